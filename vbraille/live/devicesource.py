"""The device that is read now, as a source of the live view.

The host's loop leaves records of its ticks in memory that any number of readers follow, each at its
own pace. Here each page is such a reader. The memory is mapped for reading only, so that nothing
that happens here can reach the loop.
"""

from __future__ import annotations

import math
import mmap
import os
import struct
import time
from typing import TYPE_CHECKING, Final

import msgspec
import numpy as np

from vbraille.engine.mailbox import Extent, watch
from vbraille.engine.record import FLOATS, INTS, SIGNAL, Ring, tick_dtype
from vbraille.errors import InputError
from vbraille.live.framing import FrameHeader, frame_bytes, joined, thinned
from vbraille.live.messages import MOST_SAMPLES, LetGo, PagePress, Point, Turn, ViewState
from vbraille.simulation.steering import BeAt

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from vbraille.engine.mailbox import Mailbox
    from vbraille.live.messages import Map, Next, PlayedEvent
    from vbraille.live.sources import Steering
    from vbraille.simulation.steering import Pointer

# A picture that is just being posted is looked at again; in between the poster needs some µs.
_TAKES: Final = 20
_TAKE_S: Final = 0.005
# The numbers that a record begins with, taken at once: field by field takes twenty times as long.
_NUMBERS: Final = struct.Struct(f"<{len(INTS)}q{len(FLOATS)}d")
_COUNT_BYTES: Final = 8
_SIGNAL: Final = len(INTS) + SIGNAL  # place of the first signal in a record


