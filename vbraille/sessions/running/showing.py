"""Showing of stimuli on a device, every tick of which goes into a trace."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from vbraille.devices.base import Placing
from vbraille.devices.events import Button
from vbraille.devices.sentences import placing_sentence
from vbraille.engine.engine import Engine, placing_of
from vbraille.engine.record import Flag
from vbraille.engine.watchers import HOME_MM, EndOfLine, Upright
from vbraille.sessions.record import events
from vbraille.sessions.record.traces import TraceWriter
from vbraille.sessions.record.trajectory import first_edge_mm
from vbraille.sessions.running.logbook import Happened, of_device, reported
from vbraille.sessions.simulated.skin import Exploration
from vbraille.simulation.steering import ReadLine

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from collections.abc import Mapping as Named
    from pathlib import Path

    from numpy.typing import NDArray

    from vbraille.devices.events import Event
    from vbraille.render.braille.profiles import Tuning
    from vbraille.sessions.planning.protocol import Protocol as Design
    from vbraille.sessions.planning.stimuli import Stimulus
    from vbraille.sessions.record.journal import Tie
    from vbraille.simulation.steering import Steering


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


class RunEngine(Engine, Protocol):
    """An engine that can be started and closed, such as `vbraille.engine.host.Host`."""

    @property
    def lost(self) -> int:
        """Number of ticks that were never polled."""
        ...

    @property
    def counts(self) -> Named[str, int]:
        """How often each thing went wrong with the device, by name; known after `close`."""
        ...

    @property
    def calibration(self) -> dict[str, Any] | None:
        """What is made up for in the device's actuators; known once the device is open."""
        ...

    def start(self) -> None:
        """Open the device, and begin to drive it."""
        ...

    def close(self) -> None:
        """Bring the array to rest, and close the device."""
        ...


