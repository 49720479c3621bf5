"""The table ``[procedure]`` of a protocol: which trial comes next, and when enough was asked.

The plan is a deck of trials, made before the session as for a fixed order: it has the order of
conditions, blocks and strings, and where two values are compared, which of the two comes first.
A procedure takes the next trial of the deck and decides the values that it is shown with.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Literal

from msgspec import structs

from vbraille.adaptive.questplus import (
    GridAxis,
    GridQuest,
    detection_quest,
    nearer_quest,
    ordered_pairs,
    steps,
)
from vbraille.adaptive.staircase import Asked, StaircaseRule, Staircases, StopRule
from vbraille.errors import VbrailleError, check_range
from vbraille.sessions.planning.design import MOST_TRIALS, Choice, Design
from vbraille.sessions.planning.stimuli import KNOBS, KnobName, Stimuli, Trial, value_at, with_value
from vbraille.toml.tomlfile import Table

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from vbraille.sessions.planning.plan import Plan
    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.planning.questions import AnyQuestion

THRESHOLD, PREFERRED = "threshold", "preferred"
_MOST_VALUES = 1000


class FixedProcedure(Table, frozen=True, tag="fixed", tag_field="kind"):
    """A procedure that follows the plan, whatever is answered."""

    def problem(self, _design: Design) -> str:
        """Say why this procedure does not go with a design, which it always does: empty."""
        return ""

    def values(self, _design: Design) -> tuple[float, ...]:
        """Values that the procedure adds to those of the design: none."""
        return ()


class _ByAnswersTable(Table, frozen=True, kw_only=True, tag_field="kind"):
    """What procedures that go by the answers have in common.

    Parameters
    ----------
    parameter
        What a procedure with strings varies; None if two are compared.
    least, most
        Bounds of its values; None if two are compared, whose values are in the design.
    harder
        Whether strings are harder to read with less or with more of it.
    trials
        Most trials of each condition; None for as many as the design has.
    seconds
        Seconds of the session after which no further trial is chosen; None for no limit.
    """

    parameter: KnobName | None = None
    least: float | None = None
    most: float | None = None
    harder: Literal["less", "more"] = "less"
    trials: int | None = None
    seconds: float | None = None

    def __post_init__(self) -> None:
        check_range("trials", self.trials, 1, MOST_TRIALS)
        check_range("seconds", self.seconds, 1, 86_400, " s")
        knob = KNOBS.get(self.parameter or "contrast")
        assert knob is not None, "the names are those of the knobs"
        check_range("least", self.least, knob.low, knob.high, knob.unit)
        check_range("most", self.most, knob.low, knob.high, knob.unit)

    @property
    def bounds(self) -> tuple[float, float]:
        """Least and largest value of the parameter that is varied with strings.

        Raises
        ------
        ValueError
            If one of them is not given.
        """
        if self.least is None or self.most is None:
            raise ValueError("least or most is missing; add it")
        return self.least, self.most

    def _lacks(self) -> str:
        """Say what a procedure with strings lacks; empty if nothing."""
        for name in ("parameter", "least", "most"):
            if getattr(self, name) is None:
                return f"lacks {name}; add it"
        least, most = self.bounds
        if least >= most:
            return (
                f"least is {least:g} and most is {most:g}, and nothing can move between them; "
                f"make most larger"
            )
        return ""


class QuestProcedure(_ByAnswersTable, frozen=True, kw_only=True, tag="quest"):
    """QUEST+: the value, or the pair of values, that is expected to tell most.

    Parameters
    ----------
    step
        Step from one value that may be asked to the next; None, where two are compared, for the
        values of the design alone.
    furthest
        Largest difference between two values that are compared; None for any.
    scale
        Scale on which distances between compared values are judged.
    shape
        Shape of the psychometric function of strings.
    spread, guess, lapse
        Possible values of these parameters; one value fixes the parameter.
    sd, width
        Standard deviation, and width of the interval of 95 %, that are precise enough; None for
        no end by precision.
    at_least
        Number of trials of a condition before precision counts.

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    step: float | None = None
    furthest: float | None = None
    scale: Literal["linear", "log"] = "linear"
    shape: Literal["normal", "logistic", "weibull"] = "normal"
    spread: tuple[float, ...]
    guess: tuple[float, ...] = (0.0,)
    lapse: tuple[float, ...] = (0.03,)
    sd: float | None = None
    width: float | None = None
    at_least: int = 10

    def __post_init__(self) -> None:
        super().__post_init__()
        check_range("step", self.step, 1e-4, 50)
        check_range("furthest", self.furthest, 1e-4, 50)
        for value in self.spread:
            check_range("spread: one", value, 1e-4, 100)
        for name in ("guess", "lapse"):
            for value in getattr(self, name):
                check_range(f"{name}: one", value, 0, 0.9)
        for name in ("spread", "guess", "lapse"):
            GridAxis(name, getattr(self, name))
        self.stop  # noqa: B018

    @property
    def stop(self) -> StopRule:
        """When enough was asked in a condition."""
        return StopRule(self.trials, self.sd, self.width, self.at_least, self.seconds)

    def problem(self, design: Design) -> str:
        """Say why this procedure does not go with a design; empty if it does."""
        if isinstance(design, Choice):
            if design.reference is not None:
                return "chooses both values of a pair; leave reference out of [design]"
            if self.parameter is not None or self.least is not None or self.most is not None:
                return "parameter, least and most are those of [design]; leave them out"
        elif lacks := self._lacks():
            return lacks
        elif self.step is None:
            return "lacks step; add it"
        elif self.furthest is not None:
            return "furthest is of kind = 'choice'; leave it out"
        try:
            self.quest(design)
        except ValueError as error:
            return str(error)
        return ""

    def values(self, design: Design) -> tuple[float, ...]:
        """Values that may be asked, increasing.

        Raises
        ------
        ValueError
            If the step does not lead from one end to the other, or there are too many values.
        """
        if isinstance(design, Choice):
            if self.step is None:
                return tuple(sorted(design.values))
            low, high = min(design.values), max(design.values)
        else:
            low, high = self.bounds
        assert self.step is not None, "problem() has seen to that"
        if (high - low) / self.step > _MOST_VALUES:
            raise ValueError(f"step makes more than {_MOST_VALUES} values; make it larger")
        return steps(low, high, self.step)

    @lru_cache(maxsize=8)  # noqa: B019 - tables are values, and few
    def quest(self, design: Design) -> GridQuest:
        """Grid of this procedure for a design.

        Raises
        ------
        ValueError
            If there is no such grid.
        """
        values = self.values(design)
        spread, lapse = GridAxis("spread", self.spread), GridAxis("lapse", self.lapse)
        if not isinstance(design, Choice):
            threshold, guess = GridAxis(THRESHOLD, values), GridAxis("guess", self.guess)
            falls = self.harder == "more"
            return detection_quest(
                self.shape, values, threshold, spread, guess, lapse, falls=falls, about=THRESHOLD
            )
        most = float("inf") if self.furthest is None else self.furthest * (1 + 1e-9)
        pairs = [pair for pair in ordered_pairs(values) if pair[1] - pair[0] <= most]
        if not pairs:
            raise ValueError(
                f"furthest is {self.furthest:g}, and no two values are so near; make it larger"
            )
        if self.scale == "log" and values[0] <= 0:
            raise ValueError("scale is 'log', which is for values above 0; leave 0 mm out")
        centre = GridAxis(PREFERRED, self._centres(values))
        return nearer_quest(pairs, centre, spread, lapse, log=self.scale == "log", about=PREFERRED)

    def _centres(self, values: tuple[float, ...]) -> tuple[float, ...]:
        """Values that may be the preferred one: those asked, or 51 from end to end if few are."""
        if self.step is not None:
            return values
        return steps(values[0], values[-1], (values[-1] - values[0]) / 50)


