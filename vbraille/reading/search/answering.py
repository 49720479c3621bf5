"""Answers to what is asked of a whole book, a step at a time: the one way to look, near or far."""

from __future__ import annotations

from array import array
from bisect import bisect_right
from typing import TYPE_CHECKING

from vbraille.layout.blocks import LaidBlock
from vbraille.layout.runs import LaidRun
from vbraille.reading.search.queries import (
    Counted,
    CountLines,
    Failed,
    FindKind,
    FindLine,
    FindPage,
    FindShare,
    FindText,
    Found,
    Indexed,
    Listed,
    ListedHeading,
    ListHeadings,
    NotFound,
    Searched,
)
from vbraille.reading.search.structure import (
    extended,
    find_kind,
    find_page,
    find_share,
    first_place,
    list_headings,
)
from vbraille.reading.search.text import find_text
from vbraille.translate.book import Book

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.layout.blocks import Carried
    from vbraille.reading.search.queries import Answer, Query
    from vbraille.translate.source import Source

Place = FindText | FindKind | FindShare | FindPage | ListHeadings
Hit = int | tuple[ListedHeading, ...]


def steps(source: Source, query: Place, *, near: bool = False) -> Iterator[Hit | float]:
    """Look for a place in a source, or for its headings.

    Parameters
    ----------
    near
        Whether the steps are to be small, since somebody waits for them and will not take many.

    Yields
    ------
    int, float or tuple
        About how much of the work is done, 0 to 1, as floats; then the place of the source that
        was found, if any, or the headings.

    Raises
    ------
    InputError
        If the source cannot be read any more.
    """
    match query:
        case FindText():
            return find_text(source, query, near=near)
        case FindKind():
            return find_kind(source, query)
        case FindShare():
            return find_share(source, query.share)
        case FindPage():
            return find_page(source, query.label)
        case ListHeadings():
            return list_headings(source)


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


class Answering:
    """Answers of one book; what was found out for one question helps with the next.

    Parameters
    ----------
    book
        Book that is asked about. Only to count lines it needs its table.
    """

    def __init__(self, book: Book) -> None:
        self.book = book
        self._counts: dict[int, LineCounts] = {}

    def answer(self, query: Query) -> Iterator[Answer]:
        """Answer a question: `Searched` any number of times, then something else, once.

        The work goes on only while somebody takes the answers.

        Raises
        ------
        VbrailleError
            If the book cannot be read any more.
        """
        match query:
            case CountLines():
                return self._lines(query.width).count(query.block)
            case FindLine():
                return self._find_line(query)
        return _find(self.book.source, query)

    def _lines(self, width: int) -> LineCounts:
        if width not in self._counts:
            self._counts[width] = LineCounts(self.book, width)
        return self._counts[width]

    def _find_line(self, query: FindLine) -> Iterator[Answer]:
        table = "" if self.book.table is None else self.book.table.name
        if query.table == table:
            yield from self._lines(query.width).find(query.line)
        else:
            by = table or "the file's own cells"
            yield Failed(f"lines are counted by {by} only; type percent as in 40%")

    def index(self) -> Iterator[Answer]:
        """Find out where all blocks are: `Searched` any number of times, then `Indexed`."""
        yield from map(Searched, extended(self.book.source))
        yield Indexed(self.book.source.index())


def answer(book: Book | Source, query: Query) -> Iterator[Answer]:
    """Answer a question on a book in this process; see `Answering.answer`."""
    return Answering(book if isinstance(book, Book) else Book(book)).answer(query)


def _find(source: Source, query: Place) -> Iterator[Answer]:
    for step in steps(source, query):
        if isinstance(step, float):
            yield Searched(step)
        else:
            index = source.index()
            yield Found(step, index) if isinstance(step, int) else Listed(step, index)
            return
    yield NotFound()
