"""Hands that move along a line, and from line to line: sweeping, still, or as people read.

A made-up hand says by where it goes that it is done with a line: it touches
the end once, as the last thing before it returns to the start. Reading again,
it turns round short of both.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vbraille.errors import check_range
from vbraille.simulation.motion import MOST_MM, RETURN_MM_S, SPEED_BOUNDS_MM_S, Motion, Way

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from vbraille.simulation.steering import Area

# All ours. A finger drifts by less than what would bring the next line under the array's centre:
# half a pitch, or three quarters of it with a hysteresis of a quarter.
DRIFT_PITCHES = 0.15
TILT_RAD = math.radians(5.0)
_PERIODS_S = (3.0, 9.0)
_SHARES = (0.5, 0.3, 0.2)  # shares of the waves that make up a drift; their sum is 1
FOOT_S = 0.8  # how long a hand stays below a page, which is longer than the program waits for
_KNOTS_S = 0.02  # time between knots, short enough that straight lines between them look smooth
EMPTY_LINE_S = 0.25
STILL_S = 1e9  # which no reading lasts
# Unless it is done, a hand comes no nearer to the start once it has left it, and turns no nearer to
# the end. More than 1 mm, since the program takes "reached the end, then within 1 mm of the
# start" for the end of a line: this is what tells reading again from being done.
CLEAR_MM = 1.25
TURN_SHORT = (0.01, 0.10)  # passes but the last turn round at 90 to 99 % of the way
SLOW_BACK_CHANCE = 0.3  # of feeling the line on the way back too, before reading it again
LEAST_REREAD_MM = CLEAR_MM / TURN_SHORT[1]  # on a shorter line there is no room: one pass
LEAST_MOVE_MM = 0.05  # a shorter rest of a way is gone in the same movement
RESCANS_MM = (11.0, 22.0)  # a cell or two of both devices (10.48 and 11.1 mm)


def read_lines(read_line: Callable[[float, float], Motion], area: Area) -> Motion:
    """Return a motion over a page: along each line and back, down to the next, then to the foot.

    Parameters
    ----------
    read_line
        Function that gives the motion along the next line and back, as in `Hand`.
    area
        Area that the lines take.
    """
    knots, begun_s = [], 0.0  # times and places x and y
    for line in range(area.lines):
        motion = read_line(area.start_mm, area.end_mm)
        y_mm = np.full(motion.t_s.size, area.middle_mm(line))
        knots.append((begun_s + motion.t_s, motion.x_mm, y_mm))
        begun_s += motion.duration_s + area.pitch_mm / RETURN_MM_S
    if area.foot_mm:
        down_s = knots[-1][0][-1] + (area.pitch_mm / 2 + area.foot_mm) / RETURN_MM_S
        foot_mm = np.full(2, area.height_mm + area.foot_mm)
        knots.append((down_s + np.array([0.0, FOOT_S]), np.full(2, area.start_mm), foot_mm))
    return Motion(*np.concatenate(knots, axis=1))


def drifting(
    motion: Motion, random: np.random.Generator, most_mm: float, tilt_rad: float
) -> Motion:
    """Return a motion over a page that drifts along y and turns, slowly and within two bounds."""
    assert motion.y_mm is not None, "a page has lines"
    t_s = np.union1d(motion.t_s, np.arange(0.0, motion.duration_s, _KNOTS_S))
    x_mm, y_mm = (np.interp(t_s, motion.t_s, way) for way in (motion.x_mm, motion.y_mm))
    strayed_mm, theta_rad = most_mm * _wave(t_s, random), tilt_rad * _wave(t_s, random)
    return Motion(t_s, x_mm, y_mm + strayed_mm, theta_rad)


def _wave(t_s: NDArray[np.float64], random: np.random.Generator) -> NDArray[np.float64]:
    """Return a slow wave between -1 and 1, drawn at random."""
    periods_s, phases = (random.uniform(*ends, len(_SHARES)) for ends in (_PERIODS_S, (0, 1)))
    return np.sin(2 * math.pi * (t_s[:, None] / periods_s + phases)) @ _SHARES


class Hand(ABC):
    """A hand that reads line after line, or a page.

    Attributes
    ----------
    goes_on : bool
        Whether its one motion is that over a whole reading, and not over a line or a page.
    """

    goes_on = False

    @abstractmethod
    def read_line(self, start_mm: float, end_mm: float) -> Motion:
        """Read the next line: from its start, where the hand is, to its end and back.

        In between it never leaves the line. For an empty line, where start is end, it waits a
        little.

        Raises
        ------
        ValueError
            If a place is beyond `MOST_MM`, or the end is left of the start.
        """

    def read_page(self, area: Area) -> Motion:
        """Read all lines of a page, from the first to the last; y and θ are given if they change.

        Raises
        ------
        ValueError
            In the cases in which `read_line` raises it.
        """
        return read_lines(self.read_line, area)


def along(start_mm: float, end_mm: float) -> Way:
    """Return a way that begins at the start of a line, after a check of the line's places."""
    if not -MOST_MM <= start_mm <= end_mm <= MOST_MM:
        raise ValueError(
            f"a line is from {start_mm:g} to {end_mm:g} mm; "
            f"it must go right, within {-MOST_MM:g} to {MOST_MM:g} mm"
        )
    return Way(start_mm)


