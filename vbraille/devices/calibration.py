"""Gains of a device's actuators: what was found, its file beside the settings, how it is made up.

A gain is the share of the full swing that an actuator is driven with: 1 is all of it, 0 is an
actuator that does not move, and a negative gain one that moves the other way.
"""

from __future__ import annotations

import json
import tomllib
from typing import TYPE_CHECKING, Annotated, Any, Final, Protocol
from urllib.parse import quote

import msgspec
import numpy as np

from vbraille.errors import InputError
from vbraille.files import read_text, write_file

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from vbraille.display import Display

    class _Device(Protocol):
        """The part of a device that is asked here."""

        display: Display
        serial_number: str


Gain = Annotated[float, msgspec.Meta(ge=-1, le=1)]
_Row = Annotated[list[Gain], msgspec.Meta(min_length=1)]
_TURN_S: Final = 0.1  # in which an actuator goes over to another gain
_MOST_NAME: Final = 150


class Calibration(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Findings on a device's actuators.

    Parameters
    ----------
    device
        Name of the device, with its serial number if it has one.
    gain
        Gain of each actuator: row by row from the far one, columns from the left.
    """

    device: str
    gain: Annotated[list[_Row], msgspec.Meta(min_length=1)]

    def __post_init__(self) -> None:
        if len({len(row) for row in self.gain}) > 1:
            raise ValueError("its rows of `gain` are not alike in length")

    @property
    def gains(self) -> NDArray[np.float64]:
        """The gains; float64[rows, columns]."""
        return np.array(self.gain, np.float64)

    def to_json(self) -> dict[str, Any]:
        """Return it as a session keeps it."""
        return msgspec.to_builtins(self)

    def to_toml(self) -> str:
        """Text of its file."""
        rows = "".join(f"  [{', '.join(f'{gain:g}' for gain in row)}],\n" for row in self.gain)
        return (
            "# Made by vbraille calibrate: a gain for each actuator, the far row first, the left "
            "column first.\n# 1 is the full swing, 0 an actuator that does not move; a negative "
            f"gain one that moves the other way.\n"
            f"device = {json.dumps(self.device, ensure_ascii=False)}\ngain = [\n{rows}]\n"
        )


def even_gains(device: _Device) -> Calibration:
    """Calibration in which every actuator is well."""
    rows, columns = device.display.shape
    return Calibration(name_of(device), [[1.0] * columns] * rows)


def name_of(device: _Device) -> str:
    """Name by which a calibration knows a device: its own, and its serial number if it has one."""
    return f"{device.display.name} {device.serial_number}".strip()


def path_of(settings: Path, device: str) -> Path:
    """Path of a device's calibration, which stands beside the settings file."""
    kept = quote(device, safe=" ").replace(" ", "-")[:_MOST_NAME]
    return settings.with_name(f"{settings.stem}-calibration-{kept}.toml")


def load(settings: Path, device: _Device) -> Calibration | None:
    """Read what is kept of a device; None if nothing is.

    Raises
    ------
    InputError
        If there is a file that is no calibration, or is for another device or array.
    """
    name = name_of(device)
    path = path_of(settings, name)
    if not path.exists():
        return None
    try:
        table = tomllib.loads(read_text(path, "calibration"))
        found = msgspec.convert(table, Calibration, strict=False)
    except (tomllib.TOMLDecodeError, msgspec.ValidationError) as error:
        raise InputError(f"{path} is no calibration: {error}; mend it or move it away") from None
    rows, columns = found.gains.shape
    if (found.device, rows, columns) != (name, *device.display.shape):
        raise InputError(
            f"{path} is of {rows} × {columns} actuators of {found.device} and not of {name}; move "
            f"it away, and calibrate again"
        )
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
    write_file(path, calibration.to_toml().encode(), replace=True, durable=True)


class Correction:
    """Deflections on their way to actuators of different gains.

    An actuator is sent ``scale · deflection + offset``: an inverted one has an offset of 1 and a
    negative scale. Both go to what is wanted in steps, so that no actuator jumps; where the device
    has gone to rest by itself, all actuators stand at 0, and inverted ones set out from there.

    Attributes
    ----------
    moving : bool
        Whether scale and offset are still on their way.
    """

    def __init__(self, shape: tuple[int, int], rate_hz: float) -> None:
        self.moving = False
        # Scales, then offsets.
        self._now = np.stack([np.ones(shape), np.zeros(shape)])
        self._to = self._now.copy()
        self._step = 1 / max(_TURN_S * rate_hz, 1)
        self._rested: int | None = None

    def aim(self, gains: NDArray[np.float64] | None) -> None:
        """Go over to these gains, float64[rows, columns]; None for deflections as they are."""
        self._to[0] = 1.0 if gains is None else gains
        self._to[1] = self._to[0] < 0
        self.moving = True

    def of(self, frame: NDArray[np.float64], rested: int) -> NDArray[np.float64]:
        """Correct a frame, float64[rows, columns] in [0, 1].

        Parameters
        ----------
        frame
            Deflections that are wanted.
        rested
            How often the device has gone to rest by itself so far.
        """
        if rested != self._rested:
            self._rested, self.moving = rested, True
            self._now[0] = np.maximum(self._to[0], 0.0)
            self._now[1] = 0.0
        if self.moving:
            self._now += np.clip(self._to - self._now, -self._step, self._step)
            self.moving = bool((self._now != self._to).any())
        scale, offset = self._now
        return np.clip(scale * frame + offset, 0.0, 1.0)
