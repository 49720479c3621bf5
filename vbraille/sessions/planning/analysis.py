"""The analysis that a protocol plans: the one that answers what its sessions are for."""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

from msgspec import structs

from vbraille.errors import check_range
from vbraille.sessions.planning.pace import check_line
from vbraille.tomlfile import Table, which
from vbraille.wording import count

MOST_PEOPLE = 10_000
ITEM = "item_"  # beginning of the columns of results that have the file of items' own
CONDITION = "condition"  # the factor of conditions that a protocol lists by name
# What has levels on a scale, along which a threshold may be found.
NUMBERS = frozenset(
    ("contrast", "texture", "dot_width_mm", "dot_spacing_mm", "cell_gap_mm", "row_spacing_mm")
)


class Measure(NamedTuple):
    """A measure that may be the primary one.

    Parameters
    ----------
    words
        Name in a report, without a unit.
    unit
        Unit in which it is printed: "%" of a share; empty for numbers.
    scale
        "share" of right answers; "log" for what is above 0 and skewed, and compared by ratios;
        "linear" for all else.
    questions
        Kinds of question that give it.
    """

    words: str
    unit: str
    scale: Literal["share", "log", "linear"]
    questions: tuple[str, ...]


_APART = ("which", "odd", "match", "same-different", "detect")
MEASURES = {
    "legibility": Measure("legibility of strings", "%", "share", ("identify",)),
    "characters": Measure("legibility of characters", "%", "share", ("identify",)),
    "duration": Measure("duration of right answers", "s", "log", ("identify",)),
    "right": Measure("right answers", "%", "share", (*_APART, "name")),
    "threshold": Measure("threshold", "", "log", ("detect", "which", "odd", "match", "identify")),
    "d_prime": Measure("d′", "", "linear", ("detect", "same-different", "which")),
    "preferred": Measure("preferred value", "", "linear", ("which",)),
    "rating": Measure("rating", "", "linear", ("rating",)),
    "magnitude": Measure("magnitude", "", "log", ("magnitude",)),
    "reading_speed": Measure("reading speed", "words a minute", "linear", ("read",)),
}


class Task(NamedTuple):
    """A protocol's task, as far as its usual analysis follows from it.

    Parameters
    ----------
    question
        Kind of the question.
    scored
        Whether one of two stimuli is right by having more or less of something.
    adaptive, catch
        Whether there is a procedure, and whether there are catch trials.
    factors
        What each factor changes, by its name; "condition" for conditions that are listed.
    items
        Columns of the results that have the file of items' own, such as "item_size".
    """

    question: str
    scored: bool
    adaptive: bool
    catch: bool
    factors: dict[str, frozenset[str]]
    items: tuple[str, ...] = ()

    @property
    def levels(self) -> tuple[str, ...]:
        """Factors whose levels a threshold is found among: those that change a number."""
        if self.question != "detect" or self.adaptive:
            return ()
        return tuple(name for name, changes in self.factors.items() if changes & NUMBERS)

    @property
    def measure(self) -> str | None:
        """Usual primary measure; None if answers are words."""
        match self.question:
            case "identify" if self.adaptive:
                return "threshold"
            case "odd" | "match":
                return "threshold" if self.adaptive else "right"
            case "which":
                return "threshold" if self.scored else "preferred"
            case "same-different":
                return "d_prime"
            case "detect":
                return "threshold" if self.adaptive or self.levels else "d_prime"
        return next((n for n, of in MEASURES.items() if self.question in of.questions), None)


