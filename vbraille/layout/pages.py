"""Cells on a virtual page: wrapped into lines, and which cell is where."""

from __future__ import annotations

import math
from array import array
from bisect import bisect_right
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vbraille.braille.cells import Cells
from vbraille.layout.wrapping import breaks_of, wrap
from vbraille.translate.documents.paragraphs import to_text

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from vbraille.braille.geometry import Geometry
    from vbraille.translate.book import Book
    from vbraille.translate.documents.paragraphs import Paragraph

INDENT = 2
_REMEMBERED = 16  # paragraphs


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
    first, after : int
        The first of the paragraph's characters that it stands for, and one past the last.
    """

    number: int
    indent: int
    cells: Cells
    paragraph: Paragraph
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
        """The line as it would be embossed: its indent and its cells, without the way back."""
        return Cells.bare(self.masks)

    @property
    def text(self) -> str:
        """The text that the line stands for; the lines of a paragraph together are its text.

        White space at which a line ends belongs to that line. A character whose cells do not
        find room on one line belongs to the first of its lines.
        """
        return to_text(self.paragraph.codes[self.first : self.after])

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


class Layout:
    """A book laid out in lines of a width, only as far as somebody looks.

    Words wrap whole; a paragraph begins with an indent of two cells; a word
    that is longer than a line is cut between two of its characters and goes on
    in the next. With the lines of the source kept, each begins at the margin
    and what runs over is indented.

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
        self._carried: dict[int, _Carried] = {}
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
        first, after = laid.edges[index : index + 2]
        return Line(number, indent, laid.cells[start:stop], laid.paragraph, first, after)

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
        first = 0
        if paragraph.continues:
            carried = self._carried[number]
            indent = carried.indent
            paragraph, cells = carried.paragraph + paragraph, carried.cells + cells
            first = int(np.searchsorted(paragraph.source, carried.character))
        breaks = breaks_of(paragraph, cells)
        bounds = wrap(breaks, self.width, indent, runover, cells.starts.data)
        laid = _Laid(paragraph, cells, bounds, first)
        following = self.book.document.paragraph(number + 1)
        if following is None or not following.continues:
            if paragraph.continues and bounds == [(0, 0, 0)]:
                bounds.clear()  # nothing but blanks after the last piece
        else:
            start, stop, its_indent = bounds.pop()
            if start == stop:  # blank so far
                start, its_indent = len(cells), indent
            elif stop < len(cells):  # the blanks after it have filled it
                bounds.append((start, stop, its_indent))
                start, its_indent = len(cells), runover
            laid.rest = start
            self._carried[number + 1] = _carry(laid, start, its_indent)
        if len(self._recent) >= _REMEMBERED:
            del self._recent[next(iter(self._recent))]
        self._recent[number] = laid
        return laid


class _Laid:
    """A paragraph, or a piece of one, in lines.

    Parameters
    ----------
    paragraph, cells
        What is laid out.
    bounds
        Of each line the first cell, one past the last, and the indent.
    first
        The first of the paragraph's characters that no earlier piece's lines stand for.

    Attributes
    ----------
    rest : int or None
        Where the cells begin that are left for the next piece's lines.
    """

    __slots__ = ("_edges", "bounds", "cells", "first", "paragraph", "rest")

    def __init__(
        self,
        paragraph: Paragraph,
        cells: Cells,
        bounds: list[tuple[int, int, int]],
        first: int,
    ) -> None:
        self.paragraph = paragraph
        self.cells = cells
        self.bounds = bounds
        self.first = first
        self.rest: int | None = None
        self._edges: list[int] | None = None

    @property
    def edges(self) -> list[int]:
        """Index of the character at which each line begins, and one past the last line's."""
        if self._edges is None:
            starts = [start for start, _, _ in self.bounds[1:]]
            starts += [] if self.rest is None or not self.bounds else [self.rest]
            after = [stop for _, stop, _ in self.bounds]
            edges = [self._edge(start, stop) for start, stop in zip(starts, after, strict=False)]
            self._edges = [self.first, *edges]
            if len(edges) < max(len(self.bounds), 1):
                self._edges.append(self.paragraph.codes.size)
        return self._edges

    def _edge(self, start: int, stop: int) -> int:
        """Where a line's text begins: the line has its cells from `start`, the last to `stop`."""
        codes, starts = self.paragraph.codes, self.cells.starts
        if start == starts.size:
            return codes.size
        character = int(starts[start])
        if stop and starts[stop - 1] == character:  # its text is on the line before
            character = self.cells.source(start)[1]
        at = int(np.searchsorted(self.paragraph.source, character))
        while at < codes.size and chr(codes[at]).isspace():
            at += 1
        return at


class _Carried(NamedTuple):
    """A paragraph's unfinished line, for its next piece, and the first character of its text."""

    indent: int
    paragraph: Paragraph
    cells: Cells
    character: int


def _carry(laid: _Laid, start: int, indent: int) -> _Carried:
    """A paragraph from one of its cells on; keeps nothing of what is before in memory."""
    paragraph, cells = laid.paragraph, laid.cells
    first, text = int(cells.starts[start]) if start < len(cells) else paragraph.end, laid.edges[-1]
    character = int(paragraph.source[text]) if text < paragraph.source.size else paragraph.end
    rest = Cells(cells.masks[start:].copy(), cells.starts[start:].copy(), cells.end)
    return _Carried(indent, paragraph.since(first), rest, character)


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
