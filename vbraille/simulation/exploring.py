"""Hands that go over a picture, and the paths that they take.

Lévesque 2009, 8.5.2 and fig. 8.30, has two: *wide* goes round the canvas and then inward in a
spiral of a chosen density; *spot* swings about one place. Paths are motions of the array's centre.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vbraille.errors import check_range
from vbraille.simulation.hand import Sweep
from vbraille.simulation.motion import MOST_MM, SPEED_BOUNDS_MM_S, Motion

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.simulation.hand import Area

SPACING_MM = 10.0
SPEED_MM_S = 60.0
_SWING_S = 0.005  # from knot to knot of a path that swings
# A swing along x and one along y whose frequencies have no common period fill the square about a
# place evenly.
_RATIO = (1 + math.sqrt(5)) / 2


def spiral(width_mm: float, height_mm: float, spacing_mm: float) -> NDArray[np.float64]:
    """Return the corners of a path round a canvas and then inward, from the upper left one.

    Returns
    -------
    float64[2, n]
        Places x and y.
    """
    corners = [(0.0, 0.0)]
    for inset in np.arange(0, min(width_mm, height_mm) / 2, spacing_mm):
        right, low = width_mm - inset, height_mm - inset
        next_turn = min(inset + spacing_mm, low)
        corners += [(right, inset), (right, low), (inset, low), (inset, next_turn)]
    # What is left in the middle is gone along once.
    half = min(width_mm, height_mm) / 2
    if width_mm >= height_mm:
        corners += [(corners[-1][0], half), (width_mm - half, half)]
    else:
        corners += [(half, corners[-1][1]), (half, height_mm - half)]
    x, y = np.array(corners).T
    moved = np.append(True, np.hypot(np.diff(x), np.diff(y)) > 0)
    return np.stack((x[moved], y[moved]))


def wide(
    width_mm: float,
    height_mm: float,
    *,
    spacing_mm: float = SPACING_MM,
    speed_mm_s: float = SPEED_MM_S,
) -> Motion:
    """Go round a canvas and then inward in a spiral: Lévesque 2009, fig. 8.30.

    Parameters
    ----------
    width_mm, height_mm
        Size of the canvas.
    spacing_mm
        Distance between neighbouring turns of the spiral, 0.5 to 1000 mm.
    speed_mm_s
        Speed along the path.

    Raises
    ------
    ValueError
        If a number is out of range.
    """
    check_range("spacing", spacing_mm, 0.5, 1000, " mm")
    check_range("speed", speed_mm_s, *SPEED_BOUNDS_MM_S, " mm/s")
    corners = spiral(width_mm, height_mm, spacing_mm)
    lengths_mm = np.hypot(*np.diff(corners))
    return Motion(np.append(0.0, np.cumsum(lengths_mm)) / speed_mm_s, *corners)


def spot(
    x_mm: float,
    y_mm: float,
    *,
    radius_mm: float = 5.0,
    speed_mm_s: float = SPEED_MM_S,
    duration_s: float = 10.0,
) -> Motion:
    """Swing about a place, along x and along y, so that the square about it is filled evenly.

    Parameters
    ----------
    x_mm, y_mm
        Place.
    radius_mm
        How far the array's centre goes from there along x, and along y, 0.1 to 1000 mm.
    speed_mm_s
        Largest speed, that with which the place itself is crossed.
    duration_s
        How long it swings, 0.1 to 3600 s.

    Raises
    ------
    ValueError
        If a number is out of range.
    """
    check_range("place", x_mm, -MOST_MM, MOST_MM, " mm")
    check_range("place", y_mm, -MOST_MM, MOST_MM, " mm")
    check_range("radius", radius_mm, 0.1, 1000, " mm")
    check_range("speed", speed_mm_s, *SPEED_BOUNDS_MM_S, " mm/s")
    check_range("duration", duration_s, 0.1, 3600, " s")
    rate = speed_mm_s / (radius_mm * math.hypot(1, _RATIO))
    t_s = np.arange(0, duration_s + _SWING_S / 2, _SWING_S)
    x = x_mm + radius_mm * np.sin(rate * t_s)
    return Motion(t_s, x, y_mm + radius_mm * np.sin(_RATIO * rate * t_s))


@dataclass(frozen=True, slots=True)
class Explorer:
    """A hand that goes over a picture by one of these paths; a line it only crosses.

    Parameters
    ----------
    at_mm
        Place that the hand swings about; None for a hand that goes round and inward.
    spacing_mm
        Distance between neighbouring turns of the spiral.

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    at_mm: tuple[float, float] | None = None
    spacing_mm: float = SPACING_MM

    def __post_init__(self) -> None:
        self.over(100.0, 100.0)  # refuses what is out of range

    def over(self, width_mm: float, height_mm: float) -> Motion:
        """Return the path of the array's centre over a canvas."""
        if self.at_mm is not None:
            return spot(*self.at_mm)
        return wide(width_mm, height_mm, spacing_mm=self.spacing_mm)

    def read_line(self, start_mm: float, end_mm: float) -> Motion:
        """Return the motion along a line, to its end and back; see `hand.Hand`."""
        return Sweep(SPEED_MM_S).read_line(start_mm, end_mm)

    def read_page(self, area: Area) -> Motion:
        """Return the motion over the canvas that an area is; its lines do not matter."""
        path = self.over(area.end_mm, area.height_mm)
        half_span_mm = -area.start_mm / 2  # an array at the left stop stands there
        return Motion(path.t_s, path.x_mm - half_span_mm, path.y_mm)


def parse_explorer(spec: str) -> Explorer:
    """Return the hand of ``wide``, ``wide:SPACING`` or ``spot:X,Y``.

    Raises
    ------
    ValueError
        If a number is none, or out of range.
    """
    kind, _, rest = spec.partition(":")
    if kind == "spot":
        return Explorer(parse_place(rest))
    return Explorer(spacing_mm=_number(rest, "spacing") if rest else SPACING_MM)


def parse_place(text: str) -> tuple[float, float]:
    """Return the place on the canvas that is written as ``X,Y``, in mm.

    Raises
    ------
    ValueError
        If it is written in another way.
    """
    x, comma, y = text.partition(",")
    if not comma:
        raise ValueError(f"the place is {text!r}; write it as X,Y in mm, such as 140,108")
    return _number(x, "place"), _number(y, "place")


def _number(text: str, what: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise ValueError(f"{what} is {text!r}; give a number in mm")
    return value
