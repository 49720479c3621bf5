"""Trials that are chosen by the answers.

The plan is a deck of trials, made before the session as for a fixed order: it has the order of
conditions, blocks and strings, and where two values are compared, which of the two comes first.
A procedure takes the next trial of the deck and decides the values that it is shown with.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from msgspec import structs

from vbraille.adaptive.staircase import Asked
from vbraille.sessions.planning.design import Choice
from vbraille.sessions.planning.procedures import (
    FixedProcedure,
    QuestProcedure,
    StaircaseProcedure,
)
from vbraille.sessions.planning.stimuli import KNOBS, Stimuli, Trial, value_at, with_value

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from vbraille.sessions.planning.plan import Plan
    from vbraille.sessions.planning.protocol import Protocol


@dataclass(frozen=True, slots=True)
class Answered:
    """A trial that was answered.

    Parameters
    ----------
    trial
        The trial; as it was shown, if the answers choose what is shown.
    answer
        The answer that counts; `vbraille.braille.spelling` says how it is written. Empty if the
        time for it was over.
    t_s
        Seconds of the session at the answer; if it was taken back, at the one given instead.
    """

    trial: Trial
    answer: str
    t_s: float = 0.0


@dataclass(frozen=True, slots=True)
class FixedOrder:
    """Procedure that follows a plan, whatever is answered.

    Parameters
    ----------
    trials
        All trials of the plan, in order.
    """

    trials: tuple[Trial, ...]

    def next(self, history: Sequence[Answered], /) -> Trial | None:
        """Trial of the plan that follows the answered ones; None after the last."""
        done = len(history)
        return self.trials[done] if done < len(self.trials) else None

    def found(self, _history: Sequence[Answered], /) -> Sequence[str]:
        """No sentence: nothing is made of the answers."""
        return ()


@dataclass(frozen=True, slots=True)
class ByAnswers:
    """Procedure that takes trials from a deck, and decides the values by the answers.

    Each condition has its own history. A condition of which enough is known is left out from then
    on, with its catch trials. These are shown as they were planned, and choose nothing.

    Parameters
    ----------
    protocol, plan
        Protocol of the session, and its plan, whose trials are the deck.
    """

    protocol: Protocol
    plan: Plan
    _of: Mapping[str, tuple[Trial, ...]] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        of: dict[str, list[Trial]] = defaultdict(list)
        for trial in self.plan.trials:
            of[trial.condition].append(trial)
        object.__setattr__(self, "_of", {name: tuple(trials) for name, trials in of.items()})

    @property
    def trials(self) -> None:
        """None: which trials there are depends on the answers."""
        return

    @property
    def parameter(self) -> str:
        """Name of what is varied, such as dot_width_mm or contrast."""
        return varied(self.protocol)

    @property
    def most(self) -> int:
        """Largest number of trials that there may be."""
        limit = self._table.stop.trials
        most = 0
        for own in self._of.values():
            chosen = [place for place, trial in enumerate(own, 1) if not trial.catch]
            most += len(own) if limit is None or len(chosen) <= limit else chosen[limit - 1]
        return most

    @property
    def _table(self) -> QuestProcedure | StaircaseProcedure:
        table = self.protocol.procedure
        assert not isinstance(table, FixedProcedure), "a fixed order chooses nothing"
        return table

    def _seed(self, condition: str) -> str:
        """Text that random choices in a condition follow from."""
        return f"{self.plan.protocol} {self.plan.seed} {self.plan.participant} {condition}"

    def next(self, history: Sequence[Answered], /) -> Trial | None:
        """Trial that follows a history, with the values that the procedure chooses."""
        asked = self.asked(history)
        for trial in self._left(history):
            own, design = asked[trial.condition], self.protocol.design
            chosen = self._table.next(own, design, self._seed(trial.condition))
            if chosen is not None:
                stimuli = trial.stimuli
                stimuli = stimuli if trial.catch else _at(self.protocol, stimuli, chosen)
                return structs.replace(trial, number=len(history) + 1, stimuli=stimuli)
        return None

    def found(self, history: Sequence[Answered], /) -> tuple[str, ...]:
        """Sentences on what was found in each condition that has answers."""
        knob = KNOBS[self.parameter]
        what, unit = knob.words, knob.unit
        sentences: list[str] = []
        for name, own in self.asked(history).items():
            if own and len(self._of) > 1:
                sentences.append(f"condition: {name}")
            if own:
                design, seed = self.protocol.design, self._seed(name)
                sentences += self._table.found(own, design, what, unit, seed)
        return tuple(sentences)

    def asked(self, history: Sequence[Answered]) -> dict[str, list[Asked]]:
        """Questions and outcomes of each condition, as the choosers know them."""
        asked: dict[str, list[Asked]] = {name: [] for name in self._of}
        for answered in history:
            if not answered.trial.catch:
                told = _asked(answered, self.parameter, self.protocol)
                asked[answered.trial.condition].append(told)
        return asked

    def _left(self, history: Sequence[Answered]) -> list[Trial]:
        """Next trial of each condition that has one left, in the order of the deck."""
        done = Counter(answered.trial.condition for answered in history)
        left = [own[done[name]] for name, own in self._of.items() if done[name] < len(own)]
        return sorted(left, key=lambda trial: trial.number)


# Rule that chooses the next trial by the history, which leaves practice out, and has an answer that
# was given anew in the place of the one taken back. The same history must give the same trial.
Procedure = FixedOrder | ByAnswers


def procedure_of(protocol: Protocol, plan: Plan) -> Procedure:
    """Procedure by which the trials of a session follow each other."""
    return ByAnswers(protocol, plan) if protocol.adaptive else FixedOrder(plan.trials)


def varied(protocol: Protocol) -> str:
    """Name of what a procedure varies, such as dot_width_mm or contrast; empty if nothing."""
    table = protocol.procedure
    own = "" if isinstance(table, FixedProcedure) else table.parameter
    return protocol.parameter or own or ""


def describe(protocol: Protocol) -> str:
    """Say which trials a session asks, for a protocol whose trials depend on the answers."""
    table, design = protocol.procedure, protocol.design
    knob = KNOBS[varied(protocol)]
    what, unit = knob.words, knob.unit
    values = table.values(design)
    ends = f"{values[0]:g} to {values[-1]:g}{unit}"
    if isinstance(table, QuestProcedure):
        return f"quest, {what} by the answers, {len(values)} values from {ends}"
    return f"staircase, {what} by the answers, from {ends}"


def _asked(answered: Answered, parameter: str, protocol: Protocol) -> Asked:
    """Question and outcome of an answered trial; of two values, the lower stands first.

    Of values and a standard, what was asked is how much they differ from it.
    """
    trial, t_s, question = answered.trial, answered.t_s, protocol.asks
    if (standard := protocol.standard) is not None:
        apart = max(round(abs(value - standard), 9) for value in values_of(trial))
        return Asked((apart,), int(question.good(trial, answered.answer)), t_s)
    if len(trial.stimuli) == 1:
        value = value_at(trial.stimuli[0], parameter)
        return Asked((value,), int(question.positive(trial, answered.answer)), t_s)
    first, second = values_of(trial)
    chosen = (first, second)[int(answered.answer) - 1]
    low, high = sorted((first, second))
    return Asked((low, high), int(chosen == low), t_s)


def _at(protocol: Protocol, stimuli: Stimuli, chosen: tuple[float, ...]) -> Stimuli:
    """Stimuli of a trial of the deck, shown with the values that were chosen."""
    knob = varied(protocol)
    if len(stimuli) == 1:
        (stimulus,), (value,) = stimuli, chosen
        return Stimuli((with_value(stimulus, knob, value),))
    values = [stimulus.value or 0.0 for stimulus in stimuli]
    design = protocol.design
    if isinstance(design, Choice) and design.reference is not None:
        other = design.apart(chosen[0])
        ordered = [value if value == design.reference else other for value in values]
    else:
        ordered = chosen if values[0] < values[1] else chosen[::-1]
    return Stimuli(
        with_value(replace(stimulus, value=value), knob, value)
        for stimulus, value in zip(stimuli, ordered, strict=True)
    )


def values_of(trial: Trial) -> tuple[float, ...]:
    """Values that a trial compares, in the order in which they are shown."""
    return tuple(stimulus.value or 0.0 for stimulus in trial.stimuli)
