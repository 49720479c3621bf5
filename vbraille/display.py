"""A laterotactile display: its actuators, and the carriage that they stand on.

A device offers its `Display` and gives a `Pose` at each tick. Pages are laid out for a display, and
pictures are compiled for it.
"""

from __future__ import annotations

import math
import operator
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vbraille.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray


# What the protocol and the kernels have room for.
MOST_ROWS, MOST_COLUMNS = 16, 64
REST_SIDES = ("left", "right")


@dataclass(frozen=True, slots=True)
class Display:
    """The hardware as a value; row 0 is far from the reader, column 0 is the left one.

    Parameters
    ----------
    name
        What people call the display.
    rows, columns
        How many actuators there are, at least 1 each.
    column_pitch_mm, row_pitch_mm
        Distance between neighbouring columns (along x) and rows (along y), in mm; with one row
        the row pitch has no meaning.
    levels
        Number of deflections that an actuator can stand at, at least 2: 1024 for 10 bits.
    rest_side
        The side at which an actuator stands at deflection 0, "left" or "right".
    travel_mm
        How far the carriage goes along x.
    counts_per_mm
        Resolution of the carriage's encoders, in counts a mm.
    rate_hz
        Frames a second that the display is made for.
    height_mm
        How far the carriage goes along y; 0 if it has one axis only.
    turns
        Whether the carriage measures which way the array is turned.
    contactor_mm
        Width and height of what touches the skin, in mm; None if that is not known.
    shown_near
        Whether a carriage of two axes that must be shown its place is shown the left corner near
        the reader, and not the far one.

    Raises
    ------
    ValueError
        If a value is out of range.
    """

    name: str
    rows: int
    columns: int
    column_pitch_mm: float
    row_pitch_mm: float
    levels: int = 1024
    rest_side: str = "right"
    travel_mm: float = 300.0
    counts_per_mm: float = 200.0
    rate_hz: float = 1000.0
    height_mm: float = 0.0
    turns: bool = False
    contactor_mm: tuple[float, float] | None = None
    shown_near: bool = False

    def __post_init__(self) -> None:
        for name in ("rows", "columns", "levels"):
            operator.index(getattr(self, name))  # TypeError for what is no whole number
        if not (1 <= self.rows <= MOST_ROWS and 1 <= self.columns <= MOST_COLUMNS):
            raise ValueError(
                f"an array of {self.rows} × {self.columns} actuators is not possible; "
                f"it must be 1 to {MOST_ROWS} rows × 1 to {MOST_COLUMNS} columns"
            )
        for name in ("column_pitch_mm", "row_pitch_mm"):
            if not 0.05 <= getattr(self, name) <= 50:
                raise ValueError(f"{name} is {getattr(self, name):g}; it must be 0.05 to 50 mm")
        if self.levels < 2:
            raise ValueError(f"a display of {self.levels} levels is not possible; it has 2 or more")
        if self.rest_side not in REST_SIDES:
            raise ValueError(f"rest side is {self.rest_side!r}; it must be left or right")
        for name in ("travel_mm", "counts_per_mm", "rate_hz"):
            if not 0 < getattr(self, name) < math.inf:
                raise ValueError(f"{name} is {getattr(self, name)}; it must be above 0")
        if not 0 <= self.height_mm < math.inf:
            raise ValueError(f"height_mm is {self.height_mm}; it must be 0 or more")
        if self.contactor_mm is not None:
            width, height = self.contactor_mm  # JSON has lists
            object.__setattr__(self, "contactor_mm", (width, height))
            if not (width > 0 and height > 0):
                raise ValueError(f"contactors are {width} × {height} mm; they must be above 0")

    @property
    def span_mm(self) -> float:
        """Distance from the left column to the right one: S = (columns - 1) · pitch."""
        return (self.columns - 1) * self.column_pitch_mm

    @property
    def depth_mm(self) -> float:
        """Distance from row 0 to the row nearest to the reader."""
        return (self.rows - 1) * self.row_pitch_mm

    @property
    def shape(self) -> tuple[int, int]:
        """Shape of a frame: rows, columns."""
        return self.rows, self.columns

    @property
    def axes(self) -> str:
        """Tell what the carriage measures: "x", "xy", or either with "θ"."""
        return "x" + "y" * (self.height_mm > 0) + "θ" * self.turns

    def column_offsets_mm(self) -> NDArray[np.float64]:
        """Tell how far each column is right of the left one; float64[columns]."""
        return np.arange(self.columns, dtype=np.float64) * self.column_pitch_mm

    def row_offsets_mm(self) -> NDArray[np.float64]:
        """Tell how far each row is from row 0, towards the reader; float64[rows]."""
        return np.arange(self.rows, dtype=np.float64) * self.row_pitch_mm


def check_rate(rate_hz: float) -> float:
    """Frames a second, if a loop can have so many.

    Raises
    ------
    InputError
        If it is not 1 to 10,000.
    """
    if not 1 <= rate_hz <= 10_000:
        raise InputError(f"rate is {rate_hz:g} Hz; it must be 1 to 10000 Hz")
    return rate_hz


class Pose(NamedTuple):
    """Place of the array at a time.

    Parameters
    ----------
    time_ns
        Time of the pose, in ns of the device's clock.
    x_mm, y_mm
        The array's centre on the canvas. At the left stop of a slider the whole array stands
        before the line: x = -(columns - 1) / 2 · pitch. A slider measures no y: it says 0, and
        the picture is shown where it has its dots.
    theta_rad
        Angle by which the array is turned, in radians; 0 where that is not measured.
    """

    time_ns: int
    x_mm: float
    y_mm: float = 0.0
    theta_rad: float = 0.0
