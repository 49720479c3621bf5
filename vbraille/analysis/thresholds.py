"""Thresholds and preferred values of one person, by a grid of the observer's parameters.

The share of positive answers at a level x is g + (1 - g - l) F(x), with guesses g and lapses l. The
threshold is where F is a half: of a logistic function for yes and no, and of a Weibull function for
right answers by difference. Before the answers, all thresholds from half the range of the levels
below them to half above are equally likely, as are all logarithms of the spread, and all guesses
from 0 to 0.9 where they are free. Lapses are beta(1, 20), and 0.1 at most (Wichmann and Hill 2001).

The grid is drawn closer twice around what is likely: without this, intervals of steep functions
hold the truth in 90 % only. The estimate is the most likely point, and the interval lies between
quantiles of the threshold's own posterior (Schütt et al. 2016).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy import optimize, special

from vbraille.adaptive.observer import Grid, nearer, psychometric

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from vbraille.analysis.stats import Floats

FEWEST_LEVELS = 3
MOST_LAPSES = 0.1
MOST_GUESSES = 0.9
FEW_LAPSES = 20
POINTS = {"threshold": 32, "spread": 16, "guess": 8, "lapse": 4}
UNLIKELY = 12.0  # in log likelihood below the best
EDGE = 1e-9
LEVELS_AT_ONCE = 64  # so that the grid's table stays small


class Threshold(NamedTuple):
    """A threshold with its 95 % credible interval, or the reason why it has no value."""

    value: float = np.nan
    low: float = np.nan
    high: float = np.nan
    why: str = ""


def _logistic(x, threshold, spread, guess, lapse) -> Floats:
    return psychometric("logistic")(x, threshold, np.exp(spread), guess, lapse)


def _weibull(x, threshold, spread, guess, lapse) -> Floats:
    """Return a Weibull function that is a half at the threshold; its slope is 1 / spread."""
    slope = np.exp(-spread)
    return psychometric("weibull")(x, threshold / np.log(2) ** (1 / slope), slope, guess, lapse)


def find_threshold(
    levels: ArrayLike,
    positive: ArrayLike,
    *,
    guess: float | None = None,
    blanks: tuple[int, int] = (0, 0),
    by_ratio: bool = False,
    most: float = np.inf,
) -> Threshold:
    """Find the threshold of one person.

    Parameters
    ----------
    levels : float[trials]
        Level of each trial, 0 or more.
    positive : bool[trials]
        Whether it was answered with yes, or rightly.
    guess
        Share of positive answers where nothing can be felt; None if it is free.
    blanks
        Positive answers to trials with nothing to be felt, and all answers to them.
    by_ratio
        Whether levels are differences above 0, so that the function is Weibull's.
    most
        Largest level that there may be.

    Returns
    -------
    Threshold
        One at or beyond an end of the levels is a limit: it has no value, and the reason says so.
    """
    at, index = np.unique(np.round(np.asarray(levels, np.float64), 9), return_inverse=True)
    trials = np.bincount(index)
    yes = np.bincount(index, np.asarray(positive, np.float64))
    if at.size < FEWEST_LEVELS:
        return Threshold(why=f"{at.size} levels, and a threshold needs {FEWEST_LEVELS}")
    below, above = f"threshold below {at[0]:g}, the lowest level", f"{at[-1]:g}, the highest level"
    if yes.sum() == 0:
        return Threshold(why=f"threshold above {above}")
    if yes.sum() == trials.sum():
        return Threshold(why=below)
    if np.cov(at, yes / trials, fweights=trials)[0, 1] <= 0:
        return Threshold(why="answers do not rise with the level")
    observer = _weibull if by_ratio else _logistic
    axes = _axes(at, guess, by_ratio=by_ratio, most=most)

    def log_posterior(points: dict[str, Floats]) -> Floats:
        guesses = np.clip(points["guess"], EDGE, 1)[:, np.newaxis]
        total = special.xlogy(blanks[0], guesses) + special.xlog1py(blanks[1] - blanks[0], -guesses)
        total = total + (FEW_LAPSES - 1) * np.log1p(-points["lapse"])
        for first in range(0, at.size, LEVELS_AT_ONCE):
            part = slice(first, first + LEVELS_AT_ONCE)
            grid = Grid(observer, points)
            total = total + grid.log_likelihood(at[part], yes[part], trials[part])
        return total

    def lost(point: Floats) -> float:
        return -log_posterior(dict(zip(axes, point.reshape(-1, 1), strict=True))).item()

    bounds = [(values[0], values[-1]) for values in axes.values()]
    for _ in range(2):
        axes = _closer(axes, log_posterior(axes))
    found = log_posterior(axes)
    best = np.unravel_index(np.argmax(found), found.shape)
    start = [values[n] for values, n in zip(axes.values(), best, strict=True)]
    value = optimize.minimize(lost, start, method="L-BFGS-B", bounds=bounds).x[0]
    ends = Grid(observer, axes).estimate("threshold", found)
    threshold = Threshold(value, min(ends.low, value), max(ends.high, value))
    if value <= at[0]:
        return threshold._replace(value=np.nan, why=below)
    if value >= at[-1]:
        return threshold._replace(value=np.nan, why=f"threshold above {above}")
    return threshold


def _axes(at: Floats, guess: float | None, *, by_ratio: bool, most: float) -> dict[str, Floats]:
    """Return points over everything that the levels could show; spreads as logarithms."""
    low, high = at[0], at[-1]
    reach = high - low
    if by_ratio:
        ends = low**1.5 / high**0.5, high**1.5 / low**0.5
        spreads = np.log(0.05), np.log(2.0)
    else:
        ends = max(low - reach / 2, 0.0), min(high + reach / 2, most)
        spreads = np.log(np.diff(at).min() / 10), np.log(2 * reach)
    guesses = [guess] if guess is not None else np.linspace(0, MOST_GUESSES, POINTS["guess"])
    return {
        "threshold": np.linspace(*ends, POINTS["threshold"]),
        "spread": np.linspace(*spreads, POINTS["spread"]),
        "guess": np.array(guesses),
        "lapse": np.linspace(0, MOST_LAPSES, POINTS["lapse"]),
    }


def _closer(axes: dict[str, Floats], log_posterior: Floats) -> dict[str, Floats]:
    """Return points over what is not unlikely."""
    likely = np.nonzero(log_posterior > log_posterior.max() - UNLIKELY)
    closer = {}
    for at, (name, values) in zip(likely, axes.items(), strict=True):
        first, last = max(at.min() - 1, 0), min(at.max() + 1, values.size - 1)
        closer[name] = np.linspace(values[first], values[last], POINTS[name])[: values.size]
    return closer


def find_preferred(first: ArrayLike, second: ArrayLike, chose_first: ArrayLike) -> Threshold:
    """Find the value that one person prefers, from choices of the nearer of two values.

    All inner values of the range are equally likely beforehand, and noises of 2 to 40 % of it;
    3 % of the answers are lapses.

    Parameters
    ----------
    first, second : float[trials]
        Values in the order in which they were felt.
    chose_first : bool[trials]
        Whether the first was chosen.

    Returns
    -------
    Threshold
        Mean of the posterior. If the most likely value is an end of the range, it is a limit, and
        has no value.
    """
    shown = np.column_stack([first, second]).astype(float)
    low, high = shown.min(), shown.max()
    if low == high:
        return Threshold(why="no two values were compared")
    pairs, index = np.unique(shown, axis=0, return_inverse=True)
    chosen = np.bincount(index.ravel(), np.asarray(chose_first, np.float64))
    axes = {
        "liked": np.linspace(low, high, 101),
        "noise": np.geomspace(0.02, 0.4, 12) * (high - low),
        "lapse": (0.03,),
    }
    grid = Grid(nearer, axes)
    found = grid.log_likelihood(pairs, chosen, np.bincount(index.ravel()))
    estimate = grid.estimate("liked", found)
    best = int(np.argmax(np.exp(found - found.max()).sum(axis=(1, 2))))
    if 0 < best < found.shape[0] - 1:
        return Threshold(estimate.mean, estimate.low, estimate.high)
    end = low if best == 0 else high
    why = f"preferred value at {end:g}, an end of the range, or beyond"
    return Threshold(np.nan, estimate.low, estimate.high, why=why)
