"""False positives and coverage of the analysis: 20,000 studies of each kind, through its functions.

Run it by itself for the table of docs/analysis.md: ``python -m tests.benchmarks coverage``.
"""

from __future__ import annotations

import os
from itertools import combinations, product
from typing import TYPE_CHECKING

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
from scipy import special

from tests.benchmarks.timing import Result
from vbraille.analysis import designs, stats
from vbraille.analysis.power import MOST_LOG_ODDS, NODES, WEIGHTS
from vbraille.analysis.thresholds import find_threshold

if TYPE_CHECKING:
    from collections.abc import Iterator

STUDIES = 20_000
PEOPLE = (3, 4, 6, 8, 12)
SHARES = (0.05, 0.2, 0.5, 0.8, 0.95, 0.98)
MIDDLE = (0.2, 0.5, 0.8)
TRIALS = 26
SPREAD, DIFFERING = 1.0, 0.3  # of people, and of each condition, in log odds
READERS = 1000


def middle_of(share: float, spread: float) -> float:
    """Log odds whose share, averaged over people, is this."""
    low, high = -MOST_LOG_ODDS, MOST_LOG_ODDS
    for _ in range(60):
        middle = (low + high) / 2
        mean = special.expit(middle + spread * NODES) @ WEIGHTS / WEIGHTS.sum()
        low, high = (middle, high) if mean < share else (low, middle)
    return middle


def read(random, shares, people, trials) -> stats.Floats:
    """Shares of people in conditions, float64[studies, people, conditions].

    `shares` has one share for all conditions, or one for each, and `trials` the number of trials of
    each condition, or of each person and condition.
    """
    spread = np.hypot(SPREAD, DIFFERING)
    trials = np.asarray(trials)
    own = np.array([middle_of(share, spread) for share in np.atleast_1d(shares)])
    own = own + SPREAD * random.standard_normal((STUDIES, people, 1))
    own = own + DIFFERING * random.standard_normal((STUDIES, people, trials.shape[-1]))
    return random.binomial(np.broadcast_to(trials, own.shape[1:]), special.expit(own)) / trials


def found(p) -> float:
    """Share of studies with a p of 0.05 or less, in percent."""
    return 100 * float((p <= stats.ALPHA).mean())


def any_pair(values) -> tuple[float, float]:
    """Percent of studies in which any pair is found, and in which p and interval are at odds."""
    levels = list("abc"[: values.shape[-1]])
    design = designs.Design(["condition"], [levels])
    pairs = [test for *_, test in designs.pairs_of(values, design)]
    p, k = stats.holm(np.stack([pair.p for pair in pairs], axis=-1))
    odds = np.zeros(len(values), bool)
    for n, pair in enumerate(pairs):
        low, high = stats.t_interval(pair.value, pair.error, pair.df, k[:, n])
        odds |= ~np.isnan(p[:, n]) & ((p[:, n] <= stats.ALPHA) != ((low > 0) | (high < 0)))
    return found(np.nanmin(np.where(np.isnan(p), 1, p), axis=-1)), 100 * float(odds.mean())


