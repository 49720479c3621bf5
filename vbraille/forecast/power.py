"""Power of a protocol: how often a study of it would find an effect, by simulation."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.stats import nct
from scipy.stats import t as student

from vbraille.analysis.statistics.intervals import FEWEST_PARTICIPANTS, Unanswerable, wilson
from vbraille.errors import InputError, VbrailleError
from vbraille.forecast.effects import shares_of
from vbraille.forecast.kept import KeptResults, work_on
from vbraille.forecast.studies import (
    StudyPlan,
    StudyTask,
    count_found,
    log_odds_of,
    mean_and_spread,
)
from vbraille.sessions.planning.design import Choice
from vbraille.sessions.planning.making import make_plan
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

    from vbraille.forecast.workers import Workers
    from vbraille.sessions.planning.protocol import Protocol

ALPHA = 0.05
ENOUGH = 0.8
MOST_PARTICIPANTS = 500
MOST_STUDIES = 1_000_000
MOST_SPREAD = 5.0
PORTION = 125  # studies of a task, however many workers there are
SEED = 20090618
TESTS = ("model", "paired")
_HALF = "one half"


@dataclass(frozen=True, slots=True)
class PowerRow:
    """Power of a comparison in studies of one size.

    Parameters
    ----------
    participants
        Number of participants of a study.
    first, second
        What is compared.
    first_share, second_share
        Shares of right answers that were assumed, over the population; 0…1.
    studies, found, untested
        Number of studies, of those that found a difference, and of those that had no p.
    power, low, high
        found / studies, with Wilson's 95 % interval for the number of studies; 0…1.
    closed_form
        Power by the noncentral t distribution, which takes shares for normal; None for a test
        that is no t-test, or for corrected p-values.
    """

    participants: int
    first: str
    second: str
    first_share: float
    second_share: float
    studies: int
    found: int
    untested: int
    power: float
    low: float
    high: float
    closed_form: float | None


@dataclass(frozen=True, slots=True)
class PowerTable:
    """What a simulation of power gave.

    Parameters
    ----------
    about
        What was assumed and done, as pairs of a word and a sentence.
    rows
        Power by number of participants and comparison.
    unfinished
        What ended the simulation early; None if it is whole.
    """

    about: tuple[tuple[str, str], ...]
    rows: tuple[PowerRow, ...]
    unfinished: VbrailleError | None = None

    def enough(self, power: float = ENOUGH) -> dict[tuple[str, str], int | None]:
        """Smallest study from which on all have this power, by comparison; None if none has."""
        least: dict[tuple[str, str], int | None] = {}
        for row in sorted(self.rows, key=lambda row: row.participants):
            pair = row.first, row.second
            if row.power < power:
                least[pair] = None
            elif least.get(pair) is None:
                least[pair] = row.participants
        return least

    def to_json(self) -> dict[str, Any]:
        """Table in the terms of JSON."""
        return {
            "about": dict(self.about),
            "rows": [asdict(row) for row in self.rows],
            "enough": [
                {"first": first, "second": second, "power": ENOUGH, "participants": least}
                for (first, second), least in self.enough().items()
            ],
            "unfinished": None if self.unfinished is None else str(self.unfinished),
        }


@dataclass(frozen=True, slots=True)
class PowerQuestion:
    """What is asked of a simulation of power.

    Parameters
    ----------
    protocol
        Protocol whose plan and comparisons are simulated.
    effect
        Shares by condition, as `vbraille.forecast.effects.shares_of` takes them.
    sizes
        Numbers of participants.
    between, differing
        Standard deviations over people of the log odds of a right answer, and of what a condition
        adds to them.
    test
        "model" or "paired"; None for the one of the protocol's kind.
    correction
        How p-values of several pairs are corrected.
    studies, seed
        Number of studies of each size, and what they are drawn by.

    Raises
    ------
    InputError
        If a value cannot be used.
    """

    protocol: Protocol
    effect: Mapping[str, str]
    sizes: tuple[int, ...]
    between: float = 0.5
    differing: float = 0.0
    test: str | None = None
    correction: str = "holm"
    studies: int = 1000
    seed: int = SEED

    def __post_init__(self) -> None:
        for size in self.sizes:
            if not FEWEST_PARTICIPANTS <= size <= MOST_PARTICIPANTS:
                raise InputError(
                    f"{setting('participants')} has {size}; it must be {FEWEST_PARTICIPANTS} to "
                    f"{MOST_PARTICIPANTS}"
                )
        if not 1 <= self.studies <= MOST_STUDIES:
            raise InputError(
                f"{setting('studies')} is {self.studies}; it must be 1 to {MOST_STUDIES}"
            )
        for name, spread in (("between", self.between), ("differing", self.differing)):
            if not 0 <= spread <= MOST_SPREAD:
                raise InputError(
                    f"{setting(name)} is {spread:g}; it must be 0 to {MOST_SPREAD:g} log odds"
                )
        if self.protocol.adaptive:
            raise InputError(
                f"{self.protocol.name} chooses its trials by the answers, and power is of a fixed "
                f"design; give one without [procedure]"
            )
        if self.test is not None and isinstance(self.protocol.design, Choice):
            raise InputError(
                f"{self.protocol.name} compares two stimuli, which has one test; leave "
                f"{setting('test')} out"
            )

    def plan(self) -> StudyPlan:
        """What is simulated: the trials of the protocol's plans, and the shares."""
        shares = shares_of(self.protocol, self.effect)
        choosing = isinstance(self.protocol.design, Choice)
        if choosing and len(self.protocol.conditions) > 1:
            raise InputError(
                f"{self.protocol.name} compares two stimuli in {len(self.protocol.conditions)} "
                f"conditions; power is of one with a single condition"
            )
        each = math.hypot(self.between, self.differing)
        return StudyPlan(
            trials=self._trials(list(shares)),
            log_odds=tuple(log_odds_of(share, each) for share in shares.values()),
            between=float(self.between),
            differing=float(self.differing),
            sizes=self.sizes,
            test="half" if choosing else self.test or TESTS[0],
            correction=self.correction,
            alpha=ALPHA,
        )

    def _trials(self, names: list[str]) -> tuple[tuple[int, ...], ...]:
        """Trials of each participant in each condition, by the participant's own plan.

        Catch trials are left out, as the analysis does, except where blank ones are detected.
        """
        detects = self.protocol.asks.name == "detect"
        counted = []
        for number in range(1, max(self.sizes) + 1):
            plan = make_plan(self.protocol, f"P{number}", self.seed)
            shown = [
                names[0] if trial.stimuli[0].value is not None else trial.condition
                for trial in plan.trials
                if (detects or not trial.catch)
                and (
                    len(trial.stimuli) == 1
                    or names[0] in {f"{stimulus.value:g}" for stimulus in trial.stimuli}
                )
            ]
            counted.append(tuple(shown.count(name) for name in names))
        if self.test == "paired" and not all(map(all, counted)):
            raise InputError(
                f"{self.protocol.name} does not show each participant all conditions, which the "
                f"paired test needs; leave {setting('test')} out"
            )
        return tuple(counted)


