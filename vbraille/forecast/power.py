"""Power of a protocol: how often a study of it would find an effect, by simulation.

Studies are analysed as the protocol plans: its measure, factors, model and correction.
"""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from msgspec import structs

from vbraille.analysis.input.trials import natural
from vbraille.analysis.primary import pair_name
from vbraille.analysis.statistics.intervals import FEWEST_PARTICIPANTS, wilson
from vbraille.errors import InputError, VbrailleError, check_range
from vbraille.forecast.studies import ALPHA, StudyPlan, StudyTask, count_found, log_odds_of
from vbraille.forecast.workers import KeptResults, work_on
from vbraille.sessions.planning.analysis import CONDITION, ITEM, MEASURES
from vbraille.sessions.planning.making import make_plan
from vbraille.sessions.planning.questions import OneOfTwo
from vbraille.sessions.running.reader import ReaderHabits
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    from vbraille.forecast.workers import Workers
    from vbraille.sessions.planning.analysis import PlannedAnalysis
    from vbraille.sessions.planning.protocol import Protocol

ENOUGH = 0.8
MOST_PARTICIPANTS = 500
MOST_STUDIES = 1_000_000
MOST_SPREAD = 5.0  # of log odds, and of logarithms
PORTION = 125  # studies of a task, however many workers there are
SEED = 1
_GUESSES = 50  # of each trial, from which it is known how often one is right by chance
OF_GROUP = ":"  # between a group and its condition
ODDS_RATIO = "odds-ratio"
# Group, condition, and levels of items that the measure is compared by.
Stratum = tuple[str, str, tuple[str, ...]]
_EFFECT = setting("effect")


@dataclass(frozen=True, slots=True)
class PowerRow:
    """Power of a comparison in studies of one size; or how exact the only mean is.

    Parameters
    ----------
    participants
        Number of participants of a study.
    compared
        Effect, difference or simple effect; of a plan that compares nothing, the measure.
    kind
        "effect", "difference", "simple effect" or "mean".
    studies, found, untested
        Number of studies, of those that found it, and of those that had no p.
    power, low, high
        found / studies, with Wilson's 95 % interval for the number of studies; 0…1. None of a
        mean.
    half_width
        Mean of half the width of the mean's interval, in the measure's unit, of logarithms as a
        logarithm; None of a comparison, or if no study has one.
    """

    participants: int
    compared: str
    kind: str
    studies: int
    found: int
    untested: int
    power: float | None = None
    low: float | None = None
    high: float | None = None
    half_width: float | None = None


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

    def enough(self, power: float = ENOUGH) -> dict[str, int | None]:
        """Smallest study from which on all have this power, by comparison; None if none has."""
        least: dict[str, int | None] = {}
        for row in sorted(self.rows, key=lambda row: row.participants):
            if row.power is None:
                continue
            if row.power < power:
                least[row.compared] = None
            elif least.get(row.compared) is None:
                least[row.compared] = row.participants
        return least

    def to_json(self) -> dict[str, Any]:
        """Table in the terms of JSON."""
        return {
            "about": dict(self.about),
            "rows": [asdict(row) for row in self.rows],
            "enough": [
                {"compared": compared, "power": ENOUGH, "participants": least}
                for compared, least in self.enough().items()
            ],
            "unfinished": None if self.unfinished is None else str(self.unfinished),
        }


