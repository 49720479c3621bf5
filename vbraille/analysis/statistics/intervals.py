"""Intervals of proportions, means, shares and correlations; several p-values; their errors.

All intervals of the analysis have the level `LEVEL`.
"""

from __future__ import annotations

import math
from functools import cache, lru_cache
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.special import expit, ndtri, stdtr, stdtrit

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike, NDArray

LEVEL = 0.95
TAIL = (1 - LEVEL) / 2
FEWEST_PARTICIPANTS = 3
SEEN = "how people differ is seen of three or more"
ROUNDING = 1e-12  # values whose relative difference is smaller are the same
# Squares of larger scores overflow; no score in seconds, millimetres or per cent comes near.
LARGEST = 1e100
METHODS: Mapping[str, str] = MappingProxyType(
    {
        "none": "no correction",
        "bonferroni": "Bonferroni's correction",
        "holm": "Holm's step-down",
        "fdr": "Benjamini and Hochberg's false discovery rate",
    }
)
"""Corrections of p-values that may be asked for, with the title of each."""


class Unanswerable(ValueError):  # noqa: N818 - what is wrong is the question
    """Error of a question that has no answer for these scores.

    The message is a short clause with the reason, fit to stand in a report in
    place of the number: "one participant; a t-test needs two".
    """


class Interval(NamedTuple):
    """Ends between which a quantity lies, in its unit."""

    low: float
    high: float


def finite_scores(name: str, scores: ArrayLike) -> NDArray[np.float64]:
    """Scores as float64[n], after a check that they can be reckoned with.

    Raises
    ------
    ValueError
        If they are not one row of numbers, or if one is not finite or beyond ±1e100.
    """
    row = np.asarray(scores, dtype=np.float64)
    if row.ndim != 1:
        raise ValueError(f"{name} have {row.ndim} dimensions; one is needed")
    if not (np.abs(row) <= LARGEST).all():  # False for NaN too
        raise ValueError(f"{name} must be finite and within ±{LARGEST:g}")
    return row


def wilson(correct: int, trials: int) -> Interval:
    """Score interval of a proportion (Wilson 1927), in 0…1.

    It does not shrink to a point when all or none is correct, as a reader's
    score often is.

    Parameters
    ----------
    correct, trials
        Number of correct trials, and number of all trials.

    Raises
    ------
    Unanswerable
        If there are no trials.
    ValueError
        If `correct` is not among 0…`trials`.
    """
    if not 0 <= correct <= trials:
        raise ValueError(f"{correct} correct of {trials} trials")
    if trials == 0:
        raise Unanswerable("no trials")
    square = float(ndtri(1 - TAIL)) ** 2
    middle = (correct + square / 2) / (trials + square)
    spread = square * (correct * (trials - correct) / trials + square / 4)
    half = math.sqrt(spread) / (trials + square)
    low = 0.0 if correct == 0 else middle - half
    return Interval(low, 1.0 if correct == trials else middle + half)


def mean_interval(values: ArrayLike) -> Interval:
    """Student's interval of the mean over the population that participants come from.

    Parameters
    ----------
    values : float[n]
        One value of each participant, in any unit, such as seconds.

    Raises
    ------
    Unanswerable
        If there are fewer than three values, or all are the same: then they do not show how people
        differ.
    """
    row = _differing(finite_scores("values", values))
    error = float(row.std(ddof=1)) / math.sqrt(row.size)
    half = float(stdtrit(row.size - 1, 1 - TAIL)) * error
    mean = float(row.mean())
    return Interval(mean - half, mean + half)


def mean_duration(values: ArrayLike) -> Interval:
    """Interval of a mean of durations, which are skewed: Cox's, with Student's t (Olsson 2005).

    Their logarithms y are taken for normal over the population, of mean μ and variance s². The
    mean duration is exp(μ + s²/2), whose logarithm has the standard error
    √(s²/n + s⁴/(2 (n - 1))).

    Parameters
    ----------
    values : float[n]
        One mean duration of each participant, in seconds.

    Raises
    ------
    Unanswerable
        If there are fewer than three values, one is 0, or all are the same.
    """
    row = _differing(finite_scores("durations", values))
    if row.min() <= 0:
        raise Unanswerable("a duration is 0; its interval is by logarithms")
    y = np.log(row)
    variance = float(y.var(ddof=1))
    middle = float(y.mean()) + variance / 2
    error = math.sqrt(variance / row.size + variance**2 / (2 * (row.size - 1)))
    half = float(stdtrit(row.size - 1, 1 - TAIL)) * error
    try:
        return Interval(math.exp(middle - half), math.exp(middle + half))
    except OverflowError:
        raise Unanswerable("durations differ too much for an interval of their mean") from None


