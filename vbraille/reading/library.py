"""The library: a file of all books that were read, each with its place and bookmarks."""

from __future__ import annotations

import hashlib
import os
import sqlite3
import time
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Self
from urllib.parse import quote

import msgspec

from vbraille.config.options import BOOK, held_in
from vbraille.errors import InputError
from vbraille.reading.search.questions import FindShare, FindText
from vbraille.reading.search.seeker import find_place
from vbraille.translate.source import Index, share_before
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from vbraille.translate.source import Source


VERSION: Final = 2
ENVIRONMENT: Final = "VBRAILLE_PLACES"
# A reader's hand must not be held up by another process that writes; opening and closing may wait.
_PATIENT_MS, _READING_MS = 3_000, 10
_AGAIN_S: Final = 2.0  # between two tries to open a file that could not be written
_TRIES: Final = 20
_DAMAGED = (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB)
_LOCKED = (sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED)
_TABLES = """
CREATE TABLE books (
    digest TEXT PRIMARY KEY, path BLOB NOT NULL, title TEXT NOT NULL, read_s REAL NOT NULL,
    settled INTEGER NOT NULL, options BLOB, place BLOB, tuning BLOB
);
CREATE INDEX books_path ON books (path);
CREATE TABLE bookmarks (
    book TEXT NOT NULL, name TEXT NOT NULL, packed BLOB NOT NULL, PRIMARY KEY (book, name)
);
CREATE TABLE indices (book TEXT PRIMARY KEY, packed BLOB NOT NULL);
"""
_Statement = tuple[str, tuple[Any, ...]]


class _OtherVersionError(Exception):
    """Another version of the program has written the file, and this one leaves it as it is."""


def usual_path() -> Path:
    """Path of the file in which this user's places are kept."""
    if given := os.environ.get(ENVIRONMENT):
        return Path(given)
    from platformdirs import user_data_path

    return user_data_path("vbraille", appauthor=False) / "places.sqlite"


