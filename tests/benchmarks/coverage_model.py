"""How often intervals of the trials' model hold the truth, and how often its test is misled."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import expit, logit

from tests.benchmarks.coverage_people import Found, centre_of, mean_of
from tests.conftest import SEED
from vbraille.analysis.statistics.marginalmeans import difference, mean, separate_cells
from vbraille.analysis.statistics.trialsmodel import combine, fit_trials

TRIALS = 78  # of each participant, as in the source's sessions
APART = 0.5  # log odds that conditions, and groups, differ by where they do
DIFFERING = 0.5  # SD over people of how conditions differ
WHAT = ("mean share", "odds ratio", "difference of shares")


@dataclass(frozen=True, slots=True)
class Misled:
    """Studies of nothing in which a test finds something."""

    given: int
    misled: int

    @property
    def share(self) -> float:
        """Of the studies that can be tested, in per cent."""
        return 100 * self.misled / self.given

    def text(self) -> str:
        """The share in words for a table."""
        return f"{self.share:.1f}"


@dataclass(frozen=True, slots=True, eq=False)
class Population:
    """Simulated studies of two conditions or two groups, and what is true of them.

    Parameters
    ----------
    correct, trials
        Counts of each participant in each cell, int64[studies, people, 2].
    shares
        The population's mean share in each.
    """

    correct: np.ndarray
    trials: np.ndarray
    shares: tuple[float, float]


def population(
    people: int, share: float, sd: float, kind: str, apart: float, studies: int
) -> Population:
    """Simulate people whose log odds are normal, `kind` "within", "missing" or "between".

    "missing" are conditions within participants, of whom all but the first two lack one in six
    cells, and who have unequal numbers of trials.
    """
    random = np.random.default_rng(
        [SEED, people, round(100 * share), round(10 * sd), round(100 + 10 * apart), len(kind)]
    )
    centre = centre_of(share, sd)
    own = random.normal(centre, sd, (studies, people))
    if kind == "between":
        differing, odds = 0.0, np.stack([own, own + apart], axis=-1)
        trials = TRIALS * np.eye(2, dtype=int)[np.arange(people) % 2]
        trials = np.broadcast_to(trials, odds.shape)
    else:
        differing = DIFFERING
        odds = np.stack([own, own + apart + random.normal(0, differing, own.shape)], axis=-1)
        trials = np.full(odds.shape, TRIALS // 2)
        if kind == "missing":
            trials = random.integers(TRIALS // 4, TRIALS // 2, odds.shape)
            trials[:, 2:][random.random(trials[:, 2:].shape) < 1 / 6] = 0
    ends = mean_of(centre, sd), mean_of(centre + apart, float(np.hypot(sd, differing)))
    return Population(random.binomial(trials, expit(odds)), trials, ends)


def intervals(people: int, share: float, sd: float, kind: str, what: str, studies: int) -> Found:
    """Coverage of one of `WHAT`."""
    made = population(people, share, sd, kind, APART if share < 0.9 else -APART, studies)
    fit = fit_trials(made.correct, made.trials, separate_cells(people, 2))
    first, second = made.shares
    if what == "mean share":
        found, truth = mean(fit, [0, 1]), second
        low, high = found.low, found.high
    elif what == "odds ratio":
        (low, high), truth = combine(fit, [-1, 1]).ends(), logit(second) - logit(first)
    else:
        found, truth = difference(fit, [0, 1], [1, 0]), second - first
        low, high = found.low, found.high
    given = np.isfinite(low)
    held = (low <= truth) & (truth <= high)
    return Found(int(given.sum()), int(held.sum()), studies)


def misled(people: int, share: float, sd: float, kind: str, studies: int) -> Misled:
    """False positives: conditions or groups do not differ, and neither does any participant."""
    random = np.random.default_rng([SEED, people, round(100 * share), round(10 * sd), len(kind)])
    own = expit(random.normal(centre_of(share, sd), sd, (studies, people, 1)))
    if kind == "between":
        trials = TRIALS * np.eye(2, dtype=int)[np.arange(people) % 2]
    elif kind == "covariate":
        trials = np.full((people, 6), TRIALS // 6)
    else:
        trials = np.full((people, 2), TRIALS // 2)
    trials = np.broadcast_to(trials, (studies, *trials.shape))
    if kind == "covariate":  # a slope over six sixths of a session
        design = np.ones((people, 6, 2))
        design[..., 1] = np.arange(6) / 5
        weights = [0, 1]
    else:
        design, weights = separate_cells(people, 2), [-1, 1]
    correct = random.binomial(trials, np.broadcast_to(own, trials.shape))
    p = combine(fit_trials(correct, trials, design), weights).p_values()
    given = np.isfinite(p)
    return Misled(int(given.sum()), int((p[given] < 0.05).sum()))