def correlation_interval(first: ArrayLike, second: ArrayLike) -> Interval:
    """Interval of Pearson's r, on Fisher's scale (Fisher 1921).

    The standard error of atanh r is the larger of two: Fisher's 1 / √(n - 3), which is right for
    normal values, and that of the values' own fourth moments (Steiger and Hakstian 1982), which is
    right for many values of any kind. Durations are skewed, and an answer is right or wrong.

    Parameters
    ----------
    first, second : float[n]
        Values of the same n things; neither may be the same throughout.

    Raises
    ------
    Unanswerable
        If there are fewer than four values, or all lie on a line.
    ValueError
        If the two are not of one length, or a value is not finite.
    """
    one, two = finite_scores("first values", first), finite_scores("second values", second)
    if one.size != two.size:
        raise ValueError(f"{one.size} first values and {two.size} second ones")
    n = one.size
    if n < 4:
        raise Unanswerable(f"{n} values; it needs 4")
    x, y = ((row - row.mean()) / row.std() for row in (one, two))
    r = float(x @ y) / n
    if not abs(r) < 1 - ROUNDING:
        raise Unanswerable("all values lie on a line")
    own = float(np.std(x * y - r / 2 * (x**2 + y**2), ddof=1)) / (1 - r**2)
    error = max(1 / math.sqrt(n - 3), own / math.sqrt(n))
    half = float(ndtri(1 - TAIL)) * error
    return Interval(math.tanh(math.atanh(r) - half), math.tanh(math.atanh(r) + half))


def slope_interval(x: NDArray[np.float64], y: NDArray[np.float64]) -> tuple[float, Interval, float]:
    """Slope of a straight line by least squares, with Student's interval and p.

    Parameters
    ----------
    x, y : float64[n]
        Places, and the values there.

    Raises
    ------
    Unanswerable
        If there are fewer than three points, or all are at one place.
    """
    if x.size < 3 or np.ptp(x) == 0:
        raise Unanswerable("there are fewer than three estimates, or one value")
    apart = x - x.mean()
    slope = float((apart * y).sum() / (apart**2).sum())
    off = y - y.mean() - slope * apart
    error = math.sqrt(float((off**2).sum()) / (x.size - 2) / float((apart**2).sum()))
    half = float(stdtrit(x.size - 2, 1 - TAIL)) * error
    t = slope / error if error else math.inf
    p = 2 * float(stdtr(x.size - 2, -abs(t)))
    return slope, Interval(slope - half, slope + half), p


def adjust(p_values: ArrayLike, method: str) -> NDArray[np.float64]:
    """P-values adjusted for their number: each can be held against the level for a single test.

    The step-down is Holm's (1979), the false discovery rate Benjamini and Hochberg's (1995).

    Parameters
    ----------
    p_values : float[…, n], 0…1
        p-values of the n tests that belong together; there may be none.
    method
        A key of `METHODS`.

    Raises
    ------
    ValueError
        If the method is not known, or a p-value is outside 0…1.
    """
    if method not in METHODS:
        raise ValueError(f"no correction {method!r}; there are {', '.join(METHODS)}")
    p = np.asarray(p_values, np.float64)
    if not ((p >= 0) & (p <= 1)).all():  # nor NaN
        raise ValueError(f"p-values {p.tolist()} are not all in 0…1")
    if method == "none" or p.size == 0:
        return p.copy()
    if method == "bonferroni":
        return np.minimum(p * p.shape[-1], 1.0)
    order = np.argsort(p, axis=-1)
    steps, n = np.take_along_axis(p, order, axis=-1), p.shape[-1]
    if method == "fdr":
        steps *= n / np.arange(1, n + 1)
        steps = np.minimum.accumulate(steps[..., ::-1], axis=-1)[..., ::-1]
    else:
        steps = np.maximum.accumulate(steps * np.arange(n, 0, -1), axis=-1)
    adjusted = np.empty_like(p)
    np.put_along_axis(adjusted, order, np.minimum(steps, 1.0), axis=-1)
    return adjusted


def too_few(participants: int) -> str:
    """Reason why there is no interval for so few participants."""
    few = ("no participants", "one participant", "two participants")[participants]
    return f"{few}; {SEEN}"


def _differing(row: NDArray[np.float64]) -> NDArray[np.float64]:
    """Values of participants, if they are enough and differ."""
    if row.size < FEWEST_PARTICIPANTS:
        raise Unanswerable(too_few(row.size))
    if np.ptp(row) <= ROUNDING * np.abs(row).max():
        raise Unanswerable("all values are the same; how people differ is not seen")
    return row


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
