"""Cells on a virtual page: wrapped into lines, and which cell is where."""

from __future__ import annotations

import math
from array import array
from bisect import bisect_right
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vbraille.translate.cells import Cells
from vbraille.translate.paragraphs import NO_BREAK_SPACE, to_text

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from vbraille.geometry import Geometry
    from vbraille.translate.book import Book
    from vbraille.translate.paragraphs import Paragraph

INDENT = 2
_REMEMBERED = 16  # paragraphs
_SOLID = 0xFF  # in a search for blanks: a cell at which a line must not break


@dataclass(frozen=True, slots=True, eq=False)
class Line:
    """A line of a page.

    Parameters
    ----------
    number : int
        Its number in the book, from 1.
    indent : int
        Blank cells before the first.
    cells : Cells
        What it shows after them.
    paragraph : Paragraph
        The text it is part of.
    """

    number: int
    indent: int
    cells: Cells
    paragraph: Paragraph

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
        """The line as it would be embossed: its indent and its cells, without the way back."""
        return Cells.bare(self.masks)

    @property
    def text(self) -> str:
        """The text that the line stands for."""
        if not len(self.cells):
            return ""
        return self._between(int(self.cells.starts[0]), self.cells.end).strip()

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
        at = int(np.searchsorted(self.paragraph.source, span[0]))
        text = self.paragraph.text
        if at >= len(text) or text[at].isspace():
            return ""
        before = text[:at].split(None)[-1:] if at and not text[at - 1].isspace() else []
        return "".join(before) + text[at:].split(None, 1)[0]

    def _between(self, first: int, end: int) -> str:
        low, high = np.searchsorted(self.paragraph.source, (first, end))
        return to_text(self.paragraph.codes[low:high])