@dataclass(frozen=True, slots=True)
class PowerQuestion:
    """Question to a simulation of power.

    Parameters
    ----------
    protocol
        Protocol whose plan and primary analysis are simulated.
    effect
        Values by condition, as `values_of` takes them.
    sizes
        Numbers of participants.
    between
        Standard deviation over people of what all their conditions share: of shares in log odds of
        a right answer, of durations, thresholds and magnitudes in natural logarithms, of other
        measures in their unit.
    differing
        Standard deviation over people of what each condition adds to that, so that a difference of
        two conditions has √2 times as much.
    correction
        How p are corrected; None as planned.
    studies, seed
        Number of studies of each size, and what they are drawn by.
    lapses, false_alarms
        For shares: share of the trials that are answered by chance alone, and share of the others
        that are answered "yes" or "different" whatever was felt. Values by condition are those
        without them.

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
    correction: str | None = None
    studies: int = 1000
    seed: int = SEED
    lapses: float = 0.0
    false_alarms: float = 0.0

    def __post_init__(self) -> None:
        self._check_habits()
        if not 1 <= self.studies <= MOST_STUDIES:
            raise InputError(
                f"{setting('studies')} is {self.studies}; it must be 1 to {MOST_STUDIES}"
            )
        if self.analysis.measure is None:
            raise InputError(f"{self.protocol.name} asks for words, of which nothing is compared")
        linear = MEASURES[self.analysis.measure].scale == "linear"
        unit = " log odds" if self.shares else ""
        try:
            for size in self.sizes:
                name = f"{setting('participants')}: one"
                check_range(name, size, FEWEST_PARTICIPANTS, MOST_PARTICIPANTS)
            for name in ("between", "differing"):
                most = math.inf if linear else MOST_SPREAD
                check_range(setting(name), getattr(self, name), 0, most, unit)
        except ValueError as error:
            raise InputError(str(error)) from None
        if not self.shares and not self.between and not self.differing:
            raise InputError(
                f"people would not differ; give {setting('between')} or {setting('differing')}"
            )

    def _check_habits(self) -> None:
        """Check lapses and false alarms.

        Raises
        ------
        InputError
            If they are out of range, or the measure or the question has none.
        """
        ReaderHabits(0.0, self.lapses, self.false_alarms).checked()
        if not (self.lapses or self.false_alarms):
            return
        measure = self.protocol.planned_analysis.measure
        if measure is not None and not self.shares:
            raise InputError(
                f"{self.protocol.name} compares {MEASURES[measure].words}, and lapses and false "
                f"alarms are of shares of right answers; leave them out"
            )
        question = self.protocol.asks
        if self.false_alarms and not isinstance(question, OneOfTwo):
            raise InputError(
                f"false alarms are of the questions detect and same-different, and "
                f"{self.protocol.name} asks {question.name}; leave them out"
            )

    @property
    def analysis(self) -> PlannedAnalysis:
        """Analysis that is planned, with the correction that is asked for."""
        planned = self.protocol.planned_analysis
        return structs.replace(planned, correction=self.correction or planned.correction)

    @property
    def shares(self) -> bool:
        """True if the measure is a share of right answers."""
        return MEASURES[self.analysis.measure or ""].scale == "share"

    def plan(self) -> StudyPlan:
        """Plan of the simulation: trials of the protocol's plans, values, and the analysis."""
        strata, cells, levels, _ = _cells(self.protocol, self.analysis)
        values = list(values_of(self.protocol, self.analysis, self.effect).values())
        if self.shares:
            each = math.hypot(self.between, self.differing)
            middles = tuple(log_odds_of(value, each) for value in values)
        else:
            log = MEASURES[self.analysis.measure or ""].scale == "log"
            middles = tuple(math.log(value) if log else value for value in values)
        return StudyPlan(
            trials=self._trials(strata),
            middles=middles,
            cells=cells,
            levels=levels,
            between=float(self.between),
            differing=float(self.differing),
            sizes=self.sizes,
            model=(self.analysis.model or "means") if self.shares else "scores",
            correction=self.analysis.correction,
            by_chance=self._by_chance(strata),
            attended=(1 - self.lapses) * (1 - self.false_alarms),
        )

    def _by_chance(self, strata: list[Stratum]) -> tuple[float, ...]:
        """Right answers to trials of each condition that are lapses or false alarms, as shares."""
        if not (self.lapses or self.false_alarms):
            return ()
        question, found = self.protocol.asks, []
        random = np.random.default_rng(self.seed)
        people = range(1, max(1, len(self.protocol.groups)) + 1)  # one of each group
        plans = [make_plan(self.protocol, f"P{number}", self.seed) for number in people]
        for group, condition, *_ in strata:
            own = [
                trial
                for plan in plans
                for trial in plan.trials
                if (plan.group, trial.condition) == (group, condition) and not trial.catch
            ]
            guesses = [(trial, question.guess(trial, random)) for trial in own * _GUESSES]
            lapsed = np.mean([question.good(*each) for each in guesses])
            alarmed = 0.0
            if isinstance(question, OneOfTwo):
                alarmed = np.mean([question.good(trial, question.words[0]) for trial in own])
            alarms = (1 - self.lapses) * self.false_alarms
            found.append(float(self.lapses * lapsed + alarms * alarmed))
        return tuple(found)

    def _trials(self, strata: list[Stratum]) -> tuple[tuple[int, ...], ...]:
        """Trials of each participant in each condition, by the participant's own plan.

        Catch trials are left out, as the analysis does. A score is one in each condition.
        """
        counted = []
        for number in range(1, max(self.sizes) + 1):
            if self.shares:
                plan = make_plan(self.protocol, f"P{number}", self.seed)
                items = _items(self.analysis)
                shown = [
                    (plan.group, trial.condition, _levels(columns, items))
                    for trial in plan.trials
                    if not trial.catch
                    for columns in (self.protocol.columns_of(trial.item),)
                ]
                counted.append(tuple(shown.count(stratum) for stratum in strata))
            else:
                groups = self.protocol.groups or ("",)
                group = groups[(number - 1) % len(groups)]
                counted.append(tuple(int(own == group) for own, *_ in strata))
        return tuple(counted)


