"""Lines of a book on a virtual page, made block by block as they are asked for."""

from __future__ import annotations

from bisect import bisect_left
from functools import lru_cache
from itertools import islice
from math import inf
from typing import TYPE_CHECKING

from vbraille.braille.cells import mask_of
from vbraille.errors import InputError
from vbraille.layout.lines import Line, wrap
from vbraille.translate import Block, BlockKind, Book, text_source

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.braille.geometry import Geometry
    from vbraille.display import Display
    from vbraille.translate import BrailleTable

_REMEMBERED = 64  # blocks
STEP = 2  # cells of an indent
# Where a page of the printed book begins, braille books have a row of dots 3 and 6 and then the
# page's number. A whole line of them would only be a long way to the number under one finger.
_RULE = bytes([mask_of((3, 6))] * 4)
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
    """Lines of a book.

    Parameters
    ----------
    book
        Cells of the book.
    width
        Number of cells in a line.
    """

    def __init__(self, book: Book, width: int) -> None:
        self.book, self.width = book, width
        self._lines = lru_cache(_REMEMBERED)(self._lay_out)
        self._before = [0]  # numbers of lines before each block, as far as counted

    def last(self) -> Line | None:
        """Last line of the book; None if it has none. All of the book is read, but not laid out."""
        source = self.book.source
        last = source.block_at(len(source.text))
        return None if last is None else next(self._lines_from(last, -1), None)

    def beside(self, line: Line, step: int = 1) -> Line | None:
        """Line that is some steps after another, or before it with a step below 0; None past it."""
        way = 1 if step > 0 else -1
        index = line.index if way > 0 else len(self._lines(line.block)) - 1 - line.index
        return next(islice(self._lines_from(line.block, way), index + abs(step), None), None)

    def place(self, place: int) -> tuple[Line, int] | None:
        """Line and cell that a place of the source is on; None past the end.

        A character that no cell stands for, such as a blank at a wrap, gives the next cell
        after it.
        """
        block = self.book.source.block_at(place)
        for line in () if block is None else self._lines_from(block):
            cells = line.cells
            if len(cells) and place < cells.end:
                return line, line.indent + cells.of_source(max(place, int(cells.starts[0])))[0]
            if not len(cells) and place <= line.place:
                return line, 0
        return None

    def progress(self, line: Line) -> float:
        """Tell how much of the book stands before a line, 0 to 1."""
        return self.book.source.progress(line.place)

    def line(self, number: int) -> Line | None:
        """Line of a number, from 1, counted from the start; None past either end."""
        before = self._count(lines=number)
        at = bisect_left(before, number) - 1
        block = self.book.source.block(at) if number <= before[-1] else None
        return None if block is None else self._lines(block)[number - 1 - before[at]]

    def lines(self, first: int = 1, last: int | None = None) -> Iterator[Line]:
        """Lines of a range of numbers, both ends included."""
        begin = self.line(first)
        if begin is not None:
            stop = None if last is None else begin.index + max(last - first + 1, 0)
            yield from islice(self._lines_from(begin.block), begin.index, stop)

    def number(self, line: Line) -> int:
        """Number of a line, from 1, counted from the start."""
        return self._count(blocks=line.block.number)[line.block.number] + line.index + 1

    def count(self) -> int:
        """Number of lines in all; this lays out the whole book."""
        return self._count()[-1]

    def _count(self, lines: float = inf, blocks: float = inf) -> list[int]:
        """Numbers of lines before each block, as far as that many lines or blocks need it."""
        before = self._before
        for block in self.book.source.blocks(len(before) - 1):
            if before[-1] >= lines or len(before) > blocks:
                break
            before.append(before[-1] + len(self._lines(block)))
        return before

    def _lines_from(self, block: Block, way: int = 1) -> Iterator[Line]:
        """Lines from the first of a block on, or back from its last."""
        for each in self.book.source.blocks(block.number, way):
            yield from self._lines(each)[::way]

    def _lay_out(self, block: Block) -> list[Line]:
        cells, before = self.book.cells(block), b""
        if block.kind is BlockKind.PAGE:
            if block.cells is not None or not len(cells):
                return []  # the page has no number
            before = _RULE[: max(self.width - len(cells), 0)]
        table = self.book.table if block.cells is None else None  # ready cells are cut as they are
        return wrap(block, cells, self.width, indents(block, self.width), table, before)


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
    lines = wrap(Block(words), cells, width or max(len(cells), 1))
    return [line.masks.tobytes() for line in lines]
