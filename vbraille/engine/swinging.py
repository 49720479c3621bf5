"""One actuator at a time, swung gently, with all others at rest; nothing ever jumps."""

from __future__ import annotations

import math
from collections import deque
from typing import TYPE_CHECKING, Final

import numpy as np

from vbraille.engine.constants import FADE_S, NS_PER_S

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.devices import Device
    from vbraille.engine.clock import Clock

SWING_S: Final = 1.0  # time of a swing, out and back
SWINGS: Final = 4  # how often an actuator swings before it rests again


class Swinging:
    """Actuators of a device that swing one after the other.

    Whoever has one calls `tick` again and again; each call waits for its time.

    Parameters
    ----------
    device
        Open device, whose correction is that of whoever opened it.
    clock
        Clock by which ticks are due.
    begun
        Function that is told the row and column, from 0, of each actuator as it begins to swing.
    """

    def __init__(
        self,
        device: Device,
        clock: Clock,
        begun: Callable[[tuple[int, int]], None] = lambda _: None,
    ) -> None:
        rate_hz = device.display.rate_hz
        self._device, self._clock, self._say_begun = device, clock, begun
        self._period_ns = round(NS_PER_S / rate_hz)
        self._steps = round(SWING_S * rate_hz)
        self._fade = 1 / max(FADE_S * rate_hz, 1.0)  # of a deflection, a frame
        self._frame = np.zeros(device.display.shape)
        self._next: deque[tuple[int, int]] = deque()
        self._at: tuple[int, int] | None = None
        self._step = 0
        self._ending = False
        self._due_ns = clock.now_ns()
        self._was = device.rested, device.taking

    @property
    def resting(self) -> bool:
        """Whether every actuator is at rest, and none is to swing."""
        return self._at is None and not self._next

    def swing(self, *places: tuple[int, int]) -> None:
        """Have actuators swing one after the other, once the present one has faded to rest."""
        self._next.clear()
        self._next.extend(places)
        self._ending = True

    def stop(self) -> None:
        """Have the actuator that swings fade to rest."""
        self.swing()

    def tick(self) -> None:
        """Wait for the next frame's time, read the device, and send the frame.

        Raises
        ------
        DeviceError
            If the device is gone for good.
        """
        self._due_ns = max(self._due_ns + self._period_ns, self._clock.now_ns() - self._period_ns)
        self._clock.sleep_until_ns(self._due_ns)
        device = self._device
        device.read()
        now = device.rested, device.taking
        if now != self._was:
            # It has gone to rest by itself, or leaves it: begin again from there.
            self._was, self._step = now, 0
            if self._at is not None:
                self._frame[self._at] = 0.0
        self._move()
        device.write(self._frame)

    def rest(self) -> None:
        """Fade to rest, and have inverted actuators go to where the device itself rests.

        Raises
        ------
        DeviceError
            If the device is gone for good.
        """
        self.stop()
        while not self.resting or self._device.uncorrect():
            self.tick()

    def _move(self) -> None:
        """Move the actuator that swings by a step, or go to the next."""
        if self._at is None:
            self._ending = False
            if self._next:
                self._at, self._step = self._next.popleft(), 0
                self._say_begun(self._at)
            return
        if self._ending:
            level = max(self._frame[self._at] - self._fade, 0.0)
        else:
            self._step += 1
            level = math.sin(math.pi * self._step / self._steps) ** 2
            if self._step == self._steps * SWINGS:
                level, self._ending = 0.0, True
        self._frame[self._at] = level
        if self._ending and level == 0.0:
            self._at = None
