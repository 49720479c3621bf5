"""Answers to what is asked of a whole book, a step at a time."""

from __future__ import annotations

from typing import TYPE_CHECKING

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
from vbraille.reading.seeking.extent import block_at_share, extended, known_blocks
from vbraille.reading.seeking.finding import find_text
from vbraille.translate.book import Book
from vbraille.translate.documents.document import Document
from vbraille.translate.source import BlockKind, MarkKind

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.reading.queries import Answer, Query
    from vbraille.translate.source import Block, Source

LINK = "link"
_NOT_PLAIN = frozenset(kind.value for kind in BlockKind) - {"paragraph", "line"} | {LINK}
_STEP = 64  # blocks that are looked at before it is told how far that is


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
    number = query.block
    while True:
        number += -1 if query.backward else 1
        block = source.block(number)
        if block is None:
            yield NotFound()
            return
        if _is_wanted(block, query):
            break
        if number % _STEP == 0:
            yield Searched(source.progress(number))
    if query.backward and query.group:
        while (before := source.block(number - 1)) is not None and before.group == block.group:
            number, block = number - 1, before
    yield Found(_place(block, query), source.index())


def _is_wanted(block: Block, query: FindKind) -> bool:
    if query.kind == LINK:
        return any(mark.kind is MarkKind.LINK for mark in block.marks)
    return (
        block.kind.value == query.kind
        and not block.continues
        and not (query.level and block.level > query.level)
        and not (query.group and block.group == query.group)
    )


def _place(block: Block, query: FindKind) -> int:
    if query.kind == LINK:
        links = [mark.start for mark in block.marks if mark.kind is MarkKind.LINK]
        return links[-1 if query.backward else 0]
    return place_of_block(block)


def place_of_block(block: Block) -> int:
    """Place of the source at which a block begins."""
    return int(block.text.places[0]) if len(block.text) else max(block.text.end - 1, 0)


def _find_share(source: Source, share: float) -> Iterator[Answer]:
    yield from map(Searched, extended(source, share))
    number = block_at_share(source, share)
    block = source.block(number)
    while block is not None and block.continues and number:
        number -= 1
        block = source.block(number)
    yield NotFound() if block is None else Found(place_of_block(block), source.index())


def _find_page(source: Source, label: str) -> Iterator[Answer]:
    if isinstance(source, Document):
        yield NotFound()
        return
    wanted = label.strip().casefold()
    number = 0
    while (block := source.block(number)) is not None:
        if block.kind is BlockKind.PAGE and str(block.text).strip().casefold() == wanted:
            yield Found(place_of_block(block), source.index())
            return
        number += 1
        if number % _STEP == 0:
            yield Searched(source.progress(min(number, known_blocks(source))))
    yield NotFound()
