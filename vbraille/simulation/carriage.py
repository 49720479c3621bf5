"""The carriage of a simulated controller, and the hand on it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from vbraille.simulation.motion import Motion, Way
from vbraille.simulation.recorded import Recorded

if TYPE_CHECKING:
    from vbraille.simulation.hand import Hand

# Speed of a hand that moves without reading.
APPROACH_MM_S: Final = 250.0
PAST_MARK_MM: Final = 1.0


class Carriage:
    """A carriage at the left stop, and the hand that moves it when it is told to.

    Parameters
    ----------
    hand
        Hand that reads lines as wide as the travel, one after the other; a recorded hand reads
        once.
    span_mm, travel_mm
        Width of the array, and how far the carriage can move.
    """

    def __init__(self, hand: Hand | Recorded, span_mm: float, travel_mm: float) -> None:
        self._hand = hand
        self._left_mm, self._travel_mm = -span_mm, travel_mm
        self._motion: Motion | None = None
        self._begun_us = 0
        self._x_mm = self._left_mm
        self._waits, self._reads = True, False

    def way_mm(self, now_us: int) -> float:
        """Distance of the carriage from the left stop; time must not go back."""
        if self._motion is not None:
            time_s = (now_us - self._begun_us) / 1e6
            self._x_mm = float(np.interp(time_s, self._motion.t_s, self._motion.x_mm))
            if time_s >= self._motion.duration_s:
                self._motion = None
        if self._motion is None and self._reads:
            self._motion, self._begun_us = self._read(), now_us
        return min(max(self._x_mm - self._left_mm, 0.0), self._travel_mm)

    def set_out(self) -> None:
        """Have the hand read when it has done what it is doing; it may be reading already."""
        if self._waits:
            self._waits, self._reads = False, True

    def cross(self, mark_mm: float, now_us: int) -> None:
        """Move over the encoder's mark and back to the stop."""
        if self._motion is None:
            way = Way(self._x_mm)
            way.move(self._left_mm + mark_mm + PAST_MARK_MM, APPROACH_MM_S)
            way.move(self._left_mm, APPROACH_MM_S)
            self._motion, self._begun_us = way.motion(), now_us

    def go_back(self, now_us: int) -> None:
        """Move to the left stop, and wait there for the next order."""
        self.way_mm(now_us)
        self._motion = None
        if self._x_mm != self._left_mm:
            way = Way(self._x_mm)
            way.move(self._left_mm, APPROACH_MM_S)
            self._motion, self._begun_us = way.motion(), now_us
        self._waits, self._reads = True, False

    def _read(self) -> Motion:
        if not isinstance(self._hand, Recorded):
            return self._hand.read_line(self._left_mm, self._left_mm + self._travel_mm)
        self._reads = False
        motion = self._hand.motion()
        approach_s = abs(motion.x_mm[0] - self._x_mm) / APPROACH_MM_S
        if approach_s == 0:
            return motion
        return Motion(
            np.concatenate(([0.0], motion.t_s + approach_s)),
            np.concatenate(([self._x_mm], motion.x_mm)),
        )
