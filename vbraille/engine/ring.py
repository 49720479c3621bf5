"""The last ticks, in memory that any number of readers follow, each at its own pace.

One side appends, and never waits for anybody. A reader copies, then looks how far the writer has
come meanwhile: what may have been overwritten under its hands it drops, and counts as lost. A
record is published with the next one, a tick later: that far apart, no processor shows the two
stores to another in the wrong order.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Self

import numpy as np

from vbraille.engine.record import columns_of, tick_dtype

if TYPE_CHECKING:
    from numpy.typing import NDArray

_HEADER_BYTES = 64


class Ring:
    """The writer's end: records of the last ticks.

    Parameters
    ----------
    buffer
        Zeroed memory of `bytes_needed`, shared or not.
    shape
        Rows and columns of a frame.
    size
        How many ticks it holds.

    Attributes
    ----------
    columns : tuple of arrays
        All records, as `vbraille.engine.record.columns_of` gives them, to be filled.
    integers : memoryview[size, INTS]
        Whole numbers of all records.
    published : int64[1]
        How many records may be read.
    """

    def __init__(self, buffer: memoryview, shape: tuple[int, int], size: int) -> None:
        self.size = size
        self.published = np.frombuffer(buffer, np.int64, 1)
        self.columns = columns_of(np.frombuffer(buffer, tick_dtype(shape), size, _HEADER_BYTES))
        self.integers = self.columns[0].data  # set one by one in half of numpy's time
        self._buffer = buffer
        self._shape = shape
        self.appended = 0

    @classmethod
    def alone(cls, shape: tuple[int, int], size: int) -> Self:
        """Make a ring in memory of its own."""
        return cls(memoryview(bytearray(cls.bytes_needed(shape, size))), shape, size)

    @staticmethod
    def bytes_needed(shape: tuple[int, int], size: int) -> int:
        """Size of the buffer, a multiple of 8."""
        return _HEADER_BYTES + size * tick_dtype(shape).itemsize

    def begin(self) -> int:
        """Begin a record: let those before it be seen, and tell the place of the new one."""
        self.published[0] = self.appended
        return self.appended % self.size

    def end(self, count: int = 1) -> None:
        """End a record, or several that were filled one after the other."""
        self.appended += count

    def publish(self) -> None:
        """Let the last record be seen at once."""
        self.published[0] = self.appended

    def reader(self) -> RingReader:
        """Make a reader of the records from now on, in this process."""
        return RingReader(self._buffer, self._shape, self.size)


class RingReader:
    """A reader's end; there may be many on one memory, in this process and in others.

    It begins with the newest record that is there when it joins; a reader that joins before the
    first record sees all.

    Parameters
    ----------
    buffer, shape, size
        What the writer's end was made with. The memory may be read-only.

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
        self._published = buffer[:_HEADER_BYTES].cast("q")
        self._records = np.frombuffer(buffer, tick_dtype(shape), size, _HEADER_BYTES)
        self.cursor = max(self._published[0] - 1, 0)

    def drain(self) -> NDArray[np.void]:
        """Copy the records since the last call, oldest first; `tick_dtype`[n]."""
        end = self._published[0]
        first = max(self.cursor, end - self._size)
        ticks = self._records[np.arange(first, end) % self._size]
        # The slot after the last published one may just be written.
        whole = min(max(first, self._published[0] + 1 - self._size), end)
        self.lost += whole - self.cursor
        self.cursor = end
        return ticks[whole - first :]
