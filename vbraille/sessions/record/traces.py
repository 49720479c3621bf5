"""Traces: files with every tick of a run of the engine, written while it runs.

A trace is a chain of gzip members, called chunks, each with the ticks of a second or less, field by
field in the order of `TRACE`. Of a field there is the difference of each tick from the one before,
as little-endian int64 (of numbers with a point, of their bits): that makes files an eighth as long,
and who needs few fields unpacks no others. The header of a member has an extra field with the
member's length and checksum. So a trace can be read up to the last whole member after a crash, and
no flipped bit goes unseen; gzip can read the file as well. A second extra field names the last line
of the journal that was on the disk at that time. So the journal's last lines cannot be replaced
unseen.
"""

from __future__ import annotations

import os
import struct
import weakref
import zlib
from contextlib import suppress
from dataclasses import dataclass
from hashlib import sha256
from itertools import pairwise
from typing import TYPE_CHECKING, Any, TypeAlias

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
        ("time_ns", "<i8"),  # when the tick woke, by the host's monotonic clock
        ("line", "<i8"),  # number of the showing under the hand; 0 before the first
        ("flags", "<i8"),  # bits of `vbraille.engine.record.Flag`
        ("x_mm", "<f8"),  # place of the array, a `vbraille.pose.Pose`; NaN before the first sample
        ("vx_mm_s", "<f8"),  # velocity of the hand
        ("y_mm", "<f8"),
        ("theta_rad", "<f8"),
        ("vy_mm_s", "<f8"),
        ("tick", "<i8"),  # number of the frame in its run, from 0
        ("device_ns", "<i8"),  # time of the sample, by the device's clock
        ("late", "<i8"),  # deadlines missed so far
        ("part", "<i8"),  # which part of a picture that has several is under the array
        ("shown_s", "<f8"),  # the picture's own time since its start, if it moves by itself
        ("share", "<f8"),  # how much of a change has faded in; 1 is all
    ]
)
LAST_FIELD = "share"
TickColumns: TypeAlias = "dict[str, NDArray[Any]]"
"""Fields of `TRACE` by their names, each of all ticks."""
CHUNK_TICKS = 1000
_LEVEL = 1  # level of gzip: the fastest, since higher ones hardly make counts shorter
# A member begins as RFC 1952 says: no name, no time, level 1, Unix, extra fields of 24 bytes. The
# first of these, "vp", has 8 bytes: the length of the member, and the checksum of all that follows
# the field. The second, "vj", has 8 bytes as well, which tie the member to the journal: the number
# of a line, and its checksum.
_HEAD = bytes((0x1F, 0x8B, 8, 4, 0, 0, 0, 0, 4, 3)) + b"\x18\x00vp\x08\x00"
_TIE_FIELD = b"vj\x08\x00"
_EXTRA = struct.Struct("<II")
_TRAILER = struct.Struct("<II")
_START = struct.Struct(f"<{len(_HEAD)}sII{len(_TIE_FIELD)}sII")
# All checksums of a smaller trace are looked at when a `ChunkedTrace` opens it.
_SOON_CHECKED_BYTES = 1 << 25
# No chunk has so many ticks: what says so is no trace.
_MOST_BYTES = 1 << 24
_AFTER_LENGTH = len(_HEAD) + _EXTRA.size
_AFTER_TIE = _AFTER_LENGTH + len(_TIE_FIELD) + _EXTRA.size


