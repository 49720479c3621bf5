"""The file in which places are kept: opened, or something in its stead, so that reading goes on."""

from __future__ import annotations

import os
import sqlite3
import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote

VERSION = 1
ENVIRONMENT = "VBRAILLE_PLACES"
# A reader's hand must not be held up by another process that writes; opening may wait.
_OPENING_MS, READING_MS = 3_000, 10
_TRIES = 20
_DAMAGED = (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB)
_LOCKED = (sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED)
_TABLES = """
CREATE TABLE books (
    id INTEGER PRIMARY KEY AUTOINCREMENT, digest TEXT, path BLOB NOT NULL, size INTEGER NOT NULL,
    mtime_ns INTEGER NOT NULL, inode INTEGER NOT NULL, title TEXT NOT NULL, read_s REAL NOT NULL,
    replaced INTEGER NOT NULL, settled INTEGER NOT NULL, options BLOB, place BLOB, tuning BLOB
);
CREATE INDEX books_digest ON books (digest);
CREATE INDEX books_path ON books (path);
CREATE INDEX books_size ON books (size);
CREATE TABLE bookmarks (
    book INTEGER NOT NULL, name TEXT NOT NULL, packed BLOB NOT NULL, PRIMARY KEY (book, name)
);
CREATE TABLE indices (book INTEGER PRIMARY KEY, packed BLOB NOT NULL);
"""


class NewerPlacesError(Exception):
    """A later version of the program has written the file."""


@dataclass(slots=True)
class Opened:
    """A database that is open.

    Parameters
    ----------
    connection
        Connection to it; each statement is a transaction unless one is begun.
    note
        Sentence on why it is not the file that was asked for; None if it is.
    fault
        Why nothing that is written is kept; None if it is kept.
    """

    connection: sqlite3.Connection
    note: str | None
    fault: str | None = None


def usual_path() -> Path:
    """Path of the file in which this user's places are kept."""
    if given := os.environ.get(ENVIRONMENT):
        return Path(given)
    from platformdirs import user_data_path

    return user_data_path("vbraille", appauthor=False) / "places.sqlite"


def open_database(path: Path, *, damaged: bool = False) -> Opened:
    """Open the file with places, or what stands in for it: this never fails.

    A damaged file is set aside, and another is begun. Where no file can be written, places are
    kept in memory until `connect` succeeds.

    Parameters
    ----------
    path
        Path of the file.
    damaged
        Whether it was found to be damaged.
    """
    if damaged:
        return _begin_anew(path)
    try:
        return Opened(connect(path), None)
    except NewerPlacesError:
        why = "a newer vbraille has written it"
    except sqlite3.Error as error:
        if is_damage(error):
            return _begin_anew(path)
        why = reason(error)
    except OSError as error:
        why = error.strerror or str(error)
    note = f"places cannot be kept in {path}: {why}; reading goes on, and it is tried again"
    return Opened(_in_memory(path), note, why)


def is_damage(error: sqlite3.Error) -> bool:
    """Whether an error means that the file is damaged."""
    return _code(error) in _DAMAGED


def is_lock(error: sqlite3.Error) -> bool:
    """Whether an error means that another process is writing just now."""
    return _code(error) in _LOCKED


def failed_note(path: Path, error: sqlite3.Error) -> str:
    """Sentence on an error in writing."""
    why = reason(error)
    return f"places cannot be kept in {path} now: {why}; reading goes on, and it is tried again"


def set_aside(path: Path) -> Path:
    """Give a damaged file another name, which nothing has, and tell that name."""
    stamp = time.strftime("%Y%m%d-%H%M%S")
    name, number = f"{path.name}.damaged-{stamp}", 1
    while path.with_name(name).exists():
        number += 1
        name = f"{path.name}.damaged-{stamp}-{number}"
    aside = path.with_name(name)
    path.rename(aside)
    for end in ("-wal", "-shm"):
        with suppress(OSError):
            path.with_name(path.name + end).rename(aside.with_name(name + end))
    return aside


