"""Traces read chunk by chunk, so that hours of ticks need no more memory than a second of them."""

from __future__ import annotations

import os
import weakref
import zlib
from typing import TYPE_CHECKING

import numpy as np

from vbraille.errors import VbrailleError
from vbraille.sessions.record.traces import (
    EXTRA,
    HEAD_BYTES,
    HEADS,
    TRACE,
    check_member,
    next_start,
)

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

# All checksums of a smaller trace are looked at when it is opened.
_SOON_CHECKED_BYTES = 1 << 25
# No chunk has so many ticks: what says so is no trace.
_MOST_BYTES = 1 << 24
_HEADER_BYTES = HEAD_BYTES + EXTRA.size


class ChunkedTrace:
    """A trace whose chunks are read one by one, in any order.

    Parameters
    ----------
    path
        Path of the trace.

    Attributes
    ----------
    record : numpy.dtype
        Kind of its records: `vbraille.sessions.record.traces.TRACE` or `LEFT_TRACE`.
    damage : list[int]
        Numbers of the chunks, from 0, before which something is not whole. In a very large trace
        only headers are looked at for that, and other damage is found when a chunk is read.
    torn_bytes : int
        Length of a last chunk that a crash cut short.

    Raises
    ------
    VbrailleError
        If the file cannot be read.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self.damage: list[int] = []
        self.torn_bytes = 0
        try:
            self._file = os.open(path, os.O_RDONLY | os.O_CLOEXEC)
            self._close = weakref.finalize(self, os.close, self._file)
            self._size = os.fstat(self._file).st_size
            self._places, self.record = self._walk()
        except OSError as error:
            raise self._fault(error) from None

    def __len__(self) -> int:
        """Count the chunks."""
        return len(self._places)

    def ticks(self, number: int) -> NDArray[np.void]:
        """Ticks of a chunk, as they were written; none if it is damaged or has none."""
        at, length = self._places[number]
        try:
            member = check_member(memoryview(self._read(at, length)), self.record)
            deflated = b"" if member is None else member.deflated
            chunk = zlib.decompressobj(-zlib.MAX_WBITS).decompress(deflated, _MOST_BYTES)
        except (ValueError, zlib.error):
            chunk = b""
        return np.frombuffer(chunk, self.record, len(chunk) // self.record.itemsize)

    def close(self) -> None:
        """Close the file; it is closed with the last use of this, too."""
        self._close()

    def _walk(self) -> tuple[list[tuple[int, int]], np.dtype]:
        """Places and lengths of all chunks that have something in them, by their headers alone."""
        places: list[tuple[int, int]] = []
        record: np.dtype | None = None
        at = 0
        while at < self._size:
            kind, length = self._header(at)
            if length and record in (None, kind):
                record = kind
                places.append((at, length))
                at += length
                continue
            rest = self._read(at, self._size - at)
            after = next_start(rest, 1)
            if after < len(rest) or not _is_torn(rest, record):
                self.damage.append(len(places))
            else:
                self.torn_bytes = len(rest)
            at += after
        return places, record or TRACE

    def _header(self, at: int) -> tuple[np.dtype | None, int]:
        """Kind of the records and length of the chunk at a place; length 0 if it is none."""
        head = self._read(at, _HEADER_BYTES)
        if len(head) < _HEADER_BYTES or (kind := HEADS.get(head[:HEAD_BYTES])) is None:
            return None, 0
        length = int(EXTRA.unpack_from(head, HEAD_BYTES)[0])
        if length > min(self._size - at, _MOST_BYTES):
            return None, 0
        try:
            if self._size <= _SOON_CHECKED_BYTES:
                check_member(memoryview(self._read(at, length)), kind)
        except ValueError:
            return None, 0
        return kind, length

    def _read(self, at: int, length: int) -> bytes:
        try:
            return os.pread(self._file, length, at)
        except OSError as error:
            raise self._fault(error) from None

    def _fault(self, error: OSError) -> VbrailleError:
        return VbrailleError(f"{self._path} cannot be read: {error.strerror}")


def _is_torn(rest: bytes, record: np.dtype | None) -> bool:
    """Whether a trace that ends with this was cut short in a chunk that may have been whole."""
    try:
        return check_member(memoryview(rest), record) is None
    except ValueError:
        return False
