"""The record of a session: one SQLite file with the protocol, the plan, all events and all ticks.

An event is on the disk when `Record.append` returns. Each event, and each blob of ticks, holds the
SHA-256 of itself and of the one before, so that the last one stands for the whole record.
"""

from __future__ import annotations

import json
import os
import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from datetime import UTC, datetime
from hashlib import sha256
from pathlib import Path
from typing import Any, NamedTuple

import msgspec
import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from vbraille.csvfiles import read_csv
from vbraille.errors import InputError, VbrailleError
from vbraille.files import sync_names, whole_file
from vbraille.sessions.planning.plan import Plan
from vbraille.sessions.planning.trial import Trial
from vbraille.sessions.record.ticks import pack

FORMAT = 1
SCHEMA = Path(__file__).with_name("schema.sql").read_text("utf-8")


class Kind(NamedTuple):
    """A kind of event: its byte on a serial port, its moment in playback, and its meaning."""

    byte: int
    moment: str
    meaning: str


KINDS = {
    kind: Kind(int(byte), moment, meaning)
    for kind, byte, moment, meaning in read_csv(Path(__file__).with_name("events.csv")).rows
}
TICKS_A_BLOB = 1000
LAST = """
    SELECT event.n, ifnull(ticks.sum, event.sum) FROM event LEFT JOIN ticks ON after = n
    ORDER BY n DESC, first DESC LIMIT 1
"""
TRIAL = ("practice", "number", "block", "condition", "item", "gap_s", "catch", "columns", "stimuli")
START = bytes(32)  # what the first event's sum goes on from


class RecordError(VbrailleError):
    """The record cannot be read or written; the message says what to do."""


class NoRecordError(RecordError, InputError):
    """There is no such record, or there is one already where a new one should be."""


class Event(Struct, frozen=True):
    """Something that happened.

    Parameters
    ----------
    n
        Number of the event, from 1.
    kind
        One of `KINDS`.
    t_s
        Time that the session had run for.
    wall
        Time of day, in UTC.
    practice, trial, attempt
        Trial that it happened in, and which attempt at it; None if it was in none.
    data
        Everything else, such as the answer.
    """

    n: int
    kind: str
    t_s: float
    wall: str
    practice: int | None
    trial: int | None
    attempt: int | None
    data: dict[str, Any]

    @property
    def key(self) -> tuple[bool, int] | None:
        """Practice and number of the trial; None if it happened in none."""
        return None if self.trial is None else (bool(self.practice), self.trial)


def create(path: Path, head: dict[str, Any], files: dict[str, bytes], plan: Plan) -> None:
    """Write a new record; it is on the disk whole, or not at all.

    Parameters
    ----------
    head
        All that is known of the session before it begins; protocol, order, group and fields at
        least.

    Raises
    ------
    RecordError
        If there is such a file, or it cannot be written.
    """
    if path.exists():
        raise NoRecordError(f"{path} is there already; choose another name")
    try:
        with whole_file(path) as partial:
            partial.unlink(missing_ok=True)  # of a console that was killed
            with told(path), closing(connect(partial, "rwc")) as db:
                partial.chmod(0o600)
                db.execute("PRAGMA synchronous = EXTRA")
                db.executescript(f"BEGIN; {SCHEMA}")
                row = (1, FORMAT, plan.participant, head["protocol"], plan.seed, json.dumps(head))
                insert(db, "session", row)
                for named in files.items():
                    insert(db, "file", named)
                for trial in plan.trials:
                    insert(db, "trial", _trial_row(trial))
                _insert_event(db, _event(1, "session", 0.0, None, None, plan=plan_sum(db)), START)
                db.execute("COMMIT")
        sync_names(path.parent)
    except OSError as error:
        raise RecordError(f"{path}: {error.strerror}") from None


