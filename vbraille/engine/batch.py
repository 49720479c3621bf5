"""The loop's ticks by the block, for simulated hands: as fast as the machine can.

What `LocalEngine` does on a clock that is turned by hand, with array operations:
the same records, some thirty times as soon. No tick of it is late, no sample
missing, and no hand so fast that its carriage seems lost; that part of the loop
is not here.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING, Self

import numpy as np

from vbraille.devices.recorded import Recorded
from vbraille.devices.simulated import SimulatedDevice
from vbraille.engine.clock import ManualClock
from vbraille.engine.engine import place_of
from vbraille.engine.loop import FADE_S, IDLE_S, NS_PER_S, PAUSE_FADE_S, STILL_MM
from vbraille.engine.ring import Flag, tick_dtype
from vbraille.engine.tally import Tally
from vbraille.engine.velocity import DIFFERENCE, GAP_NS, MEAN
from vbraille.errors import InputError
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from vbraille.devices import Device
    from vbraille.devices.events import Event
    from vbraille.display import Display
    from vbraille.render.renderer import Renderer

_FADE_NS = int(FADE_S * NS_PER_S)
_PAUSE_FADE_NS = int(PAUSE_FADE_S * NS_PER_S)
_IDLE_NS = int(IDLE_S * NS_PER_S)


class BatchEngine:
    """An `Engine` that does all ticks of a poll at once. A context manager.

    Parameters
    ----------
    device
        Opened, and closed by whoever opened it. It lives by the engine's clock
        from now on.
    rate_hz
        Ticks a second.
    poll_ticks
        Ticks done by each poll. A poll in which the hand comes to its end is
        over with that tick, so that nothing runs on with a hand that is done.

    Attributes
    ----------
    device : SimulatedDevice
        The device; it is sent the last frame of each poll only.
    newest : record or None
        The last tick polled.
    tally : Tally
        What was done so far.
    counts : dict[str, int]
        What went wrong with the device: nothing.
    lost : int
        Ticks that were never polled: none.

    Raises
    ------
    InputError
        If the device has no hand that reads lines.
    ValueError
        If the rate is not 1 to 10,000 Hz, or a poll does nothing.
    """

    def __init__(self, device: Device, rate_hz: float = 1000.0, poll_ticks: int = 1000) -> None:
        if not 1 <= rate_hz <= 10_000:
            raise ValueError(f"rate is {rate_hz:g} Hz; it must be 1 to 10000 Hz")
        if poll_ticks < 1:
            raise ValueError(f"a poll does {poll_ticks} ticks; it must do 1 or more")
        hand = device.hand if isinstance(device, SimulatedDevice) else None
        if not isinstance(device, SimulatedDevice) or hand is None or isinstance(hand, Recorded):
            raise InputError(
                f"{setting('fast')} needs a hand that reads lines: slow, fluent or sweep:SPEED"
            )
        self.newest: np.void | None = None
        self.tally = Tally()
        self.counts: dict[str, int] = {}
        self.lost = 0
        self._clock = ManualClock()
        self.device = device
        device.go_by(self._clock.now_ns)
        self._poll_ticks = poll_ticks
        self._period_ns = round(NS_PER_S / rate_hz)
        shape = device.display.rows, device.display.columns
        self._dtype = tick_dtype(shape)
        self._picture: Renderer | None = None
        self._line = 0
        self._paused = False
        self._followed = False
        self._rested = device.rested
        self._shown: Renderer | None = None  # what was last under the hand; None at rest
        self._output = np.zeros(shape, np.float32)
        self._held = self._output
        self._fading_ns = _FADE_NS
        self._faded_from_ns = -_FADE_NS
        self._moved_ns = 0
        self._moved_mm = math.inf  # from where the first place is motion
        self._places_mm = np.empty(0)  # the last ones, as far as the velocity needs them
        self._velocities = np.zeros(MEAN - 1)

    @property
    def display(self) -> Display:
        """What the device says of itself."""
        return self.device.display

    @property
    def x_mm(self) -> float | None:
        """Where the array's left column was at the last poll; None before it is known."""
        return place_of(self.newest)

    @property
    def paused(self) -> bool:
        """Whether the array rests; setting it takes effect with the next tick."""
        return self._paused

    @paused.setter
    def paused(self, paused: bool) -> None:
        self._paused = paused
        self._moved_ns = self._clock.now_ns()

    def show(self, picture: Renderer, line: int, end_mm: float) -> None:
        """Put a picture of a line under the hand; see `Engine`."""
        self._picture = picture
        if line != self._line:
            self._line = line
            self.device.follow(end_mm)
            self._followed = False

    def take_events(self) -> Sequence[Event]:
        """What there is to tell since the last call."""
        return self.device.take_events()

    def set_zero(self) -> None:
        """Say that the carriage is at the left stop now."""
        self.device.set_zero()

    def poll(self) -> NDArray[np.void]:
        """Do some ticks; their records, `vbraille.engine.ring.tick_dtype`[n]."""
        tick = self.tally.ticks + np.arange(self._poll_ticks)
        times_ns = tick * self._period_ns
        followed = self.device.followed_at(times_ns)
        if followed[-1] and not self._followed:
            count = int(followed.argmax()) + 1
            tick, times_ns, followed = tick[:count], times_ns[:count], followed[:count]
        self._followed = bool(followed[-1])
        x_mm = self.device.places_mm(times_ns)
        self._clock.sleep_until_ns(int(times_ns[-1]))
        ticks = np.zeros(tick.size, self._dtype)
        ticks["tick"] = tick
        ticks["time_ns"] = ticks["device_ns"] = times_ns
        ticks["line"] = self._line
        ticks["x_mm"] = x_mm
        ticks["flags"] = followed * int(Flag.FOLLOWED) + self._paused * int(Flag.PAUSED)
        ticks["flags"] += (not self.device.taking) * int(Flag.HELD)
        ticks["share"] = 1.0
        self._measure(ticks, x_mm)
        self._render(ticks, self._idle(times_ns, x_mm), times_ns, x_mm)
        self.device.write(self._output.astype(np.float64))
        self.newest = ticks[-1]
        self.tally = Tally.of(ticks[-1])
        return ticks

    def start(self) -> None:
        """Nothing: its ticks are the polls."""

    def close(self) -> None:
        """Nothing: whoever opened the device closes it."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        """Nothing, as `close`."""

    def _idle(self, times_ns: NDArray[np.int64], x_mm: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Whether the hand has stood still for long, bool[n]."""
        # One after the other, since each place that counts as motion moves the next one's mark.
        moved, mark = [], self._moved_mm
        for n, place in enumerate(x_mm.tolist()):
            if abs(place - mark) > STILL_MM:
                mark = place
                moved.append(n)
        self._moved_mm = mark
        moved_ns = np.full(times_ns.size, self._moved_ns)
        moved_ns[moved] = times_ns[moved]
        np.maximum.accumulate(moved_ns, out=moved_ns)
        self._moved_ns = int(moved_ns[-1])
        return times_ns - moved_ns > _IDLE_NS

    def _measure(self, ticks: NDArray[np.void], x_mm: NDArray[np.float64]) -> None:
        """Fill in speed (as `Velocity`) and the way to the right."""
        before_mm = self._places_mm
        if not before_mm.size:
            before_mm = np.full(1, x_mm[0])
        steps_mm = np.diff(x_mm, prepend=before_mm[-1])
        right = steps_mm > 0
        # A running sum from what there is: rounded tick by tick, whatever the size of a block.
        for field, added, so_far in (
            ("forward_mm", np.where(right, steps_mm, 0.0), self.tally.forward_mm),
            ("forward_s", right * (self._period_ns / NS_PER_S), self.tally.forward_s),
        ):
            ticks[field] = np.cumsum(np.concatenate(([so_far], added)))[1:]
        places_mm = np.concatenate((self._places_mm, x_mm))
        self._places_mm = places_mm[-DIFFERENCE:]
        if self._period_ns >= GAP_NS:
            return
        ways_mm = places_mm[DIFFERENCE:] - places_mm[:-DIFFERENCE]
        velocities = np.zeros(MEAN - 1 + x_mm.size)  # 0 before there are enough places
        velocities[: MEAN - 1] = self._velocities
        if ways_mm.size:
            velocities[-ways_mm.size :] = ways_mm / (DIFFERENCE * self._period_ns) * NS_PER_S
        self._velocities = velocities[x_mm.size :]
        ticks["speed_mm_s"] = np.convolve(velocities, np.ones(MEAN), "valid") / MEAN

    def _render(
        self,
        ticks: NDArray[np.void],
        idle: NDArray[np.bool_],
        times_ns: NDArray[np.int64],
        x_mm: NDArray[np.float64],
    ) -> None:
        """Fill in the frames, with how they fade, run by run of picture or rest."""
        # Not in the records: for frames that do not lie together the kernel would be compiled anew.
        frames = np.zeros(ticks["frame"].shape, np.float32)
        flags, shares = ticks["flags"], ticks["share"]
        if self.device.rested != self._rested:
            self._rested = self.device.rested
            self._output = self._held = np.zeros_like(self._output)
            self._fading_ns, self._faded_from_ns = _FADE_NS, times_ns[0]
            flags[0] |= int(Flag.RESTED | Flag.CHANGED)
        held = not self.device.taking
        if held:
            self._output = self._held = np.zeros_like(self._output)
            self._shown = None
            self._faded_from_ns = times_ns[0] - self._fading_ns
        resting = idle | (self._paused or self._picture is None or held)
        turns = (np.flatnonzero(resting[1:] != resting[:-1]) + 1).tolist()
        for first, end in pairwise((0, *turns, ticks.size)):
            picture = None if resting[first] else self._picture
            if picture is not self._shown:
                self._held = frames[first - 1].copy() if first else self._output
                self._shown = picture
                self._fading_ns = _PAUSE_FADE_NS if self._paused else _FADE_NS
                self._faded_from_ns = times_ns[first]
                flags[first] |= int(Flag.CHANGED)
            if picture is None:
                flags[first:end] |= int(Flag.RESTING)
            else:
                picture.path(x_mm[first:end], frames[first:end])
            since_ns = times_ns[first:end] - self._faded_from_ns
            fading = first + int(np.searchsorted(since_ns, self._fading_ns))
            if fading > first:
                shares[first:fading] = since_ns[: fading - first] / self._fading_ns
                _blend(self._held, frames[first:fading], shares[first:fading])
        ticks["frame"] = frames
        self._output = frames[-1].copy()


def _blend(
    held: NDArray[np.float32], frames: NDArray[np.float32], shares: NDArray[np.float64]
) -> None:
    """Fade into frames from the one held, as `vbraille.render.kernels.blend` does."""
    share = shares[:, None, None]
    change = frames - held.astype(np.float64)
    frames[...] = np.where(share < 0.5, held + share * change, frames - (1.0 - share) * change)
