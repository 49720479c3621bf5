"""The record of a tick, the ring of the last ones, and the tally of many.

A record is the same in the ring's memory, in a block of ticks and in the compiled code: whole
numbers, then numbers, then the frame. Columns of either kind are told apart by their place, so
that compiled code serves arrays of any shape.
"""

from __future__ import annotations

from enum import IntFlag
from typing import TYPE_CHECKING, NamedTuple, Self

import numpy as np

from vbraille.render.work import MOST_SIGNALS

if TYPE_CHECKING:
    from numpy.typing import NDArray


INTS = (
    "tick",  # number of the tick, from 0
    "time_ns",  # when the tick woke, by the host's monotonic clock
    "device_ns",  # when the pose was taken, by the device's clock
    "lateness_ns",  # from the deadline to the waking
    "work_ns",  # from waking until the frame was written
    "late",  # deadlines missed so far
    "line",  # number of what is under the hand; 0 before the first
    "part",  # which part of the picture is shown, such as the line of a page, from 0
    "flags",  # bits of `Flag`
)
FLOATS = (
    "x_mm",  # the array's centre on the canvas; NaN before the first pose
    "y_mm",
    "theta_rad",
    "vx_mm_s",  # the hand's velocity
    "vy_mm_s",
    "forward_mm",  # way to the right so far, and the time that it took
    "forward_s",
    "shown_s",  # the picture's own time, since it was put under the hand
    "share",  # how much of a change has faded in: 1 is all
    *(f"signal_{number}" for number in range(1, MOST_SIGNALS + 1)),  # values of a scene's signals
)
TICK, TIME, DEVICE, LATENESS, WORK, LATE, LINE, PART, FLAGS = range(len(INTS))
X, Y, THETA, VX, VY, FORWARD_MM, FORWARD_S, SHOWN, SHARE, SIGNAL = range(10)


class Flag(IntFlag):
    """Remarks on a tick, as bits."""

    PAUSED = 1
    SILENT = 2  # the device has given no pose for a while
    STOP = 16  # the device waits to be told that it is at the left stop
    RESTING = 32  # nothing is shown, whatever the line
    CHANGED = 64  # a fade begins here, from the frame before
    RESTED = 128  # the device had gone to rest by itself: the frame before was rest
    HELD = 256  # the device is at rest by itself and takes none of the frames that it is sent
    TURNED = 1024  # the array is turned too far for the picture, and rests
    UNFELT = 2048  # something is to be felt, and for one of these reasons cannot be


def tick_dtype(shape: tuple[int, int]) -> np.dtype:
    """Describe one record: the numbers of a tick, and its frame, float32[rows, columns]."""
    numbers = [(name, "<i8") for name in INTS] + [(name, "<f8") for name in FLOATS]
    return np.dtype([*numbers, ("frame", "<f4", shape)], align=True)


def columns_of(
    records: NDArray[np.void],
) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float32]]:
    """Views of records for compiled code: the whole numbers, the numbers and the frames.

    Returns
    -------
    int64[n, INTS], float64[n, FLOATS], float32[n, rows, columns]
        Views of the records' memory; their types do not depend on the frame's shape.
    """
    from numpy.lib.recfunctions import structured_to_unstructured  # loads numpy.ma

    ints, floats = (structured_to_unstructured(records[list(names)]) for names in (INTS, FLOATS))
    return ints, floats, records["frame"]


class Tally(NamedTuple):
    """Counts of what happened so far.

    Parameters
    ----------
    ticks, late
        Number of ticks done, and of deadlines that passed before their tick could begin.
    forward_mm, forward_s
        How far the hand went to the right in all, and how long that took.
    """

    ticks: int = 0
    late: int = 0
    forward_mm: float = 0.0
    forward_s: float = 0.0

    @property
    def scanning_mm_s(self) -> float:
        """Mean speed of the hand while it moved right; 0 if it never did."""
        return self.forward_mm / self.forward_s if self.forward_s else 0.0

    @classmethod
    def of(cls, tick: np.void) -> Self:
        """Make a tally from a record of the ring."""
        counts = (tick[name].item() for name in cls._fields[1:])
        return cls(int(tick["tick"]) + 1, *counts)


_HEADER_BYTES = 64
RING_S = 8.0  # of ticks are kept for readers


class RingReader:
    """A reader of records; there may be many on one memory, in this process and in others.

    It begins with the newest record that is there when it joins; a reader that joins before the
    first record sees all.

    Parameters
    ----------
    buffer
        Memory of `Ring.bytes_needed`, shared or not; it may be read-only.
    shape
        Rows and columns of a frame.
    size
        How many ticks it holds.

    Attributes
    ----------
    cursor : int
        Number of the tick that comes next.
    lost : int
        Records that were overwritten before this reader drained them.
    """

    def __init__(self, buffer: memoryview, shape: tuple[int, int], size: int) -> None:
        self.lost = 0
        self._of = buffer, shape, size
        self._published = buffer[:_HEADER_BYTES].cast("q")
        self._records = np.frombuffer(buffer, tick_dtype(shape), size, _HEADER_BYTES)
        self.cursor = max(self._published[0] - 1, 0)

    def another(self) -> RingReader:
        """Make another reader of the same memory, which begins with the newest record."""
        return RingReader(*self._of)

    def drain(self) -> NDArray[np.void]:
        """Copy the records since the last call, oldest first; `tick_dtype`[n]."""
        end, size = self._published[0], self._records.size
        first = max(self.cursor, end - size)
        ticks = self._records[np.arange(first, end) % size]
        # The slot after the last published one may just be written.
        whole = min(max(first, self._published[0] + 1 - size), end)
        self.lost += whole - self.cursor
        self.cursor = end
        return ticks[whole - first :]


class Ring(RingReader):
    """The writer's end: records of the last ticks, which begin as zeros.

    Attributes
    ----------
    columns : tuple of arrays
        All records, as `vbraille.engine.record.columns_of` gives them, to be filled.
    integers : memoryview[size, INTS]
        Whole numbers of all records.
    """

    def __init__(self, buffer: memoryview, shape: tuple[int, int], size: int) -> None:
        super().__init__(buffer, shape, size)
        self.columns = columns_of(self._records)
        self.integers = self.columns[0].data  # set one by one in half of numpy's time

    @classmethod
    def alone(cls, shape: tuple[int, int], size: int) -> Self:
        """Make a ring in memory of its own."""
        return cls(memoryview(bytearray(cls.bytes_needed(shape, size))), shape, size)

    @staticmethod
    def bytes_needed(shape: tuple[int, int], size: int) -> int:
        """Size of the buffer, a multiple of 8."""
        return _HEADER_BYTES + size * tick_dtype(shape).itemsize

    @property
    def slot(self) -> int:
        """Place of the record that comes next."""
        return self._published[0] % self._records.size

    def publish(self, count: int = 1) -> None:
        """Let a record be seen, or several that were filled one after the other."""
        self._published[0] += count
