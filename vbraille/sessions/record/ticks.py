"""The ticks of the device, as a record has them: a second or less in each blob."""

from __future__ import annotations

import sqlite3
import zlib
from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

# What tells how a line was read comes first, so that no more of a blob need be decompressed.
TICK = np.dtype(
    [("line", "<i8"), ("time_ns", "<i8"), ("x_mm", "<f8"), ("vx_mm_s", "<f8")]
    + [(name, "<i8") for name in ("tick", "device_ns", "part", "flags", "late")]
    + [(name, "<f8") for name in ("y_mm", "theta_rad", "vy_mm_s", "shown_s", "share")]
)
FIELDS = TICK.names or ()


TIME, *TIMED = (FIELDS.index(name) for name in ("time_ns", "device_ns", "shown_s"))


def pack(ticks: NDArray[np.void]) -> bytes:
    """Compress the differences of each field from tick to tick.

    `TIMED` clocks are kept as their lead over ``time_ns``, which hardly changes.
    """
    words = ticks[[*FIELDS]].astype(TICK).view("<i8").reshape(-1, len(FIELDS)).T
    words[TIMED[-1]] = np.rint(1e9 * ticks["shown_s"])
    words[TIMED] -= words[TIME]
    return zlib.compress(np.diff(words, axis=1, prepend=0).tobytes(), 1)


def unpack(fields: bytes, count: int, names: Sequence[str]) -> NDArray[np.void]:
    """Return the ticks of a blob, with some of the fields of `TICK`, as an array of [count]."""
    # One field follows another: what comes after the last that is wanted stays compressed.
    size = 8 * count * (max(map(FIELDS.index, names)) + 1)
    words = np.frombuffer(zlib.decompressobj().decompress(fields, size), "<i8").reshape(-1, count)
    ticks = np.empty(count, [(name, TICK[name]) for name in names])
    for name in names:
        place = FIELDS.index(name)
        kept = words[place].cumsum() + (words[TIME].cumsum() if place in TIMED else 0)
        ticks[name] = kept / 1e9 if name == "shown_s" else kept.view(TICK[name])
    return ticks


def read_ticks(db: sqlite3.Connection, line: int, names: Sequence[str]) -> NDArray[np.void]:
    """Return the ticks of a showing, with "line" and other fields of `TICK`, as an array of [n]."""
    # Showings are numbered in the order of time, so that the ticks of one stand together.
    query = """
        SELECT fields, count FROM ticks WHERE last_line >= :line AND first_line BETWEEN
            ifnull((SELECT max(first_line) FROM ticks WHERE first_line < :line), 0) AND :line
        ORDER BY after, first
    """
    ticks = _joined(db.execute(query, {"line": line}), names)
    return ticks[ticks["line"] == line]


def read_all(db: sqlite3.Connection, after: int, before: int) -> NDArray[np.void]:
    """Return the ticks that came after one event and before another, `TICK`[n]."""
    query = "SELECT fields, count FROM ticks WHERE after >= ? AND after < ? ORDER BY after, first"
    return _joined(db.execute(query, (after, before)), FIELDS)


def _joined(blobs: Iterable[tuple[bytes, int]], names: Sequence[str]) -> NDArray[np.void]:
    return np.concatenate([np.empty(0, TICK)[[*names]], *(unpack(*b, names) for b in blobs)])
