"""Traces: every tick of a run of the engine, appended as it happens.

A trace is a chain of gzip members, each with the ticks of some part of a
second: records of `TRACE`, little endian. A member's header has an extra field
with its length and its checksum, so that a trace can be read to the last whole
one after a crash, and no bit of it flips unseen; gzip itself reads it too.
"""

from __future__ import annotations

import os
import struct
import zlib
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import accumulate
from typing import TYPE_CHECKING

import numpy as np

from vbraille.errors import VbrailleError

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

TRACE = np.dtype(
    [
        ("tick", "<i8"),  # number of the frame in its run, from 0
        ("time_ns", "<i8"),  # when the tick woke, by the host's monotonic clock
        ("device_ns", "<i8"),  # of the sample, by the device's clock
        ("late", "<i8"),  # deadlines missed so far
        ("line", "<i8"),  # number of what is under the hand; 0 before the first
        ("flags", "<i8"),  # of `vbraille.engine.ring.Flag`
        ("x_mm", "<f8"),  # where the array's left column is; NaN before the first sample
        ("speed_mm_s", "<f8"),
        ("share", "<f8"),  # how much of a change has faded in: 1 is all
    ]
)
CHUNK_TICKS = 1000
_FIELDS: tuple[str, ...] = TRACE.names or ()
_LEVEL = 1  # the fastest; higher ones gain little on counts
# RFC 1952: no name, no time, level 1, Unix; an extra field "vb" of 8 bytes, which are the length
# of the member and the checksum of what comes after them.
_HEADER = bytes((0x1F, 0x8B, 8, 4, 0, 0, 0, 0, 4, 3, 12, 0, ord("v"), ord("b"), 8, 0))
_EXTRA = struct.Struct("<II")
_TRAILER = struct.Struct("<II")
_SIZE = struct.Struct("<I")  # the last of a member: of what was deflated
_MOST_THREADS = 4
_WORTH_A_THREAD = 16  # members
_DEFLATED = len(_HEADER) + _EXTRA.size


class TraceWriter:
    """Append ticks to a new trace.

    Parameters
    ----------
    path
        Of the trace; it must not exist.

    Raises
    ------
    VbrailleError
        If the disk does not take it.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._waiting: list[NDArray[np.void]] = []
        self._count = 0
        try:
            self._file = path.open("xb", buffering=0)
        except OSError as error:
            raise self._fault(error) from None

    def add(self, ticks: NDArray[np.void]) -> None:
        """Take records of the engine's ring; what makes a chunk is written."""
        if ticks.size:
            part = np.empty(ticks.size, TRACE)
            for name in _FIELDS:
                part[name] = ticks[name]
            self._waiting.append(part)
            self._count += ticks.size
        if self._count >= CHUNK_TICKS:
            self.flush()

    def flush(self) -> None:
        """Write what is waiting."""
        if not self._count:
            return
        chunk = _squeeze(np.concatenate(self._waiting).tobytes())
        self._waiting, self._count = [], 0
        try:
            written = self._file.write(chunk)
            if written < len(chunk):
                self._file.write(chunk[written:])  # says why not
        except OSError as error:
            raise self._fault(error) from None

    def sync(self) -> None:
        """Have all of it on the disk."""
        self.flush()
        try:
            os.fsync(self._file.fileno())
        except OSError as error:
            raise self._fault(error) from None

    def close(self) -> None:
        """Write what is waiting, and close; further calls do nothing."""
        if not self._file.closed:
            try:
                self.flush()
            finally:
                self._file.close()

    def _fault(self, error: OSError) -> VbrailleError:
        return VbrailleError(
            f"{self._path} cannot be written: {error.strerror}; answers up to here are in: "
            f"make room, then session resume goes on"
        )


@dataclass(frozen=True, slots=True)
class Trace:
    """What is in a trace.

    Parameters
    ----------
    ticks : `TRACE`[n]
        Of its whole chunks.
    torn_bytes
        Length of a last chunk that a crash cut short.
    damage
        What is wrong with a chunk that is not the last; None if nothing is.
    """

    ticks: NDArray[np.void]
    torn_bytes: int
    damage: str | None


def read_trace(path: Path) -> Trace:
    """Read a trace to its last whole chunk.

    Raises
    ------
    VbrailleError
        If it cannot be read at all.
    """
    try:
        trace = memoryview(path.read_bytes())
    except OSError as error:
        raise VbrailleError(f"{path} cannot be read: {error.strerror}") from None
    members: list[tuple[memoryview, int]] = []
    at, damage = 0, None
    while at < len(trace):
        try:
            length = _check_member(trace[at:])
        except ValueError:
            damage = f"chunk {len(members) + 1} of {path.name} does not match its checksum"
            break
        if not length:
            break
        (size,) = _SIZE.unpack_from(trace, at + length - _SIZE.size)
        members.append((trace[at + _DEFLATED : at + length - _TRAILER.size], size))
        at += length
    torn_bytes = 0 if damage is not None else len(trace) - at
    return Trace(_inflate(members), torn_bytes, damage)


def _squeeze(chunk: bytes) -> bytes:
    """One gzip member."""
    squeeze = zlib.compressobj(_LEVEL, zlib.DEFLATED, -zlib.MAX_WBITS)
    body = squeeze.compress(chunk) + squeeze.flush() + _TRAILER.pack(zlib.crc32(chunk), len(chunk))
    return _HEADER + _EXTRA.pack(_DEFLATED + len(body), zlib.crc32(body)) + body


def _check_member(trace: memoryview) -> int:
    """Length of the first gzip member; 0 if it is cut short.

    Raises
    ------
    ValueError
        If it is not what was written.
    """
    if not _HEADER.startswith(bytes(trace[: len(_HEADER)])):
        raise ValueError
    if len(trace) < _DEFLATED:
        return 0
    length, crc = _EXTRA.unpack_from(trace, len(_HEADER))
    if len(trace) < length:
        return 0
    if length < _DEFLATED + _TRAILER.size or zlib.crc32(trace[_DEFLATED:length]) != crc:
        raise ValueError
    return length


def _inflate(members: list[tuple[memoryview, int]]) -> NDArray[np.void]:
    """Ticks of checked members, given as what was deflated and its whole size in bytes."""
    stops = list(accumulate(size for _, size in members))
    ticks = np.empty((stops[-1] if stops else 0) // TRACE.itemsize, TRACE)
    room = ticks.view(np.uint8)

    def fill(first: int) -> None:
        for (deflated, size), stop in zip(
            members[first::threads], stops[first::threads], strict=True
        ):
            chunk = zlib.decompress(deflated, -zlib.MAX_WBITS, size)
            room[stop - size : stop] = np.frombuffer(chunk, np.uint8)

    # zlib lets other threads run meanwhile; a short trace is not worth one.
    threads = min(len(os.sched_getaffinity(0)), _MOST_THREADS, 1 + len(members) // _WORTH_A_THREAD)
    if threads == 1:
        fill(0)
    else:
        with ThreadPoolExecutor(threads) as pool:
            list(pool.map(fill, range(threads)))
    return ticks
