"""A hand that goes about a page without reading it: along a smooth path of its own."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from vbraille.errors import check_range
from vbraille.simulation.hand import CLEAR_MM, Sweep, along
from vbraille.simulation.motion import LEAST_KNOT_S, RETURN_MM_S, SPEED_BOUNDS_MM_S, Motion

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.simulation.hand import Area

# All ours.
TURN_RAD = math.radians(30.0)
ARM_MM = 60.0  # a turn by 1 rad counts as a way of this length, so that no hand spins on the spot
_KNOTS = 64  # knots of the path between two of the places that it is drawn to
# A path is drawn to more places than it needs, and is then cut off. On average it goes at least
# this share of width and height together between two of the places.
_LEAST_SHARE = 0.05
_BEYOND = 0.5  # how far beyond each edge places are drawn, as a share of width and height


class Wander:
    """A hand that wanders at a constant speed; equal seeds wander in the same way.

    It is drawn to places anywhere on the page one after the other, without quite reaching them,
    and turns meanwhile. On a page it goes as far as reading each line once would take it.

    Parameters
    ----------
    speed_mm_s
        Speed along the path as long as the hand does not turn; while turning it is slower. The way
        back is at `RETURN_MM_S`.
    seed
        Seed of the path, 0 or more.

    Raises
    ------
    ValueError
        If the speed is out of `SPEED_BOUNDS_MM_S`, or the seed is negative.
    """

    def __init__(self, speed_mm_s: float, seed: int = 1) -> None:
        check_range("wander speed", speed_mm_s, *SPEED_BOUNDS_MM_S, " mm/s")
        if seed < 0:
            raise ValueError(f"seed is {seed}; it must be 0 or more")
        self.speed_mm_s = speed_mm_s
        self._random = np.random.default_rng(seed)

    def read_line(self, start_mm: float, end_mm: float) -> Motion:
        """Motion to and fro on the next line, then to its end and back; see `Hand`."""
        way = along(start_mm, end_mm)
        low_mm, high_mm = start_mm + CLEAR_MM, end_mm - CLEAR_MM
        if low_mm >= high_mm:
            return Sweep(self.speed_mm_s).read_line(start_mm, end_mm)
        way.move(low_mm, self.speed_mm_s)
        for place_mm in self._random.uniform(low_mm, high_mm, 6):
            way.move(place_mm, self.speed_mm_s)
        way.move(end_mm, self.speed_mm_s)
        way.move(start_mm, RETURN_MM_S)
        return way.motion()

    def read_page(self, area: Area) -> Motion:
        """Motion all about a page, and back to the start of its first line; see `Hand`."""
        along(area.start_mm, area.end_mm)
        home = np.array([area.start_mm, area.middle_mm(0), 0.0])
        low = np.array([area.start_mm, 0.0, -TURN_RAD])
        high = np.array([area.end_mm, area.height_mm, TURN_RAD])
        length_mm = area.lines * (area.end_mm - area.start_mm) + area.height_mm
        least_mm = _LEAST_SHARE * float((high - low)[:2].sum())
        # The path keeps between the places; so some are drawn beyond the edges, and brought back.
        beyond = _BEYOND * (high - low)
        count = math.ceil(length_mm / least_mm)
        drawn = self._random.uniform(low - beyond, high + beyond, (count, 3)).clip(low, high)
        # The spline keeps between the places, but for rounding.
        path = _spline(np.concatenate(([home, home, home], drawn))).clip(low, high)
        far_mm = np.concatenate(([0.0], np.cumsum(_steps_mm(path))))
        kept = int(np.searchsorted(far_mm, length_mm))
        path, t_s = path[:kept], far_mm[:kept] / self.speed_mm_s
        back_s = max(float(_steps_mm(np.array([path[-1], home]))[0]) / RETURN_MM_S, LEAST_KNOT_S)
        t_s, path = np.append(t_s, t_s[-1] + back_s), np.concatenate((path, [home]))
        moved = np.concatenate(([True], np.diff(t_s) >= LEAST_KNOT_S))
        return Motion(t_s[moved], *path[moved].T)


def _spline(places: NDArray[np.float64]) -> NDArray[np.float64]:
    """Uniform cubic B-spline of places, float64[m, 3]: smooth, and never outside their bounds."""
    u = (np.arange(_KNOTS) / _KNOTS)[:, None, None]
    weights = (
        (1 - u) ** 3 / 6,
        (3 * u**3 - 6 * u**2 + 4) / 6,
        (-3 * u**3 + 3 * u**2 + 3 * u + 1) / 6,
        u**3 / 6,
    )
    count = len(places) - 3
    parts = [weight * places[n : n + count] for n, weight in enumerate(weights)]
    return np.sum(parts, axis=0).transpose(1, 0, 2).reshape(-1, 3)


def _steps_mm(path: NDArray[np.float64]) -> NDArray[np.float64]:
    """Lengths of the steps along a path, with its turns."""
    return np.linalg.norm(np.diff(path, axis=0) * (1.0, 1.0, ARM_MM), axis=1)
