"""How often intervals of single readers hold the truth: d′, and psychometric functions."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from scipy.special import ndtr
from scipy.stats import norm

from tests.benchmarks.coverage_people import Found
from tests.conftest import SEED
from vbraille.analysis.statistics.detection import yes_no
from vbraille.analysis.statistics.intervals import Unanswerable
from vbraille.analysis.statistics.psychometric import SHAPES, fit_psychometric

LEVELS = np.linspace(0.25, 1.75, 7)
THRESHOLD, SPREAD, LAPSES = 1.0, 0.25, 0.02


def sensitivity(trials: int, d: float, criterion: float, studies: int) -> Found:
    """Coverage of d′ of yes and no; counts that come again are worked out once."""
    random = np.random.default_rng([SEED, trials, round(10 * d), round(10 * criterion)])
    shares = ndtr([d / 2 - criterion, -d / 2 - criterion])
    counts, often = np.unique(random.binomial(trials, shares, (studies, 2)), axis=0,
                              return_counts=True)  # fmt: skip
    held = 0
    for (hits, falses), times in zip(counts.tolist(), often.tolist(), strict=True):
        ends = yes_no(hits, trials, falses, trials).d_interval
        held += times * (ends.low <= d <= ends.high)
    return Found(studies, held, studies)


class Bias(NamedTuple):
    """Mean error of estimates, of a truth of 1."""

    error: float
    given: int

    def text(self) -> str:
        return f"{self.error:+.3f}"


def curve(trials: int, shape: str, alarms: float | None, studies: int) -> dict[str, Found | Bias]:
    """Coverage of a psychometric function's threshold and spread, and its threshold's bias.

    A study is one reader: seven levels of 12 or 24 trials. Yes and no has as many blank trials as a
    level has, and a share of false alarms; None is which of two.
    """
    random = np.random.default_rng([SEED, trials, len(shape), round(100 * (alarms or 0))])
    guess = 0.5 if alarms is None else alarms
    rising = SHAPES[shape](LEVELS, np.array(THRESHOLD), np.array(SPREAD))
    shares = guess + (1 - guess - LAPSES) * rising
    given, error = 0, 0.0
    held = {"threshold": 0, "spread": 0}
    for _ in range(studies):
        positive = random.binomial(trials, shares)
        blanks = (0, 0) if alarms is None else (int(random.binomial(trials, alarms)), trials)
        try:
            found = fit_psychometric(
                LEVELS, positive, np.full(7, trials), shape=shape,
                guess=0.5 if alarms is None else None, blanks=blanks, scale=(0.0, np.inf),
            )  # fmt: skip
        except Unanswerable:
            continue
        given += 1
        error += found.threshold - THRESHOLD
        for what, ends, truth in (
            ("threshold", found.threshold_interval, THRESHOLD),
            ("spread", found.spread_interval, SPREAD),
        ):
            held[what] += ends.low <= truth <= ends.high
    covered = {what: Found(given, of, studies) for what, of in held.items()}
    return {**covered, "bias": Bias(error / given, given)}


def just_noticeable(readers: int, lapse: float, seed: int = 5) -> tuple[float, float]:
    """Coverage of the point of equality, and of the just noticeable difference, as shares.

    Constant stimuli have 7 levels of 12 trials; a share of the answers lapses at each end.
    """
    random, levels = np.random.default_rng(seed), np.linspace(-2.1, 2.1, 7)
    held, given = np.zeros(2), 0
    for _ in range(readers):
        middle = random.uniform(-0.3, 0.3)
        spread = math.exp(random.uniform(math.log(0.5), math.log(1.2)))
        share = lapse + (1 - 2 * lapse) * norm.cdf(levels, middle, spread)
        more = random.binomial(12, share)
        try:
            fit = fit_psychometric(levels, more, np.full(7, 12), shape="normal", even=True)
        except Unanswerable:
            continue
        given += 1
        held += [
            of.low <= truth <= of.high
            for of, truth in ((fit.threshold_interval, middle), (fit.spread_interval, spread))
        ]
    equal, jnd = (held / given).tolist()
    return equal, jnd
