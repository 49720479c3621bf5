"""The device that a page is laid out for; a simulated one is just so."""

from __future__ import annotations

from typing import TYPE_CHECKING
from urllib.parse import urlencode

from vbraille.devices import DeviceInfo
from vbraille.errors import InputError

if TYPE_CHECKING:
    from vbraille.geometry import Geometry
    from vbraille.render import Model

LEVELS = 1024  # 10 bits, as the source's devices take
COUNTS_PER_MM = 200.0  # 5 µm a count: at full texture 4 % of the swing


def device_info(model: Model, geometry: Geometry, rate_hz: float) -> DeviceInfo:
    """Device that the page is laid out for; a simulated one is just so."""
    array = model.array
    return DeviceInfo(
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


def device_spec(device: str, hand: str, seed: int) -> str:
    """Spec of a device; the simulated one is told its hand."""
    if device.rstrip(":") != "sim":
        return device
    return f"sim:?{urlencode({'hand': hand, 'seed': seed})}"
