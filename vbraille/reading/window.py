"""The part of a line that is under the hand: a line may be longer than the carriage goes."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.braille.geometry import Geometry
    from vbraille.layout.pages import Line


@dataclass(frozen=True, slots=True, eq=False)
class Window:
    """Cells of a line that the hand can cross at once.

    Parameters
    ----------
    line : Line
        The line.
    width : int
        Largest number of cells that are shown.
    offset : int
        Cell of the line that stands first; below 0 that many blank cells stand before the line.
    start_mm : float
        Place on the surface at which that cell begins, a cell's pitch before 0 at most.
    """

    line: Line
    width: int
    offset: int = 0
    start_mm: float = 0.0

    def __len__(self) -> int:
        return max(0, min(self.width, len(self.line) - self.offset))

    @property
    def masks(self) -> NDArray[np.uint8]:
        """Dot masks of what is shown, uint8[cells]."""
        before = np.zeros(min(max(-self.offset, 0), len(self)), np.uint8)
        return np.concatenate((before, self.line.masks[max(self.offset, 0) :]))[: len(self)]

    @property
    def right(self) -> Window | None:
        """The part after this one; None if the line ends here."""
        following = self.offset + self.width
        return Window(self.line, self.width, following) if following < len(self.line) else None

    @property
    def left(self) -> Window | None:
        """The part before this one; None if the line begins here."""
        before = max(0, self.offset - self.width)
        return Window(self.line, self.width, before) if self.offset > 0 else None

    @property
    def last(self) -> Window:
        """The last part of the line."""
        return self.showing(max(len(self.line) - 1, 0))

    def showing(self, cell: int) -> Window:
        """Part of the line with a cell, of the parts into which the line falls from its start."""
        return Window(self.line, self.width, cell // self.width * self.width)

    def cell_at(self, x_mm: float, geometry: Geometry) -> int | None:
        """Cell of the line at a place on the surface; None if there is none."""
        shown = math.floor((x_mm - self.start_mm) / geometry.cell_pitch_mm)
        cell = shown + self.offset
        return cell if 0 <= shown < len(self) and cell >= 0 else None

    def share_at(self, x_mm: float, geometry: Geometry) -> float:
        """How much of its cell is left of a place on the surface, 0 to 1."""
        return (x_mm - self.start_mm) / geometry.cell_pitch_mm % 1

    def under(self, cell: int, share: float, x_mm: float, geometry: Geometry) -> Window:
        """Part of the line in which a cell is under a finger that is at a place on the surface.

        Parameters
        ----------
        share
            How much of the cell is to be left of the finger, 0 to 1.
        """
        cells = x_mm / geometry.cell_pitch_mm - share  # that stand before it, and a part of one
        shown = math.ceil(cells - 1e-9)
        start_mm = min((cells - shown) * geometry.cell_pitch_mm, 0.0)
        return replace(self, offset=cell - shown, start_mm=start_mm)
