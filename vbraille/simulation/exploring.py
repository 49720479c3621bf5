"""Paths of a hand over a picture, on which frames and their cost are taken.

Lévesque 2009, 8.5.2 and fig. 8.30, has two: *wide* goes round the canvas and then inward in a
spiral of a chosen density; *spot* swings about one place. Its 9.6 adds disturbances: a path that
sways, a speed that changes, and stretches that are gone back. The numbers are ours.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vbraille.errors import check_range
from vbraille.simulation.motion import MOST_MM, RETURN_MM_S, SPEED_BOUNDS_MM_S, Motion, Way

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.simulation.hand import Area

_STEP_MM = 0.5  # from knot to knot of a path that is disturbed
_MOST_KNOTS = 5_000_000
_SWING_S = 0.005  # from knot to knot of a path that swings
# A swing along x and one along y whose frequencies have no common period fill the square about a
# place evenly.
_RATIO = (1 + math.sqrt(5)) / 2


@dataclass(frozen=True, slots=True)
class Disturbance:
    """Disturbances that keep a path from being even: Lévesque 2009, 9.6.

    Parameters
    ----------
    sway_mm, sway_length_mm
        How far the path sways to either side, and the length of path from one sway to the next.
    speed_change, speed_period_s
        Share by which the speed changes up and down, below 1, and how long a change takes.
    back_mm, back_every_mm
        Length of the stretches that are gone back, and the length of path between them.

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    sway_mm: float = 0.0
    sway_length_mm: float = 20.0
    speed_change: float = 0.0
    speed_period_s: float = 2.0
    back_mm: float = 0.0
    back_every_mm: float = 50.0

    def __post_init__(self) -> None:
        check_range("sway", self.sway_mm, 0, 100, " mm")
        check_range("length of a sway", self.sway_length_mm, 1, 1000, " mm")
        check_range("change of speed", self.speed_change, 0, 0.9)
        check_range("period of a change of speed", self.speed_period_s, 0.1, 100, " s")
        check_range("way back", self.back_mm, 0, 0.9 * self.back_every_mm, " mm")
        check_range("way between", self.back_every_mm, 1, 1000, " mm")

    @property
    def none(self) -> bool:
        """Tell whether the path is even."""
        return not (self.sway_mm or self.speed_change or self.back_mm)


@dataclass(frozen=True, slots=True, eq=False)
class ExploringPath:
    """Places of the array's centre over time.

    Parameters
    ----------
    t_s, x_mm, y_mm : float64[n]
        Times of knots, from 0 on, increasing, and the places there; between them the way is
        straight.
    """

    t_s: NDArray[np.float64]
    x_mm: NDArray[np.float64]
    y_mm: NDArray[np.float64]

    @property
    def duration_s(self) -> float:
        """Time of the last knot."""
        return float(self.t_s[-1])

    def motion(self, span_mm: float) -> Motion:
        """Motion of an array whose outer columns are so far apart."""
        return Motion(self.t_s, self.x_mm - span_mm / 2, self.y_mm)


