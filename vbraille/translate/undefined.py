"""Text to dots: liblouis first, as the text stands; then ours for what it leaves undefined.

What a table does not know is known only in its place: a bracket that is undefined alone is written
beside a Greek letter. So the whole text is translated; each part that came out undefined takes its
next spelling, and the whole text is translated again, until nothing is left.
"""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass, field
from functools import cache, partial
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
    parts = _parts(text)
    part_of = [part for part in parts for _ in part.original]
    while True:
        written, origins = _spelt(parts)
        shapes = None if forms is None else [forms[place] for place in origins]
        answer = LOUIS.translate(table, written, shapes)
        dots = bytearray(answer.masks)
        left: list[int] = []  # characters of the text that come out undefined
        for cell in answer.undefined:
            place = answer.places[cell]
            if "⠀" <= written[place] <= "⣿":
                dots[cell] = ord(written[place]) & 0xFF
            else:
                left.append(origins[place])
        # A spelling of ours must not come out blank, as · does in some tables.
        owners = [part_of[origins[place]] for place in answer.places]
        inked = {part.start for part, dot in zip(owners, dots, strict=True) if dot}
        left += [part.start for part in owners if part.kind and part.start not in inked]
        left = left or [origins[place] for place in _swallowed(table, written, answer)]
        if not left:
            break
        undefined: dict[int, set[str]] = {}
        for place in left:
            undefined.setdefault(part_of[place].start, set()).add(text[place])
        for start, signs in undefined.items():
            part = part_of[start]
            if part.spellings is None:
                own = partial(cells_of, table)
                part.spellings = spellings(part.original, signs, how, own)
            # Even full cells can be eaten by a rule; they are counted all the same.
            part.kind, part.spelt = next(part.spellings, (Kind.MARKED, ""))
    places = [origins[min(place, len(origins) - 1)] for place in answer.places]
    otherwise = Counter((part.kind, part.original) for part in parts if part.kind)
    return Written(bytes(dots), places, otherwise)


@dataclass(slots=True)
class _Part:
    """A letter with its marks, spelt as it stands until it takes another spelling."""

    start: int
    original: str
    spelt: str
    kind: Kind | None = None
    spellings: Iterator[tuple[Kind | None, str]] | None = None


def _parts(text: str) -> list[_Part]:
    parts: list[_Part] = []
    for place, sign in enumerate(text):
        if parts and joins(parts[-1].original, sign):
            parts[-1].original += sign
        else:
            parts.append(_Part(place, sign, ""))
    for part in parts:
        part.spelt = in_order(part.original)
    return parts


def _spelt(parts: list[_Part]) -> tuple[str, list[int]]:
    """The text as spelt now, and the character of the text that each of it stands for.

    Neighbours that have a marker each have one together.
    """
    text: list[str] = []
    origins: list[int] = []
    marked = ""
    for part in parts:
        is_marked = part.kind is Kind.MARKED
        if is_marked and part.spelt == marked:
            continue
        marked = part.spelt if is_marked else ""
        text.append(part.spelt)
        exact = part.spelt == part.original
        origins += [part.start + exact * number for number in range(len(part.spelt))]
    return "".join(text), origins


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


@cache
def cells_of(table: str, text: str) -> bytes:
    """Dot masks of a short text by a table; none if it leaves some of it undefined."""
    answer = LOUIS.translate(table, text)
    return b"" if answer.undefined else answer.masks


def _word_by_word(table: str, text: str, forms: list[int] | None, how: Undefined) -> Written:
    """Translate each word alone; a word that does not end is a marker."""
    whole = Written(b"", [])
    start = lost = 0
    for word in text.split(" "):
        if start:
            whole.masks += b"\0"
            whole.places.append(start - 1)
        written = Written(b"", [])
        if word:
            written = Written(_FULL, [0] * len(_FULL), Counter({(Kind.UNENDING, word): 1}))
        if word and lost < _MOST_LOST:
            try:
                written = _write(table, word, forms and forms[start : start + len(word)], how)
            except UnendingError:
                lost += 1
        whole.masks += written.masks
        whole.places += [start + place for place in written.places]
        whole.otherwise += written.otherwise
        start += len(word) + 1
    return whole