class StaircaseProcedure(_ByAnswersTable, frozen=True, kw_only=True, tag="staircase"):
    """Staircases: harder after right answers, easier after wrong ones.

    Parameters
    ----------
    start
        Values that the staircases begin with: as many staircases as values, interleaved.
    steps
        Sizes of the step before the first reversal, before the second, and so on.
    right, wrong
        Number of right answers running that make it harder, and of wrong ones that make it easier.
    target
        Share of right answers that a weighted staircase converges to; None if steps are as large
        one way as the other.
    reversals
        Number of reversals after which a staircase is over; None for no such end.

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    start: tuple[float, ...]
    steps: tuple[float, ...]
    right: int = 2
    wrong: int = 1
    target: float | None = None
    reversals: int | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        check_range("target", self.target, 0.05, 0.95)
        if self.target is not None and (self.right, self.wrong) != (1, 1):
            raise ValueError("target is of staircases with right = 1 and wrong = 1; give these")
        if not self.start:
            raise ValueError("start has no value; give one for each staircase")

    @property
    def stop(self) -> StopRule:
        """When enough was asked in a condition."""
        return StopRule(self.trials, seconds=self.seconds)

    def problem(self, design: Design) -> str:
        """Say why this procedure does not go with a design; empty if it does."""
        if isinstance(design, Choice):
            return "kind is 'staircase', which needs right answers; for a choice give 'quest'"
        if lacks := self._lacks():
            return lacks
        trials = min(self.trials or MOST_TRIALS, design.trials)
        if trials < min(self.right, self.wrong):
            return (
                f"right is {self.right} and wrong is {self.wrong}, and a condition has {trials} "
                f"trials: the staircase cannot move; give it more trials"
            )
        try:
            self.staircases("")
        except ValueError as error:
            return str(error)
        return ""

    def values(self, _design: Design) -> tuple[float, ...]:
        """Ends of the values that may be shown."""
        return self.bounds

    def staircases(self, seed: str) -> Staircases:
        """The staircases of a condition.

        Raises
        ------
        ValueError
            If one could not move.
        """
        least, most = self.bounds
        easier = 1.0 if self.target is None else self.target / (1 - self.target)
        rules = tuple(
            StaircaseRule(
                start,
                least,
                most,
                self.steps,
                self.right,
                self.wrong,
                easier,
                self.harder == "less",
                self.reversals,
            )
            for start in self.start
        )
        return Staircases(rules, seed)


ProcedureTable = FixedProcedure | QuestProcedure | StaircaseProcedure


@dataclass(frozen=True, slots=True)
class Answered:
    """A trial that was answered.

    Parameters
    ----------
    trial
        The trial; as it was shown, if the answers choose what is shown.
    answer
        The answer that counts; `vbraille.braille.spelling` says how it is written.
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
class ByQuest:
    """Choice of values by QUEST+.

    Parameters
    ----------
    quest
        Grid of stimuli and parameters.
    name
        Name of the parameter of the grid that is estimated.
    stop
        When enough was asked.
    """

    quest: GridQuest
    name: str
    stop: StopRule

    def next(self, history: Sequence[Asked]) -> tuple[float, ...] | None:
        """Value or pair of values that is asked next; None if enough was asked."""
        if self.stop.out_of_limits(history):
            return None
        told = self._told(history)
        if self.stop.by_precision and self.stop.precise(
            len(told), self.quest.estimate(told, self.name)
        ):
            return None
        return self.quest.next(told)

    def found(self, history: Sequence[Asked], what: str, unit: str) -> tuple[str, ...]:
        """Sentences on the parameter that is estimated."""
        known = self.quest.estimate(self._told(history), self.name)
        return (
            f"{self.name} {what}: {known.mean:.3g}{unit}",
            f"95 % interval: {known.low:.3g} to {known.high:.3g}{unit}",
        )

    def _told(self, history: Sequence[Asked]) -> list[tuple[tuple[float, ...], int]]:
        for asked in history:
            if asked.stimulus not in self.quest:
                values = " and ".join(f"{value:g}" for value in asked.stimulus)
                raise VbrailleError(
                    f"the journal is damaged: it has shown {values}, which the protocol's "
                    f"procedure never asks; nothing was changed"
                )
        return [(asked.stimulus, asked.outcome) for asked in history]


