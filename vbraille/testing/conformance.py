"""Checks of what every device must do, which any driver's tests can run.

    from vbraille.testing import CHECKS

    @pytest.mark.parametrize("check", CHECKS)
    def test_my_device(check):
        check(lambda: MyDevice("an address"))

A check is given a function that opens a fresh device, and raises AssertionError.
"""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence
from itertools import pairwise
from types import NoneType
from typing import TYPE_CHECKING

import numpy as np

from vbraille.devices.base import Device, Particulars
from vbraille.devices.events import Placing, is_known
from vbraille.display import Display
from vbraille.engine.checkup import NS_PER_S, Watch, finishes_parts
from vbraille.engine.clock import RealClock
from vbraille.engine.engine import HOME_MM
from vbraille.errors import DeviceError, InputError

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from vbraille.engine.clock import Clock

    Open = Callable[[], Device]

# How far a carriage goes before it has turned, and how long it is asked where it is.
_AWAY_MM = 20.0
_LOOKING_S = 1.0
_VALUES: dict[str, tuple[type, ...]] = {
    "rested": (int,),
    "placing": (Placing,),
    "taking": (bool,),
    "acknowledges": (bool,),
    "acknowledged_ns": (int, NoneType),
    "watchdog_trips": (int, NoneType),
    "tripped_ms": (float, NoneType),
    "descriptor": (int, NoneType),
    "particulars": (Particulars, NoneType),
}


def check_members(open_device: Open) -> None:
    """Tell what is to be a value is one, of its kind; a method there would always count as true."""
    with _opened(open_device) as device:
        assert isinstance(device.display, Display), "display must be a Display"
        assert device.display == device.display, "display must stay the same"
        assert device.display.name, "a device has a name"
        for name in ("read", "write", "set_zero", "take_events", "counts"):
            assert callable(getattr(device, name)), f"{name} must be a method"
        for name, kinds in _VALUES.items():
            value = getattr(device, name)
            right = isinstance(value, kinds) and (bool in kinds or not isinstance(value, bool))
            wanted = " or ".join(kind.__name__ for kind in kinds)
            assert right, f"{name} must be {wanted}, and is {value!r}"
        events = device.take_events()
        assert isinstance(events, Sequence), f"take_events must give a list, and gives {events!r}"
        for event in events:
            assert is_known(event), f"{event!r} is no event of vbraille.devices.events"
        counts = device.counts()
        assert isinstance(counts, Mapping), f"counts must give a dict, and gives {counts!r}"
        for name, count in counts.items():
            assert isinstance(name, str), f"counts must give numbers by name, and gives {name!r}"
            assert isinstance(count, int), f"counts must give whole numbers, and gives {count!r}"


def check_samples(open_device: Open, clock: Clock | None = None) -> None:
    """For a second at its rate, `read` and `write` wait for nothing, and samples can be true.

    Their places are finite, within the travel and no jump away from one another, their times never
    go back, and an angle is only told where the display turns. Give a clock that stands still
    while a simulated controller works within the driver's calls.
    """
    clock = clock or RealClock()
    with _opened(open_device) as device:
        info, frame = device.display, _frame(device, 0.0)
        # The first calls may load what is compiled.
        device.read()
        device.write(frame)
        watch = Watch(device, clock)
        slack = 1 / info.counts_per_mm
        begun_ns = due_ns = clock.now_ns()
        while due_ns < begun_ns + _LOOKING_S * NS_PER_S:
            sample = watch.read()
            watch.write(frame)
            if sample is not None:
                way_mm = sample.x_mm + info.span_mm / 2
                assert -slack <= way_mm, "at the left stop the array's centre is at -span_mm / 2"
                assert way_mm <= info.travel_mm + slack, "the travel ends"
            due_ns = max(due_ns + round(NS_PER_S / info.rate_hz), clock.now_ns())
            clock.sleep_until_ns(due_ns)
        faults = watch.faults()
        assert not faults, "; ".join(faults)


def check_left_stop(open_device: Open) -> None:
    """A carriage that turns again and again at its left stop says -span_mm / 2 there.

    It can be told of one that moves by itself, and within a second; any other one is passed.
    """
    with _opened(open_device) as device:
        half_mm = device.display.span_mm / 2
        left_mm = _turning_place(device)
    assert left_mm is None or left_mm <= HOME_MM - half_mm, (
        f"no line would ever be done: the carriage turns at x = {left_mm:.2f} mm, and at its left "
        f"stop, where the whole array stands before the line, x is -span_mm / 2 = {-half_mm:.2f} mm"
    )


def check_frames(open_device: Open) -> None:
    """Frames from rest to full swing are taken, and left as they were."""
    with _opened(open_device) as device:
        for share in (0.0, 0.25, 1.0):
            frame = _frame(device, share)
            device.write(frame)
            assert (frame == share).all(), "a frame belongs to the caller"


def check_bad_frames(open_device: Open) -> None:
    """A frame that is out of range, no number or of another shape is refused."""
    with _opened(open_device) as device:
        for bad in (-0.001, 1.001, math.nan, math.inf, -math.inf):
            frame = _frame(device, 0.5)
            frame[-1, -1] = bad
            _refused(device, frame, f"a deflection of {bad}")
        _refused(device, np.append(frame, frame, 0), "another shape")
        device.write(_frame(device, 0.5))


def check_parts(open_device: Open) -> None:
    """A message of which the line took a part is finished before another is begun."""
    with _opened(open_device) as device:
        faults = finishes_parts(device)
    assert not faults, faults[0]


def check_close(open_device: Open) -> None:
    """Closing twice is closing once; nothing is written after it."""
    device = _opened(open_device)
    device.write(_frame(device, 1.0))
    device.close()
    device.close()
    _refused(device, _frame(device, 0.0), "a frame after close")


CHECKS = (
    check_members,
    check_samples,
    check_left_stop,
    check_frames,
    check_bad_frames,
    check_parts,
    check_close,
)


def _opened(open_device: Open) -> Device:
    """A device that is opened anew; InputError if what is given opens none."""
    if not callable(open_device):
        name = type(open_device).__name__
        raise InputError(
            f"a check opens the device by itself; give it what opens one, such as the class "
            f"{name}, and not what is open already"
        )
    return open_device()


def _frame(device: Device, share: float) -> NDArray[np.float64]:
    return np.full(device.display.shape, share)


def _turning_place(device: Device) -> float | None:
    """Place where the carriage turned twice, and never was left of it; None if it did not."""
    until_s, x_mm = time.monotonic() + _LOOKING_S, []
    while time.monotonic() < until_s:
        if (sample := device.read()) is not None:
            x_mm.append(sample.x_mm)
    least_mm = min(x_mm, default=0.0)
    ends = [x > least_mm + HOME_MM for x in x_mm if not HOME_MM < x - least_mm <= _AWAY_MM]
    return least_mm if sum(after > before for before, after in pairwise(ends)) > 1 else None


def _refused(device: Device, frame: NDArray[np.float64], what: str) -> None:
    try:
        device.write(frame)
    except DeviceError:
        return
    raise AssertionError(f"{what} must be refused with a DeviceError")
