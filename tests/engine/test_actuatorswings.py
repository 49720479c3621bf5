"""One actuator swings at a time, and nothing jumps, whatever is asked for in between."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tiers import examples
from vbraille.devices.calibration import Calibration, Tried
from vbraille.display import Display
from vbraille.engine.checkup import SWING_S, SWINGS, ActuatorSwings
from vbraille.engine.clock import ManualClock
from vbraille.simulation.simulated import SimulatedDevice

SMALL = Display("bench", 2, 2, 1.2, 1.4, levels=10_001, rate_hz=100.0)
# sin² rises by π a period at most; a fade goes as far in a tenth of a second.
STEEPEST = np.pi / (SWING_S * 100)
FADE = 1 / (0.1 * 100)


class Kept(SimulatedDevice):
    """A device that keeps all that it is sent."""

    def __init__(self, clock):
        super().__init__(SMALL, clock.now_ns)
        self.sent = []

    def _send(self, frame):
        super()._send(frame)
        self.sent.append(self.levels / (SMALL.levels - 1))


def swinging(begun=lambda _: None):
    clock = ManualClock()
    device = Kept(clock)
    return ActuatorSwings(device, clock, begun), device


def run(swung, ticks):
    for _ in range(ticks):
        swung.tick()


def test_an_actuator_swings_some_times_and_rests():
    begun = []
    swung, device = swinging(begun.append)
    swung.swing((0, 1))
    run(swung, 1 + round(SWING_S * 100) * SWINGS + 2)
    frames = np.array(device.sent)
    assert swung.resting
    assert begun == [(0, 1)]
    assert frames[:, 0, 1].max() == 1
    assert not frames[-1].any()
    frames[:, 0, 1] = 0
    assert not frames.any()
    tops = np.array(device.sent)[:, 0, 1] == 1
    assert tops.sum() == SWINGS


@examples(60)
@given(
    st.lists(
        st.tuples(
            st.lists(st.tuples(st.integers(0, 1), st.integers(0, 1)), max_size=3),
            st.integers(0, 150),
        ),
        min_size=1,
        max_size=5,
    )
)
def test_only_one_is_off_its_rest_and_none_jumps(orders):
    swung, device = swinging()
    for places, ticks in orders:
        swung.swing(*places)
        run(swung, ticks)
    swung.rest()
    swung.tick()
    frames = np.array(device.sent)
    assert not frames[-1].any()
    assert (np.count_nonzero(frames, axis=(1, 2)) <= 1).all()
    steps = np.abs(np.diff(frames, axis=0, prepend=0))
    assert steps.max() <= max(STEEPEST, FADE) + 1e-3


def test_a_device_that_has_rested_by_itself_is_begun_with_anew():
    swung, device = swinging()
    swung.swing((1, 0))
    run(swung, 40)
    assert device.sent[-1][1, 0] > 0.5
    device.rested += 1
    run(swung, 2)
    assert device.sent[-1][1, 0] < 0.01


def test_inverted_ones_go_back_to_where_the_device_rests():
    swung, device = swinging()
    device.correct(Calibration("bench", 2, 2, (Tried(0, 0, inverted=True),)))
    run(swung, 20)
    assert device.sent[-1].tolist() == [[1, 0], [0, 0]]
    swung.rest()
    assert not device.sent[-1].any()
    steps = np.abs(np.diff(np.array(device.sent), axis=0))
    assert steps.max() == pytest.approx(FADE, abs=1e-3)
