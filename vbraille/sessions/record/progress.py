"""Progress of a session, trial by trial, according to its events."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from msgspec import structs

from vbraille.errors import VbrailleError
from vbraille.sessions.planning.nexttrial import Answered, FixedOrder, Procedure
from vbraille.sessions.planning.plan import Plan, stimulus_from_json
from vbraille.sessions.planning.stimuli import Stimuli, Stimulus, Trial
from vbraille.sessions.record import events

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from vbraille.sessions.planning.questionnaire import AnyItem
    from vbraille.sessions.record.events import JournalEvent


@dataclass(slots=True)
class TrialRecord:
    """Record of a trial.

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
        Events of all showings of the trial's stimuli, in order.
    trace
        Name of the trace of the last attempt; None on paper and on a conventional display.
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
        What moved the carriage: "person", "simulated", or "simulated:pointer" if a person at the
        live view was the hand for a part of the trial, in any attempt; empty on paper.
    lost
        Numbers of the lost events of a salvaged journal that may belong to the trial.
    confidence
        How sure the answer that counts is, on the protocol's scale; None if that was not asked.
    ended_by
        What ended reading: the participant's key, "exposure", or "answer" if the answer came before
        these; empty if the protocol has no such key and no limit of the exposure.
    late
        Whether the answer came after the time for it, or not at all.
    missed
        Whether the trial ended without an answer, since the time for one was over.
    """

    trial: Trial
    attempts: int = 0
    answer: str | None = None
    first_answer: str | None = None
    showings: list[events.Presented] = field(default_factory=list)
    trace: str | None = None
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
    late: bool = False
    missed: bool = False

    @property
    def over(self) -> bool:
        """True if the trial is over, with an answer or without one."""
        return self.answer is not None or self.missed

    @property
    def response_s(self) -> float | None:
        """Seconds from the start signal to the participant's key, or else to the answer.

        Pauses are left out. None if there is no answer.
        """
        by_key = self.ended_by.startswith(("button:", "key:")) and "ended" in self.t_s
        end = "ended" if by_key else "answer"
        if "cue" not in self.t_s or end not in self.t_s or "answer" not in self.t_s:
            return None
        return self.t_s[end] - self.t_s["cue"] - self.paused_s

    @property
    def last_attempt(self) -> list[events.Presented]:
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
            shown = stimulus_of(showing)
            tuning = replace(shown.tuning, **showing.tuning)
            stimuli[showing.stimulus] = replace(shown, tuning=tuning)
        return structs.replace(self.trial, stimuli=Stimuli(stimuli))


# Mover of the carriage if a page of the live view was the hand.
POINTED = "simulated:pointer"


class Progress:
    """The state of a session after some events.

    Parameters
    ----------
    plan
        Plan of the session.
    events
        Events of the session's journal.
    procedure
        Rule that chooses the next trial; None for the order of the plan.

    Attributes
    ----------
    history : list[Answered]
        Trials that were answered, in order, practice left out.
    trials : dict[int, TrialRecord]
        What is known about each trial, by its number: about all that are planned, or about all
        that were chosen so far if the procedure goes by the answers.
    practice : dict[int, TrialRecord]
        What is known about each practice trial, by its number.
    begun : bool
        Whether practice is over.
    correcting : Trial or None
        Trial whose answer was taken back, and was not given anew so far.
    broken : int
        Number of trials that were answered before the last break.
    tuning : dict[str, float]
        Contrast or texture that the experimenter has set.
    runs : list[events.Run]
        Events with which the runs of the session began.
    line : int
        Largest line number used so far.
    script_lines : dict[str, int]
        Number of the last line used so far of each answers file, by the file's name.
    t_s : float
        Seconds that the session has run for.
    ended : bool
        Whether the session has ended for good.
    pointed : bool
        Whether a page of the live view is the hand.
    torn_bytes : int
        Length of all torn lines that were moved out of the journal.
    replies : dict[tuple[str, int], str]
        Answers to the questionnaire, by the question's name and the number of the trial or block
        that it was asked after; 0 at the beginning and the end.
    why : str
        Reason for which the participant stopped for good; empty if that is not so.
    """

    def __init__(
        self, plan: Plan, events: Iterable[JournalEvent] = (), procedure: Procedure | None = None
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
        self.pointed = False
        self.torn_bytes = 0
        self.replies: dict[tuple[str, int], str] = {}
        self.why = ""
        self._moved_by = ""
        self._answers = ""
        self._trial = 0
        self._lost: list[int] = []
        self._unasked = False  # an answer may be lost that the trials after it were chosen by
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
                if not record.over:
                    return record.trial
        return self._next

    @property
    def last_answered(self) -> Trial | None:
        """Trial answered last, whose answer an undo takes back; practice cannot be undone."""
        return self.history[-1].trial if self.history else None

    @property
    def done(self) -> int:
        """Number of trials that have an answer, practice left out."""
        return len(self.history)

    @property
    def found(self) -> Sequence[str]:
        """Sentences on what the answers have shown so far; none for a fixed order."""
        return self.procedure.found(self.history)

    @property
    def planned(self) -> int | None:
        """Number of trials in all, practice left out; None if it depends on the answers."""
        trials = self.procedure.trials
        return None if trials is None else len(trials)

    def due(self, items: Iterable[AnyItem], *, over: bool = False) -> tuple[AnyItem, int] | None:
        """Question that is to be asked now, and the number of its trial or block, or 0.

        Parameters
        ----------
        items
            The questionnaire.
        over
            Whether no further trial comes.
        """
        last, coming = self.last_answered, None if over else self.next_trial
        times = {"begin": 0}
        if last is not None:
            if not last.catch and not self.record_of(last).missed:
                times["trial"] = last.number
            if coming is None or coming.block != last.block:
                times["block"] = last.block
        if coming is None:
            times["end"] = 0
        for time, number in times.items():
            for item in items:
                if item.when == time and (item.name, number) not in self.replies:
                    return item, number
        return None

    def of_all(self, number: int) -> str:
        """Text for a number of trials, with the number of all trials if that is known."""
        return f"{number}" if self.planned is None else f"{number} of {self.planned}"

    def record_of(self, trial: Trial) -> TrialRecord:
        """Record of a trial, practice or not."""
        return (self.practice if trial.practice else self.trials)[trial.number]

    def take(self, event: JournalEvent) -> None:
        """Change the state as an event says.

        Raises
        ------
        VbrailleError
            If the event belongs to a trial that does not exist.
        """
        self.t_s = max(self.t_s, event.t_s)
        if event.script_line:
            self.script_lines[self._answers] = event.script_line
        record = None
        if isinstance(event, events.AnyTime) and event.trial:
            record = self._record_at(event)
        self._change(event, record)
        if record is None:
            return
        kind = "corrected" if isinstance(event, events.Answer) and event.corrects else event.kind
        record.t_s[kind] = event.t_s
        if isinstance(event, events.Answer):
            record.t_s[kind] -= event.confidence_s
        record.wall[kind] = event.wall
        if not record.trial.practice:
            self._mark_lost(record.trial.number)
            self._trial = record.trial.number

    def _ask(self) -> Trial | None:
        """Ask the procedure which trial comes after those that were answered."""
        if self._unasked:
            return None
        trial = self.procedure.next(self.history)
        if self.procedure.trials is None:
            self.trials.pop(self.done + 1, None)  # the choice made before an answer was corrected
            if trial is not None:
                self.trials[trial.number] = TrialRecord(trial)
        return trial

    def _record_at(self, event: events.AnyTime) -> TrialRecord:
        records = self.practice if event.practice else self.trials
        record = records.get(event.trial)
        if record is None and self._unasked and not event.practice:
            # The journal says what was shown; all else is as in the plan's trial of that number.
            last = next(reversed(records.values())).trial
            planned = next((t for t in self.plan.trials if t.number == event.trial), last)
            trial = structs.replace(planned, number=event.trial)
            record = records[event.trial] = TrialRecord(trial)
        if record is None:
            which = "practice trial" if event.practice else "trial"
            raise VbrailleError(
                f"the journal is damaged: event {event.n} is of {which} {event.trial}, which there "
                f"is not; nothing was changed"
            )
        return record

    def _mark_lost(self, trial: int) -> None:
        """Mark all trials that the events lost before an event of this trial may belong to."""
        first, last = sorted((self._trial or trial, trial))
        for number in range(first, last + 1) if self._lost else ():
            record = self.trials.get(number)
            if record is None:  # all events of a trial that the answers chose are lost
                continue
            record.lost = sorted({*record.lost, *self._lost})
        self._lost = []

    def _change(self, event: JournalEvent, record: TrialRecord | None) -> None:
        """Change the state by an event, and what is known of its trial if it is of one."""
        match event:
            case events.Run():
                self.runs.append(event)
                self._answers = event.answers or self._answers
                self.torn_bytes += event.torn_bytes
                self._moved_by = _mover_of(event) or self._moved_by
                self.pointed = False  # the device of the new run tells it again
                self._paused_s = None
            case events.Presented() if record:
                self._take_presented(event, record)
            case events.Answer() if record:
                self._take_answer(event, record)
            case events.Missed() if record:
                record.missed = record.late = True
                self._end_pause(record, event)
                self._go_on(event, Answered(record.trial, "", event.t_s))
            case events.Undo() if record:
                self.correcting = self.last_answered
                record.first_answer = record.first_answer or record.answer
                record.answer = None
                record.confidence = None
            case events.Fault() if record:
                record.faults.append(event.what)
            case events.Read() if record and record.showings:
                if record.trial.stimuli[0].conventional:
                    record.unread_s = record.paused_s
            case events.Tuning():
                self.tuning = event.tuning
                self.line = max(self.line, event.line)
                if record and record.showings and event.line:
                    last = record.showings[-1]
                    again = structs.replace(last, line=event.line, tuning=event.tuning)
                    record.showings.append(again)
            case events.HandTaken():
                self.pointed = True
                if record:
                    record.moved_by = POINTED
            case events.HandGivenBack():
                self.pointed = False
            case events.Pause():
                self._paused_s = event.t_s
            case events.Go():
                self._end_pause(record, event)
            case events.Break():
                self.broken = self.done
            case events.Begin():
                self.begun = True
            case events.Reply():
                self.replies[event.name, event.trial or event.block] = event.answer
                self._end_pause(record, event)
            case events.End():
                self.ended, self.why = True, event.said if event.reason else ""
            case events.Lost():
                self._lost.append(event.n)
                self._unasked = self.procedure.trials is None
                if self._trial:
                    self.trials[self._trial].lost.append(event.n)

    def _take_presented(self, event: events.Presented, record: TrialRecord) -> None:
        if event.stimulus == 0 and event.attempt != record.attempts:
            record.attempts = event.attempt
            record.t_s.clear()
            record.wall.clear()
            record.paused_s = record.unread_s = 0.0
        # What stands on a conventional display is in no trace.
        record.trace = self.runs[-1].trace or None if self.runs and event.line else None
        if record.moved_by != POINTED:
            moved_by = self._moved_by if event.line else ""  # no carriage is moved elsewhere
            record.moved_by = POINTED if self.pointed and moved_by else moved_by
        record.showings.append(event)
        self.line = max(self.line, event.line)
        self.begun |= not event.practice

    def _take_answer(self, event: events.Answer, record: TrialRecord) -> None:
        record.answer = event.answer
        record.confidence = event.confidence
        record.missed = False
        record.source = self._answers
        # What goes by the answers goes by what was felt, whatever it would choose today.
        shown = record.trial if self.procedure.trials is not None else record.shown
        answered = Answered(shown, event.answer, event.t_s)
        if self.correcting is not None:
            self.correcting = None
            self.history[-1] = answered
            if self._next is None or not self.record_of(self._next).attempts:
                self._next = self._ask()  # a trial that was shown already stays
            return
        record.early = event.early
        record.ended_by = event.ended_by
        record.late = event.late
        self._end_pause(record, event)  # an answer ends a pause
        self._go_on(event, answered)

    def _go_on(self, event: events.InTrial, answered: Answered) -> None:
        """Ask for the trial after one that is over."""
        if not event.practice:
            self.history.append(answered)
            self._next = self._ask()

    def _end_pause(self, record: TrialRecord | None, event: JournalEvent) -> None:
        if self._paused_s is not None and record and "ended" not in record.t_s:
            record.paused_s += event.t_s - self._paused_s
        self._paused_s = None


def stimulus_of(showing: events.Presented) -> Stimulus:
    """Stimulus that was shown.

    Raises
    ------
    VbrailleError
        If the journal's description is not that of a stimulus.
    """
    try:
        return stimulus_from_json(showing.shown)
    except ValueError as error:
        raise VbrailleError(
            f"the journal is damaged: it says of trial {showing.trial} that it has shown what "
            f"cannot be: {error}"
        ) from None


def _mover_of(run: events.Run) -> str:
    """Mover of the carriage in a run; empty on paper, and where the run before tells it."""
    if not run.trace or not run.spec:
        return ""
    return "simulated" if run.spec.partition(":")[0] == "sim" else "person"
