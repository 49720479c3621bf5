"""Calibrations of devices in files beside the settings: a file a device, which people may mend."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Final
from urllib.parse import quote

from vbraille.devices.calibration import Calibration, State, Tried
from vbraille.display import MOST_COLUMNS, MOST_ROWS
from vbraille.errors import InputError, check_range
from vbraille.files import read_text, sync_names, write_file
from vbraille.tomlfile import Table, TomlFile
from vbraille.wording import setting

if TYPE_CHECKING:
    from pathlib import Path

    from vbraille.devices.base import Device
_MOST_NAME: Final = 150


class ActuatorTable(Table, frozen=True):
    """A table ``[[actuator]]``: what was found of one actuator."""

    row: int
    column: int
    state: State = "ok"
    inverted: bool = False
    gain: float = 1.0

    def __post_init__(self) -> None:
        self.tried()

    def tried(self) -> Tried:
        """The same with rows and columns that count from 0."""
        check_range("row", self.row, 1, MOST_ROWS)
        check_range("column", self.column, 1, MOST_COLUMNS)
        return Tried(self.row - 1, self.column - 1, self.state, self.inverted, self.gain)


class CalibrationTable(Table, frozen=True):
    """A calibration's file as a whole."""

    device: str
    rows: int
    columns: int
    actuator: tuple[ActuatorTable, ...] = ()


def parse(text: str, where: str) -> Calibration:
    """Read a calibration.

    Parameters
    ----------
    text
        Text of the file.
    where
        Name of the file, for messages.

    Raises
    ------
    InputError
        If the text is no calibration; one sentence says the line and the key.
    """
    file = TomlFile(text, where)
    found = file.read(CalibrationTable)
    with file.checking():
        return Calibration(
            found.device,
            found.rows,
            found.columns,
            tuple(one.tried() for one in found.actuator),
        )


def name_of(device: Device) -> str:
    """Name by which a calibration knows a device: its own, and its serial number if it has one."""
    return f"{device.display.name} {device.serial_number}".strip()


def path_of(settings: Path, device: str) -> Path:
    """Path of a device's calibration, which stands beside the settings file.

    Parameters
    ----------
    settings
        Path of the settings file, which need not be there.
    device
        Name of the device, as `name_of` gives it.
    """
    kept = quote(device, safe=" ").replace(" ", "-")[:_MOST_NAME]
    return settings.with_name(f"{settings.stem}-calibration-{kept}.toml")


def load(settings: Path, device: Device) -> Calibration | None:
    """Read what is kept of a device; None if nothing is.

    Raises
    ------
    InputError
        If there is a file that cannot be read, has what no calibration has, or is for another
        array.
    """
    name, display = name_of(device), device.display
    path = path_of(settings, name)
    if not path.exists():
        return None
    found = parse(read_text(path, "calibration"), str(path))
    if found.device != name:
        raise InputError(
            f"{path} is of {found.device} and not of {name}; move it away, or mend its device"
        )
    if (found.rows, found.columns) != display.shape:
        raise InputError(
            f"{path} is for {found.rows} × {found.columns} actuators and {name} has "
            f"{display.rows} × {display.columns}; calibrate it anew after "
            f"vbraille device calibrate {setting('forget')}"
        )
    return found


def correct_by_kept(settings: Path, device: Device) -> Calibration | None:
    """Have a device corrected by what is kept of it, if it has no gains of its own.

    Returns
    -------
    Calibration or None
        What is made up for; None if nothing is kept, or the device does so itself.

    Raises
    ------
    InputError
        If what is kept cannot be used.
    DeviceError
        If the driver corrects nothing.
    """
    if device.has_own_gains:
        return None
    found = load(settings, device)
    if found is not None:
        device.correct(found)
    return found


def save(settings: Path, calibration: Calibration) -> None:
    """Keep a calibration, whole and on the disk, in place of the one before.

    Raises
    ------
    InputError
        If no file can be made.
    VbrailleError
        If the disk cannot take it.
    """
    path = path_of(settings, calibration.device)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{path.parent} cannot be made: {error.strerror}") from None
    write_file(path, to_toml(calibration).encode(), replace=True, durable=True)
    sync_names(path.parent)


def to_toml(calibration: Calibration) -> str:
    """Text of a calibration's file; rows and columns count from 1 there."""
    lines = [
        "# Made by vbraille device calibrate. Rows count from the far one, columns from the left.",
        f"device = {json.dumps(calibration.device, ensure_ascii=False)}",
        f"rows = {calibration.rows}",
        f"columns = {calibration.columns}",
    ]
    for one in calibration.tried:
        lines += ["", "[[actuator]]", f"row = {one.row + 1}", f"column = {one.column + 1}"]
        lines.append(f'state = "{one.state}"')
        lines += ["inverted = true"] * one.inverted
        lines += [f"gain = {one.gain:g}"] * (one.gain < 1)
    return "\n".join(lines) + "\n"
