"""Intervals of proportions, means and correlations, p-values of several tests, and their errors.

All intervals of the analysis have the level `LEVEL`.
"""

from __future__ import annotations

import math
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy import stats
from statsmodels.stats.multitest import multipletests
from statsmodels.stats.proportion import proportion_confint

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
    ends = proportion_confint(correct, trials, alpha=1 - LEVEL, method="wilson")
    return Interval(*np.clip(np.asarray(ends, np.float64), 0.0, 1.0).tolist())


def mean_interval(values: ArrayLike) -> Interval:
    """Student's interval of the mean over the population that participants come from.

    Parameters
    ----------
    values : float[n]
        One value of each participant, in any unit, such as seconds.

    Raises
    ------
    Unanswerable
        If there are fewer than three values, or all are the same: then nobody sees how people
        differ.
    """
    row = _differing(finite_scores("values", values))
    error = float(row.std(ddof=1)) / math.sqrt(row.size)
    half = float(stats.t.ppf(1 - TAIL, row.size - 1)) * error
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
    half = float(stats.t.ppf(1 - TAIL, row.size - 1)) * error
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
    half = float(stats.norm.ppf(1 - TAIL)) * error
    return Interval(math.tanh(math.atanh(r) - half), math.tanh(math.atanh(r) + half))


def adjust(p_values: ArrayLike, method: str) -> NDArray[np.float64]:
    """P-values adjusted for their number: each can be held against the level for a single test.

    The methods are Holm's (1979) and Benjamini and Hochberg's (1995), as statsmodels has them.

    Parameters
    ----------
    p_values : float[n], 0…1
        p-values of the tests that belong together; there may be none.
    method
        A key of `METHODS`.

    Raises
    ------
    ValueError
        If the method is not known, or a p-value is outside 0…1.
    """
    if method not in METHODS:
        raise ValueError(f"no correction {method!r}; there are {', '.join(METHODS)}")
    p = finite_scores("p-values", p_values)
    if ((p < 0) | (p > 1)).any():
        raise ValueError(f"p-values {p.tolist()} are not all in 0…1")
    if method == "none" or p.size == 0:
        return p.copy()
    named = "fdr_bh" if method == "fdr" else method
    return np.asarray(multipletests(p, method=named)[1], dtype=np.float64)


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
