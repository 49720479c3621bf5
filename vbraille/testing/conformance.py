"""What every device must do, as checks that any driver's tests can run.

    from vbraille.testing import CHECKS

    @pytest.mark.parametrize("check", CHECKS)
    def test_my_device(check):
        check(lambda: MyDevice("an address"))

A check is given a function that opens a fresh device, and raises AssertionError.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from vbraille.devices.interface import misfits, wrong_values
from vbraille.display import Display
from vbraille.errors import DeviceError
from vbraille.pose import Pose

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from vbraille.devices.base import Device

    Open = Callable[[], Device]


def check_info(open_device: Open) -> None:
    """The device says what it is, and says the same again."""
    with open_device() as device:
        assert isinstance(device.display, Display), "display must be a Display"
        assert device.display == device.display, "display must stay the same"
        assert device.display.name.strip(), "a device has a name"


def check_members(open_device: Open) -> None:
    """Methods can be called as they will be, what is to be a value is one, and gives its kind."""
    with open_device() as device:
        for misfit in misfits(device):
            raise AssertionError(misfit)
        for wrong in wrong_values(device):
            raise AssertionError(wrong)


def check_samples(open_device: Open) -> None:
    """Samples have finite places within the travel, and times that never go back."""
    with open_device() as device:
        info, last_ns = device.display, None
        for _ in range(100):
            sample = device.read()
            if sample is None:
                continue
            assert isinstance(sample, Pose), "read gives a Pose or None"
            assert all(map(math.isfinite, sample[1:])), "a place is a number"
            slack = 1 / info.counts_per_mm
            way_mm = sample.x_mm + info.span_mm / 2
            assert -slack <= way_mm, "at the left stop the array's centre is at -span_mm / 2"
            assert way_mm <= info.travel_mm + slack, "the travel ends"
            assert last_ns is None or sample.time_ns >= last_ns, "time never goes back"
            last_ns = sample.time_ns


def check_frames(open_device: Open) -> None:
    """Frames from rest to full swing are taken, and left as they were."""
    with open_device() as device:
        for share in (0.0, 0.25, 1.0):
            frame = _frame(device, share)
            device.write(frame)
            assert (frame == share).all(), "a frame belongs to the caller"


def check_bad_frames(open_device: Open) -> None:
    """A frame that is out of range, no number or of another shape is refused."""
    with open_device() as device:
        for bad in (-0.001, 1.001, math.nan, math.inf, -math.inf):
            frame = _frame(device, 0.5)
            frame[-1, -1] = bad
            _refused(device, frame, f"a deflection of {bad}")
        _refused(
            device, np.zeros((device.display.rows + 1, device.display.columns)), "another shape"
        )
        device.write(_frame(device, 0.5))


def check_close(open_device: Open) -> None:
    """Closing twice is closing once; nothing is written after it."""
    device = open_device()
    device.write(_frame(device, 1.0))
    device.close()
    device.close()
    _refused(device, _frame(device, 0.0), "a frame after close")


CHECKS = (
    check_members,
    check_info,
    check_samples,
    check_frames,
    check_bad_frames,
    check_close,
)


def _frame(device: Device, share: float) -> NDArray[np.float64]:
    return np.full((device.display.rows, device.display.columns), share)


def _refused(device: Device, frame: NDArray[np.float64], what: str) -> None:
    try:
        device.write(frame)
    except DeviceError:
        return
    raise AssertionError(f"{what} must be refused with a DeviceError")
