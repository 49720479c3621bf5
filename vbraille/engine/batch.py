"""The loop's ticks, done many at a time for simulated hands, as fast as the machine can.

`BatchEngine` does what `LocalEngine` does on a clock that is turned by hand, by the same compiled
function. None of its ticks is late, and none lacks a pose.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Self

import numpy as np

from vbraille.engine.clock import ManualClock
from vbraille.engine.constants import NS_PER_S
from vbraille.engine.engine import place_of
from vbraille.engine.record import Tally, columns_of, tick_dtype
from vbraille.engine.state import LoopState
from vbraille.engine.ticks import POSE_THETA, POSE_X, POSED
from vbraille.errors import InputError
from vbraille.simulation.recorded import Recorded
from vbraille.simulation.simulated import SimulatedDevice
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from vbraille.devices import Device
    from vbraille.devices.events import Event
    from vbraille.display import Display
    from vbraille.render.program import Program


class BatchEngine:
    """An `Engine` that does all ticks of a poll at once; it is a context manager.

    Parameters
    ----------
    device
        An open device, which its opener closes. From now on it goes by the
        engine's clock.
    rate_hz
        Ticks a second.
    poll_ticks
        How many ticks each poll does. A poll in which the hand comes to its end stops with that
        tick, so that nothing is recorded of a hand that is done.

    Attributes
    ----------
    device : SimulatedDevice
        The device; it is sent the last frame of each poll only.
    newest : record or None
        Record of the last tick polled.
    tally : Tally
        Counts of what was done so far.
    calibration : None
        What is made up for in the actuators: nothing.
    counts : dict[str, int]
        Counts of what went wrong with the device; always empty.
    lost : int
        Number of ticks that were never polled; always 0.

    Raises
    ------
    InputError
        If the device has no hand that can be told to read a line.
    ValueError
        If the rate is not 1 to 10,000 Hz, ``poll_ticks`` is below 1, or the hand is not steered.
    """

    def __init__(self, device: Device, rate_hz: float = 1000.0, poll_ticks: int = 1000) -> None:
        if poll_ticks < 1:
            raise ValueError(f"a poll does {poll_ticks} ticks; it must do 1 or more")
        hand = device.hand if isinstance(device, SimulatedDevice) else None
        if not isinstance(device, SimulatedDevice) or hand is None or isinstance(hand, Recorded):
            raise InputError(
                f"{setting('fast')} needs a hand that reads lines: slow, fluent or sweep:SPEED"
            )
        if device.steering is None:
            raise ValueError("nothing steers the hand; a poll would not know when it is done")
        self.newest: np.void | None = None
        self.tally = Tally()
        self.counts: dict[str, int] = {}
        self.calibration: None = None
        self.lost = 0
        self._clock = ManualClock()
        self.device = device
        device.go_by(self._clock.now_ns)
        self._state = LoopState(device.display, rate_hz, 0, rested=device.rested)
        self._poll_ticks = poll_ticks
        self._period_ns = round(NS_PER_S / rate_hz)
        self._dtype = tick_dtype(device.display.shape)

    @property
    def display(self) -> Display:
        """The actuators and the carriage of the device."""
        return self.device.display

    @property
    def x_mm(self) -> float | None:
        """Place of the array's centre along x at the last poll; None before it is known."""
        return place_of(self.newest)

    @property
    def paused(self) -> bool:
        """Tell whether the array rests; setting it takes effect with the next tick."""
        return self._state.paused

    @paused.setter
    def paused(self, paused: bool) -> None:
        self._state.pause(paused, self._clock.now_ns())

    @property
    def switches(self) -> int:
        """States of a scene's switches; setting them takes effect with the next tick."""
        return self._state.switches

    @switches.setter
    def switches(self, switches: int) -> None:
        self._state.switch(switches, self._clock.now_ns())

    def show(self, picture: Program, line: int) -> None:
        """Put a picture under the hand; see `Engine`."""
        self._state.want(picture, line)

    def take_events(self) -> Sequence[Event]:
        """Take the events since the last call."""
        return [*self.device.take_events(), *self._state.take_events()]

    def set_zero(self) -> None:
        """Say that the carriage is at the left stop now."""
        self.device.set_zero()

    def poll(self) -> NDArray[np.void]:
        """Do some ticks; return their records, `vbraille.engine.record.tick_dtype`[n]."""
        first = self.tally.ticks
        due_ns = (first + np.arange(self._poll_ticks)) * self._period_ns
        self._clock.sleep_until_ns(int(due_ns[0]))
        self.device.obey()
        due_ns = due_ns[: self.device.until_done(due_ns)]
        poses = np.zeros((due_ns.size, 4))
        poses[:, POSED] = 1.0
        poses[:, POSE_X : POSE_THETA + 1] = self.device.poses_at(due_ns).T
        self._clock.sleep_until_ns(int(due_ns[-1]))
        self.device.read()  # this tells the caller that steers the hand that it has ended
        # Views of a single record would be contiguous, for which ticks would be compiled again: so
        # there is room for one more.
        room = np.zeros(due_ns.size + 1, self._dtype)
        ticks = room[:-1]
        times_ns = np.repeat(due_ns[:, None], 2, axis=1)
        device = self.device
        self._state.advance(times_ns, poses, device.rested, device.taking, columns_of(room))
        device.write(self._state.output)
        self.newest = ticks[-1]
        self.tally = Tally.of(ticks[-1])
        return ticks

    def start(self) -> None:
        """Do nothing: ticks are done by `poll` alone."""

    def close(self) -> None:
        """Do nothing: the device's opener closes it."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        """Do nothing, as `close` does."""
