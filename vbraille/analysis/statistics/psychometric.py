"""Psychometric functions: how the share of answers rises with what is presented.

A share is γ + (1 - γ - λ) F(x): γ is the share of guesses, λ that of lapses, and F rises from 0 to
1. The threshold m is where F is a half, in the unit of x. The lapses have a prior, beta with 1
and 20, and 0.1 at most, since few trials tell of them (Wichmann and Hill 2001). Guesses are fixed;
as many as lapses, where a trial that is not attended to gets either answer as often; or free: even
from 0 to 0.9, and blank trials, whose share of yes is γ, join their likelihood to that of the
levels. Threshold and logarithm of the spread are even over what the levels could show, half their
range below and above them, as far as the scale goes. The estimate is the most likely of all (MAP);
intervals are between quantiles of the threshold's and the spread's own posterior, worked out on a
grid (Schütt et al. 2016). docs/validation.md has how often they hold the truth.
"""

from __future__ import annotations

import math
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from scipy.special import expit, ndtr, xlog1py, xlogy

from vbraille.analysis.statistics.intervals import TAIL, Interval, Unanswerable
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from numpy.typing import ArrayLike, NDArray

    Curve = Callable[..., NDArray[np.float64]]  # of levels, threshold and spread

MOST_LAPSES = 0.1
MOST_GUESSES = 0.9
FEWEST_LEVELS = 3
_FEW = 20.0  # second parameter of the lapses' prior; the first is 1
# Of lapses at both ends: with less, the spread of people who never lapse is too seldom within its
# interval, since some lapses are expected of all (docs/validation.md).
_WIDER = 1.05
_SIZE = (48, 32, 5, 12)  # cells of the grid along threshold, spread, lapses, and guesses if free
_COARSE = (40, 24, 3, 6)  # and of the two before it, each grid over what the last left likely
_UNLIKELY = 12.0  # in log likelihood below the best
_EDGE = 1e-9  # a share is at least so far from 0 and 1

SHAPES: Mapping[str, Curve] = MappingProxyType(
    {
        "logistic": lambda x, m, s: expit((x - m) / s),
        "normal": lambda x, m, s: ndtr((x - m) / s),
        "weibull": lambda x, m, s: -np.expm1(-math.log(2) * (x / m) ** (1 / s)),
    }
)
"""Forms of F, of the level, the threshold and the spread. The Weibull's spread is one over its
exponent, and its levels are above 0."""


class PsychometricFit(NamedTuple):
    """A psychometric function of one participant.

    Parameters
    ----------
    shape
        A key of `SHAPES`.
    threshold, threshold_interval
        Level at which F is a half, in the unit of the levels; the interval has it in it, even
        where the quantiles of the posterior leave it outside.
    spread, spread_interval
        The larger, the flatter; in the unit of the levels, but for the Weibull, which has none.
    guess, lapse
        Shares γ and λ.
    note
        What else to know; may be empty.
    """

    shape: str
    threshold: float
    threshold_interval: Interval
    spread: float
    spread_interval: Interval
    guess: float
    lapse: float
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
    blanks: tuple[int, int]
    even: bool

    @property
    def few(self) -> float:
        """Second parameter of the lapses' prior: at both ends there are half as many at each."""
        return 2 * _FEW if self.even else _FEW

    def floor(self, lapse: Any) -> Any:
        """Fixed share of guesses, where a share lapses."""
        return lapse if self.even else self.guess


