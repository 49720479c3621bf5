"""An engine in this process: its loop goes on while it is polled."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from vbraille.engine.loop import Loop
from vbraille.engine.ring import Ring

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.devices import Device
    from vbraille.devices.events import Event
    from vbraille.display import Display
    from vbraille.engine.clock import Clock
    from vbraille.engine.record import Tally
    from vbraille.render.program import Program


class LocalEngine:
    """An engine in this process, for a device that a program has, tests and clocks turned by hand.

    Parameters
    ----------
    device
        An open device, which is left to whoever opened it to close.
    clock
        The clock by which ticks are due.
    rate_hz
        Ticks a second.
    poll_ticks
        How many ticks each poll does.
    """

    def __init__(
        self, device: Device, clock: Clock, *, rate_hz: float = 1000.0, poll_ticks: int = 1
    ) -> None:
        ring = Ring.alone(device.display.shape, poll_ticks + 1)
        self._reader = ring.reader()
        self.loop = Loop(device, clock, rate_hz=rate_hz, ring=ring)
        self._poll_ticks = poll_ticks

    @property
    def display(self) -> Display:
        """The actuators and the carriage of the device."""
        return self.loop.device.display

    @property
    def tally(self) -> Tally:
        """Counts of what the loop has done."""
        return self.loop.tally

    @property
    def x_mm(self) -> float | None:
        """Where the array's centre is along x; None before it is known."""
        return self.loop.x_mm

    @property
    def paused(self) -> bool:
        """Whether the array rests."""
        return self.loop.paused

    @paused.setter
    def paused(self, paused: bool) -> None:
        self.loop.paused = paused

    def show(self, picture: Program, line: int) -> None:
        """Put a picture of a line under the hand; see `Engine`."""
        self.loop.show(picture, line)

    def poll(self) -> NDArray[np.void]:
        """Do some ticks; return their records."""
        for _ in range(self._poll_ticks):
            self.loop.tick()
        self.loop.ring.publish()
        return self._reader.drain()

    def take_events(self) -> Sequence[Event]:
        """Take the events since the last call."""
        return self.loop.take_events()

    def set_zero(self) -> None:
        """Say that the carriage is at the left stop now."""
        self.loop.device.set_zero()

    @property
    def calibration(self) -> dict[str, Any] | None:
        """What is made up for in the device's actuators, as `Calibration.to_json` says it."""
        found = self.loop.device.calibration
        return None if found is None else found.to_json()

    @property
    def counts(self) -> Mapping[str, int]:
        """What went wrong with the device, by name."""
        return self.loop.device.counts()

    def start(self) -> None:
        """Begin with the next poll: what has gone by until now is not late."""
        self.loop.restart_clock()

    def close(self) -> None:
        """Have the array fade to rest; whoever opened the device closes it."""
        self.loop.fade_to_rest()
