"""Device specs, ``KIND:ADDRESS``, to devices.

A kind is an entry point in the group ``vbraille.devices``: a function that takes
the address and the `DeviceInfo` that the page was laid out for, or None, and gives an
opened `vbraille.devices.Device`. Packages of other builders join the same way.
"""

from __future__ import annotations

from importlib.metadata import entry_points
from typing import TYPE_CHECKING

from vbraille.errors import InputError

if TYPE_CHECKING:
    from vbraille.devices.base import Device, DeviceInfo

GROUP = "vbraille.devices"
# By how much a device's pitch may differ from the page's.
PITCH_TOLERANCE = 0.01


def open_device(spec: str, wanted: DeviceInfo | None, *, fits: bool = True) -> Device:
    """Open the device of a spec.

    Parameters
    ----------
    spec
        ``sim`` or ``KIND:ADDRESS``.
    wanted
        The actuators and the travel that the page was laid out for; None if any will do.
    fits
        Whether the actuators must be those; else they are a wish, and only the rate must be had.

    Raises
    ------
    InputError
        If there is no such kind, or the device has other actuators or is too slow.
    DeviceError
        If it cannot be opened.
    """
    kind, _, address = spec.partition(":")
    found = entry_points(group=GROUP, name=kind) if kind else ()
    if not found:
        kinds = ", ".join(sorted(entry_points(group=GROUP).names))
        raise InputError(f"there is no device kind {kind!r}; there is {kinds}")
    device = next(iter(found)).load()(address, wanted)
    if wanted is not None:
        try:
            if fits:
                check_actuators(device.info, wanted)
            _check_rate(device.info, wanted.rate_hz)
        except InputError:
            device.close()
            raise
    return device


def check_actuators(info: DeviceInfo, wanted: DeviceInfo) -> None:
    """Raise InputError if a device has other actuators than a page is for."""
    if (info.rows, info.columns) != (wanted.rows, wanted.columns):
        raise InputError(
            f"{info.name} has {info.rows} × {info.columns} actuators and the page is for "
            f"{wanted.rows} × {wanted.columns}; choose another --model or --device"
        )
    for what, lines, pitch_mm, wanted_mm in (
        ("columns", info.columns, info.column_pitch_mm, wanted.column_pitch_mm),
        ("rows", info.rows, info.row_pitch_mm, wanted.row_pitch_mm),
    ):
        # One row or column has no pitch.
        if lines > 1 and abs(pitch_mm - wanted_mm) > PITCH_TOLERANCE * wanted_mm:
            raise InputError(
                f"the {what} of {info.name} are {pitch_mm:g} mm apart and the page is for "
                f"{wanted_mm:g} mm; choose another --model or --device"
            )


def _check_rate(info: DeviceInfo, rate_hz: float) -> None:
    """Raise InputError if a device is too slow for the loop."""
    if info.rate_hz < rate_hz:
        raise InputError(
            f"{info.name} is made for {info.rate_hz:g} frames a second and {rate_hz:g} "
            f"are asked for; choose --rate {info.rate_hz:g} or less"
        )
