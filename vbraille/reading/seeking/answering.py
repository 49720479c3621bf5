"""Answers to what is asked of a whole book, a step at a time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.reading.nearby import LINK, Reach, first_place, look
from vbraille.reading.queries import (
    CountLines,
    FindKind,
    FindPage,
    FindShare,
    FindText,
    Found,
    Indexed,
    NotFound,
    Searched,
)
from vbraille.reading.seeking.counting import LineCounts
from vbraille.reading.seeking.extent import block_at_share, extended
from vbraille.reading.seeking.finding import find_text
from vbraille.translate.book import Book
from vbraille.translate.documents.document import Document
from vbraille.translate.source import BlockKind

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.reading.queries import Answer, Query
    from vbraille.translate.source import Source

_NOT_PLAIN = frozenset(kind.value for kind in BlockKind) - {"paragraph", "line"} | {LINK}
_BLOCKS = 64  # that are looked at before it is heard whether somebody still wants to know
_STEP = Reach(_BLOCKS, 0.02)


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
        source = self.book.source
        match query:
            case FindText():
                return find_text(source, query)
            case FindKind():
                return _find_kind(source, query)
            case FindShare():
                return _find_share(source, query.share)
            case FindPage():
                return _find_page(source, query.label)
            case CountLines():
                if query.width not in self._counts:
                    self._counts[query.width] = LineCounts(self.book, query.width)
                return self._counts[query.width].count(query.block)

    def index(self) -> Iterator[Answer]:
        """Find out where all blocks are: `Searched` any number of times, then `Indexed`."""
        yield from map(Searched, extended(self.book.source))
        yield Indexed(self.book.source.index())


def answer(book: Book | Source, query: Query) -> Iterator[Answer]:
    """Answer a question on a book in this process; see `Answering.answer`."""
    return Answering(book if isinstance(book, Book) else Book(book)).answer(query)


def _find_kind(source: Source, query: FindKind) -> Iterator[Answer]:
    if isinstance(source, Document) and query.kind in _NOT_PLAIN:
        yield NotFound()  # so that nobody waits for the end of a long text
        return
    left: int | Query | None = query
    while isinstance(left, FindKind):
        left = look(source, left, _STEP)
        if isinstance(left, FindKind):
            yield Searched(source.progress(max(left.block, 0)))
    if not isinstance(left, int):
        yield NotFound()
        return
    yield Found(_group_start(source, left) if query.backward else left, source.index())


def _group_start(source: Source, place: int) -> int:
    """Place where the list or table begins that a place is in; other places stay."""
    number = source.block_at(place)
    block = None if number is None else source.block(number)
    if number is None or block is None or not block.group:
        return place
    while number and (before := source.block(number - 1)) is not None:
        if before.group != block.group or before.kind is not block.kind:
            break
        number, place = number - 1, first_place(before)
    return place


def _find_share(source: Source, share: float) -> Iterator[Answer]:
    yield from map(Searched, extended(source, share))
    number = block_at_share(source, share)
    block = source.block(number)
    while block is not None and block.continues and number:
        number -= 1
        block = source.block(number)
    yield NotFound() if block is None else Found(first_place(block), source.index())


def _find_page(source: Source, label: str) -> Iterator[Answer]:
    if isinstance(source, Document):
        yield NotFound()
        return
    wanted = label.strip().casefold()
    number = 0
    while (block := source.block(number)) is not None:
        if block.kind is BlockKind.PAGE and str(block.text).strip().casefold() == wanted:
            yield Found(first_place(block), source.index())
            return
        number += 1
        if number % _BLOCKS == 0:
            yield Searched(source.progress(number - 1))
    yield NotFound()