class Store:
    """A database of places.

    A damaged file is set aside, and another begun. Where no file can be written, what can be read
    of it is taken into memory, and the file is tried again.

    Parameters
    ----------
    path
        Path of its file.
    now
        Clock in seconds since 1970.

    Attributes
    ----------
    fault : str or None
        Why what was written last is not on the disk; None if it is, or will be in a moment.
    """

    _connection: sqlite3.Connection

    def __init__(self, path: Path, now: Callable[[], float] = time.time) -> None:
        self.path = path
        self.now = now
        self.fault: str | None = None
        self._note: str | None = None
        self._noted = False  # one is enough, whatever comes after it
        self._on_disk = False
        self._tried_s: float | None = now()
        self._open()

    def note(self) -> str | None:
        """Sentence on why places are not kept, given once; None if they are."""
        note, self._note = self._note, None
        return note

    def first(self, sql: str, *values: Any) -> Any:
        """First row that a query gives; None if there is none, or nothing can be read."""
        rows = self.all(sql, *values)
        return rows[0] if rows else None

    def all(self, sql: str, *values: Any) -> list[Any]:
        """All rows that a query gives; none if nothing can be read."""
        try:
            return self._connection.execute(sql, values).fetchall()
        except sqlite3.Error as error:
            self.take(error)
            return []

    def write(self, statements: Sequence[_Statement]) -> bool:
        """Write by statements, all or none; whether they are on the disk.

        A file that could not be opened is tried again, but not all the time.

        Parameters
        ----------
        statements
            SQL of each with its values.
        """
        if not self._on_disk:
            self._open_again()
        try:
            with self.transaction() as connection:
                for sql, values in statements:
                    connection.execute(sql, values)
        except sqlite3.Error as error:
            self.take(error)
            return False
        if self._on_disk:
            self.fault = None
        return self._on_disk

    @contextmanager
    def transaction(self) -> Iterator[sqlite3.Connection]:
        """Do all of a block, or nothing of it."""
        connection = self._connection
        connection.execute("BEGIN IMMEDIATE")
        try:
            yield connection
            connection.execute("COMMIT")
        except BaseException:  # a signal's exception, too
            with suppress(sqlite3.Error):
                connection.execute("ROLLBACK")
            raise

    @contextmanager
    def patient(self) -> Iterator[None]:
        """Wait for other processes in a block, since this holds up no reader's hand."""
        self._tried_s = None
        self._connection.execute(f"PRAGMA busy_timeout = {_PATIENT_MS}")
        try:
            yield
        finally:
            with suppress(sqlite3.Error):
                self._connection.execute(f"PRAGMA busy_timeout = {_READING_MS}")

    def shrink(self) -> None:
        """Have nothing of what was deleted left in the file or in its log."""
        self.all("PRAGMA wal_checkpoint(TRUNCATE)")

    def close(self) -> None:
        """Close the file. Nothing can be read or written after that."""
        with suppress(sqlite3.Error):
            self._connection.close()

    def take(self, error: sqlite3.Error) -> None:
        """Make a note of an error; a damaged file is set aside, and another is begun."""
        if _code(error) in _LOCKED:
            return  # another process is writing; it is tried again
        if _code(error) in _DAMAGED and self._on_disk:
            self.close()
            self._open(damaged=True)
            return
        why = _reason(error)
        if self._on_disk:
            self.fault = why
        self._say(
            f"places cannot be kept in {self.path} now: {why}; reading goes on, and it is tried "
            f"again"
        )

    def _say(self, note: str) -> None:
        if not self._noted:
            self._noted, self._note = True, note

    def _open(self, *, damaged: bool = False) -> None:
        """Open the file, or what stands in for it: this never fails."""
        try:
            if damaged:
                self._set_aside()
            self._connection = _connect(self.path, _PATIENT_MS)
        except _OtherVersionError:
            why = "another version of vbraille has written it"
        except sqlite3.Error as error:
            if _code(error) in _DAMAGED and not damaged:
                self._open(damaged=True)
                return
            why = _reason(error)
        except OSError as error:
            why = error.strerror or str(error)
        else:
            self._on_disk, self.fault = True, None
            return
        self._on_disk, self.fault = False, why
        self._connection = _in_memory(self.path)
        self._say(
            f"places cannot be kept in {self.path}: {why}; reading goes on, and it is tried again"
        )

    def _open_again(self) -> None:
        """Open the file in place of what stands in for it, if it can be opened by now."""
        if self._tried_s is not None and 0 <= self.now() - self._tried_s < _AGAIN_S:
            return
        self._tried_s = self.now()
        with suppress(OSError, sqlite3.Error, _OtherVersionError):
            opened = _connect(self.path, _READING_MS)
            self._connection.close()
            self._connection, self._on_disk = opened, True

    def _set_aside(self) -> None:
        """Give a damaged file another name, which nothing has, and say so."""
        path, stamp = self.path, time.strftime("%Y%m%d-%H%M%S")
        name, number = f"{path.name}.damaged-{stamp}", 1
        while path.with_name(name).exists():
            number += 1
            name = f"{path.name}.damaged-{stamp}-{number}"
        path.rename(path.with_name(name))
        for end in ("-wal", "-shm"):
            with suppress(OSError):
                path.with_name(path.name + end).rename(path.with_name(name + end))
        self._say(f"the places in {path} are damaged; the file is now {name}, and a new one begins")


def _connect(path: Path, wait_ms: int) -> sqlite3.Connection:
    """Open the file with places, which is made if it is not there.

    Parameters
    ----------
    path
        Path of the file.
    wait_ms
        How long to wait for another process that is writing.

    Raises
    ------
    OSError, sqlite3.Error, _OtherVersionError
        If the file cannot be opened and written.
    """
    if not path.parent.exists():
        path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    # It has text of a user's books in it: no other user is to read it.
    os.close(os.open(path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600))
    connection = sqlite3.connect(path, isolation_level=None)
    try:
        connection.execute(f"PRAGMA busy_timeout = {wait_ms}")
        _version(connection)
        _try_again(lambda: _choose_journal(connection))
        connection.execute("PRAGMA synchronous = NORMAL")
        connection.execute("PRAGMA secure_delete = ON")
        _try_again(lambda: _make_tables(connection))
        connection.execute(f"PRAGMA busy_timeout = {_READING_MS}")
    except BaseException:
        connection.close()
        raise
    return connection


