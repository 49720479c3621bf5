"""Lines of a virtual page: each knows its block, its place in it, and the text it stands for."""

from __future__ import annotations

import re
from bisect import bisect_right
from dataclasses import dataclass
from functools import lru_cache, partial
from itertools import islice
from typing import TYPE_CHECKING

import numpy as np

from vbraille.braille.cells import UNICODE_BLANK, Cells, mask_of
from vbraille.errors import InputError
from vbraille.layout.wrapping import Piece, wrap
from vbraille.translate import BlockKind, Book, text_source

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from vbraille.braille.geometry import Geometry
    from vbraille.display import Display
    from vbraille.translate import Block, BrailleTable

_REMEMBERED = 64  # blocks
_LINES = 1 << 20  # more than a block has
STEP = 2  # cells of an indent
# Where a page of the printed book begins, braille books have a row of dots 3 and 6 and then the
# page's number. A whole line of them would only be a long way to the number under one finger.
_RULE = bytes([mask_of((3, 6))] * 4)


@dataclass(frozen=True, slots=True, eq=False)
class Line:
    """A line of a page.

    Parameters
    ----------
    block : Block
        Block that the line is part of.
    index : int
        Which line of its block it is, from 0.
    indent : int
        Number of blank cells before the line's cells.
    cells : Cells
        Cells of the line after the indent; they stand for places in the source.
    first, after : int
        Index of the first character of the block's text on the line, and one past the last.
    """

    block: Block
    index: int
    indent: int
    cells: Cells
    first: int
    after: int

    @property
    def id(self) -> int:
        """Number that no other line of the layout has, above 0; growing along the book."""
        return self.block.number * _LINES + self.index + 1

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Line) and self.id == other.id

    def __hash__(self) -> int:
        return self.id

    @property
    def place(self) -> int:
        """Place of the source at which the line begins."""
        return int(self.cells.starts[0]) if len(self.cells) else self.block.start + self.first

    @property
    def end(self) -> int:
        """Place one past the line's text."""
        return self.block.start + self.after

    @property
    def masks(self) -> NDArray[np.uint8]:
        """Dot masks of the line from its first cell on, uint8[indent + cells]."""
        return np.concatenate((np.zeros(self.indent, np.uint8), self.cells.masks))

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
        return self.block.text[self.first : self.after]

    def source(self, cell: int) -> tuple[int, int] | None:
        """Places of the text of a cell as [first, one past the last); None off the text."""
        if not self.indent <= cell < len(self):
            return None
        return self.cells.source(cell - self.indent)

    def cell_of(self, place: int) -> int:
        """First cell of a character at a place.

        Raises
        ------
        IndexError
            If the character is not on this line.
        """
        return self.indent + self.cells.of_source(place)[0]

    def word(self, cell: int) -> str:
        """The whole word that a cell is part of, on this line or not; empty at a blank."""
        span = self.source(cell)
        at = -1 if span is None else span[0] - self.block.start
        text = self.block.text.replace(chr(UNICODE_BLANK), " ")
        words = (found for found in re.finditer(r"\S+", text) if found.end() > at >= found.start())
        return next((found[0] for found in words), "")


# Steps before the first line of a block and before the others; for items and quotations, beside
# those of their level.
_INDENTS = {
    BlockKind.PARAGRAPH: (1, 0),
    BlockKind.NOTE: (1, 0),
    BlockKind.HEADING: (2, 2),
    BlockKind.ITEM: (-1, 0),
    BlockKind.QUOTE: (1, 0),
    BlockKind.ROW: (0, 1),
    BlockKind.LINE: (0, 1),
    BlockKind.PAGE: (0, 0),
}


def indents(block: Block, width: int) -> tuple[int, int]:
    """Numbers of blank cells before a block's first line and before its other lines.

    They are less than half of a line, so that there is room for words: a larger indent of the
    kind is cut to the largest even number of cells that is.

    Parameters
    ----------
    width
        Number of cells in a line.
    """
    first, others = _INDENTS[block.kind]
    depth = block.level if block.kind in (BlockKind.ITEM, BlockKind.QUOTE) else 0
    first = others if block.continues else first
    most = (width - 1) // (2 * STEP) * STEP
    return min((first + depth) * STEP, most), min((others + depth) * STEP, most)


