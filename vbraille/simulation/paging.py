"""How a hand that reads lines reads a page: from line to line, drifting a little off each."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vbraille.simulation.motion import RETURN_MM_S, Motion

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

# All ours. A finger drifts by less than what would bring the next line under the array's centre:
# half a pitch, or three quarters of it with a hysteresis of a quarter.
DRIFT_PITCHES = 0.15
TILT_RAD = math.radians(5.0)
_PERIODS_S = (3.0, 9.0)
_SHARES = (0.5, 0.3, 0.2)  # shares of the waves that make up a drift; their sum is 1
FOOT_S = 0.8  # how long a hand stays below a page, which is longer than the program waits for
_KNOTS_S = 0.02  # time between knots, short enough that straight lines between them look smooth


@dataclass(frozen=True, slots=True)
class Area:
    """Area of a page that its lines take, as a hand needs it.

    Parameters
    ----------
    lines
        Number of lines, 1 or more; line n, from 0, takes y from n to n + 1 line pitches.
    pitch_mm
        Distance from one line to the next.
    start_mm, end_mm
        Places where the array begins and ends each line, along x as in `Motion`.
    foot_mm
        How far below the last line a hand goes at the end, and stays there; 0 if it does not.

    Raises
    ------
    ValueError
        If there is no line, or the pitch is not above 0.
    """

    lines: int
    pitch_mm: float
    start_mm: float
    end_mm: float
    foot_mm: float = 0.0

    def __post_init__(self) -> None:
        if self.lines < 1:
            raise ValueError(f"a page has {self.lines} lines; it must have 1 or more")
        if not 0 < self.pitch_mm < math.inf:
            raise ValueError(f"line pitch is {self.pitch_mm:g} mm; it must be above 0")

    def middle_mm(self, line: int) -> float:
        """Place of the middle of a line along y."""
        return (line + 0.5) * self.pitch_mm

    @property
    def height_mm(self) -> float:
        """Height of all lines together."""
        return self.lines * self.pitch_mm


def area_on(height_mm: float, lines: int, pitch_mm: float, start_mm: float, end_mm: float) -> Area:
    """Area of lines at the top of a surface; its foot is the surface's lower edge.

    A hand that is not told how much of a page there is goes down there when it has read these
    lines, which is below the last line of whatever page there is.
    """
    foot_mm = max(height_mm - lines * pitch_mm, 0.0)
    return Area(lines, pitch_mm, start_mm, end_mm, foot_mm)


class Drift:
    """How a hand wanders off a line and turns a little, slowly and within bounds.

    Parameters
    ----------
    random
        Generator that draws the drift; each drift is a different one.
    pitches, tilt_rad
        How far the hand goes at most, in line pitches, and how far it turns.
    """

    def __init__(
        self,
        random: np.random.Generator,
        pitches: float = DRIFT_PITCHES,
        tilt_rad: float = TILT_RAD,
    ) -> None:
        self._pitches = pitches
        self._tilt_rad = tilt_rad
        self._waves = [self._draw(random) for _ in range(2)]

    def y_pitches(self, t_s: NDArray[np.float64]) -> NDArray[np.float64]:
        """Tell how far below the middle of the line the hand is at some times, in line pitches.

        Values are within the bounds that were given.
        """
        return self._pitches * self._wave(0, t_s)

    def theta_rad(self, t_s: NDArray[np.float64]) -> NDArray[np.float64]:
        """Tell how far the hand is turned at some times, within the bound that was given."""
        return self._tilt_rad * self._wave(1, t_s)

    @staticmethod
    def _draw(random: np.random.Generator) -> list[tuple[float, float, float]]:
        return [
            (share, random.uniform(*_PERIODS_S), random.uniform(0, 2 * math.pi))
            for share in _SHARES
        ]

    def _wave(self, number: int, t_s: NDArray[np.float64]) -> NDArray[np.float64]:
        total = np.zeros(t_s.size)
        for share, period_s, phase in self._waves[number]:
            total += share * np.sin(2 * math.pi * t_s / period_s + phase)
        return total


def read_lines(
    read_line: Callable[[float, float], Motion], area: Area, drift: Drift | None = None
) -> Motion:
    """Motion over a page: along each line and back as on a single line, then down to the next.

    If the area has a foot the hand ends there.

    Parameters
    ----------
    read_line
        Function that gives the motion along the next line and back, as in
        `vbraille.simulation.hand.Hand`.
    area
        Area that the lines take.
    drift
        How the hand wanders off the lines; None if it keeps to the middle of each.
    """
    times_s, places_mm, middles_mm = [], [], []
    begun_s = 0.0
    for line in range(area.lines):
        motion = read_line(area.start_mm, area.end_mm)
        times_s.append(begun_s + motion.t_s)
        places_mm.append(motion.x_mm)
        middles_mm.append(np.full(motion.t_s.size, area.middle_mm(line)))
        begun_s += motion.duration_s + area.pitch_mm / RETURN_MM_S
    last_s = times_s[-1][-1]
    if area.foot_mm:
        down_s = last_s + (area.pitch_mm / 2 + area.foot_mm) / RETURN_MM_S
        times_s.append(np.array([down_s, down_s + FOOT_S]))
        places_mm.append(np.full(2, area.start_mm))
        middles_mm.append(np.full(2, area.height_mm + area.foot_mm))
    t_s, x_mm, y_mm = map(np.concatenate, (times_s, places_mm, middles_mm))
    if drift is None:
        return Motion(t_s, x_mm, y_mm)
    fine_s = np.union1d(t_s, np.arange(0.0, t_s[-1], _KNOTS_S))
    strayed_mm = area.pitch_mm * drift.y_pitches(fine_s)
    y_mm = np.interp(fine_s, t_s, y_mm) + np.where(fine_s > last_s, 0.0, strayed_mm)
    return Motion(fine_s, np.interp(fine_s, t_s, x_mm), y_mm, drift.theta_rad(fine_s))