def _begin_anew(path: Path) -> Opened:
    try:
        aside = set_aside(path)
        note = (
            f"the places in {path} are damaged; the file is now {aside.name}, and a new one begins"
        )
        return Opened(connect(path), note)
    except (OSError, sqlite3.Error):
        why = "the file is damaged"
        note = f"the places in {path} are damaged; reading goes on, and this reading is not kept"
        return Opened(_in_memory(None), note, why)


def connect(path: Path, wait_ms: int = _OPENING_MS) -> sqlite3.Connection:
    """Open the file with places, which is made if it is not there.

    Parameters
    ----------
    path
        Path of the file.
    wait_ms
        How long to wait for another process that is writing.

    Raises
    ------
    OSError, sqlite3.Error, NewerPlacesError
        If the file cannot be opened and written.
    """
    if not path.parent.exists():
        path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    # It has text of somebody's books in it: nobody else is to read it.
    os.close(os.open(path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600))
    connection = sqlite3.connect(path, isolation_level=None)
    try:
        connection.execute(f"PRAGMA busy_timeout = {wait_ms}")
        _check_version(connection)
        _again(lambda: _choose_journal(connection))
        connection.execute("PRAGMA synchronous = NORMAL")
        connection.execute("PRAGMA secure_delete = ON")
        _again(lambda: _make_tables(connection))
        connection.execute(f"PRAGMA busy_timeout = {READING_MS}")
    except BaseException:
        connection.close()
        raise
    return connection


def _check_version(connection: sqlite3.Connection) -> int:
    (version,) = connection.execute("PRAGMA user_version").fetchone()
    if version > VERSION:
        raise NewerPlacesError
    return version


def _choose_journal(connection: sqlite3.Connection) -> None:
    """Have transactions logged, or rolled back where a file system cannot share memory."""
    try:
        (mode,) = connection.execute("PRAGMA journal_mode = WAL").fetchone()
        if mode == "wal":
            connection.execute("SELECT count(*) FROM sqlite_schema").fetchone()
            return
    except sqlite3.OperationalError as error:
        if is_lock(error):
            raise
    connection.execute("PRAGMA journal_mode = DELETE").fetchone()


def _make_tables(connection: sqlite3.Connection) -> None:
    if _check_version(connection) == VERSION:
        return
    connection.execute("BEGIN IMMEDIATE")
    try:
        if _check_version(connection) < VERSION:  # another process may have been quicker
            for statement in _TABLES.split(";")[:-1]:
                connection.execute(statement)
            connection.execute(f"PRAGMA user_version = {VERSION}")
        connection.execute("COMMIT")
    except BaseException:
        connection.execute("ROLLBACK")
        raise


def _again(step) -> None:
    """Do a step again for a while if another process is doing it just now."""
    for left in reversed(range(_TRIES)):
        try:
            step()
            return
        except sqlite3.OperationalError as error:
            if not left or not is_lock(error):
                raise
            time.sleep(0.02)


def _in_memory(path: Path | None) -> sqlite3.Connection:
    """Database in memory, with what can be read of a file that is no use.

    Books that are new in it have numbers that no book of the file gets meanwhile.
    """
    connection = _copy(path)
    connection.execute("DELETE FROM sqlite_sequence")
    connection.execute("INSERT INTO sqlite_sequence VALUES ('books', ?)", (time.time_ns(),))
    return connection


def _copy(path: Path | None) -> sqlite3.Connection:
    connection = sqlite3.connect(":memory:", isolation_level=None)
    if path is not None:
        with suppress(sqlite3.Error, NewerPlacesError):
            address = f"file:{quote(str(path.absolute()))}?mode=ro&immutable=1"
            kept = sqlite3.connect(address, uri=True)
            try:
                if _check_version(kept) == VERSION:
                    kept.backup(connection)
                    return connection
            finally:
                kept.close()
    _make_tables(connection)
    return connection


def _code(error: sqlite3.Error) -> int:
    return getattr(error, "sqlite_errorcode", 0) & 0xFF


def reason(error: sqlite3.Error) -> str:
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
    return str(error)
