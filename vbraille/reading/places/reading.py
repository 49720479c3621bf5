"""What is kept of a book, as its reader has it: places are plain characters there."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.reading.places.anchoring import place_in
from vbraille.reading.places.values import Bookmark
from vbraille.reading.whereabouts import before, is_counted
from vbraille.translate.documents.document import Document
from vbraille.translate.source import BlockKind

if TYPE_CHECKING:
    from vbraille.layout.pages import Layout, Line
    from vbraille.reading.places.book import KeptBook
    from vbraille.translate.source import Block


class KeptReading:
    """What is kept of a book that is being read; it is a `vbraille.reading.beside.KeptLike`.

    Parameters
    ----------
    kept
        What is kept of the book.
    layout
        Lines of the book.
    """

    def __init__(self, kept: KeptBook, layout: Layout) -> None:
        self._kept = kept
        self._layout = layout
        self._seen: tuple[Block | None, str] = None, ""  # a block and its page

    def bookmarks(self) -> list[Bookmark]:
        """All bookmarks, by their place."""
        return self._kept.bookmarks()

    def mark(self, name: str, character: int, text: str) -> None:
        """Set a bookmark; one with the same name is moved."""
        place = place_in(self._layout.book.source, character)
        # What the reader is told of it are some words; to find it again takes more.
        self._kept.set_bookmark(Bookmark(name, character, text, place.share, place.after))

    def delete_bookmark(self, name: str) -> None:
        """Delete a bookmark."""
        self._kept.delete_bookmark(name)

    def keep(self, character: int) -> None:
        """Keep the place at which reading goes on another time."""
        layout = self._layout
        source, table = layout.book.source, layout.book.table
        found = layout.place(character)
        if found is None:
            self._kept.keep_at(source, character)
            return
        line, _ = found
        page = self._page(line)
        self._kept.keep_at(
            source,
            character,
            line=line.number if is_counted(layout) else None,
            lines_before=self._lines_before(character),
            width=layout.width,
            table="" if table is None else table.name,
            page=page,
        )

    def _page(self, line: Line) -> str:
        """Page of the printed book that a line is on; looked for once for each block."""
        if isinstance(self._layout.book.source, Document):
            return ""  # it has none, and looking would read much of it
        if self._seen[0] is not line.block:
            page = before(self._layout.book.source, line, BlockKind.PAGE)
            self._seen = line.block, "" if page is None else str(page.text).strip()
        return self._seen[1]

    def _lines_before(self, character: int) -> int | None:
        """Number of lines before the block that a character is in; None if nobody counted."""
        source = self._layout.book.source
        number = source.block_at(character)
        block = None if number is None else source.block(number)
        if block is None or not len(block.text):
            return None
        found = self._layout.place(int(block.text.places[0]))
        return found[0].number - 1 if found is not None and is_counted(self._layout) else None
