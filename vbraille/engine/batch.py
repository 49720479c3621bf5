"""The loop's ticks, done many at a time for simulated hands, as fast as the machine can.

`BatchEngine` does what `LocalEngine` does on a clock that is turned by hand, by the same compiled
function. None of its ticks is late, and none lacks a pose.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vbraille.engine.clock import ManualClock
from vbraille.engine.loop import LocalEngine
from vbraille.engine.ticks import POSE_X, POSED
from vbraille.errors import InputError
from vbraille.simulation.simulated import SimulatedDevice
from vbraille.wording import setting

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.devices import Device


class BatchEngine(LocalEngine):
    """A `LocalEngine` that does all ticks of a poll at once.

    Parameters
    ----------
    device
        An open device, which its opener closes. From now on it goes by the engine's clock, and is
        sent the last frame of each poll only.
    rate_hz
        Ticks a second.
    poll_ticks
        How many ticks each poll does. A poll in which the hand comes to its end stops with that
        tick, so that nothing is recorded of a hand that is done.

    Raises
    ------
    InputError
        If the device has no hand that can be told to read a line.
    ValueError
        If the rate is not 1 to 10,000 Hz.
    """

    device: SimulatedDevice

    def __init__(self, device: Device, rate_hz: float = 1000.0, poll_ticks: int = 1000) -> None:
        hand = device.hand if isinstance(device, SimulatedDevice) else None
        if not isinstance(device, SimulatedDevice) or hand is None or hand.goes_on:
            raise InputError(
                f"{setting('fast')} needs a hand that reads lines: slow, fluent or sweep:SPEED"
            )
        clock = ManualClock()
        device.go_by(clock.now_ns)
        super().__init__(device, clock, rate_hz=rate_hz, poll_ticks=poll_ticks)

    def poll(self) -> NDArray[np.void]:
        """Do some ticks; return their records, `vbraille.engine.record.tick_dtype`[n]."""
        device, ring = self.device, self.ring
        due_ns = (int(self.now["tick"]) + np.arange(self.poll_ticks)) * self._period_ns
        self.clock.sleep_until_ns(int(due_ns[0]))
        due_ns = due_ns[: device.until_done(due_ns)]
        poses = np.zeros((due_ns.size, 4))
        poses[:, POSED] = 1.0
        for column, values in enumerate(device.poses_at(due_ns), POSE_X):
            poses[:, column] = values
        self.clock.sleep_until_ns(int(due_ns[-1]))
        times_ns = np.repeat(due_ns[:, None], 2, axis=1)
        self.advance(times_ns, poses)
        device.write(self.output)
        ring.publish(due_ns.size)
        return self._take()
