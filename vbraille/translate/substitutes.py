"""Characters that a braille table cannot write, and those that are written in their place."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from vbraille.translate.scripts import script_of
from vbraille.translate.text import SPACE
from vbraille.translate.undefined import MARKERS, Undefined, likenesses, spellings

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from numpy.typing import NDArray

    from vbraille.translate.scripts import Script
    from vbraille.translate.text import Text

# Invisible characters that carry no text unless a table knows them (joiners, variation selectors,
# directions); and the byte-order mark, which liblouis 3.24 turns into a wrong "zero".
_IGNORABLE = (
    {0x034F, 0x061C, 0xFEFF, *range(0x200B, 0x2010), *range(0x202A, 0x202F)}
    | {*range(0x2060, 0x2070), *range(0xFE00, 0xFE10)}
    | {*range(0x180B, 0x1810), *range(0xE0000, 0xE0200)}
)
_BYTE_ORDER_MARK = 0xFEFF


class Substitutes:
    """What is known so far of the characters of a table; each is looked at once.

    Parameters
    ----------
    writes
        Function that tells whether the table can write a code point.
    how
        What is written for a character that the table does not know.

    Attributes
    ----------
    undefined : set of int
        Code points that occurred and that the table does not know.
    """

    def __init__(self, writes: Callable[[int], bool], how: Undefined) -> None:
        self.undefined: set[int] = set()
        self._writes = writes
        self._how = how
        # Characters that the table is known to have; what stands for those it does not have.
        self._known = {SPACE}
        self._instead: dict[int, tuple[int, ...]] = {}
        self._foreign: dict[str, Script] = {}  # scripts of whole unknown passages, by name
        self._noted = 0

    @cached_property
    def marker(self) -> str:
        """Text that marks characters that the table does not know."""
        return "".join(map(chr, self._first_written(MARKERS)))

    def take_foreign(self) -> Script | None:
        """Next script that a passage was in and the table does not know, each once; then None."""
        if self._noted == len(self._foreign):
            return None
        self._noted += 1
        return list(self._foreign.values())[self._noted - 1]

    def put_into(self, text: Text) -> tuple[NDArray[np.uint32], NDArray[np.int64]]:
        """Replace characters that the table cannot write by others that it can.

        Returns
        -------
        uint32[characters], int64[characters]
            Code points, and the place in the source of each.
        """
        if text.alphabet <= self._known:
            return text.codes, text.places
        for code in text.alphabet - self._known - self._instead.keys():
            self._probe(code)
        own = text.codes.tolist()
        if self._instead.keys().isdisjoint(own):
            return text.codes, text.places
        self._look_for_foreign(own)
        written: list[int] = []
        places: list[int] = []
        mark = _codes(self.marker) if self._how is Undefined.MARK else None
        marked = False
        for code, place in zip(own, text.places.tolist(), strict=True):
            instead = self._instead.get(code, (code,))
            if instead[:1] == (SPACE,) and written[-1:] in ([], [SPACE]):
                instead = instead[1:] or instead
            marked, before = instead == mark and code in self.undefined, marked
            if marked and before:
                continue  # one marker stands for all neighbours
            written += instead
            places += (place,) * len(instead)
        return np.array(written, np.uint32), np.array(places, np.int64)

    def _look_for_foreign(self, codes: list[int]) -> None:
        """Remember the script of a passage if the table does not know most of its letters."""
        if self.undefined.isdisjoint(codes):
            return
        letters = [letter for letter in map(chr, codes) if letter.isalpha()]
        unknown = [letter for letter in letters if ord(letter) in self.undefined]
        if 2 * len(unknown) > len(letters):
            script = script_of(unknown)
            if script is not None:
                self._foreign.setdefault(script.name, script)

    def _probe(self, code: int) -> None:
        """Learn whether the table knows a character, and what to hand liblouis if it does not."""
        instead = self._find_instead(code)
        if instead == (code,):
            self._known.add(code)
        else:
            self._instead[code] = instead

    def _find_instead(self, code: int) -> tuple[int, ...]:
        if code == _BYTE_ORDER_MARK:
            return ()
        if self._writes(code):
            return (code,)
        if code in _IGNORABLE:
            return ()
        character = chr(code)
        if character.isspace():
            return (SPACE,)
        alike = self._first_written(likenesses(character))
        if alike:
            return alike
        self.undefined.add(code)
        return self._first_written(spellings(character, self._how))

    def _first_written(self, texts: Iterable[str]) -> tuple[int, ...]:
        """First of the texts that the table can write in full; empty if there is none."""
        return next((c for c in map(_codes, texts) if all(map(self._writes, c))), ())


def _codes(text: str) -> tuple[int, ...]:
    return tuple(map(ord, text))