class TickViews:
    """The memory of one start of the host, mapped for reading only, as many pages look at it.

    `vbraille.engine.ring.RingReader` copies every record whole. A page needs the newest one whole,
    and three numbers of those before it; so each page has a number for its cursor, and all have
    these views.

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
        """Number of records up to now."""
        return self._published[0]

    def newest(self, end: int) -> tuple[tuple[float, ...], bytes]:
        """Copy the last of the first ``end`` records, which must be above 0.

        Returns
        -------
        tuple[float, ...]
            Numbers of the tick, in the order of `vbraille.engine.record.INTS` and `FLOATS`.
        bytes
            Frame of the tick, float32[rows, columns].
        """
        begin = (end - 1) % self._size * self._bytes
        record = bytes(self._memory[begin : begin + self._bytes])
        return _NUMBERS.unpack_from(record), record[_NUMBERS.size : self._frame_end]

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


class DeviceSource:
    """A `vbraille.live.sources.LiveSource` of a device that is read now.

    Parameters
    ----------
    forward
        Function that takes commands and turned knobs, for the reader.
    hand
        What holds the simulated hand; None if no page may be the hand.
    blind
        Whether stimuli are hidden. That cannot be taken back, and a state that says so has the
        same effect from then on.

    Attributes
    ----------
    told : tuple[int, bytes]
        Number of the newest state, and the state as JSON.
    watched : TickViews or None
        Memory of the host that runs; None before the first.
    blind : bool
        Whether stimuli are hidden.
    signals : int
        Number of signals of the newest state.
    """

    playback = False
    length_s = 0.0
    moments: Sequence[PlayedEvent] = ()

    def __init__(
        self,
        forward: Callable[[PagePress | Turn], None],
        hand: Pointer | None = None,
        *,
        blind: bool = False,
    ) -> None:
        self.watched: TickViews | None = None
        self.blind = blind
        self._forward = forward
        self._hand = hand
        self._title = ""
        self.show(ViewState(0, device="device: not open yet"))

    def show(self, state: ViewState) -> None:
        """Have pages be told another state, without the stimuli if those are hidden."""
        self.blind = self.blind or state.blind
        if self.blind:
            state = msgspec.structs.replace(
                state,
                lines=[],
                rows_shown=[],
                scene=None,
                beside=None,
                figures=[],
                signals=[],
                blind=True,
            )
        self._title = state.title
        self.signals = len(state.signals)
        self.told = state.number, msgspec.json.encode(state)

    def watch(self, watched: TickViews) -> None:
        """Have pages watch a host that was started; each begins with its newest tick."""
        self.watched = watched

    def viewer(self) -> DeviceViewer:
        """Make the viewer of a page."""
        return DeviceViewer(self)

    def map(self, request: Map) -> bytes:
        """Draw the map of what is under the hand.

        Raises
        ------
        InputError
            If stimuli are hidden, or nothing that has a map is under the hand.
        """
        drawn = b"" if self.blind else self._drawn(request)
        if self.blind:  # meanwhile, at the latest
            raise InputError("there is no map: stimuli are hidden until all answers are given")
        return drawn

    def _drawn(self, request: Map) -> bytes:
        watched = self.watched
        if watched is None or not watched.mailbox.published:
            raise InputError("there is no map: nothing is under the hand yet")
        for _ in range(_TAKES):
            posted = watched.mailbox.take()
            if posted is not None:
                break
            time.sleep(_TAKE_S)
        else:
            raise InputError("the map could not be drawn while lines change; ask for it again")
        from vbraille.live import maps  # loads Pillow and the kernels

        try:
            return maps.picture(posted.program, request.form, self._title)
        except ValueError as error:
            raise InputError(f"there is no map: {error}") from None

    def ask(self, request: Steering) -> None:
        """Take what a page with the right to steer asks for.

        Raises
        ------
        InputError
            If there is no hand that a page could be, or it is sent nowhere.
        """
        if not isinstance(request, Point | LetGo):
            self._forward(request)
            return
        if self._hand is None:
            raise InputError("a real hand moves this device; there is none that a page could be")
        if isinstance(request, LetGo):
            self._hand.let_go()
            return
        try:
            at = BeAt(request.x_mm, request.y_mm, request.theta_rad)
        except ValueError as error:
            raise InputError(str(error)) from None
        self._hand.hold(at)


class DeviceViewer:
    """View of a device by one page.

    Parameters
    ----------
    source
        The device.
    """

    def __init__(self, source: DeviceSource) -> None:
        self._source = source
        self._watched: TickViews | None = None
        self._cursor = 0  # number of the record that comes next

    def state(self, request: Next) -> tuple[int, bytes]:  # noqa: ARG002 - it is the same for all
        """Number of the newest state, and the state as JSON."""
        return self._source.told

    def frame(self, request: Next, *, again: bool = False) -> bytes | None:
        """Give the newest tick, with those since the last call as samples."""
        watched, state = self._source.watched, self._source.told[0]
        end = 0 if watched is None else watched.published
        if watched is not self._watched:
            self._watched = watched
            self._cursor = max(end - 1, 0)
        if end == self._cursor and not again:
            return None
        if watched is None or not end:
            return frame_bytes(FrameHeader(state=state))
        numbers, deflections = watched.newest(end)
        row = -1 if self._source.blind else request.row
        samples = watched.samples(self._cursor, end, row, request.column)
        self._cursor = end
        shape, signals = watched.shape, b""
        if self._source.blind:
            shape, deflections = (0, 0), b""
        elif count := self._source.signals:
            signals = struct.pack(f"<{count}f", *numbers[_SIGNAL : _SIGNAL + count])
        return joined(_header(numbers, state), shape, deflections, samples, signals)


def _header(numbers: Sequence[float], state: int) -> FrameHeader:
    """Header of a tick, by the numbers of its record."""
    (
        tick, time_ns, _, lateness_ns, work_ns, late, _, line, part, flags,
        x_mm, y_mm, theta_rad, vx_mm_s, _, _, _, _, share, *_,
    ) = numbers  # fmt: skip
    return FrameHeader(
        int(flags), state, int(line), int(part), int(late), tick, time_ns / 1e9,
        x_mm, y_mm, theta_rad, vx_mm_s, lateness_ns / 1e3, work_ns / 1e3, share,
        (time.monotonic_ns() - time_ns) / 1e6,
    )  # fmt: skip
