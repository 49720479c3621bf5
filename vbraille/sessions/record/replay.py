"""Frames that were sent to the actuators, made again from the traces, bit for bit.

For each tick, a trace tells where the array was, which picture was under it, and how far a change
had faded in. So each frame follows from the one before.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from vbraille.engine.record import FLAGS, FLOATS, INTS, LINE, Flag
from vbraille.engine.ticks import recall, replay
from vbraille.render import work
from vbraille.render.program import nothing, scratch_for
from vbraille.sessions.record.progress import stimulus_of
from vbraille.sessions.record.traces import TRACE, read_trace

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from vbraille.display import Display
    from vbraille.render.program import Program
    from vbraille.sessions.record.folder import Record
    from vbraille.sessions.record.progress import Progress

_RESTING = int(Flag.RESTING)


class Replay:
    """Maker of the frames of one trace, from its first tick on.

    Parameters
    ----------
    picture_of
        Function that gives the picture of a line number.
    display
        Display that the frames are for; it is at rest before the first tick.
    """

    def __init__(self, picture_of: Callable[[int], Program], display: Display) -> None:
        self._picture_of = picture_of
        self._nothing = nothing(display)
        self._shape = display.shape
        self._output, self._held, self._target = np.zeros((3, *display.shape))
        self._scratch = scratch_for(display.shape)
        self._at, self._remembered = np.zeros((2, work.AT))
        self._next = 0

    def frames(self, ticks: NDArray[np.void]) -> NDArray[np.float64]:
        """Frames of the next ticks.

        Parameters
        ----------
        ticks : `vbraille.sessions.record.traces.TRACE`[n]
            Ticks that follow those of the last call.

        Returns
        -------
        float64[n, rows, columns]
            Deflections, 0 … 1. Frames are NaN if they are part of a fade whose beginning is
            missing from the trace.
        """
        frames = np.zeros((ticks.size, *self._shape))
        ints = np.zeros((ticks.size, len(INTS)), np.int64)
        floats = np.zeros((ticks.size, len(FLOATS)))
        for table, names in ((ints, INTS), (floats, FLOATS)):
            for column, name in enumerate(names):
                if name in (TRACE.names or ()):
                    table[:, column] = ticks[name]
        missing = np.diff(ticks["tick"], prepend=self._next - 1) != 1
        bounds = np.flatnonzero(missing | (np.diff(ticks["line"], prepend=-1) != 0)).tolist()
        for first, end in pairwise((*bounds, ticks.size)):
            if missing[first]:
                self._output.fill(np.nan)
                self._held.fill(np.nan)
            resting = (ints[first:end, FLAGS] & _RESTING).all()
            program = self._nothing if resting else self._picture_of(int(ints[first, LINE]))
            recall(program.numbers, ints[first:end], floats[first:end], self._remembered)
            replay(
                program.numbers,
                program.table,
                self._scratch,
                ints[first:end],
                floats[first:end],
                self._at,
                self._output,
                self._held,
                self._target,
                frames[first:end],
            )
        if ticks.size:
            self._next = int(ticks["tick"][-1]) + 1
        return frames


def frames(record: Record) -> Iterator[tuple[int, NDArray[np.void], NDArray[np.float64]]]:
    """Frames of all ticks of a session, stretch by stretch.

    Yields
    ------
    line : int
        Number of the showing, as the journal has it; 0 before the first of a run.
    ticks : `vbraille.sessions.record.traces.TRACE`[n]
        Ticks of a stretch that has that number.
    deflections : float64[n, rows, columns]
        Frames of these ticks, 0 … 1.

    Raises
    ------
    VbrailleError
        If a trace cannot be read.
    """
    progress = record.progress()
    pictures = StimulusPrograms(record, progress)
    for run in progress.runs:
        if not run.trace:
            continue
        ticks = read_trace(record.folder / run.trace).ticks
        replay = Replay(pictures.of, record.protocol.model.display)
        ends = np.flatnonzero(np.diff(ticks["line"])) + 1
        for part in np.split(ticks, ends):
            if part.size:
                yield int(part["line"][0]), part, replay.frames(part)


class StimulusPrograms:
    """Programs of the stimuli that a session has shown, by their line numbers.

    Parameters
    ----------
    record
        What the session's directory holds.
    progress
        State of the session after all its events.

    Attributes
    ----------
    shown : dict[int, tuple[Trial, Presented]]
        For each line number, the trial and the showing that it belongs to.
    """

    def __init__(self, record: Record, progress: Progress) -> None:
        self._protocol = record.protocol
        self.shown = {
            showing.line: (told.trial, showing)
            for told in (*progress.practice.values(), *progress.trials.values())
            for showing in told.showings
            if showing.line  # what stood on a conventional display is in no trace
        }

    def of(self, line: int) -> Program:
        """Picture of a line number."""
        _, showing = self.shown[line]
        stimulus = stimulus_of(showing)
        tuning = replace(stimulus.tuning, **showing.tuning)
        return self._protocol.program(stimulus, tuning)
