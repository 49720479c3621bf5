"""The last ticks, in memory that a recorder in another process reads.

One side appends, the other drains; neither waits for the other. The reader
copies, then looks how far the writer has come meanwhile: what may have been
overwritten under its hands it drops, and counts as lost. A record is published
with the next one, a tick later: that far apart, no processor shows the two
stores to another in the wrong order.
"""

from __future__ import annotations

import struct
from enum import IntFlag
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

_HEADER_BYTES = 64
_FIELDS = (
    ("tick", "<i8"),  # from 0
    ("time_ns", "<i8"),  # when the tick woke, by the host's monotonic clock
    ("device_ns", "<i8"),  # of the sample, by the device's clock
    ("lateness_ns", "<i8"),  # from the deadline to the waking
    ("work_ns", "<i8"),  # from waking until the frame was written
    ("late", "<i8"),  # deadlines missed so far
    ("overruns", "<i8"),  # ticks so far whose own work took longer than a period
    ("line", "<i8"),  # number of what is under the hand; 0 before the first
    ("flags", "<i8"),  # of `Flag`
    ("x_mm", "<f8"),  # where the array's left column is; NaN before the first sample
    ("speed_mm_s", "<f8"),
    ("forward_mm", "<f8"),  # way to the right so far, and the time that it took
    ("forward_s", "<f8"),
    ("share", "<f8"),  # how much of a change has faded in: 1 is all
)
_PACK = struct.Struct("<9q5d").pack_into


class Flag(IntFlag):
    """What else is true of a tick."""

    PAUSED = 1
    SILENT = 2  # the device has given no sample for a while
    FOLLOWED = 4  # in old traces: a simulated hand has come to its end; never set any more
    MARK = 8  # the device waits for its mark
    STOP = 16  # the device waits to be told that it is at the left stop
    RESTING = 32  # nothing is shown, whatever the line
    CHANGED = 64  # a fade begins here, from the frame before
    RESTED = 128  # the device had gone to rest by itself: the frame before was rest
    HELD = 256  # the device is at rest by itself and takes none of the frames that it is sent


def tick_dtype(shape: tuple[int, int]) -> np.dtype:
    """One record: the fields of a tick, and the frame that it sent, float32[rows, columns]."""
    return np.dtype([*_FIELDS, ("frame", "<f4", shape)], align=True)


class Ring:
    """Records of the last ticks.

    Parameters
    ----------
    buffer
        Zeroed memory of `bytes_needed`, shared or not.
    shape
        Rows and columns of a frame.
    size
        Ticks held.

    Attributes
    ----------
    lost : int
        Records that were overwritten before this end drained them.
    """

    def __init__(self, buffer: memoryview, shape: tuple[int, int], size: int) -> None:
        self.lost = 0
        self._size = size
        self._published = buffer[:_HEADER_BYTES].cast("q")
        self._records = np.frombuffer(buffer, tick_dtype(shape), size, _HEADER_BYTES)
        self._frames = self._records["frame"]
        self._bytes = buffer[_HEADER_BYTES:]
        self._appended = 0
        self._drained = 0

    @staticmethod
    def bytes_needed(shape: tuple[int, int], size: int) -> int:
        """Size of the buffer, a multiple of 8."""
        return _HEADER_BYTES + size * tick_dtype(shape).itemsize

    def append(self, frame: NDArray[np.float64], *fields: float) -> None:
        """Add a record: the frame, and the fields in their order but for the tick's number."""
        tick = self._appended
        self._published[0] = tick
        slot = tick % self._size
        _PACK(self._bytes, slot * self._records.itemsize, tick, *fields)
        np.copyto(self._frames[slot], frame, casting="same_kind")
        self._appended = tick + 1

    def publish(self) -> None:
        """Let the last record be seen at once."""
        self._published[0] = self._appended

    def drain(self) -> NDArray[np.void]:
        """Records since the last call, oldest first; `tick_dtype`[n]."""
        end = self._published[0]
        first = max(self._drained, end - self._size)
        ticks = self._records[np.arange(first, end) % self._size]
        # The slot after the last published one may be in the writing.
        whole = max(first, self._published[0] + 1 - self._size)
        self.lost += min(whole, end) - self._drained
        self._drained = end
        return ticks[whole - first :]
