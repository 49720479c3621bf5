"""Progress of a session: what happened in each trial, and which one comes next.

The runner hands over each event once it is written. A session that is resumed hands over all events
of its record, and so is where it was.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass, field

from msgspec import structs

from vbraille.sessions.planning.plan import Plan
from vbraille.sessions.planning.procedures import Outcome, outcome_of, put
from vbraille.sessions.planning.protocol import Protocol
from vbraille.sessions.planning.questionnaire import Item, due
from vbraille.sessions.planning.trial import Stimulus, Trial
from vbraille.sessions.record.record import Event

OVER = ("answer", "missed")
DECIDING = (*OVER, "undo")


@dataclass
class Tried:
    """Events of a trial, and what they come to.

    Parameters
    ----------
    events
        All of its events.
    decided
        Kind of the newest event after which it has an answer, or has none any more.
    answer, confidence
        Events of the answer that stands, and of its confidence.
    """

    events: list[Event] = field(default_factory=list)
    decided: str = ""
    answer: Event | None = None
    confidence: Event | None = None

    def take(self, event: Event) -> None:
        """Take another event of the trial."""
        self.events.append(event)
        if event.kind in DECIDING:
            self.decided, self.confidence = event.kind, None
            self.answer = event if event.kind == "answer" else None
        elif event.kind == "confidence":
            self.confidence = event

    @property
    def attempts(self) -> int:
        """Number of times that it was shown."""
        return max((event.attempt or 0 for event in self.events), default=0)

    def of(self, *kinds: str) -> list[Event]:
        """Return the events of some kinds in the newest attempt."""
        newest = self.attempts
        return [e for e in self.events if e.attempt == newest and e.kind in kinds]

    @property
    def paused_s(self) -> float:
        """Time for which the newest attempt was paused."""
        paused_s, began_s = 0.0, None
        for event in self.of("pause", "go", "answer"):
            if event.kind == "pause":
                began_s = event.t_s
            elif began_s is not None:
                paused_s, began_s = paused_s + event.t_s - began_s, None
        return paused_s


class Progress:
    """Progress of a session.

    Attributes
    ----------
    tried : dict
        What happened in each trial, by its key.
    replies : dict
        Events of the replies that stand, by the name and the number of the trial or block.
    t_s : float
        Time that the session has run for, up to the newest event.
    runs : int
        How often the session was begun or resumed.
    line : int
        Number of the last showing.
    script_line : int
        Line of the file of answers that was used last.
    ended : bool
        Whether the session is over.
    """

    def __init__(self, protocol: Protocol, plan: Plan, events: Iterable[Event] = ()) -> None:
        self.protocol = protocol
        self.plan = plan
        self.tried: defaultdict[tuple[bool, int], Tried] = defaultdict(Tried)
        self.replies: dict[tuple[str, int], Event] = {}
        self.t_s = 0.0
        self.runs = self.line = self.script_line = 0
        self.ended = self._broken = self._practised = False
        self._trials = [trial for trial in plan.trials if not trial.practice]
        self._outcomes: dict[str, list[Outcome]] = {}
        for event in events:
            self.take(event)

    def take(self, event: Event) -> None:
        """Take another event."""
        data = event.data
        self.t_s = event.t_s
        self.line = data.get("line", self.line)
        self.script_line = data.get("script_line", self.script_line)
        self.runs += event.kind == "run"
        self.ended |= event.kind == "end"
        self._broken |= event.kind == "break"
        self._practised |= event.kind == "begin"
        if event.kind == "reply":
            self.replies[data["name"], data["number"]] = event
        elif event.kind == "undo" and "name" in data:
            self.replies.pop((data["name"], data["number"]), None)
        if event.key is not None:
            self._practised |= not event.key[0]
            self.tried[event.key].take(event)
            if event.kind in DECIDING:
                self._outcomes.clear()
                self._broken &= event.kind == "undo"

    def answer(self, trial: Trial) -> Event | None:
        """Return the answer to a trial that stands; None if there is none."""
        return self.tried[trial.key].answer

    def lacks_confidence(self, trial: Trial) -> bool:
        """Tell whether a trial has an answer, and it is still to be asked how sure that is."""
        tried = self.tried[trial.key]
        wanted = self.protocol.asks.confidence is not None
        return wanted and tried.answer is not None and tried.confidence is None

    def is_taken_back(self, trial: Trial) -> bool:
        """Tell whether the answer of a trial was taken back, and no other one was given."""
        return self.tried[trial.key].decided == "undo"

    def _is_over(self, trial: Trial) -> bool:
        return self.tried[trial.key].decided in OVER and not self.lacks_confidence(trial)

    @property
    def done(self) -> int:
        """Number of trials that are over, practice left out."""
        return sum(self.tried[trial.key].decided in OVER for trial in self._trials)

    @property
    def newest_given(self) -> Event | None:
        """The newest answer or reply that stands; None if there is none."""
        answers = [tried.answer for tried in self.tried.values() if tried.answer is not None]
        return max([*answers, *self.replies.values()], key=lambda event: event.n, default=None)

    # What comes next.

    @property
    def next_trial(self) -> Trial | None:
        """The first trial that is not over, as it is shown; None after the last."""
        for trial in self.plan.trials:
            left = not (self._is_over(trial) or (trial.practice and self.practice_is_over))
            if left and (shown := self.shown(trial)) is not None:
                return None if self._is_late and not self._is_half_done(trial) else shown
        return None

    @property
    def next_item(self) -> tuple[Item, int] | None:
        """Question that is asked now, and of which trial or block; None for nothing.

        Nothing is asked in practice, nor between a trial and its answer or confidence.
        """
        if not self.protocol.questionnaire:
            return None
        coming = self.next_trial
        if coming is not None and (coming.practice or self._is_half_done(coming)):
            return None
        last = next((trial for trial in reversed(self._trials) if self._is_over(trial)), None)
        asked = due(self.protocol.questionnaire, last, coming)
        return next((each for each in asked if (each[0].name, each[1]) not in self.replies), None)

    @property
    def why_over(self) -> str:
        """Why nothing comes next."""
        limit_s = self.protocol.session.limit_s
        return f"the limit of {limit_s:g} s is over" if self._is_late else "all trials are done"

    @property
    def _is_late(self) -> bool:
        """True if the session's time is over, so that no further trial begins."""
        limit_s = self.protocol.session.limit_s
        return limit_s is not None and self.t_s > limit_s

    def _is_half_done(self, trial: Trial) -> bool:
        return self.is_taken_back(trial) or self.lacks_confidence(trial)

    @property
    def practice_is_over(self) -> bool:
        """Tell whether a trial of a block was shown, or practice has come to its end."""
        until = self.protocol.practice.until
        if self._practised or until is None:
            return self._practised
        last = [trial for trial in self.plan.trials if trial.practice and self.answer(trial)]
        right = [self.is_right(trial) for trial in last[-until.of :]]
        return len(right) == until.of and right.count(True) >= until.right

    def is_right(self, trial: Trial) -> bool | None:
        """Tell whether the answer to a trial is right; None if there is none, or nothing is."""
        answer = self.answer(trial)
        return None if answer is None else self.protocol.asks.correct(trial, answer.data["answer"])

    def is_break_due(self, trial: Trial) -> bool:
        """Tell whether there is a break before a trial."""
        if trial.practice or self._broken or not self.done:
            return False
        every = self.protocol.session.break_every
        in_block = sum(each.block == trial.block and self._is_over(each) for each in self._trials)
        return in_block == 0 or (every is not None and in_block % every == 0)

    # Trials whose values answers choose.

    def shown(self, trial: Trial) -> Trial | None:
        """Return a trial of the plan as it is shown; None if a procedure leaves it out."""
        procedure, design = self.protocol.procedure, self.protocol.design
        if self.tried[trial.key].decided:
            return self._as_cued(trial)
        if procedure is None or trial.practice or trial.catch:
            return trial
        level = procedure.next(design, *self._history(trial.condition))
        return None if level is None else put(procedure, design, trial, level)

    def _as_cued(self, trial: Trial) -> Trial:
        """Return a trial as its newest attempt has shown it."""
        stimuli = list(trial.stimuli)
        for cue in self.tried[trial.key].of("cue"):  # the last one of each stimulus
            stimuli[cue.data["stimulus"]] = self.stimulus(trial, cue)
        return structs.replace(trial, stimuli=tuple(stimuli))

    def stimulus(self, trial: Trial, cue: Event) -> Stimulus:
        """Return a stimulus of a trial of the plan as an event of its cue has it."""
        stimulus, varied = trial.stimuli[cue.data["stimulus"]], self.protocol.varied
        return stimulus.at(varied, cue.data["value"]) if varied else stimulus

    def _history(self, condition: str) -> tuple[list[Outcome], str]:
        """Return what the answers of a condition tell a procedure, and the seed of its choices."""
        if condition not in self._outcomes:
            found = self._outcomes[condition] = []
            asks, design = self.protocol.asks, self.protocol.design
            for trial in self._trials:
                answer = self.answer(trial)
                if trial.condition == condition and answer is not None and not trial.catch:
                    shown = self._as_cued(trial)
                    level = getattr(shown.stimuli[0].look, self.protocol.varied)
                    given = answer.data["answer"]
                    found.append(outcome_of(design, asks, shown, level, given))
        seed = f"{self.protocol.name} {self.plan.participant} {self.plan.seed} {condition}"
        return self._outcomes[condition], seed

    @property
    def found(self) -> list[str]:
        """Sentences on what a procedure has found in each condition."""
        procedure, design = self.protocol.procedure, self.protocol.design
        if procedure is None:
            return []
        conditions = dict.fromkeys(trial.condition for trial in self._trials)
        found = {each: procedure.found(design, *self._history(each)) for each in conditions}
        return [f"{condition}: {said}" for condition, said in found.items() if said]