@dataclass(frozen=True, slots=True)
class Sweep(Hand):
    """A hand at constant speed, which comes back at `RETURN_MM_S`.

    Parameters
    ----------
    speed_mm_s
        Speed to the right.

    Raises
    ------
    ValueError
        If the speed is out of `SPEED_BOUNDS_MM_S`.
    """

    speed_mm_s: float

    def __post_init__(self) -> None:
        check_range("sweep speed", self.speed_mm_s, *SPEED_BOUNDS_MM_S, " mm/s")

    def read_line(self, start_mm: float, end_mm: float) -> Motion:
        """Return the motion along the next line; see `Hand`."""
        way = along(start_mm, end_mm)
        if start_mm == end_mm:
            way.wait(EMPTY_LINE_S)
        way.move(end_mm, self.speed_mm_s)
        way.move(start_mm, RETURN_MM_S)
        return way.motion()


class Still(Hand):
    """A hand that stays where it is, until a person moves it in the live view."""

    def read_line(self, start_mm: float, end_mm: float) -> Motion:
        """Return a motion that stays at the start of a line; see `Hand`."""
        way = along(start_mm, end_mm)
        way.wait(STILL_S)
        return way.motion()


@dataclass(frozen=True, slots=True)
class Habits:
    """Habits of a reader, who reads in movements of constant speed, one after the other.

    A pair has the two bounds between which a value is drawn evenly. Each chance is that of
    something to happen after a movement to the right.

    Parameters
    ----------
    speed_mm_s
        Median over time of the speed to the right.
    spread
        Standard deviation of the natural logarithm of the speed.
    speed_bounds_mm_s
        Slowest and fastest speed of any movement but a quick return.
    movement_s
        Duration of a movement.
    pause_s
        Duration of standing still, at the end of a pass or elsewhere.
    chance
        Chance of standing still, and that of a step back of 2 to 10 mm.
    rescan_chance
        Chance of going back by `RESCANS_MM`, to feel one cell or two again.
    passes
        Number of times that a line is read.
    """

    speed_mm_s: float
    spread: float
    speed_bounds_mm_s: tuple[float, float]
    movement_s: tuple[float, float]
    pause_s: tuple[float, float]
    chance: float
    rescan_chance: float = 0.0
    passes: tuple[int, int] = (1, 1)