class TraceWriter:
    """Writer that appends ticks to a new trace.

    Parameters
    ----------
    path
        Path of the trace, which must not exist yet.
    tie
        Function that tells which line of the journal is on the disk.

    Raises
    ------
    VbrailleError
        If the disk does not take the trace.
    """

    def __init__(self, path: Path, tie: Callable[[], Tie]) -> None:
        self._path = path
        self._tie = tie
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
            records = np.empty(ticks.size, TRACE)
            for name in TRACE.names or ():
                records[name] = ticks[name]
            self._waiting.append(records)
            self._count += ticks.size
        if self._count >= CHUNK_TICKS:
            self.flush()

    def flush(self) -> None:
        """Write the ticks that are waiting."""
        if self._count:
            self._write(_differences(np.concatenate(self._waiting)))

    def _write(self, ticks: bytes) -> None:
        tie = self._tie()
        chunk = _squeeze(ticks, tie)
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
                if self._tie() != self._tied:
                    self._write(b"")
            finally:
                self._file.close()

    def closed(self) -> dict[str, Any]:
        """Fields of the journal's event for a closed trace: name, length and SHA-256."""
        sum_of = self._sum.hexdigest()
        return {"trace": self._path.name, "trace_bytes": self._bytes, "trace_sha256": sum_of}

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
    ticks : `TRACE`[n]
        Ticks of the whole chunks.
    torn_bytes
        Length of a last chunk that a crash cut short.
    damage
        What is wrong with a chunk that is not the last; None if nothing is.
    ties
        Lines of the journal that whole chunks name, each once.
    later : `TRACE`[m], …
        Ticks of whole chunks after the damage, with one array after each damaged place.
    """

    ticks: NDArray[np.void]
    torn_bytes: int
    damage: str | None
    ties: tuple[Tie, ...] = ()
    later: tuple[NDArray[np.void], ...] = ()


NO_TRACE = Trace(np.zeros(0, TRACE), 0, None)


def read_trace(path: Path, upto: str = LAST_FIELD) -> Trace:
    """Read a trace, including its whole chunks after a damage.

    Parameters
    ----------
    upto
        Last field of `TRACE` that is read; the fewer fields, the quicker.

    Raises
    ------
    VbrailleError
        If the file cannot be read at all.
    """
    chunks = ChunkedTrace(path, checked=True)
    trace = chunks.whole(upto)
    chunks.close()
    return trace


def read_last_tie(path: Path) -> Tie | None:
    """Line of the journal that the last whole chunk of a trace names; None if there is none."""
    try:
        chunks = ChunkedTrace(path)
    except VbrailleError:
        return None
    chunks.close()
    return chunks.ties[-1] if chunks.ties else None


class ChunkedTrace:
    """A trace whose chunks are read one by one, in any order.

    So hours of ticks need no more memory than a second of them.

    Parameters
    ----------
    path
        Path of the trace.
    checked
        Whether the checksums of all chunks are looked at when it is opened; None if it is small
        enough for that. Of a trace whose headers alone are looked at, other damage is found when
        a chunk is read.

    Attributes
    ----------
    damage : list[int]
        Numbers of the chunks, from 0, before which something is not whole.
    torn_bytes : int
        Length of a last chunk that a crash cut short.
    ties : list[Tie]
        Line of the journal that each chunk names.
    size_bytes : int
        Length of the file.

    Raises
    ------
    VbrailleError
        If the file cannot be read.
    """

    def __init__(self, path: Path, *, checked: bool | None = None) -> None:
        self._path = path
        self._places: list[tuple[int, int]] = []
        self._content: memoryview | None = None
        self.damage: list[int] = []
        self.torn_bytes = 0
        self.ties: list[Tie] = []
        try:
            self._file = os.open(path, os.O_RDONLY | os.O_CLOEXEC)
            self._close = weakref.finalize(self, os.close, self._file)
            self.size_bytes = os.fstat(self._file).st_size
        except OSError as error:
            raise self._unreadable(error) from None
        self._checked = self.size_bytes <= _SOON_CHECKED_BYTES if checked is None else checked
        if self._checked:  # all of it is read anyway, and at once in less time
            self._content = self._read(0, self.size_bytes)
            self.size_bytes = len(self._content)
        self._walk()

    def __len__(self) -> int:
        """Count the chunks."""
        return len(self._places)

    def ticks(self, number: int) -> NDArray[np.void]:
        """Ticks of a chunk, `TRACE`[n]; none if it is damaged or has none."""
        return self.between(number, number + 1)

    def between(self, first: int, stop: int, upto: str = LAST_FIELD) -> NDArray[np.void]:
        """Ticks of some chunks that follow each other, with the fields of `TRACE` up to one."""
        names = _names(upto)
        parts = [self.differences(n, len(names)) for n in range(first, stop)]
        found = np.empty(
            sum(part.shape[1] for part in parts), [(name, TRACE[name]) for name in names]
        )
        whole = found.view("<i8").reshape(-1, len(names))
        at = 0
        for part in parts:
            part.cumsum(axis=1, out=whole[at : at + part.shape[1]].T)
            at += part.shape[1]
        return found

    def differences(self, number: int, fields: int) -> NDArray[np.int64]:
        """Differences of a chunk's first fields, int64[fields, n]; n is 0 if it is damaged."""
        member = self._read(*self._places[number])
        try:
            whole = len(member) if self._checked else _whole(member)
            stop = whole - _TRAILER.size
            _, size = _TRAILER.unpack_from(member, stop)
            ticks = min(size, _MOST_BYTES) // TRACE.itemsize
            unpacker = zlib.decompressobj(-zlib.MAX_WBITS)
            chunk = unpacker.decompress(member[_AFTER_TIE:stop], 8 * ticks * fields or 1)
            return np.frombuffer(chunk, "<i8", ticks * fields).reshape(fields, ticks)
        except (ValueError, struct.error, zlib.error):
            return np.zeros((fields, 0), np.int64)

    def whole(self, upto: str = LAST_FIELD) -> Trace:
        """Content of the trace, with the fields of `TRACE` up to one."""
        bounds = sorted({0, *self.damage, len(self)})
        first, *later = (self.between(*span, upto) for span in pairwise([*bounds, len(self)]))
        if self.damage and not self.damage[0]:
            first, later = first[:0], [first, *later]
        later = tuple(stretch for stretch in later if stretch.size)
        torn_bytes = 0 if self.damage else self.torn_bytes
        return Trace(first, torn_bytes, self.fault(), tuple(dict.fromkeys(self.ties)), later)

    def fault(self) -> str | None:
        """Say which chunk is the first that is not whole; None if all are."""
        if not self.damage:
            return None
        return f"chunk {self.damage[0] + 1} of {self._path.name} does not match its checksum"

    def close(self) -> None:
        """Close the file; it is closed with the last use of this, too."""
        self._close()

    def _walk(self) -> None:
        """Find all chunks, and what is not whole between them."""
        at = 0
        while at < self.size_bytes:
            head = self._read(at, _START.size)
            if len(head) == _START.size:
                start, length, crc, _, *tie = _START.unpack(head)
                if start == _HEAD and self._is_whole(at, length, crc):
                    self._places.append((at, length))
                    self.ties.append(Tie(*tie))
                    at += length
                    continue
            rest = bytes(self._read(at, self.size_bytes - at))
            after = _next_start(rest)
            if after < len(rest) or not _is_torn(rest):
                self.damage.append(len(self._places))
            else:
                self.torn_bytes = len(rest)
            at += after

    def _is_whole(self, at: int, length: int, crc: int) -> bool:
        """True if a chunk whose header says so can begin here; its checksum may be looked at."""
        if not _AFTER_TIE + _TRAILER.size <= length <= min(self.size_bytes - at, _MOST_BYTES):
            return False
        return not self._checked or zlib.crc32(self._read(at, length)[_AFTER_LENGTH:]) == crc

    def _read(self, at: int, length: int) -> memoryview:
        if self._content is not None:
            return self._content[at : at + length]
        try:
            return memoryview(os.pread(self._file, length, at))
        except OSError as error:
            raise self._unreadable(error) from None

    def _unreadable(self, error: OSError) -> VbrailleError:
        return VbrailleError(f"{self._path} cannot be read: {error.strerror}")