@dataclass(frozen=True, slots=True)
class ByStaircases:
    """Choice of values by staircases.

    Parameters
    ----------
    staircases
        The staircases, interleaved.
    stop
        When enough was asked, beside their own end.
    """

    staircases: Staircases
    stop: StopRule

    def next(self, history: Sequence[Asked]) -> tuple[float, ...] | None:
        """Value that is shown next; None if enough was asked."""
        if self.stop.out_of_limits(history):
            return None
        level = self.staircases.next(history)
        return None if level is None else (level,)

    def found(self, history: Sequence[Asked], what: str, unit: str) -> tuple[str, ...]:
        """Sentences on the level that the staircases came to."""
        known = self.staircases.estimate(history)
        if known is None:
            return (f"{THRESHOLD} {what}: not known, no staircase turned round with its last step",)
        return (
            f"{THRESHOLD} {what}: {known.mean:.3g}{unit}",
            f"reversals: {known.reversals}, standard deviation {known.sd:.2g}{unit}",
        )


@dataclass(frozen=True, slots=True)
class ByAnswers:
    """Procedure that takes trials from a deck, and decides the values by the answers.

    Each condition has its own history. A condition of which enough is known is left out from then
    on.

    Parameters
    ----------
    deck
        Trials of the plan, in order.
    choosers
        Choice of values in each condition, by the condition's name.
    protocol
        Protocol of the session.
    """

    deck: tuple[Trial, ...]
    choosers: Mapping[str, ByQuest | ByStaircases]
    protocol: Protocol
    _of: Mapping[str, tuple[Trial, ...]] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        of: dict[str, list[Trial]] = defaultdict(list)
        for trial in self.deck:
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
        most = Counter(trial.condition for trial in self.deck)
        limits = {name: chooser.stop.trials for name, chooser in self.choosers.items()}
        return sum(min(most[name], limit or most[name]) for name, limit in limits.items())

    def next(self, history: Sequence[Answered], /) -> Trial | None:
        """Trial that follows a history, with the values that the procedure chooses."""
        asked = self.asked(history)
        for place, condition in self._places(asked):
            chosen = self.choosers[condition].next(asked[condition])
            if chosen is not None:
                trial = self._of[condition][place]
                stimuli = _at(self.protocol, trial.stimuli, chosen)
                return structs.replace(trial, number=len(history) + 1, stimuli=stimuli)
        return None

    def found(self, history: Sequence[Answered], /) -> tuple[str, ...]:
        """Sentences on what was found in each condition that has answers."""
        knob = KNOBS[self.parameter]
        what, unit = knob.words, knob.unit
        sentences: list[str] = []
        for name, own in self.asked(history).items():
            if own and len(self.choosers) > 1:
                sentences.append(f"condition: {name}")
            if own:
                sentences += self.choosers[name].found(own, what, unit)
        return tuple(sentences)

    def asked(self, history: Sequence[Answered]) -> dict[str, list[Asked]]:
        """Questions and outcomes of each condition, as the choosers know them."""
        asked: dict[str, list[Asked]] = {name: [] for name in self.choosers}
        for answered in history:
            told = _asked(answered, self.parameter, self.protocol.asks)
            asked[answered.trial.condition].append(told)
        return asked

    def _places(self, asked: Mapping[str, Sequence[Asked]]) -> list[tuple[int, str]]:
        """Next trial of each condition that has one left, in the order of the deck."""
        left = [(self._of[name][len(own)].number, len(own), name)
                for name, own in asked.items() if len(own) < len(self._of[name])]  # fmt: skip
        return [(place, name) for _, place, name in sorted(left)]


