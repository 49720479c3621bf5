"""The ticks of the device, as a record has them: a second or less in each blob."""

from __future__ import annotations

import sqlite3
import zlib
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

TICK = np.dtype(
    [(name, "<i8") for name in ("tick", "time_ns", "device_ns", "line", "part", "flags", "late")]
    + [(name, "<f8") for name in ("x_mm", "y_mm", "theta_rad", "vx_mm_s", "vy_mm_s")]
    + [(name, "<f8") for name in ("shown_s", "share")]
)
FIELDS = TICK.names or ()
WORD_BYTES = 8


def pack(ticks: NDArray[np.void]) -> bytes:
    """Compress the differences of each field from tick to tick."""
    kept = np.empty(ticks.size, TICK)
    for name in TICK.names or ():
        kept[name] = ticks[name]
    words = kept.view("<i8").reshape(-1, len(FIELDS)).T
    return zlib.compress(np.diff(words, axis=1, prepend=0).tobytes(), 1)


def unpack(fields: bytes, count: int, names: Sequence[str] = FIELDS) -> NDArray[np.void]:
    """Return some fields of the ticks of a blob, or all, `TICK`[count]."""
    places = [FIELDS.index(name) for name in names]
    # Fields stand one after the other; those behind the last that is wanted stay compressed.
    content = zlib.decompressobj().decompress(fields, (max(places) + 1) * count * WORD_BYTES)
    words = np.frombuffer(content, "<i8").reshape(-1, count)
    ticks = np.empty(count, _of_fields(names))
    for name, place in zip(names, places, strict=True):
        ticks[name] = words[place].cumsum().view(TICK[name])
    return ticks


def _of_fields(names: Sequence[str]) -> np.dtype:
    return np.dtype([(name, TICK[name]) for name in names])


def read_ticks(
    db: sqlite3.Connection, first_line: int, last_line: int, names: Sequence[str] = FIELDS
) -> NDArray[np.void]:
    """Return the ticks of some showings; `names` are the fields that are wanted, "line" among them.

    To read three fields takes a third of the time of all.
    """
    # Showings are numbered in the order of time, so that the ticks of one stand together.
    query = """
        SELECT fields, count FROM ticks WHERE last_line >= :first AND first_line BETWEEN
            ifnull((SELECT max(first_line) FROM ticks WHERE first_line < :first), 0) AND :last
        ORDER BY after, first
    """
    found = db.execute(query, {"first": first_line, "last": last_line})
    blobs = [unpack(fields, count, names) for fields, count in found]
    ticks = np.concatenate([np.empty(0, _of_fields(names)), *blobs])
    return ticks[(ticks["line"] >= first_line) & (ticks["line"] <= last_line)]


def read_all(db: sqlite3.Connection, after: int, before: int) -> NDArray[np.void]:
    """Return the ticks that came after one event and before another, `TICK`[n]."""
    query = "SELECT fields, count FROM ticks WHERE after >= ? AND after < ? ORDER BY after, first"
    blobs = [unpack(*row) for row in db.execute(query, (after, before))]
    return np.concatenate([np.empty(0, TICK), *blobs])
