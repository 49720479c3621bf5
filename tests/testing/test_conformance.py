"""The conformance suite: vbraille's own devices pass it, and each fault of a driver fails it."""

import numpy as np
import pytest

from vbraille.devices.base import Device
from vbraille.devices.events import Placing
from vbraille.display import Display, Pose
from vbraille.render import MODELS
from vbraille.testing import CHECKS, simulated_device

SMALL = Display("small", 1, 2, 1.0, 1.0, levels=256, travel_mm=100.0, rate_hz=200.0)


@pytest.mark.parametrize("check", CHECKS, ids=lambda check: check.__name__)
def test_a_simulated_device_passes(check):
    # Where a busy machine holds the simulation up, a slow hand has not gone far meanwhile.
    hand = "sweep:190" if check.__name__ == "check_left_stop" else "sweep:20"
    check(lambda: simulated_device(MODELS["vbd"], hand=hand))


class Good(Device):
    display = SMALL

    def read(self):
        return None

    def _send(self, _frame):
        return None

    def _release(self):
        pass


class NoPlace(Good):
    def read(self):
        return Pose(1, float("nan"))


class NeverPlaced(Good):
    placing = Placing.STOP

    def read(self):
        return Pose(1, 0.0)


class BeyondTravel(Good):
    def read(self):
        return Pose(1, 200.0)


class Changes(Good):
    def _send(self, frame):
        frame[:] = 1.0


class TakesAll(Good):
    def write(self, _frame):
        return True


class MethodForValue(Good):
    def taking(self):
        return True


class OwnEvents(Good):
    def take_events(self):
        return ["unplugged"]


@pytest.mark.parametrize(
    "driver",
    [NoPlace, NeverPlaced, BeyondTravel, Changes, TakesAll, MethodForValue, OwnEvents],
)
def test_a_fault_of_a_driver_is_found(driver):
    failed = 0
    for check in CHECKS:
        try:
            check(driver)
        except AssertionError:
            failed += 1
    assert failed > 0


def test_a_driver_without_a_fault_passes():
    for check in CHECKS:
        check(Good)
    assert np.isfinite(SMALL.span_mm)
