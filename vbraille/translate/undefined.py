"""Text to dots: liblouis first, as the text stands; then ours for what it leaves undefined.

What a table does not know is known only in its place: a bracket that is undefined alone is written
beside a Greek letter. So the whole text is translated; each part that came out undefined takes its
next spelling, and the whole text is translated again, until nothing is left.
"""

from __future__ import annotations

import re
from collections import Counter
from contextlib import suppress
from dataclasses import dataclass, field

import numpy as np

from vbraille.braille.cells import Cells
from vbraille.translate.liblouis import LOUIS, Answer, UnendingError, cells_of
from vbraille.translate.spellings import FULL_CELLS, Kind, Undefined, in_order, joins, spellings

_STRANGER = "\ue123"  # no table has it
_MOST_LOST = 3  # unending words of a passage that are tried, before the rest is given up
# What tables expect otherwise: what is left out, Hebrew points and the Arabic shadda.
_NEEDS_ORDER = re.compile("[\0\u00ad\ufeff\u05b0-\u05c2\u0651]")
_FULL = bytes(ord(sign) & 0xFF for sign in FULL_CELLS)


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

    masks: bytes = b""
    places: list[int] = field(default_factory=list)
    otherwise: Counter[tuple[Kind, str]] = field(default_factory=Counter)

    def add(self, part: Written, start: int) -> None:
        """Add what was written for the text from a character on."""
        self.masks += part.masks
        self.places += [start + place for place in part.places]
        self.otherwise += part.otherwise

    def cells(self, length: int, start: int = 0) -> Cells:
        """Cells for a text of a length that begins at a place of a book."""
        masks, starts = np.frombuffer(self.masks, np.uint8), np.array(self.places, np.int64)
        return Cells(masks, starts + start, start + length)


def write(table: str, text: str, forms: list[int] | None, how: Undefined) -> Written:
    """Translate a text; word by word, with markers for words, where liblouis does not end.

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
    """
    with suppress(UnendingError):
        return _write(table, text, forms, how)
    whole, start, lost = Written(), 0, 0
    for word in re.findall(" |[^ ]+", text):
        try:
            if lost >= _MOST_LOST and word != " ":
                raise UnendingError
            part = _write(table, word, forms and forms[start : start + len(word)], how)
        except UnendingError:
            lost += 1
            part = Written(_FULL, [0] * len(_FULL), Counter({(Kind.UNENDING, word): 1}))
        whole.add(part, start)
        start += len(word)
    return whole


def _write(table: str, text: str, forms: list[int] | None, how: Undefined) -> Written:
    if not _NEEDS_ORDER.search(text):  # most texts of most books need no more, three times as fast
        answer = LOUIS.translate(table, text, forms)
        if not answer.undefined and not _swallowed(table, text, answer):
            return Written(answer.masks, answer.places)
    parts: list[str] = []
    for sign in text:
        if parts and joins(parts[-1], sign):
            parts[-1] += sign
        else:
            parts.append(sign)
    owners = [number for number, part in enumerate(parts) for _ in part]
    tried = [0] * len(parts)  # spellings of each part
    while True:
        spelt, marked, start = "", "", 0
        origins: list[int] = []  # character of the text that each of the spelt stands for
        otherwise: Counter[tuple[Kind, str]] = Counter()
        for part, number in zip(parts, tried, strict=True):
            ways = spellings(part, table, how) if number else [(None, in_order(part))]
            kind, way = ways[min(number, len(ways) - 1)]
            if kind is not None:
                otherwise[kind, part] += 1
            if kind is not Kind.MARKED or way != marked:  # neighbours have one marker together
                spelt += way
                origins += [start + (way == part) * place for place in range(len(way))]
            marked = way if kind is Kind.MARKED else ""
            start += len(part)
        shapes = None if forms is None else [forms[place] for place in origins]
        answer = LOUIS.translate(table, spelt, shapes)
        dots = bytearray(answer.masks)
        left: list[int] = []  # characters of the text that come out undefined
        for cell in answer.undefined:
            place = answer.places[cell]
            if "⠀" <= spelt[place] <= "⣿":
                dots[cell] = ord(spelt[place]) & 0xFF
            else:
                left.append(origins[place])
        left = left or [origins[place] for place in _swallowed(table, spelt, answer)]
        if not left:
            places = [origins[min(place, len(origins) - 1)] for place in answer.places]
            return Written(bytes(dots), places, otherwise)
        for number in {owners[place] for place in left}:
            tried[number] += 1


def _swallowed(table: str, text: str, answer: Answer) -> list[int]:
    """Characters that vanish: liblouis takes what it does not know for blanks, and rules eat those.

    A character without cells may be part of a contraction. It is not if any other does as well.
    """
    with_cells = set(answer.places)
    swallowed = []
    for place, sign in enumerate(text):
        if place in with_cells or cells_of(table, sign):
            continue
        other = text[:place] + _STRANGER + text[place + 1 :]
        if LOUIS.translate(table, other).masks == answer.masks:
            swallowed.append(place)
    return swallowed
