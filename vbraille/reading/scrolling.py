"""Autoscroll: lines that come by themselves, at a speed that the reader sets while reading."""

from __future__ import annotations

import math
from typing import Final

from vbraille.errors import check_range

USUAL_CELLS_S: Final = 8.0
SLOWEST_CELLS_S: Final = 1.0
FASTEST_CELLS_S: Final = 30.0
STEP: Final = 1.2  # from a speed to the next faster one


# Time between two looks that counts; a longer one was a pause, in which nothing was read.
_MOST_S: Final = 0.25


class Scroll:
    """Time that a line is given by its number of cells, whatever the hand does.

    Parameters
    ----------
    speed_cells_s
        Cells a second, 1 to 30.

    Raises
    ------
    ValueError
        If the speed is out of range.
    """

    def __init__(self, speed_cells_s: float = USUAL_CELLS_S) -> None:
        check_range(
            "autoscroll", speed_cells_s, SLOWEST_CELLS_S, FASTEST_CELLS_S, " cells a second"
        )
        # Steps from the usual speed: counted, so that as many back lead to the same speed.
        self._steps = math.log(speed_cells_s / USUAL_CELLS_S, STEP)
        self._on = False
        self._passed = 0.0  # cells of the line for which the time is over
        self._till_s: float | None = None  # when that was so

    @property
    def on(self) -> bool:
        """Whether lines come by themselves; the present line has all its time once that is set."""
        return self._on

    @on.setter
    def on(self, on: bool) -> None:
        if on and not self._on:
            self._passed, self._till_s = 0.0, None
        self._on = on

    @property
    def speed_cells_s(self) -> float:
        """Speed in cells a second, 1 to 30."""
        speed = USUAL_CELLS_S * STEP**self._steps
        return round(min(max(speed, SLOWEST_CELLS_S), FASTEST_CELLS_S), 1)

    @property
    def sentence(self) -> str:
        """Sentence that says the speed."""
        return f"autoscroll: {self._words}"

    def faster(self) -> str:
        """Turn the speed up by a fifth; give words for it, with "the fastest" if it cannot be."""
        return self._turn(1, "the fastest")

    def slower(self) -> str:
        """Turn the speed down by as much as `faster` turns it up; give words for it likewise."""
        return self._turn(-1, "the slowest")

    def begin(self, now_s: float) -> None:
        """Note that a line has come under the hand, by a clock in seconds that does not go back."""
        self._passed = 0.0
        self._till_s = now_s

    def due(self, line_cells: int, now_s: float) -> bool:
        """Whether the time of the line is over; if so, that of the next line begins.

        Call it again and again, as the speed may change: that counts at once for the present line.
        Time in which it is not called, as in a pause, does not count.

        Parameters
        ----------
        line_cells
            Number of cells in the line; an empty line has the time of one cell.
        now_s
            Time by the same clock as in `begin`.
        """
        if not self._on:
            return False
        since_s = 0.0 if self._till_s is None else now_s - self._till_s
        self._till_s = now_s
        if since_s <= _MOST_S:
            self._passed += since_s * self.speed_cells_s
        if self._passed < max(line_cells, 1):
            return False
        self.begin(now_s)
        return True

    @property
    def _words(self) -> str:
        speed = self.speed_cells_s
        return f"{speed:g} {'cell' if speed == 1 else 'cells'} a second"

    def _turn(self, steps: int, bound: str) -> str:
        before = self.speed_cells_s
        self._steps += steps
        if self.speed_cells_s == before:
            self._steps -= steps
            return f"{self._words}, {bound}"
        return self._words
