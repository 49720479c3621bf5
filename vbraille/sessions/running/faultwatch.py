"""Watch over the ticks of a trial for those at which its stimulus could not be felt."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from vbraille.engine.record import Flag
from vbraille.sessions.record import events
from vbraille.sessions.running.happened import Happened

if TYPE_CHECKING:
    from numpy.typing import NDArray

# Flags of a device that cannot let a stimulus be felt, and of one that has just gone to rest.
AWAY = int(Flag.SILENT | Flag.MARK | Flag.STOP | Flag.HELD | Flag.TURNED)
_UNFELT = AWAY | int(Flag.RESTED)
# These are plain numbers because numpy, when it reads an enumeration, can swallow an exception that
# a signal raises.
_PAUSED, _RESTING, _HELD = int(Flag.PAUSED), int(Flag.RESTING), int(Flag.HELD)
_WHY_HELD = int(Flag.HELD | Flag.RESTED | Flag.SILENT)
# A fault is told at most once in so many seconds of a trial, which the first one has marked.
_TOLD_S = 1.0
# A device that rests because the hand stands still may take so long to accept frames again.
_WAKING_S = 0.1


class FaultWatch:
    """Watch over the ticks of a trial.

    Attributes
    ----------
    away : bool
        Whether the stimulus cannot be felt at the moment.
    """

    def __init__(self) -> None:
        self.away = False
        self._line = 0  # first line of the trial
        self._still = False  # whether the newest tick rested because the hand stood still
        self._waking_ns = -(1 << 62)  # when the device last began to wake
        self._told_ns: int | None = None  # time of the last fault of the trial

    def begin(self, line: int) -> None:
        """Begin a trial, or another attempt at it, with the showing of this line number."""
        self.away, self._told_ns, self._line = False, None, line

    def look(self, ticks: NDArray[np.void], lost: NDArray[np.bool_]) -> list[Happened]:
        """Faults that begin or end in these ticks.

        Parameters
        ----------
        ticks
            Records of ticks, in order.
        lost : bool[n]
            Whether ticks before each were lost.

        Notes
        -----
        A tick of the trial, pauses left out, is faulty if the device was silent, did not know its
        place, had gone to rest by itself or took no frames, if its array was turned too far, or if
        ticks before it were lost. It is no fault that the array rests while the hand stands still,
        nor that the device then takes a moment to wake.
        """
        shown = (ticks["line"] >= self._line) & (ticks["flags"] & _PAUSED == 0)
        ticks, lost = ticks[shown], lost[shown]
        if not ticks.size:
            return []
        unfelt = (ticks["flags"] & _UNFELT != 0) & ~self._wakes(ticks) | lost
        at = np.flatnonzero(unfelt)
        happened = []
        if at.size and not self.away:
            fault = ticks[int(at[0])]
            time_ns = int(fault["time_ns"])
            if self._told_ns is not None and time_ns - self._told_ns < _TOLD_S * 1e9:
                return []
            self.away, self._told_ns = True, time_ns
            happened.append(Happened(events.Fault, {"what": _why(fault), **when(fault)}))
        if self.away and not unfelt[-1]:
            self.away = False
            well = int(at[-1]) + 1 if at.size else 0
            happened.append(Happened(events.Well, when(ticks[well])))
        return happened

    def _wakes(self, ticks: NDArray[np.void]) -> NDArray[np.bool_]:
        """Mark ticks at which the device still wakes after the hand stood still."""
        flags, times_ns = ticks["flags"], ticks["time_ns"]
        held = flags & _WHY_HELD == _HELD
        wakes = np.zeros(ticks.size, np.bool_)
        for n in np.flatnonzero(held):
            begins = self._still if n == 0 else bool(flags[n - 1] & _RESTING) and not held[n - 1]
            if begins:
                self._waking_ns = int(times_ns[n])
            wakes[n] = times_ns[n] - self._waking_ns < _WAKING_S * 1e9
        self._still = bool(flags[-1] & _RESTING) and not held[-1]
        return wakes


def _why(tick: np.void) -> str:
    """Say why the stimulus could not be felt at a tick."""
    flags = int(tick["flags"])
    if flags & Flag.SILENT:
        return "the device is silent"
    if flags & (Flag.MARK | Flag.STOP):
        return "the device does not know where its carriage is"
    if flags & (Flag.HELD | Flag.RESTED):
        return "the array went to rest by itself"
    return "the array was turned too far" if flags & Flag.TURNED else "ticks of it were lost"


def when(tick: np.void) -> dict[str, Any]:
    """Fields of an event for the tick at which it happened."""
    return {"tick": int(tick["tick"]), "time_ns": int(tick["time_ns"])}
