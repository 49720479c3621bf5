"""Watchers of ticks: whether a line was read to its end, and whether the array is turned."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from vbraille.engine.record import Flag
from vbraille.render.braille.straying import MOST_TILT_RAD

if TYPE_CHECKING:
    from collections.abc import Iterator

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


# This is a plain number because numpy, when it reads an enumeration, can swallow an exception that
# a signal raises.
_TURNED = int(Flag.TURNED)


class Upright:
    """Watches which way the array is turned."""

    def __init__(self) -> None:
        self._turned = False

    def watch(self, tick: np.void) -> Iterator[str]:
        """Sentences to be said after a tick."""
        turned = bool(int(tick["flags"]) & _TURNED)
        if turned is self._turned:
            return
        self._turned = turned
        most = math.degrees(MOST_TILT_RAD)
        if not turned:
            yield "upright: braille is felt again"
            return
        theta = math.degrees(float(tick["theta_rad"]))
        right = "left" if theta < 0 else "right"  # against the clock it is turned if positive
        yield (
            f"turned: the array is turned by {abs(theta):.0f} degrees, and braille is felt up to "
            f"{most:.0f}; turn it back to the {right}"
        )
