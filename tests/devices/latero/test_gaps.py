"""A hand that goes on while the host, or the network, is held up: no blade jumps."""

import math

import numpy as np
import pytest

from tests.devices.latero.talking import MS, Talk
from tests.wired import CATCH_UP, DOT_MM, waves
from vbraille.devices.base import Device
from vbraille.devices.latero.device import AHEAD_NS, DISPLAY
from vbraille.devices.latero.wire import REST
from vbraille.engine.clock import ManualClock
from vbraille.engine.constants import FADE_S
from vbraille.engine.loop import Loop
from vbraille.simulation.laterosim import LateroFaults

SPEED_MM_S = 250.0
# What hand and fade ask for in a millisecond, in levels; both ends are rounded.
ASKED = (SPEED_MM_S * math.pi / DOT_MM + 1 / FADE_S) / 1000 * REST
ALLOWED = CATCH_UP * ASKED + 1
# Where datagrams are lost at random, one that says what blades did is not known from one before it.
ALLOWED_AT_RANDOM = (CATCH_UP + 1) * ASKED + 1


class OnLatero(Device):
    """A Latero in memory, without its watchdog."""

    acknowledges = True
    ahead_ns = AHEAD_NS

    def __init__(self, clock, **options):
        self.talk = Talk(speed_mm_s=SPEED_MM_S, **options)
        self._clock = clock

    @property
    def display(self):
        return DISPLAY

    def _turn(self):
        self.talk.now_ns = self._clock.now_ns()
        return self.talk.now_ns

    def ask(self):
        self.talk.conversation.ask(self._turn())
        self.talk.exchange()

    def read(self):
        self._turn()
        pose = self.talk.take()
        self.rested, self.taking = self.talk.conversation.rested, self.talk.conversation.taking
        return pose

    def _send(self, frame):
        self.talk.conversation.show(frame, self._turn())
        self.talk.exchange()

    def _release(self):
        pass


def read(gap, **faults):
    """Read for 0.6 s with a gap every 0.1 s; levels of the blades after each millisecond."""
    clock = ManualClock()
    clock.advance_ns(MS)
    device = OnLatero(clock, faults=LateroFaults(**faults))
    loop = Loop(device, clock)
    loop.show(waves(1.0).render(np.full(30, 0b001001, np.uint8), DISPLAY))
    levels, lengths = [], iter((11, 23, 37, 3, 30))
    for tick in range(700):
        if gap and tick >= 200 and tick % 100 == 0:
            length = next(lengths)
            device.talk.cut = gap == "cut"
            for _ in range(length):
                if gap == "stopped":
                    clock.advance_ns(MS)
                else:
                    loop.tick()
                levels.append(device.talk.board.levels.astype(int))
            device.talk.cut = False
        loop.tick()
        levels.append(device.talk.board.levels.astype(int))
    return np.array(levels)


@pytest.mark.parametrize(
    ("gap", "faults"),
    [
        ("", {}),
        ("stopped", {}),
        ("cut", {}),
        ("stopped", {"drop": 0.3, "double": 0.2}),
        ("", {"drop": 0.4}),
        ("", {"late": 0.7}),
    ],
)
def test_a_hand_that_goes_on_in_a_gap_is_caught_up_with(gap, faults):
    levels = read(gap, **faults)
    allowed = ALLOWED_AT_RANDOM if "drop" in faults else ALLOWED
    assert np.abs(np.diff(levels, axis=0)).max() <= allowed
    assert np.ptp(levels, axis=0).max() > 100
