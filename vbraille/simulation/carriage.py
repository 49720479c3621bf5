"""The carriage of a simulated controller, and the hand on it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

from vbraille.simulation.hand import Area, area_on
from vbraille.simulation.motion import APPROACH_MM_S, Course, Way
from vbraille.simulation.recorded import Recorded

if TYPE_CHECKING:
    from vbraille.display import Display
    from vbraille.simulation.hand import Hand

PAST_MARK_MM: Final = 1.0
_NS_PER_US: Final = 1000
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
    """Place of a carriage: how far from its left stop and its far one, and how far turned."""

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
    home_y_mm
        Where the carriage stands across the lines before the hand reads: at its far stop, or
        further down.
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
        home_y_mm: float = 0.0,
    ) -> None:
        self._hand = hand
        self._left_mm, self._travel_mm = -span_mm, travel_mm
        self._height_mm, self._area = height_mm, area
        self._home = self._left_mm, home_y_mm, 0.0
        self._course = Course(*self._home, free_y=height_mm > 0, turns=turns)
        self._waits, self._reads = True, False

    def at(self, now_us: int) -> CarriageAt:
        """Place of the carriage, on the axes that it has; time must not go back."""
        now_ns = now_us * _NS_PER_US
        if self._reads and self._course.is_over(now_ns):
            self._read(now_ns)
        x_mm, y_mm, theta_rad = self._course.at(now_ns)
        return CarriageAt(
            min(max(x_mm - self._left_mm, 0.0), self._travel_mm),
            min(max(y_mm, 0.0), self._height_mm),
            theta_rad,
        )

    def set_out(self) -> None:
        """Have the hand read when it has done what it is doing; it may be reading already."""
        if self._waits:
            self._waits, self._reads = False, True

    def cross(self, mark_mm: float, now_us: int) -> None:
        """Move over the encoder's mark and back to the stop."""
        now_ns = now_us * _NS_PER_US
        if self._course.is_over(now_ns):
            way = Way(self._course.at(now_ns)[0])
            way.move(self._left_mm + mark_mm + PAST_MARK_MM, APPROACH_MM_S)
            way.move(self._left_mm, APPROACH_MM_S)
            self._course.follow(way.motion(), now_ns)

    def go_back(self, now_us: int) -> None:
        """Move to where it stood at first, straighten the array, and wait for the next order."""
        self._course.go_to(self._home, now_us * _NS_PER_US)
        self._waits, self._reads = True, False

    def _read(self, now_ns: int) -> None:
        """Have the hand read once more; a recorded one reads once."""
        if isinstance(self._hand, Recorded):
            self._reads = False
            motion = self._hand.motion()
        elif self._area is not None:
            motion = self._hand.read_page(self._area)
        else:
            motion = self._hand.read_line(self._left_mm, self._left_mm + self._travel_mm)
        self._course.follow(motion, now_ns)
