"""Device specs, ``KIND:ADDRESS``, to devices.

A kind is an entry point in the group ``vbraille.devices``: a function that takes
the address and the `Display` that the page was laid out for, or None, and gives an
opened `vbraille.devices.Device`. Packages of other builders join the same way.
"""

from __future__ import annotations

import logging
from contextlib import contextmanager
from importlib.metadata import entry_points
from traceback import walk_tb
from typing import TYPE_CHECKING

from vbraille.devices.base import Device
from vbraille.errors import DeviceError, InputError, VbrailleError
from vbraille.logs import print_traceback
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Iterator
    from importlib.metadata import EntryPoint

    from vbraille.display import Display

GROUP = "vbraille.devices"
# Difference that is allowed between a device's pitch and the page's, as a share.
PITCH_TOLERANCE = 0.01
# Allowance for the rounding of counts and micrometres on their way here.
TRAVEL_TOLERANCE_MM = 0.01

_log = logging.getLogger(__name__)


def open_device(
    spec: str, wanted: Display | None, *, fits: bool = True, often: bool = True
) -> Device:
    """Open the device of a spec.

    Parameters
    ----------
    spec
        ``sim`` or ``KIND:ADDRESS``.
    wanted
        Actuators and travel that the page was laid out for; None if any will do.
    fits
        Whether the device must have those actuators; otherwise they are a wish.
    often
        Whether the device must take frames at this rate; otherwise the rate is a wish, too.

    Raises
    ------
    InputError
        If there is no such kind, or the device has other actuators or is too slow.
    DeviceError
        If the device cannot be opened.
    """
    driver = find_driver(spec)
    with _naming(driver, opening=True):
        device = driver.load()(spec.partition(":")[2], wanted)
        if not isinstance(device, Device):
            raise DeviceError(
                f"the driver {driver.name} ({driver.value}) gives {device!r} where it must give a "
                f"vbraille.devices.Device; tell its author"
            )
        if wanted is not None:
            try:
                if fits:
                    check_actuators(device.display, wanted)
                own_hz = device.display.rate_hz
                if often and own_hz < wanted.rate_hz:
                    raise InputError(
                        f"{device.display.name} is made for {own_hz:g} frames a second and "
                        f"{wanted.rate_hz:g} are asked for; choose {setting('rate')} {own_hz:g} or "
                        f"less"
                    )
            except InputError:
                device.close()
                raise
        _log.info("opened %s: %s", spec, device.display)
        return device


@contextmanager
def opened_device(
    spec: str, wanted: Display | None, *, fits: bool = True, often: bool = True
) -> Iterator[Device]:
    """Open the device of a spec; on leaving, close it.

    An exception of another package's driver in between names the driver.

    Raises
    ------
    InputError, DeviceError
        In the cases of `open_device`; `DeviceError` also for any exception of another package's
        driver.
    """
    with _naming(find_driver(spec)), open_device(spec, wanted, fits=fits, often=often) as device:
        yield device


def drivers() -> list[tuple[str, str]]:
    """Kinds of devices that there are, with the module that opens each."""
    return sorted((each.name, each.module) for each in entry_points(group=GROUP))


def find_driver(spec: str) -> EntryPoint:
    """Find the entry point of a spec's kind, without loading it.

    Raises
    ------
    InputError
        If there is no such kind.
    """
    kind, _, _ = spec.partition(":")
    found = entry_points(group=GROUP, name=kind) if kind else ()
    if not found:
        kinds = ", ".join(sorted(entry_points(group=GROUP).names))
        raise InputError(f"unknown device kind {kind!r}; known: {kinds}")
    return next(iter(found))


@contextmanager
def _naming(driver: EntryPoint, *, opening: bool = False) -> Iterator[None]:
    """Turn what another package's driver raises into a `DeviceError` that names the driver.

    Errors that are sentences pass, and so do those of vbraille's own drivers and an OSError in
    which the driver has no part, such as one of our own output.
    """
    try:
        yield
    except VbrailleError:
        raise
    except (Exception, SystemExit) as error:
        package = driver.module.partition(".")[0]
        frames = (frame for frame, _ in walk_tb(error.__traceback__))
        parts = {str(frame.f_globals.get("__name__")).partition(".")[0] for frame in frames}
        others = isinstance(error, OSError) and not opening and package not in parts
        if package == "vbraille" or others:
            raise
        if opening and isinstance(error, OSError | ValueError):
            raise DeviceError(
                f"{driver.name} cannot open this device: {' '.join(str(error).split())}; see that "
                f"its address is right, and that it is on"
            ) from error
        print_traceback(error)
        what = f"{type(error).__name__}: {' '.join(str(error).split())}".removesuffix(": ")
        raise DeviceError(
            f"the driver {driver.name} ({driver.value}), which is not vbraille's own, has a fault "
            f"({what}); tell its author what {setting('verbose')} prints"
        ) from error


def check_actuators(info: Display, wanted: Display) -> None:
    """Raise InputError if a device has other actuators than a page is for."""
    if (info.rows, info.columns) != (wanted.rows, wanted.columns):
        raise InputError(
            f"{info.name} has {info.rows} × {info.columns} actuators and the page is for "
            f"{wanted.rows} × {wanted.columns}; choose another {setting('model')} or "
            f"{setting('device')}"
        )
    for what, lines, pitch_mm, wanted_mm in (
        ("columns", info.columns, info.column_pitch_mm, wanted.column_pitch_mm),
        ("rows", info.rows, info.row_pitch_mm, wanted.row_pitch_mm),
    ):
        # One row or column has no pitch.
        if lines > 1 and abs(pitch_mm - wanted_mm) > PITCH_TOLERANCE * wanted_mm:
            raise InputError(
                f"the {what} of {info.name} are {pitch_mm:g} mm apart and the page is for "
                f"{wanted_mm:g} mm; choose another {setting('model')} or {setting('device')}"
            )


def check_travel(display: Display, travel_mm: float) -> None:
    """Raise InputError if a page needs more travel than a device's carriage has."""
    if travel_mm > display.travel_mm + TRAVEL_TOLERANCE_MM:
        raise InputError(
            f"the carriage of {display.name} goes {display.travel_mm:g} mm and "
            f"{setting('travel')} asks for {travel_mm:g} mm; leave {setting('travel')} out, or "
            f"give {display.travel_mm:g} or less"
        )


def check_height(display: Display, height_mm: float | None) -> None:
    """Raise InputError if a page is higher than a device's carriage goes down; None is no page."""
    if height_mm is not None and height_mm > display.height_mm + TRAVEL_TOLERANCE_MM:
        far = f"goes {display.height_mm:g} mm down" if display.height_mm else "goes along x only"
        raise InputError(
            f"the carriage of {display.name} {far} and {setting('height')} asks for "
            f"{height_mm:g} mm; leave {setting('height')} out"
        )
