"""Studies of a design simulated and analysed, thousands at a time.

Of each participant, the log odds of a right answer in a condition, or the score there, are

    η = a_c + σ z + τ z_c,                                                        (1)

with a_c of the condition, and z and z_c standard normal: σ is how much participants differ, τ how
much a condition differs between them; a difference of two conditions then has the standard
deviation √2 τ. Of shares, a_c is chosen so that the share of right answers, averaged over the
population, is the one that was asked for, and each trial is drawn by itself. Where people lapse, or
give false alarms, a trial is right with the probability b_c + s / (1 + exp(-η)). A score is η.

A study has a random generator of its own, which follows from the seed and from the study's number
alone, and a participant draws before the next one does. So the studies are the same in whatever
portions they are made, and a study of 12 participants is the beginning of the one of 13.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.optimize import brentq
from scipy.special import expit, ndtri

from vbraille.analysis.statistics.comparisons import (
    CellDesign,
    CellScores,
    CellShares,
    correct_family,
    effects,
)
from vbraille.analysis.statistics.intervals import Unanswerable
from vbraille.analysis.statistics.trialsmodel import (
    compare,
    compare_all,
    fit_trials,
    separate_cells,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.analysis.statistics.comparisons import LevelPair

    Floats = NDArray[np.float64]

_NODES, _WEIGHTS = np.polynomial.hermite_e.hermegauss(80)
_MOST_LOG_ODDS = 40.0
ALPHA = 0.05  # level at which a difference counts as found


@dataclass(frozen=True, slots=True)
class StudyPlan:
    """Simulation and analysis, the same in every study.

    Parameters
    ----------
    trials : tuple[participants][conditions]
        Trials of each participant in each condition of each group, of as many participants as the
        largest study has; 0 in those of other groups. Of scores, 1 where there is a score.
    middles
        a_c of each, by equation 1.
    cells
        Cell of the analysis that each belongs to.
    levels : tuple[cells][factors]
        Level of each factor in each cell.
    between, differing
        σ and τ of equation 1.
    sizes
        Numbers of participants, each a study of its own.
    model
        "trials" for the model of trials; "means" for participants' shares; "scores" for scores.
    correction
        How p are corrected: a key of `METHODS`.
    by_chance, attended
        Share of right answers in each condition that no feeling makes, b_c, and share s of the
        trials that are answered by feeling alone; empty and 1 if all are.
    """

    trials: tuple[tuple[int, ...], ...]
    middles: tuple[float, ...]
    cells: tuple[int, ...]
    levels: tuple[tuple[int, ...], ...]
    between: float
    differing: float
    sizes: tuple[int, ...]
    model: str
    correction: str
    by_chance: tuple[float, ...] = ()
    attended: float = 1.0

    @property
    def design(self) -> CellDesign:
        """Cells of the analysis."""
        return CellDesign(np.array(self.levels, np.int64).reshape(len(self.levels), -1))

    def compared(self) -> list[tuple[tuple[int, ...], LevelPair | None]]:
        """Tests of each study: every effect, followed by the differences in it."""
        design = self.design
        return [(own, pair) for own in design.effects() for pair in (None, *design.compared(own))]


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


def simulate(task: StudyTask) -> NDArray[np.float64]:
    """Right answers, or scores, of each participant in each condition.

    Returns
    -------
    float64[studies, participants, conditions]
    """
    plan = task.plan
    trials = np.asarray(plan.trials)
    people, conditions = trials.shape
    scores = plan.model == "scores"
    # The condition of each trial of each participant; conditions that are too many mean no trial.
    place = np.arange(0 if scores else trials.sum(axis=1).max())
    which = (place >= np.cumsum(trials, axis=1)[:, :, None]).sum(axis=1)
    draws = np.empty((task.studies, people, 1 + conditions + place.size))
    for study in range(task.studies):
        sequence = np.random.SeedSequence(task.seed, spawn_key=(task.first + study,))
        np.random.Generator(np.random.PCG64(sequence)).random(out=draws[study])
    normal = ndtri(np.maximum(draws[..., : 1 + conditions], np.finfo(float).tiny))
    made = np.asarray(plan.middles) + plan.between * normal[..., :1]
    made = made + plan.differing * normal[..., 1:]
    if scores:
        return np.where(trials > 0, made, np.nan)
    shares = expit(made)
    if plan.by_chance:
        shares = np.asarray(plan.by_chance) + plan.attended * shares
    correct = np.empty((task.studies, people, conditions))
    for condition in range(conditions):
        right = draws[..., 1 + conditions :] < shares[..., condition, None]
        correct[..., condition] = (right & (which == condition)).sum(axis=-1)
    return correct


def count_found(task: StudyTask) -> list[list[list[float]]]:
    """Simulate studies, analyse each, and count.

    Returns
    -------
    list[sizes][compared] of [found, untested]
        Number of studies of each size whose corrected p is below the level, for each of
        `StudyPlan.compared`; and of those in which there is no p, since the participants do not
        differ. Of a plan that compares nothing, one row a size: sum of the half widths of the
        interval of the mean, and number of studies without one.
    """
    plan = task.plan
    values, trials = _in_cells(plan, simulate(task))
    counts = []
    for size in plan.sizes:
        own, asked = values[:, :size], trials[:size]
        if not plan.levels[0]:
            counts.append([_half_widths(plan, own, asked)])
            continue
        p = _by_model(plan, own, asked) if plan.model == "trials" else _by_scores(plan, own, asked)
        found, untested = (p < ALPHA).sum(axis=0), np.isnan(p).sum(axis=0)
        counts.append(np.column_stack([found, untested]).tolist())
    return counts


def _in_cells(plan: StudyPlan, made: Floats) -> tuple[Floats, NDArray[np.int64]]:
    """Right answers or means, and trials, of the conditions in the cells of the analysis."""
    trials = np.asarray(plan.trials)
    of = np.zeros((trials.shape[1], len(plan.levels)))
    of[np.arange(trials.shape[1]), plan.cells] = 1.0
    asked = (trials @ of).astype(np.int64)
    total = np.nan_to_num(made) @ of
    if plan.model == "trials":
        return total, asked
    own = np.full_like(total, np.nan)
    return np.divide(total, asked, out=own, where=np.broadcast_to(asked > 0, own.shape)), asked


def _by_model(plan: StudyPlan, correct: Floats, asked: NDArray[np.int64]) -> Floats:
    """Corrected p of all that is compared, by the model of trials; float64[studies, compared]."""
    design = plan.design
    fit = fit_trials(correct, np.broadcast_to(asked, correct.shape), separate_cells(*asked.shape))
    effect_p, pair_p = [], []
    for own in design.effects():
        try:
            effect_p.append(compare_all(fit, design.contrasts(own)).p)
        except Unanswerable:
            effect_p.append(np.full(len(correct), np.nan))
        tested = [compare(fit, pair.weights).p_values() for pair in design.compared(own)]
        pair_p.append(np.column_stack(tested) if tested else np.empty((len(correct), 0)))
    family, within = correct_family(np.column_stack(effect_p), pair_p, plan.correction)
    return np.hstack([np.hstack([family[:, [at]], of]) for at, of in enumerate(within)])


def _by_scores(plan: StudyPlan, values: Floats, asked: NDArray[np.int64]) -> Floats:
    """The same by participants' own values."""
    rows = []
    for own in values:
        tested = effects(_scores(plan, own, asked), plan.correction)
        p = [q for effect in tested for q in (effect.p, *(p for *_, p in effect.pairs))]
        rows.append([np.nan if one is None else one for one in p])
    return np.array(rows)


def _scores(plan: StudyPlan, own: Floats, asked: NDArray[np.int64]) -> CellScores:
    have = asked > 0
    patterns, group = np.unique(have, axis=0, return_inverse=True)
    return CellScores(own, plan.design, group.ravel(), patterns.argmax(axis=0))


def _half_widths(plan: StudyPlan, values: Floats, asked: NDArray[np.int64]) -> list[float]:
    """Sum of half the widths of the interval of the only mean, and studies without one."""
    widths = []
    for own in values:
        data = (
            CellShares(own.astype(np.int64), asked, plan.design)
            if plan.model == "trials"
            else _scores(plan, own, asked)
        )
        mean = data.mean(0)
        widths.append(
            np.nan if mean.low is None or mean.high is None else (mean.high - mean.low) / 2
        )
    return [float(np.nansum(widths)), int(np.isnan(widths).sum())]
