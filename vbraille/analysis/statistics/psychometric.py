"""Psychometric functions: how the share of answers rises with what is presented.

A share is γ + (1 - γ - λ) F(x): γ is the share of guesses, λ that of lapses, and F rises from 0 to
1. The threshold m is where F is a half, in the unit of x. The lapses have a prior, beta with 1
and 20, and 0.1 at most, since few trials tell of them (Wichmann and Hill 2001); threshold and
logarithm of the spread are even over what the levels could show. The estimate is the most likely
of all (MAP); intervals are between quantiles of the threshold's and the spread's own posterior,
worked out on a grid (Schütt et al. 2016). docs/analysis.md has how often they hold the truth.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.optimize import minimize
from scipy.special import expit, ndtr, xlog1py, xlogy
from scipy.stats import chi2

from vbraille.analysis.statistics.intervals import LEVEL, Interval
from vbraille.analysis.statistics.scores import check_level, finite_scores
from vbraille.analysis.statistics.unanswerable import Unanswerable

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import ArrayLike, NDArray

    Curve = Callable[..., NDArray[np.float64]]  # of levels, threshold and spread

MOST_LAPSES = 0.1
FEWEST_LEVELS = 3
_FEW = 20.0  # second parameter of the lapses' prior; the first is 1
_SIZE = (64, 40, 7)  # points of the grid along threshold, spread and lapses
_GUESSES = 7  # and along guesses, where they are free
_PASSES = 3  # each after the first is over what the one before left likely, the last on all points
_UNLIKELY = 12.0  # in log likelihood below the best
_EDGE = 1e-9  # a share is at least so far from 0 and 1

SHAPES: Mapping[str, Curve] = MappingProxyType(
    {
        "logistic": lambda x, m, s: expit((x - m) / s),
        "normal": lambda x, m, s: ndtr((x - m) / s),
        "weibull": lambda x, m, s: -np.expm1(-math.log(2) * (x / m) ** (1 / s)),
    }
)
"""What F may be: of the level, the threshold and the spread. The Weibull's spread is one over its
exponent, and its levels are above 0."""


@dataclass(frozen=True, slots=True)
class PsychometricFit:
    """A psychometric function of one participant.

    Parameters
    ----------
    shape
        A key of `SHAPES`.
    threshold, threshold_interval
        Level at which F is a half, in the unit of the levels.
    spread, spread_interval
        The larger, the flatter; in the unit of the levels, but for the Weibull, which has none.
    slope
        Rise of the share at the threshold, in one over the unit of the levels.
    guess, lapse
        Shares γ and λ.
    deviance, df, p
        Twice what the log likelihood lacks to that of each level's own share; levels less two,
        since lapses and guesses hardly follow the answers; p of such a deviance by chi-square,
        which is meant for levels of ten trials or more.
    note
        What else to know; may be empty.
    """

    shape: str
    threshold: float
    threshold_interval: Interval
    spread: float
    spread_interval: Interval
    slope: float
    guess: float
    lapse: float
    deviance: float
    df: int
    p: float
    note: str

    def shares(self, levels: ArrayLike) -> NDArray[np.float64]:
        """Shares of positive answers at levels, 0…1, by the fitted function."""
        x = np.asarray(levels, np.float64)
        rising = SHAPES[self.shape](x, np.array(self.threshold), np.array(self.spread))
        return self.guess + (1 - self.guess - self.lapse) * rising


class LevelCounts(NamedTuple):
    """Counts of answers by level, with the function that is fitted to them."""

    levels: NDArray[np.float64]
    positive: NDArray[np.float64]
    trials: NDArray[np.float64]
    curve: Curve
    guess: float | None


def fit_psychometric(
    levels: ArrayLike,
    positive: ArrayLike,
    trials: ArrayLike,
    *,
    shape: str = "logistic",
    guess: float | None = 0.5,
    level: float = LEVEL,
) -> PsychometricFit:
    """Fit a psychometric function to the answers of one participant.

    Parameters
    ----------
    levels : float[n]
        What was presented, in any unit; a level may stand there several times.
    positive, trials : int[n]
        Answers that say there is more, or that are right, and all answers, at each level.
    shape
        A key of `SHAPES`.
    guess
        Share of positive answers where nothing can be felt: 0.5 for which of two, 0 where nobody
        guesses; None where it is free, as for yes and no, with the prior that lapses have.
    level
        Level of confidence.

    Raises
    ------
    Unanswerable
        If there are fewer than three levels, all answers or none are positive, or their share
        does not rise.
    ValueError
        If there is no such shape, or the counts are none.
    """
    check_level(level)
    asked = _answers(levels, positive, trials, shape, guess)
    axes = _first_axes(asked, shape)
    for _ in range(_PASSES - 1):
        axes = _nearer(axes, _log_posterior(asked, [*axes[:2], *(of[::3] for of in axes[2:])]))
    log_posterior = _log_posterior(asked, axes)
    at = np.unravel_index(np.argmax(log_posterior), log_posterior.shape)
    best = _best(asked, [float(axis[i]) for axis, i in zip(axes, at, strict=True)])
    mass = np.exp(log_posterior - log_posterior.max())
    ends = []
    for axis in (0, 1):
        own = mass.sum(axis=tuple(i for i in range(mass.ndim) if i != axis))
        ends.append(_between(axes[axis], own, level))
    threshold, spread, lapse = best[0], math.exp(best[1]), best[2]
    floor = best[3] if asked.guess is None else asked.guess
    deviance = _deviance(asked, _shares(asked, best))
    df = len(asked.levels) - 2
    inside = asked.levels[0] <= threshold <= asked.levels[-1]
    step = 1e-5 * spread * (threshold if shape == "weibull" else 1.0)
    rise = np.diff(
        asked.curve(threshold + np.array([-step, step]), *map(np.array, best[:1]), spread)
    )
    return PsychometricFit(
        shape,
        threshold,
        Interval(min(ends[0][0], threshold), max(ends[0][1], threshold), level),
        spread,
        Interval(min(math.exp(ends[1][0]), spread), max(math.exp(ends[1][1]), spread), level),
        (1 - floor - lapse) * float(rise[0]) / (2 * step),
        floor,
        lapse,
        deviance,
        df,
        float(chi2.sf(deviance, df)),
        "" if inside else "the threshold is beyond the levels that were presented",
    )


def _answers(
    levels: ArrayLike, positive: ArrayLike, trials: ArrayLike, shape: str, guess: float | None
) -> LevelCounts:
    """Counts with equal levels put together, in their order, after checks."""
    if shape not in SHAPES:
        raise ValueError(f"no shape {shape!r}; there are {', '.join(SHAPES)}")
    if guess is not None and not 0 <= guess < 1:
        raise ValueError(f"guess {guess} is not in 0…1")
    x = finite_scores("levels", levels)
    y, n = (np.asarray(of, np.float64) for of in (positive, trials))
    if not (x.shape == y.shape == n.shape) or not ((y >= 0) & (y <= n) & (n < np.inf)).all():
        raise ValueError("positive answers must be counts, no more than the trials of each level")
    x, y, n = x[n > 0], y[n > 0], n[n > 0]
    if shape == "weibull" and not (x > 0).all():
        raise ValueError("levels of a Weibull must be above 0")
    found, at = np.unique(x, return_inverse=True)
    y, n = (np.asarray(np.bincount(at, of, found.size), np.float64) for of in (y, n))
    if found.size < FEWEST_LEVELS:
        raise Unanswerable(f"{found.size} levels; a curve needs {FEWEST_LEVELS}")
    if y.sum() in (0, n.sum()):
        raise Unanswerable("all answers are the same; they show no threshold")
    if (n * (found - np.average(found, weights=n)) * (y / n)).sum() <= 0:
        raise Unanswerable("the share of answers does not rise with the level")
    return LevelCounts(found, y, n, SHAPES[shape], guess)


def _first_axes(asked: LevelCounts, shape: str) -> list[NDArray[np.float64]]:
    """Grid over all that the levels could show: threshold, logarithm of the spread, lapses, …."""
    low, high = float(asked.levels[0]), float(asked.levels[-1])
    reach, gap = high - low, float(np.diff(asked.levels).min())
    if shape == "weibull":
        thresholds = np.geomspace(low**1.5 / high**0.5, high**1.5 / low**0.5, _SIZE[0])
        spreads = np.linspace(math.log(0.05), math.log(2.0), _SIZE[1])
    else:
        thresholds = np.linspace(low - reach / 2, high + reach / 2, _SIZE[0])
        spreads = np.linspace(math.log(gap / 10), math.log(2 * reach), _SIZE[1])
    rare = (np.arange(_SIZE[2]) + 0.5) / _SIZE[2] * MOST_LAPSES
    return [thresholds, spreads, rare] + ([rare.copy()] if asked.guess is None else [])


def _log_posterior(asked: LevelCounts, axes: list[NDArray[np.float64]]) -> NDArray[np.float64]:
    """Logarithm of the posterior on a grid, up to a constant."""
    m, s = axes[0][:, None, None], np.exp(axes[1])[None, :, None]
    rising = asked.curve(asked.levels, m, s)
    lapse = axes[2][:, None]
    total = np.zeros(tuple(axis.size for axis in axes))
    guesses = axes[3] if asked.guess is None else [asked.guess]
    for number, guess in enumerate(guesses):
        of = total if asked.guess is not None else total[..., number]
        for at in range(asked.levels.size):
            share = guess + (1 - guess - lapse[:, 0]) * rising[:, :, at, None]
            share = np.clip(share, _EDGE, 1 - _EDGE)
            yes, no = asked.positive[at], asked.trials[at] - asked.positive[at]
            of += yes * np.log(share) + no * np.log1p(-share)
        of += (_FEW - 1) * np.log1p(-lapse[:, 0])
        if asked.guess is None:
            of += (_FEW - 1) * math.log1p(-guess)
    return total


def _nearer(
    axes: list[NDArray[np.float64]], log_posterior: NDArray[np.float64]
) -> list[NDArray[np.float64]]:
    """Grid over what is not unlikely of another; lapses and guesses keep theirs."""
    likely = log_posterior > log_posterior.max() - _UNLIKELY
    found = list(axes)
    for axis in (0, 1):
        at = np.flatnonzero(likely.any(axis=tuple(i for i in range(likely.ndim) if i != axis)))
        first, last = max(at[0] - 1, 0), min(at[-1] + 1, axes[axis].size - 1)
        found[axis] = np.linspace(axes[axis][first], axes[axis][last], axes[axis].size)
    return found


def _shares(asked: LevelCounts, at: list[float]) -> NDArray[np.float64]:
    floor = at[3] if asked.guess is None else asked.guess
    rising = asked.curve(asked.levels, np.array(at[0]), np.array(math.exp(at[1])))
    return np.clip(floor + (1 - floor - at[2]) * rising, _EDGE, 1 - _EDGE)


def _best(asked: LevelCounts, start: list[float]) -> list[float]:
    """Most likely parameters, from a start near them; to 1e-6 of their size."""

    def lost(at: NDArray[np.float64]) -> float:
        share = _shares(asked, at.tolist())
        right = asked.positive * np.log(share) + (asked.trials - asked.positive) * np.log1p(-share)
        return -float(right.sum() + (_FEW - 1) * np.log1p(-at[2:]).sum())

    free = [(None, None), (start[1] - 2, start[1] + 2)] + [(0.0, MOST_LAPSES)] * (len(start) - 2)
    if asked.curve is SHAPES["weibull"]:
        free[0] = (start[0] / 2, start[0] * 2)
    found = minimize(
        lost, start, method="L-BFGS-B", bounds=free, options={"ftol": 1e-14, "gtol": 1e-8}
    )
    return [float(value) for value in found.x]


def _deviance(asked: LevelCounts, share: NDArray[np.float64]) -> float:
    own = asked.positive / asked.trials
    best = xlogy(asked.positive, own) + xlog1py(asked.trials - asked.positive, -own)
    found = asked.positive * np.log(share) + (asked.trials - asked.positive) * np.log1p(-share)
    return max(2 * float((best - found).sum()), 0.0)


def _between(
    axis: NDArray[np.float64], mass: NDArray[np.float64], level: float
) -> tuple[float, float]:
    """Ends between which the level's share of the mass on an axis of even steps lies."""
    widths = np.gradient(axis)
    sums = np.cumsum(mass * widths)
    sums = np.concatenate([[0.0], sums / sums[-1]])
    ends = np.concatenate([axis - widths / 2, [axis[-1] + widths[-1] / 2]])
    tail = (1 - level) / 2
    low, high = np.interp([tail, 1 - tail], sums, ends).tolist()
    return low, high
