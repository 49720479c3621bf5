"""Characters that a braille table cannot write, and those that are written in their place."""

from __future__ import annotations

import re
import unicodedata
from enum import StrEnum
from functools import cache, cached_property
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from vbraille.translate.library import EndlessError, call, limit_s
from vbraille.translate.scripts import script_of
from vbraille.translate.source import SPACE, Text

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from numpy.typing import NDArray

    from vbraille.translate.scripts import Script

# In order of preference: the marker is the first text that the table can write in full.
# Three full cells are how typists of braille cross out; few tables know no question mark.
MARKERS = ("[?]", "(?)", "?", "⠿⠿⠿")
_BRACKETS = ("[]", "()")
# Characters that typewriters put in place of the marks of typesetters.
_PLAIN = str.maketrans(
    {
        "\u2010": "-", "\u2011": "-", "\u2012": "-", "\u2013": "-", "\u2014": "--", "\u2015": "--",
        "\u2018": "'", "\u2019": "'", "\u201a": "'", "\u02bc": "'", "\u2212": "-", "\u2044": "/",
        "\u201c": '"', "\u201d": '"', "\u201e": '"', "\u00ab": '"', "\u00bb": '"',
    }
)  # fmt: skip


# Blocks of Unicode: clocks and keys, symbols and dingbats, arrows and stars, pictures.
_EMOJI = ((0x231A, 0x23FF), (0x2600, 0x27BF), (0x2B00, 0x2BFF), (0x1F000, 0x1FAFF))


class Undefined(StrEnum):
    """Replacement of a character that the table does not know."""

    MARK = "mark"
    """The same short marker, such as ``[?]``, for each run of them; but an emoji's name."""
    NAME = "name"
    """The character's name in Unicode, such as ``[grinning face]``."""
    CODE = "code"
    """The character's number in Unicode, such as ``[U+1F600]``."""
    DROP = "drop"
    """Nothing."""


def spellings(character: str, how: Undefined) -> Iterator[str]:
    """Texts that may stand for a character, best first; a table takes the first it can write."""
    if how is Undefined.DROP:
        yield ""
    named = how is Undefined.NAME or (how is Undefined.MARK and is_emoji(character))
    if named and (name := unicodedata.name(character, "")):
        yield from (f"{opening}{name.lower()}{closing}" for opening, closing in _BRACKETS)
    if how is Undefined.NAME or how is Undefined.CODE:
        number = number_of(character)
        for text in (number, number.lower()):  # the capitals of some tables have eight dots
            yield from (f"{opening}{text}{closing}" for opening, closing in _BRACKETS)
    yield from MARKERS


def is_emoji(character: str) -> bool:
    """Tell if a character is a little picture that people write between words."""
    code = ord(character)
    pictures = any(first <= code <= last for first, last in _EMOJI)
    return pictures and unicodedata.category(character) in ("So", "Sk")


def likenesses(character: str) -> Iterator[str]:
    """Other spellings of the same: a ligature's letters, plain quotes, a small letter, accents."""
    seen = {character}
    plain = unicodedata.normalize("NFKC", character)
    if plain[:1].isdigit() and not character.isdecimal():
        plain = f" {plain}"  # ½ after a number is not the number's next digit
    apart = unicodedata.normalize("NFD", plain)
    for text in (plain, plain.translate(_PLAIN), plain.lower(), apart):
        if text not in seen:
            seen.add(text)
            yield text


def number_of(character: str) -> str:
    """Number of a character as Unicode writes it, such as U+1F600."""
    return f"U+{ord(character):04X}"


def describe(character: str) -> str:
    """Number of a character, with its name if it has one."""
    return f"{number_of(character)} {unicodedata.name(character, '').lower()}".rstrip()


# Invisible characters that carry no text unless a table knows them (joiners, variation selectors,
# directions); and the byte-order mark, which liblouis 3.24 turns into a wrong "zero".
_IGNORABLE = (
    {0x034F, 0x061C, 0xFEFF, *range(0x200B, 0x2010), *range(0x202A, 0x202F)}
    | {*range(0x2060, 0x2070), *range(0xFE00, 0xFE10)}
    | {*range(0x180B, 0x1810), *range(0xE0000, 0xE0200)}
)
_BYTE_ORDER_MARK = 0xFEFF
_TRIED = 100  # characters that are translated to learn of one, at most about


class Substitutes:
    """Characters of a table, as far as they are known; each is looked at once.

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
        # Characters that the table is known to have; those of them that other characters leave
        # as they are; what stands for those that it does not have.
        self._known = {SPACE}
        self._plain = {SPACE}
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

        Texts that are canonically equal become the same.

        Returns
        -------
        uint32[characters], int64[characters]
            Code points, and the place in the source of each.
        """
        if text.alphabet <= self._plain:
            return text.codes, text.places
        alphabet = text.alphabet
        if any(map(_joins, alphabet - self._plain)):
            text = self._composed(text)
            alphabet = frozenset(text.codes.tolist())
        new = alphabet - self._known - self._instead.keys()
        if new:
            try:
                call(lambda: [self._probe(code) for code in new], limit_s(_TRIED * len(new)))
            except EndlessError:
                for code in new:
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

    def _composed(self, text: Text) -> Text:
        """The text in the one form of all that are canonically equal to it.

        Letters are composed as in NFC, and those that NFC leaves apart, such as क़, where the table
        has them. Characters that become others take the place of the first of them.
        """
        characters = str(text)
        apart = _apart().search(unicodedata.normalize("NFC", characters)) is not None
        if not apart and unicodedata.is_normalized("NFC", characters):
            return text
        codes: list[int] = []
        places: list[int] = []
        own = text.places.tolist()
        begins = [n for n, code in enumerate(text.codes.tolist()) if not n or not _follows(code)]
        for start, stop in pairwise((*begins, len(own))):
            before = characters[start:stop]
            after = unicodedata.normalize("NFC", before)
            if apart:
                after = _apart().sub(self._whole, after)
            codes += map(ord, after)
            places += own[start:stop] if after == before else (own[start],) * len(after)
        return Text(np.array(codes, np.uint32), np.array(places, np.int64), text.end, text.alphabet)

    def _whole(self, parts: re.Match[str]) -> str:
        """The letter of these parts, or the parts where the table has no such letter."""
        letter = _excluded()[parts[0]]
        return letter if self._writes(ord(letter)) else parts[0]

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
            if not _joins(code):
                self._plain.add(code)
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


@cache
def _follows(code: int) -> bool:
    """Tell if a character may become another together with one before it."""
    # The numbers are vowels and ends of syllables of Hangul.
    return unicodedata.category(chr(code))[0] == "M" or 0x1160 <= code < 0x1200


@cache
def _joins(code: int) -> bool:
    """Tell if a character may become another, alone or with one before it."""
    return _follows(code) or not unicodedata.is_normalized("NFC", chr(code))


@cache
def _excluded() -> dict[str, str]:
    """Letters that NFC leaves apart, by their parts."""
    letters = map(chr, (*range(0x958, 0x1000), 0x2ADC, *range(0xFB1D, 0xFB4F)))
    parts = {unicodedata.normalize("NFC", letter): letter for letter in letters}
    return {several: letter for several, letter in parts.items() if len(several) > 1}


@cache
def _apart() -> re.Pattern[str]:
    """Pattern of the parts of such letters, the longest first."""
    return re.compile("|".join(sorted(_excluded(), key=len, reverse=True)))


def _codes(text: str) -> tuple[int, ...]:
    return tuple(map(ord, text))
