"""What is kept of one book, while it is read."""

from __future__ import annotations

import os
from contextlib import suppress
from typing import TYPE_CHECKING, Any

import msgspec

from vbraille.reading.places.place import (
    Bookmark,
    BookOptions,
    KeptPlace,
    anchored,
    book_options,
    place_in,
    storable,
)
from vbraille.translate.source import Index

if TYPE_CHECKING:
    from pathlib import Path

    from vbraille.reading.places.store import Store
    from vbraille.translate.source import Source

EVERY_S = 0.5  # a place that changes all the time is written so often
_LARGEST_TUNING = 100_000  # bytes


class KeptBook:
    """What is kept of a book: the place, bookmarks, tuning, options and the index.

    What is set is written at once, except places, which are written at most every half second.
    What cannot be written, since the disk is full or another process is writing, is remembered
    and written later: `Store.note` says what must be said, and nothing is raised here.

    Parameters
    ----------
    store
        Database that the book is kept in.
    digest
        Digest by which the database knows it.
    path
        Path of the file.
    title
        Title, or the file's name.

    Attributes
    ----------
    place : KeptPlace or None
        Place at which reading goes on; None if the book was not read yet.
    tuning : dict or None
        How the book's braille was tuned; None if nobody kept that.
    options : dict
        Options with which the book was opened.
    """

    def __init__(self, store: Store, digest: str, path: Path, title: str) -> None:
        self.digest = digest
        self.path = path
        self.title = title
        self._store = store
        self._unwritten: dict[str, tuple[str, tuple[Any, ...]]] = {}
        self._own_bookmarks: dict[str, Bookmark | None] = {}  # those that are not written yet
        self._written_s: float | None = None
        row = store.first(
            "SELECT settled, options, place, tuning FROM books WHERE digest = ?", digest
        )
        settled, options, place, tuning = row or (1, None, None, None)
        self._settled = bool(settled)
        self.options = {**book_options({}), **(decoded(options, BookOptions) or {})}
        self.place: KeptPlace | None = decoded(place, KeptPlace)
        self.tuning: dict[str, Any] | None = decoded(tuning, dict)

    @property
    def fault(self) -> str | None:
        """Why something is not on the disk yet, and is tried again; None if all is."""
        return self._store.fault if self._unwritten else None

    @property
    def changed(self) -> bool:
        """Whether the file is another than its places are for: `settle` mends that."""
        return not self._settled

    @property
    def index(self) -> Index | None:
        """Where the book's blocks are, as far as it was kept."""
        row = self._store.first("SELECT packed FROM indices WHERE book = ?", self.digest)
        return None if row is None else decoded(row[0], Index)

    def keep(self, place: KeptPlace) -> None:
        """Keep the place at which reading goes on; call it at each step of the reading loop."""
        self.tend()
        if place == self.place and "place" not in self._unwritten:
            return
        self.place = place
        self._put(
            "place",
            "UPDATE books SET place = ?, read_s = ? WHERE digest = ?",
            (msgspec.msgpack.encode(place), self._store.now(), self.digest),
            wait=not self._due(),
        )

    def keep_at(
        self,
        source: Source,
        character: int,
        *,
        line: int | None = None,
        lines_before: int | None = None,
        width: int = 0,
        table: str = "",
        page: str = "",
    ) -> None:
        """Keep a place by its character, with the text around it, as `keep` does.

        Parameters
        ----------
        source
            The book.
        character
            Place of the source.
        line, lines_before, width, table, page
            As in `KeptPlace`.
        """
        old = self.place
        if old is not None and (old.character, old.line) == (character, line):
            self.keep(old)
            return
        place = place_in(source, character)
        told = {"line": line, "lines_before": lines_before, "width": width}
        self.keep(msgspec.structs.replace(place, **told, table=table, page=page))

    def bookmarks(self) -> list[Bookmark]:
        """All bookmarks, by their place."""
        rows = self._store.all("SELECT packed FROM bookmarks WHERE book = ?", self.digest)
        kept = [decoded(packed, Bookmark) for (packed,) in rows]
        named: dict[str, Bookmark | None] = {mark.name: mark for mark in kept if mark is not None}
        named |= self._own_bookmarks
        marks = [mark for mark in named.values() if mark is not None]
        return sorted(marks, key=lambda mark: (mark.character, mark.name))

    def set_bookmark(self, bookmark: Bookmark) -> None:
        """Set a bookmark; one of the same name is moved."""
        bookmark = msgspec.structs.replace(
            bookmark,
            name=storable(bookmark.name),
            text=storable(bookmark.text),
            after=storable(bookmark.after),
        )
        self._own_bookmarks[bookmark.name] = bookmark
        self._put(
            f"bookmark {bookmark.name}",
            "INSERT OR REPLACE INTO bookmarks (book, name, packed) VALUES (?, ?, ?)",
            (self.digest, bookmark.name, msgspec.msgpack.encode(bookmark)),
        )

    def delete_bookmark(self, name: str) -> None:
        """Delete a bookmark; if there is none of that name, nothing happens."""
        name = storable(name)
        self._own_bookmarks[name] = None
        self._put(
            f"bookmark {name}",
            "DELETE FROM bookmarks WHERE book = ? AND name = ?",
            (self.digest, name),
        )

    def keep_tuning(self, tuning: dict[str, Any]) -> None:
        """Keep how the book's braille is tuned: names and plain values.

        Raises
        ------
        ValueError
            If it is far too large for that.
        """
        packed = msgspec.msgpack.encode(tuning)
        if len(packed) > _LARGEST_TUNING:
            raise ValueError(f"tuning has {len(packed)} bytes; at most {_LARGEST_TUNING} are kept")
        self.tuning = dict(tuning)
        self._set("tuning", packed)

    def keep_options(self, options: BookOptions) -> None:
        """Keep the options with which the book is open."""
        if options != self.options:
            self.options = options
            with suppress(UnicodeEncodeError):  # the name of a table's file may be no text
                self._set("options", msgspec.msgpack.encode(options))

    def keep_title(self, title: str) -> None:
        """Keep the title that the book gives itself."""
        title = storable(title)
        if title and title != self.title:
            self.title = title
            self._set("title", title)

    def keep_index(self, index: Index) -> None:
        """Keep where the book's blocks are, so that the next opening knows it."""
        self._put(
            "index",
            "INSERT OR REPLACE INTO indices (book, packed) VALUES (?, ?)",
            (self.digest, msgspec.msgpack.encode(index)),
        )

    def settle(self, source: Source) -> str | None:
        """Find the places again in a file that has changed since; do nothing in another.

        Returns
        -------
        str or None
            Sentence on what became of the place; None if the file has not changed.
        """
        if self._settled:
            return None
        found = True
        if self.place is not None:
            self.place, found = anchored(source, self.place)
        marks = self.bookmarks()
        for mark in marks:
            old = KeptPlace(mark.character, share=mark.share, after=mark.after or mark.text)
            place, _ = anchored(source, old)
            self.set_bookmark(
                msgspec.structs.replace(mark, character=place.character, share=place.share)
            )
        self._settled = True
        packed = None if self.place is None else msgspec.msgpack.encode(self.place)
        self._put(
            "settled",
            "UPDATE books SET settled = 1, place = ? WHERE digest = ?",
            (packed, self.digest),
        )
        if found:
            return "the text has changed since it was read; the place was found again"
        return "the text has changed since it was read; the place is gone, and this is near it"

    def close(self) -> None:
        """Write what is left to write. Further calls do nothing new."""
        with self._store.patient():
            self.tend(last=True)

    def _due(self) -> bool:
        passed = None if self._written_s is None else self._store.now() - self._written_s
        return passed is None or not 0 <= passed < EVERY_S

    def _set(self, column: str, value: Any) -> None:
        self._put(column, f"UPDATE books SET {column} = ? WHERE digest = ?", (value, self.digest))

    def _put(self, what: str, sql: str, values: tuple[Any, ...], *, wait: bool = False) -> None:
        """Write something now, or when it can be; what is newer replaces what is older."""
        self._unwritten.pop(what, None)
        self._unwritten[what] = (sql, values)
        if not wait:
            self._write()

    def tend(self, *, last: bool = False) -> None:
        """Write what could not be written before, if it is time for that."""
        if self._unwritten and (last or self._due()):
            self._write()

    def _write(self) -> None:
        # Also where it fails, it is tried no more often.
        self._written_s = self._store.now()
        if self._store.write([self._row(), *self._unwritten.values()]):
            self._unwritten.clear()
            self._own_bookmarks.clear()

    def _row(self) -> tuple[str, tuple[Any, ...]]:
        """Statement that makes the book's row again, if another process has deleted it."""
        return (
            "INSERT OR IGNORE INTO books (digest, path, title, read_s, settled, options, place,"
            " tuning) VALUES (?, ?, ?, ?, 1, ?, ?, ?)",
            (
                self.digest,
                os.fsencode(self.path),
                self.title,
                self._store.now(),
                msgspec.msgpack.encode(self.options),
                None if self.place is None else msgspec.msgpack.encode(self.place),
                None if self.tuning is None else msgspec.msgpack.encode(self.tuning),
            ),
        )


def decoded(packed: bytes | None, kind: type) -> Any:
    """Value of its bytes; None if there are none, or they are not of this kind."""
    if packed is None:
        return None
    try:
        return msgspec.msgpack.decode(packed, type=kind)
    except (msgspec.DecodeError, TypeError):
        return None
