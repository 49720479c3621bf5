"""How far a session has come: which answers stand, and which trial comes next.

The runner hands over each event once it is written. A session that is resumed hands over all events
of its record, and so is where it was.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable

from vbraille.sessions.planning.plan import Plan
from vbraille.sessions.planning.procedures import Outcome
from vbraille.sessions.planning.protocol import Protocol
from vbraille.sessions.planning.questionnaire import Item, due
from vbraille.sessions.planning.trial import Trial
from vbraille.sessions.record.record import Event

Key = tuple[bool, int]


class Progress:
    """Progress of a session.

    Attributes
    ----------
    events : dict
        Events of each trial, by its key.
    answers, confidences : dict
        Events of the answers that stand, and of their confidences, by the trials' keys.
    replies : dict
        Replies to the questionnaire, by the name and the number of the trial or block.
    last : Event or None
        The newest event.
    runs : int
        How often the session was begun or resumed.
    line : int
        Number of the last showing.
    script_line : int
        Line of the file of answers that was used last.
    """

    def __init__(self, protocol: Protocol, plan: Plan, events: Iterable[Event] = ()) -> None:
        self.protocol = protocol
        self.plan = plan
        self.events: defaultdict[Key, list[Event]] = defaultdict(list)
        self.answers: dict[Key, Event] = {}
        self.confidences: dict[Key, Event] = {}
        self.replies: dict[tuple[str, int], str] = {}
        self.last: Event | None = None
        self.runs = self.line = self.script_line = 0
        self.ended = self._broken = False
        for event in events:
            self.take(event)

    def take(self, event: Event) -> None:
        """Take another event."""
        self.last = event
        self.line = event.data.get("line", self.line)
        self.script_line = event.data.get("script_line", self.script_line)
        self.runs += event.kind == "run"
        self.ended |= event.kind == "end"
        if event.kind == "reply":
            self.replies[event.data["name"], event.data["number"]] = event.data["reply"]
        if event.kind == "break":
            self._broken = True
        if (key := event.key) is None:
            return
        self.events[key].append(event)
        if event.kind == "answer":
            self.answers[key] = event
            self._broken = False
        elif event.kind == "confidence":
            self.confidences[key] = event
        elif event.kind == "undo":
            self.answers.pop(key, None)
            self.confidences.pop(key, None)

    @property
    def t_s(self) -> float:
        """Time that the session has run for, up to the newest event."""
        return 0.0 if self.last is None else self.last.t_s

    @property
    def next_trial(self) -> Trial | None:
        """The first trial that lacks an answer or its confidence; None after the last."""
        for trial in self.plan.trials:
            if trial.practice and self.practice_is_over:
                continue
            if trial.key in self.answers and not self.lacks_confidence(trial):
                continue
            if (shown := self.shown(trial)) is not None:
                return shown
        return None

    @property
    def next_item(self) -> tuple[Item, int] | None:
        """What the questionnaire asks now, and of which trial or block; None for nothing."""
        trials = [trial for trial in self.plan.trials if not trial.practice]
        asked = due(self.protocol.questionnaire, trials, self.done)
        return next((each for each in asked if (each[0].name, each[1]) not in self.replies), None)

    def shown(self, trial: Trial) -> Trial | None:
        """Return a trial of the plan as it is shown; None if a procedure leaves it out."""
        procedure = self.protocol.procedure
        if procedure is None or trial.practice:
            return trial
        cues = [e.data["value"] for e in self.events[trial.key] if e.kind == "cue"]
        seed = f"{self.protocol.name} {self.plan.participant} {self.plan.seed} {trial.condition}"
        value = cues[-1] if cues else procedure.next(self._outcomes(trial.condition), seed)
        return None if value is None else trial.at(procedure.parameter, value)

    def _outcomes(self, condition: str) -> list[Outcome]:
        """Return the values that were shown in a condition, with their answers."""
        found = []
        for trial in self.plan.trials:
            if trial.condition == condition and not trial.practice and trial.key in self.answers:
                answer = self.answers[trial.key].data["answer"]
                value = next(e.data["value"] for e in self.events[trial.key] if e.kind == "cue")
                found.append(Outcome(value, self.protocol.asks.positive(trial, answer)))
        return found

    @property
    def last_answered(self) -> Trial | None:
        """The trial that was answered last; None if no answer stands."""
        if not self.answers:
            return None
        newest = max(self.answers.values(), key=lambda event: event.n)
        return next(trial for trial in self.plan.trials if trial.key == newest.key)

    @property
    def done(self) -> int:
        """Number of trials with an answer, practice left out."""
        return sum(not practice for practice, _ in self.answers)

    @property
    def practice_is_over(self) -> bool:
        """Tell whether a trial of a block was shown, or practice has come to its criterion."""
        if any(not practice for practice, _ in self.events):
            return True
        until = self.protocol.practice.until
        if until is None:
            return False
        last = [trial for trial in self.plan.trials if trial.practice and trial.key in self.answers]
        asks = self.protocol.asks
        right = [asks.correct(t, self.answers[t.key].data["answer"]) for t in last[-until.of :]]
        return len(right) == until.of and right.count(True) >= until.right

    def lacks_confidence(self, trial: Trial) -> bool:
        """Tell whether a trial has an answer, and it is still to be asked how sure that is."""
        wanted = self.protocol.asks.confidence is not None
        return wanted and trial.key in self.answers and trial.key not in self.confidences

    def is_taken_back(self, trial: Trial) -> bool:
        """Tell whether the answer of a trial was taken back, and no other one was given."""
        kinds = [e.kind for e in self.events[trial.key] if e.kind in ("answer", "undo")]
        return kinds[-1:] == ["undo"]

    def attempts(self, trial: Trial) -> int:
        """Tell how often a trial was shown."""
        return max((event.attempt or 0 for event in self.events[trial.key]), default=0)

    def is_break_due(self, trial: Trial) -> bool:
        """Tell whether there is a break before a trial."""
        if trial.practice or self._broken or not self.done:
            return False
        every = self.protocol.session.break_every
        in_block = sum(
            each.block == trial.block and each.key in self.answers for each in self.plan.trials
        )
        return in_block == 0 or (every is not None and in_block % every == 0)
