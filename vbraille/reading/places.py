"""Books that were read: the place in each, its bookmarks and its options, in one SQLite table."""

from __future__ import annotations

import json
import os
import re
import sqlite3
import time
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from vbraille.errors import InputError
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.layout import Line
    from vbraille.translate import Source

_VERSION = 1
_TABLE = f"""
PRAGMA journal_mode=WAL;
PRAGMA synchronous=NORMAL;
PRAGMA secure_delete=ON;
CREATE TABLE IF NOT EXISTS books (
    digest TEXT PRIMARY KEY, path BLOB, title TEXT, read_s REAL,
    place INTEGER DEFAULT 0, share REAL DEFAULT 0, around TEXT DEFAULT '',
    bookmarks TEXT DEFAULT '{{}}', options TEXT DEFAULT '{{}}'
);
PRAGMA user_version={_VERSION};
"""
_AROUND = 200  # characters that are kept with a place, to find it again


def places_path() -> Path:
    """Path of the file, which ``VBRAILLE_PLACES`` may name."""
    if os.environ.get("VBRAILLE_PLACES"):
        return Path(os.environ["VBRAILLE_PLACES"]).expanduser()
    from platformdirs import user_data_path

    return user_data_path("vbraille") / "books.sqlite"


def around(line: Line) -> str:
    """Words from a line on, by which its place is found again."""
    return line.block.text[line.first : line.first + _AROUND]


def nearest(source: Source, words: str, place: int, share: float | None = None) -> int:
    """Place where words stand that is nearest to another place; without them, the same share.

    Parameters
    ----------
    source
        The text.
    words
        What stood at the place.
    place
        The place before the text changed.
    share
        Share of the text that stood before it; None to keep the place.
    """
    text = source.text
    for length in (_AROUND, 40, 12):
        if words[:length].strip():
            found = [hit.start() for hit in re.finditer(re.escape(words[:length]), text)]
            if found:
                return min(found, key=lambda each: abs(each - place))
    return min(place if share is None else int(share * len(text)), max(len(text) - 1, 0))


class ListedBook(NamedTuple):
    """A book in the list."""

    digest: str
    path: Path
    title: str
    share: float


class KeptBook:
    """Place and bookmarks in a book. Reading goes on without it: what cannot be kept is said.

    Parameters
    ----------
    places
        The books.
    digest
        Checksum of the book's content.

    Attributes
    ----------
    bookmarks : dict[str, int]
        Places of bookmarks by their names.
    options : dict[str, Any]
        Options with which the text was opened, and the table that was chosen while reading.
    """

    def __init__(self, places: Places, digest: str, *, changed: bool = False) -> None:
        self._places, self._digest, self._changed = places, digest, changed
        row = places.row("digest", digest)
        assert row is not None, "a row that `Places.book` has written"
        self.options: dict[str, Any] = json.loads(row["options"])
        self._marks: dict[str, list[Any]] = json.loads(row["bookmarks"])
        self._place, self._share, self._around = row["place"], row["share"], row["around"]

    def find(self, source: Source, say: Callable[[str], None]) -> int:
        """Place at which reading goes on; in a book that has changed, near its words."""
        if not self._changed:
            return self._place
        self._marks = {
            name: [nearest(source, words, place), words]
            for name, (place, words) in self._marks.items()
        }
        if not self._place:
            return 0
        place = nearest(source, self._around, self._place, self._share)
        exact = self._around.strip() and source.text.startswith(self._around, place)
        gone = "your exact place is gone; this is close to it"
        say("the book has changed; this is your place" if exact else gone)
        return place

    def keep(self, place: int, share: float, words: str) -> None:
        """Keep the place."""
        self._write(place=place, share=share, around=words, read_s=time.time())

    def set_options(self, **options: Any) -> None:
        """Keep options of the text, in place of those that there are."""
        self.options |= options
        self._write(options=json.dumps(self.options))

    @property
    def bookmarks(self) -> dict[str, int]:
        """Places of the bookmarks by their names, in the order of the book."""
        marks = sorted(self._marks.items(), key=lambda mark: mark[1][0])
        return {name: place for name, (place, _) in marks}

    def mark(self, name: str, place: int | None = None, words: str = "") -> None:
        """Set a bookmark, in place of one with the same name; remove it without a place."""
        self._marks.pop(name, None)
        if place is not None:
            self._marks[name] = [place, words]
        self._write(bookmarks=json.dumps(self._marks))

    def _write(self, **values: Any) -> None:
        self._places.write(self._digest, **values)


