"""The library: a file of all books that were read, each with its place and bookmarks."""

from __future__ import annotations

import hashlib
import os
import sqlite3
import time
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import msgspec

from vbraille.cli.old.reading.keptplace import Bookmark, KeptPlace, anchored, place_in, storable
from vbraille.cli.old.reading.store import Store, usual_path
from vbraille.config.options import BOOK, held_in
from vbraille.errors import InputError

Index = None
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from vbraille.translate import Source


BookOptions = dict[str, bool | int | str | None]


def book_options(given: Mapping[str, Any], *, turned: bool = False) -> BookOptions:
    """Choose the options that are kept with a book, of values by their names; None is usual.

    With `turned`, language and grade were chosen by keys while the book was read: they hold the
    next time, too, unless options say otherwise then.
    """
    kept = {option.name: given.get(option.name, option.default) for option in held_in(BOOK)}
    return {**kept, "turned": turned}


class ListedBook(msgspec.Struct, frozen=True):
    """A book in the list of those that were read.

    Parameters
    ----------
    digest
        Digest by which the database knows it.
    title
        Title, or the file's name.
    path
        Where the file was.
    read_s
        When it was last read, in seconds since 1970.
    place
        Where reading goes on; None if nothing was read.
    missing
        Whether there is no such file now.
    """

    digest: str
    title: str
    path: str
    read_s: float
    place: KeptPlace | None
    missing: bool


EVERY_S = 0.5  # a place that changes all the time is written so often
_LARGEST_TUNING = 100_000  # bytes


class KeptBook:
    """Book as it is kept: its place, bookmarks, tuning, options and index.

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
        How the book's braille was tuned; None if that was not kept.
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
        """Tell whether the file is another than its places are for: `settle` mends that."""
        return not self._settled

    @property
    def index(self) -> Index | None:
        """Index of the book's blocks, as far as it was kept."""
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


_END_BYTES = 1_000_000  # at the beginning of a file, and at its end, by which it is known
_TEXT = ("encoding", "keep_lines", "form")  # options that decide on the characters of a file
_FORGETTING = (
    "DELETE FROM bookmarks WHERE book = ?",
    "DELETE FROM indices WHERE book = ?",
    "DELETE FROM books WHERE digest = ?",
)


class KeptPlaces:
    """The database of places; it is a context manager.

    Opening and using it never fails: `note` says what is the matter, and what cannot be written is
    known as long as the program runs, and tried again.

    Parameters
    ----------
    store
        Database, as `KeptPlaces.open` opens it.
    """

    def __init__(self, store: Store) -> None:
        self._store = store
        self._books: list[KeptBook] = []

    @classmethod
    def open(cls, path: Path | str | None = None, now: Callable[[], float] = time.time) -> Self:
        """Open the database.

        Parameters
        ----------
        path
            Path of its file; None for the user's, or the one that the environment names.
        now
            Clock in seconds since 1970.
        """
        return cls(Store(usual_path() if path is None else Path(path), now))

    @property
    def fault(self) -> str | None:
        """Why what was written last is not on the disk; None if it is, or will be in a moment."""
        return self._store.fault

    def note(self) -> str | None:
        """Sentence on why places are not kept, given once; None if they are."""
        return self._store.note()

    def book(self, path: Path | str, title: str = "") -> KeptBook:
        """Find what is kept of a book; an unknown one is known from now on.

        A book is known by its content, wherever it is. If the content is new and the path is
        known, what is kept is that of the path's old content: `KeptBook.changed` says so.

        Parameters
        ----------
        path
            Path of the file.
        title
            Title, if the book has one.
        """
        place = Path(path).absolute()
        digest = _digest(place)
        title = storable(title)
        name = title or storable(place.name)
        try:
            with self._store.patient(), self._store.transaction() as connection:
                _take_in(connection, digest, os.fsencode(place), name)
                connection.execute(
                    "UPDATE books SET read_s = ? WHERE digest = ?", (self._store.now(), digest)
                )
                if title:
                    connection.execute(
                        "UPDATE books SET title = ? WHERE digest = ?", (title, digest)
                    )
        except sqlite3.Error as error:
            self._store.take(error)
        book = KeptBook(self._store, digest, place, name)
        self._books.append(book)
        return book

    def listed(self) -> list[ListedBook]:
        """All books, the one that was read last first."""
        rows = self._store.all(
            "SELECT digest, title, path, read_s, place FROM books ORDER BY read_s DESC, rowid DESC"
        )
        books: list[ListedBook] = []
        for digest, title, packed, read_s, place in rows:
            path = os.fsdecode(packed)
            missing = not os.path.exists(path)  # noqa: PTH110 - which raises nothing
            kept = decoded(place, KeptPlace)
            books.append(ListedBook(digest, title, path, read_s, kept, missing))
        return books

    def forget(self, digest: str) -> bool:
        """Delete what is kept of a book, by its digest in `listed`; whether that was done."""
        if self._store.first("SELECT 1 FROM books WHERE digest = ?", digest) is None:
            return False
        with self._store.patient():
            done = self._store.write([(sql, (digest,)) for sql in _FORGETTING])
            if done:
                self._store.shrink()
            return done

    def close(self) -> None:
        """Write what is left to write, and close the file."""
        for book in self._books:
            book.close()
        self._books.clear()
        self._store.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _digest(path: Path) -> str:
    """SHA-256 of a file's size, beginning and end; of its path if it is no file that can be read.

    A book of any size is known at once by these.
    """
    try:
        if path.is_file():
            with path.open("rb") as file:
                size = file.seek(0, os.SEEK_END)
                digest = hashlib.sha256(str(size).encode())
                for start in (0, max(size - _END_BYTES, 0)):
                    file.seek(start)
                    digest.update(file.read(_END_BYTES))
                return digest.hexdigest()
    except OSError:
        pass
    return hashlib.sha256(os.fsencode(path)).hexdigest()


