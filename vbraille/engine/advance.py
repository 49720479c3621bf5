"""When a hand is done with a line: it reached the end and came back."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

HOME_MM = 1.0


class EndOfLine:
    """Watches a hand read a line, and knows when it has read all of it.

    The hand has reached the line's end when the array's centre passes the last
    dot, and is done when the array is then back at the left stop, to a
    millimetre.

    Parameters
    ----------
    span_mm
        Distance from the array's left column to its right one.
    end_mm
        Right edge of the line's last dot.
    """

    def __init__(self, span_mm: float, end_mm: float) -> None:
        self.reached = False
        self._end_mm = end_mm
        self._home_mm = HOME_MM - span_mm / 2

    def find(self, x_mm: NDArray[np.float64]) -> int | None:
        """Find the first of these places, float64[n], that ends the line; None if none does."""
        start = 0
        if not self.reached:
            at_end = np.flatnonzero(x_mm >= self._end_mm)
            if not at_end.size:
                return None
            self.reached = True
            start = int(at_end[0])
        home = np.flatnonzero(x_mm[start:] <= self._home_mm)
        return start + int(home[0]) if home.size else None