def false_positives() -> Iterator[Result]:
    random = np.random.default_rng(1)
    worst = dict.fromkeys(("2 conditions", "3 conditions, any pair", "3 conditions, F", "2 groups"))
    odds = 0.0
    for people, share in product(PEOPLE, SHARES):
        three = read(random, share, people, [TRIALS] * 3)
        groups = read(random, share, 2 * people, [TRIALS])[..., 0]
        pair, odd = any_pair(three)
        odds = max(odds, odd)
        effect = stats.effect_within(three @ stats.contrasts([3], (0,)))
        rates = {
            "2 conditions": any_pair(three[..., :2])[0],
            "3 conditions, any pair": pair,
            "3 conditions, F": found(effect.p),
            "2 groups": found(stats.welch(groups[:, :people], groups[:, people:]).p),
        }
        for name, rate in rates.items():
            told = (rate, people, share)
            worst[name] = max(worst[name] or told, told)
    for name, (rate, people, share) in worst.items():
        got = f"{rate:.1f} % ({people} people, share {share:g})"
        yield Result(f"false positives, largest: {name}", "≤ 6 %", got, rate <= 6)
    yield Result("p and interval at odds", "0", f"{odds:g} %", odds == 0)
    for trials, share in product(([20, 80], [8, 120]), (0.5, 0.9, 0.98)):
        rate = max(any_pair(read(random, share, people, trials))[0] for people in PEOPLE)
        what = f"false positives, {trials[0]} against {trials[1]} trials, share {share:g}"
        yield Result(what, "told", f"{rate:.1f} %", met=True)
    for share in (0.5, 0.9):
        groups = read(random, share, 15, [TRIALS])[..., 0]
        rate = found(stats.welch(groups[:, :3], groups[:, 3:]).p)
        what = f"false positives, 3 against 12 people, share {share:g}"
        yield Result(what, "told", f"{rate:.1f} %", met=True)


def _held(ends, truth) -> float:
    low, high = ends
    known = ~np.isnan(low)
    return 100 * float(((low <= truth) & (truth <= high))[known].mean())


def coverage() -> Iterator[Result]:
    random = np.random.default_rng(2)
    gaps: dict[bool, list[float]] = {True: [], False: []}
    means = []
    for people in PEOPLE:
        for one, other in combinations(SHARES, 2):
            values = read(random, [one, other], people, [TRIALS, TRIALS])
            test = stats.paired(values[..., 0] - values[..., 1])
            held = _held(stats.t_interval(test.value, test.error, test.df), one - other)
            gaps[one in MIDDLE and other in MIDDLE].append(held)
        for share in SHARES:
            for trials in (
                [TRIALS],
                np.array([[8, 26, 120][n % 3] for n in range(people)])[:, None],
            ):
                values = read(random, share, people, trials)[..., 0]
                means.append(_held(stats.mean_share(values), share))
    for middle, bar, least in ((True, "94-97 %", 94), (False, "≥ 86 %", 86)):
        where = "shares .2 to .8" if middle else "shares .05 to .98"
        got = f"{min(gaps[middle]):.1f} to {max(gaps[middle]):.1f} %"
        yield Result(f"coverage, differences, {where}", bar, got, min(gaps[middle]) >= least)
    got = f"{min(means):.1f} to {max(means):.1f} %"
    yield Result("coverage, mean share", "≥ 90 %", got, min(means) >= 90)
    held = []
    for people in PEOPLE:
        own = 0.3 * random.standard_normal((STUDIES, people, 1))
        taken = np.log(random.gamma(4, 0.25, (STUDIES, people, 20))) + own
        truth = special.digamma(4) + np.log(0.25)
        held.append(_held(stats.mean_interval(taken.mean(axis=-1)), truth))
    got = f"{min(held):.1f} to {max(held):.1f} %"
    yield Result("coverage, geometric mean duration", "≥ 91 %", got, min(held) >= 91)


def thresholds() -> Iterator[Result]:
    levels = np.linspace(0.25, 1.75, 7)
    for alarms, trials in product((0.02, 0.1, 0.3), (12, 24)):
        random = np.random.default_rng([3, trials])
        at = np.repeat(levels, trials)
        share = alarms + (1 - alarms - 0.02) * special.expit((at - 1) / 0.25)
        low, high = [], []
        for _ in range(READERS):
            blanks = int(random.binomial(trials, alarms)), trials
            ends = find_threshold(at, random.random(at.size) < share, blanks=blanks)
            low.append(ends.low)
            high.append(ends.high)
        held = _held((np.array(low), np.array(high)), 1.0)
        what = f"coverage, threshold, {100 * alarms:.0f} % false alarms, {trials} trials a level"
        yield Result(what, "93-97 %", f"{held:.1f} %", 92.5 <= held <= 97.5)


def run() -> Iterator[Result]:
    yield from false_positives()
    yield from coverage()
    yield from thresholds()