def fit_psychometric(
    levels: ArrayLike,
    positive: ArrayLike,
    trials: ArrayLike,
    *,
    shape: str = "logistic",
    guess: float | None = 0.5,
    blanks: tuple[int, int] = (0, 0),
    scale: tuple[float, float] = (-math.inf, math.inf),
    even: bool = False,
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
        Share of positive answers where nothing can be felt: 0.5 for which of two, 0 without
        guessing; None where it is free, as for yes and no.
    blanks
        Positive answers to trials without anything to be felt, and all answers to them; they tell
        of free guesses.
    scale
        Ends of what the levels are measured by, such as 0 and 1; no threshold is beyond them.
    even
        Whether lapses are at both ends alike, in place of guesses, as where one of two is chosen
        that has more.

    Raises
    ------
    Unanswerable
        If there are fewer than three levels, all answers or none are positive, or their share
        does not rise.
    """
    asked = _answers(levels, positive, trials, shape, guess, blanks, even=even)
    edges = _first_edges(asked, shape, scale)
    within = [(float(axis[0]), float(axis[-1])) for axis in edges]
    for sizes in (_COARSE, _SIZE):
        edges = _nearer(edges, _log_posterior(asked, edges), sizes)
    log_posterior = _log_posterior(asked, edges)
    at = np.unravel_index(np.argmax(log_posterior), log_posterior.shape)
    start = [float(_middles(axis)[i]) for axis, i in zip(edges, at, strict=True)]
    best = _best(asked, start, within)
    mass = np.exp(log_posterior - log_posterior.max())
    ends = []
    for axis in (0, 1):
        own = mass.sum(axis=tuple(i for i in range(mass.ndim) if i != axis))
        ends.append(_between(edges[axis], own))
    threshold, spread, lapse = best[0], math.exp(best[1]), best[2]
    floor = best[3] if asked.guess is None else asked.floor(lapse)
    interval = Interval(min(ends[0][0], threshold), max(ends[0][1], threshold))
    middle = math.log(spread)
    wider = _WIDER if even else 1.0
    low, high = (math.exp(middle + wider * (end - middle)) for end in ends[1])
    return PsychometricFit(
        shape,
        threshold,
        interval,
        spread,
        Interval(min(low, spread), max(high, spread)),
        floor,
        lapse,
        "; ".join(_beyond(asked, threshold, interval)),
    )


def _answers(
    levels: ArrayLike,
    positive: ArrayLike,
    trials: ArrayLike,
    shape: str,
    guess: float | None,
    blanks: tuple[int, int],
    *,
    even: bool,
) -> LevelCounts:
    """Counts with equal levels put together, in their order, after checks."""
    x, y, n = (np.asarray(of, np.float64) for of in (levels, positive, trials))
    x, y, n = x[n > 0], y[n > 0], n[n > 0]
    found, at = np.unique(x, return_inverse=True)
    y, n = (np.asarray(np.bincount(at, of, found.size), np.float64) for of in (y, n))
    if found.size < FEWEST_LEVELS:
        raise Unanswerable(f"{count(found.size, 'level')}; a curve needs {FEWEST_LEVELS}")
    if y.sum() in (0, n.sum()):
        raise Unanswerable("all answers are the same; they show no threshold")
    if (n * (found - np.average(found, weights=n)) * (y / n)).sum() <= 0:
        raise Unanswerable("the share of answers does not rise with the level")
    return LevelCounts(found, y, n, SHAPES[shape], guess, blanks, even)


def _first_edges(
    asked: LevelCounts, shape: str, scale: tuple[float, float]
) -> list[NDArray[np.float64]]:
    """Edges of cells over all that the levels could show: threshold, logarithm of the spread, …."""
    low, high = float(asked.levels[0]), float(asked.levels[-1])
    reach, gap = high - low, float(np.diff(asked.levels).min())
    if shape == "weibull":
        least, most = max(low**1.5 / high**0.5, scale[0]), min(high**1.5 / low**0.5, scale[1])
        thresholds = np.geomspace(least, most, _COARSE[0] + 1)
        spreads = math.log(0.05), math.log(2.0)
    else:
        least, most = max(low - reach / 2, scale[0]), min(high + reach / 2, scale[1])
        thresholds = np.linspace(least, most, _COARSE[0] + 1)
        spreads = math.log(gap / 10), math.log(2 * reach)
    others = [spreads, (0.0, MOST_LAPSES), (0.0, MOST_GUESSES)][: 3 if asked.guess is None else 2]
    cells = zip(others, _COARSE[1:], strict=False)
    return [thresholds, *(np.linspace(*ends, size + 1) for ends, size in cells)]


def _middles(edges: NDArray[np.float64]) -> NDArray[np.float64]:
    return (edges[1:] + edges[:-1]) / 2


def _log_posterior(asked: LevelCounts, edges: list[NDArray[np.float64]]) -> NDArray[np.float64]:
    """Logarithm of the posterior in the middle of each cell, up to a constant."""
    axes = [_middles(axis) for axis in edges]
    m, s = axes[0][:, None, None], np.exp(axes[1])[None, :, None]
    rising = asked.curve(asked.levels, m, s)
    lapse = axes[2][:, None]
    total = np.zeros(tuple(axis.size for axis in axes))
    guesses = axes[3] if asked.guess is None else [asked.guess]
    for number, guess in enumerate(guesses):
        of = total if asked.guess is not None else total[..., number]
        for at in range(asked.levels.size):
            floor = lapse[:, 0] if asked.even else guess
            share = floor + (1 - floor - lapse[:, 0]) * rising[:, :, at, None]
            share = np.clip(share, _EDGE, 1 - _EDGE)
            yes, no = asked.positive[at], asked.trials[at] - asked.positive[at]
            of += yes * np.log(share) + no * np.log1p(-share)
        of += (asked.few - 1) * np.log1p(-lapse[:, 0]) + _of_blanks(asked, guess)
    return total


def _of_blanks(asked: LevelCounts, guess: float) -> float:
    """Log likelihood of the answers to blank trials."""
    yes, trials = asked.blanks
    return float(xlogy(yes, max(guess, _EDGE)) + xlog1py(trials - yes, -guess))


def _nearer(
    edges: list[NDArray[np.float64]], log_posterior: NDArray[np.float64], sizes: tuple[int, ...]
) -> list[NDArray[np.float64]]:
    """Cells over those of others that are not unlikely."""
    likely = log_posterior > log_posterior.max() - _UNLIKELY
    found = []
    for axis, (own, size) in enumerate(zip(edges, sizes, strict=False)):
        at = np.flatnonzero(likely.any(axis=tuple(i for i in range(likely.ndim) if i != axis)))
        first, last = max(at[0] - 1, 0), min(at[-1] + 2, own.size - 1)
        found.append(np.linspace(own[first], own[last], size + 1))
    return found


def _shares(asked: LevelCounts, at: list[float]) -> NDArray[np.float64]:
    floor = at[3] if asked.guess is None else asked.floor(at[2])
    rising = asked.curve(asked.levels, np.array(at[0]), np.array(math.exp(at[1])))
    return np.clip(floor + (1 - floor - at[2]) * rising, _EDGE, 1 - _EDGE)


def _best(asked: LevelCounts, start: list[float], within: list[tuple[float, float]]) -> list[float]:
    """Most likely parameters, from a start near them; to 1e-6 of their size."""

    def lost(at: NDArray[np.float64]) -> float:
        found = at.tolist()
        guess = found[3] if asked.guess is None else 0.0
        prior = (asked.few - 1) * math.log1p(-found[2])
        share, no = _shares(asked, found), asked.trials - asked.positive
        likely = float((xlogy(asked.positive, share) + xlog1py(no, -share)).sum())
        return -likely - prior - _of_blanks(asked, guess)

    from scipy.optimize import minimize  # takes a while to load

    found = minimize(
        lost, start, method="L-BFGS-B", bounds=within, options={"ftol": 1e-14, "gtol": 1e-8}
    )
    return [float(value) for value in found.x]


def _beyond(asked: LevelCounts, threshold: float, interval: Interval) -> Iterator[str]:
    """Clauses of what is beyond the levels that were presented."""
    low, high = asked.levels[0], asked.levels[-1]
    if not low <= threshold <= high:
        yield "the threshold is beyond the levels that were presented"
    if interval.low < low:
        yield f"the interval begins below the lowest level presented, {low:g}"
    if interval.high > high:
        yield f"the interval ends above the highest level presented, {high:g}"


def _between(edges: NDArray[np.float64], mass: NDArray[np.float64]) -> tuple[float, float]:
    """Ends between which the intervals' share of the mass in equal cells lies."""
    sums = np.concatenate([[0.0], np.cumsum(mass / mass.sum())])
    low, high = np.interp([TAIL, 1 - TAIL], sums, edges).tolist()
    return low, high
