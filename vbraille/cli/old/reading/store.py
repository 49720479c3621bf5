"""The file of a reader's books: an SQLite database that outlives damage, crowds and full disks."""

from __future__ import annotations

import os
import sqlite3
import time
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final
from urllib.parse import quote

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence


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
