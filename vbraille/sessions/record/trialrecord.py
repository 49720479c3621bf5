"""What is known about a trial, according to the events of a session."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from msgspec import structs

from vbraille.errors import VbrailleError
from vbraille.sessions.planning.planfile import stimulus_from_json
from vbraille.sessions.planning.stimuli import Stimuli

if TYPE_CHECKING:
    from vbraille.sessions.planning.stimuli import Stimulus, Trial


@dataclass(slots=True)
class Showing:
    """One time that a stimulus was put under the hand.

    Parameters
    ----------
    attempt
        Number of the attempt at the trial, from 1.
    stimulus
        Index of the stimulus in the trial: 0, or 1 for the second of two to compare.
    line
        Number of the showing in the trace.
    trace
        Name of the trace file; None on paper and on a conventional display.
    tuning
        Contrast or texture that the experimenter had set instead of the stimulus's own.
    shown
        The stimulus as the journal describes it.
    """

    attempt: int
    stimulus: int
    line: int
    trace: str | None
    tuning: dict[str, float]
    shown: dict[str, Any]

    def stimulus_of(self, trial: Trial) -> Stimulus:
        """Stimulus that was shown in a trial.

        Raises
        ------
        VbrailleError
            If the journal's description is not that of a stimulus.
        """
        try:
            return stimulus_from_json(self.shown)
        except ValueError as error:
            raise VbrailleError(
                f"the journal is damaged: it says of trial {trial.number} that it has shown what "
                f"cannot be: {error}"
            ) from None


@dataclass(slots=True)
class TrialRecord:
    """What is known about a trial.

    Parameters
    ----------
    trial
        The trial as it was planned.
    attempts
        Number of times that the trial was begun.
    answer
        Answer that counts, None before there is one; `vbraille.braille.spelling` says how it is
        written.
    first_answer
        First answer, if it was taken back; else None.
    showings
        All showings of the trial's stimuli, in order.
    faults
        What went wrong with the device during the trial, a sentence for each fault.
    t_s
        Seconds of the session at which events of each kind happened last, by the name of the kind,
        such as cue or answer. An answer after an undo is under corrected.
    wall
        Times of the same events by the wall clock.
    paused_s
        Seconds that the trial was paused after its start signal.
    unread_s
        Seconds of these before it was read to its end by key on the conventional display; 0 on
        paper, which no pause takes away.
    early
        Whether the answer came before the hand had been at the end of the string.
    source
        Source of the answer: typed, simulated:0.2, or a file's name.
    moved_by
        What moved the carriage: "person", "simulated", or "simulated:pointer" if somebody at the
        live view was the hand for a part of the trial, in any attempt; empty on paper.
    lost
        Numbers of the lost events of a salvaged journal that may belong to the trial.
    confidence
        How sure the answer that counts is, on the protocol's scale; None if that was not asked.
    ended_by
        What ended reading: the participant's key, or "answer" if the answer came before it; empty
        if the protocol has no such key.
    """

    trial: Trial
    attempts: int = 0
    answer: str | None = None
    first_answer: str | None = None
    showings: list[Showing] = field(default_factory=list)
    faults: list[str] = field(default_factory=list)
    t_s: dict[str, float] = field(default_factory=dict)
    wall: dict[str, str] = field(default_factory=dict)
    paused_s: float = 0.0
    unread_s: float = 0.0
    early: bool = False
    source: str = ""
    moved_by: str = ""
    lost: list[int] = field(default_factory=list)
    confidence: int | None = None
    ended_by: str = ""

    @property
    def response_s(self) -> float | None:
        """Seconds from the start signal to the participant's key, or else to the answer.

        Pauses are left out. None if there is no answer.
        """
        by_key = self.ended_by not in ("", "answer") and "ended" in self.t_s
        end = "ended" if by_key else "answer"
        if "cue" not in self.t_s or end not in self.t_s or "answer" not in self.t_s:
            return None
        return self.t_s[end] - self.t_s["cue"] - self.paused_s

    @property
    def last_attempt(self) -> list[Showing]:
        """Showings of the last attempt."""
        return [showing for showing in self.showings if showing.attempt == self.attempts]

    @property
    def tuning(self) -> dict[str, float]:
        """Contrast or texture that the experimenter had set at the last showing."""
        return self.showings[-1].tuning if self.showings else {}

    @property
    def shown(self) -> Trial:
        """The trial as it was shown in its last attempt, with what the experimenter had set."""
        stimuli = list(self.trial.stimuli)
        for showing in self.last_attempt:
            shown = showing.stimulus_of(self.trial)
            tuning = replace(shown.tuning, **showing.tuning)
            stimuli[showing.stimulus] = replace(shown, tuning=tuning)
        return structs.replace(self.trial, stimuli=Stimuli(stimuli))