class Layout:
    """A book laid out in lines of a width, only as far as somebody looks.

    Words wrap whole; a paragraph begins with an indent of two cells; a word
    that is longer than a line is cut and goes on in the next. With the lines of
    the source kept, each begins at the margin and what runs over is indented.

    Parameters
    ----------
    book
        The cells.
    width
        Cells a line, at least 1.

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
        indent = INDENT if width > 2 * INDENT else 0
        self._indents = (0, indent) if book.document.keep_lines else (indent, 0)
        # Number of lines before each paragraph; the last entry is of the paragraph to come.
        self._before = array("q", [0])
        # Where a long paragraph comes in pieces: its unfinished line, by the next piece.
        self._carried: dict[int, tuple[int, Paragraph, Cells]] = {}
        self._complete = False
        self._recent: dict[int, _Laid] = {}

    def line(self, number: int) -> Line | None:
        """Line of a number, from 1; None past the end."""
        while number > self._before[-1] and not self._complete:
            self._extend()
        if not 0 < number <= self._before[-1]:
            return None
        paragraph = bisect_right(self._before, number - 1) - 1
        return self._line(paragraph, number - 1 - self._before[paragraph])

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
        """Lines in all; lays out the whole book."""
        while not self._complete:
            self._extend()
        return self._before[-1]

    def place(self, character: int) -> tuple[Line, int] | None:
        """Line and cell that a source character is on; None past the end.

        A character that no cell stands for, such as a blank at a wrap, gives
        the next cell after it.
        """
        paragraph = self.book.document.paragraph_at(character)
        while paragraph is not None:
            while paragraph >= len(self._before) - 1 and not self._complete:
                self._extend()
            if paragraph >= len(self._before) - 1:
                return None
            for n in range(self._before[paragraph + 1] - self._before[paragraph]):
                line = self._line(paragraph, n)
                if len(line.cells) and character < line.cells.end:
                    return line, line.cell_of(max(character, int(line.cells.starts[0])))
            paragraph += 1
        return None

    def progress(self, line: Line) -> float:
        """About how much of the book stands before a line, 0 to 1."""
        return self.book.document.progress(bisect_right(self._before, line.number - 1) - 1)

    def _extend(self) -> None:
        """Lay out the next paragraph."""
        laid = self._lay_out(len(self._before) - 1)
        if laid is None:
            self._complete = True
        else:
            self._before.append(self._before[-1] + len(laid.bounds))

    def _line(self, paragraph: int, index: int) -> Line:
        laid = self._lay_out(paragraph)
        assert laid is not None, "only paragraphs already laid out are asked for"
        start, stop, indent = laid.bounds[index]
        number = self._before[paragraph] + index + 1
        return Line(number, indent, laid.cells[start:stop], laid.paragraph)

    def _lay_out(self, number: int) -> _Laid | None:
        """Break a paragraph, or a piece of one, into lines; None past the end."""
        laid = self._recent.get(number)
        if laid is not None:
            return laid
        found = self.book.paragraph(number)
        if found is None:
            return None
        paragraph, cells = found
        indent, runover = self._indents
        if paragraph.continues:
            indent, before, carried = self._carried[number]
            paragraph, cells = before + paragraph, carried + cells
        bounds = wrap(_breaks(paragraph, cells), self.width, indent, runover)
        following = self.book.document.paragraph(number + 1)
        if following is None or not following.continues:
            if paragraph.continues and bounds == [(0, 0, 0)]:
                bounds = []  # nothing but blanks after the last piece
        else:
            start, stop, first = bounds.pop()
            if start == stop:  # blank so far
                start, first = len(cells), indent
            elif stop < len(cells):  # the blanks after it have filled it
                bounds.append((start, stop, first))
                start, first = len(cells), runover
            self._carried[number + 1] = first, *_rest(paragraph, cells, start)
        if len(self._recent) >= _REMEMBERED:
            del self._recent[next(iter(self._recent))]
        laid = self._recent[number] = _Laid(paragraph, cells, bounds)
        return laid


class _Laid(NamedTuple):
    """A paragraph in lines: of each its first cell, one past its last, and its indent."""

    paragraph: Paragraph
    cells: Cells
    bounds: list[tuple[int, int, int]]


def _rest(paragraph: Paragraph, cells: Cells, start: int) -> tuple[Paragraph, Cells]:
    """A paragraph from one of its cells on; keeps nothing of what is before in memory."""
    character = int(cells.starts[start]) if start < len(cells) else paragraph.end
    rest = Cells(cells.masks[start:].copy(), cells.starts[start:].copy(), cells.end)
    return paragraph.since(character), rest


def _breaks(paragraph: Paragraph, cells: Cells) -> bytes:
    """Cells as bytes: zero where a line may break, which is at blanks but for no-break spaces."""
    if NO_BREAK_SPACE not in paragraph.alphabet:
        return cells.masks.tobytes()
    no_break = paragraph.source[paragraph.codes == NO_BREAK_SPACE]
    solid = np.isin(cells.starts, no_break) & (cells.masks == 0)
    return np.where(solid, _SOLID, cells.masks).astype(np.uint8).tobytes()


def wrap(
    breaks: bytes, width: int, indent: int = 0, runover: int = 0
) -> list[tuple[int, int, int]]:
    """Break a paragraph into lines, each as full as it can be.

    Parameters
    ----------
    breaks
        A byte a cell, zero where a line may break; what stands at a break is dropped.
    width
        Cells a line.
    indent, runover
        Blank cells before the first line and before the others; less than the width.

    Returns
    -------
    list of (start, stop, indent)
        Cells of each line, as [start, stop), and the blank cells before them.
    """
    end = len(breaks)
    leading = end - len(breaks.lstrip(b"\0"))
    if leading == end:
        return [(0, 0, 0)]
    # Deep indents of the source's own must leave room for words: half a line, and the first whole.
    word = len(breaks[leading:].split(b"\0", 1)[0])
    start = leading - min(leading, width // 2, max(0, width - indent - word))
    bounds = []
    while end - start > width - indent:
        room = width - indent
        cut = breaks.rfind(0, start, start + room + 1)
        if cut > start:
            bounds.append((start, start + len(breaks[start:cut].rstrip(b"\0")), indent))
            start = end - len(breaks[cut:].lstrip(b"\0"))
        else:
            bounds.append((start, start + room, indent))
            start += room
        indent = runover
    if start < end:
        bounds.append((start, end, indent))
    return bounds


def locate(line: Line, geometry: Geometry, x_mm: float) -> int | None:
    """Cell of a line at a place on the surface; None if there is none.

    Parameters
    ----------
    x_mm
        The place: for an actuator column, the carriage's position plus the column's offset. The
        space after a cell counts as the cell's.
    """
    cell = math.floor(x_mm / geometry.cell_pitch_mm)
    return cell if 0 <= cell < len(line) else None


def place_of(cell: int, geometry: Geometry) -> float:
    """Middle of a cell of a line on the surface, in mm; `locate` takes it back."""
    middle = (geometry.dot_spacing_mm + geometry.dot_width_mm) / 2
    return cell * geometry.cell_pitch_mm + min(middle, geometry.cell_pitch_mm / 2)