def _version(connection: sqlite3.Connection) -> int:
    """Version of the file's tables; 0 if it has none yet."""
    (version,) = connection.execute("PRAGMA user_version").fetchone()
    if version not in (0, VERSION):
        raise _OtherVersionError
    return version


def _choose_journal(connection: sqlite3.Connection) -> None:
    """Have transactions logged, or rolled back where a file system cannot share memory."""
    try:
        (mode,) = connection.execute("PRAGMA journal_mode = WAL").fetchone()
        if mode == "wal":
            connection.execute("SELECT count(*) FROM sqlite_schema").fetchone()
            return
    except sqlite3.OperationalError as error:
        if _code(error) in _LOCKED:
            raise
    connection.execute("PRAGMA journal_mode = DELETE").fetchone()


def _make_tables(connection: sqlite3.Connection) -> None:
    if _version(connection):
        return
    connection.execute("BEGIN IMMEDIATE")
    try:
        if not _version(connection):  # another process may have been quicker
            for statement in _TABLES.split(";")[:-1]:
                connection.execute(statement)
            connection.execute(f"PRAGMA user_version = {VERSION}")
        connection.execute("COMMIT")
    except BaseException:
        connection.execute("ROLLBACK")
        raise


def _try_again(step: Callable[[], None]) -> None:
    """Do a step again for a while if another process is doing it just now."""
    for left in reversed(range(_TRIES)):
        try:
            step()
            return
        except sqlite3.OperationalError as error:
            if not left or _code(error) not in _LOCKED:
                raise
            time.sleep(0.02)


def _in_memory(path: Path) -> sqlite3.Connection:
    """Database in memory, with what can be read of a file that cannot be written."""
    connection = sqlite3.connect(":memory:", isolation_level=None)
    with suppress(sqlite3.Error, _OtherVersionError):
        address = f"file:{quote(str(path.absolute()))}?mode=ro&immutable=1"
        kept = sqlite3.connect(address, uri=True)
        try:
            if _version(kept):
                kept.backup(connection)
        finally:
            kept.close()
    _make_tables(connection)
    return connection


def _code(error: sqlite3.Error) -> int:
    return getattr(error, "sqlite_errorcode", 0) & 0xFF


def _reason(error: sqlite3.Error) -> str:
    """Why the file could not be written, in a few words."""
    match _code(error):
        case sqlite3.SQLITE_FULL:
            return "the disk is full"
        case sqlite3.SQLITE_READONLY | sqlite3.SQLITE_CANTOPEN | sqlite3.SQLITE_PERM:
            return "it cannot be written"
        case sqlite3.SQLITE_IOERR:
            return "the disk refused it"
        case sqlite3.SQLITE_BUSY | sqlite3.SQLITE_LOCKED:
            return "another program holds it"
        case code if code in _DAMAGED:
            return "the file is damaged"
    return str(error)


BookOptions = dict[str, bool | int | str | None]


def storable(text: str) -> str:
    """Text without what cannot be written as UTF-8: halves of characters, bytes of no text."""
    return text.encode("utf-8", "replace").decode()


