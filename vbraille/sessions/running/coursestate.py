"""Where a session is: which trial is open, and how far it has been read."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from vbraille.sessions.planning.standing import is_conventional
from vbraille.sessions.running.phases import Phase

if TYPE_CHECKING:
    from vbraille.render.braille.profiles import Tuning
    from vbraille.sessions.planning.plan import Plan
    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.planning.stimuli import Trial
    from vbraille.sessions.record.progress import Progress
    from vbraille.sessions.running.conventional import OnConventional
    from vbraille.sessions.running.halfanswer import HalfAnswer
    from vbraille.sessions.running.showing import OnDevice


class CourseState:
    """Where the course of a session is.

    Parameters
    ----------
    protocol, plan
        What the session shows, and in which order.
    progress
        State of the session, which every event updates.
    display
        Display of the stimuli; None on paper.
    beside
        Conventional display of the session; None without one.

    Attributes
    ----------
    phase : Phase
        What the session waits for.
    paused : bool
        Whether the session is paused, so that the array rests.
    read_said : bool
        Whether the experimenter has been told that the trial is read; on paper, whether a key has
        said so.
    half : HalfAnswer or None
        Answer whose confidence is waited for.
    ended_by : str
        Key by which the participant has ended reading; empty before.
    stimulus : int
        Which stimulus of the open trial is shown: 0, or 1 for the second of two.
    break_wanted : bool
        Whether the experimenter has asked for a break that has not begun.
    """

    def __init__(
        self,
        protocol: Protocol,
        plan: Plan,
        progress: Progress,
        display: OnDevice | None,
        beside: OnConventional | None,
    ) -> None:
        self.protocol = protocol
        self.plan = plan
        self.progress = progress
        self.display = display
        self.beside = beside
        self.phase = Phase.READY
        self.paused = False
        self.read_said = False
        self.half: HalfAnswer | None = None
        self.ended_by = ""
        self.stimulus = 0
        self.break_wanted = False

    @property
    def trial(self) -> Trial | None:
        """Trial that is open or comes next; None after the last."""
        return self.progress.next_trial

    @property
    def open_trial(self) -> Trial | None:
        """Trial that is open; None if none is."""
        return self.trial if self.phase is Phase.OPEN else None

    @property
    def by_key(self) -> bool:
        """Whether Enter times the trial that is open or comes next, since no device feels it.

        It is read on paper, or on the conventional display.
        """
        return self.display is None or self._stands is not None

    @property
    def _stands(self) -> OnConventional | None:
        """Conventional display, if the trial that is open or comes next stands on it."""
        trial = self.trial
        return self.beside if trial is not None and is_conventional(trial.stimuli[0]) else None

    @property
    def _referred(self) -> OnConventional | None:
        """Conventional display, if what the next trial is compared with stands on it."""
        return self.beside if self.protocol.conventional.reference and not self.by_key else None

    @property
    def read(self) -> bool:
        """Whether the open trial has been read to its end."""
        trial = self.open_trial
        if trial is None or self.stimulus + 1 < len(trial.stimuli):
            return False
        return self.read_said if self.display is None or self.by_key else self.display.read

    @property
    def reached(self) -> bool:
        """Whether the hand has been at the end of the open trial; on paper, whether it is read."""
        return self.read_said if self.display is None or self.by_key else self.display.reached

    @property
    def second_to_come(self) -> bool:
        """Whether a stimulus of the open trial has not been shown yet."""
        trial = self.open_trial
        return trial is not None and self.stimulus + 1 < len(trial.stimuli)

    def name(self, trial: Trial) -> str:
        """Name of a trial in sentences for the experimenter."""
        if trial.practice:
            return f"practice {trial.number} of {len(self.plan.practice)}"
        return f"trial {self.progress.of_all(trial.number)}"

    @property
    def reading(self) -> bool:
        """Whether a stimulus is read, so that the participant's key may end it."""
        display = self.display
        if self.open_trial is None or display is None or display.ended or self.by_key:
            return False
        return not (self.paused or self.half or self.ended_by)

    @property
    def over(self) -> bool:
        """Whether the session has lasted as long as the protocol allows."""
        limit_s = self.protocol.session.limit_s
        return limit_s is not None and self.progress.t_s >= limit_s

    def break_due(self, trial: Trial) -> bool:
        """Whether there is a break before a trial that comes next."""
        done = self.progress.done
        if self.break_wanted:
            return True
        if trial.practice or done == self.progress.broken:
            return False
        every = self.protocol.session.break_every
        in_block = sum(past.trial.block == trial.block for past in self.progress.history)
        return not in_block or (every is not None and in_block % every == 0)

    def warning_due(self, trial: Trial, since_cue_s: float) -> bool:
        """Whether the warning is due so long after the start signal, pauses included."""
        warning_s = self.protocol.trial.warning_s
        told = self.progress.told(trial)
        if warning_s is None or "warning" in told.t_s:
            return False
        return since_cue_s - told.paused_s >= warning_s

    def tuning_of(self, trial: Trial) -> Tuning:
        """Tuning of the stimulus that is shown, with what the experimenter has set instead."""
        return replace(trial.stimuli[self.stimulus].tuning, **self.progress.tuning)

    @property
    def prompt(self) -> str:
        """What the experimenter is to type as an answer."""
        return "the answer" if self.protocol.question is None else self.protocol.question.typed

    def told_ready(self, trial: Trial, *, waits: bool) -> str:
        """Sentence that says that a trial is ready, to somebody who presses keys if it waits."""
        again = ", again" if self.progress.told(trial).attempts else ""
        how = "; Enter when reading begins" if self.by_key and waits else ""
        if self._stands is not None:
            how = f", on the conventional display{how}"
        return f"ready: {self.name(trial)}{again}{how}"

    def told_read(self, trial: Trial) -> str:
        """Sentence that says how long a trial was read off the device, and what to type."""
        told = self.progress.told(trial)
        seconds = told.t_s["read"] - told.t_s["cue"] - told.unread_s
        return f"read: {seconds:.1f} s; type {self.prompt}"

    def told_ended(self, trial: Trial, key: str) -> str:
        """Sentence that says when the participant's key ended a trial, and what to type."""
        told = self.progress.told(trial)
        seconds = told.t_s["ended"] - told.t_s["cue"] - told.paused_s
        return f"ended: {seconds:.2f} s, by {key}; type {self.prompt}"
