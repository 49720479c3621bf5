"""Presenters: what puts a stimulus before the participant, and tells what becomes of it.

A presenter takes any program: a line, a page or a picture. On the device every tick goes into a
trace; paper only waits for a key; `vbraille.sessions.running.conventional` has the display of pins.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np

from vbraille.devices.base import Placing
from vbraille.devices.events import Button, HandHeld, Knob, placing_sentence, told
from vbraille.engine.engine import HOME_MM, EndOfLine, Engine, Upright, placing_of
from vbraille.engine.record import Flag
from vbraille.sessions.record import events
from vbraille.sessions.record.traces import TraceWriter
from vbraille.sessions.record.trajectory import first_edge_mm
from vbraille.sessions.simulated.skin import FeltFrames
from vbraille.simulation.steering import ReadLine, ReadPage

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from collections.abc import Mapping as Named
    from pathlib import Path

    from numpy.typing import NDArray

    from vbraille.devices.events import Event
    from vbraille.render.braille.style import Tuning
    from vbraille.render.program import Program
    from vbraille.sessions.planning.protocol import Protocol as Design
    from vbraille.sessions.planning.stimuli import Stimulus
    from vbraille.sessions.record.events import JournalEvent
    from vbraille.sessions.record.journal import Tie
    from vbraille.simulation.steering import Steering


@dataclass(frozen=True, slots=True)
class Presentation:
    """A stimulus as presenters take it.

    Parameters
    ----------
    program
        Picture for the device, by places of the array's centre.
    end_mm
        Right end of what is read from left to right; None if only a key ends reading.
    edge_mm
        Left edge of the first dot; None if none is shown.
    masks
        Dot masks for a display of pins.
    canvas_mm
        Width and height of a picture, which is felt all over and ends nowhere; None for a line.
    """

    program: Program
    end_mm: float | None = None
    edge_mm: float | None = None
    masks: tuple[int, ...] = ()
    canvas_mm: tuple[float, float] | None = None


def presentation_of(protocol: Design, stimulus: Stimulus, tuning: Tuning) -> Presentation:
    """Make the presentation of a picture, or of a string with blank cells before it."""
    if stimulus.picture is not None:
        canvas = protocol.scene_of(stimulus).canvas
        size_mm = canvas.width_mm, canvas.height_mm
        return Presentation(protocol.program(stimulus, tuning), canvas_mm=size_mm)
    line, geometry = protocol.line(stimulus.masks), stimulus.geometry
    return Presentation(
        protocol.program(stimulus, tuning),
        geometry.extent_mm(len(line)),
        first_edge_mm(line, protocol.mapping_of(stimulus), geometry),
        stimulus.masks,
    )


class Occurrence(NamedTuple):
    """Something that the experimenter or the journal should be told.

    Parameters
    ----------
    kind
        Kind of event: ``Contact`` if the array came to the first dot, ``Read`` if the hand went
        to the end and back, ``Fault`` if the stimulus can no longer be felt, ``Well`` if it can be
        felt again, ``Device`` if the device reports something, ``HandTaken`` and
        ``HandGivenBack`` if a page of the live view becomes its hand or lets that go.
    fields
        Those fields of the kind that are known here.
    said
        Sentence for the experimenter; empty if there is none.
    """

    kind: type[JournalEvent]
    fields: dict[str, Any]
    said: str = ""


def _reported(what: str) -> Occurrence:
    """Make a notice of a sentence on the device."""
    return Occurrence(events.Device, {"what": what}, what)


def _notices_of(given: Iterable[Event]) -> list[Occurrence]:
    """Notices of a device's events, or of its engine's."""
    return [_notice(event, sentence) for event in given for sentence in told((event,))]


def _notice(event: Event, sentence: str) -> Occurrence:
    if not isinstance(event, HandHeld):
        return _reported(sentence)
    return Occurrence(events.HandTaken if event.held else events.HandGivenBack, {}, sentence)


class Presenter:
    """Presenter of what needs no display: a string on paper, which Enter times.

    Other presenters drive a display, and are made of this one.

    Attributes
    ----------
    by_key : bool
        Whether Enter says when reading begins and ends, since no device feels it.
    read : bool
        Whether the stimulus has been read to its end.
    taken : bool
        Whether what was shown last has come to the display.
    """

    by_key = True

    def __init__(self) -> None:
        self.read = False
        self.taken = True

    @property
    def why(self) -> str:
        """Reason why nothing can be shown now, in words for people; empty if something can."""
        return ""

    @property
    def ready(self) -> bool:
        """True if a trial may begin."""
        return not self.why

    @property
    def reached(self) -> bool:
        """True if the hand has been at the end of the stimulus."""
        return self.read

    @property
    def explorations(self) -> list[FeltFrames]:
        """Frames and places of each stimulus of the trial so far; none off the device."""
        return []

    def show(self, _presentation: Presentation, *, first: bool = True) -> None:  # noqa: ARG002
        """Put a stimulus before the participant; the first one of a trial, or another."""
        self.read = False

    def end_reading(self) -> None:
        """Take the stimulus from under the hand, since a key has ended the reading."""
        self.read = True

    def rest(self) -> None:
        """Have nothing be felt for a while."""

    def go(self) -> None:
        """Let the stimulus be felt again after a rest, unless its reading was ended."""

    def withdraw(self) -> None:
        """Take the stimulus away, since the attempt at the trial is over."""

    def poll(self) -> list[Occurrence]:
        """Give what has happened since the last call."""
        return []


Paper = Presenter


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
_LINE_MM = 10.0  # ours: between the lines that a simulated hand goes along over a picture


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

    def look(self, ticks: NDArray[np.void], lost: NDArray[np.bool_]) -> list[Occurrence]:
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
        notices = []
        if at.size and not self.away:
            fault = ticks[int(at[0])]
            time_ns = int(fault["time_ns"])
            if self._told_ns is not None and time_ns - self._told_ns < _TOLD_S * 1e9:
                return []
            self.away, self._told_ns = True, time_ns
            notices.append(Occurrence(events.Fault, {"what": _why(fault), **when(fault)}))
        if self.away and not unfelt[-1]:
            self.away = False
            well = int(at[-1]) + 1 if at.size else 0
            notices.append(Occurrence(events.Well, when(ticks[well])))
        return notices

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
        """Counts of what went wrong with the device, by name; known after `close`."""
        ...

    @property
    def calibration(self) -> dict[str, Any] | None:
        """Calibration of the device's actuators; known once the device is open."""
        ...

    def start(self) -> None:
        """Open the device, and begin to drive it."""
        ...

    def close(self) -> None:
        """Bring the array to rest, and close the device."""
        ...