class TraceLines:
    """Ticks of a trace without damage, by their line numbers, which grow along it.

    Those that are wanted in the order of the trace are unpacked once, and a few at a time: hours
    of ticks at once would take more time for their memory than for themselves.

    Parameters
    ----------
    chunks
        The trace.
    upto
        Last field of `TRACE` that ticks have.
    """

    def __init__(self, chunks: ChunkedTrace, upto: str = LAST_FIELD) -> None:
        self._chunks = chunks
        self._upto = upto
        self._names = _names(upto)
        self._next = 0  # the first chunk that was not passed,
        self._passed: int | None = None  # the last line number that was,
        self._kept: tuple[int, NDArray[np.int64]] | None = None  # and the chunk unpacked last

    def between(self, least: int, most: int) -> TickColumns:
        """Ticks whose line number is within bounds."""
        line = self._names.index("line")
        if self._passed is not None and least <= self._passed:
            self._next, self._passed = 0, None
        parts: list[NDArray[np.int64]] = []
        while self._next < len(self._chunks):
            part = self._unpacked(self._next)
            if part.shape[1]:
                first, last = int(part[line, 0]), int(part[line].sum())
                if first > most:
                    break
                if last >= least:
                    parts.append(part)
                if last > most:
                    break
                self._passed = last
            self._next += 1
        whole = np.empty((len(self._names), sum(part.shape[1] for part in parts)), "<i8")
        at = 0
        for part in parts:
            part.cumsum(axis=1, out=whole[:, at : at + part.shape[1]])
            at += part.shape[1]
        some = slice(*np.searchsorted(whole[line], (least, most + 1)))
        return {
            name: column[some].view(TRACE[name])
            for name, column in zip(self._names, whole, strict=True)
        }

    def whole(self) -> Trace:
        """All ticks at once."""
        return self._chunks.whole(self._upto)

    def _unpacked(self, number: int) -> NDArray[np.int64]:
        if self._kept is None or self._kept[0] != number:
            self._kept = number, self._chunks.differences(number, len(self._names))
        return self._kept[1]


