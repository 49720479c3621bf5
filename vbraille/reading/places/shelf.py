"""All books that somebody has read, each with what is kept of it."""

from __future__ import annotations

import os
import sqlite3
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from vbraille.reading.places.book import KeptBook, decoded, path_bytes
from vbraille.reading.places.database import usual_path
from vbraille.reading.places.identity import QUICK_BYTES, Digesting, digest_of, fingerprint
from vbraille.reading.places.store import Store
from vbraille.reading.places.values import KeptPlace, ListedBook, storable

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.reading.places.identity import Fingerprint

_OLDER_KEPT = 5  # of the contents that a file had before


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

    def book(self, path: Path | str | None, digest: str | None = None, title: str = "") -> KeptBook:
        """What is kept of a book; an unknown one is known from now on.

        A file that the system says the same of as when it was last read is the same book. Others
        are known by their content, wherever they are. If the content is new and the path is known,
        places of the path's old content are taken over: `KeptBook.changed` says so.

        Parameters
        ----------
        path
            Path of the file; None for standard input, whose digest must be given.
        digest
            SHA-256 of the content in hexadecimal, if it is known.
        title
            Title, if the book has one.
        """
        place = None if path is None else Path(path).absolute()
        mark = None if place is None else fingerprint(place)
        title = storable(title)
        name = title or ("standard input" if place is None else storable(place.name))
        try:
            with self._store.patient(), self._store.transaction() as connection:
                number, known = _find_or_make(connection, place, mark, digest, name)
                connection.execute(
                    "UPDATE books SET read_s = ? WHERE id = ?", (self._store.now(), number)
                )
                if title:
                    connection.execute("UPDATE books SET title = ? WHERE id = ?", (title, number))
        except sqlite3.Error as error:
            number, known = self._stand_in(error, mark), True
        digesting = None
        if not known and place is not None:
            digesting = Digesting(place)
        book = KeptBook(self._store, number, place, mark, name, digesting)
        self._books.append(book)
        return book

    def last_path(self) -> Path | None:
        """Path of the book that was read last, of those that have a file; None if there is none."""
        row = self._store.first(
            "SELECT path FROM books WHERE length(path) AND NOT replaced "
            "ORDER BY read_s DESC, id DESC LIMIT 1"
        )
        return None if row is None else Path(os.fsdecode(row[0]))

    def listed(self) -> list[ListedBook]:
        """All books, the one that was read last first."""
        rows = self._store.all(
            "SELECT id, title, path, read_s, place FROM books WHERE NOT replaced "
            "ORDER BY read_s DESC, id DESC"
        )
        return [
            ListedBook(
                number, title, os.fsdecode(path), read_s, decoded(place, KeptPlace),
                bool(path) and not _exists(path),
            )
            for number, title, path, read_s, place in rows
        ]  # fmt: skip

    def forget(self, number: int) -> bool:
        """Delete what is kept of a book, by its number in `listed`; whether that was done.

        What was kept of its file's older contents is deleted, too.
        """
        row = self._store.first("SELECT path FROM books WHERE id = ?", number)
        if row is None:
            return False
        older = self._store.all(
            "SELECT id FROM books WHERE replaced AND length(path) AND path = ?", row[0]
        )
        numbers = [number, *(n for (n,) in older)]
        with self._store.patient():
            return (
                self._store.write([(sql, (n,)) for n in numbers for sql in _FORGETTING], None)
                and self._store.shrink()
            )

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

    def _stand_in(self, error: sqlite3.Error, mark: Fingerprint | None) -> int:
        """Number of a book where nothing can be written now, its own if it can be read."""
        self._store.take(error)
        if mark is not None:
            row = self._store.first(
                "SELECT id FROM books WHERE size = ? AND mtime_ns = ? AND inode = ?",
                *_numbers(mark),
            )
            if row is not None:
                return row[0]
        return time.time_ns()  # no other will have it


