"""How far a session is: what its events come to, trial by trial."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterable

    from vbraille.sessions.planning.plan import Plan, Trial

    Event = dict[str, Any]


@dataclass(slots=True)
class Showing:
    """One time that a stimulus was put under the hand.

    Parameters
    ----------
    attempt
        Of the trial, from 1.
    stimulus
        0, or 1 for the second of two to compare.
    line
        Number of it in the trace.
    trace
        File of the trace; None on paper.
    tuning
        What the experimenter had set it to, where that is not the plan's.
    """

    attempt: int
    stimulus: int
    line: int
    trace: str | None
    tuning: dict[str, float]


@dataclass(slots=True)
class TrialsTold:
    """What is known of a trial.

    Parameters
    ----------
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
        When, in seconds of the session, things last happened, by the event's name: presented, cue,
        contact, read, answer, corrected, warning.
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
        """What the experimenter had set it to in the end."""
        return self.showings[-1].tuning if self.showings else {}


class Progress:
    """The state of a session after some events.

    Parameters
    ----------
    plan
        What is to be done.
    events
        Of its journal.

    Attributes
    ----------
    trials : dict[int, Told]
        Of the planned trials, by their numbers.
    practice : dict[int, Told]
        Of the practice trials.
    begun : bool
        Whether practice is over.
    correcting : Trial or None
        Whose answer was undone, and has not been given again.
    broken : int
        Trials that were done when the last break was taken.
    tuning : dict[str, float]
        What the experimenter has set.
    runs : list of events
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

    def __init__(self, plan: Plan, events: Iterable[Event] = ()) -> None:
        self.plan = plan
        self.trials = {trial.number: TrialsTold() for trial in plan.trials}
        self.practice = {trial.number: TrialsTold() for trial in plan.practice}
        self.begun = not plan.practice
        self.correcting: Trial | None = None
        self.broken = 0
        self.tuning: dict[str, float] = {}
        self.runs: list[Event] = []
        self.line = 0
        self.script_lines: dict[str, int] = {}
        self.t_s = 0.0
        self.ended = False
        self.torn_bytes = 0
        self._answers = ""
        self._trial = 0
        self._lost: list[int] = []
        self._paused_s: float | None = None
        self._answered = 0
        for event in events:
            self.take(event)

    @property
    def next_trial(self) -> Trial | None:
        """The trial that comes next, or is open; None after the last."""
        if not self.begun:
            for trial in self.plan.practice:
                if self.practice[trial.number].answer is None:
                    return trial
        if self._answered < len(self.plan.trials):
            return self.plan.trials[self._answered]
        return None

    @property
    def last_answered(self) -> Trial | None:
        """The planned trial answered last, which an undo is about."""
        return self.plan.trials[self._answered - 1] if self._answered else None

    @property
    def done(self) -> int:
        """Planned trials that have an answer."""
        return self._answered

    def told(self, trial: Trial) -> TrialsTold:
        """What is known of a trial."""
        return (self.practice if trial.practice else self.trials)[trial.number]

    def take(self, event: Event) -> None:
        """Go on by an event."""
        self.t_s = max(self.t_s, event["t_s"])
        if "script_line" in event:
            self.script_lines[self._answers] = event["script_line"]
        handler = getattr(self, f"_take_{event['event']}", None)
        if handler is not None:
            handler(event)
        told = self._of(event)
        if told is not None:
            name = "corrected" if event.get("corrects") else event["event"]
            told.t_s[name] = event["t_s"]
            told.wall[name] = event["wall"]
        if "trial" in event and "practice" not in event:
            self._mark_lost(event["trial"])
            self._trial = event["trial"]

    def _of(self, event: Event) -> TrialsTold | None:
        if "trial" not in event:
            return None
        return (self.practice if event.get("practice") else self.trials)[event["trial"]]

    def _told(self, event: Event) -> TrialsTold:
        told = self._of(event)
        assert told is not None, f"a {event['event']} is of a trial"
        return told

    def _mark_lost(self, trial: int) -> None:
        """Mark the trials that events before one of this trial may be of."""
        first, last = sorted((self._trial or trial, trial))
        for number in range(first, last + 1) if self._lost else ():
            told = self.trials[number]
            told.lost = sorted({*told.lost, *self._lost})
        self._lost = []

    def _take_lost(self, event: Event) -> None:
        self._lost.append(event["n"])
        if self._trial:
            self.trials[self._trial].lost.append(event["n"])

    def _take_run(self, event: Event) -> None:
        self.runs.append(event)
        self._answers = event.get("answers", self._answers)
        self.torn_bytes += event.get("torn_bytes", 0)
        self._paused_s = None

    def _take_presented(self, event: Event) -> None:
        told = self._told(event)
        if event["stimulus"] == 0 and event["attempt"] != told.attempts:
            told.attempts = event["attempt"]
            told.t_s.clear()
            told.wall.clear()
            told.paused_s = 0.0
        showing = Showing(
            event["attempt"],
            event["stimulus"],
            event.get("line", 0),
            self.runs[-1].get("trace") if self.runs else None,
            event.get("tuning", {}),
        )
        told.showings.append(showing)
        self.line = max(self.line, event.get("line", 0))
        self.begun |= not event.get("practice", False)

    def _take_begin(self, _event: Event) -> None:
        self.begun = True

    def _take_answer(self, event: Event) -> None:
        told = self._told(event)
        told.answer = event["answer"]
        told.source = self._answers
        if self.correcting is not None:
            self.correcting = None
            return
        told.early = event.get("early", False)
        self._end_pause(told, event)  # what is not gone on with is over all the same
        if not event.get("practice"):
            self._answered += 1

    def _take_undo(self, event: Event) -> None:
        told = self._told(event)
        self.correcting = self.last_answered
        if told.first_answer is None:
            told.first_answer = told.answer
        told.answer = None

    def _take_fault(self, event: Event) -> None:
        told = self._of(event)
        if told is not None:
            told.faults.append(event["what"])

    def _take_pause(self, event: Event) -> None:
        self._paused_s = event["t_s"]

    def _take_go(self, event: Event) -> None:
        self._end_pause(self._of(event), event)

    def _end_pause(self, told: TrialsTold | None, event: Event) -> None:
        if told is not None and self._paused_s is not None:
            told.paused_s += event["t_s"] - self._paused_s
        self._paused_s = None

    def _take_break(self, _event: Event) -> None:
        self.broken = self._answered

    def _take_tuning(self, event: Event) -> None:
        self.tuning = event["tuning"]
        self.line = max(self.line, event.get("line", 0))
        told = self._of(event)
        if told is not None and told.showings and "line" in event:
            last = told.showings[-1]
            told.showings.append(replace(last, line=event["line"], tuning=event["tuning"]))

    def _take_end(self, _event: Event) -> None:
        self.ended = True
