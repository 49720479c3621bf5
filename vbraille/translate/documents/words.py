"""Words in a stretch of characters, and the gaps between them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vbraille.translate.documents.codepoints import BREAK, NEWLINE, TEXT

if TYPE_CHECKING:
    from numpy.typing import NDArray


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
