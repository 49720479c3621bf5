"""What the actuators did, made again from the traces: bit for bit what was sent.

A record of a tick tells where the array was, which picture was under it, and
how far a change had faded in; so each frame follows from the one before.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from vbraille.engine.ring import Flag
from vbraille.render.kernels import blend
from vbraille.sessions.planning.pictures import render
from vbraille.sessions.record.progress import Progress
from vbraille.sessions.record.traces import read_trace

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from vbraille.render.renderer import Renderer
    from vbraille.sessions.record.folder import Record

_RESTING, _CHANGED, _RESTED = int(Flag.RESTING), int(Flag.CHANGED), int(Flag.RESTED)
_HELD = int(Flag.HELD)
_FIELDS = ("tick", "line", "flags", "x_mm", "share")


class Replay:
    """Frames of one trace, from its first tick on.

    Parameters
    ----------
    picture_of
        The picture of a line number.
    shape
        Rows and columns of the array, which is at rest before the first tick.
    """

    def __init__(self, picture_of: Callable[[int], Renderer], shape: tuple[int, int]) -> None:
        self._picture_of = picture_of
        self._shape = shape
        self._before = np.zeros(shape)
        self._held = self._before
        self._tick = -1

    def frames(self, ticks: NDArray[np.void]) -> NDArray[np.float64]:
        """Frames of the next ticks.

        Parameters
        ----------
        ticks : `vbraille.sessions.record.traces.TRACE`[n] or `LEFT_TRACE`[n]
            Those after the ones before, as they were written; the pictures are for their places.

        Returns
        -------
        float64[n, rows, columns]
            Deflections, 0 … 1. Where ticks are missing from the trace, what a fade had come from
            is not known, and its frames are NaN.
        """
        frames = np.zeros((ticks.size, *self._shape))
        target = np.zeros(self._shape)
        shown, picture = 0, None
        columns = (ticks[name].tolist() for name in _FIELDS)
        for frame, tick, line, flags, x_mm, share in zip(frames, *columns, strict=True):
            if tick != self._tick + 1:
                self._before = self._held = np.full(self._shape, np.nan)
            self._tick = tick
            if flags & _RESTED:
                self._before = np.zeros(self._shape)
            if flags & _CHANGED:
                self._held = self._before
            if flags & _RESTING:
                target.fill(0.0)
            else:
                if picture is None or line != shown:
                    shown, picture = line, self._picture_of(line)
                picture.frame(x_mm, target)
            if share < 1:
                blend(self._held, target, share, frame)
            else:
                np.copyto(frame, target)
            self._before = frame
            if flags & _HELD:  # the loop goes on from what it wrote, and nothing of it was done
                self._before = frame.copy()
                frame.fill(0.0)
        return frames


def frames(record: Record) -> Iterator[tuple[int, NDArray[np.void], NDArray[np.float64]]]:
    """What the actuators did in a session.

    Yields
    ------
    line : int
        Number of what was shown, as the journal has it; 0 before the first of a run.
    ticks : `vbraille.sessions.record.traces.TRACE`[n] or `LEFT_TRACE`[n]
        Of a stretch of that line, as they were written.
    deflections : float64[n, rows, columns]
        Their frames, 0 … 1.

    Raises
    ------
    VbrailleError
        If a trace cannot be read.
    """
    progress = Progress(record.plan, record.told.events)
    pictures = _Pictures(record, progress)
    for run in progress.runs:
        if "trace" not in run:
            continue
        ticks = read_trace(record.folder / run["trace"]).ticks
        replay = Replay(pictures.of, record.protocol.model.array.shape)
        ends = np.flatnonzero(np.diff(ticks["line"])) + 1
        for part in np.split(ticks, ends):
            if part.size:
                yield int(part["line"][0]), part, replay.frames(part)


class _Pictures:
    """The pictures of a session, by line number."""

    def __init__(self, record: Record, progress: Progress) -> None:
        self._protocol = record.protocol
        self._anchor_mm = None if record.centred else 0.0
        self._shown = {
            showing.line: (trial.stimuli[showing.stimulus], showing.tuning)
            for trial in (*record.plan.practice, *record.plan.trials)
            for showing in progress.told(trial).showings
        }

    def of(self, line: int) -> Renderer:
        """Picture of a line number."""
        stimulus, tuning = self._shown[line]
        tuning = replace(stimulus.tuning, **tuning)
        return render(self._protocol, stimulus, tuning, anchor_mm=self._anchor_mm)
