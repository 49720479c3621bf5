"""Power of a protocol: how often a study of it would find a difference, by simulation.

Of each person the log odds of a right answer in a cell, or the value there, are

    η = a + σ z + τ z',                                                                       (1)

with a of the cell, and z of the person and z' of the person in the cell standard normal. So a
difference of two cells has the standard deviation √2 τ over people. Of shares, a is such that the
share of right answers averaged over people is the one asked for, and trials are drawn from it.
Studies are tested by the functions that analyse real ones.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from math import prod
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy import optimize, special

from vbraille.analysis import designs, stats
from vbraille.analysis.measures import LOGS, MEASURES, SHARES
from vbraille.errors import InputError
from vbraille.sessions.planning.plan import make_plan

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from vbraille.analysis.stats import Floats
    from vbraille.sessions.planning.protocol import Protocol

ENOUGH = 0.8
LARGEST = 500
PORTION = 2000  # studies at a time, so that memory does not grow with them
MOST_LOG_ODDS = 40.0
NODES, WEIGHTS = np.polynomial.hermite_e.hermegauss(80)


class PowerRow(NamedTuple):
    """Power of a test in studies of one size, or the width of the interval of the only mean.

    Parameters
    ----------
    participants
        Number of people of a study.
    compared
        Effect, or two levels; "mean" if nothing is compared.
    studies, power, low, high
        Number of studies, share of them that find it, and its 95 % interval; None of a mean.
    half_width
        Mean half width of the 95 % interval of the only mean; None of a comparison.
    """

    participants: int
    compared: str
    studies: int
    power: float | None = None
    low: float | None = None
    high: float | None = None
    half_width: float | None = None


@dataclass(frozen=True)
class Study:
    """A study of a protocol: its cells, its groups, and what is assumed of people.

    Parameters
    ----------
    scale
        "shares", "logarithms" or "values".
    factors, levels
        Names of the factors, and of the levels of each; the one between people is the last.
    middles : float64[groups, cells]
        a of equation (1); one group if there is no factor between people.
    trials : int[groups, cells]
        Trials of a person, of shares.
    between, differing
        σ and τ of equation (1).
    """

    scale: str
    factors: list[str]
    levels: list[list[str]]
    middles: Floats
    trials: Floats
    between: float
    differing: float


def study_of(
    protocol: Protocol,
    effect: Mapping[str, float],
    *,
    between: float = 0.5,
    differing: float = 0.0,
    seed: int = 1,
) -> Study:
    """Return the study that a protocol plans.

    Parameters
    ----------
    effect
        Value of the measure in each condition, or GROUP:CONDITION; by the measure's name if there
        is one condition.
    between, differing
        σ and τ of equation (1): in log odds of shares, logarithms of durations and magnitudes, or
        the measure's unit.

    Raises
    ------
    InputError
        If a value is missing, unknown, or out of range, or nothing can be compared.
    """
    plan = protocol.analysis
    if plan is None or not plan.measure:
        raise InputError(f"{protocol.name} asks for words, which are not compared")
    scale = MEASURES[plan.measure].scale
    if scale != SHARES and not between and not differing:
        raise InputError("people would not differ; give --between or --differing above 0")
    groups = list(protocol.groups) or [""]
    conditions = [condition.name for condition in protocol.conditions]
    along = plan.measure == "threshold" and not plan.factors
    names = conditions[:1] if along else conditions
    label = "{group}:{name}" if len(names) > 1 else "{group}"
    known = [
        label.format(group=group, name=name).strip(":") or plan.measure
        for group in groups
        for name in names
    ]
    if set(effect) != set(known):
        raise InputError(f"--effect needs a value of each of {', '.join(known)}")
    if scale == SHARES and not all(0 < value < 1 for value in effect.values()):
        raise InputError("--effect has shares of right answers; each must be above 0 and below 1")
    if scale == LOGS and min(effect.values()) <= 0:
        raise InputError(f"--effect has a {MEASURES[plan.measure].name} of 0; each must be above 0")
    spread = np.hypot(between, differing)
    middles = np.array([_middle(scale, effect[name], spread) for name in known])
    factors = [factor for factor in protocol.factors if not factor.between]
    levels = [[level.name for level in factor.levels] for factor in factors]
    factors = [factor.name for factor in factors]
    if (len(names) > 1 and prod(map(len, levels)) != len(names)) or not factors:
        factors, levels = ["condition"], [names]
    if len(names) == 1:
        factors, levels = [], []
    if len(groups) > 1:
        factors.append("-".join(factor.name for factor in protocol.factors if factor.between))
        levels.append(groups)
    shape = len(groups), len(names)
    trials = _trials(protocol, groups, names, seed) if scale == SHARES else np.ones(shape)
    return Study(scale, factors, levels, middles.reshape(shape), trials, between, differing)


def _middle(scale: str, value: float, spread: float) -> float:
    """Return a of equation (1) for a value averaged over people."""
    if scale == LOGS:
        return float(np.log(value))
    if scale != SHARES:
        return value
    weights = WEIGHTS / WEIGHTS.sum()

    def off(middle: float) -> float:
        return float(special.expit(middle + spread * NODES) @ weights) - value

    return float(optimize.brentq(off, -MOST_LOG_ODDS, MOST_LOG_ODDS))  # pyright: ignore[reportArgumentType]


def _trials(protocol: Protocol, groups: list[str], names: list[str], seed: int) -> Floats:
    """Return how many trials a person of each group has in each condition."""
    counts = np.zeros((len(groups), len(names)))
    for row, group in enumerate(groups):
        plan = make_plan(protocol, "P1", seed, order=1, group=group or None)
        shown = [trial.condition for trial in plan.trials if not (trial.practice or trial.catch)]
        counts[row] = [shown.count(name) for name in names]
    return counts


def simulate(study: Study, people: int, studies: int, random: np.random.Generator) -> Floats:
    """Return values of people in studies, float64[studies, people, cells]; groups take turns."""
    member = np.arange(people) % len(study.middles)
    made = study.middles[member] + study.between * random.standard_normal((studies, people, 1))
    cells = study.middles.shape[1]
    made = made + study.differing * random.standard_normal((studies, people, cells))
    if study.scale != SHARES:
        return made
    trials = study.trials[member]
    return random.binomial(trials.astype(int), special.expit(made)) / trials


def power(
    study: Study, sizes: Sequence[int], *, studies: int = 1000, seed: int = 1
) -> Iterator[PowerRow]:
    """Simulate studies of some sizes, and count those that find each effect and difference.

    Raises
    ------
    InputError
        If a size is too small to be tested.
    """
    groups = len(study.middles)
    if min(sizes) < stats.FEWEST * groups or max(sizes) > LARGEST:
        raise InputError(f"--participants must be {stats.FEWEST * groups} to {LARGEST}")
    for size in sizes:
        random = np.random.default_rng([seed, size])
        found = Counter()
        widths = []
        for first in range(0, studies, PORTION):
            values = simulate(study, size, min(PORTION, studies - first), random)
            if not study.factors:
                interval = stats.mean_share if study.scale == SHARES else stats.mean_interval
                low, high = interval(values[..., 0])
                widths += (high - low).tolist()
                continue
            for name, p in _tested(study, values):
                found[name] += int((p <= stats.ALPHA).sum())
        if not study.factors:
            yield PowerRow(size, "mean", studies, half_width=float(np.nanmean(widths) / 2))
        for name, count in found.items():
            low, high = stats.wilson(count, studies)
            yield PowerRow(size, name, studies, count / studies, float(low), float(high))


def _tested(study: Study, values: Floats) -> Iterator[tuple[str, Floats]]:
    """Return the name of each test, and its corrected p in each study."""
    groups = len(study.middles)
    member = np.arange(values.shape[1]) % groups if groups > 1 else None
    design = designs.Design(study.factors, study.levels, member)
    effects = dict(designs.effects_of(values, design))
    pairs = {f"{one} and {two}": test for _, one, two, test in designs.pairs_of(values, design)}
    for tests in (effects, pairs) if len(effects) > 1 or len(pairs) > 1 else (pairs,):
        corrected, _ = stats.holm(np.stack([test.p for test in tests.values()], axis=-1))
        yield from zip(tests, np.moveaxis(corrected, -1, 0), strict=True)


def enough(rows: Sequence[PowerRow]) -> dict[str, int | None]:
    """Return the smallest size from which on all have a power of 0.8, for each comparison."""
    least = {}
    for row in sorted(rows, key=lambda row: row.participants):
        if row.power is not None and row.power < ENOUGH:
            least[row.compared] = None
        elif row.power is not None and least.get(row.compared) is None:
            least[row.compared] = row.participants
    return least
