"""Checks of a record, and salvage of one that is not whole."""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Iterator
from contextlib import closing, suppress
from hashlib import sha256
from pathlib import Path
from typing import Any

from vbraille.sessions.record.record import (
    LAST,
    SCHEMA,
    START,
    RecordError,
    connect,
    encoded,
    insert,
    plan_sum,
    reading,
    told,
)

TABLES = ("session", "file", "trial", "event", "ticks")


def sum_of(path: Path) -> str:
    """Return the sum that stands for a whole record."""
    with reading(path) as db:
        return db.execute(LAST).fetchone()[1].hex()


def check(path: Path, expect: str = "") -> list[str]:
    """Return a sentence for everything that is wrong with a record.

    What was taken off the end of a session whose console was killed cannot be seen without the sum
    that a console said, nor can a change by a person who has computed all sums anew.

    Parameters
    ----------
    expect
        Sum that the record had once, of which it must be the same or go on.
    """
    faults: list[str] = []
    sums: set[str] = set()
    try:
        with reading(path) as db:
            result = db.execute("PRAGMA integrity_check")
            faults += [f"file: {said}" for (said,) in result if said != "ok"]
            planned = db.execute("SELECT data FROM event WHERE n = 1").fetchone()
            if planned is None or json.loads(planned[0])["plan"] != plan_sum(db):
                faults.append("the protocol or the plan was changed")
            before = START
            for what, content, sum_ in _links(db):
                if sum_ != sha256(before + content).digest():
                    faults.append(f"{what} was changed")
                before = sum_
                sums.add(sum_.hex())
            if db.execute("PRAGMA foreign_key_check").fetchone():
                faults.append("there are ticks of events that are missing")
            for (sealed,) in db.execute("SELECT sum FROM seal"):
                if sealed.hex() not in sums:
                    faults.append("what was there when it was closed was changed or is missing")
    except (RecordError, sqlite3.Error, TypeError, KeyError, ValueError) as error:
        faults.append(f"file: {error}")
    if expect and expect.lower() not in sums:
        faults.append(f"it never had the sum {expect}")
    return faults


def _links(db: sqlite3.Connection) -> Iterator[tuple[str, bytes, bytes]]:
    """Go through events and ticks in their order: what each is, its content, and its sum."""
    query = "SELECT first, fields, sum FROM ticks WHERE after = ? ORDER BY first"
    for *row, sum_ in db.execute("SELECT * FROM event ORDER BY n"):
        yield f"event {row[0]}, or what stands before it,", encoded(row), sum_
        for first, fields, sum_ in db.execute(query, (row[0],)):
            yield f"a part of the ticks after event {row[0]}, from {first} on,", fields, sum_


def salvage(path: Path, into: Path) -> list[str]:
    """Write what can be read of a damaged record into a new file, and say what is missing.

    Raises
    ------
    RecordError
        If the new file is there already or cannot be written, or nothing can be read.
    """
    if into.exists():
        raise RecordError(f"{into} is there already; choose another name")
    said = []
    with told(path), closing(connect(path, "ro")) as db:
        db.execute("PRAGMA writable_schema = ON")  # a file whose end is missing is opened, too
        rows = {table: _readable(db, table) for table in TABLES}
    if not any(rows.values()):
        raise RecordError(f"{path}: nothing of it can be read")
    with told(into), closing(connect(into, "rwc")) as new:
        into.chmod(0o600)
        new.executescript(SCHEMA)
        for table, found in rows.items():
            for row in found:
                with suppress(sqlite3.Error):
                    insert(new, table, row)
            count = new.execute(f"SELECT count(*) FROM {table}").fetchone()[0]
            said.append(f"{table}: {count} rows saved")
    return said + [f"not whole: {fault}" for fault in check(into)]


def _readable(db: sqlite3.Connection, table: str) -> list[tuple[Any, ...]]:
    """Return the rows of a table that can be read, from its start on and from its end back."""
    found: dict[int, tuple[Any, ...]] = {}
    for direction in ("", " DESC"):
        with suppress(sqlite3.Error):
            for rowid, *row in db.execute(
                f"SELECT rowid, * FROM {table} ORDER BY rowid{direction}"
            ):
                if rowid in found:
                    break
                found[rowid] = tuple(row)
    return [found[rowid] for rowid in sorted(found)]
