"""Lines of a block for a page that is embossed, taken one by one as there is room for them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vbraille.layout.embossed_rules import CENTRED_MARGIN, PlacingRule
from vbraille.layout.wrapping import breaks_of, wrap

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.braille.cells import Cells
    from vbraille.translate.source import Block

    Row = NDArray[np.uint8]


class BlockFlow:
    """Cells of a block from which one line after the other is taken.

    Parameters
    ----------
    place
        Where the block's lines begin.

    Attributes
    ----------
    breaks : bytes
        Where a line may end among the cells, as `vbraille.layout.wrapping.breaks_of` tells it.
    """

    def __init__(self, place: PlacingRule) -> None:
        self._place = place
        self._indent = place.first
        self._begun = False
        self._masks = np.empty(0, np.uint8)
        self._starts = np.empty(0, np.int64)
        self.breaks = b""
        self._at = 0

    def add(self, block: Block, cells: Cells) -> None:
        """Add the cells of a piece of the block; what is taken is forgotten."""
        at = self._at
        self._masks = np.concatenate((self._masks[at:], cells.masks))
        self._starts = np.concatenate((self._starts[at:], cells.starts))
        self.breaks = self.breaks[at:] + breaks_of(block.text, cells)
        self._at = 0

    def count(self, width: int) -> int:
        """Number of lines that all cells take in a width."""
        return len(wrap(self.breaks, width, self._place.first, self._place.others))

    def has_line(self, whole: int, *, final: bool) -> bool:
        """Whether there is a line to take; the blanks before it are left out, but no indent.

        Parameters
        ----------
        whole
            Number of cells of a page's line.
        final
            Whether no further piece of the block follows.
        """
        while not (rest := self.breaks[self._at : self._at + 3 * whole]).strip(b"\0"):
            if not rest:
                return False
            self._at += len(rest)
        if self._begun or self._place.centred:  # a blank at which the line before ended
            self._at += len(rest) - len(rest.lstrip(b"\0"))
        return final or len(self.breaks) - self._at > 2 * whole

    def take(self, width: int, whole: int) -> Row:
        """Take a line.

        Parameters
        ----------
        width
            Largest number of cells that the line may have.
        whole
            Number of cells of a page's line, in whose middle a centred line stands.
        """
        at = self._at
        room = width
        if self._place.centred:
            room = min(width, whole - 2 * CENTRED_MARGIN)
        window = slice(at, at + 3 * whole)
        starts = self._starts[window]
        bounds = wrap(
            self.breaks[window], room, min(self._indent, room // 2), self._place.others,
            starts.tolist(),
        )  # fmt: skip
        start, stop, indent = bounds[0]
        following = bounds[1][0] if len(bounds) > 1 else len(self.breaks[window])
        line = self._masks[at + start : at + stop]
        self._at = at + following
        self._indent = self._place.others
        self._begun = True
        if self._place.centred:
            indent = min((whole - line.size) // 2, width - line.size)
        return np.concatenate((blank(indent), line))


def blank(cells: int) -> Row:
    """Make a row of so many cells without dots."""
    return np.zeros(cells, np.uint8)