def _exists(path: bytes) -> bool:
    try:
        return Path(os.fsdecode(path)).exists()
    except OSError:
        return False


_FORGETTING = (
    "DELETE FROM bookmarks WHERE book = ?",
    "DELETE FROM indices WHERE book = ?",
    "DELETE FROM books WHERE id = ?",
)


def _find_or_make(
    connection: sqlite3.Connection,
    path: Path | None,
    mark: Fingerprint | None,
    digest: str | None,
    title: str,
) -> tuple[int, bool]:
    """Number of a book's row, and whether its digest is known."""
    if mark is not None:
        row = connection.execute(
            "SELECT id, digest FROM books WHERE size = ? AND mtime_ns = ? AND inode = ? "
            "ORDER BY path = ? DESC, read_s DESC LIMIT 1",
            (mark.size, mark.mtime_ns, mark.inode, path_bytes(path)),
        ).fetchone()
        if row is not None and digest in (None, row[1]):
            _take_path(connection, row[0], path, mark)
            return row[0], row[1] is not None
    if digest is None and path is not None and mark is not None:
        same_size = "SELECT 1 FROM books WHERE size = ? LIMIT 1"
        if mark.size <= QUICK_BYTES or connection.execute(same_size, (mark.size,)).fetchone():
            digest = digest_of(path)
    if digest is not None:
        row = connection.execute(
            "SELECT id FROM books WHERE digest = ? ORDER BY read_s DESC LIMIT 1", (digest,)
        ).fetchone()
        if row is not None:
            _take_path(connection, row[0], path, mark)
            return row[0], True
    old = None
    if path is not None:
        old = connection.execute(
            "SELECT id FROM books WHERE path = ? AND NOT replaced LIMIT 1", (path_bytes(path),)
        ).fetchone()
    values: tuple[Any, ...] = (digest, path_bytes(path), *_numbers(mark), title)
    number = connection.execute(
        "INSERT INTO books (digest, path, size, mtime_ns, inode, title, read_s, replaced, settled)"
        " VALUES (?, ?, ?, ?, ?, ?, 0, 0, 1)",
        values,
    ).lastrowid
    assert number is not None
    if old is not None:
        _take_over(connection, old[0], number)
    _take_path(connection, number, path, mark)
    return number, digest is not None


def _take_over(connection: sqlite3.Connection, old: int, number: int) -> None:
    """Copy what was kept of a file's old content; where the places are now, the text will say."""
    connection.execute(
        "UPDATE books SET (options, place, tuning, settled) ="
        " (SELECT options, place, tuning, 0 FROM books WHERE id = ?) WHERE id = ?",
        (old, number),
    )
    connection.execute(
        "INSERT INTO bookmarks SELECT ?, name, packed FROM bookmarks WHERE book = ?", (number, old)
    )
    connection.execute("DELETE FROM indices WHERE book = ?", (old,))


def _take_path(
    connection: sqlite3.Connection, number: int, path: Path | None, mark: Fingerprint | None
) -> None:
    """Have a book be the one at a path; another that was there is replaced."""
    if path is None:
        return
    connection.execute(
        "UPDATE books SET path = ?, size = ?, mtime_ns = ?, inode = ?, replaced = 0 WHERE id = ?",
        (path_bytes(path), *_numbers(mark), number),
    )
    connection.execute(
        "UPDATE books SET replaced = 1 WHERE path = ? AND id != ?", (path_bytes(path), number)
    )
    older = connection.execute(
        "SELECT id FROM books WHERE path = ? AND replaced ORDER BY read_s DESC LIMIT -1 OFFSET ?",
        (path_bytes(path), _OLDER_KEPT),
    ).fetchall()
    for row in older:
        for sql in _FORGETTING:
            connection.execute(sql, row)


def _numbers(mark: Fingerprint | None) -> tuple[int, int, int]:
    return (-1, -1, -1) if mark is None else (mark.size, mark.mtime_ns, mark.inode)
