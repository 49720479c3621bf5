"""Books that were read: the place in each, its bookmarks and its options, in one SQLite table."""

from __future__ import annotations

import json
import os
import re
import sqlite3
import time
from contextlib import suppress
from dataclasses import astuple, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

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
    digest TEXT PRIMARY KEY, path BLOB, title TEXT, read_s REAL, place INTEGER, share REAL,
    around TEXT, bookmarks TEXT, options TEXT
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


@dataclass(slots=True)
class BookRow:
    """A row of the table: a book, and what is kept of it; without a digest it is not written."""

    digest: str
    encoded: bytes
    title: str
    read_s: float = 0.0
    place: int = 0
    share: float = 0.0
    around: str = ""
    bookmarks: str = "{}"
    options: str = "{}"

    @property
    def path(self) -> Path:
        """Path of the book's file."""
        return Path(os.fsdecode(self.encoded))


class KeptBook:
    """Place and bookmarks in a book. Reading goes on without it: what cannot be kept is said.

    Parameters
    ----------
    places
        The books.
    row
        Row of the book.
    changed
        Whether the book's content is another than when the row was written.

    Attributes
    ----------
    bookmarks : dict[str, int]
        Places of bookmarks by their names.
    options : dict[str, Any]
        Options with which the text was opened, and the table that was chosen while reading.
    """

    def __init__(self, places: Places, row: BookRow, *, changed: bool) -> None:
        self._places, self._row, self._changed = places, row, changed
        self.options: dict[str, Any] = json.loads(row.options)
        self._marks: dict[str, list[Any]] = json.loads(row.bookmarks)

    def find(self, source: Source, say: Callable[[str], None]) -> int:
        """Place at which reading goes on; in a book that has changed, near its words."""
        row = self._row
        if not self._changed:
            return row.place
        self._marks = {
            name: [nearest(source, words, place), words]
            for name, (place, words) in self._marks.items()
        }
        if not row.place:
            return 0
        place = nearest(source, row.around, row.place, row.share)
        exact = row.around.strip() and source.text.startswith(row.around, place)
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
        self._row = replace(self._row, **values)
        self._places.write(self._row)


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
        named = {"digest": digest, "encoded": os.fsencode(path), "title": title}
        same = self._rows("WHERE digest=?", digest)
        former = [] if same else self._rows("WHERE path=?", named["encoded"])
        row = replace([*same, *former, BookRow(**named)][0], **named, read_s=time.time())
        self.write(row)  # before the former goes, so that a place is never in neither
        with suppress(InputError):  # which cannot be written was said
            for each in former:
                self.forget(each.digest)
        return KeptBook(self, row, changed=bool(former))

    def listed(self) -> list[BookRow]:
        """All books, the one that was read last first."""
        return self._rows("ORDER BY read_s DESC")

    def numbered(self, number: int) -> BookRow:
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

    def _rows(self, which: str, *values: str | bytes) -> list[BookRow]:
        return [BookRow(*row) for row in self._db.execute(f"SELECT * FROM books {which}", values)]

    def write(self, row: BookRow) -> None:
        """Write a row; a fault is said once, and the next row may be written."""
        try:
            if row.digest:
                self._db.execute(f"REPLACE INTO books VALUES (?{', ?' * 8})", astuple(row))
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
        (version,) = db.execute("PRAGMA user_version").fetchone()
        if version not in (0, _VERSION):
            raise sqlite3.OperationalError("it is a file of another version of vbraille")
        db.executescript(_TABLE)
        db.execute("SELECT digest, place, bookmarks, options FROM books")
    finally:
        os.umask(before)
    return db