def power(
    question: PowerQuestion,
    workers: Workers,
    *,
    keep: Path | None = None,
    told: Callable[[int, int], None] = lambda _done, _all: None,
) -> PowerTable:
    """Simulate studies, and count those that find a difference.

    Parameters
    ----------
    question
        What is asked.
    workers
        Who works; the numbers do not depend on it.
    keep
        File that keeps what is done, so that a simulation that was ended goes on; None for none.
    told
        Function that is told how many portions of the work are done, and how many there are.

    Raises
    ------
    InputError
        If the question cannot be asked, or `keep` is of another one.
    """
    plan = question.plan()
    starts = range(0, question.studies, PORTION)
    tasks = [
        StudyTask(plan, question.seed, first, min(PORTION, question.studies - first))
        for first in starts
    ]
    kept = KeptResults(keep, {"plan": asdict(plan), "seed": question.seed, "all": question.studies})
    try:
        ended = work_on(workers, count_found, tasks, kept, told)
    except Unanswerable as reason:
        raise InputError(f"this design cannot be tested: {reason}") from None
    finished = sum(tasks[number].studies for number in kept.found)
    if not finished and ended is not None:
        raise ended
    # In the order of the tasks, whoever was first.
    counted = np.sum([kept.found[number] for number in sorted(kept.found)], axis=0)
    rows = tuple(_rows(question, plan, counted, finished))
    return PowerTable(_about(question, plan, finished), rows, ended)