def _names(upto: str) -> tuple[str, ...]:
    """Names of the fields of `TRACE` up to one."""
    names = TRACE.names or ()
    return names[: names.index(upto) + 1]


def _differences(ticks: NDArray[np.void]) -> bytes:
    """Bytes of a chunk: field by field, the difference of each tick from the one before."""
    whole = ticks.view("<i8").reshape(ticks.size, -1).T
    return np.diff(whole, axis=1, prepend=np.int64(0)).tobytes()


def _squeeze(chunk: bytes, tie: Tie) -> bytes:
    """Make a gzip member of the bytes of a chunk."""
    squeeze = zlib.compressobj(_LEVEL, zlib.DEFLATED, -zlib.MAX_WBITS)
    body = _TIE_FIELD + _EXTRA.pack(*tie) + squeeze.compress(chunk) + squeeze.flush()
    body += _TRAILER.pack(zlib.crc32(chunk), len(chunk))
    return _HEAD + _EXTRA.pack(_AFTER_LENGTH + len(body), zlib.crc32(body)) + body


def _whole(trace: memoryview) -> int:
    """Length of the gzip member that a trace begins with; 0 if it is cut short.

    Raises
    ------
    ValueError
        If the member is damaged.
    """
    if not _HEAD.startswith(bytes(trace[: len(_HEAD)])):
        raise ValueError
    if len(trace) < _AFTER_LENGTH:
        return 0
    length, crc = _EXTRA.unpack_from(trace, len(_HEAD))
    if len(trace) < length:
        return 0
    if length < _AFTER_TIE + _TRAILER.size or zlib.crc32(trace[_AFTER_LENGTH:length]) != crc:
        raise ValueError
    return length


def _is_torn(rest: bytes) -> bool:
    """True if a trace that ends with this was cut short in a chunk that may have been whole."""
    try:
        return not _whole(memoryview(rest))
    except ValueError:
        return False


def _next_start(rest: bytes) -> int:
    """Offset at which the next whole member begins; the length of the rest if there is none."""
    at = rest.find(_HEAD, 1)
    while at >= 0:
        with suppress(ValueError):
            if _whole(memoryview(rest)[at:]):
                return at
        at = rest.find(_HEAD, at + 1)
    return len(rest)
