"""A device of two axes under a hand that a test holds: where it is, a test says."""

import math
from dataclasses import replace

from tests.engine.planar import Planar
from vbraille.engine.clock import ManualClock
from vbraille.reading.device import OpenDevice
from vbraille.render import model_of

RATE_HZ = 100.0


class Plane(Planar):
    """A carriage of two axes whose place a test says, with buttons."""

    pressed = ()

    def take_events(self):
        events, self.pressed = self.pressed, ()
        return events


class Held:
    """An open device on which so many lines of a page have room, and the foot below them."""

    def __init__(self, model, rows, say, *, attended=True):
        self.x_mm = self.y_mm = self.theta = 0.0
        clock = ManualClock()
        height_mm = (rows + 0.5) * model.style.geometry.line_pitch_mm if rows else 0.0
        self.own = model_of(replace(model.display, height_mm=height_mm, rate_hz=RATE_HZ))
        display = self.own.display
        self.device = Plane(clock, lambda _: (self.x_mm, self.y_mm, self.theta), display)
        self.opened = OpenDevice(self.device, display, clock=clock, say=say, attended=attended)

    @property
    def reader(self):
        return self.opened.reader

    @property
    def surface(self):
        return self.reader.under.surface

    def run(self, seconds):
        for _ in range(max(1, math.ceil(seconds * RATE_HZ / 2))):
            self.opened.poll()
