"""The ticks of the device, as a record has them: a second or less in each blob."""

from __future__ import annotations

import sqlite3
import zlib

import numpy as np
from numpy.typing import NDArray

TICK = np.dtype(
    [(name, "<i8") for name in ("tick", "time_ns", "device_ns", "line", "part", "flags", "late")]
    + [(name, "<f8") for name in ("x_mm", "y_mm", "theta_rad", "vx_mm_s", "vy_mm_s")]
    + [(name, "<f8") for name in ("shown_s", "share")]
)


def pack(ticks: NDArray[np.void]) -> bytes:
    """Compress the differences of each field from tick to tick."""
    kept = np.empty(ticks.size, TICK)
    for name in TICK.names or ():
        kept[name] = ticks[name]
    words = kept.view("<i8").reshape(-1, len(TICK)).T
    return zlib.compress(np.diff(words, axis=1, prepend=0).tobytes(), 1)


def unpack(fields: bytes) -> NDArray[np.void]:
    """Return the ticks of a blob, `TICK`[n]."""
    words = np.frombuffer(zlib.decompress(fields), "<i8").reshape(len(TICK), -1).cumsum(axis=1)
    return np.ascontiguousarray(words.T).view(TICK).ravel()


def read_ticks(db: sqlite3.Connection, first_line: int, last_line: int) -> NDArray[np.void]:
    """Return the ticks of some showings, `TICK`[n]."""
    # Showings are numbered in the order of time, so that the ticks of one stand together.
    query = """
        SELECT fields FROM ticks WHERE last_line >= :first AND first_line BETWEEN
            ifnull((SELECT max(first_line) FROM ticks WHERE first_line < :first), 0) AND :last
        ORDER BY after, first
    """
    found = db.execute(query, {"first": first_line, "last": last_line})
    ticks = np.concatenate([np.empty(0, TICK), *(unpack(fields) for (fields,) in found)])
    return ticks[(ticks["line"] >= first_line) & (ticks["line"] <= last_line)]


def read_all(db: sqlite3.Connection, after: int, before: int) -> NDArray[np.void]:
    """Return the ticks that came after one event and before another, `TICK`[n]."""
    query = "SELECT fields FROM ticks WHERE after >= ? AND after < ? ORDER BY after, first"
    blobs = [unpack(fields) for (fields,) in db.execute(query, (after, before))]
    return np.concatenate([np.empty(0, TICK), *blobs])
