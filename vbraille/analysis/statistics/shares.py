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
    TAIL,
    Interval,
    Unanswerable,
    too_few,
)

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

MEANS, SPREADS = 240, 32  # points of the grid along m and σ
_FINE, _LARGEST = 0.2, 8.0  # σ is spaced evenly below the first, by equal shares up to the second
_NOISE, _STEEP = 1.25, 0.45  # constants in the prior of σ
_STEPS, _NEAR = 25, 1e-3  # Newton's method, in log odds; it is quadratic, so that these suffice
_NODES, _MANY, _NODES_OF_MANY = 11, 100, 5  # many right and wrong make the integrand normal


class Grid(NamedTuple):
    """Grid on which likelihoods are worked out.

    Parameters
    ----------
    ends : float64[MEANS + 1]
        Ends of the cells of m, ascending from 0 to 1, even in the arcsine of its root.
    spread : float64[SPREADS]
        Values of σ, in log odds.
    centre : float64[MEANS, SPREADS]
        Value of μ for which the mean share at σ is m.
    weight : float64[MEANS, SPREADS]
        Size of a cell times the prior of m at σ, √(dμ/dm). At σ = 0 that is Jeffreys' prior of a
        share.
    """

    ends: NDArray[np.float64]
    spread: NDArray[np.float64]
    centre: NDArray[np.float64]
    weight: NDArray[np.float64]


def mean_share(shares: ArrayLike, trials: ArrayLike) -> Interval:
    """Interval of the mean share over the population that participants come from.

    Parameters
    ----------
    shares : float[n]
        Share of right answers, 0…1, for each participant.
    trials : int[n]
        Number of answers that each share is of.

    Raises
    ------
    Unanswerable
        If there are fewer than three participants.
    ValueError
        If a share is not in 0…1, or has no trials.
    """
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
    low, high = quantiles(found[None], float(number.mean()))
    return Interval(float(low[0]), float(high[0]))


@lru_cache(maxsize=512)
def log_likelihood(correct: float, trials: float) -> NDArray[np.float32]:
    """Log likelihood of one participant's answers up to a constant, float32[MEANS, SPREADS].

    The integral over z is by adaptive Gauss-Hermite quadrature (Pinheiro and Bates 1995): the
    nodes are put where the integrand is, which suits 1 trial as well as 100,000.

    Parameters
    ----------
    correct
        Number of right answers; not whole where a share is a mean of several.
    trials
        Number of answers.
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
    likelihoods: NDArray[np.floating], trials: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Ends of the intervals of many studies at once.

    The prior of σ is (σ² + 1.25 / trials)^-0.45. Chance alone scatters log odds of so many trials
    by a variance of 4 / trials at a share of a half. Where σ is large beside that, the prior is
    almost 1 / σ, the prior of a scale of which nothing is known, which gives a normal mean
    Student's interval. Where σ is small, the prior is even. Both numbers were found by simulation:
    of those tried they cover best where there are three participants, who leave much to the prior.
    With six or more participants they hardly matter.

    Parameters
    ----------
    likelihoods : float[studies, MEANS, SPREADS]
        Sums of the participants' log likelihoods.
    trials
        Mean of the participants' numbers of trials.

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
    return _inverse(sums, grid.ends, TAIL), _inverse(sums, grid.ends, 1 - TAIL)


@cache
def grid_of_means() -> Grid:
    """Grid that all calls share; it is made once."""
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
    size = np.diff(ends)[:, None] * np.cosh(even)  # dm dσ up to a factor
    return Grid(ends, spread, centre, size / np.sqrt(slope))


def _log_density(
    correct: float,
    trials: float,
    mu: NDArray[np.float64],
    precision: NDArray[np.float64],
    at: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Logarithm of the integrand at log odds `at`."""
    softplus = np.maximum(at, 0.0) + np.log1p(np.exp(-np.abs(at)))
    return correct * at - trials * softplus - precision * (at - mu) ** 2 / 2


def _inverse(
    sums: NDArray[np.float64], ends: NDArray[np.float64], share: float
) -> NDArray[np.float64]:
    """Place where each row of sums, rising from 0 to 1 over the ends of cells, reaches a share."""
    at = np.argmax(sums >= share, axis=1)
    rows = np.arange(len(sums))
    below, above = sums[rows, at - 1], sums[rows, at]
    return ends[at - 1] + (share - below) / (above - below) * (ends[at] - ends[at - 1])
