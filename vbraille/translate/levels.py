"""Superscripts and subscripts as each braille table writes them."""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby
from typing import TYPE_CHECKING

import numpy as np

from vbraille.translate.source import SPACE, Mark, MarkKind, Text

if TYPE_CHECKING:
    from collections.abc import Callable

_KINDS = {"<super>": MarkKind.SUPERSCRIPT, "<sub>": MarkKind.SUBSCRIPT}
_NOTATION = {MarkKind.SUPERSCRIPT: "^", MarkKind.SUBSCRIPT: "_"}
# Endings of ordinal numbers, which English writes on the line as often as above it.
_ORDINALS = frozenset(("st", "nd", "rd", "th"))
# Unified English Braille; its tables in liblouis have no sign for subscripts.
_UEB = {MarkKind.SUPERSCRIPT: "⠰⠔", MarkKind.SUBSCRIPT: "⠰⠢"}
_UEB_GROUP = ("⠣", "⠜")
_BY_RULE = re.compile("[a-j]{1,5}")  # a rule of UEB's tables takes these for digits, ungrouped
_LOWERED = {1: 2, 2: 4, 8: 16, 16: 32}  # bits of dots 1, 2, 4, 5, and of those below them


def _raised_and_lowered() -> dict[int, tuple[MarkKind, int]]:
    """For each raised or lowered character of Unicode: which it is, and the one on the line."""
    found = {}
    letters = (*range(0x2B0, 0x2B9), *range(0x1D2C, 0x1D6B))
    for code in (0xB2, 0xB3, 0xB9, *range(0x2070, 0x20A0), *letters):
        kind, _, base = unicodedata.decomposition(chr(code)).partition(" ")
        if kind in _KINDS and " " not in base:
            found[code] = _KINDS[kind], int(base, 16)
    return found


_ON_LINE = _raised_and_lowered()
_FORMS: dict[MarkKind, dict[str, str]] = {kind: {} for kind in _NOTATION}
for _code, (_kind, _base) in _ON_LINE.items():
    _FORMS[_kind].setdefault(chr(_base), chr(_code))
for _forms in _FORMS.values():
    _forms["-"] = _forms["\u2212"]
# Characters of numbers, which would melt into a number before them.
_OF_NUMBERS = frozenset("0123456789+-\u2212=()ni")


# Small numbers and what a reader types who looks for them.
TYPED = {
    ord(form): base
    for forms in _FORMS.values()
    for base, form in forms.items()
    if base in _OF_NUMBERS
}


def small_number(text: str, kind: MarkKind) -> str:
    """Text of a superscript or subscript in Unicode's small characters, if it is a number.

    >>> small_number("10", MarkKind.SUPERSCRIPT), small_number("th", MarkKind.SUPERSCRIPT)
    ('¹⁰', 'th')
    """
    if not _OF_NUMBERS.issuperset(text) or (text.isalpha() and len(text) > 1):
        return text
    return "".join(_FORMS[kind][character] for character in text)


@dataclass(frozen=True, slots=True)
class _Indicator:
    """Cells that a table sets before and after a superscript or subscript.

    Parameters
    ----------
    before, after
        Cells, as characters of Unicode; empty where it sets none.
    digits
        Cells of each digit in between; empty if they are as on the line.
    numeric
        What of the cells before says that digits follow.
    group
        Brackets around several characters, if nothing else ends them.
    """

    before: str
    after: str = ""
    digits: tuple[str, ...] = ()
    numeric: str = ""
    group: tuple[str, str] = ("(", ")")

    def around(self, part: str, following: str) -> tuple[str, str, str]:
        """Tell what stands before a part, the part, and what stands after it."""
        if _is_number(part):
            if self.digits:
                cells = "".join(self.digits[int(digit)] for digit in part)
                return self.before, cells, self.after
            alone = bool(self.after) or not following.isdigit()
        else:
            alone = bool(self.after) or len(part) == 1
        opening, closing = ("", "") if alone else self.group
        if opening and _BY_RULE.fullmatch(part):
            opening, closing = "(", ")"
        before = self.before if _is_number(part) else self.before.removeprefix(self.numeric)
        return before + opening, part, closing + self.after


