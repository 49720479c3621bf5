"""How far a session is: what its events come to, trial by trial."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from msgspec import structs

from vbraille.errors import VbrailleError
from vbraille.sessions.planning.planfile import stimulus_from_json
from vbraille.sessions.planning.procedure import Answered, FixedOrder
from vbraille.sessions.planning.stimuli import Stimuli
from vbraille.sessions.record import events

if TYPE_CHECKING:
    from collections.abc import Iterable

    from vbraille.sessions.planning.plan import Plan
    from vbraille.sessions.planning.procedure import Procedure
    from vbraille.sessions.planning.stimuli import Stimulus, Trial
    from vbraille.sessions.record.events import Event


@dataclass(slots=True)
class Showing:
    """One time that a stimulus was put under the hand.

    Parameters
    ----------
    attempt
        Which attempt of the trial it was, from 1.
    stimulus
        0, or 1 for the second of two to compare.
    line
        Number of it in the trace.
    trace
        File of the trace; None on paper.
    tuning
        What the experimenter had set, instead of the stimulus's own.
    shown
        The stimulus as the journal has it; empty before format 4.
    """

    attempt: int
    stimulus: int
    line: int
    trace: str | None
    tuning: dict[str, float]
    shown: dict[str, Any]

    def stimulus_of(self, trial: Trial) -> Stimulus:
        """What was shown: as the journal has it, and before format 4 as the trial was planned.

        Raises
        ------
        VbrailleError
            If what the journal has is no stimulus.
        """
        if not self.shown:
            return trial.stimuli[self.stimulus]
        try:
            return stimulus_from_json(self.shown)
        except ValueError as error:
            raise VbrailleError(
                f"the journal is damaged: it says of trial {trial.number} that it has shown what "
                f"cannot be: {error}"
            ) from None


@dataclass(slots=True)
class TrialRecord:
    """What is known of a trial.

    Parameters
    ----------
    trial
        The trial as it was planned.
    attempts
        How often it was begun.
    answer
        The one that counts, None before there is one; `vbraille.braille.spelling` says
        how it is written.
    first_answer
        The one before an undo.
    showings
        All of them, in order.
    faults
        What went wrong with the device while it ran.
    t_s
        When, in seconds of the session, things last happened, by the kind of the event: presented,
        cue, contact, read, answer, warning; corrected for an answer after an undo.
    wall
        The same, by the wall clock.
    paused_s
        How long it was paused since the cue.
    early
        Whether it was answered before the hand had been at its end.
    source
        Where the answer came from: typed, simulated:0.2, a file's name.
    lost
        Numbers of events that are not whole in a journal that was salvaged, and may be of it.
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
    early: bool = False
    source: str = ""
    lost: list[int] = field(default_factory=list)

    @property
    def last_attempt(self) -> list[Showing]:
        """Showings of the last attempt."""
        return [showing for showing in self.showings if showing.attempt == self.attempts]

    @property
    def tuning(self) -> dict[str, float]:
        """What the experimenter had set in the end."""
        return self.showings[-1].tuning if self.showings else {}

    @property
    def shown(self) -> Trial:
        """The trial with what was shown in its last attempt."""
        stimuli = list(self.trial.stimuli)
        for showing in self.last_attempt:
            stimuli[showing.stimulus] = showing.stimulus_of(self.trial)
        return structs.replace(self.trial, stimuli=Stimuli(stimuli))


