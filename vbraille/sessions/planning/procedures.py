"""The table ``[procedure]`` of a protocol: which values come next, and when enough was asked.

A class for each kind chooses by what was asked in one condition so far, and by nothing else.
"""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Literal

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
from vbraille.sessions.planning.stimuli import KNOBS, KnobName
from vbraille.tomlfile import Table

if TYPE_CHECKING:
    from collections.abc import Sequence

THRESHOLD, PREFERRED = "threshold", "preferred"
_MOST_VALUES = 1000


class FixedProcedure(Table, frozen=True, tag="fixed", tag_field="kind"):
    """A procedure that follows the plan, whatever is answered."""

    def check(self, _design: Design) -> None:
        """Accept any design."""

    def values(self, _design: Design) -> tuple[float, ...]:
        """Values that the procedure adds to those of the design: none."""
        return ()


class _ByAnswersTable(Table, frozen=True, kw_only=True, tag_field="kind"):
    """Common part of the procedures that go by the answers.

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

    def ends(self, design: Design) -> tuple[float, float]:
        """Least and largest of what is chosen: of a value, or of a difference from a standard.

        Raises
        ------
        ValueError
            If there is none.
        """
        if not isinstance(design, Choice):
            return self.bounds
        chosen = design.values if design.reference is None else design.differences
        return min(chosen), max(chosen)

    def _check_varied(self, design: Design) -> None:
        """Check that there is something to vary, in one table.

        Raises
        ------
        ValueError
            If there is nothing, or a choice has it twice.
        """
        if not isinstance(design, Choice):
            self._check_bounds()
            return
        if (self.parameter, self.least, self.most) != (None, None, None):
            raise ValueError("parameter, least and most are those of [design]; leave them out")
        if design.reference is not None:
            if self.harder != "less":
                raise ValueError("harder is of strings; the less two differ, the harder it is")
            _ = design.differences

    def _check_bounds(self) -> None:
        """Check that a procedure with strings has something to vary."""
        for name in ("parameter", "least", "most"):
            if getattr(self, name) is None:
                raise ValueError(f"lacks {name}; add it")
        least, most = self.bounds
        if least >= most:
            raise ValueError(
                f"least is {least:g} and most is {most:g}, and nothing can move between them; "
                f"make most larger"
            )


class QuestProcedure(_ByAnswersTable, frozen=True, kw_only=True, tag="quest"):
    """QUEST+: the value, or the pair of values, that is expected to tell most.

    Parameters
    ----------
    step
        Step from one value that may be asked to the next; None for the values of the design alone,
        where two are compared.
    furthest
        Largest difference between two values that are compared; None for any.
    scale
        Scale on which distances between compared values are judged.
    shape
        Shape of the psychometric function of strings.
    spread, guess, lapse
        Possible values of these parameters; one value fixes the parameter. Without ``guess``,
        strings are not guessed, and of several stimuli each is guessed as often.
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
    guess: tuple[float, ...] | None = None
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
            for value in getattr(self, name) or ():
                check_range(f"{name}: one", value, 0, 0.9)
        for name in ("spread", "guess", "lapse"):
            if (given := getattr(self, name)) is not None:
                GridAxis(name, given)
        self.stop  # noqa: B018

    @property
    def stop(self) -> StopRule:
        """Rule that ends the questions of a condition."""
        return StopRule(self.trials, self.sd, self.width, self.at_least, self.seconds)

    def check(self, design: Design) -> None:
        """Check that this procedure goes with a design.

        Raises
        ------
        ValueError
            If it does not.
        """
        self._check_varied(design)
        compares = isinstance(design, Choice)
        if compares and design.reference is None and design.form != "pairs":
            raise ValueError("chooses both values of a pair; leave form out of [design]")
        if compares and design.reference is not None and self.scale != "linear":
            raise ValueError("scale is of two values that are compared freely; leave it out")
        if compares and self.guess is not None:
            raise ValueError("guess follows from the number of stimuli; leave it out")
        if not compares and self.step is None:
            raise ValueError("lacks step; add it")
        if self.furthest is not None and not (compares and design.reference is None):
            raise ValueError("furthest is of kind = 'choice' without a reference; leave it out")
        self.quest(design)

    def next(
        self, asked: Sequence[Asked], design: Design, _seed: str = ""
    ) -> tuple[float, ...] | None:
        """Value or pair of values that is asked next in a condition; None if enough was asked."""
        if self.stop.out_of_limits(asked):
            return None
        quest, history = self.quest(design), self._history(asked, design)
        if self.stop.by_precision:
            known = quest.estimate(history, quest.axes[0].name)
            if self.stop.precise(len(history), known):
                return None
        return quest.next(history)

    def found(
        self, asked: Sequence[Asked], design: Design, what: str, unit: str, _seed: str = ""
    ) -> tuple[str, ...]:
        """Sentences on the threshold, or on the preferred value."""
        quest = self.quest(design)
        name = quest.axes[0].name
        known = quest.estimate(self._history(asked, design), name)
        return (
            f"{name} {_of(design, what)}: {known.mean:.3g}{unit}",
            f"95 % interval: {known.low:.3g} to {known.high:.3g}{unit}",
        )

    def _history(
        self, asked: Sequence[Asked], design: Design
    ) -> list[tuple[tuple[float, ...], int]]:
        quest = self.quest(design)
        for each in asked:
            if each.stimulus not in quest:
                values = " and ".join(f"{value:g}" for value in each.stimulus)
                raise VbrailleError(
                    f"the journal is damaged: it has shown {values}, which the protocol's "
                    f"procedure never asks; nothing was changed"
                )
        return [(each.stimulus, each.outcome) for each in asked]

    def values(self, design: Design) -> tuple[float, ...]:
        """Values that may be shown, increasing; see `chosen`."""
        return _shown(design, self.chosen(design))

    def chosen(self, design: Design) -> tuple[float, ...]:
        """Values, or differences from the standard, that may be asked, increasing.

        Raises
        ------
        ValueError
            If the step does not lead from one end to the other, or there are too many values.
        """
        low, high = self.ends(design)
        if self.step is None:
            assert isinstance(design, Choice), "check() has seen to that"
            return tuple(sorted(design.values if design.reference is None else design.differences))
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
        values = self.chosen(design)
        spread, lapse = GridAxis("spread", self.spread), GridAxis("lapse", self.lapse)
        if not isinstance(design, Choice) or design.reference is not None:
            alike = (1 / design.alternatives,) if isinstance(design, Choice) else (0.0,)
            threshold, guess = GridAxis(THRESHOLD, values), GridAxis("guess", self.guess or alike)
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
        """Rule that ends the questions of a condition."""
        return StopRule(self.trials, seconds=self.seconds)

    def check(self, design: Design) -> None:
        """Check that this procedure goes with a design, and that its staircases can move.

        Raises
        ------
        ValueError
            If one cannot.
        """
        if isinstance(design, Choice) and design.reference is None:
            raise ValueError(
                "kind is 'staircase', which needs right answers; add reference to [design], or "
                "give 'quest'"
            )
        self._check_varied(design)
        trials = min(self.trials or MOST_TRIALS, design.trials)
        if trials < min(self.right, self.wrong):
            raise ValueError(
                f"right is {self.right} and wrong is {self.wrong}, and a condition has {trials} "
                f"trials: the staircase cannot move; give it more trials"
            )
        self.staircases(design, "")
        if trials < min(self.right, self.wrong) * len(self.start):
            raise ValueError(
                f"start is of {len(self.start)} staircases, and a condition has {trials} trials: "
                f"one of them cannot move; give it more trials"
            )

    def next(
        self, asked: Sequence[Asked], design: Design, seed: str = ""
    ) -> tuple[float, ...] | None:
        """Value that is shown next in a condition; None if enough was asked."""
        if self.stop.out_of_limits(asked):
            return None
        level = self.staircases(design, seed).next(asked)
        return None if level is None else (level,)

    def found(
        self, asked: Sequence[Asked], design: Design, what: str, unit: str, seed: str = ""
    ) -> tuple[str, ...]:
        """Sentences on the level that the staircases came to."""
        known, what = self.staircases(design, seed).estimate(asked), _of(design, what)
        if known is None:
            return (f"{THRESHOLD} {what}: not known, no staircase turned round with its last step",)
        return (
            f"{THRESHOLD} {what}: {known.mean:.3g}{unit}",
            f"reversals: {known.reversals}, standard deviation {known.sd:.2g}{unit}",
        )

    def values(self, design: Design) -> tuple[float, ...]:
        """Ends of the values that may be shown."""
        return _shown(design, self.ends(design))

    def staircases(self, design: Design, seed: str) -> Staircases:
        """The staircases of a condition.

        Raises
        ------
        ValueError
            If one could not move.
        """
        least, most = self.ends(design)
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


def _shown(design: Design, chosen: tuple[float, ...]) -> tuple[float, ...]:
    """Values that stimuli have, increasing, for what a procedure chooses."""
    if not isinstance(design, Choice) or design.reference is None:
        return chosen
    return tuple(sorted(map(design.apart, chosen)))


def _of(design: Design, what: str) -> str:
    """Words for what a threshold is of: a value, or a difference from the standard."""
    compared = isinstance(design, Choice) and design.reference is not None
    return f"difference of {what}" if compared else what


ProcedureTable = FixedProcedure | QuestProcedure | StaircaseProcedure
