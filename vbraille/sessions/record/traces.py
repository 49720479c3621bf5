"""Traces: files with every tick of a run of the engine, written while it runs.

A trace is a chain of gzip members, called chunks, each with the ticks of a second or less. The
ticks are little-endian records of `TRACE`; in sessions of formats 1 and 2 they are records of
`LEFT_TRACE`, which have the place of the array's left column. The header of a member has an extra
field with the member's length and checksum. So a trace can be read up to the last whole member
after a crash, and no flipped bit goes unseen; gzip can read the file as well. A second extra field
names the last line of the journal that was on the disk at that time. So nobody can replace the
journal's last lines unseen.
"""

from __future__ import annotations

import os
import struct
import zlib
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass
from hashlib import sha256
from itertools import accumulate
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from vbraille.errors import VbrailleError
from vbraille.files import sync_names
from vbraille.sessions.record.journal import Tie

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from numpy.typing import NDArray

TRACE = np.dtype(
    [
        ("tick", "<i8"),  # number of the frame in its run, from 0
        ("time_ns", "<i8"),  # when the tick woke, by the host's monotonic clock
        ("device_ns", "<i8"),  # time of the sample, by the device's clock
        ("late", "<i8"),  # deadlines missed so far
        ("line", "<i8"),  # number of the showing under the hand; 0 before the first
        ("part", "<i8"),  # which part of a picture that has several is under the array
        ("flags", "<i8"),  # bits of `vbraille.engine.record.Flag`
        ("x_mm", "<f8"),  # place of the array, a `vbraille.pose.Pose`; NaN before the first sample
        ("y_mm", "<f8"),
        ("theta_rad", "<f8"),
        ("vx_mm_s", "<f8"),  # velocity of the hand
        ("vy_mm_s", "<f8"),
        ("shown_s", "<f8"),  # the picture's own time since its start, if it moves by itself
        ("share", "<f8"),  # how much of a change has faded in; 1 is all
    ]
)
LEFT_TRACE = np.dtype(
    [
        *((name, "<i8") for name in ("tick", "time_ns", "device_ns", "late", "line", "flags")),
        ("x_mm", "<f8"),  # place of the array's left column; NaN before the first sample
        ("speed_mm_s", "<f8"),  # velocity of the hand, to the right
        ("share", "<f8"),
    ]
)
CHUNK_TICKS = 1000
_LEVEL = 1  # level of gzip: the fastest, since higher ones hardly make counts shorter
# A member begins as RFC 1952 says: no name, no time, level 1, Unix, extra fields. The first extra
# field has 8 bytes: the length of the member, and the checksum of all that follows the field. It is
# called "vp" if the records are of `TRACE`, and "vb" if they are of `LEFT_TRACE`. Format 1 has no
# other field. The second field, "vj", has 8 bytes as well, which tie the member to the journal: the
# number of a line, and its checksum.
_START = bytes((0x1F, 0x8B, 8, 4, 0, 0, 0, 0, 4, 3))
_TIE_FIELD = b"vj\x08\x00"
_RECORDS = {b"vp\x08\x00": TRACE, b"vb\x08\x00": LEFT_TRACE}
_LOOSE = {_START + b"\x0c\x00" + name: record for name, record in _RECORDS.items()}
_TIED = {_START + b"\x18\x00" + name: record for name, record in _RECORDS.items()}
HEADS = _LOOSE | _TIED
HEAD_BYTES = len(_START) + 6
EXTRA = struct.Struct("<II")
_TRAILER = struct.Struct("<II")
_SIZE = struct.Struct("<I")  # last field of a member: size of its content before it was deflated
_MOST_THREADS = 4
_WORTH_A_THREAD = 16  # number of members that are worth one more thread
_AFTER_LENGTH = HEAD_BYTES + EXTRA.size
_AFTER_TIE = _AFTER_LENGTH + len(_TIE_FIELD) + EXTRA.size


