"""Progress of a session: which answers stand, and which trial comes next.

The runner hands over each event once it is written. A session that is resumed hands over all events
of its record, and so is where it was.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable

from vbraille.sessions.planning.plan import Plan
from vbraille.sessions.planning.procedures import Outcome, outcome_of, put
from vbraille.sessions.planning.protocol import Protocol
from vbraille.sessions.planning.questionnaire import Item, due
from vbraille.sessions.planning.trial import Trial
from vbraille.sessions.record.record import Event

Key = tuple[bool, int]
DECIDING = ("answer", "undo", "missed")


class Progress:
    """Progress of a session.

    Attributes
    ----------
    events : dict
        Events of each trial, by its key.
    answers, confidences : dict
        Events of the answers that stand, and of their confidences, by the trials' keys.
    missed : set
        Keys of the trials that are over without an answer.
    replies : dict
        Events of the replies that stand, by the name and the number of the trial or block.
    last : Event or None
        The newest event.
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
        self.events: defaultdict[Key, list[Event]] = defaultdict(list)
        self.answers: dict[Key, Event] = {}
        self.confidences: dict[Key, Event] = {}
        self.missed: set[Key] = set()
        self.replies: dict[tuple[str, int], Event] = {}
        self.last: Event | None = None
        self.runs = self.line = self.script_line = 0
        self.ended = self._broken = self._practised = False
        self._trials = [trial for trial in plan.trials if not trial.practice]
        self._in_conditions: defaultdict[str, list[Trial]] = defaultdict(list)
        for trial in self._trials:
            self._in_conditions[trial.condition].append(trial)
        self._outcomes: dict[str, list[Outcome]] = {}
        for event in events:
            self.take(event)

    def take(self, event: Event) -> None:
        """Take another event."""
        self.last = event
        data = event.data
        self.line = data.get("line", self.line)
        self.script_line = data.get("script_line", self.script_line)
        self.runs += event.kind == "run"
        self.ended |= event.kind == "end"
        self._practised |= event.kind == "begin"
        if event.kind == "reply":
            self.replies[data["name"], data["number"]] = event
        elif event.kind == "undo" and "name" in data:
            self.replies.pop((data["name"], data["number"]), None)
        elif event.kind == "break":
            self._broken = True
        key = event.key
        if key is None:
            return
        self._practised |= not key[0]
        self.events[key].append(event)
        if event.kind in DECIDING:
            self._decide(event, key)
        elif event.kind == "confidence":
            self.confidences[key] = event

    def _decide(self, event: Event, key: Key) -> None:
        """Take an event after which a trial has an answer, or has none any more."""
        self.answers.pop(key, None)
        self.confidences.pop(key, None)
        self.missed.discard(key)
        self._outcomes.clear()
        if event.kind == "answer":
            self.answers[key] = event
            self._broken = False
        elif event.kind == "missed":
            self.missed.add(key)
            self._broken = False

    @property
    def t_s(self) -> float:
        """Time that the session has run for, up to the newest event."""
        return 0.0 if self.last is None else self.last.t_s

    def _is_over(self, trial: Trial) -> bool:
        if trial.key in self.missed:
            return True
        return trial.key in self.answers and not self.lacks_confidence(trial)

    @property
    def next_trial(self) -> Trial | None:
        """The first trial that is not over, as it is shown; None after the last."""
        for trial in self.plan.trials:
            left = not (self._is_over(trial) or (trial.practice and self.practice_is_over))
            if left and (shown := self.shown(trial)) is not None:
                return shown
        return None

    @property
    def next_item(self) -> tuple[Item, int] | None:
        """Question that is asked now, and of which trial or block; None for nothing."""
        if not self.protocol.questionnaire:
            return None
        last = next((trial for trial in reversed(self._trials) if self._is_over(trial)), None)
        asked = due(self.protocol.questionnaire, last, self.next_trial)
        return next((each for each in asked if (each[0].name, each[1]) not in self.replies), None)

    def shown(self, trial: Trial) -> Trial | None:
        """Return a trial of the plan as it is shown; None if a procedure leaves it out."""
        procedure, varied = self.protocol.procedure, self.protocol.varied
        events = self.events.get(trial.key, ())
        if any(event.kind in DECIDING for event in events):
            newest = max(event.attempt or 0 for event in events)
            cues = [e.data for e in events if e.kind == "cue" and e.attempt == newest]
            if not varied or not cues:
                return trial
            if not trial.values:
                return trial.at(varied, cues[-1]["value"])
            values = dict(enumerate(trial.values))
            values |= {cue["stimulus"]: cue["value"] for cue in cues}  # the last one of each
            return trial.with_values(varied, list(values.values()))
        if procedure is None or trial.practice or trial.catch:
            return trial
        history = self._history(trial.condition)
        level = procedure.next(self.protocol.design, history, self._seed(trial.condition))
        return None if level is None else put(procedure, self.protocol.design, trial, level)

    def _seed(self, condition: str) -> str:
        return f"{self.protocol.name} {self.plan.participant} {self.plan.seed} {condition}"

    def _history(self, condition: str) -> list[Outcome]:
        """Return what the answers of a condition tell a procedure."""
        if condition not in self._outcomes:
            found = self._outcomes[condition] = []
            asks, design = self.protocol.asks, self.protocol.design
            for trial in self._in_conditions[condition]:
                event = self.answers.get(trial.key)
                shown = None if event is None or trial.catch else self.shown(trial)
                if event is not None and shown is not None:
                    level = getattr(shown.stimuli[0].look, self.protocol.varied)
                    given = event.data["answer"], event.t_s
                    found.append(outcome_of(design, asks, shown, level, *given))
        return self._outcomes[condition]

    @property
    def found(self) -> list[str]:
        """Sentences on what a procedure has found in each condition."""
        procedure = self.protocol.procedure
        sentences: list[str] = []
        if procedure is None:
            return sentences
        for condition in self._in_conditions:
            history, seed = self._history(condition), self._seed(condition)
            if said := procedure.found(self.protocol.design, history, seed):
                sentences.append(f"{condition}: {said}")
        return sentences

    @property
    def newest_given(self) -> Event | None:
        """The newest answer or reply that stands; None if there is none."""
        given = [*self.answers.values(), *self.replies.values()]
        return max(given, key=lambda event: event.n, default=None)

    @property
    def done(self) -> int:
        """Number of trials that are over, practice left out."""
        return sum(not practice for practice, _ in (*self.answers, *self.missed))

    @property
    def practice_is_over(self) -> bool:
        """Tell whether a trial of a block was shown, or practice has come to its end."""
        until = self.protocol.practice.until
        if self._practised or until is None:
            return self._practised
        asks = self.protocol.asks
        last = [trial for trial in self.plan.trials if trial.practice and trial.key in self.answers]
        right = [asks.correct(t, self.answers[t.key].data["answer"]) for t in last[-until.of :]]
        return len(right) == until.of and right.count(True) >= until.right

    def lacks_confidence(self, trial: Trial) -> bool:
        """Tell whether a trial has an answer, and it is still to be asked how sure that is."""
        wanted = self.protocol.asks.confidence is not None
        return wanted and trial.key in self.answers and trial.key not in self.confidences

    def is_taken_back(self, trial: Trial) -> bool:
        """Tell whether the answer of a trial was taken back, and no other one was given."""
        kinds = [e.kind for e in self.events.get(trial.key, ()) if e.kind in DECIDING]
        return kinds[-1:] == ["undo"]

    def attempts(self, trial: Trial) -> int:
        """Tell how often a trial was shown."""
        return max((event.attempt or 0 for event in self.events.get(trial.key, ())), default=0)

    def is_break_due(self, trial: Trial) -> bool:
        """Tell whether there is a break before a trial."""
        if trial.practice or self._broken or not self.done:
            return False
        every = self.protocol.session.break_every
        in_block = sum(each.block == trial.block and self._is_over(each) for each in self._trials)
        return in_block == 0 or (every is not None and in_block % every == 0)
