"""The frames of a session, made again from its ticks, bit for bit.

A tick tells where the array was, what was under it, and how far a change had faded in. So each
frame follows from the one before.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vbraille.engine.record import FLAGS, FLOATS, INTS, LINE, Flag
from vbraille.engine.ticks import replay
from vbraille.render import work
from vbraille.render.program import Program, nothing
from vbraille.sessions.planning.protocol import Protocol
from vbraille.sessions.planning.shown import make_shown
from vbraille.sessions.planning.trial import Stimulus, Trial
from vbraille.sessions.record.progress import Progress
from vbraille.sessions.record.record import Content, Event, read, reading
from vbraille.sessions.record.ticks import FIELDS, read_all
from vbraille.sessions.record.trials import protocol_of

BEFORE, AFTER = 2, 2  # showings around one, whose ticks its own may be written with


class Showing(NamedTuple):
    """A stimulus that was put under the hand.

    Parameters
    ----------
    line
        Number of the showing in the ticks.
    cue
        Event of its cue.
    trial, stimulus
        The trial as it was planned, and the stimulus as it was shown.
    """

    line: int
    cue: Event
    trial: Trial
    stimulus: Stimulus


class Replay:
    """Showings of a session, and their frames.

    Attributes
    ----------
    content, protocol, progress
        What the record holds, the protocol as the participant's group has it, and what happened.
    showings : dict of Showing
        What was put under the hand, by the number in the ticks, in order.

    Raises
    ------
    RecordError
        If the session cannot be read, or a console runs it.
    """

    def __init__(self, path: Path) -> None:
        self.content: Content = read(path)
        self.protocol: Protocol = protocol_of(self.content)
        self.showings: dict[int, Showing] = {}
        self.progress = Progress(self.protocol, self.content.plan, self.content.events)
        trials = {trial.key: trial for trial in self.content.plan.trials}
        for cue in self.content.events:
            if cue.kind == "cue" and cue.key and "line" in cue.data:
                trial, line = trials[cue.key], cue.data["line"]
                stimulus = self.progress.stimulus(trial, cue)
                self.showings[line] = Showing(line, cue, trial, stimulus)
        self._program = lru_cache(maxsize=8)(self._compile)

    def frames(self, line: int) -> tuple[NDArray[np.void], NDArray[np.float64]]:
        """Make the frames of a showing again.

        Returns
        -------
        `TICK`[n], float64[n, rows, columns]
            Ticks, and the deflections of each, 0 to 1. They are NaN in a fade whose beginning is
            missing.
        """
        events, place = self.content.events, list(self.showings).index(line)
        cues = [showing.cue.n for showing in self.showings.values()]
        run = max(event.n for event in events[: cues[place]] if event.kind == "run")
        cues = [run] * BEFORE + cues + [events[-1].n + 1] * AFTER
        with reading(self.content.path) as db:
            ticks = read_all(db, max(cues[place], run) - 1, cues[place + BEFORE + AFTER])
        own = ticks["line"] == line
        return ticks[own], self._frames(ticks)[own]

    def _compile(self, line: int) -> Program:
        return make_shown(self.protocol, self.showings[line].stimulus).program

    def _frames(self, ticks: NDArray[np.void]) -> NDArray[np.float64]:
        """Return float64[n, rows, columns] of `TICK`[n] that follow each other, after a rest."""
        display = self.protocol.display_model.display
        frames = np.zeros((ticks.size, *display.shape))
        output, held, target = np.zeros((3, *display.shape))
        at = np.zeros(work.AT)
        blank = nothing(display)
        ints = np.zeros((ticks.size, len(INTS)), np.int64)
        floats = np.zeros((ticks.size, len(FLOATS)))
        for table, names in ((ints, INTS), (floats, FLOATS)):
            for column, name in enumerate(names):
                if name in FIELDS:
                    table[:, column] = ticks[name]
        missing = np.diff(ticks["tick"], prepend=-1) != 1
        bounds = np.flatnonzero(missing | (np.diff(ticks["line"], prepend=-1) != 0)).tolist()
        for first, end in pairwise((*bounds, ticks.size)):
            line = int(ints[first, LINE])
            if missing[first]:  # before its first showing a run is at rest
                output.fill(np.nan if line else 0.0)
                held.fill(np.nan if line else 0.0)
            resting = (ints[first:end, FLAGS] & int(Flag.RESTING)).all()
            program = blank if resting or not line else self._program(line)
            part, into = (ints[first:end], floats[first:end]), frames[first:end]
            arrays = program.numbers, program.table, program.scratch
            replay(*arrays, *part, at, output, held, target, into)
        return frames
