"""How often intervals of the trials' model hold the truth, and how often its test is misled."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.special import expit, logit

from tests.benchmarks.coverage_people import Found, centre_of, mean_of
from tests.conftest import SEED
from vbraille.analysis.statistics.intervals import LEVEL, MEANS, SPREADS, log_likelihood, quantiles
from vbraille.analysis.statistics.trialsmodel import (
    combine,
    compare,
    compare_all,
    difference,
    fit_trials,
    separate_cells,
    tells_difference,
)

TRIALS = 78  # of each participant, as in the source's sessions
APART = 0.5  # log odds that conditions, and groups, differ by where they do
DIFFERING = 0.5  # SD over people of how conditions differ
AT_ONCE = 2_000  # studies
_log_likelihood = cache(log_likelihood.__wrapped__)  # of all counts there are: more than it keeps
WHAT = ("mean share", "odds ratio", "difference of shares")


@dataclass(frozen=True, slots=True)
class Misled:
    """Studies of nothing in which a test finds something."""

    given: int
    misled: int
    studies: int

    @property
    def share(self) -> float:
        """Of the studies that can be tested, in per cent."""
        return 100 * self.misled / self.given if self.given else np.nan

    def text(self) -> str:
        """The share, and that of the studies with a test where not all have one."""
        if not self.given:
            return "none"
        rest = "" if self.given == self.studies else f" ({100 * self.given / self.studies:.0f})"
        return f"{self.share:.1f}{rest}"


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
    first, second = made.shares
    if what == "mean share":
        (low, high), truth = mean_shares(made.correct[..., 1], made.trials[..., 1]), second
    else:
        fit = fit_trials(made.correct, made.trials, separate_cells(people, 2))
        if what == "odds ratio":
            (low, high), truth = combine(fit, [-1, 1]).ends(), logit(second) - logit(first)
        else:
            (low, high), truth = difference(fit, [-1, 1]), second - first
        if what == "difference of shares":
            low = np.where(tells_difference(made.correct, made.trials), low, np.nan)
    given = np.isfinite(low)
    held = (low <= truth) & (truth <= high)
    return Found(int(given.sum()), int(held.sum()), studies)


def mean_shares(correct: np.ndarray, trials: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Ends of `shares.mean_share` for many studies, of whom some participants have no trials."""
    ends = []
    for right, asked in zip(correct, trials, strict=True):
        likely = np.zeros((MEANS, SPREADS), np.float32)
        for k, n in zip(right[asked > 0].tolist(), asked[asked > 0].tolist(), strict=True):
            likely = likely + _log_likelihood(float(k), float(n))
        ends.append(quantiles(likely[None], float(asked[asked > 0].mean())))
    low, high = zip(*ends, strict=True)
    return np.concatenate(low), np.concatenate(high)


def misled(people: int, share: float, sd: float, kind: str, studies: int) -> Misled:
    """False positives: conditions or groups do not differ, and neither does any participant.

    Of two or three conditions ("within", "three within"), groups ("between", "three between"), or
    of a slope over six sixths of a session ("covariate").
    """
    random = np.random.default_rng([SEED, people, round(100 * share), round(10 * sd), len(kind)])
    cells = 6 if kind == "covariate" else 3 if kind.startswith("three") else 2
    if kind.endswith("between"):
        trials = TRIALS * np.eye(cells, dtype=int)[np.arange(people) % cells]
    else:
        trials = np.full((people, cells), TRIALS // cells)
    given = found = 0
    for part in np.array_split(np.arange(studies), max(1, studies // AT_ONCE)):
        own = expit(random.normal(centre_of(share, sd), sd, (part.size, people, 1)))
        asked = np.broadcast_to(trials, (part.size, *trials.shape))
        p = _tested(random.binomial(asked, np.broadcast_to(own, asked.shape)), asked, kind)
        known = np.isfinite(p)
        given += int(known.sum())
        found += int((p[known] < 1 - LEVEL).sum())
    return Misled(given, found, studies)


def _tested(correct: np.ndarray, trials: np.ndarray, kind: str) -> np.ndarray:
    """P of the test that is asked for, float[studies]."""
    people, cells = trials.shape[1:]
    if kind == "covariate":
        design = np.ones((people, cells, 2))
        design[..., 1] = np.arange(cells) / (cells - 1)
        return combine(fit_trials(correct, trials, design), [0, 1]).p_values()
    fit = fit_trials(correct, trials, separate_cells(people, cells))
    if cells == 3:
        return compare_all(fit, [[-1, 1, 0], [-1, 0, 1]]).p
    return compare(fit, [-1, 1]).p_values()