# Rule that chooses the next trial by the history, which leaves practice out, and has an answer that
# was given anew in the place of the one taken back. The same history must give the same trial.
Procedure = FixedOrder | ByAnswers


def procedure_of(protocol: Protocol, plan: Plan) -> Procedure:
    """Procedure by which the trials of a session follow each other."""
    table, design = protocol.procedure, protocol.design
    names = tuple(dict.fromkeys(trial.condition for trial in plan.trials))
    choosers: dict[str, ByQuest | ByStaircases] = {}
    match table:
        case QuestProcedure():
            name = PREFERRED if isinstance(design, Choice) else THRESHOLD
            for condition in names:
                choosers[condition] = ByQuest(table.quest(design), name, table.stop)
        case StaircaseProcedure():
            for condition in names:
                seed = f"{plan.protocol} {plan.seed} {plan.participant} {condition}"
                choosers[condition] = ByStaircases(table.staircases(seed), table.stop)
        case _:
            return FixedOrder(plan.trials)
    return ByAnswers(plan.trials, choosers, protocol)


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


def _asked(answered: Answered, parameter: str, question: AnyQuestion) -> Asked:
    """Question and outcome of an answered trial; of two values, the lower stands first."""
    trial, t_s = answered.trial, answered.t_s
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
    first, second = (stimulus.value or 0.0 for stimulus in stimuli)
    ordered = chosen if first < second else chosen[::-1]
    return Stimuli(
        with_value(replace(stimulus, value=value), knob, value)
        for stimulus, value in zip(stimuli, ordered, strict=True)
    )


def values_of(trial: Trial) -> tuple[float, ...]:
    """Values that a trial compares, in the order in which they are shown."""
    return tuple(stimulus.value or 0.0 for stimulus in trial.stimuli)
