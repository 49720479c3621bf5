"""The database of places as books use it: errors become notes, and reading goes on."""

from __future__ import annotations

import sqlite3
import time
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any

from vbraille.reading.places.database import (
    failed_note,
    is_damage,
    is_lock,
    open_database,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from pathlib import Path

_PATIENT_MS, _READING_MS = 3_000, 10
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
    on_disk : bool
        Whether what is written is kept when the program ends.
    """

    def __init__(self, path: Path, now: Callable[[], float] = time.time) -> None:
        self.path = path
        self.now = now
        opened = open_database(path)
        self._connection = opened.connection
        self._note = opened.note
        self.on_disk = opened.on_disk
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
        """Write by statements, all or none; whether they were written.

        Parameters
        ----------
        statements
            SQL of each with its values.
        row
            Statement that is done before them.
        """
        try:
            with self.transaction() as connection:
                if row is not None:
                    connection.execute(*row)
                for sql, values in statements:
                    connection.execute(sql, values)
        except sqlite3.Error as error:
            self.take(error)
            return False
        return True

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
        self._connection.execute(f"PRAGMA busy_timeout = {_PATIENT_MS}")
        try:
            yield
        finally:
            with suppress(sqlite3.Error):
                self._connection.execute(f"PRAGMA busy_timeout = {_READING_MS}")

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
        if is_damage(error) and self.on_disk:
            self.close()
            opened = open_database(self.path, damaged=True)
            self._connection, self._note, self.on_disk = (
                opened.connection,
                opened.note,
                opened.on_disk,
            )
            self._noted = True
        elif not self._noted:
            self._noted = True
            self._note = failed_note(self.path, error)