def _rows(question: PowerQuestion, plan: StudyPlan, counted: np.ndarray, studies: int):
    shares = shares_of(question.protocol, question.effect)
    names, values = list(shares), list(shares.values())
    for size, pairs in zip(plan.sizes, counted.tolist(), strict=True):
        for (one, two), (found, untested) in zip(plan.pairs, pairs, strict=True):
            half = plan.test == "half"
            ends = wilson(found, studies)
            yield PowerRow(
                participants=size,
                first=names[one],
                second=_HALF if half else names[two],
                first_share=values[one],
                second_share=0.5 if half else values[two],
                studies=studies,
                found=found,
                untested=untested,
                power=found / studies,
                low=ends.low,
                high=ends.high,
                closed_form=_closed_form(plan, size, one, None if half else two),
            )


def _closed_form(plan: StudyPlan, size: int, one: int, two: int | None) -> float | None:
    """Power of a t-test, if shares were normal; None where it is not the test that is made."""
    alike = len(set(plan.trials[:size])) == 1
    corrected = len(plan.pairs) > 1 and plan.correction != "none"
    if plan.test == "model" or corrected or not alike:
        return None
    mean, spread = mean_and_spread(plan, one, two, plan.trials[0])
    return t_power(mean / spread, size, plan.alpha)


def t_power(d: float, n: int, alpha: float = ALPHA) -> float:
    """Power of a two-sided paired t-test, by the noncentral t distribution.

    Parameters
    ----------
    d
        Mean of the differences by their standard deviation.
    n
        Number of differences, 2 or more.
    alpha
        Level of the test.
    """
    critical, off = float(student.ppf(1 - alpha / 2, n - 1)), abs(d) * math.sqrt(n)
    return float(nct.sf(critical, n - 1, off) + nct.cdf(-critical, n - 1, off))


def _about(question: PowerQuestion, plan: StudyPlan, studies: int) -> tuple[tuple[str, str], ...]:
    protocol, shares = question.protocol, shares_of(question.protocol, question.effect)
    trials = sorted({sum(own) for own in plan.trials})
    many = f"{trials[0]} to {trials[-1]}" if len(trials) > 1 else f"{trials[0]}"
    chosen = plan.test == "half"
    what = "comparisons that have the value" if chosen else "trials"
    tests = {
        "model": "logistic regression of single trials with participants as clusters",
        "paired": "paired t-test of the participants' shares",
        "half": "t-test over participants, of the share of comparisons in which it is chosen",
    }
    correction = "" if len(plan.pairs) == 1 else f", p corrected by {plan.correction}"
    right = "chosen" if chosen else "right"
    studied = "study" if studies == 1 else "studies"
    assumed = ", ".join(f"{name} {share:.1%} {right}" for name, share in shares.items())
    return (
        ("protocol", f"{protocol.name}, {many} {what} of each participant"),
        ("assumed", assumed.replace("%", " %")),
        (
            "people differ",
            f"by an s.d. of {plan.between:g} in log odds, and in what a condition adds to them "
            f"by {plan.differing:g}",
        ),
        ("test", f"{tests[plan.test]}, two-sided at {plan.alpha:g}{correction}"),
        ("simulated", f"{studies} {studied} of each size, seed {question.seed}"),
    )
