"""Hands that go over a picture: Lévesque 2009, 8.5.2 and fig. 8.30.

*Wide* goes round the canvas and then inward in a spiral of a chosen density; *spot* swings about
one place. The numbers are ours.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vbraille.errors import check_range
from vbraille.simulation.hand import Hand, Sweep
from vbraille.simulation.motion import MOST_MM, Motion

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.simulation.steering import Area

SPACING_MM = 10.0
SPEED_MM_S = 60.0
RADIUS_MM = 5.0  # how far a spot path goes from its place along x, and along y
DURATION_S = 10.0  # of a spot path
_SWING_S = 0.005  # from knot to knot of a path that swings
# A swing along x and one along y whose frequencies have no common period fill the square about a
# place evenly.
_RATIO = (1 + math.sqrt(5)) / 2


class Explorer(Hand):
    """A hand that goes over a picture, which is its page; a line it only crosses."""

    def read_line(self, start_mm: float, end_mm: float) -> Motion:
        """Return the motion along a line, to its end and back; see `hand.Hand`."""
        return Sweep(SPEED_MM_S).read_line(start_mm, end_mm)


@dataclass(frozen=True, slots=True)
class Wide(Explorer):
    """A hand that goes round a canvas and then inward in a spiral.

    Parameters
    ----------
    spacing_mm
        Distance between neighbouring turns of the spiral, 0.5 to 1000 mm.
    """

    spacing_mm: float = SPACING_MM

    def __post_init__(self) -> None:
        check_range("spacing", self.spacing_mm, 0.5, 1000, " mm")

    def read_page(self, area: Area) -> Motion:
        """Return the motion over the canvas that an area is; its lines do not matter."""
        x_mm, y_mm = spiral(area.end_mm, area.height_mm, self.spacing_mm)
        t_s = np.append(0.0, np.cumsum(np.hypot(np.diff(x_mm), np.diff(y_mm)))) / SPEED_MM_S
        # The array's centre is on the spiral, and half its span left of that it is at the start.
        return Motion(t_s, x_mm + area.start_mm / 2, y_mm)


@dataclass(frozen=True, slots=True)
class Spot(Explorer):
    """A hand that swings about a place, so that the square about it is filled evenly.

    Parameters
    ----------
    at_mm
        Place on the canvas, which is crossed at `SPEED_MM_S`; None for the middle.
    """

    at_mm: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        for place in self.at_mm or ():
            check_range("place", place, -MOST_MM, MOST_MM, " mm")

    def read_page(self, area: Area) -> Motion:
        """Return the motion over the canvas that an area is; its lines do not matter."""
        x_mm, y_mm = self.at_mm or (area.end_mm / 2, area.height_mm / 2)
        rate = SPEED_MM_S / (RADIUS_MM * math.hypot(1, _RATIO))
        t_s = np.arange(0, DURATION_S + _SWING_S / 2, _SWING_S)
        x = x_mm + area.start_mm / 2 + RADIUS_MM * np.sin(rate * t_s)
        return Motion(t_s, x, y_mm + RADIUS_MM * np.sin(_RATIO * rate * t_s))


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
