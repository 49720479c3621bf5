"""Lines of a book on a virtual page: its blocks broken into them, made as they are asked for."""

from __future__ import annotations

import re
import unicodedata
from bisect import bisect_left, bisect_right
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import islice
from math import inf
from typing import TYPE_CHECKING

import numpy as np

from vbraille.braille.cells import UNICODE_BLANK, Cells, mask_of
from vbraille.translate import BlockKind

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from vbraille.translate import Block, Book, BrailleTable

_LINES = 1 << 20  # more than a block has
_SOLID = 0xFF  # in a search for blanks: a cell at which a line must not break
_NO_BREAK_SPACE = "\u00a0"
# Scripts that are written without spaces: Thai, Lao, Tibetan, Burmese, Khmer, kana and Han.
_SPACELESS = re.compile(
    "[\u0e01-\u0fff\u1000-\u109f\u1780-\u17ff\u3001-\u30ff\u3400-\u9fff\uff01-\uff65]"
)
_OPENING = frozenset("([{「『（《〈【〔“‘«เแโใไເແໂໃໄ")
_CLOSING = frozenset(
    ")]}」』）》〉】〕”’»,.;:!?，。、．；：！？·・ーぁぃぅぇぉっゃゅょゎァィゥェォッャュョヮ々ๆໆ។៕ៗฯ།"
)
_JOINERS = frozenset("\u17d2\u1039\u103a\u0f84\u200d")  # what stacks the next letter below

_REMEMBERED = 64  # blocks
STEP = 2  # cells of an indent
# Where a page of the printed book begins, braille books have a row of dots 3 and 6 and then the
# page's number. A whole line of them would only be a long way to the number under one finger.
_RULE = bytes([mask_of((3, 6))] * 4)
# Steps before the first line of a block and before the others; for items and quotations, beside
# those of their level.
_INDENTS = {
    BlockKind.HEADING: (2, 2),
    BlockKind.ITEM: (-1, 0),
    BlockKind.ROW: (0, 1),
    BlockKind.LINE: (0, 1),
    BlockKind.PAGE: (0, 0),
}


@dataclass(frozen=True, slots=True)
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
    cells: Cells = field(compare=False)
    first: int
    after: int

    @property
    def id(self) -> int:
        """Number that no other line of the layout has, above 0; growing along the book."""
        return self.block.number * _LINES + self.index + 1

    @property
    def place(self) -> int:
        """Place of the source at which the line begins."""
        return self.block.start + self.first

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

    def word(self, cell: int) -> str:
        """The whole word that a cell is part of, on this line or not; empty at a blank."""
        span = self.source(cell)
        if span is None:
            return ""
        at, text = span[0] - self.block.start, self.block.text.replace(chr(UNICODE_BLANK), " ")
        words = re.finditer(r"\S+", text)
        return next((word[0] for word in words if word.start() <= at < word.end()), "")