class KeptPlace(msgspec.Struct, frozen=True):
    """A place in a book, told in so many ways that one of them holds later.

    Parameters
    ----------
    character
        Place of the source, counted in characters from 0.
    block
        Number of the block that the character is in.
    share
        How much of the book stands before it, 0 to 1.
    before, after
        Text before the place and from it on, as it is read; a changed book is searched for it.
    reach
        Number of the source's characters that the text before the place is from.
    line
        Number of the line, from 1, in lines of `width` cells by `table`; None if not counted.
    lines_before
        Number of such lines before the block; None if not counted. A `Layout` can begin there.
    width, table
        Width in cells and name of the table for which these numbers hold.
    page
        Number of the page as the book writes or counts it; empty if it has none.
    about
        Whether the share is about right, since the book was not read to its end.
    """

    character: int
    block: int = 0
    share: float = 0.0
    before: str = ""
    after: str = ""
    reach: int = 0
    line: int | None = None
    lines_before: int | None = None
    width: int = 0
    table: str = ""
    page: str = ""
    about: bool = False

    def lines_before_for(self, width: int, table: str) -> int | None:
        """Number of such lines before the block; None if it is not known for them."""
        return self.lines_before if (self.width, self.table) == (width, table) else None


class Bookmark(msgspec.Struct, frozen=True):
    """A place of a book with a name.

    Parameters
    ----------
    name
        Name that the reader gave it.
    character
        Place of the source, counted in characters from 0.
    text
        A few words of the text from there on.
    share
        About how much of the book stands before it, 0 to 1.
    after
        Text from the place on, for which a changed book is searched; empty for that of `text`.
    """

    name: str
    character: int
    text: str = ""
    share: float = 0.0
    after: str = ""


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


AROUND = 200  # characters
# How much text before and after a place is looked for, the most telling first.
_TRIED = ((200, 200), (60, 60), (0, 100), (100, 0), (20, 20), (0, 30))
_LEAST = 12  # a shorter text stands anywhere


def place_in(source: Source, character: int) -> KeptPlace:
    """Place of a source, with the text around it."""
    number = source.block_at(character)
    block = None if number is None else source.block(number)
    if number is None or block is None:
        return KeptPlace(character, share=1.0)
    text, index = str(block.text), block.text.index(character)
    before, after = text[:index], text[index:]
    begins = int(block.text.places[max(0, index - AROUND)]) if index else character
    earlier = source.block(number - 1) if number else None
    if len(before) < AROUND and earlier is not None and len(earlier.text):
        more = AROUND - len(before)
        before = str(earlier.text)[-more:] + ("" if block.continues else " ") + before
        begins = int(earlier.text.places[max(0, len(earlier.text) - more)])
    later = source.block(number + 1) if len(after) < AROUND else None
    if later is not None:
        after += ("" if later.continues else " ") + str(later.text)
    return KeptPlace(
        character,
        number,
        share_before(source, character),
        storable(before[-AROUND:]),
        storable(after[:AROUND]),
        max(0, character - begins),
        about=not source.complete,
    )


def anchored(source: Source, place: KeptPlace) -> tuple[KeptPlace, bool]:
    """Place in a source that has changed since it was kept, and whether the text was found again.

    The nearest to the old place is taken of all where the same text stands. If it stands nowhere,
    the place is the one with the same share of the book before it.
    """
    for before, after in _TRIED:
        head = place.before[len(place.before) - min(before, len(place.before)) :]
        tail = place.after[:after]
        if len((head + tail).strip()) < _LEAST:
            continue
        found = _nearest(source, head + tail, place.character - len(head))
        if found is None:
            continue
        character = found
        if head.strip():
            reach = place.reach if before >= len(place.before) else len(head)
            character = found + reach
            if tail.strip():
                nearer = find_place(source, FindText(tail, found + reach // 2))
                character = character if nearer is None else nearer
        return _again(source, place, character), True
    character = find_place(source, FindShare(place.share)) or 0
    return _again(source, place, character), False


def _again(source: Source, place: KeptPlace, character: int) -> KeptPlace:
    """A new place, with what is still so of the old one; lines are counted anew."""
    return msgspec.structs.replace(place_in(source, character), page=place.page)


def _nearest(source: Source, text: str, character: int) -> int | None:
    character = max(0, character)
    after = find_place(source, FindText(text, character))
    before = find_place(source, FindText(text, character, backward=True))
    near = [at for at in (after, before) if at is not None]
    return min(near, key=lambda at: abs(at - character), default=None)


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