class OnDevice:
    """Display of stimuli on a device.

    Parameters
    ----------
    engine
        Engine that drives the device.
    protocol
        Protocol of the session, which says how cells are shown.
    folder
        Directory of the session, in which traces are written.
    keeps
        Whether ticks are kept for a simulated reader.
    tie
        Function that tells which line of the journal is on the disk, to which traces are tied.
    steering
        Channel that tells the simulated hand what to read; None if a person's hand reads.
    by_hand
        Whether the hand's way to the end and back ends reading, and not the participant's key
        alone.

    Attributes
    ----------
    line : int
        Number of the last showing.
    newest : record or None
        Record of the newest tick that was polled; None before the first.
    ready : bool
        Whether the device works, and its carriage has just been at the left stop.
    read : bool
        Whether the hand has gone to the end of the stimulus and back.
    ended : bool
        Whether the participant's key has ended the reading of this stimulus.
    explorations : list[Exploration]
        Frames and places of each stimulus of the trial so far.
    """

    def __init__(
        self,
        engine: RunEngine,
        protocol: Design,
        folder: Path,
        *,
        keeps: bool,
        tie: Callable[[], Tie],
        steering: Steering | None = None,
        by_hand: bool = True,
    ) -> None:
        self.engine = engine
        self.line = 0
        self._protocol = protocol
        self._span_mm = protocol.model.display.span_mm
        self._folder = folder
        self._keeps = keeps
        self._tie = tie
        self._steering = steering
        self._button = protocol.trial.button
        self._by_hand = by_hand
        self.ended = False
        self._trace: TraceWriter | None = None
        self.newest: np.void | None = None
        self._placing = Placing.DONE
        self._stimulus: Stimulus | None = None
        self._end: EndOfLine
        self._edge_mm: float | None = None
        self._shown_ns = 0
        self._touched = self.read = self.ready = False
        self._shown_line = 0  # first line of the stimulus
        self._faults = FaultWatch()
        self._upright = Upright()
        self._felt: list[list[NDArray[np.void]]] = []

    def open(self, run: int, line: int) -> str:
        """Begin the trace of an engine that was started, and return the trace's name.

        Parameters
        ----------
        run
            Number of the run, from 1.
        line
            Number of the last showing in earlier runs.
        """
        self.close_trace()
        self.engine.paused = True
        self.line = line
        # A run that was killed before the journal had its event may have left a trace.
        while (self._folder / _trace_name(run)).exists():
            run += 1
        self._trace = TraceWriter(self._folder / _trace_name(run), self._tie)
        self.newest = self._stimulus = None
        self._faults.away = self.ready = False
        return _trace_name(run)

    @property
    def now_ns(self) -> int:
        """Time of the newest tick that was polled; 0 before the first."""
        return 0 if self.newest is None else int(self.newest["time_ns"])

    @property
    def reached(self) -> bool:
        """Whether the hand has been at the end of the stimulus."""
        return self.read or self._end.reached

    @property
    def explorations(self) -> list[Exploration]:
        """Frames and places of each stimulus of the trial so far."""
        together = (np.concatenate(parts) for parts in self._felt)
        return [Exploration(t["frame"], t["x_mm"], t["time_ns"] / 1e9) for t in together]

    def show(self, stimulus: Stimulus, tuning: Tuning, *, first: bool) -> None:
        """Put a stimulus under the hand, as the showing with the next line number.

        Parameters
        ----------
        stimulus, tuning
            Stimulus, and the tuning that it is shown with.
        first
            Whether it is the first stimulus of a trial, and not the second of a comparison.
        """
        self._stimulus = stimulus
        self._shown_ns = self.now_ns
        self._shown_line = self.line + 1
        if first:
            self._felt = []
            self._faults.begin(self._shown_line)
        self._felt.append([])
        self._end = EndOfLine(self._span_mm, self._end_mm(stimulus))
        edge_mm = first_edge_mm(
            self._protocol.line(stimulus.masks),
            self._protocol.mapping_of(stimulus),
            stimulus.geometry,
        )
        self._edge_mm = None if edge_mm is None else edge_mm - self._span_mm / 2
        self._touched = self.read = self.ended = False
        self.retune(tuning)
        self.engine.paused = False

    def retune(self, tuning: Tuning) -> None:
        """Show the stimulus with another tuning, as the showing with the next line number."""
        stimulus = self._stimulus
        assert stimulus is not None, "nothing is shown"
        self.line += 1
        self.engine.show(self._protocol.program(stimulus, tuning), self.line)
        if self._steering is not None:
            self._steering.give(ReadLine(self._end_mm(stimulus)))

    def _end_mm(self, stimulus: Stimulus) -> float:
        return stimulus.geometry.extent_mm(len(self._protocol.line(stimulus.masks)))

    def rest(self) -> None:
        """Bring the array to rest at once."""
        self.engine.paused = True

    def go(self) -> None:
        """Let the stimulus be felt again after a rest, unless its reading was ended."""
        self.engine.paused = self.ended

    def end_reading(self) -> None:
        """Bring the array to rest, since the participant's key has ended the reading."""
        self.read = self.ended = True
        self.rest()

    def withdraw(self) -> None:
        """Take the stimulus away, since the attempt at the trial is over."""
        self.rest()
        self._stimulus = None

    def confirm(self) -> bool:
        """Take Enter as the sign that the carriage is at its left stop, if that is awaited."""
        if self._placing is not Placing.STOP:
            return False
        self.engine.set_zero()
        return True

    def poll(self) -> list[Happened]:
        """Add the ticks since the last call to the trace, and return what happened in them.

        Raises
        ------
        VbrailleError
            If the engine has ended, or the disk does not take the trace.
        """
        ticks = self.engine.poll()
        told = self.engine.take_events()
        happened = of_device(told)
        if not ticks.size:
            return happened + self._pressed(told)
        before = ticks["tick"][0] - 1 if self.newest is None else self.newest["tick"]
        lost = np.diff(ticks["tick"], prepend=before) != 1
        self.newest = ticks[-1]
        # A carriage that a machine moves may be at the left for a few ticks only.
        at_left = ticks["x_mm"] <= HOME_MM - self._span_mm / 2
        well = ticks["flags"] & AWAY == 0
        self.ready = bool(well[-1] and (at_left & well).any())
        if self._trace is not None:
            self._trace.add(ticks)
        placing = placing_of(self.newest)
        if placing is not self._placing:
            self._placing = placing
            display = self.engine.display
            said = placing_sentence(placing, display, press="press Enter")
            happened.append(reported(said))
        happened += map(reported, self._upright.watch(ticks[-1]))
        if self._stimulus is not None:
            happened += sorted(
                self._faults.look(ticks, lost) + self._follow(ticks),
                key=lambda each: each.fields["tick"],
            )
        return happened + self._pressed(told)

    def _pressed(self, told: Iterable[Event]) -> list[Happened]:
        """Press of the button that ends reading, if it is among these events."""
        if self._stimulus is None or self.ended:
            return []
        for event in told:
            if isinstance(event, Button) and event.pressed and event.number == self._button:
                by = {"by": f"button:{event.number}"}
                # A press from before the stimulus came is told now, and counts from now on.
                at_ns = event.at_ns if event.at_ns and event.at_ns > self._shown_ns else None
                return [Happened(events.Ended, by if at_ns is None else by | {"time_ns": at_ns})]
        return []

    def sync(self) -> None:
        """Make sure that the trace is on the disk."""
        if self._trace is not None:
            self._trace.sync()

    def close(self) -> None:
        """Bring the array to rest, and close the engine and the trace."""
        try:
            self.engine.close()
        finally:
            self.close_trace()

    def close_trace(self) -> dict[str, Any]:
        """Close the trace, and return the journal's fields about it; empty if there is none."""
        if self._trace is None:
            return {}
        self._trace.close()
        return self._trace.closed()

    def _follow(self, ticks: NDArray[np.void]) -> list[Happened]:
        """Touch of the first dot, and end of reading, if they are in these ticks."""
        ticks = ticks[(ticks["line"] >= self._shown_line) & (ticks["flags"] & _PAUSED == 0)]
        if not ticks.size:
            return []
        happened = []
        if self._keeps:
            self._felt[-1].append(ticks)
        if not self._touched and self._edge_mm is not None:
            on = np.flatnonzero(ticks["x_mm"] >= self._edge_mm)
            if on.size:
                self._touched = True
                happened.append(Happened(events.Contact, when(ticks[int(on[0])])))
        steered = self._steering is not None and self._steering.done_at(int(ticks["device_ns"][-1]))
        if (
            self._by_hand
            and not self.read
            and (self._end.find(ticks["x_mm"]) is not None or steered)
        ):
            self.read = True
            happened.append(Happened(events.Read, when(ticks[-1])))
        return happened


def _trace_name(run: int) -> str:
    return f"trace-{run:03}.gz"
