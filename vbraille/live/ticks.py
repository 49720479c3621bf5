"""The records of the host's loop, as many pages look at them: each only what it draws.

`vbraille.engine.ring.RingReader` copies every record whole. A page needs the newest one whole, and
three numbers of those before it; so each page has a number for its cursor, and all have these
views.
"""

from __future__ import annotations

import math
import mmap
import os
import struct
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from vbraille.engine.record import FLOATS, INTS, tick_dtype
from vbraille.engine.ring import Ring
from vbraille.engine.shared import Extent, watch
from vbraille.live.framing import thinned
from vbraille.live.messages import MOST_SAMPLES

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.engine.mailbox import Mailbox

# The numbers that a record begins with, taken at once: field by field takes twenty times as long.
_NUMBERS: Final = struct.Struct(f"<{len(INTS)}q{len(FLOATS)}d")
_COUNT_BYTES: Final = 8


class NewestTick(NamedTuple):
    """The newest record.

    Parameters
    ----------
    numbers
        Numbers of the tick, in the order of `vbraille.engine.record.INTS` and `FLOATS`.
    deflections
        Frame of the tick, float32[rows, columns], as bytes.
    """

    numbers: tuple[int | float, ...]
    deflections: bytes


class TickViews:
    """The memory of one start of the host, mapped for reading only.

    Parameters
    ----------
    descriptor
        Descriptor of the memory, which may be closed then.
    extent
        What decides the size of the memory.

    Attributes
    ----------
    shape : tuple[int, int]
        Rows and columns of a frame.
    mailbox : Mailbox
        Pictures that were posted to the host.

    Raises
    ------
    ValueError
        If there is less memory than the extent says.
    """

    def __init__(self, descriptor: int, extent: Extent) -> None:
        there = os.fstat(descriptor).st_size
        if there < extent.total_bytes:
            raise ValueError(f"the memory has {there} of {extent.total_bytes} bytes")
        memory = memoryview(mmap.mmap(descriptor, extent.total_bytes, prot=mmap.PROT_READ))
        self.mailbox: Mailbox = watch(memory, extent)[0]
        ring = memory[extent.mailbox_bytes :]
        begin = Ring.bytes_needed(extent.shape, 0)
        dtype = tick_dtype(extent.shape)
        records = np.frombuffer(ring, dtype, extent.ticks, begin)
        self.shape = extent.shape
        self._size = extent.ticks
        self._bytes = dtype.itemsize
        self._memory = ring[begin:]
        self._published = ring[:_COUNT_BYTES].cast("q")
        self._times_ns, self._x_mm = records["time_ns"], records["x_mm"]
        self._frames = records["frame"]
        self._frame_end = _NUMBERS.size + 4 * extent.rows * extent.columns
        self._samples = np.empty((MOST_SAMPLES, 3), np.float32)
        self._ago_s, self._places, self._follows = self._samples.T

    @property
    def published(self) -> int:
        """How many records there have been, up to now."""
        return self._published[0]

    def newest(self, end: int) -> NewestTick:
        """Copy the last of the first ``end`` records, which must be above 0."""
        begin = (end - 1) % self._size * self._bytes
        record = bytes(self._memory[begin : begin + self._bytes])
        return NewestTick(_NUMBERS.unpack_from(record), record[_NUMBERS.size : self._frame_end])

    def samples(self, first: int, end: int, row: int, column: int) -> bytes:
        """Make the samples of records.

        Parameters
        ----------
        first, end
            The records: from this number, from 0, to the one before that.
        row, column
            The actuator whose deflection is told; NaN if there is no such actuator.

        Returns
        -------
        bytes
            float32[n, 3] as `vbraille.live.framing.frame_bytes` describes it, of at most
            `MOST_SAMPLES`. Records that may have been overwritten meanwhile are left out.
        """
        first = max(first, end - self._size)
        count = end - first
        at = first % self._size
        slots: slice | NDArray[np.intp] = slice(at, at + count)
        if count > MOST_SAMPLES or at + count > self._size:
            slots = (first + thinned(count)) % self._size
            count = slots.size
        if not count:
            return b""
        times_ns = self._times_ns[slots]
        rows, columns = self.shape
        is_there = 0 <= row < rows and 0 <= column < columns
        # Filled column by column, in memory of its own, since that is made for each frame.
        self._ago_s[:count] = (times_ns[-1] - times_ns) * 1e-9
        self._places[:count] = self._x_mm[slots]
        self._follows[:count] = self._frames[slots, row, column] if is_there else math.nan
        # The slot after the last published one may just be written.
        overwritten = self.published + 1 - self._size - first
        if overwritten > 0:
            numbers = thinned(end - first)
            return self._samples[:count][numbers >= overwritten].tobytes()
        return self._samples[:count].tobytes()
