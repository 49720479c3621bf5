"""The record of a session: one SQLite file with the protocol, the plan, all events and all ticks.

An event is on the disk when `Record.append` returns. Each event, and each blob of ticks, holds the
SHA-256 of itself and of the one before, so that the last one stands for the whole record.
"""

from __future__ import annotations

import json
import os
import sqlite3
import zlib
from collections.abc import Iterator
from contextlib import closing, contextmanager
from datetime import UTC, datetime
from hashlib import sha256
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from vbraille.errors import VbrailleError
from vbraille.sessions.planning.plan import Plan
from vbraille.sessions.planning.trial import Trial

FORMAT = 9
SCHEMA = """
CREATE TABLE session (          -- one row: who, what, and with which equipment
    id INTEGER PRIMARY KEY CHECK (id = 1), format INTEGER NOT NULL, participant TEXT NOT NULL,
    protocol TEXT NOT NULL, seed INTEGER NOT NULL, head TEXT NOT NULL CHECK (json_valid(head))
) STRICT;
CREATE TABLE file (             -- the protocol and what stands beside it, byte for byte
    name TEXT PRIMARY KEY, content BLOB NOT NULL
) STRICT;
CREATE TABLE trial (            -- the plan
    practice INTEGER NOT NULL, number INTEGER NOT NULL, block INTEGER NOT NULL,
    condition TEXT NOT NULL, item TEXT NOT NULL, gap_s REAL NOT NULL, catch TEXT NOT NULL,
    stimuli TEXT NOT NULL CHECK (json_valid(stimuli)),
    PRIMARY KEY (practice, number)
) STRICT;
CREATE TABLE event (            -- what happened, in order
    n INTEGER PRIMARY KEY, kind TEXT NOT NULL, t_s REAL NOT NULL, wall TEXT NOT NULL,
    practice INTEGER, trial INTEGER, attempt INTEGER,
    data TEXT NOT NULL CHECK (json_valid(data)), sum BLOB NOT NULL
) STRICT;
CREATE TABLE ticks (            -- a second or less of the device's ticks; see `read_ticks`
    after INTEGER NOT NULL REFERENCES event (n), first INTEGER NOT NULL, count INTEGER NOT NULL,
    first_line INTEGER NOT NULL, last_line INTEGER NOT NULL, fields BLOB NOT NULL,
    sum BLOB NOT NULL, PRIMARY KEY (after, first)
) STRICT;
CREATE INDEX ticks_of_line ON ticks (first_line);
CREATE INDEX event_of_trial ON event (kind, practice, trial);
CREATE TRIGGER events_do_not_change BEFORE UPDATE ON event
    BEGIN SELECT RAISE(ABORT, 'events do not change'); END;
CREATE TRIGGER events_do_not_go BEFORE DELETE ON event
    BEGIN SELECT RAISE(ABORT, 'events do not go'); END;
CREATE VIEW answers AS          -- the answer of each trial that counts
    SELECT t.practice, t.number AS trial, t.block, t.condition, t.catch, t.item, e.attempt,
        json_extract(e.data, '$.answer') AS answer, e.t_s, e.wall
    FROM trial t LEFT JOIN event e ON e.kind = 'answer' AND e.n = (
        SELECT max(n) FROM event
        WHERE kind IN ('answer', 'undo') AND trial = t.number AND practice = t.practice);
"""
# Kinds of events, and what each says. The codebook has these words.
KINDS = {
    "session": "the plan was made",
    "run": "a console began to run the session, or went on with it",
    "cue": "a stimulus was put under the hand",
    "contact": "the array came to the first dot",
    "read": "the hand was at the end of the line and back",
    "ended": "reading was ended by a key or by time",
    "warning": "the participant was warned that time is over soon",
    "answer": "an answer was given",
    "confidence": "it was said how sure the last answer is",
    "reply": "a question of the questionnaire was answered",
    "undo": "the answer of the trial was taken back",
    "repeat": "the trial is shown again",
    "fault": "the stimulus could not be felt",
    "pause": "the array was brought to rest",
    "go": "a pause or a break ended",
    "break": "a break began",
    "note": "the experimenter noted something",
    "stop": "the console stopped; the session can be resumed",
    "end": "the session is over",
}
TICK = np.dtype(
    [(name, "<i8") for name in ("tick", "time_ns", "device_ns", "line", "part", "flags", "late")]
    + [(name, "<f8") for name in ("x_mm", "y_mm", "theta_rad", "vx_mm_s", "vy_mm_s")]
    + [(name, "<f8") for name in ("shown_s", "share")]
)
TICKS_A_BLOB = 1000
LAST = """
    SELECT event.n, ifnull(ticks.sum, event.sum) FROM event LEFT JOIN ticks ON after = n
    ORDER BY n DESC, first DESC LIMIT 1
"""


