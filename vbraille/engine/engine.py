"""Every engine: a loop that drives a device, in a process of its own or in this one.

What its records tell stands here, too: where the array is, whether a line was read to its end, and
whether what is shown can be felt.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from vbraille.devices.events import AtStart, FeltAgain, LineRead, Placing, Turned, Unfelt
from vbraille.engine.record import Flag
from vbraille.render.braille.style import MOST_TILT_RAD

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from vbraille.devices.events import Event
    from vbraille.display import Display
    from vbraille.engine.record import Tally
    from vbraille.render.program import Program
    from vbraille.simulation.steering import HandOrder

HOME_MM = 1.0
# Plain numbers, since numpy, when it reads an enumeration, can swallow what a signal raises.
_TURNED, _UNFELT, _PAUSED = int(Flag.TURNED), int(Flag.UNFELT), int(Flag.PAUSED)
_AWAY = int(Flag.SILENT | Flag.MARK | Flag.STOP | Flag.HELD | Flag.TURNED)
_WHY = {
    Flag.SILENT: "the device is silent",
    Flag.MARK | Flag.STOP: "the device does not know where its carriage is",
    Flag.HELD | Flag.RESTED: "the array went to rest by itself",
    Flag.TURNED: "the array is turned too far",
}


class Engine(Protocol):
    """A loop with its device, as seen by a caller that gives it lines to show and watches it."""

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

    @property
    def display(self) -> Display:
        """The actuators and the carriage of the device."""
        ...

    @property
    def tally(self) -> Tally:
        """Counts of what the loop has done, up to the last poll."""
        ...

    @property
    def newest(self) -> np.void | None:
        """Record of the last tick polled; None before the first."""
        ...

    @property
    def x_mm(self) -> float | None:
        """Place of the array's centre at the last poll; None before it is known."""
        ...

    @property
    def ready(self) -> bool:
        """Tell whether the device works and its array was at the left at the last poll."""
        ...

    @property
    def steered(self) -> bool:
        """Tell whether a simulated hand moves the device, and takes orders."""
        ...

    @property
    def lost(self) -> int:
        """Number of ticks that were never polled."""
        ...

    @property
    def counts(self) -> Mapping[str, int]:
        """Counts of what went wrong with the device, by name; known after `close`."""
        ...

    @property
    def calibration(self) -> dict[str, Any] | None:
        """Calibration of the device's actuators; known once the device is open."""
        ...

    def start(self) -> Display:
        """Open the device and begin to drive it."""
        ...

    def show(self, picture: Program, line: int, end_mm: float | None = None) -> None:
        """Put a picture of a line under the hand.

        Parameters
        ----------
        picture
            Picture that is shown; it fades in.
        line
            Number of the line in the records, from 1.
        end_mm
            Right edge of the line's last dot; a `LineRead` event tells that the hand was there and
            is back. None for what ends nowhere.
        """
        ...

    def give(self, order: HandOrder) -> None:
        """Tell a simulated hand what to do; nothing happens where a person moves the device."""
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

    def close(self) -> None:
        """Bring the array to rest, and let the device go."""
        ...


def place_of(tick: np.void | None) -> float | None:
    """Tell where the array's centre was in a record; None if that was not known."""
    if tick is None or math.isnan(tick["x_mm"]):
        return None
    return float(tick["x_mm"])


def placing_of(tick: np.void | None) -> Placing:
    """Tell how the device was waiting to be shown its place, from a record."""
    flags = 0 if tick is None else int(tick["flags"])
    if flags & int(Flag.STOP):
        return Placing.STOP
    return Placing.MARK if flags & int(Flag.MARK) else Placing.DONE


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

    Parameters
    ----------
    display
        The display that is driven.

    Attributes
    ----------
    newest : record or None
        The newest record; None before the first.
    ready : bool
        Whether the device works, and the array was at the left in the ticks last watched.
    """

    def __init__(self, display: Display) -> None:
        self.newest: np.void | None = None
        self.ready = False
        self._span_mm = display.span_mm
        self._home_mm = HOME_MM - display.span_mm / 2
        self._line = 0
        self._end: EndOfLine | None = None
        self._unfelt = self._turned = self._at_left = False
        self._events: list[Event] = []

    @property
    def x_mm(self) -> float | None:
        """Place of the array's centre; None before it is known."""
        return place_of(self.newest)

    def show(self, line: int, end_mm: float | None) -> None:
        """Watch for the end of another line, at a place; None for no end."""
        self._line = line
        self._end = None if end_mm is None else EndOfLine(self._span_mm, end_mm)

    def take_events(self) -> list[Event]:
        """Take the events since the last call."""
        events, self._events = self._events, []
        return events

    def watch(self, ticks: NDArray[np.void]) -> None:
        """Look at records, oldest first."""
        if not ticks.size:
            return
        flags = ticks["flags"]
        well = flags & _AWAY == 0
        at_left = well & (ticks["x_mm"] <= self._home_mm)
        # A carriage that a machine moves may be at the left for a few ticks only.
        self.ready = bool(well[-1] and at_left.any())
        if at_left.any() and not self._at_left:
            self._events.append(AtStart(*_when(ticks[int(at_left.argmax())])))
        self._at_left = bool(at_left[-1])
        self._watch_feeling(ticks)
        felt = (ticks["line"] == self._line) & (flags & (_UNFELT | _PAUSED) == 0)
        if self._end is not None:
            shown = ticks[felt]
            found = self._end.find(shown["x_mm"])
            if found is not None:
                self._end = None
                self._events.append(LineRead(self._line, *_when(shown[found])))
        self.newest = ticks[-1]

    def _watch_feeling(self, ticks: NDArray[np.void]) -> None:
        """Tell where what is shown is felt no more, or again, and whether the array is turned."""
        before = ticks[0]["tick"] - 1 if self.newest is None else self.newest["tick"]
        lost = np.diff(ticks["tick"], prepend=before) != 1
        unfelt = (ticks["flags"] & _UNFELT != 0) | lost
        changes = np.flatnonzero(np.diff(unfelt, prepend=self._unfelt))
        for at in sorted({*changes[:1].tolist(), *changes[-1:].tolist()}):
            tick = ticks[int(at)]
            if unfelt[at]:
                self._events.append(Unfelt(_why(tick, bool(lost[at])), *_when(tick)))
            else:
                self._events.append(FeltAgain(*_when(tick)))
        self._unfelt = bool(unfelt[-1])
        turned = bool(ticks[-1]["flags"] & _TURNED)
        if turned is not self._turned:
            self._turned = turned
            degrees = math.degrees(float(ticks[-1]["theta_rad"])) if turned else 0.0
            self._events.append(Turned(degrees, math.degrees(MOST_TILT_RAD)))


def _when(tick: np.void) -> tuple[int, int]:
    return int(tick["tick"]), int(tick["time_ns"])


def _why(tick: np.void, lost: bool) -> str:
    flags = int(tick["flags"])
    said = (why for flag, why in _WHY.items() if flags & int(flag))
    return "ticks were lost" if lost else next(said, "the array is at rest")