def _items(analysis: PlannedAnalysis) -> list[str]:
    """Columns of the file of items that the measure is compared by."""
    named = analysis.factors or ()
    return [factor.removeprefix(ITEM) for factor in named if factor.startswith(ITEM)]


def _levels(columns: Mapping[str, str], items: Sequence[str]) -> tuple[str, ...]:
    return tuple(str(columns[item]) for item in items)


def _name(condition: str, own: tuple[str, ...], protocol: Protocol) -> str:
    """Name of a condition, and of items in it by the levels that they have."""
    parts = (condition,) if len(protocol.conditions) > 1 or not own else ()
    return "-".join((*parts, *own))


def _cells(
    protocol: Protocol, analysis: PlannedAnalysis
) -> tuple[
    list[Stratum],
    tuple[int, ...],
    tuple[tuple[int, ...], ...],
    tuple[tuple[str, ...], ...],
]:
    """Things with their own values, the cell of each in the analysis, and cells' levels by name.

    Conditions are one where the measure is found along them.
    """
    factors = analysis.factors or ()
    names = [condition.name for condition in protocol.conditions]
    along = analysis.measure == "threshold" and not protocol.adaptive and CONDITION not in factors
    items = _items(analysis)
    shown = dict.fromkeys(_levels(row.columns, items) for row in protocol.item_rows) or {(): None}
    strata = [
        (group, name, own)
        for group in protocol.groups or ("",)
        for name in (names[:1] if along and not protocol.factors else names)
        for own in (shown if items else ((),))
    ]
    told = []
    for group, name, own in strata:
        levels_of = protocol.assigned(group).levels(name) | {CONDITION: name}
        levels_of |= dict(zip((f"{ITEM}{item}" for item in items), own, strict=True))
        told.append(tuple(levels_of[factor] for factor in factors))
    levels = tuple(
        tuple(sorted({levels[at] for levels in told}, key=natural)) for at in range(len(factors))
    )
    places = [tuple(levels[at].index(one) for at, one in enumerate(own)) for own in told]
    different = sorted(set(places))
    return strata, tuple(different.index(place) for place in places), tuple(different), levels


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
    ended = work_on(workers, count_found, tasks, kept, report)
    finished = sum(tasks[number].studies for number in kept.found)
    if not finished and ended is not None:
        raise ended
    # In the order of the tasks, whichever was first.
    counted = np.sum([kept.found[number] for number in sorted(kept.found)], axis=0)
    rows = tuple(_rows(question, plan, counted, finished))
    return PowerTable(_about(question, plan, finished), rows, ended)


def _rows(question: PowerQuestion, plan: StudyPlan, counted: np.ndarray, studies: int):
    analysis = question.analysis
    factors, (*_, levels) = analysis.factors or (), _cells(question.protocol, analysis)
    for size, counts in zip(plan.sizes, counted.tolist(), strict=True):
        if not factors:
            ((widths, without),) = counts
            known = studies - int(without)
            yield PowerRow(
                size,
                MEASURES[analysis.measure or ""].words,
                "mean",
                studies,
                0,
                int(without),
                half_width=widths / known if known else None,
            )
            continue
        for (own, pair), (found, untested) in zip(plan.compared(), counts, strict=True):
            if pair is not None and pair.at is None and len(levels[pair.factor]) == 2:
                continue  # the only difference of a factor is its effect
            ends = wilson(int(found), studies)
            if pair is None:
                name, kind = " × ".join(factors[at] for at in own), "effect"
            else:
                name = pair_name(factors, levels, pair)
                kind = "difference" if pair.at is None else "simple effect"
            yield PowerRow(
                participants=size,
                compared=name,
                kind=kind,
                studies=studies,
                found=int(found),
                untested=int(untested),
                power=found / studies,
                low=ends.low,
                high=ends.high,
            )