class TraceWriter:
    """Writer that appends ticks to a new trace.

    Parameters
    ----------
    path
        Path of the trace, which must not exist yet.
    tie
        Function that tells which line of the journal is on the disk; None in a session of format
        1, whose traces are not tied to the journal.
    left_mm
        Distance of the array's left column from its centre in a session of format 1 or 2, whose
        traces have places of the left column; None in sessions of other formats.

    Raises
    ------
    VbrailleError
        If the disk does not take the trace.
    """

    def __init__(
        self, path: Path, tie: Callable[[], Tie] | None = None, left_mm: float | None = None
    ) -> None:
        self._path = path
        self._tie = tie
        self._left_mm = left_mm
        self._tied: Tie | None = None
        self._bytes = 0
        self._sum = sha256()
        self._waiting: list[NDArray[np.void]] = []
        self._count = 0
        try:
            path.touch(0o600, exist_ok=False)
            self._file = path.open("wb", buffering=0)
            sync_names(path.parent)
        except OSError as error:
            raise self._fault(error) from None

    def add(self, ticks: NDArray[np.void]) -> None:
        """Take ticks from the engine, and write a chunk if there are enough of them."""
        if ticks.size:
            self._waiting.append(self._records(ticks))
            self._count += ticks.size
        if self._count >= CHUNK_TICKS:
            self.flush()

    def _records(self, ticks: NDArray[np.void]) -> NDArray[np.void]:
        """Convert ticks of the engine to records of the session's format."""
        record = TRACE if self._left_mm is None else LEFT_TRACE
        made = np.empty(ticks.size, record)
        for name in record.names or ():
            made[name] = ticks["vx_mm_s" if name == "speed_mm_s" else name]
        if self._left_mm is not None:
            made["x_mm"] -= self._left_mm
        return made

    def flush(self) -> None:
        """Write the ticks that are waiting."""
        if self._count:
            self._write(np.concatenate(self._waiting).tobytes())

    def _write(self, ticks: bytes) -> None:
        tie = None if self._tie is None else self._tie()
        chunk = _squeeze(ticks, tie, TRACE if self._left_mm is None else LEFT_TRACE)
        self._waiting, self._count, self._tied = [], 0, tie
        try:
            written = self._file.write(chunk)
            if written < len(chunk):
                self._file.write(chunk[written:])  # a second try tells the reason
        except OSError as error:
            raise self._fault(error) from None
        self._bytes += len(chunk)
        self._sum.update(chunk)

    def sync(self) -> None:
        """Write the ticks that are waiting, and make sure that the trace is on the disk."""
        self.flush()
        try:
            os.fsync(self._file.fileno())
        except OSError as error:
            raise self._fault(error) from None

    def close(self) -> None:
        """Write waiting ticks and a last tie to the journal, and close; more calls do nothing."""
        if not self._file.closed:
            try:
                self.flush()
                if self._tie is not None and self._tie() != self._tied:
                    self._write(b"")
            finally:
                self._file.close()

    def closed(self) -> dict[str, Any]:
        """Fields of the journal's event for a closed trace: name, length and SHA-256."""
        told: dict[str, Any] = {"trace": self._path.name, "trace_bytes": self._bytes}
        return told if self._tie is None else {**told, "trace_sha256": self._sum.hexdigest()}

    def _fault(self, error: OSError) -> VbrailleError:
        return VbrailleError(
            f"{self._path} cannot be written: {error.strerror}; answers up to here are in: "
            f"make room, then session resume goes on"
        )


@dataclass(frozen=True, slots=True)
class Trace:
    """Content of a trace.

    Parameters
    ----------
    ticks : `TRACE`[n] or `LEFT_TRACE`[n]
        Ticks of the whole chunks, as they were written; see `posed` and `left_places_mm`.
    torn_bytes
        Length of a last chunk that a crash cut short.
    damage
        What is wrong with a chunk that is not the last; None if nothing is.
    ties
        Lines of the journal that whole chunks name, each once.
    loose
        Whether a whole chunk names no line of the journal.
    later : `TRACE`[m] or `LEFT_TRACE`[m], …
        Ticks of whole chunks after the damage, with one array after each damaged place.
    """

    ticks: NDArray[np.void]
    torn_bytes: int
    damage: str | None
    ties: tuple[Tie, ...] = ()
    loose: bool = False
    later: tuple[NDArray[np.void], ...] = ()


class ChunkMember(NamedTuple):
    """A whole gzip member: kind of its records, length, deflated bytes, full size, and tie."""

    record: np.dtype
    length: int
    deflated: memoryview
    size: int
    tie: Tie | None


def read_trace(path: Path) -> Trace:
    """Read a trace, including its whole chunks after a damage.

    Raises
    ------
    VbrailleError
        If the file cannot be read at all.
    """
    try:
        trace = path.read_bytes()
    except OSError as error:
        raise VbrailleError(f"{path} cannot be read: {error.strerror}") from None
    view = memoryview(trace)
    stretches: list[list[ChunkMember]] = [[]]
    at, damage, torn_bytes = 0, None, 0
    record = None
    while at < len(trace):
        try:
            member = check_member(view[at:], record)
            after = at if member is None else at + member.length
        except ValueError:
            member, after = None, next_start(trace, at + 1)
        if member is not None:
            stretches[-1].append(member)
            record = member.record
        elif after == at and (after := next_start(trace, at + 1)) == len(trace):
            torn_bytes = len(trace) - at if damage is None else 0
        elif damage is None:
            damage = f"chunk {len(stretches[0]) + 1} of {path.name} does not match its checksum"
            stretches.append([])
        elif stretches[-1]:
            stretches.append([])
        at = after
    ties = [member.tie for members in stretches for member in members]
    first, *later = (_inflate(members, record or TRACE) for members in stretches)
    return Trace(
        first,
        torn_bytes,
        damage,
        tuple(dict.fromkeys(tie for tie in ties if tie is not None)),
        None in ties,
        tuple(stretch for stretch in later if stretch.size),
    )


