"""The device that a page is laid out for, and the page for the device that is there."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING
from urllib.parse import urlencode

from vbraille.devices.registry import check_actuators
from vbraille.display import Display
from vbraille.errors import InputError
from vbraille.render.models import MODELS
from vbraille.simulation.steering import Steering

if TYPE_CHECKING:
    from vbraille.geometry import Geometry
    from vbraille.render.models import Model

LEVELS = 1024  # 10 bits, as the source's devices take
TRAVEL_TOLERANCE_MM = 0.01
COUNTS_PER_MM = 200.0  # 5 µm a count: at full texture 4 % of the swing


def device_info(model: Model, geometry: Geometry, rate_hz: float) -> Display:
    """Device that the page is laid out for; a simulated one is just so."""
    array = model.array
    return Display(
        name=f"simulated {model.title}",
        rows=array.rows,
        columns=array.columns,
        column_pitch_mm=array.column_pitch_mm,
        row_pitch_mm=array.row_pitch_mm,
        levels=LEVELS,
        rest_side=model.rest_side,
        travel_mm=geometry.travel_mm,
        counts_per_mm=COUNTS_PER_MM,
        rate_hz=rate_hz,
    )


def model_of(info: Display, name: str | None) -> Model:
    """The model that a device is, with the device's own pitches.

    Parameters
    ----------
    info
        What the device says of itself.
    name
        Of the model that it must be; None if any will do.

    Raises
    ------
    InputError
        If it is none, or not this one.
    """
    if name is not None:
        check_actuators(info, device_info(MODELS[name], MODELS[name].geometry, info.rate_hz))
    for model in MODELS.values():
        with suppress(InputError):
            check_actuators(info, device_info(model, model.geometry, info.rate_hz))
            array = replace(
                model.array,
                column_pitch_mm=info.column_pitch_mm,
                row_pitch_mm=info.row_pitch_mm,
            )
            return replace(model, array=array)
    known = " and ".join(
        f"{model.array.rows} × {model.array.columns} {model.array.column_pitch_mm:g} mm apart "
        f"({model.title})"
        for model in MODELS.values()
    )
    raise InputError(
        f"{info.name} has {info.rows} × {info.columns} actuators {info.column_pitch_mm:g} mm "
        f"apart, and pages are laid out for {known} only; choose another --device"
    )


def check_travel(info: Display, travel_mm: float) -> None:
    """Raise InputError if a page needs more travel than a device's carriage has."""
    # Counts and micrometres are rounded on their way here.
    if travel_mm > info.travel_mm + TRAVEL_TOLERANCE_MM:
        raise InputError(
            f"the carriage of {info.name} goes {info.travel_mm:g} mm and --travel asks for "
            f"{travel_mm:g} mm; leave --travel out, or give {info.travel_mm:g} or less"
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