class PlannedAnalysis(Table, frozen=True, kw_only=True):
    """The table ``[analysis]`` of a protocol.

    Parameters
    ----------
    measure
        Primary measure, a key of `MEASURES`; None for the usual one of the question.
    factors
        Names of the factors that it is compared by, "condition" for conditions that are listed,
        or columns of the file of items, such as "item_size"; None for all factors.
    model
        "trials": logistic regression of single trials, with participants as clusters; "means":
        participants' own means. None for "trials" of shares, and "means" of all else.
    correction
        How the p of all tests of the primary analysis are corrected together.
    too_fast_s, too_slow_s
        Trials that took less, or more, are left out; None for no such limit.
    catch_right
        Least share of a participant's catch trials that are right; with a smaller one the
        participant is left out. None for no such rule.
    participants
        Planned number of participants; None if it is not planned.
    stop
        Rule by which the study stops, in words; empty if there is none but the number.

    Raises
    ------
    ValueError
        If a value is out of range.
    """

    measure: str | None = None
    factors: tuple[str, ...] | None = None
    model: Literal["trials", "means"] | None = None
    correction: Literal["holm", "bonferroni", "fdr", "none"] = "holm"
    too_fast_s: float | None = None
    too_slow_s: float | None = None
    catch_right: float | None = None
    participants: int | None = None
    stop: str = ""

    def __post_init__(self) -> None:
        if self.measure is not None and self.measure not in MEASURES:
            raise ValueError(f"measure is {self.measure!r}{which(self.measure, MEASURES)}")
        check_range("too_fast_s", self.too_fast_s, 0, 3600, " s")
        check_range("too_slow_s", self.too_slow_s, 0, 86400, " s")
        check_range("catch_right", self.catch_right, 0, 1)
        check_range("participants", self.participants, 1, MOST_PEOPLE)
        if (self.too_fast_s or 0.0) >= (self.too_slow_s or math.inf):
            raise ValueError("too_fast_s must be below too_slow_s")
        if self.stop:
            check_line("stop", self.stop)

    def resolved(self, task: Task) -> PlannedAnalysis:
        """Fill in the usual choices of a task where none is made.

        Raises
        ------
        ValueError
            If a choice does not suit the task.
        """
        measure = self.measure or task.measure
        if measure is not None and task.question not in MEASURES[measure].questions:
            known = [name for name, of in MEASURES.items() if task.question in of.questions]
            raise ValueError(
                f"measure is {measure!r}, which the question {task.question} does not give"
                f"{which(measure, known) if known else '; leave it out'}"
            )
        if measure == "threshold" and task.question == "identify" and not task.adaptive:
            raise ValueError("measure is 'threshold', which strings have with [procedure] alone")
        factors = tuple(task.factors) if self.factors is None else self.factors
        for name in factors:
            if name not in (known := (*task.factors, *task.items)):
                raise ValueError(f"factors has {name!r}{which(name, known)}")
        if len(set(factors)) < len(factors):
            raise ValueError("factors has one twice; leave it out once")
        if measure == "threshold" and self.factors is None:
            factors = tuple(name for name in factors if name not in task.levels)
        share = measure is not None and MEASURES[measure].scale == "share"
        if self.model == "trials" and not share:
            raise ValueError(
                f"model is 'trials', which is of shares of right answers, not of {measure}"
            )
        if self.catch_right is not None and not task.catch:
            raise ValueError("catch_right is of catch trials, and [design] has none; leave it out")
        return structs.replace(
            self,
            measure=measure,
            factors=factors,
            model=self.model or ("trials" if share else "means"),
        )

    def described(self) -> str:
        """Describe the analysis in a line."""
        if self.measure is None:
            return "none; answers are words"
        by = " by " + " × ".join(self.factors) if self.factors else ""
        told = [f"{MEASURES[self.measure].words}{by}", f"model {self.model}"]
        told += [f"p corrected by {self.correction}"] if self.factors else []
        for limit, words in ((self.too_fast_s, "below"), (self.too_slow_s, "above")):
            told += [] if limit is None else [f"without trials {words} {limit:g} s"]
        if self.catch_right is not None:
            told.append(
                f"without people with less than {self.catch_right:.0%} of catch trials right"
            )
        told += [] if self.participants is None else [count(self.participants, "participant")]
        return "; ".join(told + ([self.stop] if self.stop else []))

    def column(self, factor: str) -> str:
        """Column of trials that has the levels of a factor."""
        return factor if factor == CONDITION or factor.startswith(ITEM) else f"factor_{factor}"
