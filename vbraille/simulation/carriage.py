"""The carriage of a simulated controller, and the hand on it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

from vbraille.simulation.hand import Area, area_on
from vbraille.simulation.motion import Course
from vbraille.simulation.recorded import Recorded

if TYPE_CHECKING:
    from vbraille.display import Display
    from vbraille.simulation.hand import Hand

_NS_PER_US: Final = 1000
# What a page keeps free below its last line, in line pitches, for a finger that goes on from there.
BELOW_PITCHES: Final = 0.225


def area_of(display: Display, pitch_mm: float, lines: int = 0) -> Area | None:
    """Return the area of lines on a display, as many as fit; None if its carriage has one axis."""
    if not display.height_mm:
        return None
    lines = lines or max(int(display.height_mm / pitch_mm - BELOW_PITCHES), 1)
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
    display
        What the carriage carries, and how far it moves.
    hand
        Hand that reads lines as wide as the travel, one after the other, or a page again and again;
        a recorded hand reads once.
    area
        Lines of a page, on a carriage of two axes; None where single lines are read.
    home_y_mm
        Where the carriage stands across the lines before the hand reads: at its far stop, or
        further down.
    """

    def __init__(
        self,
        display: Display,
        hand: Hand | Recorded,
        area: Area | None = None,
        home_y_mm: float = 0.0,
    ) -> None:
        self._display, self._hand, self._area = display, hand, area
        self._home = -display.span_mm, home_y_mm, 0.0
        self._course = Course(*self._home[:2], free_y=display.height_mm > 0, turns=display.turns)
        self._waits, self._reads = True, False

    def at(self, now_us: int) -> CarriageAt:
        """Return the place of the carriage, on the axes that it has; time must not go back."""
        now_ns = now_us * _NS_PER_US
        if self._reads and self._course.is_over(now_ns):
            self._read(now_ns)
        display = self._display
        x_mm, y_mm, theta_rad = self._course.at(now_ns)
        return CarriageAt(
            min(max(x_mm + display.span_mm, 0.0), display.travel_mm),
            min(max(y_mm, 0.0), display.height_mm),
            theta_rad,
        )

    def set_out(self) -> None:
        """Have the hand read when it has done what it is doing; it may be reading already."""
        if self._waits:
            self._waits, self._reads = False, True

    def go_back(self, now_us: int) -> None:
        """Move to where it stood at first, straighten the array, and wait for the next order."""
        self._course.go_to(self._home, now_us * _NS_PER_US)
        self._waits, self._reads = True, False

    def _read(self, now_ns: int) -> None:
        """Have the hand read once more; a recorded one reads once."""
        left_mm = -self._display.span_mm
        if isinstance(self._hand, Recorded):
            self._reads = False
            motion = self._hand.motion()
        elif self._area is not None:
            motion = self._hand.read_page(self._area)
        else:
            motion = self._hand.read_line(left_mm, left_mm + self._display.travel_mm)
        self._course.follow(motion, now_ns)
