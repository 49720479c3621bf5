"""Text to dots: liblouis first, as the text stands; then ours for what it leaves undefined.

What a table does not know is known only in its place: a bracket that is undefined alone is written
beside a Greek letter. So the whole text is translated; each part that came out undefined takes its
next spelling, and the whole text is translated again, until nothing is left.
"""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass, field
from functools import cache
from typing import TYPE_CHECKING

from vbraille.translate.liblouis import LOUIS, Answer, UnendingError
from vbraille.translate.spellings import (
    FULL_CELLS,
    LEFT_OUT,
    SHADDA,
    Kind,
    Undefined,
    in_order,
    joins,
    spellings,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

_STRANGER = "\ue123"  # no table has it
_MOST_LOST = 3  # unending words of a passage that are tried, before the rest is given up
# What tables expect otherwise than Unicode's normal forms have it: a shadda before the vowel, and
# Hebrew letters with their points composed, as no normal form has them.
_NEEDS_ORDER = re.compile(f"[{LEFT_OUT}]|[\u064b-\u0655\u0670]{SHADDA}|[\u05b0-\u05c2]")
_FULL = bytes(ord(sign) & 0xFF for sign in FULL_CELLS)
# Even full cells can be eaten by a rule; they are counted all the same.
_GIVEN_UP = (Kind.MARKED, "")


@dataclass(slots=True)
class Written:
    """Dots of a text.

    Attributes
    ----------
    masks : bytes
        Dots of each cell.
    places : list of int
        Character of the text that each cell stands for, never decreasing.
    otherwise : Counter
        Parts that were written otherwise than they stand, with how.
    """

    masks: bytes
    places: list[int]
    otherwise: Counter[tuple[Kind, str]] = field(default_factory=Counter)


def write(table: str, text: str, forms: list[int] | None, how: Undefined) -> Written:
    """Translate a text.

    Parameters
    ----------
    table
        File name or path of a table.
    text
        Any text.
    forms
        Bits of the table's classes of emphasis for each character; None for none.
    how
        What is written for what nothing else can be written for.

    Raises
    ------
    InputError
        If the table cannot be used.
    """
    if not text:
        return Written(b"", [])
    try:
        return _write(table, text, forms, how)
    except UnendingError:
        return _word_by_word(table, text, forms, how)


def _write(table: str, text: str, forms: list[int] | None, how: Undefined) -> Written:
    if not _NEEDS_ORDER.search(text):
        answer = LOUIS.translate(table, text, forms)
        if not answer.undefined and not _swallowed(table, text, answer):
            return Written(answer.masks, answer.places)
    parts = _Parts(table, text, how)
    while True:
        written, origins = parts.written()
        shapes = None if forms is None else [forms[place] for place in origins]
        answer = LOUIS.translate(table, written, shapes)
        dots = bytearray(answer.masks)
        left = set()
        for cell in answer.undefined:
            place = answer.places[cell]
            if _is_pattern(written[place]):
                dots[cell] = ord(written[place]) & 0xFF
            else:
                left.add(origins[place])
        left |= parts.blank(answer.places, dots, origins)
        if not left:
            left = {origins[place] for place in _swallowed(table, written, answer)}
        if not left:
            break
        parts.take_next(left)
    places = [origins[min(place, len(origins) - 1)] for place in answer.places]
    return Written(bytes(dots), places, parts.count())


def _swallowed(table: str, text: str, answer: Answer) -> list[int]:
    """Characters that vanish: liblouis takes what it does not know for blanks, and rules eat those.

    A character without cells may be part of a contraction. It is not if any other does as well.
    """
    with_cells = set(answer.places)
    swallowed = []
    for place, sign in enumerate(text):
        if place in with_cells or not _is_undefined_alone(table, sign):
            continue
        other = text[:place] + _STRANGER + text[place + 1 :]
        if LOUIS.translate(table, other).masks == answer.masks:
            swallowed.append(place)
    return swallowed


@cache
def _is_undefined_alone(table: str, sign: str) -> bool:
    """Tell whether a table leaves a character undefined that stands alone."""
    return bool(LOUIS.translate(table, sign).undefined)


@cache
def cells_of(table: str, text: str) -> bytes:
    """Dot masks of a short text by a table; none if it leaves some of it undefined."""
    answer = LOUIS.translate(table, text)
    return b"" if answer.undefined else answer.masks


def _word_by_word(table: str, text: str, forms: list[int] | None, how: Undefined) -> Written:
    """Translate each word alone; a word that does not end is a marker."""
    whole = Written(b"", [], Counter({(Kind.BY_WORDS, text): 1}))
    start = lost = 0
    for word in text.split(" "):
        if start:
            whole.masks += b"\0"
            whole.places.append(start - 1)
        shapes = None if forms is None else forms[start : start + len(word)]
        written = Written(_FULL, [0] * len(_FULL), Counter({(Kind.UNENDING, word): 1}))
        if not word:
            written = Written(b"", [])
        elif lost < _MOST_LOST:
            try:
                written = _write(table, word, shapes, how)
            except UnendingError:
                lost += 1
        whole.masks += written.masks
        whole.places += [start + place for place in written.places]
        whole.otherwise += written.otherwise
        start += len(word) + 1
    return whole


class _Parts:
    """A text in letters with their marks, each spelt as it stands until it takes another."""

    def __init__(self, table: str, text: str, how: Undefined) -> None:
        self._table, self._text, self._how = table, text, how
        self._part_at: list[int] = []  # where the part begins that a character is in
        self._originals: dict[int, str] = {}
        start = 0
        for place, sign in enumerate(text):
            if place and not joins(text[start:place], sign):
                start = place
            self._part_at.append(start)
            self._originals[start] = self._originals.get(start, "") + sign
        self._spelt = {start: in_order(part) for start, part in self._originals.items()}
        self._kinds: dict[int, Kind | None] = {}
        self._spellings: dict[int, Iterator[tuple[Kind | None, str]]] = {}

    def take_next(self, places: set[int]) -> None:
        """Take the next spelling of the parts that hold these places."""
        undefined: dict[int, set[str]] = {}
        for place in places:
            undefined.setdefault(self._part_at[place], set()).add(self._text[place])
        for start, signs in undefined.items():
            if start not in self._spellings:
                part = self._originals[start]
                self._spellings[start] = spellings(
                    part, signs, self._how, lambda text: cells_of(self._table, text)
                )
            self._kinds[start], self._spelt[start] = next(self._spellings[start], _GIVEN_UP)

    def blank(self, cells: list[int], dots: bytearray, origins: list[int]) -> set[int]:
        """Parts that a spelling of ours has made blank, as · is in some tables."""
        inked: dict[int, bool] = {}
        for cell, dot in zip(cells, dots, strict=True):
            start = self._part_at[origins[cell]]
            inked[start] = inked.get(start, False) or dot != 0
        return {start for start, kind in self._kinds.items() if kind and inked.get(start) is False}

    def written(self) -> tuple[str, list[int]]:
        """The text as spelt now, and the character of the text that each of it stands for.

        Neighbours that have a marker each have one together.
        """
        text: list[str] = []
        origins: list[int] = []
        marked = ""
        for start, spelling in self._spelt.items():
            is_marked = self._kinds.get(start) is Kind.MARKED
            if is_marked and spelling == marked:
                continue
            marked = spelling if is_marked else ""
            text.append(spelling)
            exact = spelling == self._originals[start]
            origins += [start + (number if exact else 0) for number in range(len(spelling))]
        return "".join(text), origins

    def count(self) -> Counter[tuple[Kind, str]]:
        """Parts that are written otherwise, by how."""
        return Counter(
            (kind, self._originals[start])
            for start, kind in self._kinds.items()
            if kind is not None
        )


def _is_pattern(sign: str) -> bool:
    """Tell whether a character is a pattern of dots in Unicode."""
    return "⠀" <= sign <= "⣿"