class RecordError(VbrailleError):
    """The record cannot be read or written; the message says what to do."""


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

    Raises
    ------
    RecordError
        If there is such a file, or it cannot be written.
    """
    partial = path.with_name(f".{path.name}.new")
    partial.unlink(missing_ok=True)  # of a console that was killed
    try:
        with told(path), closing(sqlite3.connect(partial, isolation_level=None)) as db:
            partial.chmod(0o600)
            db.execute("PRAGMA synchronous = EXTRA")
            db.executescript(f"BEGIN; {SCHEMA}")
            row = (FORMAT, plan.participant, head["protocol"], plan.seed, json.dumps(head))
            db.execute("INSERT INTO session VALUES (1, ?, ?, ?, ?, ?)", row)
            db.executemany("INSERT INTO file VALUES (?, ?)", files.items())
            rows = map(_trial_row, plan.trials)
            db.executemany("INSERT INTO trial VALUES (?, ?, ?, ?, ?, ?, ?, ?)", rows)
            _insert(db, _event(1, "session", 0.0, None, None, {"plan": _plan_sum(db)}), bytes(32))
            db.execute("COMMIT")
        os.link(partial, path)
    except FileExistsError:
        raise RecordError(f"{path} is there already; choose another name") from None
    except OSError as error:
        raise RecordError(f"{path}: {error.strerror}") from None
    finally:
        partial.unlink(missing_ok=True)
    folder = os.open(path.parent, os.O_RDONLY)
    os.fsync(folder)
    os.close(folder)


class Record:
    """A record that is open to be added to. No other console can open it meanwhile."""

    def __init__(self, path: Path) -> None:
        self.path = path
        with told(path):
            uri = f"file:{path}?mode=rw"
            self._db = sqlite3.connect(uri, uri=True, isolation_level=None, timeout=0)
            self._db.execute("PRAGMA locking_mode = EXCLUSIVE")
            self._db.execute("PRAGMA journal_mode = TRUNCATE")
            self._db.execute("PRAGMA synchronous = FULL")
            self._db.executescript("BEGIN IMMEDIATE; COMMIT")
            self._n, self.sum = self._db.execute(LAST).fetchone()
        self._waiting: list[NDArray[np.void]] = []

    def append(
        self, kind: str, t_s: float, trial: Trial | None = None, attempt: int = 0, **data: Any
    ) -> Event:
        """Add an event, and return it; it is on the disk then, an answer with its ticks."""
        assert kind in KINDS, kind
        event = _event(self._n + 1, kind, t_s, trial, attempt, data)
        with self._transaction():
            before = self._insert_ticks() if kind == "answer" else self.sum
            sum_ = _insert(self._db, event, before)
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
        self.sum = sum_

    def _insert_ticks(self) -> bytes:
        """Insert the ticks that wait, and return the newest sum."""
        if not self._waiting:
            return self.sum
        ticks = np.concatenate(self._waiting)
        self._waiting = []
        kept = np.empty(ticks.size, TICK)
        for name in TICK.names or ():
            kept[name] = ticks[name]
        fields = _pack(kept)
        sum_ = sha256(self.sum + fields).digest()
        lines = int(kept["line"][0]), int(kept["line"][-1])
        row = (self._n, int(kept["tick"][0]), kept.size, *lines, fields, sum_)
        self._db.execute("INSERT INTO ticks VALUES (?, ?, ?, ?, ?, ?, ?)", row)
        return sum_

    def close(self) -> None:
        """Write the ticks that wait, and close the file, which then stands alone."""
        self.write_ticks()
        with closing(self._db), told(self.path):
            self._db.execute("PRAGMA journal_mode = DELETE")

    def read(self) -> Content:
        """Read everything but the ticks."""
        with told(self.path):
            return _read(self.path, self._db)

    @contextmanager
    def _transaction(self) -> Iterator[None]:
        with told(self.path):
            self._db.execute("BEGIN IMMEDIATE")
            try:
                yield
                self._db.execute("COMMIT")
            except BaseException:
                if self._db.in_transaction:
                    self._db.execute("ROLLBACK")
                raise


class Content(Struct, frozen=True):
    """What a record holds beside its ticks."""

    path: Path
    head: dict[str, Any]
    files: dict[str, bytes]
    plan: Plan
    events: tuple[Event, ...]


def read(path: Path) -> Content:
    """Read a record, which may be in use.

    Raises
    ------
    RecordError
        If it cannot be read.
    """
    with reading(path) as db:
        return _read(path, db)


@contextmanager
def reading(path: Path) -> Iterator[sqlite3.Connection]:
    """Open a record to read it. What a crash left half done is first taken back, if that can be."""
    writable = os.access(path, os.W_OK) and os.access(path.parent, os.W_OK)
    uri = f"file:{path}?mode={'rw' if writable else 'ro'}"
    with told(path), closing(sqlite3.connect(uri, uri=True)) as db:
        db.execute("PRAGMA query_only = ON")
        yield db


def _read(path: Path, db: sqlite3.Connection) -> Content:
    participant, seed, head = db.execute("SELECT participant, seed, head FROM session").fetchone()
    head = json.loads(head)
    trials = tuple(
        msgspec.convert(dict(zip(_TRIAL, row, strict=True)), Trial, strict=False)
        for row in _with_json(db.execute("SELECT * FROM trial ORDER BY practice DESC, number"))
    )
    query = "SELECT n, kind, t_s, wall, practice, trial, attempt, data FROM event ORDER BY n"
    events = tuple(Event(*row) for row in _with_json(db.execute(query)))
    files = dict(db.execute("SELECT name, content FROM file"))
    return Content(
        path, head, files, Plan(participant, seed, head["order"], head["group"], trials), events
    )


_TRIAL = ("practice", "number", "block", "condition", "item", "gap_s", "catch", "stimuli")


def _trial_row(trial: Trial) -> tuple[Any, ...]:
    *values, stimuli = (getattr(trial, name) for name in _TRIAL)
    return *values, msgspec.json.encode(stimuli).decode()


def _with_json(rows: Iterator[tuple[Any, ...]]) -> Iterator[tuple[Any, ...]]:
    """Decode the last column of each row."""
    for *row, data in rows:
        yield *row, msgspec.json.decode(data)


def _event(
    n: int, kind: str, t_s: float, trial: Trial | None, attempt: int | None, data: dict[str, Any]
) -> Event:
    wall = f"{datetime.now(UTC):%Y-%m-%dT%H:%M:%S.%fZ}"
    where = (None, None, None) if trial is None else (int(trial.practice), trial.number, attempt)
    # A whole number would come back from SQLite as another one than was hashed.
    return Event(n, kind, float(round(t_s, 6)), wall, *where, data)


def _insert(db: sqlite3.Connection, event: Event, before: bytes) -> bytes:
    """Insert an event, and return its sum."""
    row = [*msgspec.structs.astuple(event)[:-1], json.dumps(event.data, ensure_ascii=False)]
    sum_ = _sum_of(row, before)
    db.execute("INSERT INTO event VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)", (*row, sum_))
    return sum_


def _sum_of(row: list[Any], before: bytes) -> bytes:
    return sha256(before + json.dumps(row, ensure_ascii=False).encode()).digest()


def _plan_sum(db: sqlite3.Connection) -> str:
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


def _pack(ticks: NDArray[np.void]) -> bytes:
    """Compress each field's differences from tick to tick."""
    words = np.ascontiguousarray(ticks).view("<i8").reshape(-1, len(TICK)).T
    return zlib.compress(np.diff(words, axis=1, prepend=0).tobytes(), 1)


