"""Stimuli under the hand: on a device, whose every tick goes into a trace, or on paper."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np

from vbraille.devices.base import Placing
from vbraille.engine.advance import HOME_MM, EndOfLine
from vbraille.engine.engine import Engine, placing_of
from vbraille.engine.ring import Flag
from vbraille.sessions.planning.pictures import render
from vbraille.sessions.record.traces import TraceWriter
from vbraille.sessions.record.trajectory import first_edge_mm
from vbraille.sessions.simulated.skin import Exploration

if TYPE_CHECKING:
    from collections.abc import Callable
    from collections.abc import Mapping as Named
    from pathlib import Path

    from numpy.typing import NDArray

    from vbraille.render.tuning import Tuning
    from vbraille.sessions.planning.plan import Stimulus
    from vbraille.sessions.planning.protocol import Protocol as Design
    from vbraille.sessions.record.journal import Tie

_PLACES = {
    Placing.DONE: "place: known",
    Placing.MARK: "place: move the carriage over its mark",
    Placing.STOP: "place: move left to the stop, then press Enter",
}
_AWAY = int(Flag.SILENT | Flag.MARK | Flag.STOP)


class RunEngine(Engine, Protocol):
    """An engine that is started and ended, as `vbraille.engine.host.Host` is."""

    @property
    def lost(self) -> int:
        """Ticks that were never polled."""
        ...

    @property
    def counts(self) -> Named[str, int]:
        """What went wrong with the device, by name; known after `close`."""
        ...

    def start(self) -> None:
        """Open the device and begin."""
        ...

    def close(self) -> None:
        """Bring the array to rest, and end."""
        ...


class Happened(NamedTuple):
    """Something that the experimenter or the journal should know of.

    Parameters
    ----------
    what
        ``contact``: the array came to the first dot. ``read``: the hand went to the end and
        back. ``fault``, ``well``: the device went away, is back. ``note``: it has something to say.
    fields
        Of the journal's event.
    """

    what: str
    fields: dict[str, Any]


class OnDevice:
    """Stimuli on a device.

    Parameters
    ----------
    engine
        Drives it.
    protocol
        How cells are shown.
    folder
        Where the trace goes.
    keeps
        Whether what is felt is kept, for a simulated reader.
    tie
        Tells which line of the journal is on the disk, for the traces to be tied to; None in a
        session of format 1.

    Attributes
    ----------
    line : int
        Number of what was shown last.
    explorations : list[Exploration]
        What was felt of the stimuli of the trial so far.
    """

    by_key = False

    def __init__(
        self,
        engine: RunEngine,
        protocol: Design,
        folder: Path,
        *,
        keeps: bool,
        tie: Callable[[], Tie] | None = None,
    ) -> None:
        self.engine = engine
        self.line = 0
        self._protocol = protocol
        self._span_mm = protocol.model.array.span_mm
        self._folder = folder
        self._keeps = keeps
        self._tie = tie
        self._trace: TraceWriter | None = None
        self._newest: np.void | None = None
        self._placing = Placing.DONE
        self._stimulus: Stimulus | None = None
        self._end: EndOfLine
        self._edge_mm: float | None = None
        self._touched = self._read = self._away = self._ready = False
        self._felt: list[list[NDArray[np.void]]] = []

    def open(self, run: int, line: int) -> str:
        """Begin the trace of an engine that was started; its name.

        Parameters
        ----------
        run
            Number of the run, from 1.
        line
            Number of the last line shown in those before.
        """
        self.close_trace()
        self.engine.paused = True
        self.line = line
        # A run that was killed before the journal told of it has left its trace.
        while (self._folder / _trace_name(run)).exists():
            run += 1
        self._trace = TraceWriter(self._folder / _trace_name(run), self._tie)
        self._newest = self._stimulus = None
        self._away = self._ready = False
        return _trace_name(run)

    @property
    def now_ns(self) -> int:
        """When the newest tick known of was; 0 before the first."""
        return 0 if self._newest is None else int(self._newest["time_ns"])

    @property
    def ready(self) -> bool:
        """Whether the device is well, and its carriage has just been at the left stop."""
        return self._ready

    @property
    def read(self) -> bool:
        """Whether the hand has gone to the end of what is shown and back."""
        return self._read

    @property
    def explorations(self) -> list[Exploration]:
        """What was felt of the trial's stimuli so far."""
        together = (np.concatenate(parts) for parts in self._felt)
        return [Exploration(t["frame"], t["x_mm"], t["time_ns"] / 1e9) for t in together]

    def show(self, stimulus: Stimulus, tuning: Tuning, *, first: bool) -> None:
        """Put a stimulus under the hand, with the next number as its line.

        Parameters
        ----------
        first
            Of a trial, or the second that it is to be compared with.
        """
        self._stimulus = stimulus
        if first:
            self._felt = []
        self._felt.append([])
        self._end = EndOfLine(self._span_mm, self._end_mm(stimulus))
        edge_mm = first_edge_mm(
            self._protocol.line(stimulus.masks), self._protocol.mapping, stimulus.geometry
        )
        self._edge_mm = None if edge_mm is None else edge_mm - self._span_mm
        self._touched = self._read = self._away = False
        self.retune(tuning)
        self.engine.paused = False

    def retune(self, tuning: Tuning) -> None:
        """Show what is shown with another tuning, with the next number as its line."""
        stimulus = self._stimulus
        assert stimulus is not None, "nothing is shown"
        self.line += 1
        picture = render(self._protocol, stimulus, tuning)
        self.engine.show(picture, self.line, self._end_mm(stimulus))

    def _end_mm(self, stimulus: Stimulus) -> float:
        return stimulus.geometry.extent_mm(len(self._protocol.line(stimulus.masks)))

    def rest(self) -> None:
        """Have the array rest, at once."""
        self.engine.paused = True

    def go(self) -> None:
        """Let what was shown be felt again."""
        self.engine.paused = False

    def withdraw(self) -> None:
        """Take away what is shown: the trial is over."""
        self.rest()
        self._stimulus = None

    def confirm(self) -> bool:
        """Take Enter: the carriage is at its left stop, if that is what the device waits for."""
        if self._placing is not Placing.STOP:
            return False
        self.engine.set_zero()
        return True

    def poll(self) -> list[Happened]:
        """Take the ticks since the last call into the trace; what happened in them.

        Raises
        ------
        VbrailleError
            If the engine has ended, or the disk does not take the trace.
        """
        ticks = self.engine.poll()
        happened = [Happened("note", {"what": note}) for note in self.engine.take_notes()]
        if not ticks.size:
            return happened
        self._newest = ticks[-1]
        # A carriage that a machine moves may be there for some ticks only.
        at_left = ticks["x_mm"] <= HOME_MM - self._span_mm
        well = ticks["flags"] & _AWAY == 0
        self._ready = bool(well[-1] and (at_left & well).any())
        if self._trace is not None:
            self._trace.add(ticks)
        placing = placing_of(self._newest)
        if placing is not self._placing:
            self._placing = placing
            happened.append(Happened("note", {"what": _PLACES[placing]}))
        if self._stimulus is not None:
            happened += self._follow(ticks)
        return happened

    def sync(self) -> None:
        """Have the trace on the disk."""
        if self._trace is not None:
            self._trace.sync()

    def close(self) -> None:
        """Bring the array to rest, end the engine and the trace."""
        try:
            self.engine.close()
        finally:
            self.close_trace()

    def close_trace(self) -> dict[str, Any]:
        """End the trace, if there is one; what the journal tells of it."""
        if self._trace is None:
            return {}
        self._trace.close()
        return self._trace.closed()

    def _follow(self, ticks: NDArray[np.void]) -> list[Happened]:
        """What the hand did with the stimulus in these ticks."""
        ticks = ticks[(ticks["line"] == self.line) & (ticks["flags"] & Flag.PAUSED == 0)]
        if not ticks.size:
            return []
        happened = []
        if self._keeps:
            self._felt[-1].append(ticks)
        away = bool(ticks["flags"][-1] & _AWAY)
        if away != self._away:
            self._away = away
            happened.append(Happened("fault" if away else "well", _when(ticks[-1])))
        if not self._touched and self._edge_mm is not None:
            on = np.flatnonzero(ticks["x_mm"] >= self._edge_mm)
            if on.size:
                self._touched = True
                happened.append(Happened("contact", _when(ticks[int(on[0])])))
        followed = ticks["flags"][-1] & Flag.FOLLOWED
        if not self._read and (self._end.find(ticks["x_mm"]) is not None or followed):
            self._read = True
            happened.append(Happened("read", _when(ticks[-1])))
        return happened


def _trace_name(run: int) -> str:
    return f"trace-{run:03}.gz"


def _when(tick: np.void) -> dict[str, Any]:
    return {"tick": int(tick["tick"]), "time_ns": int(tick["time_ns"])}
