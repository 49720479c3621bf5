"""A session played back: its frames made again from the ticks, and its events beside them."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from vbraille.errors import InputError
from vbraille.live.messages import PlayedEvent, ViewState
from vbraille.live.states import array_shown, cells_shown, geometry_shown, rows_shown
from vbraille.playback.recorded import PLAYED, Piece, Playback
from vbraille.sessions.record.progress import Progress
from vbraille.sessions.record.record import KINDS, Event
from vbraille.sessions.record.replay import open_replay

# Kinds of moments in the live view, by the kinds of events; others are notes.
MOMENTS = {
    "cue": "cue", "warning": "cue", "contact": "line", "read": "line", "ended": "line",
    "answer": "answer", "undo": "answer", "missed": "answer", "repeat": "trial", "fault": "fault",
    "well": "fault", "pause": "pause", "go": "pause", "break": "pause",
}  # fmt: skip
_TOLD = ("answer", "what", "text", "why", "by")  # what of an event's data is said


def open_session(path: Path) -> Playback:
    """Open a session to be played back.

    Raises
    ------
    InputError
        If it has no frames.
    RecordError
        If it cannot be read, or is open in a console.
    """
    return SessionPlayback(path)


class SessionPlayback(Playback):
    """Frames of a session, a piece for each showing of a stimulus."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self._replay = open_replay(path)
        content, self._protocol = self._replay.content, self._replay.protocol
        self._name = f"{content.plan.participant}: {self._protocol.name}"
        self._progress = Progress(self._protocol, content.plan, content.events)
        if not self._progress.ended:
            self.notes.append(
                "the session has not ended; a participant who goes on with it should not see this"
            )
        cues = {e.data["line"]: e.t_s for e in content.events if "line" in e.data}
        self._showings = [each for each in self._replay.showings if each.line in cues]
        self._starts = [cues[each.line] for each in self._showings]
        if not self._showings:
            raise InputError(f"{path} has no frames to play")
        self.pieces = len(self._showings)
        self.moments = [self._moment(event) for event in content.events]
        self.length_s = max(event.t_s for event in content.events)

    def first_s(self, number: int) -> float:
        """Give the time at which a stimulus was shown, in seconds of the session."""
        return self._starts[number]

    def read(self, number: int) -> Piece:
        """Make the frames of a showing again."""
        ticks, frames = self._replay.frames(self._showings[number].line)
        played = np.zeros(len(ticks), PLAYED)
        for name in set(PLAYED.names or ()) & set(ticks.dtype.names or ()):
            played[name] = ticks[name]
        if ticks.size:
            since_s = (ticks["time_ns"] - ticks["time_ns"][0]) / 1e9
            played["time_s"] = np.maximum.accumulate(self._starts[number] + since_s)
        played["scene"] = number + 1
        return Piece(played, frames.astype(np.float32))

    def describe(self, scene: int) -> ViewState:
        """Make what a page shows of a showing."""
        showing = self._showings[max(scene - 1, 0)]
        trial, stimulus = showing.trial, showing.stimulus
        display = self._protocol.display_model.display
        style = self._protocol.style(stimulus.look)
        answer = self._progress.answers.get(trial.key)
        lines = []
        if not stimulus.picture:
            masks = stimulus.masks(self._protocol.display.lead_cells)
            lines.append(cells_shown(showing.line, masks, stimulus.text, under=True))
        return ViewState(
            title=self._name,
            array=array_shown(display),
            geometry=geometry_shown(style.geometry),
            rows_shown=[] if stimulus.picture else rows_shown(style, display),
            mapping=f"mapping: {style.mapping.name}",
            lines=lines,
            place=trial.name,
            device="recording",
            facts=[
                ("trial", trial.name),
                ("attempt", str(showing.attempt)),
                ("condition", trial.condition),
                ("shown", stimulus.picture or stimulus.cells),
                ("answer", "none" if answer is None else answer.data["answer"]),
            ],
        )

    def _moment(self, event: Event) -> PlayedEvent:
        told = ", ".join(str(event.data[name]) for name in _TOLD if event.data.get(name))
        text = f"{KINDS[event.kind]}{f': {told}' if told else ''}"
        trials = {trial.key: trial for trial in self._progress.plan.trials}
        trial = None if event.key is None else trials[event.key]
        if trial is None:
            return PlayedEvent(event.t_s, MOMENTS.get(event.kind, "note"), text)
        right = None
        if event.kind == "answer":
            right = self._protocol.asks.correct(trial, event.data["answer"])
        kind = MOMENTS.get(event.kind, "note")
        return PlayedEvent(event.t_s, kind, f"{trial.name}: {text}", right, trial.condition)
