"""Autoscroll: lines that come by themselves, at a speed that the reader sets while reading."""

from __future__ import annotations

import math
from typing import Final

from vbraille.errors import check_range

USUAL_CELLS_S: Final = 8.0
SLOWEST_CELLS_S: Final = 1.0
FASTEST_CELLS_S: Final = 30.0
STEP: Final = 1.2  # from a speed to the next faster one


class Scroll:
    """Time that a line is given by its number of cells, whatever the hand does.

    Parameters
    ----------
    speed_cells_s
        Cells a second, 1 to 30.

    Attributes
    ----------
    on : bool
        Whether lines come by themselves.

    Raises
    ------
    ValueError
        If the speed is out of range.
    """

    def __init__(self, speed_cells_s: float = USUAL_CELLS_S) -> None:
        check_range(
            "autoscroll", speed_cells_s, SLOWEST_CELLS_S, FASTEST_CELLS_S, " cells a second"
        )
        self.on = False
        # Steps from the usual speed: counted, so that as many back lead to the same speed.
        self._steps = math.log(speed_cells_s / USUAL_CELLS_S, STEP)
        self._passed = 0.0  # cells of the line for which the time is over
        self._till_s: float | None = None  # when that was so

    @property
    def speed_cells_s(self) -> float:
        """Speed in cells a second, 1 to 30."""
        speed = USUAL_CELLS_S * STEP**self._steps
        return round(min(max(speed, SLOWEST_CELLS_S), FASTEST_CELLS_S), 1)

    @property
    def sentence(self) -> str:
        """Sentence that says the speed."""
        speed = self.speed_cells_s
        return f"autoscroll: {speed:g} {'cell' if speed == 1 else 'cells'} a second"

    def faster(self) -> bool:
        """Turn the speed up by a fifth; False if it is the fastest already."""
        return self._turn(1)

    def slower(self) -> bool:
        """Turn the speed down by as much as `faster` turns it up; False if it is the slowest."""
        return self._turn(-1)

    def begin(self, now_s: float) -> None:
        """Note that a line has come under the hand, by a clock in seconds that does not go back."""
        self._passed = 0.0
        self._till_s = now_s

    def hold(self, now_s: float) -> None:
        """Note that the time since the last call does not count, as in a pause."""
        self._till_s = now_s

    def due(self, line_cells: int, now_s: float) -> bool:
        """Whether the time of the line is over; call it again and again, as speeds may change.

        Parameters
        ----------
        line_cells
            Number of cells in the line; an empty line has the time of one cell.
        now_s
            Time by the same clock as in `begin`.
        """
        if not self.on:
            self._till_s = now_s
            return False
        if self._till_s is not None:
            self._passed += (now_s - self._till_s) * self.speed_cells_s
        self._till_s = now_s
        return self._passed >= max(line_cells, 1)

    def _turn(self, steps: int) -> bool:
        before = self.speed_cells_s
        self._steps += steps
        if self.speed_cells_s == before:
            self._steps -= steps
            return False
        return True
