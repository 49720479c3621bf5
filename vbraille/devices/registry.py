"""Device specs, ``KIND:ADDRESS``, to devices.

A kind is an entry point in the group ``vbraille.devices``: a function that takes
the address and the `DeviceInfo` that the page was laid out for, and gives an
opened `vbraille.devices.Device`. Packages of other builders join the same way.
"""

from __future__ import annotations

from importlib.metadata import entry_points
from typing import TYPE_CHECKING

from vbraille.errors import InputError

if TYPE_CHECKING:
    from vbraille.devices.base import Device, DeviceInfo

GROUP = "vbraille.devices"


def open_device(spec: str, wanted: DeviceInfo) -> Device:
    """Open the device of a spec.

    Parameters
    ----------
    spec
        ``sim`` or ``KIND:ADDRESS``.
    wanted
        The actuators and the travel that the page was laid out for.

    Raises
    ------
    InputError
        If there is no such kind, or the device has other actuators.
    DeviceError
        If it cannot be opened.
    """
    kind, _, address = spec.partition(":")
    found = entry_points(group=GROUP, name=kind) if kind else ()
    if not found:
        kinds = ", ".join(sorted(entry_points(group=GROUP).names))
        raise InputError(f"there is no device kind {kind!r}; there is {kinds}")
    device = next(iter(found)).load()(address, wanted)
    info = device.info
    if (info.rows, info.columns) != (wanted.rows, wanted.columns):
        device.close()
        raise InputError(
            f"{info.name} has {info.rows} × {info.columns} actuators and the page is for "
            f"{wanted.rows} × {wanted.columns}; choose another --model or --device"
        )
    return device
