"""The database of places as books use it: errors become notes, and reading goes on."""

from __future__ import annotations

import sqlite3
import time
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any

from vbraille.reading.places.database import (
    READING_MS,
    NewerPlacesError,
    connect,
    failed_note,
    is_damage,
    is_lock,
    open_database,
    reason,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from pathlib import Path

_PATIENT_MS = 3_000
_AGAIN_S = 2.0  # between two tries to open a file that could not be written
_Statement = tuple[str, tuple[Any, ...]]


class Store:
    """A database of places.

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

    def __init__(self, path: Path, now: Callable[[], float] = time.time) -> None:
        self.path = path
        self.now = now
        opened = open_database(path)
        self._connection = opened.connection
        self._note = opened.note
        self.fault = opened.fault
        self._on_disk = opened.fault is None
        self._tried_s = now()
        self._noted = opened.note is not None  # one is enough, whatever comes after it

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

    def write(self, statements: Sequence[_Statement], row: _Statement | None = None) -> bool:
        """Write by statements, all or none; whether they are on the disk.

        A file that could not be opened is tried again, but not all the time.

        Parameters
        ----------
        statements
            SQL of each with its values.
        row
            Statement that is done before them.
        """
        if not self._on_disk:
            self._open_again()
        try:
            with self.transaction() as connection:
                if row is not None:
                    connection.execute(*row)
                for sql, values in statements:
                    connection.execute(sql, values)
        except sqlite3.Error as error:
            self.take(error)
            return False
        if self._on_disk:
            self.fault = None
        return self._on_disk

    def _open_again(self) -> None:
        """Open the file in place of what stands in for it, if it can be opened by now."""
        if self._tried_s is not None and 0 <= self.now() - self._tried_s < _AGAIN_S:
            return
        self._tried_s = self.now()
        with suppress(OSError, sqlite3.Error, NewerPlacesError):
            opened = connect(self.path, READING_MS)
            self._connection.close()
            self._connection, self._on_disk = opened, True

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
        """Wait for other processes in a block, as nobody's hand is held up by it."""
        self._tried_s = None
        self._connection.execute(f"PRAGMA busy_timeout = {_PATIENT_MS}")
        try:
            yield
        finally:
            with suppress(sqlite3.Error):
                self._connection.execute(f"PRAGMA busy_timeout = {READING_MS}")

    def shrink(self) -> bool:
        """Have nothing of what was deleted left in the file or in its log."""
        try:
            self._connection.execute("PRAGMA wal_checkpoint(TRUNCATE)").fetchone()
        except sqlite3.Error as error:
            self.take(error)
        return True

    def close(self) -> None:
        """Close the file. Nothing can be read or written after that."""
        with suppress(sqlite3.Error):
            self._connection.close()

    def take(self, error: sqlite3.Error) -> None:
        """Make a note of an error; a damaged file is set aside, and another is begun."""
        if is_lock(error):
            return  # another process is writing; it is tried again
        if is_damage(error) and self._on_disk:
            self.close()
            opened = open_database(self.path, damaged=True)
            self._connection, self._note, self.fault = opened.connection, opened.note, opened.fault
            self._on_disk = opened.fault is None
            self._noted = True
            return
        if self._on_disk:
            self.fault = reason(error)
        if not self._noted:
            self._noted = True
            self._note = failed_note(self.path, error)
