"""Power of a protocol: how often a study of it would find an effect, by simulation."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from vbraille.analysis.statistics.intervals import FEWEST_PARTICIPANTS, Unanswerable, wilson
from vbraille.errors import InputError, VbrailleError, check_range
from vbraille.forecast.studies import (
    ALPHA,
    StudyPlan,
    StudyTask,
    count_found,
    log_odds_of,
)
from vbraille.forecast.workers import KeptResults, work_on
from vbraille.sessions.planning.design import Choice
from vbraille.sessions.planning.making import make_plan
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

    from vbraille.forecast.workers import Workers
    from vbraille.sessions.planning.protocol import Protocol

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


@dataclass(frozen=True, slots=True)
class PowerTable:
    """Result of a simulation of power.

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
    """Question to a simulation of power.

    Parameters
    ----------
    protocol
        Protocol whose plan and comparisons are simulated.
    effect
        Shares by condition, as `shares_of` takes them.
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
        if not 1 <= self.studies <= MOST_STUDIES:
            raise InputError(
                f"{setting('studies')} is {self.studies}; it must be 1 to {MOST_STUDIES}"
            )
        try:
            for size in self.sizes:
                name = f"{setting('participants')}: one"
                check_range(name, size, FEWEST_PARTICIPANTS, MOST_PARTICIPANTS)
            for name in ("between", "differing"):
                check_range(setting(name), getattr(self, name), 0, MOST_SPREAD, " log odds")
        except ValueError as error:
            raise InputError(str(error)) from None
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
        """Plan of the simulation: the trials of the protocol's plans, and the shares."""
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
    report: Callable[[int, int], None] = lambda _done, _all: None,
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
    report
        Function that is called with how many portions of the work are done, and how many there are.

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
        ended = work_on(workers, count_found, tasks, kept, report)
    except Unanswerable as reason:
        raise InputError(f"this design cannot be tested: {reason}") from None
    finished = sum(tasks[number].studies for number in kept.found)
    if not finished and ended is not None:
        raise ended
    # In the order of the tasks, whichever was first.
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
            )


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
        ("test", f"{tests[plan.test]}, two-sided at {ALPHA:g}{correction}"),
        ("simulated", f"{studies} {studied} of each size, seed {question.seed}"),
    )


ODDS_RATIO = "odds-ratio"
_EFFECT = setting("effect")


def shares_of(protocol: Protocol, effect: Mapping[str, str]) -> dict[str, float]:
    """Share of right answers in each condition, in the protocol's order.

    Parameters
    ----------
    protocol
        Protocol whose conditions are compared. Where it compares two stimuli, the only name is
        one of its values, and its share that of the comparisons in which the value is chosen.
    effect
        Shares by the names of conditions; or the share of one condition, and by the name
        ``odds-ratio`` the odds of a right answer in every other one by those in this.

    Raises
    ------
    InputError
        If a condition is not known, has no share, or its share is none; or if nothing differs.
    """
    if isinstance(protocol.design, Choice):
        return _preference(protocol.name, protocol.design, effect)
    names = [condition.name for condition in protocol.conditions]
    if len(names) < 2:
        raise InputError(
            f"{protocol.name} has one condition, and power is that of a comparison; take a "
            f"protocol with two or more"
        )
    ratio = _ratio(effect[ODDS_RATIO]) if ODDS_RATIO in effect else None
    given = {name: share for name, share in effect.items() if name != ODDS_RATIO}
    for name in given:
        if name not in names:
            raise InputError(
                f"{_EFFECT} has the condition {name}, which {protocol.name} does not have; it has "
                f"{', '.join(names)}"
            )
    shares = {name: _share(name, given[name]) for name in names if name in given}
    if ratio is not None:
        if len(shares) != 1:
            raise InputError(
                f"{_EFFECT} has an odds ratio and {len(shares)} shares; give the share of one "
                f"condition, such as {names[0]}=0.5,{ODDS_RATIO}=1.8"
            )
        ((base, share),) = shares.items()
        odds = share / (1 - share) * ratio
        shares = {name: share if name == base else odds / (1 + odds) for name in names}
    missing = [name for name in names if name not in shares]
    if missing:
        raise InputError(
            f"{_EFFECT} has no share for {', '.join(missing)}; give one such as "
            f"{missing[0]}=0.5, or {ODDS_RATIO}=1.8"
        )
    return shares


def _preference(name: str, design: Choice, effect: Mapping[str, str]) -> dict[str, float]:
    if len(effect) != 1:
        raise InputError(
            f"{name} compares two stimuli; give {_EFFECT} the share of one value that is chosen, "
            f"such as {design.values[0]:g}=0.7"
        )
    ((value, share),) = effect.items()
    values = [f"{of:g}" for of in design.values]
    if value not in values:
        there = f"give {' or '.join(values)}"
        raise InputError(f"{_EFFECT} has the value {value}, which {name} does not have; {there}")
    return {value: _share(value, share)}


def _share(name: str, text: str) -> float:
    share = _number(name, text)
    if not 0 < share < 1:
        raise InputError(
            f"{_EFFECT}: the share of {name} is {share:g}; it must be between 0 and 1, and "
            f"neither of them"
        )
    return share


def _ratio(text: str) -> float:
    ratio = _number(ODDS_RATIO, text)
    if not 1e-3 <= ratio <= 1e3:
        raise InputError(f"{_EFFECT}: {ODDS_RATIO} is {ratio:g}; it must be 0.001 to 1000")
    return ratio


def _number(name: str, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise InputError(f"{_EFFECT}: {name} is {text!r}, which is not a number") from None
