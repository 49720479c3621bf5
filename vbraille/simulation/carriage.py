"""The carriage of a simulated device, with its stops, and the hand on it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from vbraille.simulation.motion import Course
from vbraille.simulation.steering import Area

if TYPE_CHECKING:
    from vbraille.display import Display
    from vbraille.simulation.hand import Hand

# What a page keeps free below its last line, in line pitches, for a finger that goes on from there.
BELOW_PITCHES: Final = 0.225


def area_of(display: Display, pitch_mm: float, lines: int = 0) -> Area | None:
    """Return the area of lines on a display, as many as fit; None if its carriage has one axis.

    Its foot is the lower edge of what the carriage reaches: a hand that is not told how much of a
    page there is goes down there when it has read these lines.
    """
    if not display.height_mm:
        return None
    lines = lines or max(int(display.height_mm / pitch_mm - BELOW_PITCHES), 1)
    foot_mm = max(display.height_mm - lines * pitch_mm, 0.0)
    right_mm = display.travel_mm - display.span_mm
    return Area(lines, pitch_mm, right_mm, foot_mm, -display.span_mm)


class Carriage:
    """A carriage at its left stop, and its far one, and the hand that moves it when it is told to.

    Parameters
    ----------
    display
        What the carriage carries, and how far it moves.
    hand
        Hand that reads lines as wide as the travel, one after the other, or a page again and again;
        a recorded hand reads once. None if other orders move it.
    area
        Lines of a page, on a carriage of two axes; None where single lines are read.
    home_y_mm
        Where the carriage stands across the lines before the hand reads: at its far stop, or
        further down.
    now_ns
        Time at which it stands there.

    Attributes
    ----------
    course : Course
        Where the hand goes; the carriage follows it as far as its stops.
    """

    def __init__(
        self,
        display: Display,
        hand: Hand | None,
        area: Area | None = None,
        home_y_mm: float = 0.0,
        now_ns: int = 0,
    ) -> None:
        self._display, self._hand, self._area = display, hand, area
        self._home = -display.span_mm, home_y_mm, 0.0
        self.course = Course(display, self._home, now_ns)
        self._waits, self._reads = True, False

    def at(self, now_ns: int) -> tuple[Any, Any, Any]:
        """Return the place of the carriage, as `places_at`, after what the hand does by then.

        Time must not go back.
        """
        if self._reads and self.course.is_over(now_ns):
            self._read(now_ns)
        return self.places_at(now_ns)

    def places_at(self, times_ns: Any) -> tuple[Any, Any, Any]:
        """Return how far it is from its left stop and its far one, and turned, at each time."""
        x_mm, y_mm, theta_rad = self.course.at(times_ns)
        display = self._display
        way_mm = np.minimum(np.maximum(x_mm + display.span_mm, 0.0), display.travel_mm)
        return way_mm, np.minimum(np.maximum(y_mm, 0.0), display.height_mm), theta_rad

    def set_out(self) -> None:
        """Have the hand read when it has done what it is doing; it may be reading already."""
        if self._waits:
            self._waits, self._reads = False, True

    def stop(self) -> None:
        """Have the hand read no more by itself: it is told what to read."""
        self._waits = self._reads = False

    def go_back(self, now_ns: int) -> None:
        """Move to where it stood at first, straighten the array, and wait for the next order."""
        self.course.go_to(self._home, now_ns)
        self._waits, self._reads = True, False

    def _read(self, now_ns: int) -> None:
        """Have the hand read once more; a recorded one reads once."""
        left_mm, hand, area = -self._display.span_mm, self._hand, self._area
        if hand is None:
            return
        self._reads = not hand.goes_on
        if area is None:
            motion = hand.read_line(left_mm, left_mm + self._display.travel_mm)
        else:
            motion = hand.read_page(area)
            if motion.y_mm is None:  # it reads the first line
                motion = replace(motion, y_mm=np.full(motion.t_s.size, area.middle_mm(0)))
        self.course.follow(motion, now_ns)
