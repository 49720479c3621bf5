"""The frames of a session, made again from its ticks, bit for bit.

A tick tells where the array was, what was under it, and how far a change had faded in. So each
frame follows from the one before.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np
from msgspec import structs
from numpy.typing import NDArray

from vbraille.display import Display
from vbraille.engine.record import FLAGS, FLOATS, INTS, LINE, Flag
from vbraille.engine.ticks import recall, replay
from vbraille.render import work
from vbraille.render.program import Program, nothing
from vbraille.sessions.planning.protocol import Protocol
from vbraille.sessions.planning.shown import make_shown
from vbraille.sessions.planning.trial import Stimulus, Trial
from vbraille.sessions.record.record import Content, Event, read, reading
from vbraille.sessions.record.ticks import TICK, read_all
from vbraille.sessions.record.trials import protocol_of

BEFORE, AFTER = 2, 2  # showings around one, whose ticks its own may be written with


class Showing(NamedTuple):
    """A stimulus that was put under the hand: its number in the ticks, and what it was."""

    line: int
    trial: Trial
    attempt: int
    stimulus: Stimulus


class Replay:
    """Showings of a session, and their frames.

    Attributes
    ----------
    content, protocol
        What the record holds, and the protocol as the participant's group has it.
    showings : list of Showing
        What was put under the hand, in order.
    """

    def __init__(self, path: Path) -> None:
        self.content: Content = read(path)
        self.protocol: Protocol = protocol_of(self.content)
        trials = {trial.key: trial for trial in self.content.plan.trials}
        self._cues = [e for e in self.content.events if e.kind == "cue" and "line" in e.data]
        self.showings = [self._showing(cue, trials[cue.key]) for cue in self._cues if cue.key]
        self._places = {showing.line: n for n, showing in enumerate(self.showings)}
        self._program = lru_cache(maxsize=8)(self._compile)

    def _showing(self, cue: Event, trial: Trial) -> Showing:
        stimulus = trial.stimuli[cue.data["stimulus"]]
        value, parameter = cue.data.get("value"), self.protocol.design.parameter
        if value is not None:
            if not parameter and self.protocol.procedure is not None:
                parameter = self.protocol.procedure.parameter
            stimulus = structs.replace(stimulus, look=stimulus.look.changed(parameter, value))
            if stimulus.value is not None:
                stimulus = structs.replace(stimulus, value=value)
        return Showing(cue.data["line"], trial, cue.attempt or 0, stimulus)

    def frames(self, line: int) -> tuple[NDArray[np.void], NDArray[np.float64]]:
        """Make the frames of a showing again.

        Returns
        -------
        `TICK`[n], float64[n, rows, columns]
            Ticks, and the deflections of each, 0 to 1. They are NaN in a fade whose beginning is
            missing.
        """
        place = self._places[line]
        earlier = self._cues[place - BEFORE].n - 1 if place >= BEFORE else 0
        run = max(e.n for e in self.content.events if e.kind == "run" and e.n < self._cues[place].n)
        later = self._cues[place + AFTER :][:1]
        until = later[0].n if later else self.content.events[-1].n + 1
        with reading(self.content.path) as db:
            ticks = read_all(db, max(earlier, run - 1), until)
        frames = _Frames(self._program, self.protocol.display_model.display).of(ticks)
        own = ticks["line"] == line
        return ticks[own], frames[own]

    def _compile(self, line: int) -> Program:
        return make_shown(self.protocol, self.showings[self._places[line]].stimulus).program


class _Frames:
    """Makes frames of ticks that follow each other.

    Parameters
    ----------
    program_of
        Function that gives what was shown by its number.
    display
        Display that the frames are for; it is at rest before the first tick.
    """

    def __init__(self, program_of: Callable[[int], Program], display: Display) -> None:
        self._program_of = program_of
        self._nothing = nothing(display)
        self._shape = display.shape

    def of(self, ticks: NDArray[np.void]) -> NDArray[np.float64]:
        """Return float64[n, rows, columns] of `TICK`[n]."""
        frames = np.zeros((ticks.size, *self._shape))
        output, held, target = np.zeros((3, *self._shape))
        at, remembered = np.zeros((2, work.AT))
        ints = np.zeros((ticks.size, len(INTS)), np.int64)
        floats = np.zeros((ticks.size, len(FLOATS)))
        for table, names in ((ints, INTS), (floats, FLOATS)):
            for column, name in enumerate(names):
                if name in (TICK.names or ()):
                    table[:, column] = ticks[name]
        missing = np.diff(ticks["tick"], prepend=-1) != 1
        bounds = np.flatnonzero(missing | (np.diff(ticks["line"], prepend=-1) != 0)).tolist()
        for first, end in pairwise((*bounds, ticks.size)):
            line = int(ints[first, LINE])
            if missing[first]:  # before its first showing a run is at rest
                output.fill(np.nan if line else 0.0)
                held.fill(np.nan if line else 0.0)
            resting = (ints[first:end, FLAGS] & int(Flag.RESTING)).all()
            program = self._nothing if resting or not line else self._program_of(line)
            part = ints[first:end], floats[first:end]
            recall(program.numbers, *part, remembered)
            into = frames[first:end]
            arrays = program.numbers, program.table, program.scratch
            replay(*arrays, *part, at, output, held, target, into)
        return frames


def open_replay(path: Path) -> Replay:
    """Open a session, to make its frames again.

    Raises
    ------
    RecordError
        If it cannot be read, or a console runs it.
    """
    return Replay(path)
