"""Studies of a design simulated and tested, thousands at a time.

Of each participant, the log odds of a right answer in a condition are

    η = a_c + σ z + τ z_c,                                                        (1)

with a_c of the condition, and z and z_c standard normal: σ is how much participants differ, τ how
much the effect of a condition differs between them. a_c is chosen so that the share of right
answers, averaged over the population, is the one that was asked for. Each trial is drawn by
itself.

A study has a random generator of its own, which follows from the seed and from the study's number
alone, and a participant draws before the next one does. So the studies are the same in whatever
portions they are made, and a study of 12 participants is the beginning of the one of 13.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.optimize import brentq
from scipy.special import expit, ndtri

from vbraille.analysis.statistics.intervals import adjust
from vbraille.analysis.statistics.paired import paired_p_values
from vbraille.analysis.statistics.trialsmodel import compare, fit_trials, separate_cells

if TYPE_CHECKING:
    from numpy.typing import NDArray

_NODES, _WEIGHTS = np.polynomial.hermite_e.hermegauss(80)
_MOST_LOG_ODDS = 40.0
ALPHA = 0.05  # level at which a difference counts as found


@dataclass(frozen=True, slots=True)
class StudyPlan:
    """Simulation and test, the same in every study.

    Parameters
    ----------
    trials : tuple[participants][conditions]
        Trials of each participant in each condition, of as many participants as the largest
        study has.
    log_odds
        a_c of each condition, by equation 1.
    between, differing
        σ and τ of equation 1.
    sizes
        Numbers of participants, each a study of its own.
    test
        "model" for the logistic model of trials; "paired" for a paired t-test of shares; "half"
        for a t-test of shares in the first condition against one half.
    correction
        How the p-values of a study's pairs are corrected: a key of `correction.METHODS`.
    """

    trials: tuple[tuple[int, ...], ...]
    log_odds: tuple[float, ...]
    between: float
    differing: float
    sizes: tuple[int, ...]
    test: str
    correction: str

    @property
    def pairs(self) -> list[tuple[int, int]]:
        """Conditions that are compared, first and second; one pair if shares are held to half."""
        if self.test == "half":
            return [(0, 0)]
        return list(combinations(range(len(self.log_odds)), 2))


class StudyTask(NamedTuple):
    """Some studies of a plan, numbered from `first` on, drawn by `seed`."""

    plan: StudyPlan
    seed: int
    first: int
    studies: int


def log_odds_of(share: float, spread: float) -> float:
    """Log odds whose share of right answers is this when people's log odds differ by an s.d.

    Parameters
    ----------
    share
        Share of right answers averaged over the population, between 0 and 1.
    spread
        Standard deviation of people's log odds.
    """
    weights = _WEIGHTS / _WEIGHTS.sum()

    def off(middle: float) -> float:
        return float(expit(middle + spread * _NODES) @ weights) - share

    return float(brentq(off, -_MOST_LOG_ODDS, _MOST_LOG_ODDS))  # pyright: ignore[reportArgumentType]


def simulate(task: StudyTask) -> NDArray[np.int64]:
    """Right answers of each participant in each condition; int64[studies, participants, c]."""
    plan = task.plan
    trials = np.asarray(plan.trials)
    people, conditions = trials.shape
    # The condition of each trial of each participant; conditions that are too many mean no trial.
    place = np.arange(trials.sum(axis=1).max())
    which = (place >= np.cumsum(trials, axis=1)[:, :, None]).sum(axis=1)
    draws = np.empty((task.studies, people, 1 + conditions + place.size))
    for study in range(task.studies):
        sequence = np.random.SeedSequence(task.seed, spawn_key=(task.first + study,))
        np.random.Generator(np.random.PCG64(sequence)).random(out=draws[study])
    normal = ndtri(np.maximum(draws[..., : 1 + conditions], np.finfo(float).tiny))
    log_odds = np.asarray(plan.log_odds) + plan.between * normal[..., :1]
    shares = expit(log_odds + plan.differing * normal[..., 1:])
    correct = np.empty((task.studies, people, conditions), np.int64)
    for condition in range(conditions):
        right = draws[..., 1 + conditions :] < shares[..., condition, None]
        correct[..., condition] = (right & (which == condition)).sum(axis=-1)
    return correct


def count_found(task: StudyTask) -> list[list[list[int]]]:
    """Simulate studies, test each, and count.

    Returns
    -------
    list[sizes][pairs] of [found, untested]
        Number of studies of each size whose corrected p is below the level, by pair; and of
        those in which there is no p, since the participants do not differ.
    """
    plan, correct = task.plan, simulate(task)
    trials = np.asarray(plan.trials)
    counts = []
    for size in plan.sizes:
        p = _p_values(plan, correct[:, :size], trials[:size])
        untested = np.isnan(p)
        found = _corrected(p, plan.correction) < ALPHA
        counts.append(np.column_stack([found.sum(axis=0), untested.sum(axis=0)]).tolist())
    return counts


def _p_values(
    plan: StudyPlan, correct: NDArray[np.int64], trials: NDArray[np.int64]
) -> NDArray[np.float64]:
    """P of each pair before correction; float64[studies, pairs], NaN where there is none."""
    if plan.test == "model":
        asked = np.broadcast_to(trials, correct.shape)
        fit = fit_trials(correct, asked, separate_cells(*trials.shape))
        unit = np.eye(trials.shape[1])
        tested = [compare(fit, unit[one] - unit[two]).p_values() for one, two in plan.pairs]
    else:
        shares = correct / trials
        if plan.test == "half":
            return paired_p_values(shares[..., 0] - 0.5)[:, None]
        tested = [paired_p_values(shares[..., one] - shares[..., two]) for one, two in plan.pairs]
    return np.column_stack(tested)


def _corrected(p: NDArray[np.float64], method: str) -> NDArray[np.float64]:
    """p-values corrected in each study for the number of those that it has."""
    if p.shape[1] == 1 or method == "none":
        return p
    known = ~np.isnan(p)
    if known.all():
        return adjust(p, method)
    corrected = np.full_like(p, np.nan)
    for study, own in enumerate(known):
        corrected[study, own] = adjust(p[study, own], method)
    return corrected