class Progress:
    """The state of a session after some events.

    Parameters
    ----------
    plan
        What is to be done.
    events
        The events of its journal.
    procedure
        What says which trial comes next; without one, the order of the plan does.

    Attributes
    ----------
    history : list[Answered]
        The trials that were answered, in their order, practice left out.
    trials : dict[int, TrialRecord]
        What is known of the trials, by their numbers: of all that are planned, or if the procedure
        goes by the answers, of all that it has asked for.
    practice : dict[int, TrialRecord]
        The same of the practice trials.
    begun : bool
        Whether practice is over.
    correcting : Trial or None
        The trial whose answer was undone, and has not been given again.
    broken : int
        Trials that were done when the last break was taken.
    tuning : dict[str, float]
        What the experimenter has set.
    runs : list[events.Run]
        Each time the session was run, or its engine started again.
    line : int
        Largest line number used so far.
    script_lines : dict[str, int]
        Lines used so far of each answers file, by its name.
    t_s : float
        Seconds that the session has run for.
    ended : bool
        Whether it is over: all trials done, or its time.
    torn_bytes : int
        Length of what was set aside of the journal, in all.
    """

    def __init__(
        self, plan: Plan, events: Iterable[Event] = (), procedure: Procedure | None = None
    ) -> None:
        self.plan = plan
        self.procedure = FixedOrder(plan.trials) if procedure is None else procedure
        self.history: list[Answered] = []
        self.trials = {trial.number: TrialRecord(trial) for trial in self.procedure.trials or ()}
        self.practice = {trial.number: TrialRecord(trial) for trial in plan.practice}
        self.begun = not plan.practice
        self.correcting: Trial | None = None
        self.broken = 0
        self.tuning: dict[str, float] = {}
        self.runs: list[events.Run] = []
        self.line = 0
        self.script_lines: dict[str, int] = {}
        self.t_s = 0.0
        self.ended = False
        self.torn_bytes = 0
        self._answers = ""
        self._trial = 0
        self._lost: list[int] = []
        self._paused_s: float | None = None
        self._next = self._ask()
        for event in events:
            self.take(event)

    def __repr__(self) -> str:
        ended = ", ended" if self.ended else ""
        return f"<Progress: {self.of_all(self.done)} trials have answers{ended}>"

    @property
    def next_trial(self) -> Trial | None:
        """The trial that comes next, or is open; None after the last."""
        if not self.begun:
            for record in self.practice.values():
                if record.answer is None:
                    return record.trial
        return self._next

    @property
    def last_answered(self) -> Trial | None:
        """The trial answered last, which an undo is about; practice cannot be undone."""
        return self.history[-1].trial if self.history else None

    @property
    def done(self) -> int:
        """Trials that have an answer, practice left out."""
        return len(self.history)

    @property
    def planned(self) -> int | None:
        """How many trials there are in all, practice left out; None if the answers say it."""
        trials = self.procedure.trials
        return None if trials is None else len(trials)

    def of_all(self, number: int) -> str:
        """Say a number of trials, and of how many, if that is known."""
        return f"{number}" if self.planned is None else f"{number} of {self.planned}"

    def told(self, trial: Trial) -> TrialRecord:
        """What is known of a trial."""
        return (self.practice if trial.practice else self.trials)[trial.number]

    def take(self, event: Event) -> None:
        """Go on by an event.

        Raises
        ------
        VbrailleError
            If it is of a trial that there is not.
        """
        self.t_s = max(self.t_s, event.t_s)
        if event.script_line:
            self.script_lines[self._answers] = event.script_line
        record = (
            self._record_of(event) if isinstance(event, events.AnyTime) and event.trial else None
        )
        if record is None:
            self._take_between(event)
            return
        self._take_in(event, record)
        kind = "corrected" if isinstance(event, events.Answer) and event.corrects else event.kind
        record.t_s[kind] = event.t_s
        record.wall[kind] = event.wall
        if not record.trial.practice:
            self._mark_lost(record.trial.number)
            self._trial = record.trial.number

    def _ask(self) -> Trial | None:
        """Ask which trial comes after those that were answered."""
        trial = self.procedure.next(self.history)
        if self.procedure.trials is None:
            self.trials.pop(self.done + 1, None)  # what came before an answer was corrected
            if trial is not None:
                self.trials[trial.number] = TrialRecord(trial)
        return trial

    def _record_of(self, event: events.AnyTime) -> TrialRecord:
        record = (self.practice if event.practice else self.trials).get(event.trial)
        if record is None:
            which = "practice trial" if event.practice else "trial"
            raise VbrailleError(
                f"the journal is damaged: event {event.n} is of {which} {event.trial}, which there "
                f"is not; nothing was changed"
            )
        return record

    def _mark_lost(self, trial: int) -> None:
        """Mark the trials that events before one of this trial may be of."""
        first, last = sorted((self._trial or trial, trial))
        for number in range(first, last + 1) if self._lost else ():
            record = self.trials[number]
            record.lost = sorted({*record.lost, *self._lost})
        self._lost = []

    def _take_between(self, event: Event) -> None:
        """Take an event that is of no trial."""
        match event:
            case events.Run():
                self.runs.append(event)
                self._answers = event.answers or self._answers
                self.torn_bytes += event.torn_bytes
                self._paused_s = None
            case events.Tuning():
                self.tuning = event.tuning
            case events.Pause():
                self._paused_s = event.t_s
            case events.Go():
                self._paused_s = None
            case events.Break():
                self.broken = self.done
            case events.Begin():
                self.begun = True
            case events.End():
                self.ended = True
            case events.Lost():
                self._lost.append(event.n)
                if self._trial:
                    self.trials[self._trial].lost.append(event.n)

    def _take_in(self, event: Event, record: TrialRecord) -> None:
        """Take an event that is of a trial."""
        match event:
            case events.Presented():
                self._take_presented(event, record)
            case events.Answer():
                self._take_answer(event, record)
            case events.Undo():
                self.correcting = self.last_answered
                record.first_answer = record.first_answer or record.answer
                record.answer = None
            case events.Fault():
                record.faults.append(event.what)
            case events.Pause():
                self._paused_s = event.t_s
            case events.Go():
                self._end_pause(record, event)
            case events.Tuning():
                self.tuning = event.tuning
                self.line = max(self.line, event.line)
                if record.showings and event.line:
                    last = record.showings[-1]
                    record.showings.append(replace(last, line=event.line, tuning=event.tuning))

    def _take_presented(self, event: events.Presented, record: TrialRecord) -> None:
        if event.stimulus == 0 and event.attempt != record.attempts:
            record.attempts = event.attempt
            record.t_s.clear()
            record.wall.clear()
            record.paused_s = 0.0
        trace = self.runs[-1].trace or None if self.runs else None
        record.showings.append(
            Showing(event.attempt, event.stimulus, event.line, trace, event.tuning, event.shown)
        )
        self.line = max(self.line, event.line)
        self.begun |= not event.practice

    def _take_answer(self, event: events.Answer, record: TrialRecord) -> None:
        record.answer = event.answer
        record.source = self._answers
        answered = Answered(record.trial, event.answer)
        if self.correcting is not None:
            self.correcting = None
            self.history[-1] = answered
            if self._next is None or not self.told(self._next).attempts:
                self._next = self._ask()  # what was shown already stays, whatever would be now
            return
        record.early = event.early
        self._end_pause(record, event)  # what is not gone on with is over all the same
        if not event.practice:
            self.history.append(answered)
            self._next = self._ask()

    def _end_pause(self, record: TrialRecord, event: Event) -> None:
        if self._paused_s is not None:
            record.paused_s += event.t_s - self._paused_s
        self._paused_s = None
