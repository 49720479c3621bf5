"""The device that a page is laid out for, and the page for the device that is there."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING
from urllib.parse import urlencode

from vbraille.caching import is_compiled
from vbraille.errors import InputError
from vbraille.simulation.steering import Steering

if TYPE_CHECKING:
    from vbraille.display import Display

TRAVEL_TOLERANCE_MM = 0.01


def check_travel(display: Display, travel_mm: float) -> None:
    """Raise InputError if a page needs more travel than a device's carriage has."""
    # Counts and micrometres are rounded on their way here.
    if travel_mm > display.travel_mm + TRAVEL_TOLERANCE_MM:
        raise InputError(
            f"the carriage of {display.name} goes {display.travel_mm:g} mm and --travel asks for "
            f"{travel_mm:g} mm; leave --travel out, or give {display.travel_mm:g} or less"
        )


def is_simulated(device: str) -> bool:
    """Whether a device is the simulated one, which is as the options say."""
    return device.rstrip(":") == "sim"


def check_rate(rate_hz: float) -> float:
    """Frames a second, if possible.

    Raises
    ------
    InputError
        If it is not 1 to 10,000.
    """
    if not 1 <= rate_hz <= 10_000:
        raise InputError(f"rate is {rate_hz:g} Hz; it must be 1 to 10000 Hz")
    return rate_hz


def refuse_hand(device: str, **given: object) -> None:
    """Raise InputError if options of the simulated hand are given for another device.

    Parameters
    ----------
    device
        The spec of the device.
    given
        Values of the options by their names; None where they were not given.
    """
    for option, value in given.items():
        if value is not None and not is_simulated(device):
            raise InputError(
                f"--{option} is for the simulated device, and {device} is moved by a person; "
                f"leave --{option} out, or leave --device out"
            )


def steering_of(device: str) -> Steering | None:
    """What steers the hand of a simulated device; None for a device that a person moves."""
    return Steering() if is_simulated(device) or device.startswith("sim:?") else None


def device_spec(device: str, hand: str, seed: int, steering: Steering | None) -> str:
    """Spec of a device; the simulated one is told its hand, and what steers it."""
    if steering is None:
        return device
    if is_simulated(device):
        device = f"sim:?{urlencode({'hand': hand, 'seed': seed})}"
    return f"{device}&steering={steering.descriptor}"


def say_if_compiling() -> None:
    """Say on stderr that a first reading is prepared, where it is: it takes a while."""
    if not is_compiled():
        print(
            "compiling: what drives the actuators, once, in up to a minute; then it begins",
            file=sys.stderr,
            flush=True,
        )
