"""Where a population's mean share lies, from the right answers of a few of its people.

People differ, and each gives few answers. Both are in the model: a person's log odds of a right
answer are normal over the population, and the number of right answers is binomial given them. What
is asked for is the mean *share* over the population, m = E[expit(μ + σz)], z standard normal, and
not the share of who is in the middle, expit(μ). Likelihood and priors are put together on a grid
of m and σ (Gelman et al. 2013, ch. 3 and 5), and the interval is between the quantiles of m.
"""

from __future__ import annotations

from functools import cache, lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.special import expit

from vbraille.analysis.statistics.intervals import (
    FEWEST_PARTICIPANTS,
    LEVEL,
    Interval,
    too_few,
)
from vbraille.analysis.statistics.scores import check_level
from vbraille.analysis.statistics.unanswerable import Unanswerable

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

MEANS, SPREADS = 240, 32  # points of the grid
_FINE, _LARGEST = 0.2, 8.0  # σ is spaced evenly below the first, by equal shares above; its end
_NOISE, _STEEP = 1.25, 0.45  # of the prior of σ
_STEPS, _NEAR = 25, 1e-3  # of Newton's method, in log odds; quadratic, so that more is not needed
_NODES, _MANY, _NODES_OF_MANY = 11, 100, 5  # where there are many right and wrong it is normal


class Grid(NamedTuple):
    """Where likelihoods are worked out.

    Parameters
    ----------
    ends : float64[MEANS + 1]
        Ends of the cells of m, ascending from 0 to 1, even in the arcsine of its root.
    spread : float64[SPREADS]
        σ, in log odds.
    centre : float64[MEANS, SPREADS]
        μ that has the mean share m at σ.
    weight : float64[MEANS, SPREADS]
        Size of a cell times the prior of m at σ, √(dμ/dm): at σ = 0 it is Jeffreys' for a share.
    """

    ends: NDArray[np.float64]
    spread: NDArray[np.float64]
    centre: NDArray[np.float64]
    weight: NDArray[np.float64]


def mean_share(shares: ArrayLike, trials: ArrayLike, level: float = LEVEL) -> Interval:
    """Interval of the mean share over the population that participants come from.

    Parameters
    ----------
    shares : float[n]
        Share of right answers, 0…1, for each participant.
    trials : int[n]
        How many answers each is of.
    level
        Confidence.

    Raises
    ------
    Unanswerable
        If there are fewer than three participants.
    ValueError
        If a share is not in 0…1, or is of no trials.
    """
    check_level(level)
    share, number = np.asarray(shares, np.float64), np.asarray(trials, np.float64)
    if share.ndim != 1 or share.shape != number.shape:
        raise ValueError(f"{share.shape} shares of {number.shape} numbers of trials")
    if not ((share >= 0) & (share <= 1)).all():
        raise ValueError(f"shares {share.tolist()} are not all in 0…1")
    if not ((number >= 1) & np.isfinite(number)).all():
        raise ValueError(f"numbers of trials {number.tolist()} are not all 1 or more")
    if share.size < FEWEST_PARTICIPANTS:
        raise Unanswerable(too_few(share.size))
    found = np.zeros((MEANS, SPREADS))
    for own, of in zip((share * number).tolist(), number.tolist(), strict=True):
        found += log_likelihood(own, of)
    low, high = quantiles(found[None], float(number.mean()), level)
    return Interval(float(low[0]), float(high[0]), level)


@lru_cache(maxsize=512)
def log_likelihood(correct: float, trials: float) -> NDArray[np.float32]:
    """Log likelihood of one participant's answers, float32[MEANS, SPREADS], but for a constant.

    The integral over z is by adaptive Gauss-Hermite quadrature (Pinheiro and Bates 1995):
    the nodes are put where the integrand is, which holds of 1 trial and of 100,000.

    Parameters
    ----------
    correct
        Right answers; not whole where a share is a mean of several.
    trials
        Answers.
    """
    grid = grid_of_means()
    mu, precision = grid.centre, grid.spread**-2.0
    odds = np.log((correct + 0.5) / (trials - correct + 0.5))
    sure = trials * expit(odds) * expit(-odds)
    peak = (sure * odds + precision * mu) / (sure + precision)
    for _ in range(_STEPS):
        p = expit(peak)
        bend = trials * p * (1 - p) + precision
        step = (correct - trials * p - precision * (peak - mu)) / bend
        peak = peak + np.clip(step, -2.0, 2.0)
        if np.abs(step).max() < _NEAR:
            break
    p = expit(peak)
    width = 1 / np.sqrt(trials * p * (1 - p) + precision)
    nodes, weights = np.polynomial.hermite_e.hermegauss(
        _NODES if min(correct, trials - correct) < _MANY else _NODES_OF_MANY
    )
    top, total = _log_density(correct, trials, mu, precision, peak), np.zeros_like(mu)
    for node, weight in zip(nodes.tolist(), weights.tolist(), strict=True):
        at = peak + width * node
        gain = _log_density(correct, trials, mu, precision, at) - top + node**2 / 2
        total += weight * np.exp(gain)
    return (top + np.log(total * width * np.sqrt(precision))).astype(np.float32)


