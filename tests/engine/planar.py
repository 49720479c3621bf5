"""A device whose carriage goes where a test says, in two dimensions."""

import numpy as np

from vbraille.devices.base import Device
from vbraille.display import Display, Pose
from vbraille.engine.clock import ManualClock
from vbraille.engine.loop import LocalEngine
from vbraille.render import STRESS2

PLANE = Display(
    "plane", rows=8, columns=8, column_pitch_mm=1.2, row_pitch_mm=1.6125,
    height_mm=400.0, turns=True,
)  # fmt: skip
STYLE = STRESS2.style
LINE_MM = STYLE.geometry.line_pitch_mm
MS = 1_000_000


class Planar(Device):
    """A device at x, y and θ of its time in seconds; it keeps what it was sent."""

    def __init__(self, clock, place, display=PLANE):
        self._display, self._clock, self.place = display, clock, place
        self.sent = []

    @property
    def display(self):
        return self._display

    def read(self):
        now_ns = self._clock.now_ns()
        place = self.place(now_ns / 1e9)
        return None if place is None else Pose(now_ns, *place)

    def _send(self, frame):
        self.sent.append(frame.copy())

    def _release(self):
        """Nothing to let go."""


class Bench:
    """An engine on the manual clock, its device, and the records of all ticks so far."""

    def __init__(self, place, display=PLANE, **how):
        self.clock = ManualClock()
        self.device = Planar(self.clock, place, display)
        self.engine = LocalEngine(self.device, self.clock, **how)
        self.blocks = []

    def run(self, seconds):
        """Tick for so long; the records of these ticks."""
        count = round(seconds * self.engine.rate_hz)
        ticks = np.concatenate([self.engine.poll() for _ in range(count)])
        self.blocks.append(ticks)
        return ticks

    @property
    def records(self):
        return np.concatenate(self.blocks)

    @property
    def sent(self):
        return np.array(self.device.sent)


def still(x_mm=3.0, y_mm=0.5 * LINE_MM, theta_rad=0.0):
    """A hand that holds still."""
    return lambda _s: (x_mm, y_mm, theta_rad)