class OnDevice(Presenter):
    """Presenter on a device.

    Parameters
    ----------
    engine
        Engine that drives the device.
    span_mm
        Distance from the array's left column to its right one.
    button
        Number of the device's button that ends reading; None if no button does.
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
    anywhere
        Whether a trial may begin wherever the hand is, as for pictures, and not at the left alone.

    Attributes
    ----------
    line : int
        Number of the last showing.
    newest : record or None
        Record of the newest tick that was polled; None before the first.
    ended : bool
        Whether the participant's key has ended the reading of this stimulus.
    """

    by_key = False

    def __init__(
        self,
        engine: RunEngine,
        span_mm: float,
        folder: Path,
        *,
        button: int | None = None,
        keeps: bool,
        tie: Callable[[], Tie],
        steering: Steering | None = None,
        by_hand: bool = True,
        anywhere: bool = False,
    ) -> None:
        super().__init__()
        self._anywhere = anywhere
        self.engine = engine
        self.line = 0
        self._span_mm = span_mm
        self._folder = folder
        self._keeps = keeps
        self._tie = tie
        self._steering = steering
        self._button = button
        self._by_hand = by_hand
        self.ended = False
        self._trace: TraceWriter | None = None
        self.newest: np.void | None = None
        self._placing = Placing.DONE
        self._shown: Presentation | None = None
        self._end: EndOfLine | None = None
        self._edge_mm: float | None = None
        self._shown_ns = 0
        self._touched = self._ready = False
        self._shown_line = 0  # first line of the stimulus
        self._faults = FaultWatch()
        self._upright = Upright()
        self._felt: list[list[NDArray[np.void]]] = []
        self._controls: list[Button | Knob] = []

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
        self.newest = self._shown = None
        self._faults.away = self._ready = False
        return _trace_name(run)

    @property
    def now_ns(self) -> int:
        """Time of the newest tick that was polled; 0 before the first."""
        return 0 if self.newest is None else int(self.newest["time_ns"])

    @property
    def ready(self) -> bool:
        """True if the device works, and its carriage is where a trial may begin."""
        return self._ready

    @property
    def reached(self) -> bool:
        """True if the hand has been at the end of the stimulus; a picture has none."""
        return self.read or self._end is None or self._end.reached

    @property
    def explorations(self) -> list[FeltFrames]:
        """Frames and places of each stimulus of the trial so far."""
        together = (np.concatenate(parts) for parts in self._felt)
        return [
            FeltFrames(t["frame"], t["x_mm"], t["time_ns"] / 1e9, t["y_mm"], t["theta_rad"])
            for t in together
        ]

    def show(self, presentation: Presentation, *, first: bool = True) -> None:
        """Put a stimulus under the hand, as the showing with the next line number."""
        self._shown_ns = self.now_ns
        self._shown_line = self.line + 1
        if first:
            self._felt = []
            self._faults.begin(self._shown_line)
        self._felt.append([])
        end_mm, edge_mm = presentation.end_mm, presentation.edge_mm
        self._end = None if end_mm is None else EndOfLine(self._span_mm, end_mm)
        self._edge_mm = None if edge_mm is None else edge_mm - self._span_mm / 2
        self._touched = self.read = self.ended = False
        self.change(presentation)
        self.engine.paused = False

    def change(self, presentation: Presentation) -> None:
        """Show the stimulus by another program, as the showing with the next line number."""
        self._shown = presentation
        self.line += 1
        self.engine.show(presentation.program, self.line)
        if self._steering is None:
            return
        if presentation.canvas_mm is not None:
            width_mm, height_mm = presentation.canvas_mm
            lines = max(1, round(height_mm / _LINE_MM))
            self._steering.give(ReadPage(lines, height_mm / lines, width_mm))
        elif presentation.end_mm is not None:
            self._steering.give(ReadLine(presentation.end_mm))

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
        """Take the stimulus away, and make sure that the trace of it is on the disk."""
        self.rest()
        self._shown = None
        if self._trace is not None:
            self._trace.sync()

    def confirm(self) -> bool:
        """Take Enter as the sign that the carriage is at its left stop, if that is awaited."""
        if self._placing is not Placing.STOP:
            return False
        self.engine.set_zero()
        return True

    def poll(self) -> list[Occurrence]:
        """Add the ticks since the last call to the trace, and return what happened in them.

        Raises
        ------
        VbrailleError
            If the engine has ended, or the disk does not take the trace.
        """
        ticks = self.engine.poll()
        given = self.engine.take_events()
        notices = _notices_of(given)
        if not ticks.size:
            return notices + self._pressed(given)
        before = ticks["tick"][0] - 1 if self.newest is None else self.newest["tick"]
        lost = np.diff(ticks["tick"], prepend=before) != 1
        self.newest = ticks[-1]
        # A carriage that a machine moves may be at the left for a few ticks only.
        at_left = self._anywhere | (ticks["x_mm"] <= HOME_MM - self._span_mm / 2)
        well = ticks["flags"] & AWAY == 0
        self._ready = bool(well[-1] and (at_left & well).any())
        if self._trace is not None:
            self._trace.add(ticks)
        placing = placing_of(self.newest)
        if placing is not self._placing:
            self._placing = placing
            display = self.engine.display
            said = placing_sentence(placing, display, press="press Enter")
            notices.append(_reported(said))
        notices += map(_reported, self._upright.watch(ticks[-1]))
        if self._shown is not None:
            notices += sorted(
                self._faults.look(ticks, lost) + self._follow(ticks),
                key=lambda each: each.fields["tick"],
            )
        return notices + self._pressed(given)

    def take_controls(self) -> list[Button | Knob]:
        """Presses and turns since the last call, while a stimulus was shown.

        The button that ends reading is not among them.
        """
        controls, self._controls = self._controls, []
        return controls

    def _pressed(self, given: Iterable[Event]) -> list[Occurrence]:
        """Press of the button that ends reading, if it is among these events."""
        if self._shown is None:
            return []
        for event in given:
            if isinstance(event, Button):
                if event.pressed and event.number != self._button:
                    self._controls.append(event)
            elif isinstance(event, Knob):
                self._controls.append(event)
        if self.ended:
            return []
        for event in given:
            if isinstance(event, Button) and event.pressed and event.number == self._button:
                by = {"by": f"button:{event.number}"}
                # A press from before the stimulus came is told now, and counts from now on.
                at_ns = event.at_ns if event.at_ns and event.at_ns > self._shown_ns else None
                return [Occurrence(events.Ended, by if at_ns is None else by | {"time_ns": at_ns})]
        return []

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

    def _follow(self, ticks: NDArray[np.void]) -> list[Occurrence]:
        """Touch of the first dot, and end of reading, if they are in these ticks."""
        ticks = ticks[(ticks["line"] >= self._shown_line) & (ticks["flags"] & _PAUSED == 0)]
        if not ticks.size:
            return []
        notices = []
        if self._keeps:
            self._felt[-1].append(ticks)
        if not self._touched and self._edge_mm is not None:
            on = np.flatnonzero(ticks["x_mm"] >= self._edge_mm)
            if on.size:
                self._touched = True
                notices.append(Occurrence(events.Contact, when(ticks[int(on[0])])))
        steered = self._steering is not None and self._steering.done_at(int(ticks["device_ns"][-1]))
        shown = self._shown
        assert shown is not None, "nothing is followed that is not shown"
        if self.read or not self._by_hand or {shown.end_mm, shown.canvas_mm} == {None}:
            return notices
        if steered or (self._end is not None and self._end.find(ticks["x_mm"]) is not None):
            self.read = True
            notices.append(Occurrence(events.Read, when(ticks[-1])))
        return notices


def _trace_name(run: int) -> str:
    return f"trace-{run:03}.gz"
