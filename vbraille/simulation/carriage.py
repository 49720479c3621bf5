"""The carriage of a simulated controller, and the hand on it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from vbraille.simulation.motion import Way
from vbraille.simulation.paging import Area, area_on
from vbraille.simulation.recorded import Recorded

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from vbraille.display import Display
    from vbraille.simulation.hand import Hand
    from vbraille.simulation.motion import Motion

# Speed of a hand that moves without reading.
APPROACH_MM_S: Final = 250.0
TURN_RAD_S: Final = 2 * math.pi
PAST_MARK_MM: Final = 1.0
# What a page keeps free below its last line, in line pitches, for a finger that goes on from there.
BELOW_PITCHES: Final = 0.225


def area_of(display: Display, pitch_mm: float) -> Area | None:
    """Lines that fill the surface of a display; None if its carriage has one axis."""
    if not display.height_mm:
        return None
    lines = max(int(display.height_mm / pitch_mm - BELOW_PITCHES), 1)
    right_mm = display.travel_mm - display.span_mm
    return area_on(display.height_mm, lines, pitch_mm, -display.span_mm, right_mm)


class CarriageAt(NamedTuple):
    """Where a carriage is: how far from its left stop and its far one, and how far turned."""

    way_mm: float
    y_mm: float = 0.0
    theta_rad: float = 0.0


class Carriage:
    """A carriage at its left stop, and its far one, and the hand that moves it when it is told to.

    Parameters
    ----------
    hand
        Hand that reads lines as wide as the travel, one after the other, or a page again and again;
        a recorded hand reads once.
    span_mm, travel_mm
        Width of the array, and how far the carriage can move.
    height_mm
        How far the carriage can move across the lines; 0 if it has one axis.
    turns
        Whether the carriage measures how far the array is turned.
    area
        Lines of a page, on a carriage of two axes; None where single lines are read.
    """

    def __init__(
        self,
        hand: Hand | Recorded,
        span_mm: float,
        travel_mm: float,
        *,
        height_mm: float = 0.0,
        turns: bool = False,
        area: Area | None = None,
    ) -> None:
        self._hand = hand
        self._left_mm, self._travel_mm = -span_mm, travel_mm
        self._height_mm, self._turns, self._area = height_mm, turns, area
        # Places at these times: x as in `Motion`, y and θ; None while nothing is under way.
        self._t_s: NDArray[np.float64] = np.zeros(1)
        self._ways: list[NDArray[np.float64]] | None = None
        self._begun_us = 0
        self._at: tuple[float, ...] = (self._left_mm, 0.0, 0.0)
        self._waits, self._reads = True, False

    def at(self, now_us: int) -> CarriageAt:
        """Place of the carriage, on the axes that it has; time must not go back."""
        if self._ways is not None:
            time_s = (now_us - self._begun_us) / 1e6
            self._at = self._place(time_s)
            if time_s >= self._t_s[-1]:
                self._ways = None
        if self._ways is None and self._reads:
            self._read(now_us)
        x_mm, y_mm, theta_rad = self._at
        return CarriageAt(
            min(max(x_mm - self._left_mm, 0.0), self._travel_mm),
            min(max(y_mm, 0.0), self._height_mm),
            theta_rad if self._turns else 0.0,
        )

    def set_out(self) -> None:
        """Have the hand read when it has done what it is doing; it may be reading already."""
        if self._waits:
            self._waits, self._reads = False, True

    def cross(self, mark_mm: float, now_us: int) -> None:
        """Move over the encoder's mark and back to the stop."""
        if self._ways is None:
            way = Way(self._at[0])
            way.move(self._left_mm + mark_mm + PAST_MARK_MM, APPROACH_MM_S)
            way.move(self._left_mm, APPROACH_MM_S)
            self._move(way.motion(), now_us)

    def go_back(self, now_us: int) -> None:
        """Move to the stops, straighten the array, and wait there for the next order."""
        self.at(now_us)
        self._ways = None
        home = self._left_mm, 0.0, 0.0
        needed_s = self._needed_s(home)
        if needed_s > 0:
            self._t_s, self._begun_us = np.array([0.0, needed_s]), now_us
            self._ways = [np.array(ends) for ends in zip(self._at, home, strict=True)]
        self._waits, self._reads = True, False

    def _read(self, now_us: int) -> None:
        """Have the hand read once more; a recorded one reads once."""
        if isinstance(self._hand, Recorded):
            self._reads = False
            self._move(self._hand.motion(), now_us)
        elif self._area is not None:
            self._move(self._hand.read_page(self._area), now_us)
        else:
            line = self._hand.read_line(self._left_mm, self._left_mm + self._travel_mm)
            self._move(line, now_us)

    def _move(self, motion: Motion, now_us: int) -> None:
        """Move along a motion from now on, and first to where it begins."""
        ways = [
            np.full(motion.t_s.size, here) if way is None else way
            for here, way in zip(
                self._at, (motion.x_mm, motion.y_mm, motion.theta_rad), strict=True
            )
        ]
        needed_s = self._needed_s([float(way[0]) for way in ways])
        t_s = motion.t_s
        if needed_s > 0:
            t_s = np.concatenate(([0.0], t_s + needed_s))
            ways = [np.concatenate(([here], way)) for here, way in zip(self._at, ways, strict=True)]
        self._t_s, self._ways, self._begun_us = t_s, ways, now_us

    def _needed_s(self, to: Sequence[float]) -> float:
        """Time that the straight way to a place takes; 0 if the carriage is there."""
        x_mm, y_mm, theta_rad = (abs(end - here) for here, end in zip(self._at, to, strict=True))
        way_mm = math.hypot(x_mm, y_mm if self._height_mm else 0.0)
        return max(way_mm / APPROACH_MM_S, theta_rad / TURN_RAD_S if self._turns else 0.0)

    def _place(self, time_s: float) -> tuple[float, ...]:
        assert self._ways is not None
        return tuple(float(np.interp(time_s, self._t_s, way)) for way in self._ways)
