"""The last ticks, in memory that any number of readers follow, each at its own pace.

The writer appends, readers drain, and nobody waits for anybody: a reader that is too slow loses
records, and counts them. It copies, then looks how far the writer has come meanwhile: what may
have been overwritten under its hands it drops. A record is published with the next one, a tick
later: that far apart, no processor shows the two stores to another in the wrong order.
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
    ("part", "<i8"),  # which part of a picture that has several is under the array
    ("flags", "<i8"),  # of `Flag`
    ("x_mm", "<f8"),  # where the array is, a `vbraille.pose.Pose`; NaN before the first sample
    ("y_mm", "<f8"),
    ("theta_rad", "<f8"),
    ("vx_mm_s", "<f8"),  # velocity of the hand
    ("vy_mm_s", "<f8"),
    ("forward_mm", "<f8"),  # way to the right so far, and the time that it took
    ("forward_s", "<f8"),
    ("shown_s", "<f8"),  # the picture's own time since its start, if it moves by itself
    ("share", "<f8"),  # how much of a change has faded in: 1 is all
)
_PACK = struct.Struct("<10q9d").pack_into


class Flag(IntFlag):
    """What else is true of a tick."""

    PAUSED = 1
    SILENT = 2  # the device has given no sample for a while
    FOLLOWED = 4  # a simulated hand has come to its end
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
    """The writer's end.

    Parameters
    ----------
    buffer
        Zeroed memory of `bytes_needed`, shared or not.
    shape
        Rows and columns of a frame.
    size
        Ticks held.
    """

    def __init__(self, buffer: memoryview, shape: tuple[int, int], size: int) -> None:
        self._size = size
        self._published, self._records = _views(buffer, shape, size)
        self._frames = self._records["frame"]
        self._bytes = buffer[_HEADER_BYTES:]
        self._appended = 0

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


class RingReader:
    """A reader's end; there may be many on one memory, in this process and in others.

    It begins with the newest record that is there when it joins; one that joins before the
    writer's first sees all.

    Parameters
    ----------
    buffer, shape, size
        As the writer's. Nothing is written to the memory, which may be read-only.

    Attributes
    ----------
    cursor : int
        Number of the tick that comes next.
    lost : int
        Records that were overwritten before this reader drained them.
    """

    def __init__(self, buffer: memoryview, shape: tuple[int, int], size: int) -> None:
        self.lost = 0
        self._size = size
        self._published, self._records = _views(buffer, shape, size)
        self.cursor = max(self._published[0] - 1, 0)

    def drain(self) -> NDArray[np.void]:
        """Records since the last call, oldest first; `tick_dtype`[n], copies."""
        end = self._published[0]
        first = max(self.cursor, end - self._size)
        ticks = self._records[np.arange(first, end) % self._size]
        # The slot after the last published one may be in the writing.
        whole = min(max(first, self._published[0] + 1 - self._size), end)
        self.lost += whole - self.cursor
        self.cursor = end
        return ticks[whole - first :]


def _views(
    buffer: memoryview, shape: tuple[int, int], size: int
) -> tuple[memoryview, NDArray[np.void]]:
    """How many records are published, and the records."""
    published = buffer[:_HEADER_BYTES].cast("q")
    return published, np.frombuffer(buffer, tick_dtype(shape), size, _HEADER_BYTES)
