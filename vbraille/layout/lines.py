"""A line of cells on a page, and which of its cells is where."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vbraille.braille.cells import UNICODE_BLANK, Cells
from vbraille.translate.text import to_text

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.braille.geometry import Geometry
    from vbraille.translate.source import Block


@dataclass(frozen=True, slots=True, eq=False)
class Line:
    """A line of a page.

    Parameters
    ----------
    number : int
        Number of the line in the book, from 1.
    indent : int
        Number of blank cells before the line's cells.
    cells : Cells
        Cells of the line after the indent.
    block : Block
        Block that the line is part of.
    first, after : int
        Index of the first character of the block's text on the line, and one past the last.
    """

    number: int
    indent: int
    cells: Cells
    block: Block
    first: int
    after: int

    @property
    def place(self) -> int:
        """Place of the source at which the line begins."""
        if len(self.cells):
            return int(self.cells.starts[0])
        places = self.block.text.places
        return int(places[self.first]) if self.first < places.size else max(self.cells.end - 1, 0)

    @property
    def masks(self) -> NDArray[np.uint8]:
        """Dot masks of the line from its first cell on, uint8[indent + cells]."""
        masks = np.zeros(len(self), np.uint8)
        masks[self.indent :] = self.cells.masks
        return masks

    def __len__(self) -> int:
        return self.indent + len(self.cells)

    @property
    def printed(self) -> Cells:
        """Line as it would be embossed: its indent and its cells, without their way to the text."""
        return Cells.bare(self.masks)

    @property
    def text(self) -> str:
        """Text that the line stands for; the lines of a block together are the block's text.

        White space at which a line ends belongs to that line. A character whose cells do not
        find room on one line belongs to the first of its lines.
        """
        return to_text(self.block.text.codes[self.first : self.after])

    def source(self, cell: int) -> tuple[int, int] | None:
        """Source characters of a cell as [first, one past the last); None off the text."""
        if not self.indent <= cell < len(self):
            return None
        return self.cells.source(cell - self.indent)

    def cell_of(self, character: int) -> int:
        """First cell of a source character.

        Raises
        ------
        IndexError
            If the character is not on this line.
        """
        return self.indent + self.cells.of_source(character)[0]

    def word(self, cell: int) -> str:
        """The whole word that a cell is part of, on this line or not; empty at a blank."""
        span = self.source(cell)
        if span is None:
            return ""
        at = self.block.text.index(span[0])
        text = str(self.block.text).replace(chr(UNICODE_BLANK), " ")
        if at >= len(text) or text[at].isspace():
            return ""
        before = text[:at].split(None)[-1:] if at and not text[at - 1].isspace() else []
        return "".join(before) + text[at:].split(None, 1)[0]


def locate(line: Line, geometry: Geometry, x_mm: float) -> int | None:
    """Cell of a line at a place on the surface; None if there is none.

    Parameters
    ----------
    x_mm
        Place on the surface: for a column of actuators, the carriage's position plus the column's
        offset. The space after a cell counts as the cell's.
    """
    cell = math.floor(x_mm / geometry.cell_pitch_mm)
    return cell if 0 <= cell < len(line) else None


def place_of(cell: int, geometry: Geometry) -> float:
    """Middle of a cell of a line on the surface, in mm; `locate` finds the cell there."""
    middle = (geometry.dot_spacing_mm + geometry.dot_width_mm) / 2
    return cell * geometry.cell_pitch_mm + min(middle, geometry.cell_pitch_mm / 2)