def read_last_tie(path: Path) -> Tie | None:
    """Line of the journal that the last chunk of a trace names; None if it names none.

    Only the headers of the chunks are read, which takes hardly any time.
    """
    last = None
    try:
        with path.open("rb") as file:
            size = file.seek(0, os.SEEK_END)
            at = 0
            while at + _AFTER_TIE <= size:
                file.seek(at)
                head = file.read(_AFTER_TIE)
                length, _ = EXTRA.unpack_from(head, HEAD_BYTES)
                if head[:HEAD_BYTES] not in _TIED or not _AFTER_TIE <= length <= size - at:
                    break
                last = Tie(*EXTRA.unpack_from(head, _AFTER_LENGTH + len(_TIE_FIELD)))
                at += length
    except OSError:
        return None
    return last


def posed(ticks: NDArray[np.void], left_mm: float) -> NDArray[np.void]:
    """Convert ticks of a trace of any format to places of the array's centre.

    Parameters
    ----------
    ticks : `TRACE`[n] or `LEFT_TRACE`[n]
        Ticks as they were written.
    left_mm
        Distance of the array's left column from its centre.

    Returns
    -------
    `TRACE`[n]
        Ticks with places of the centre; y and its velocity are 0 if only x was measured.
    """
    if ticks.dtype == TRACE:
        return ticks
    made = np.zeros(ticks.size, TRACE)
    for name in LEFT_TRACE.names or ():
        made["vx_mm_s" if name == "speed_mm_s" else name] = ticks[name]
    made["x_mm"] += left_mm
    unknown = np.isnan(made["x_mm"])
    made["y_mm"][unknown] = made["theta_rad"][unknown] = np.nan
    return made


def left_places_mm(ticks: NDArray[np.void], left_mm: float) -> NDArray[np.float64]:
    """Places of the array's left column by a trace of any format; float64[n], a copy.

    They are, to the bit, the places that the frames were made for.
    """
    return ticks["x_mm"] - (left_mm if ticks.dtype == TRACE else 0.0)


def _squeeze(chunk: bytes, tie: Tie | None, record: np.dtype) -> bytes:
    """Make a gzip member of the bytes of a chunk."""
    squeeze = zlib.compressobj(_LEVEL, zlib.DEFLATED, -zlib.MAX_WBITS)
    body = squeeze.compress(chunk) + squeeze.flush() + _TRAILER.pack(zlib.crc32(chunk), len(chunk))
    if tie is not None:
        body = _TIE_FIELD + EXTRA.pack(*tie) + body
    heads = _LOOSE if tie is None else _TIED
    head = next(head for head, kind in heads.items() if kind == record)
    return head + EXTRA.pack(_AFTER_LENGTH + len(body), zlib.crc32(body)) + body


def check_member(trace: memoryview, record: np.dtype | None) -> ChunkMember | None:
    """Read the gzip member that a trace begins with; None if it is cut short.

    Raises
    ------
    ValueError
        If the member is damaged, or its records are not of the given kind.
    """
    start = bytes(trace[:HEAD_BYTES])
    if not any(head.startswith(start) for head, kind in HEADS.items() if record in (None, kind)):
        raise ValueError
    if len(trace) < _AFTER_LENGTH:
        return None
    length, crc = EXTRA.unpack_from(trace, HEAD_BYTES)
    if len(trace) < length:
        return None
    deflated = _AFTER_LENGTH if start in _LOOSE else _AFTER_TIE
    if length < deflated + _TRAILER.size or zlib.crc32(trace[_AFTER_LENGTH:length]) != crc:
        raise ValueError
    (size,) = _SIZE.unpack_from(trace, length - _SIZE.size)
    tie = None
    if start in _TIED:
        tie = Tie(*EXTRA.unpack_from(trace, _AFTER_LENGTH + len(_TIE_FIELD)))
    return ChunkMember(HEADS[start], length, trace[deflated : length - _TRAILER.size], size, tie)


def next_start(trace: bytes, after: int) -> int:
    """Offset at which the next whole member begins; the trace's length if there is none."""
    at = trace.find(_START, after)
    while at >= 0:
        with suppress(ValueError):
            if check_member(memoryview(trace)[at:], None) is not None:
                return at
        at = trace.find(_START, at + 1)
    return len(trace)


def _inflate(members: list[ChunkMember], record: np.dtype) -> NDArray[np.void]:
    """Ticks of members that were checked, as records of a kind."""
    stops = list(accumulate(member.size for member in members))
    ticks = np.empty((stops[-1] if stops else 0) // record.itemsize, record)
    room = ticks.view(np.uint8)

    def fill(first: int) -> None:
        for member, stop in zip(members[first::threads], stops[first::threads], strict=True):
            chunk = zlib.decompress(member.deflated, -zlib.MAX_WBITS, member.size)
            room[stop - member.size : stop] = np.frombuffer(chunk, np.uint8)

    # zlib lets other threads run while it works; a short trace is not worth a thread.
    threads = min(len(os.sched_getaffinity(0)), _MOST_THREADS, 1 + len(members) // _WORTH_A_THREAD)
    if threads == 1:
        fill(0)
    else:
        with ThreadPoolExecutor(threads) as pool:
            list(pool.map(fill, range(threads)))
    return ticks