def _take_in(connection: sqlite3.Connection, digest: str, path: bytes, title: str) -> None:
    """Have a book be the one at a path, with what is kept of it, or of the path's old content."""
    known = connection.execute("SELECT 1 FROM books WHERE digest = ?", (digest,)).fetchone()
    others = connection.execute(
        "SELECT digest FROM books WHERE path = ? AND digest != ?", (path, digest)
    ).fetchall()
    if known is None and others:  # where the places are now, the text will say
        values = (digest, *others.pop())
        connection.execute("UPDATE books SET digest = ?, settled = 0 WHERE digest = ?", values)
        connection.execute("UPDATE bookmarks SET book = ? WHERE book = ?", values)
        connection.execute("DELETE FROM indices WHERE book = ?", values[1:])
    elif known is None:
        connection.execute(
            "INSERT INTO books (digest, path, title, read_s, settled) VALUES (?, ?, ?, 0, 1)",
            (digest, path, title),
        )
    for other in others:
        for sql in _FORGETTING:
            connection.execute(sql, other)
    connection.execute("UPDATE books SET path = ? WHERE digest = ?", (path, digest))


def last_book(places: KeptPlaces) -> KeptBook:
    """The book that was read last.

    Raises
    ------
    InputError
        If no book was read, or its file is not where it was.
    """
    books = places.listed()
    if not books:
        raise InputError("no book is kept from an earlier reading; give the name of a file")
    return _open_listed(places, books[0], "the last book")


def numbered_book(places: KeptPlaces, number: int) -> ListedBook:
    """The book with a number in the list of all books.

    Raises
    ------
    InputError
        If there is none.
    """
    books = places.listed()
    if not 1 <= number <= len(books):
        there = f"there {'is' if len(books) == 1 else 'are'} {count(len(books), 'book')}"
        raise InputError(f"there is no book {number}; {there}, and vbraille books lists them")
    return books[number - 1]


def book_to_open(places: KeptPlaces, number: int) -> KeptBook:
    """The book with a number in the list of all books, to read on in it.

    Raises
    ------
    InputError
        If there is none, it has no file, or the file is not where it was.
    """
    return _open_listed(places, numbered_book(places, number), f"book {number}")


def _open_listed(places: KeptPlaces, book: ListedBook, name: str) -> KeptBook:
    if book.missing:
        raise InputError(
            f"{name}, {book.path}, is not there any more; give its file, or choose another: "
            f"vbraille books lists them"
        )
    return places.book(book.path)


def resume(
    source: Source, kept: KeptBook, options: BookOptions
) -> tuple[KeptPlace | None, str | None]:
    """Give an open book what is kept of it, such as where its blocks are.

    Returns
    -------
    tuple[KeptPlace or None, str or None]
        Place at which reading goes on, None for the beginning; and a sentence for the reader, such
        as that the text has changed, None if there is none.
    """
    same_text = all(kept.options[name] == options[name] for name in _TEXT)
    note = None
    index = kept.index
    if index is not None:
        source.adopt(index)
    if kept.changed:
        note = kept.settle(source)
    place = kept.place
    if place is not None and not same_text:
        place, _ = anchored(source, place)  # the same bytes, but other characters
    kept.keep_options(options)
    kept.keep_title(source.title)
    return place, note