def quantiles(
    likelihoods: NDArray[np.floating], trials: float, level: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Ends of the intervals of many studies at once.

    The prior of σ is (σ² + 1.25 / trials)^-0.45. Where σ is large beside what chance does to log
    odds of so many trials (variance 4 / trials at a share of a half) it is almost 1 / σ, that of a
    scale of which nothing is known, which gives a normal mean Student's interval; where σ is small,
    it is even. Both numbers are by simulation: of those tried they cover best where there are
    three participants, who leave much to the prior. With six or more they hardly matter.

    Parameters
    ----------
    likelihoods : float[studies, MEANS, SPREADS]
        Sum of the participants' log likelihoods.
    trials
        Mean of their numbers of trials.
    level
        Confidence.

    Returns
    -------
    low, high : float64[studies]
    """
    grid = grid_of_means()
    prior = (grid.weight / (grid.spread**2 + _NOISE / trials) ** _STEEP).astype(likelihoods.dtype)
    best = likelihoods.max(axis=(1, 2), keepdims=True)
    cells = np.einsum("rms,ms->rm", np.exp(likelihoods - best), prior)
    sums = np.cumsum(cells, axis=1, dtype=np.float64)
    sums = np.concatenate((np.zeros((len(sums), 1)), sums / sums[:, -1:]), axis=1)
    tail = (1 - level) / 2
    return _inverse(sums, grid.ends, tail), _inverse(sums, grid.ends, 1 - tail)


@cache
def grid_of_means() -> Grid:
    """The grid, made once."""
    ends = np.sin(np.pi / 2 * np.linspace(0.0, 1.0, MEANS + 1)) ** 2
    mean = (np.sin(np.pi / 2 * (np.arange(MEANS) + 0.5) / MEANS) ** 2)[:, None]
    even = (np.arange(SPREADS) + 0.5) / SPREADS * np.arcsinh(_LARGEST / _FINE)
    spread = _FINE * np.sinh(even)
    z = np.linspace(-8.0, 8.0, 129)
    normal = np.exp(-(z**2) / 2)
    normal /= normal.sum()
    wanted = np.log(mean / (1 - mean))
    centre = wanted * np.sqrt(1 + spread**2 * np.pi / 8)
    slope = np.empty_like(centre)
    for _ in range(8):  # Newton's method on the log odds of the mean, almost a straight line
        for column, sd in enumerate(spread.tolist()):
            p = expit(centre[:, column, None] + sd * z)
            q = expit(-centre[:, column, None] - sd * z)
            m, rest = p @ normal, q @ normal
            slope[:, column] = (p * q) @ normal
            off = np.log(m / rest) - wanted[:, 0]
            centre[:, column] -= off * m * rest / slope[:, column]
    size = np.diff(ends)[:, None] * np.cosh(even)  # dm dσ, but for a factor
    return Grid(ends, spread, centre, size / np.sqrt(slope))


def _log_density(
    correct: float,
    trials: float,
    mu: NDArray[np.float64],
    precision: NDArray[np.float64],
    at: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Logarithm of what is integrated, at log odds `at`."""
    softplus = np.maximum(at, 0.0) + np.log1p(np.exp(-np.abs(at)))
    return correct * at - trials * softplus - precision * (at - mu) ** 2 / 2


def _inverse(
    sums: NDArray[np.float64], ends: NDArray[np.float64], share: float
) -> NDArray[np.float64]:
    """Where each row of sums, from 0 to 1 over the ends of cells, reaches a share."""
    at = np.argmax(sums >= share, axis=1)
    rows = np.arange(len(sums))
    below, above = sums[rows, at - 1], sums[rows, at]
    return ends[at - 1] + (share - below) / (above - below) * (ends[at] - ends[at - 1])
