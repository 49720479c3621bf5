"""The ticks of the device, as a record has them: a second or less in each blob."""

from __future__ import annotations

import sqlite3
import zlib
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

TICK = np.dtype(
    [(name, "<i8") for name in ("tick", "time_ns", "device_ns", "line", "part", "flags", "late")]
    + [(name, "<f8") for name in ("x_mm", "y_mm", "theta_rad", "vx_mm_s", "vy_mm_s")]
    + [(name, "<f8") for name in ("shown_s", "share")]
)
FIELDS = TICK.names or ()


def pack(ticks: NDArray[np.void]) -> bytes:
    """Compress the differences of each field from tick to tick."""
    words = ticks[[*FIELDS]].astype(TICK).view("<i8").reshape(-1, len(FIELDS)).T
    return zlib.compress(np.diff(words, axis=1, prepend=0).tobytes(), 1)


def unpack(fields: bytes, count: int) -> NDArray[np.void]:
    """Return the ticks of a blob, `TICK`[count]."""
    words = np.frombuffer(zlib.decompress(fields), "<i8").reshape(-1, count).cumsum(axis=1)
    return np.ascontiguousarray(words.T).view(TICK).reshape(count)


def read_ticks(db: sqlite3.Connection, line: int) -> NDArray[np.void]:
    """Return the ticks of a showing, `TICK`[n]."""
    # Showings are numbered in the order of time, so that the ticks of one stand together.
    query = """
        SELECT fields, count FROM ticks WHERE last_line >= :line AND first_line BETWEEN
            ifnull((SELECT max(first_line) FROM ticks WHERE first_line < :line), 0) AND :line
        ORDER BY after, first
    """
    ticks = _joined(db.execute(query, {"line": line}))
    return ticks[ticks["line"] == line]


def read_all(db: sqlite3.Connection, after: int, before: int) -> NDArray[np.void]:
    """Return the ticks that came after one event and before another, `TICK`[n]."""
    query = "SELECT fields, count FROM ticks WHERE after >= ? AND after < ? ORDER BY after, first"
    return _joined(db.execute(query, (after, before)))


def _joined(blobs: Iterable[tuple[bytes, int]]) -> NDArray[np.void]:
    return np.concatenate([np.empty(0, TICK), *(unpack(*blob) for blob in blobs)])
