"""How many lines stand before a block, counted as far as somebody asks."""

from __future__ import annotations

from array import array
from bisect import bisect_right
from typing import TYPE_CHECKING

from vbraille.layout.blocks import LaidBlock
from vbraille.layout.runs import LaidRun
from vbraille.reading.queries import Counted, Found, NotFound, Searched
from vbraille.reading.seeking.kinds import first_place

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.layout.blocks import Carried
    from vbraille.reading.queries import Answer
    from vbraille.translate.book import Book


class LineCounts:
    """Numbers of lines before the blocks of a book, at a width; never counted twice.

    Parameters
    ----------
    book
        Book with the table that it is read by.
    width
        Number of cells in a line.
    """

    def __init__(self, book: Book, width: int) -> None:
        self._book = book
        self._width = width
        self._before = array("q", [0])
        self._carried: Carried | None = None

    def count(self, block: int) -> Iterator[Answer]:
        """Count up to a block, and tell after each block how far that is; then the number."""
        while len(self._before) <= block and self._lay_out_next():
            yield Searched((len(self._before) - 1) / max(block, 1))
        lines = self._before[min(block, len(self._before) - 1)]
        yield Counted(lines, self._book.source.index(), self._width, block)

    def find(self, line: int) -> Iterator[Answer]:
        """Count up to a line, and tell after each block how far that is; then where it begins."""
        while self._before[-1] < line and self._lay_out_next():
            yield Searched(min(self._before[-1] / line, 1.0))
        if not 1 <= line <= self._before[-1]:
            yield NotFound()
            return
        block = bisect_right(self._before, line - 1) - 1
        run = LaidRun(self._book, self._width, block, self._before[block])
        found = run.line(line)
        if found is None:  # a piece of a very long paragraph, entered in its middle
            found = run.line_of(block, 0)
        cells = found.cells
        place = int(cells.starts[0]) if len(cells) else first_place(found.block)
        yield Found(place, self._book.source.index())

    def _lay_out_next(self) -> bool:
        number = len(self._before) - 1
        found = self._book.block(number)
        if found is None:
            return False
        following = self._book.source.block(number + 1)
        goes_on = following is not None and following.continues
        carried = self._carried if found[0].continues else None
        laid = LaidBlock(*found, self._width, carried, goes_on=goes_on)
        self._carried = laid.carries
        self._before.append(self._before[-1] + len(laid.bounds))
        return True