def wrap(
    block: Block,
    cells: Cells,
    width: int,
    indents: tuple[int, int] = (0, 0),
    table: BrailleTable | None = None,
) -> list[Line]:
    """Break a block into lines.

    A word is cut only where it is longer than a line, and a text without spaces only where a line
    may begin; the cells of one character stay together, unless there are more than a line has.

    Parameters
    ----------
    block, cells
        The block, and its cells.
    width
        Number of cells in a line.
    indents
        Numbers of blank cells before the first line and before the others; less than the width.
    table
        Table that has the cells at which a word is cut; None where words are cut without a sign.
    """
    text, (indent, runover) = block.text, indents
    places = (cells.starts - block.start).tolist()
    solid = bytes(
        mask or _SOLID * (text[place] == _NO_BREAK_SPACE)
        for mask, place in zip(cells.masks.tolist(), places, strict=True)
    )
    ends, end = _ends(solid, places, text), len(solid.rstrip(b"\0"))
    # Deep indents of the source's own must leave room for words: half a line, and the first whole.
    leading = end - len(solid[:end].lstrip(b"\0"))
    word = len(solid[leading:].split(b"\0", 1)[0])
    start = leading - min(leading, width // 2, max(0, width - indent - word))
    lines: list[Line] = []
    first, before = 0, b""
    while start < end or not lines:
        full = max(start + width - indent - len(before), start + 1)
        last = bisect_right(ends, (full, end)) - 1
        stop, following = ends[last] if last >= 0 else (start, start)
        after, begin = b"", b""
        if end <= full:
            stop = following = full
        elif stop <= start:
            cut = full - (table is not None and full - start > 2)
            stop = bisect_left(places, places[cut], start, cut)  # where a character begins
            stop = stop if stop > start else cut
            if table is not None and stop < full and places[stop - 1] != places[stop]:
                after, begin = table.divide(text, places[stop])
            following = end - len(solid[stop:end].lstrip(b"\0"))
        own = cells[start:stop]
        to = len(text) if following >= end else own.end - block.start
        while to < len(text) and text[to].isspace():
            to += 1
        lines.append(Line(block, len(lines), indent, _signed(own, before, after), first, to))
        first, start, indent, before = to, following, runover, begin
    return lines


def _ends(solid: bytes, places: Sequence[int], text: str) -> list[tuple[int, int]]:
    """Places where a line may end: one past its last cell, and the cell where the next begins."""
    ends, stop = [], 0
    is_spaceless = _SPACELESS.search(text) is not None
    for at in (cell for cell, mask in enumerate(solid) if mask):
        is_blank = stop < at
        is_apart = stop and places[stop - 1] != places[at] and (is_blank or is_spaceless)
        if is_apart and _may_begin(text[places[at] - 1], text[places[at]], is_blank):
            ends.append((stop, at))
        stop = at + 1
    return ends


def _may_begin(before: str, after: str, is_blank: bool) -> bool:
    """Tell whether a line may begin between two characters, which may have a blank between."""
    if is_blank:  # which is the table's own before a closing mark
        return before.isspace() or after not in _CLOSING
    is_mark = unicodedata.category(after)[0] == "M"
    is_bound = is_mark or after in _CLOSING or before in _OPENING or before in _JOINERS
    return not is_bound and _SPACELESS.search(before + after) is not None


def _signed(cells: Cells, before: bytes, after: bytes = b"") -> Cells:
    """Cells between others that stand for the nearest of their places."""
    masks = np.frombuffer(before + cells.masks.tobytes() + after, np.uint8)
    starts = np.pad(cells.starts, (len(before), len(after)), mode="edge")
    return Cells(masks, starts, cells.end)


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
        last = self.book.source.block_at(len(self.book.source.text))
        return None if last is None else next(self._lines_from(last.number, -1), None)

    def beside(self, line: Line, step: int = 1) -> Line | None:
        """Line that is some steps after another, or before it with a step below 0; None past it."""
        way = 1 if step > 0 else -1
        at = self._lines(line.block)[::way].index(line) + abs(step)
        return next(islice(self._lines_from(line.block.number, way), at, None), None)

    def place(self, place: int) -> tuple[Line, int] | None:
        """Line and cell that a place of the source is on; None past the end.

        A character that no cell stands for, such as a blank at a wrap, gives the next cell
        after it.
        """
        block = self.book.source.block_at(place)
        for line in () if block is None else self._lines_from(block.number):
            cells, cell = line.cells, 0
            if place < cells.end or (not len(cells) and place <= line.place):
                if len(cells):
                    cell, _ = cells.of_source(max(place, int(cells.starts[0])))
                return line, line.indent + cell
        return None

    def line(self, number: int) -> Line | None:
        """Line of a number, from 1, counted from the start; None past either end."""
        return next(self.lines(number), None) if number > 0 else None

    def lines(self, first: int = 1, last: int | None = None) -> Iterator[Line]:
        """Lines of a range of numbers, both ends included."""
        before = self._count(lines=first)
        at = bisect_left(before, first) - 1
        stop = None if last is None else max(last, first - 1) - before[at]
        yield from islice(self._lines_from(at), first - 1 - before[at], stop)

    def number(self, line: Line) -> int:
        """Number of a line, from 1, counted from the start."""
        return self._count(blocks=line.block.number)[line.block.number] + line.index + 1

    @property
    def counted(self) -> int:
        """Number of blocks whose lines are counted, from the first on."""
        return len(self._before) - 1

    def count_on(self, blocks: int) -> None:
        """Count the lines of some more blocks."""
        self._count(blocks=self.counted + blocks)

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

    def _lines_from(self, number: int, way: int = 1) -> Iterator[Line]:
        """Lines from the first of a block on, or back from its last."""
        for block in self.book.source.blocks(number, way):
            yield from self._lines(block)[::way]

    def _lay_out(self, block: Block) -> list[Line]:
        cells = self.book.cells(block)
        if block.kind is BlockKind.PAGE:
            if block.cells is not None or not len(cells):
                return []  # the page has no number
            cells = _signed(cells, _RULE[: max(self.width - len(cells), 0)])
        # Indents are less than half of a line, so that there is room for words.
        most = (self.width - 1) // (2 * STEP) * STEP
        first, others = _INDENTS.get(block.kind, (1, 0))
        first = others if block.continues else first
        depth = 0 if block.kind is BlockKind.HEADING else block.level
        indents = min((first + depth) * STEP, most), min((others + depth) * STEP, most)
        table = self.book.table if block.cells is None else None  # ready cells are cut as they are
        return wrap(block, cells, self.width, indents, table)