def spiral(
    width_mm: float, height_mm: float, spacing_mm: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Make the corners of a path round a canvas and then inward.

    Parameters
    ----------
    width_mm, height_mm
        Size of the canvas.
    spacing_mm
        Distance between neighbouring turns of the spiral, above 0.

    Returns
    -------
    float64[n], float64[n]
        Places x and y of the corners, from the upper left one on to the right.
    """
    x = [0.0, width_mm, width_mm, 0.0, 0.0]
    y = [0.0, 0.0, height_mm, height_mm, 0.0]
    inset = spacing_mm
    while 2 * inset < min(width_mm, height_mm):
        x += [x[-1], width_mm - inset, width_mm - inset, inset]
        y += [inset, inset, height_mm - inset, height_mm - inset]
        inset += spacing_mm
        # Up the left side, to where the next turn begins.
        x.append(inset - spacing_mm)
        y.append(min(inset, height_mm - inset + spacing_mm))
    # What is left in the middle is gone along once.
    inset = min(width_mm, height_mm) / 2
    if width_mm >= height_mm:
        x += [x[-1], width_mm - inset]
        y += [inset, inset]
    else:
        x += [inset, inset]
        y += [y[-1], height_mm - inset]
    return np.array(x), np.array(y)


def wide(
    width_mm: float,
    height_mm: float,
    *,
    spacing_mm: float = 10.0,
    speed_mm_s: float = 60.0,
    disturbance: Disturbance | None = None,
) -> ExploringPath:
    """Go round a canvas and then inward in a spiral: Lévesque 2009, fig. 8.30.

    Parameters
    ----------
    width_mm, height_mm
        Size of the canvas.
    spacing_mm
        Distance between neighbouring turns of the spiral, 0.5 to 1000 mm.
    speed_mm_s
        Speed along the path.
    disturbance
        What keeps the path from being even; None for nothing.

    Raises
    ------
    ValueError
        If a number is out of range, or the path would be too long.
    """
    check_range("spacing", spacing_mm, 0.5, 1000, " mm")
    check_range("speed", speed_mm_s, *SPEED_BOUNDS_MM_S, " mm/s")
    x_mm, y_mm = spiral(width_mm, height_mm, spacing_mm)
    moved = np.concatenate(([True], (np.diff(x_mm) != 0) | (np.diff(y_mm) != 0)))
    x_mm, y_mm = x_mm[moved], y_mm[moved]
    along_mm = np.concatenate(([0.0], np.cumsum(np.hypot(np.diff(x_mm), np.diff(y_mm)))))
    if disturbance is None or disturbance.none:
        return ExploringPath(along_mm / speed_mm_s, x_mm, y_mm)
    return _disturbed(along_mm, x_mm, y_mm, speed_mm_s, disturbance)


def _disturbed(
    along_mm: NDArray[np.float64],
    x_mm: NDArray[np.float64],
    y_mm: NDArray[np.float64],
    speed_mm_s: float,
    how: Disturbance,
) -> ExploringPath:
    """Make a course of a path with its disturbances, in knots close together."""
    steps = _gone(float(along_mm[-1]), how)
    place = np.clip(np.cumsum(steps), 0, along_mm[-1])
    x, y = np.interp(place, along_mm, x_mm), np.interp(place, along_mm, y_mm)
    side = np.clip(np.searchsorted(along_mm, place, "right") - 1, 0, along_mm.size - 2)
    length = np.diff(along_mm)[side]
    swayed = how.sway_mm * np.sin(2 * np.pi * place / how.sway_length_mm)
    x -= swayed * (np.diff(y_mm)[side] / length)
    y += swayed * (np.diff(x_mm)[side] / length)
    left, top = x_mm.min(), y_mm.min()
    x, y = np.clip(x, left, x_mm.max()), np.clip(y, top, y_mm.max())
    # The time that each step takes at the speed of its moment: ds / v, with v as at an even pace.
    even_s = np.cumsum(np.abs(steps)) / speed_mm_s
    speed = 1 + how.speed_change * np.sin(2 * np.pi * even_s / how.speed_period_s)
    t_s = np.cumsum(np.abs(steps) / (speed_mm_s * speed))
    return ExploringPath(t_s - t_s[0], x, y)


def _gone(length_mm: float, how: Disturbance) -> NDArray[np.float64]:
    """Steps along a path, forward and back; float64[n], the first of which leads to its start."""
    back = round(how.back_mm / _STEP_MM)
    forth = max(round(how.back_every_mm / _STEP_MM), 1)
    whole = math.ceil(length_mm / _STEP_MM)
    if back:
        cycle = np.concatenate((np.full(forth, _STEP_MM), np.full(back, -_STEP_MM)))
        steps = np.tile(cycle, math.ceil(whole / (forth - back)))
        steps = steps[: int(np.argmax(np.cumsum(steps) >= length_mm)) + 1 or steps.size]
    else:
        steps = np.full(whole, _STEP_MM)
    if steps.size > _MOST_KNOTS:
        raise ValueError("the path is too long; take a larger spacing")
    return np.concatenate(([0.0], steps))


def spot(
    x_mm: float,
    y_mm: float,
    *,
    radius_mm: float = 5.0,
    speed_mm_s: float = 60.0,
    duration_s: float = 10.0,
) -> ExploringPath:
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
    check_range("radius", radius_mm, 0.1, 1000, " mm")
    check_range("speed", speed_mm_s, *SPEED_BOUNDS_MM_S, " mm/s")
    check_range("duration", duration_s, 0.1, 3600, " s")
    rate = speed_mm_s / (radius_mm * math.hypot(1, _RATIO))
    t_s = np.arange(0, duration_s + _SWING_S / 2, _SWING_S)
    return ExploringPath(
        t_s,
        x_mm + radius_mm * np.sin(rate * t_s),
        y_mm + radius_mm * np.sin(_RATIO * rate * t_s),
    )


@dataclass(frozen=True, slots=True)
class Explorer:
    """A hand that goes over a picture by one of these paths; a line it only crosses.

    Parameters
    ----------
    at_mm
        Place that the hand swings about; None for a hand that goes round and inward.
    spacing_mm
        Distance between neighbouring turns of the spiral.
    speed_mm_s
        Speed.

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    at_mm: tuple[float, float] | None = None
    spacing_mm: float = 10.0
    speed_mm_s: float = 60.0

    def __post_init__(self) -> None:
        check_range("spacing", self.spacing_mm, 0.5, 1000, " mm")
        for value in self.at_mm or ():
            check_range("place", value, -MOST_MM, MOST_MM, " mm")

    def read_line(self, start_mm: float, end_mm: float) -> Motion:
        """Motion along a line, to its end and back; see `vbraille.simulation.hand.Hand`."""
        way = Way(start_mm)
        way.wait(0.1)
        way.move(end_mm, self.speed_mm_s)
        way.move(start_mm, RETURN_MM_S)
        return way.motion()

    def read_page(self, area: Area) -> Motion:
        """Motion over the canvas that an area is; its lines do not matter."""
        span_mm = -area.start_mm  # an array at the left stop stands there
        if self.at_mm is not None:
            return spot(*self.at_mm, speed_mm_s=self.speed_mm_s).motion(span_mm)
        height_mm = area.lines * area.pitch_mm
        course = wide(
            area.end_mm, height_mm, spacing_mm=self.spacing_mm, speed_mm_s=self.speed_mm_s
        )
        return course.motion(span_mm)


def parse_explorer(spec: str) -> Explorer | None:
    """Hand of ``wide``, ``wide:SPACING`` or ``spot:X,Y``; None if the spec names another.

    Raises
    ------
    ValueError
        If a number is none, or out of range.
    """
    kind, _, rest = spec.partition(":")
    if kind == "wide":
        return Explorer(spacing_mm=_number(rest, "spacing")) if rest else Explorer()
    if kind == "spot":
        return Explorer(at_mm=parse_place(rest))
    return None


def parse_place(text: str) -> tuple[float, float]:
    """Place on the canvas that is written as ``X,Y``, in mm.

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
