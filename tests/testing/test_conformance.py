"""The conformance suite, run on the devices there are, and on broken ones it must catch."""

import gc
import math

import numpy as np
import pytest

from tests.baddrivers import BAD, Good
from tests.engine.test_loop import info
from vbraille.devices import Device, open_device
from vbraille.display import Pose
from vbraille.errors import InputError
from vbraille.simulation.simulated import SimulatedDevice
from vbraille.testing.conformance import (
    CHECKS,
    check_bad_frames,
    check_close,
    check_frames,
    check_left_stop,
    check_members,
    check_samples,
)


@pytest.mark.real_time
@pytest.mark.parametrize("check", CHECKS)
@pytest.mark.parametrize("opened", [Good, lambda: open_device("sim:", info())])
def test_the_simulated_device_conforms(opened, check):
    check(opened)


class Unchecked(SimulatedDevice):
    def write(self, frame):
        self._send(frame)


class Scribbling(SimulatedDevice):
    def _send(self, frame):
        super()._send(frame)
        frame.fill(0)


class OffTheRail(SimulatedDevice):
    def read(self):
        return Pose(0, 1e9)


class Nowhere(SimulatedDevice):
    def read(self):
        return Pose(0, math.nan)


class Backwards(SimulatedDevice):
    time_ns = 100

    def read(self):
        self.time_ns -= 1
        return Pose(self.time_ns, 0.0)


class Pacing(SimulatedDevice):
    """A motor moves its carriage to and fro, a millimetre a sample."""

    left_mm = None

    def read(self):
        self.samples = getattr(self, "samples", 0) + 1
        way_mm = abs((self.samples + 100) % 200 - 100.0)
        left_mm = -self.display.span_mm / 2 if self.left_mm is None else self.left_mm
        return Pose(self.samples, left_mm + way_mm)


class ZeroAtTheLeftStop(Pacing):
    left_mm = 0.0


class CountsInAProperty(SimulatedDevice):
    counts = property(lambda self: {"frames": self.frames})


class TakingByAMethod(SimulatedDevice):
    def taking(self):
        return False


class OneNote(SimulatedDevice):
    def take_events(self):
        return ["too hot"]


class CountsInHalves(SimulatedDevice):
    def counts(self):
        return {"frames": 0.5}


class PlacedByANumber(SimulatedDevice):
    placing = 0


class RestedOrNot(SimulatedDevice):
    rested = False


@pytest.mark.parametrize(
    ("broken", "check"),
    [
        (CountsInAProperty, check_members),
        (TakingByAMethod, check_members),
        (OneNote, check_members),
        (CountsInHalves, check_members),
        (PlacedByANumber, check_members),
        (RestedOrNot, check_members),
        (Unchecked, check_bad_frames),
        (Unchecked, check_close),
        (Scribbling, check_frames),
        (OffTheRail, check_samples),
        (Nowhere, check_samples),
        (Backwards, check_samples),
        (ZeroAtTheLeftStop, check_left_stop),
    ],
)
def test_broken_devices_are_caught(broken, check):
    with pytest.raises(AssertionError):
        check(lambda: broken(info()))


@pytest.mark.parametrize(
    ("driver", "said"), BAD.items(), ids=lambda each: getattr(each, "__name__", "")
)
def test_a_bad_driver_fails_by_the_name_of_its_fault(driver, said):
    failed = []
    for check in (check_samples, check_close):
        try:
            check(driver)
        except (AssertionError, OSError) as fault:
            failed.append(str(fault))
    assert failed
    assert all(said in fault for fault in failed), failed


def test_no_driver_is_blamed_for_the_garbage_of_others():
    """In the engine's process none is looked for, which may take a tenth of a second."""
    seen = []

    class Looking(Good):
        def read(self):
            seen.append(gc.isenabled())
            return super().read()

    assert gc.isenabled()
    check_samples(Looking)
    assert not any(seen[1:])  # the first is not watched
    assert gc.isenabled()


def test_a_carriage_that_paces_from_its_left_stop_is_right():
    check_left_stop(lambda: Pacing(info()))


@pytest.mark.parametrize("check", CHECKS)
def test_a_device_that_is_open_already_is_no_way_to_open_one(check):
    with pytest.raises(InputError, match="such as the class SimulatedDevice, and not what is open"):
        check(SimulatedDevice(info()))


class Logging(Device):
    """A driver of a few lines; what it inherits does the rest."""

    def __init__(self):
        self.log = []

    @property
    def display(self):
        return info()

    def read(self):
        return None

    def _send(self, frame):
        self.log.append(frame.max())

    def _release(self):
        self.log.append("released")


@pytest.mark.parametrize("check", CHECKS)
def test_a_small_driver_conforms(check):
    check(Logging)


def test_close_rests_first_and_releases_even_if_resting_fails():
    device = Logging()
    with device:
        device.write(np.full((6, 10), 0.5))
    assert device.log == [0.5, 0.0, "released"]

    class Gone(Logging):
        def _send(self, frame):
            raise OSError(f"gone, with {frame.max()}")

    gone = Gone()
    with pytest.raises(OSError, match="gone"):
        gone.close()
    assert gone.log == ["released"]