class Record:
    """A record that is open to be added to. No other console can open it meanwhile.

    Attributes
    ----------
    sum : bytes
        Sum of the newest event or blob of ticks, which stands for the whole record.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        with told(path):
            self._db = connect(path, "rw")
            self._db.execute("PRAGMA locking_mode = EXCLUSIVE")
            self._db.execute("PRAGMA journal_mode = TRUNCATE")
            self._db.execute("PRAGMA synchronous = FULL")
            self._db.executescript("BEGIN EXCLUSIVE; COMMIT")
            self._n, self.sum = self._db.execute(LAST).fetchone()
        self._waiting: list[NDArray[np.void]] = []

    def append(
        self, kind: str, t_s: float, trial: Trial | None = None, attempt: int = 0, **data: Any
    ) -> Event:
        """Add an event, and return it; it is on the disk then, an answer with its ticks."""
        assert kind in KINDS, kind
        event = _event(self._n + 1, kind, t_s, trial, attempt, **data)
        with self._transaction():
            before = self._insert_ticks() if kind == "answer" else self.sum
            sum_ = _insert_event(self._db, event, before)
        self._waiting = [] if kind == "answer" else self._waiting
        self._n, self.sum = event.n, sum_
        return event

    def add_ticks(self, ticks: NDArray[np.void]) -> None:
        """Take ticks of the engine; they are written by the second."""
        self._waiting.append(ticks)
        if sum(each.size for each in self._waiting) >= TICKS_A_BLOB:
            self.write_ticks()

    def write_ticks(self) -> None:
        """Write the ticks that wait."""
        with self._transaction():
            sum_ = self._insert_ticks()
        self._waiting, self.sum = [], sum_

    def _insert_ticks(self) -> bytes:
        """Insert the ticks that wait, and return the newest sum."""
        if not self._waiting:
            return self.sum
        ticks = np.concatenate(self._waiting)
        fields = pack(ticks)
        sum_ = sha256(self.sum + fields).digest()
        shown = ticks["line"][ticks["line"] > 0]  # before its first showing a run has line 0
        lines = (int(shown.min()), int(shown.max())) if shown.size else (0, 0)
        first = int(ticks["tick"][0])
        insert(self._db, "ticks", (self._n, first, ticks.size, *lines, fields, sum_))
        return sum_

    def close(self) -> None:
        """Write the ticks that wait, and close the file, which then stands alone."""
        with closing(self._db):
            self.write_ticks()
            with self._transaction():
                self._db.execute("INSERT OR REPLACE INTO seal VALUES (1, ?)", (self.sum,))
            with told(self.path):
                self._db.execute("PRAGMA journal_mode = DELETE")

    def read(self) -> Content:
        """Read everything but the ticks."""
        with told(self.path):
            return _read(self.path, self._db)

    @contextmanager
    def _transaction(self) -> Iterator[None]:
        with told(self.path), self._db:  # which commits, or rolls back
            self._db.execute("BEGIN IMMEDIATE")
            yield


class Content(Struct, frozen=True):
    """Content of a record beside its ticks."""

    path: Path
    head: dict[str, Any]
    files: dict[str, bytes]
    plan: Plan
    events: tuple[Event, ...]


def read(path: Path) -> Content:
    """Read a record.

    Raises
    ------
    RecordError
        If it cannot be read, or a console runs the session.
    """
    with reading(path) as db:
        return _read(path, db)


@contextmanager
def reading(path: Path) -> Iterator[sqlite3.Connection]:
    """Open a record to read it. What a crash left half done is first taken back, if that can be."""
    writable = os.access(path, os.W_OK) and os.access(path.parent, os.W_OK)
    with told(path), closing(connect(path, "rw" if writable else "ro")) as db:
        db.execute("PRAGMA query_only = ON")
        yield db


def participant_of(path: Path) -> str:
    """Return whose session a file is; empty if it cannot be read."""
    try:
        with reading(path) as db:
            return str(db.execute("SELECT participant FROM session").fetchone()[0])
    except (VbrailleError, OSError, TypeError):
        return ""


def connect(path: Path, mode: str) -> sqlite3.Connection:
    """Open a file of SQLite, which does not wait for another console."""
    uri = f"{path.absolute().as_uri()}?mode={mode}"
    return sqlite3.connect(uri, uri=True, isolation_level=None, timeout=0)


def _read(path: Path, db: sqlite3.Connection) -> Content:
    query = "SELECT format, participant, seed, head FROM session"
    version, participant, seed, head = db.execute(query).fetchone()
    if version != FORMAT:
        raise RecordError(f"{path} has format {version}; use a vbraille that knows it")
    head = json.loads(head)
    trials = []
    for row in db.execute("SELECT * FROM trial ORDER BY practice DESC, number"):
        values = (*row[:-2], *map(json.loads, row[-2:]))
        fields = dict(zip(TRIAL, values, strict=True))
        trials.append(msgspec.convert(fields, Trial, strict=False))
    query = "SELECT n, kind, t_s, wall, practice, trial, attempt, data FROM event ORDER BY n"
    rows = db.execute(query)
    events = tuple(Event(*row[:-1], json.loads(row[-1])) for row in rows)  # pyright: ignore
    files = dict(db.execute("SELECT name, content FROM file"))
    plan = Plan(participant, seed, head["order"], head["group"], tuple(trials), head["session"])
    return Content(path, head, files, plan, events)


def _trial_row(trial: Trial) -> list[Any]:
    row = [getattr(trial, name) for name in TRIAL]
    return [*row[:-2], *(msgspec.json.encode(value).decode() for value in row[-2:])]


def _event(
    n: int, kind: str, t_s: float, trial: Trial | None, attempt: int | None, **data: Any
) -> Event:
    wall = f"{datetime.now(UTC):%Y-%m-%dT%H:%M:%S.%fZ}"
    where = (None, None, None) if trial is None else (int(trial.practice), trial.number, attempt)
    # A whole number would come back from SQLite as another one than was hashed.
    return Event(n, kind, float(round(t_s, 6)), wall, *where, data)


def insert(db: sqlite3.Connection, table: str, row: Sequence[Any]) -> None:
    """Insert a row into a table."""
    db.execute(f"INSERT INTO {table} VALUES ({', '.join('?' * len(row))})", row)


def _insert_event(db: sqlite3.Connection, event: Event, before: bytes) -> bytes:
    """Insert an event, and return its sum."""
    row = [*msgspec.structs.astuple(event)[:-1], json.dumps(event.data, ensure_ascii=False)]
    sum_ = sha256(before + encoded(row)).digest()
    insert(db, "event", (*row, sum_))
    return sum_


def encoded(row: list[Any]) -> bytes:
    """Return the columns of an event as JSON, which its sum is made of."""
    return json.dumps(row, ensure_ascii=False).encode()


def plan_sum(db: sqlite3.Connection) -> str:
    """Return the SHA-256 of everything that does not change after the session was planned."""
    total = sha256()
    for query in (
        "SELECT * FROM session",
        "SELECT * FROM file ORDER BY name",
        "SELECT * FROM trial ORDER BY practice, number",
    ):
        for row in db.execute(query):
            total.update(repr(row).encode())
    return total.hexdigest()


@contextmanager
def told(path: Path) -> Iterator[None]:
    """Raise errors of SQLite as a `RecordError` that says what to do."""
    try:
        yield
    except sqlite3.Error as error:
        name = getattr(error, "sqlite_errorname", "")
        if "no such table" in str(error):
            name = "SQLITE_NOTADB"
        what = next((words for begin, words in SAID.items() if name.startswith(begin)), None)
        what = what or f"{error}; session check says what is whole"
        kind = NoRecordError if name in ("SQLITE_NOTADB", "SQLITE_CANTOPEN") else RecordError
        raise kind(f"{path}: {what}") from error


# What is said of errors, by the beginnings of their names.
SAID = {
    "SQLITE_FULL": "the disk is full; make room, then resume",
    "SQLITE_IOERR": "the disk failed; mend it, then resume",
    "SQLITE_BUSY": "it is open in another console; end that one first",
    "SQLITE_READONLY_ROLLBACK": "a crash left it half done, and it may not be written; copy it",
    "SQLITE_READONLY": "it may not be written; mend its permissions",
    "SQLITE_NOTADB": "it is not a session",
    "SQLITE_CANTOPEN": "there is no such file, or it may not be read",
}