REGRESSION_MM = (2.0, 10.0)
# All numbers are ours. 8 mm/s is chosen after Lévesque 2009, ch. 4 (12 s for a string of 55.5 mm:
# some 5 mm/s net, the string read again and again), 24 to 69 mm/s after common measurements of
# fluent reading on paper.
DEVICE = Habits(
    speed_mm_s=8.0,
    spread=0.3,
    speed_bounds_mm_s=(3.0, 21.0),
    movement_s=(0.15, 0.5),
    pause_s=(0.2, 0.8),
    chance=0.02,
    rescan_chance=0.01,
    passes=(2, 3),
)
FLUENT = Habits(
    speed_mm_s=41.0,
    spread=0.25,
    speed_bounds_mm_s=(24.0, 69.0),
    movement_s=(0.1, 0.3),
    pause_s=(0.1, 0.3),
    chance=0.03,
)


class HumanHand(Hand):
    """A hand that reads by habits; equal seeds read equal lines in the same way.

    Parameters
    ----------
    habits
        Habits of the reader: `DEVICE`, `FLUENT`, or others.
    seed
        Seed of what is drawn at random, 0 or more.
    """

    def __init__(self, habits: Habits, seed: int = 1) -> None:
        check_range("seed", seed, 0, math.inf)
        self.habits = habits
        self._random = np.random.default_rng(seed)
        self._drifting = np.random.default_rng((seed, 1))  # lines are read alike on any carriage

    def read_line(self, start_mm: float, end_mm: float) -> Motion:
        """Return the motion along the next line; see `Hand`. Each call draws another one."""
        way = along(start_mm, end_mm)
        length_mm, passes = end_mm - start_mm, 1
        if length_mm >= LEAST_REREAD_MM:
            passes = int(self._random.integers(*self.habits.passes, endpoint=True))
        for _ in range(passes - 1):
            short_mm = length_mm * self._random.uniform(*TURN_SHORT)
            self._read(way, start_mm, end_mm - max(short_mm, CLEAR_MM))
            back_mm = start_mm + CLEAR_MM * self._random.uniform(1, 2)
            if self._random.random() < SLOW_BACK_CHANCE:
                self._go(way, back_mm)
            else:
                way.move(back_mm, RETURN_MM_S)
        self._read(way, start_mm, end_mm)
        way.move(start_mm, RETURN_MM_S)
        return way.motion()

    def read_page(self, area: Area) -> Motion:
        """Return a motion over all lines of a page, drifting a little off each; see `Hand`."""
        most_mm = DRIFT_PITCHES * area.pitch_mm
        return drifting(read_lines(self.read_line, area), self._drifting, most_mm, TILT_RAD)

    def _read(self, way: Way, start_mm: float, to_mm: float) -> None:
        """Make one pass to the right, with steps back and pauses, and pause at its end."""
        habits = self.habits
        self._step(way, to_mm)
        while way.x_mm < to_mm:
            paused, stepped, rescanned = self._random.random(3)
            if paused < habits.chance:
                self._pause(way)
            back_mm = 0.0
            if stepped < habits.chance:
                back_mm = self._random.uniform(*REGRESSION_MM)
            elif rescanned < habits.rescan_chance:
                back_mm = float(self._random.choice(RESCANS_MM))
            if way.x_mm - back_mm >= start_mm + CLEAR_MM:
                self._go(way, way.x_mm - back_mm)
            self._step(way, to_mm)
        self._pause(way)

    def _go(self, way: Way, to_mm: float) -> None:
        while way.x_mm != to_mm:
            self._step(way, to_mm)

    def _step(self, way: Way, to_mm: float) -> None:
        """Make one movement at a speed that is drawn for it."""
        habits = self.habits
        low, high = habits.speed_bounds_mm_s
        drawn = habits.speed_mm_s * math.exp(habits.spread * self._random.standard_normal())
        speed_mm_s = min(max(drawn, low), high)
        step_mm = speed_mm_s * self._random.uniform(*habits.movement_s)
        ahead_mm = to_mm - way.x_mm
        if abs(ahead_mm) - step_mm >= LEAST_MOVE_MM:
            to_mm = way.x_mm + math.copysign(step_mm, ahead_mm)
        way.move(to_mm, speed_mm_s)

    def _pause(self, way: Way) -> None:
        way.wait(self._random.uniform(*self.habits.pause_s))
