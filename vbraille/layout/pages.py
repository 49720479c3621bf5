"""Cells on a virtual page: wrapped into lines, and which cell is where."""

from __future__ import annotations

import math
from array import array
from bisect import bisect_right
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vbraille.braille.cells import UNICODE_BLANK, Cells
from vbraille.layout.blocks import LaidBlock
from vbraille.translate.text import to_text

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from vbraille.braille.geometry import Geometry
    from vbraille.layout.blocks import Carried
    from vbraille.translate.book import Book
    from vbraille.translate.source import Block

_REMEMBERED = 16  # blocks


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


class Layout:
    """A book laid out in lines of a width, only as far as somebody looks.

    Words wrap whole; a word that is longer than a line is cut between two of its characters and
    goes on in the next line. The indent depends on the kind of block. A paragraph begins with two
    blank cells. A line that is kept as the source has it begins at the margin, and what runs over
    is indented.

    Parameters
    ----------
    book
        Cells of the book.
    width
        Number of cells in a line, at least 1.

    Raises
    ------
    ValueError
        If the width is below 1.
    """

    def __init__(self, book: Book, width: int) -> None:
        if width < 1:
            raise ValueError(f"width is {width} cells; it must be at least 1")
        self.book = book
        self.width = width
        # Number of lines before each block; the last entry is that of the next block.
        self._before = array("q", [0])
        # Unfinished line of a long block that comes in pieces, by the number of the next piece.
        self._carried: dict[int, Carried] = {}
        self._complete = False
        self._recent: dict[int, LaidBlock] = {}

    def line(self, number: int) -> Line | None:
        """Line of a number, from 1; None past the end."""
        while number > self._before[-1] and not self._complete:
            self._extend()
        if not 0 < number <= self._before[-1]:
            return None
        block = bisect_right(self._before, number - 1) - 1
        return self._line(block, number - 1 - self._before[block])

    def lines(self, first: int = 1, last: int | None = None) -> Iterator[Line]:
        """Lines of a range of numbers, both ends included."""
        number = max(first, 1)
        while last is None or number <= last:
            line = self.line(number)
            if line is None:
                return
            yield line
            number += 1

    def count(self) -> int:
        """Number of lines in all; this lays out the whole book."""
        while not self._complete:
            self._extend()
        return self._before[-1]

    def place(self, character: int) -> tuple[Line, int] | None:
        """Line and cell that a source character is on; None past the end.

        A character that no cell stands for, such as a blank at a wrap, gives the next cell
        after it.
        """
        block = self.book.source.block_at(character)
        while block is not None:
            while block >= len(self._before) - 1 and not self._complete:
                self._extend()
            if block >= len(self._before) - 1:
                return None
            for n in range(self._before[block + 1] - self._before[block]):
                line = self._line(block, n)
                if len(line.cells) and character < line.cells.end:
                    return line, line.cell_of(max(character, int(line.cells.starts[0])))
            block += 1
        return None

    def progress(self, line: Line) -> float:
        """About how much of the book stands before a line, 0 to 1."""
        return self.book.source.progress(bisect_right(self._before, line.number - 1) - 1)

    def _extend(self) -> None:
        """Lay out the next block."""
        laid = self._lay_out(len(self._before) - 1)
        if laid is None:
            self._complete = True
        else:
            self._before.append(self._before[-1] + len(laid.bounds))

    def _line(self, block: int, index: int) -> Line:
        laid = self._lay_out(block)
        assert laid is not None, "only blocks already laid out are asked for"
        start, stop, indent = laid.bounds[index]
        number = self._before[block] + index + 1
        first, after = laid.edges[index : index + 2]
        return Line(number, indent, laid.cells[start:stop], laid.block, first, after)

    def _lay_out(self, number: int) -> LaidBlock | None:
        """Break a block, or a piece of one, into lines; None past the end."""
        laid = self._recent.get(number)
        if laid is not None:
            return laid
        found = self.book.block(number)
        if found is None:
            return None
        following = self.book.source.block(number + 1)
        goes_on = following is not None and following.continues
        carried = self._carried[number] if found[0].continues else None
        laid = LaidBlock(*found, self.width, carried, goes_on=goes_on)
        if laid.carries is not None:
            self._carried[number + 1] = laid.carries
        if len(self._recent) >= _REMEMBERED:
            del self._recent[next(iter(self._recent))]
        self._recent[number] = laid
        return laid


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