def _about(question: PowerQuestion, plan: StudyPlan, studies: int) -> tuple[tuple[str, str], ...]:
    protocol, analysis = question.protocol, question.analysis
    values = values_of(protocol, analysis, question.effect)
    trials = sorted({sum(own) for own in plan.trials})
    many = f"{trials[0]} to {trials[-1]}" if len(trials) > 1 else f"{trials[0]}"
    studied = "study" if studies == 1 else "studies"
    assumed = ", ".join(
        f"{name} {100 * value:.1f} %" if question.shares else f"{name} {value:g}"
        for name, value in values.items()
    )
    of = MEASURES[analysis.measure or ""]
    scale = {
        "share": "log odds of a right answer",
        "log": f"logarithms of the {of.words}",
        "linear": f"the {of.words}",
    }[of.scale]
    return (
        ("protocol", f"{protocol.name}{f', {many} trials of each person' * question.shares}"),
        ("planned", analysis.described()),
        ("assumed", f"{assumed}{_habits(question)}"),
        (
            "people differ",
            f"by an s.d. of {plan.between:g} in {scale}, the same in all conditions, and by one of "
            f"{plan.differing:g} in each condition by itself, so that a difference of two "
            f"conditions differs between people by {math.sqrt(2) * plan.differing:.3g}",
        ),
        ("test", f"two-sided at {ALPHA:g}, p corrected as in the report"),
        ("simulated", f"{studies} {studied} of each size, seed {question.seed}"),
    )


def _habits(question: PowerQuestion) -> str:
    """Clause on lapses and false alarms; empty if there are none."""
    told = (("lapses", question.lapses), ("false alarms", question.false_alarms))
    known = [f"{100 * share:g} % of {name}" for name, share in told if share]
    return f", and beside these {' and '.join(known)}" if known else ""


def names_of(protocol: Protocol, analysis: PlannedAnalysis) -> list[str]:
    """Names of what has a value: conditions, or the levels of items in them."""
    return list(dict.fromkeys(name for _, name in _named(protocol, analysis)))


def _named(protocol: Protocol, analysis: PlannedAnalysis) -> list[tuple[str, str]]:
    strata, *_ = _cells(protocol, analysis)
    return [(group, _name(condition, own, protocol)) for group, condition, own in strata]


def values_of(
    protocol: Protocol, analysis: PlannedAnalysis, effect: Mapping[str, str]
) -> dict[str, float]:
    """Value of the measure in each condition of each group, in the protocol's order.

    Parameters
    ----------
    protocol, analysis
        Protocol whose conditions are compared, and how.
    effect
        Values by the names of conditions, or of a group and a condition with a colon between; or,
        of shares, that of one condition, and by the name ``odds-ratio`` the odds of a right answer
        in every other one by those in this. A protocol with one condition takes the value of that,
        or by the name of the measure.

    Raises
    ------
    InputError
        If a condition is not known, has no value, or its value is none.
    """
    strata = _named(protocol, analysis)
    share = MEASURES[analysis.measure or ""].scale == "share"
    names = names_of(protocol, analysis)
    given = {name: text for name, text in effect.items() if name != ODDS_RATIO}
    if len(names) == 1 and analysis.measure in given:
        given[names[0]] = given.pop(analysis.measure or "")
    known = {OF_GROUP.join(stratum) for stratum in strata if stratum[0]} | set(names)
    for name in given:
        if name not in known:
            raise InputError(
                f"{_EFFECT} has the condition {name}, which {protocol.name} does not have; it has "
                f"{', '.join(names)}{', and a group before a colon' * bool(protocol.groups)}"
            )
    found = {name: _value(name, text, analysis) for name, text in given.items()}
    if ODDS_RATIO in effect:
        ratio = _ratio(effect[ODDS_RATIO]) if share else None
        if ratio is None or len(found) != 1:
            raise InputError(
                f"{_EFFECT} has an odds ratio and {len(found)} values; give the share of one "
                f"condition, such as {names[0]}=0.5,{ODDS_RATIO}=1.8"
            )
        ((base, own),) = found.items()
        odds = own / (1 - own) * ratio
        found = {name: own if name == base else odds / (1 + odds) for name in names}
    made = {}
    for group, name in strata:
        value = found.get(f"{group}{OF_GROUP}{name}", found.get(name))
        if value is None:
            missing = [name for name in names if name not in found]
            raise InputError(
                f"{_EFFECT} has no share for {', '.join(missing)}; give one such as "
                f"{missing[0]}=0.5{f', or {ODDS_RATIO}=1.8' * share}"
            )
        made[f"{group}{OF_GROUP}{name}" if group else name] = value
    return made


def _value(name: str, text: str, analysis: PlannedAnalysis) -> float:
    value = _number(name, text)
    scale = MEASURES[analysis.measure or ""].scale
    if scale == "share" and not 0 < value < 1:
        raise InputError(
            f"{_EFFECT}: the share of {name} is {value:g}; it must be between 0 and 1, and "
            f"neither of them"
        )
    if (scale == "log" and value <= 0) or not math.isfinite(value):
        raise InputError(f"{_EFFECT}: {name} is {value:g}; it must be above 0")
    return value


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
