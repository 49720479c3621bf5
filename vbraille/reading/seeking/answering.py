"""Answers to what is asked of a whole book, a step at a time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.reading.queries import (
    CountLines,
    Failed,
    FindLine,
    Found,
    Indexed,
    Listed,
    NotFound,
    Searched,
)
from vbraille.reading.seeking.counting import LineCounts
from vbraille.reading.seeking.extent import extended
from vbraille.reading.seeking.steps import steps
from vbraille.translate.book import Book

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.reading.queries import Answer, Query
    from vbraille.reading.seeking.steps import Place
    from vbraille.translate.source import Source


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