class Places:
    """The books of a reader.

    Parameters
    ----------
    path
        Path of the file; None to keep nothing.
    say
        Function that is called with a sentence where something cannot be kept.
    """

    def __init__(self, path: Path | None, say: Callable[[str], None]) -> None:
        self._say, self._fault = say, ""
        self._db = _connect(None)
        if path is None:
            return
        try:
            self._db = _connect(path)
        except sqlite3.OperationalError as error:  # it cannot be written, or is another version's
            say(f"places are not kept: {path}: {error}")
        except sqlite3.DatabaseError:
            aside = path.with_name(f"{path.name}.damaged-{time.strftime('%Y%m%d-%H%M%S')}")
            path.rename(aside)
            say(f"{path.name} is damaged; it is kept as {aside.name}, and a new one begins")
            self._db = _connect(path)
        except OSError as error:
            say(f"places are not kept: {path}: {error.strerror}")

    def book(self, digest: str, path: Path, title: str) -> KeptBook:
        """Find what is kept of a book by its content, or by its path if that has changed."""
        known = self.row("digest", digest)
        before = None if known else self.row("path", os.fsencode(path))
        if before is not None:
            self.write(before["digest"], digest=digest)
        with suppress(sqlite3.Error):
            self._db.execute("INSERT OR IGNORE INTO books (digest) VALUES (?)", (digest,))
        self.write(digest, path=os.fsencode(path), title=title, read_s=time.time())
        if self.row("digest", digest) is None:  # it cannot be written, which was said
            self._db = _connect(None)
            return self.book(digest, path, title)
        return KeptBook(self, digest, changed=before is not None)

    def listed(self) -> list[ListedBook]:
        """All books, the one that was read last first."""
        columns = "digest, path, title, share"
        return [
            ListedBook(digest, Path(os.fsdecode(path)), title, share)
            for digest, path, title, share in self._db.execute(
                f"SELECT {columns} FROM books ORDER BY read_s DESC"
            )
        ]

    def numbered(self, number: int) -> ListedBook:
        """Book of a number in the list, from 1.

        Raises
        ------
        InputError
            If there is none.
        """
        books = self.listed()
        if not books:
            raise InputError("no book has been read yet; give a file")
        if number > len(books):
            raise InputError(f"no book {number}; vbraille books lists {count(len(books), 'book')}")
        return books[number - 1]

    def forget(self, digest: str) -> None:
        """Delete what is kept of a book.

        Raises
        ------
        InputError
            If that cannot be written.
        """
        try:
            self._db.execute("DELETE FROM books WHERE digest=?", (digest,))
            self._db.execute("PRAGMA wal_checkpoint(TRUNCATE)")
        except sqlite3.Error as error:
            raise InputError(f"the book is not forgotten: {error}") from None

    def row(self, column: str, value: str | bytes) -> sqlite3.Row | None:
        """Row of a book; None if there is none."""
        return self._db.execute(f"SELECT * FROM books WHERE {column}=?", (value,)).fetchone()

    def write(self, key: str, /, **values: Any) -> None:
        """Write values of a book; a fault is said once, and the next value may be written."""
        sets = ", ".join(f"{name}=?" for name in values)
        try:
            self._db.execute(f"UPDATE books SET {sets} WHERE digest=?", (*values.values(), key))
            self._fault = ""
        except sqlite3.Error as error:
            if str(error) != self._fault:
                self._fault = str(error)
                self._say(f"place not kept: {error}; reading goes on")


def _connect(path: Path | None) -> sqlite3.Connection:
    before = os.umask(0o077)  # it has text of books
    try:
        if path is not None:
            path.parent.mkdir(0o700, parents=True, exist_ok=True)
        db = sqlite3.connect(path or ":memory:", timeout=0.2, isolation_level=None)
        db.row_factory = sqlite3.Row
        (version,) = db.execute("PRAGMA user_version").fetchone()
        if version not in (0, _VERSION):
            raise sqlite3.OperationalError("it is a file of another version of vbraille")
        db.executescript(_TABLE)
        db.execute("SELECT digest, place, bookmarks, options FROM books")
    finally:
        os.umask(before)
    return db