def _unpack(fields: bytes) -> NDArray[np.void]:
    words = np.frombuffer(zlib.decompress(fields), "<i8").reshape(len(TICK), -1).cumsum(axis=1)
    return np.ascontiguousarray(words.T).view(TICK).ravel()


def read_ticks(db: sqlite3.Connection, first_line: int, last_line: int) -> NDArray[np.void]:
    """Return the ticks of some showings."""
    # Showings are numbered in the order of time, so that the ticks of one stand together.
    query = """
        SELECT fields FROM ticks WHERE last_line >= :first AND first_line BETWEEN
            ifnull((SELECT max(first_line) FROM ticks WHERE first_line < :first), 0) AND :last
        ORDER BY after, first
    """
    found = db.execute(query, {"first": first_line, "last": last_line})
    blobs = [_unpack(fields) for (fields,) in found]
    ticks = np.concatenate([np.empty(0, TICK), *blobs])
    return ticks[(ticks["line"] >= first_line) & (ticks["line"] <= last_line)]


def check(path: Path) -> list[str]:
    """Return a sentence for everything that is wrong with a record.

    What was taken off the end of a session that has not ended cannot be seen, nor can a change by
    somebody who has computed all sums anew.
    """
    faults: list[str] = []
    try:
        with reading(path) as db:
            result = [said for (said,) in db.execute("PRAGMA integrity_check")]
            faults += [f"file: {said}" for said in result if said != "ok"]
            (data,) = db.execute("SELECT data FROM event WHERE n = 1").fetchone()
            if json.loads(data)["plan"] != _plan_sum(db):
                faults.append("the protocol or the plan was changed")
            before, ticks = bytes(32), "SELECT first, fields, sum FROM ticks WHERE after = ?"
            for number, (*row, sum_) in enumerate(db.execute("SELECT * FROM event ORDER BY n"), 1):
                if row[0] != number or sum_ != _sum_of(row, before):
                    faults.append(f"event {row[0]}, or what stands before it, was changed")
                before = sum_
                for first, fields, sum_ in db.execute(f"{ticks} ORDER BY first", (number,)):
                    if sum_ != sha256(before + fields).digest():
                        faults.append(f"ticks after event {number}, from {first} on, were changed")
                    before = sum_
    except (RecordError, sqlite3.Error, TypeError) as error:
        faults.append(f"file: {error}")
    return faults


@contextmanager
def told(path: Path) -> Iterator[None]:
    """Raise errors of SQLite as a `RecordError` that says what to do."""
    try:
        yield
    except sqlite3.Error as error:
        name = getattr(error, "sqlite_errorname", "")
        what = {
            "SQLITE_FULL": "the disk is full; make room, then resume",
            "SQLITE_BUSY": "it is open in another console; end that one first",
            "SQLITE_READONLY": "it may not be written; mend its permissions",
            "SQLITE_NOTADB": "it is not a session",
            "SQLITE_CANTOPEN": "there is no such file, or it may not be read",
        }.get(name, f"{error}; session check says what is whole")
        raise RecordError(f"{path}: {what}") from error
