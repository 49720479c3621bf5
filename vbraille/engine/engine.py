"""Every engine: a loop that drives a device, in a process of its own or in this one.

What its records tell stands here, too: where the array is, whether a line was read to its end, and
whether the array is turned.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Protocol

import numpy as np

from vbraille.devices.events import Placing
from vbraille.engine.record import Flag
from vbraille.render.braille.style import MOST_TILT_RAD

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from vbraille.devices.events import Event
    from vbraille.display import Display
    from vbraille.engine.record import Tally
    from vbraille.render.program import Program


HOME_MM = 1.0


class Engine(Protocol):
    """A loop with its device, as seen by a caller that gives it lines to show and watches it."""

    @property
    def display(self) -> Display:
        """The actuators and the carriage of the device."""
        ...

    @property
    def tally(self) -> Tally:
        """Counts of what the loop has done, up to the last poll."""
        ...

    @property
    def x_mm(self) -> float | None:
        """Place of the array's centre at the last poll; None before it is known."""
        ...

    @property
    def paused(self) -> bool:
        """Tell whether the array is to rest; setting it takes effect with the next tick."""
        ...

    @paused.setter
    def paused(self, paused: bool) -> None: ...

    @property
    def switches(self) -> int:
        """States of a scene's switches, as `vbraille.scene.signals.packed` has them."""
        ...

    @switches.setter
    def switches(self, switches: int) -> None: ...

    def show(self, picture: Program, line: int) -> None:
        """Put a picture of a line under the hand.

        Parameters
        ----------
        picture
            Picture that is shown.
        line
            Number of the line in the records, from 1.
        """
        ...

    def poll(self) -> NDArray[np.void]:
        """Take the records of all ticks since the last poll.

        Returns
        -------
        record[n]
            Records of `vbraille.engine.record.tick_dtype`, oldest first.

        Raises
        ------
        VbrailleError
            If the loop has ended by itself.
        """
        ...

    def take_events(self) -> Sequence[Event]:
        """Take the events of the device and the engine since the last call."""
        ...

    def set_zero(self) -> None:
        """Say that the carriage is at the left stop now."""
        ...


def place_of(tick: np.void | None) -> float | None:
    """Tell where the array's centre was in a record; None if that was not known."""
    if tick is None or math.isnan(tick["x_mm"]):
        return None
    return float(tick["x_mm"])


def placing_of(tick: np.void | None) -> Placing:
    """Tell how the device was waiting to be shown its place, from a record."""
    flags = 0 if tick is None else int(tick["flags"])
    if flags & Flag.STOP:
        return Placing.STOP
    return Placing.MARK if flags & Flag.MARK else Placing.DONE


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