class Superscripts:
    """Superscripts and subscripts as a table writes them.

    A table with classes of emphasis for these is given those. Otherwise, a table that has signs of
    its own for ² and ³ says by them which indicator it has; what it says nothing of is written as
    in plain text, as in x^2 and H_2O, or in round brackets.

    Parameters
    ----------
    cells
        Function that gives the dot masks that the table writes for a text.
    writes
        Function that tells whether the table can write a code point.
    has_class
        Function that tells whether the table has a class of emphasis for a kind of mark.
    """

    def __init__(
        self,
        cells: Callable[[str], bytes],
        writes: Callable[[int], bool],
        has_class: Callable[[MarkKind], bool],
    ) -> None:
        self._cells = cells
        self._writes = writes
        self._has_class = has_class

    def put_into(self, text: Text, marks: tuple[Mark, ...]) -> tuple[Text, tuple[Mark, ...]]:
        """Set what is above or below the line apart from what is on it.

        Returns
        -------
        Text, tuple of Mark
            The text, in which inserted characters have the place of the one next to them; and its
            marks, for a table that is told by them.
        """
        levels = [mark for mark in marks if mark.kind in _NOTATION]
        if not levels and _ON_LINE.keys().isdisjoint(text.alphabet):
            return text, marks
        codes = text.codes.tolist()
        kinds: list[MarkKind | None] = [None] * len(codes)
        for mark in levels:
            start, end = text.index(mark.start), text.index(mark.end)
            kinds[start:end] = [mark.kind] * (end - start)
        for n, code in enumerate(codes):
            if code in _ON_LINE:
                kinds[n], codes[n] = _ON_LINE[code]
            elif code == SPACE:
                kinds[n] = None
        if not any(kinds):
            return text, marks
        line = "".join(map(chr, codes))
        places = text.places.tolist()
        written: list[str] = []
        written_places: list[int] = []
        told = [mark for mark in marks if mark.kind not in _NOTATION]
        start = 0
        for kind, run in groupby(kinds):
            stop = start + len(list(run))
            part = line[start:stop]
            before, after = "", ""
            if kind is not None and not _is_ordinal(part, line[:start], kind):
                if self._has_class(kind):
                    end = places[stop] if stop < len(places) else text.end
                    told.append(Mark(kind, places[start], end))
                else:
                    before, part, after = self._written(part, kind, line[stop : stop + 1])
            written += (before, part, after)
            written_places += [places[start]] * len(before)
            written_places += places[start:stop]
            written_places += [places[stop - 1]] * len(after)
            start = stop
        done = np.array([ord(c) for c in "".join(written)], np.uint32)
        places_now = np.array(written_places, np.int64)
        return Text(done, places_now, text.end, frozenset(done.tolist())), tuple(told)

    def _written(self, part: str, kind: MarkKind, following: str) -> tuple[str, str, str]:
        """Sign before a part above or below the line, the part, and the sign after it."""
        indicator, own = self._indicators.get(kind), self._own[kind]
        if indicator is None or not _is_number(part):
            if len(part) == 1 and part in own:
                return "", own[part], ""
            if indicator is None and own.keys() >= set(part):
                return "", "".join(own[character] for character in part), ""
        if indicator is not None:
            return indicator.around(part, following)
        if self._writes(ord(_NOTATION[kind])):
            return _Indicator(_NOTATION[kind]).around(part, following)
        if all(map(self._writes, map(ord, "()"))):
            return "(", part, ")"
        return (" ", part, " ") if self._writes(ord(part[0])) else ("", part, "")

    @cached_property
    def _own(self) -> dict[MarkKind, dict[str, str]]:
        """Unicode's small characters that the table tells from each other and those on the line."""
        return {kind: self._distinct(forms) for kind, forms in _FORMS.items()}

    def _distinct(self, forms: dict[str, str]) -> dict[str, str]:
        cells = {base: self._cells(form) for base, form in forms.items() if self._writes(ord(form))}
        several = list(cells.values())
        return {
            base: forms[base]
            for base, dots in cells.items()
            if several.count(dots) == 1 and dots != self._cells(base)
        }

    @cached_property
    def _indicators(self) -> dict[MarkKind, _Indicator]:
        """Indicators that the table's own signs for 2 and 3 above and below the line tell."""
        found = {}
        for kind, own in self._own.items():
            indicators = {self._indicator(own, digit) for digit in "23"}
            if len(indicators) == 1 and (indicator := indicators.pop()) is not None:
                found[kind] = indicator
        raised = found.get(MarkKind.SUPERSCRIPT)
        if raised is not None and raised.before == _UEB[MarkKind.SUPERSCRIPT]:
            ueb = {kind: _Indicator(cells, group=_UEB_GROUP) for kind, cells in _UEB.items()}
            return ueb | {kind: one for kind, one in found.items() if kind not in ueb}
        return found

    def _indicator(self, own: dict[str, str], digit: str) -> _Indicator | None:
        if digit not in own:
            return None
        small, on_line = self._cells(own[digit]), self._cells(digit)
        sign = on_line[:-1]  # that digits follow
        usual = [self._cells(digit)[-1:] for digit in "0123456789"]
        for digits in ([], usual, [bytes([_lowered(*cell)]) for cell in usual]):
            cells = digits[int(digit)] if digits else on_line
            at = small.rfind(cells)
            if at > 0 and all(self._cells(_raw(part)) == part for part in (small, *digits)):
                numeric = _raw(sign) if digits and small.startswith(sign) else ""
                after = _raw(small[at + len(cells) :])
                return _Indicator(_raw(small[:at]), after, tuple(map(_raw, digits)), numeric)
        return None


def _is_number(part: str) -> bool:
    return part.isascii() and part.isdigit()


def _is_ordinal(part: str, before: str, kind: MarkKind) -> bool:
    return kind is MarkKind.SUPERSCRIPT and part in _ORDINALS and before[-1:].isdigit()


def _lowered(cell: int) -> int:
    return sum(below for dot, below in _LOWERED.items() if cell & dot)


def _raw(cells: bytes) -> str:
    return "".join(chr(0x2800 + cell) for cell in cells)
