"""A session played back: its frames made again from the ticks, and its events beside them."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from vbraille.errors import InputError
from vbraille.live.messages import PlayedEvent, ViewState
from vbraille.live.states import array_shown
from vbraille.playback.recorded import PLAYED, Piece, Playback
from vbraille.sessions.record.record import KINDS, Event
from vbraille.sessions.record.replay import Replay
from vbraille.sessions.running.liveview import stimulus_shown

SAID = ("answer", "what", "text", "why", "by")  # what of an event's data is said


class SessionPlayback(Playback):
    """Frames of a session, a piece for each showing of a stimulus.

    Raises
    ------
    InputError
        If it has no frames.
    RecordError
        If it cannot be read, or is open in a console.
    """

    def __init__(self, path: Path) -> None:
        super().__init__()
        self._replay = Replay(path)
        content = self._replay.content
        if not self._replay.progress.ended:
            self.notes.append(
                "the session has not ended; a participant who goes on with it should not see this"
            )
        self._showings = list(self._replay.showings.values())
        if not self._showings:
            raise InputError(f"{path} has no frames to play")
        self.pieces = len(self._showings)
        self._trials = {trial.key: trial for trial in content.plan.trials}
        self.moments = [self._moment(event) for event in content.events]
        self.length_s = max(event.t_s for event in content.events)

    def first_s(self, number: int) -> float:
        """Give the time at which a stimulus was shown, in seconds of the session."""
        return self._showings[number].cue.t_s

    def read(self, number: int) -> Piece:
        """Make the frames of a showing again."""
        ticks, frames = self._replay.frames(self._showings[number].line)
        played = np.zeros(len(ticks), PLAYED)
        for name in set(PLAYED.names or ()) & set(ticks.dtype.names or ()):
            played[name] = ticks[name]
        if ticks.size:
            since_s = (ticks["time_ns"] - ticks["time_ns"][0]) / 1e9
            played["time_s"] = np.maximum.accumulate(self.first_s(number) + since_s)
        played["scene"] = number + 1
        return Piece(played, frames.astype(np.float32))

    def describe(self, scene: int) -> ViewState:
        """Make what a page shows of a showing."""
        line, cue, trial, stimulus = self._showings[max(scene - 1, 0)]
        protocol, display = self._replay.protocol, self._replay.protocol.display_model.display
        answer = self._replay.progress.answer(trial)
        return ViewState(
            title=f"{self._replay.content.plan.participant}: {protocol.name}",
            array=array_shown(display),
            place=trial.name,
            device="recording",
            facts=[
                ("trial", trial.name),
                ("attempt", str(cue.attempt)),
                ("condition", trial.condition),
                ("shown", stimulus.picture or stimulus.cells),
                ("answer", "none" if answer is None else answer.data["answer"]),
            ],
            **stimulus_shown(protocol, stimulus, line, display),
        )

    def _moment(self, event: Event) -> PlayedEvent:
        said = ", ".join(str(event.data[name]) for name in SAID if event.data.get(name))
        text = f"{KINDS[event.kind].meaning}{f': {said}' if said else ''}"
        kind = KINDS[event.kind].moment
        trial = self._trials[event.key] if event.key else None
        if trial is None:
            return PlayedEvent(event.t_s, kind, text)
        right = None
        if event.kind == "answer":
            right = self._replay.protocol.asks.correct(trial, event.data["answer"])
        return PlayedEvent(event.t_s, kind, f"{trial.name}: {text}", right)
