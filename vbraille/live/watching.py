"""The device that is read now, as a source of the live view.

The host's loop leaves records of its ticks in memory that any number of readers follow, each at its
own pace. Here each page is such a reader. The memory is mapped for reading only, so that nothing
that happens here can reach the loop.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Final

import msgspec

from vbraille.errors import InputError
from vbraille.live.framing import FrameHeader, frame_bytes, joined
from vbraille.live.messages import LetGo, PagePress, Point, Turn, ViewState
from vbraille.simulation.steering import BeAt

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from vbraille.live.messages import Map, Next, PlayedEvent
    from vbraille.live.sources import Steering
    from vbraille.live.ticks import TickViews
    from vbraille.simulation.steering import Pointer

# A picture that is just being posted is looked at again; in between the poster needs some µs.
_TAKES: Final = 20
_TAKE_S: Final = 0.005


class Watching:
    """A `vbraille.live.sources.LiveSource` of a device that is read now.

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
    watched : TickViews or None
        Memory of the host that runs; None before the first.
    blind : bool
        Whether stimuli are hidden.
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
            state = msgspec.structs.replace(state, lines=[], rows_shown=[], scene=None, blind=True)
        self._title = state.title
        self.told = state.number, msgspec.json.encode(state)

    def watch(self, watched: TickViews) -> None:
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


class WatchingViewer:
    """What one page sees of a device.

    Parameters
    ----------
    source
        The device.
    """

    def __init__(self, source: Watching) -> None:
        self._source = source
        self._watched: TickViews | None = None
        self._cursor = 0  # number of the record that comes next

    def state(self, request: Next) -> tuple[int, bytes]:  # noqa: ARG002 - it is the same for all
        """Number of the newest state, and the state as JSON."""
        return self._source.told

    def frame(self, request: Next, *, again: bool = False) -> bytes | None:
        """Give the newest tick, with those since the last call as samples."""
        watched = self._source.watched
        if watched is None:
            return frame_bytes(FrameHeader(state=self._source.told[0])) if again else None
        end = watched.published
        if watched is not self._watched:
            self._watched = watched
            self._cursor = max(end - 1, 0)
        if not end:
            return frame_bytes(FrameHeader(state=self._source.told[0])) if again else None
        if end == self._cursor and not again:
            return None
        numbers, deflections = watched.newest(end)
        row = -1 if self._source.blind else request.row
        samples = watched.samples(self._cursor, end, row, request.column)
        self._cursor = end
        shape = watched.shape
        if self._source.blind:
            shape, deflections = (0, 0), b""
        return joined(_header(numbers, self._source.told[0]), shape, deflections, samples)


def _header(numbers: Sequence[float], state: int) -> FrameHeader:
    """Header of a tick, by the numbers of its record."""
    (
        tick, time_ns, _, lateness_ns, work_ns, late, _, line, part, flags,
        x_mm, y_mm, theta_rad, vx_mm_s, _, _, _, _, share,
    ) = numbers  # fmt: skip
    return FrameHeader(
        int(flags), state, int(line), int(part), int(late), tick, time_ns / 1e9,
        x_mm, y_mm, theta_rad, vx_mm_s, lateness_ns / 1e3, work_ns / 1e3, share,
        (time.monotonic_ns() - time_ns) / 1e6,
    )  # fmt: skip
