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
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Protocol

import msgspec
import numpy as np

from vbraille.engine import shared
from vbraille.engine.record import FLOATS, INTS
from vbraille.errors import InputError
from vbraille.live.framing import NO_DEFLECTIONS, FrameHeader, frame_bytes, thinned
from vbraille.live.messages import MOST_SAMPLES, LetGo, Point, Press, State, Turn
from vbraille.simulation.steering import BeAt

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from vbraille.engine.mailbox import Mailbox
    from vbraille.engine.ring import RingReader
    from vbraille.live.messages import Map, Moment, Next
    from vbraille.live.sources import Steering

# The numbers that a record begins with, taken at once: field by field takes twenty times as long.
_NUMBERS: Final = struct.Struct(f"<{len(INTS)}q{len(FLOATS)}d")
# A picture that is just being posted is looked at again; in between the poster needs some µs.
_TAKES: Final = 20
_TAKE_S: Final = 0.005


class HandHolder(Protocol):
    """What holds a simulated hand; `vbraille.simulation.pointing.Pointer` is one."""

    def hold(self, at: BeAt) -> None:
        """Hold the hand at a pose."""
        ...

    def let_go(self) -> None:
        """Let the hand go."""
        ...


@dataclass(frozen=True, slots=True)
class Watched:
    """The memory of one start of the host, mapped for reading only.

    Parameters
    ----------
    memory
        The memory.
    extent
        What decides its size.
    """

    memory: memoryview
    extent: shared.Extent

    @classmethod
    def of(cls, descriptor: int, extent: shared.Extent) -> Watched:
        """Map the memory of a descriptor, which may be closed then.

        Raises
        ------
        ValueError
            If there is less memory than the extent says.
        """
        there = os.fstat(descriptor).st_size
        if there < extent.total_bytes:
            raise ValueError(f"the memory has {there} of {extent.total_bytes} bytes")
        mapped = mmap.mmap(descriptor, extent.total_bytes, prot=mmap.PROT_READ)
        return cls(memoryview(mapped), extent)

    def reader(self) -> RingReader:
        """Make a reader of the ticks from the newest on."""
        return shared.watch(self.memory, self.extent)[1]

    @property
    def mailbox(self) -> Mailbox:
        """The pictures that were posted."""
        return shared.watch(self.memory, self.extent)[0]


class Watching:
    """A `vbraille.live.sources.Source` of a device that is read now.

    Parameters
    ----------
    forward
        Function that takes commands and turned knobs, for whoever reads.
    hand
        What holds the simulated hand; None if no page may be the hand.
    blind
        Whether stimuli are hidden. That cannot be taken back, and a state that says so has the
        same effect from then on.

    Attributes
    ----------
    told : tuple[int, bytes]
        Number of the newest state, and the state as JSON.
    watched : Watched or None
        Memory of the host that runs; None before the first.
    blind : bool
        Whether stimuli are hidden.
    """

    playback = False
    length_s = 0.0
    moments: Sequence[Moment] = ()

    def __init__(
        self,
        forward: Callable[[Press | Turn], None],
        hand: HandHolder | None = None,
        *,
        blind: bool = False,
    ) -> None:
        self.watched: Watched | None = None
        self.blind = blind
        self._forward = forward
        self._hand = hand
        self._title = ""
        self.show(State(0, device="device: not open yet"))

    def show(self, state: State) -> None:
        """Have pages be told another state, without the stimuli if those are hidden."""
        self.blind = self.blind or state.blind
        if self.blind:
            state = msgspec.structs.replace(state, lines=[], rows_shown=[], blind=True)
        self._title = state.title
        self.told = state.number, msgspec.json.encode(state)

    def watch(self, watched: Watched) -> None:
        """Have pages watch a host that was started; each begins with its newest tick."""
        self.watched = watched

    def viewer(self) -> WatchingViewer:
        """Make the viewer of a page."""
        return WatchingViewer(self)

    def map(self, request: Map) -> bytes:
        """Draw the map of what is under the hand.

        Raises
        ------
        InputError
            If stimuli are hidden, or nothing that has a map is under the hand.
        """
        if self.blind:
            raise InputError("there is no map: stimuli are hidden until all answers are given")
        if self.watched is None or not self.watched.mailbox.published:
            raise InputError("there is no map: nothing is under the hand yet")
        for _ in range(_TAKES):
            posted = self.watched.mailbox.take()
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


class WatchingViewer:
    """What one page sees of a device.

    Parameters
    ----------
    source
        The device.
    """

    def __init__(self, source: Watching) -> None:
        self._source = source
        self._watched: Watched | None = None
        self._reader: RingReader | None = None
        self._newest: NDArray[np.void] | None = None

    def state(self, request: Next) -> tuple[int, bytes]:  # noqa: ARG002 - it is the same for all
        """Number of the newest state, and the state as JSON."""
        return self._source.told

    def frame(self, request: Next, *, again: bool = False) -> bytes | None:
        """Give the newest tick, with those since the last call as samples."""
        ticks = self._drain()
        if ticks is not None and ticks.size:
            self._newest = ticks[-1:].copy() if ticks.size > 1 else ticks
        elif not again:
            return None
        number = self._source.told[0]
        if self._newest is None or ticks is None:
            return frame_bytes(FrameHeader(state=number))
        header = _header(self._newest, number)
        deflections = self._newest["frame"][0]
        samples = _samples(ticks, request)
        if self._source.blind:
            samples[:, 2] = math.nan
            deflections = NO_DEFLECTIONS
        return frame_bytes(header, deflections, samples)

    def _drain(self) -> NDArray[np.void] | None:
        """Copy the ticks since the last call; None before the first host is started."""
        if self._watched is not self._source.watched:
            self._watched = self._source.watched
            assert self._watched is not None  # hosts come, and none is taken away
            self._reader = self._watched.reader()
        return None if self._reader is None else self._reader.drain()


def _header(newest: NDArray[np.void], state: int) -> FrameHeader:
    """Header of a tick, `tick_dtype`[1]."""
    (
        tick, time_ns, _, lateness_ns, work_ns, late, _, line, part, flags,
        x_mm, y_mm, theta_rad, vx_mm_s, _, _, _, _, share,
    ) = _NUMBERS.unpack_from(newest.view(np.uint8).data)  # fmt: skip
    return FrameHeader(
        flags=flags,
        state=state,
        line=line,
        part=part,
        late=late,
        tick=tick,
        time_s=time_ns / 1e9,
        x_mm=x_mm,
        y_mm=y_mm,
        theta_rad=theta_rad,
        vx_mm_s=vx_mm_s,
        lateness_us=lateness_ns / 1e3,
        work_us=work_ns / 1e3,
        share=share,
        age_ms=(time.monotonic_ns() - time_ns) / 1e6,
    )


def _samples(ticks: NDArray[np.void], request: Next) -> NDArray[np.float32]:
    """Samples of the ticks, as `frame_bytes` takes them; NaN for an actuator there is not."""
    if len(ticks) > MOST_SAMPLES:
        ticks = ticks[thinned(len(ticks))]
    samples = np.empty((len(ticks), 3), np.float32)
    if len(ticks):
        times_ns, frames = ticks["time_ns"], ticks["frame"]
        samples[:, 0] = (times_ns[-1] - times_ns) / 1e9
        samples[:, 1] = ticks["x_mm"]
        row, column = request.row, request.column
        is_there = 0 <= row < frames.shape[1] and 0 <= column < frames.shape[2]
        samples[:, 2] = frames[:, row, column] if is_there else math.nan
    return samples
