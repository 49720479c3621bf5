"""Every engine watches its ticks: where the array is, what was read, and what can be felt.

An engine is a loop that drives a device: in a process of its own (`vbraille.engine.host.Host`), or
in this one (`vbraille.engine.loop.LocalEngine`). Both have the same members.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from vbraille.devices.events import AtStart, FeltAgain, LineRead, Placing, Turned, Unfelt
from vbraille.engine.record import Flag, Tally
from vbraille.render.braille.style import MOST_TILT_RAD

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.devices.events import Event
    from vbraille.display import Display

HOME_MM = 1.0
# Plain numbers, since numpy, when it reads an enumeration, can swallow what a signal raises.
_TURNED, _UNFELT, _PAUSED = int(Flag.TURNED), int(Flag.UNFELT), int(Flag.PAUSED)
_STOP = int(Flag.STOP)
AWAY = int(Flag.SILENT | Flag.STOP | Flag.HELD | Flag.TURNED)
WHY = {
    int(Flag.SILENT): "the device is silent",
    _STOP: "the device does not know where its carriage is",
    int(Flag.HELD | Flag.RESTED): "the array went to rest by itself",
    _TURNED: "the array is turned too far",
}


def placing_of(tick: np.void | None) -> Placing:
    """Tell whether the device was waiting to be shown its place, from a record."""
    return Placing(tick is not None and bool(tick["flags"] & _STOP))


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


class Watcher:
    """Finds in records of ticks what callers wait for, and tells it as events.

    Attributes
    ----------
    newest : record or None
        The newest record; None before the first.
    ready : bool
        Whether the device works, and the array was at the left in the ticks last watched.
    """

    def __init__(self) -> None:
        self.newest: np.void | None = None
        self.ready = False
        self._line = 0
        self._end: EndOfLine | None = None
        self._unfelt = self._turned = self._at_left = False
        self._found: list[Event] = []

    @property
    def tally(self) -> Tally:
        """Counts of what the loop has done since the last start, up to the last poll."""
        return Tally() if self.newest is None else Tally.of(self.newest)

    @property
    def x_mm(self) -> float | None:
        """Place of the array's centre along x in the newest record; None if it is not known."""
        if self.newest is None or math.isnan(self.newest["x_mm"]):
            return None
        return float(self.newest["x_mm"])

    def wait_for(self, line: int, end_mm: float | None, display: Display) -> None:
        """Find the end of a line, whose last dot ends there; None for what ends nowhere."""
        self._line = line
        self._end = None if end_mm is None else EndOfLine(display.span_mm, end_mm)

    def watch(self, ticks: NDArray[np.void], display: Display) -> None:
        """Look at records, oldest first."""
        if not ticks.size:
            return
        flags = ticks["flags"]
        well = flags & AWAY == 0
        at_left = well & (ticks["x_mm"] <= HOME_MM - display.span_mm / 2)
        # A carriage that a machine moves may be at the left for a few ticks only.
        self.ready = bool(well[-1] and at_left.any())
        if at_left.any() and not self._at_left:
            self._found.append(AtStart(*_when(ticks[int(at_left.argmax())])))
        self._at_left = bool(at_left[-1])
        self._watch_feeling(ticks)
        if self._end is not None:
            shown = ticks[(ticks["line"] == self._line) & (flags & (_UNFELT | _PAUSED) == 0)]
            found = self._end.find(shown["x_mm"])
            if found is not None:
                self._end = None
                self._found.append(LineRead(self._line, *_when(shown[found])))
        self.newest = ticks[-1]

    def _watch_feeling(self, ticks: NDArray[np.void]) -> None:
        """Tell where what is shown is felt no more, or again, and whether the array is turned."""
        before = ticks[0]["tick"] - 1 if self.newest is None else self.newest["tick"]
        lost = np.diff(ticks["tick"], prepend=before) != 1
        unfelt = (ticks["flags"] & _UNFELT != 0) | lost
        changes = np.flatnonzero(np.diff(unfelt, prepend=self._unfelt))
        for at in sorted({*changes[:1].tolist(), *changes[-1:].tolist()}):
            tick, when = ticks[int(at)], _when(ticks[int(at)])
            said = (why for flags, why in WHY.items() if int(tick["flags"]) & flags)
            why = "ticks were lost" if lost[at] else next(said, "the array is at rest")
            self._found.append(Unfelt(why, *when) if unfelt[at] else FeltAgain(*when))
        self._unfelt = bool(unfelt[-1])
        turned = bool(ticks[-1]["flags"] & _TURNED)
        if turned is not self._turned:
            self._turned = turned
            degrees = math.degrees(float(ticks[-1]["theta_rad"])) if turned else 0.0
            self._found.append(Turned(degrees, math.degrees(MOST_TILT_RAD)))

    def _take_found(self) -> list[Event]:
        found, self._found = self._found, []
        return found


def _when(tick: np.void) -> tuple[int, int]:
    return int(tick["tick"]), int(tick["time_ns"])
