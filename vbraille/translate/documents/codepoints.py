"""Characters as they are read: as code points, of which kind, and where in the document; words."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

# In cells; a carriage that goes ten metres crosses fewer than this.
LONGEST_BLANK = 4_096
_HALF = LONGEST_BLANK // 2
TEXT, BLANK, NEWLINE, BREAK, DROPPED = range(5)
_KINDS = np.zeros(0x3002, np.uint8)  # the last entry stands for all code points above
_KINDS[[0x09, 0x20, 0x1680, 0x205F, 0x3000, *range(0x2000, 0x2007), *range(0x2008, 0x200B)]] = BLANK
_KINDS[[0x0A, 0x0B, 0x0D, 0x85, 0x2028]] = NEWLINE
_KINDS[[0x0C, 0x2029]] = BREAK
_KINDS[0xAD] = DROPPED  # a soft hyphen is a hint to a typesetter and would split contractions


@dataclass(frozen=True, slots=True, eq=False)
class Stretch:
    """A stretch of a document's characters, some of which may have been left out.

    Parameters
    ----------
    codes : uint32[n]
        Code points.
    begins : int64[runs]
        Index of the first character of each run that nothing is left out of; from 0, growing.
    places : int64[runs]
        Place of that character in the document, counted in characters from the first.
    """

    codes: NDArray[np.uint32]
    begins: NDArray[np.int64]
    places: NDArray[np.int64]

    @classmethod
    def whole(cls, codes: NDArray[np.uint32], place: int) -> Stretch:
        """Characters from a place of the document on, with none left out."""
        return cls(codes, np.zeros(1, np.int64), np.full(1, place, np.int64))

    @classmethod
    def joined(cls, parts: list[Stretch]) -> Stretch:
        """Join stretches that follow each other into one."""
        before = np.cumsum([0, *(len(part) for part in parts[:-1])])
        begins = [part.begins + size for part, size in zip(parts, before, strict=True)]
        return cls(
            np.concatenate([part.codes for part in parts]),
            np.concatenate(begins),
            np.concatenate([part.places for part in parts]),
        )

    def place(self, index: NDArray[np.intp] | int) -> NDArray[np.int64]:
        """Places in the document of characters of the stretch, given their indices."""
        run = np.searchsorted(self.begins, index, "right") - 1
        return index + (self.places - self.begins)[run]

    def __len__(self) -> int:
        return self.codes.size


def shorten_blanks(codes: NDArray[np.uint32], place: int, before: int = 0) -> tuple[Stretch, int]:
    """Shorten runs of blanks that are longer than any line of a page.

    Blanks at which a line breaks are not shown, so that the lines stay the same.

    Parameters
    ----------
    codes : uint32[n]
        Code points.
    place
        Place of the first code point in the document.
    before
        Number of blanks right before the first code point.

    Returns
    -------
    stretch : Stretch
        The characters with runs of at most `LONGEST_BLANK`.
    after : int
        Number of blanks at the end, to be given with the characters that follow.
    """
    blank = kinds_of(codes) == BLANK
    if blank.all():
        room = max(0, LONGEST_BLANK - before)
        return Stretch.whole(codes[:room].copy(), place), before + codes.size
    after = int(np.argmin(blank[::-1]))
    # A run that is too long has all of at least one such row.
    rows = blank[: blank.size // _HALF * _HALF].reshape(-1, _HALF)
    long = before + int(np.argmin(blank)) > LONGEST_BLANK or rows.all(axis=1).any()
    if not long:
        return Stretch.whole(codes, place), after
    at = np.arange(codes.size)
    run = at - np.maximum.accumulate(np.where(blank, -1 - before, at))
    kept = at[run <= LONGEST_BLANK]
    begins = np.flatnonzero(np.diff(kept, prepend=-2) > 1)
    return Stretch(codes[kept], begins, place + kept[begins]), after


def kinds_of(codes: NDArray[np.uint32]) -> NDArray[np.uint8]:
    """Kind of each character: text, blank, newline, break, or one that is dropped."""
    return np.take(_KINDS, codes, mode="clip")


class Words:
    """Where characters that are text stand together in a stretch, and what is between them.

    Parameters
    ----------
    codes : uint32[n]
        Code points of the stretch.
    kinds : uint8[n]
        Kind of each.

    Attributes
    ----------
    first, last : int
        Index of the first and last character that is text; -1 if none is.
    stops, begins : intp[gaps]
        For each gap between words: index of the last character before it, and of the first after.
    line_ends : intp[m]
        Indices of characters that end a line.
    newlines : intp[k]
        Those without the second of a carriage return and a line feed.
    """

    def __init__(self, codes: NDArray[np.uint32], kinds: NDArray[np.uint8]) -> None:
        self._kinds = kinds
        is_text = kinds == TEXT
        edges = np.flatnonzero(is_text[1:] != is_text[:-1])
        begun = int(is_text[:1].any())
        stops, begins = edges[1 - begun :: 2], edges[begun::2] + 1
        self.first = self.last = -1
        if begun or begins.size:
            self.first = 0 if begun else int(begins[0])
            self.last = codes.size - 1 if is_text[-1] else int(stops[-1])
        gaps = max(begins.size + begun - 1, 0)
        self.stops, self.begins = stops[:gaps], begins[begins.size - gaps :]
        ends = self.line_ends = np.flatnonzero((kinds == NEWLINE) | (kinds == BREAK))
        second = (ends > 0) & (codes[ends] == 0x0A) & (codes[ends - 1] == 0x0D)
        self.newlines = ends[~second]

    def counted(self, places: NDArray[np.intp]) -> NDArray[np.intp]:
        """Count in each gap the indices that are in it, given some that are no text."""
        inner = places[(places > self.first) & (places < self.last)]
        return np.bincount(np.searchsorted(self.begins, inner), minlength=self.begins.size)

    def places(self, kind: int) -> NDArray[np.intp]:
        """Indices of the characters of a kind."""
        return np.flatnonzero(self._kinds == kind)

    def line_starts(self, places: NDArray[np.intp]) -> NDArray[np.intp]:
        """Index of the first character on the line of each character, given their indices."""
        before = np.searchsorted(self.line_ends, places)
        return np.concatenate(([0], self.line_ends + 1))[before]
