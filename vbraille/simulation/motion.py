"""Motions: times and places, made step by step, and a hand that goes from one to the next."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from vbraille.display import Display

LEAST_KNOT_S = 1e-6  # a shorter time is made as long, so that time always increases
# Rounding error of ticks and samples at tenths or thousandths of a second.
SLACK = 1e-9
SPEED_BOUNDS_MM_S = (0.1, 1000.0)
MOST_MM = 10_000.0  # as far as any carriage goes
# Ours: a hand on its way back does not read, and crosses a carriage of 300 mm in little over 1 s.
RETURN_MM_S = 250.0
# Speeds at which a hand goes, and turns, to where its next motion begins.
APPROACH_MM_S = 250.0
TURN_RAD_S = 2 * math.pi
_NS_PER_S = 1_000_000_000


@dataclass(frozen=True, slots=True, eq=False)
class Motion:
    """A way over the surface, in straight lines from knot to knot.

    Parameters
    ----------
    t_s : float64[n]
        Time of each knot, from 0, increasing; at least 2 knots.
    x_mm : float64[n]
        Places of the array along x: half its span left of its centre. As long as the array is
        not turned, that is where its left column is.
    y_mm : float64[n] or None
        Places of the array's centre, from the top of the page; None if y does not change.
    theta_rad : float64[n] or None
        Angles by which the array is turned, as in `vbraille.display`; None if they do not change.

    Raises
    ------
    ValueError
        If time does not begin at 0 and increase.
    """

    t_s: NDArray[np.float64]
    x_mm: NDArray[np.float64]
    y_mm: NDArray[np.float64] | None = None
    theta_rad: NDArray[np.float64] | None = None

    def __post_init__(self) -> None:
        if self.t_s.size < 2 or self.t_s[0] != 0 or not (np.diff(self.t_s) > 0).all():
            raise ValueError("times of a motion must begin at 0 and increase; give 2 or more")

    @property
    def duration_s(self) -> float:
        """Duration of the motion: the time of its last knot."""
        return float(self.t_s[-1])

    def sample(self, rate_hz: float, y_mm: float = 0.0) -> NDArray[np.float64]:
        """Times at multiples of 1 / rate up to the end, and x, y and θ then; float64[4, n].

        Where y does not change it is the given one, and θ is 0.
        """
        t_s = np.arange(1 + math.floor(self.duration_s * rate_hz + SLACK)) / rate_hz
        ways = zip((self.x_mm, self.y_mm, self.theta_rad), (0.0, y_mm, 0.0), strict=True)
        places = (
            np.full(t_s.size, usual) if way is None else np.interp(t_s, self.t_s, way)
            for way, usual in ways
        )
        return np.stack((t_s, *places))


class Way:
    """A motion along x in the making.

    Parameters
    ----------
    x_mm
        Place where the way begins; later the place that it has come to.
    """

    def __init__(self, x_mm: float) -> None:
        self.x_mm = x_mm
        self._knots = [(0.0, x_mm)]

    def move(self, to_mm: float, speed_mm_s: float) -> None:
        """Go to a place at a speed above 0; do nothing if the way is there already."""
        if to_mm != self.x_mm:
            duration_s = abs(to_mm - self.x_mm) / speed_mm_s
            self.x_mm = to_mm
            self.wait(duration_s)

    def wait(self, duration_s: float) -> None:
        """Stay in the same place for some time."""
        t_s = self._knots[-1][0] + max(duration_s, LEAST_KNOT_S)
        self._knots.append((t_s, self.x_mm))

    def motion(self) -> Motion:
        """Return the motion made so far."""
        t_s, x_mm = np.array(self._knots).T
        return Motion(t_s, x_mm)


class Course:
    """Course of a hand that goes from motion to motion, in the time of a clock.

    Parameters
    ----------
    display
        Display that the hand moves; along an axis that its carriage does not have the hand stays
        at 0.
    home
        Place x and y where it stands at first, and its angle, as in `Motion`.
    now_ns
        Time at which it stands there.

    Attributes
    ----------
    begun_ns : int
        When what is under way, or was last, began.
    """

    def __init__(self, display: Display, home: Sequence[float], now_ns: int = 0) -> None:
        self._axes = np.array([1.0, display.height_mm > 0, display.turns])
        self.begun_ns = now_ns
        # Times of the knots, and x, y and θ then.
        self._knots = np.array([[0.0], *([place] for place in home)])

    def is_over(self, now_ns: Any) -> Any:
        """Tell whether the hand is at the end of its motion, at a time or at each of an array."""
        return (now_ns - self.begun_ns) / _NS_PER_S >= self._knots[0, -1]

    def at(self, now_ns: Any) -> list[Any]:
        """Return the place x and y, and the angle, at a time, or at each of an array of times."""
        t_s = (now_ns - self.begun_ns) / _NS_PER_S
        return [np.interp(t_s, self._knots[0], way) for way in self._knots[1:]]

    def rest(self, now_ns: int) -> Motion | None:
        """Return the motion that is left of the present one; None if it is over."""
        if self.is_over(now_ns):
            return None
        here = np.array([(now_ns - self.begun_ns) / _NS_PER_S, *self.at(now_ns)])
        later = self._knots[:, self._knots[0] > here[0]]
        t_s, *ways = np.column_stack((here, later))
        return Motion(t_s - t_s[0], *ways)

    def go_to(
        self,
        to: Sequence[float],
        now_ns: int,
        speed_mm_s: float = APPROACH_MM_S,
        least_s: float = 0.0,
    ) -> None:
        """Go straight to a place; that takes no time if the hand is there, unless it must."""
        here, there = np.array(self.at(now_ns)), np.array(to) * self._axes
        x_mm, y_mm, theta_rad = np.abs(there - here)
        way_s = max(math.hypot(x_mm, y_mm) / speed_mm_s, theta_rad / TURN_RAD_S, least_s)
        self.begun_ns = now_ns
        self._knots = np.column_stack(((0.0, *here), (way_s, *there)))

    def follow(self, motion: Motion, now_ns: int) -> None:
        """Go along a motion, and first to where it begins; y and θ stay if it has none."""
        given = zip(self.at(now_ns), (motion.x_mm, motion.y_mm, motion.theta_rad), strict=True)
        ways = [np.full(motion.t_s.size, here) if way is None else way for here, way in given]
        self.go_to([float(way[0]) for way in ways], now_ns)
        (begun, arrived), axes = self._knots.T, self._axes[:, None]
        self._knots = np.column_stack((begun, np.vstack((arrived[0] + motion.t_s, ways * axes))))
