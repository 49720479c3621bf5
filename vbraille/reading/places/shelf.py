"""All books that were read, each with what is kept of it; one is opened where it was left."""

from __future__ import annotations

import hashlib
import os
import sqlite3
import time
from pathlib import Path
from typing import TYPE_CHECKING, Self

from vbraille.errors import InputError
from vbraille.reading.places.book import KeptBook, decoded
from vbraille.reading.places.place import KeptPlace, ListedBook, anchored, storable
from vbraille.reading.places.store import Store, usual_path
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.reading.places.place import BookOptions
    from vbraille.translate.source import Source

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
    def path(self) -> Path:
        """Path of the database's file."""
        return self._store.path

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

    def last_path(self) -> Path | None:
        """Path of the book that was read last; None if there is none."""
        listed = self.listed()
        return Path(listed[0].path) if listed else None

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
    path = places.last_path()
    if path is None:
        raise InputError("no book is kept from an earlier reading; give the name of a file")
    if not path.exists():
        raise InputError(
            f"the last book, {path}, is not there any more; give its file, or choose another: "
            f"vbraille books lists them"
        )
    return places.book(path)


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
    book = numbered_book(places, number)
    if book.missing:
        raise InputError(
            f"book {number}, {book.path}, is not there any more; give its file, or choose another: "
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