class Layout:
    """Lines of a book, made block by block as they are asked for.

    Parameters
    ----------
    book
        Cells of the book.
    width
        Number of cells in a line.
    """

    def __init__(self, book: Book, width: int) -> None:
        self.book, self.width = book, width
        self._lines = lru_cache(_REMEMBERED)(lambda block: lay_out(block, book, width))
        self._before = [0]  # numbers of lines before each block, as far as counted

    def first(self) -> Line | None:
        """First line of the book; None if it has none."""
        return next(self._lines_from(0, 1), None)

    def last(self) -> Line | None:
        """Last line of the book; None if it has none. All of the book is read, but not laid out."""
        last = self.book.source.block_at(len(self.book.source.text))
        return None if last is None else next(self._lines_from(last.number, -1), None)

    def beside(self, line: Line, step: int = 1) -> Line | None:
        """Line that is some steps after another, or before it with a step below 0; None past it."""
        way = 1 if step > 0 else -1
        lines = self._lines_from(line.block.number, way)
        index = line.index if way > 0 else len(self.lines_of(line.block)) - 1 - line.index
        return next(islice(lines, index + abs(step), None), None)

    def place(self, place: int) -> tuple[Line, int] | None:
        """Line and cell that a place of the source is on; None past the end.

        A character that no cell stands for, such as a blank at a wrap, gives the next cell
        after it.
        """
        block = self.book.source.block_at(place)
        if block is None:
            return None
        for line in self._lines_from(block.number, 1):
            if len(line.cells) and place < line.cells.end:
                return line, line.cell_of(max(place, line.place))
            if not len(line.cells) and line.block.number >= block.number and place <= line.place:
                return line, 0
        return None

    def progress(self, line: Line) -> float:
        """Tell how much of the book stands before a line, 0 to 1."""
        return self.book.source.progress(line.place)

    def line(self, number: int) -> Line | None:
        """Line of a number, from 1, counted from the start; None past either end."""
        while self._before[-1] < number and self._count_on():
            pass
        before = bisect_right(self._before, number - 1) - 1
        block = self.book.source.block(before) if number <= self._before[-1] else None
        return None if block is None else self.lines_of(block)[number - 1 - self._before[before]]

    def lines(self, first: int = 1, last: int | None = None) -> Iterator[Line]:
        """Lines of a range of numbers, both ends included."""
        begin = self.first() if first <= 1 else self.line(first)
        if begin is not None:
            found = islice(self._lines_from(begin.block.number, 1), begin.index, None)
            yield from islice(found, None if last is None else max(last - max(first, 1) + 1, 0))

    def number(self, line: Line) -> int:
        """Number of a line, from 1, counted from the start."""
        while len(self._before) <= line.block.number and self._count_on():
            pass
        return self._before[line.block.number] + line.index + 1

    def count(self) -> int:
        """Number of lines in all; this lays out the whole book."""
        while self._count_on():
            pass
        return self._before[-1]

    def lines_of(self, block: Block) -> list[Line]:
        """Lines of a block."""
        return self._lines(block)

    def _count_on(self) -> bool:
        """Count the lines of one more block; tell whether there was one."""
        block = self.book.source.block(len(self._before) - 1)
        if block is not None:
            self._before.append(self._before[-1] + len(self.lines_of(block)))
        return block is not None

    def _lines_from(self, number: int, way: int) -> Iterator[Line]:
        """Lines from the first of a block on, or back from its last."""
        for block in self.book.source.blocks(number, way):
            yield from self.lines_of(block)[::way]


def lay_out(block: Block, book: Book, width: int) -> list[Line]:
    """Lines of a block of a book, of a number of cells each."""
    cells = book.cells(block)
    if block.kind is BlockKind.PAGE:
        if block.cells is not None or not len(cells):
            return []  # the page has no number
        rule = np.frombuffer(_RULE[: max(width - len(cells), 0)], np.uint8)
        starts = np.concatenate((np.full(rule.size, cells.starts[0]), cells.starts))
        cells = Cells(np.concatenate((rule, cells.masks)), starts, cells.end)
    text, indent, runover = block.text, *indents(block, width)
    places = (cells.starts - block.start).tolist()
    divide = None  # what is written in cells is cut as it is
    if block.cells is None and book.table is not None:
        divide = partial(book.table.divide, text)
    pieces = wrap(cells.masks.tobytes(), places, text, width, indent, runover, divide)
    edges = [0, *(_edge(text, places, cells, piece) for piece in pieces[1:]), len(text)]
    return [
        Line(block, number, piece.indent, _cells(cells, piece), *edges[number : number + 2])
        for number, piece in enumerate(pieces)
    ]


def _edge(text: str, places: list[int], cells: Cells, piece: Piece) -> int:
    """Index at which the text of a line begins that is not the first."""
    at = places[piece.start]
    if places[piece.start - 1] == at:  # the character's text is on the line before
        at = cells.source(piece.start)[1] - int(cells.starts[piece.start]) + at
    while at < len(text) and text[at].isspace():
        at += 1
    return at


def _cells(cells: Cells, piece: Piece) -> Cells:
    """Cells of a line, with those that say that a word was cut."""
    own = cells[piece.start : piece.stop]
    if not piece.before and not piece.after:
        return own
    masks = np.frombuffer(piece.before + own.masks.tobytes() + piece.after, np.uint8)
    pad = (len(piece.before), len(piece.after))
    return Cells(masks, np.pad(own.starts, pad, mode="edge"), own.end)


def cells_per_line(geometry: Geometry, display: Display) -> int:
    """Number of cells that a line has on a display.

    Raises
    ------
    InputError
        If there is no room for a single cell.
    """
    try:
        return geometry.cells_per_line(display.span_mm)
    except ValueError as error:
        raise InputError(str(error)) from None


def lay_out_text(text: str, width: int, table: BrailleTable, *, keep_lines: bool = False) -> Layout:
    """Lay out a string.

    Parameters
    ----------
    text
        Text to lay out; blank lines separate its paragraphs.
    width
        Number of cells in a line.
    table
        Table by which the text is translated.
    keep_lines
        Whether each line of the text stays a line, at the margin; otherwise paragraphs are filled,
        each with an indent.

    Raises
    ------
    InputError
        If the text has nothing to show.
    """
    if not text.strip():
        raise InputError("the text has nothing to read in it; give some")
    return Layout(Book(text_source(text, keep_lines=keep_lines), table), width)


def wrap_text(text: str, table: BrailleTable, width: int | None = None) -> list[bytes]:
    """Dot masks of the lines of a paragraph, which is one line without a width.

    Parameters
    ----------
    text
        Text of the paragraph.
    table
        Table by which it is translated.
    width
        Number of cells in a line.
    """
    words = " ".join(text.split())
    cells = table.translate(words)
    masks = cells.masks.tobytes()
    if width is None:
        return [masks]
    return [
        masks[piece.start : piece.stop]
        for piece in wrap(masks, cells.starts.tolist(), words, width)
    ]
