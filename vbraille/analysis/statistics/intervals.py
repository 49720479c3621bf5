"""Intervals of a proportion of one person's answers, and of a mean over people."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy import stats

from vbraille.analysis.statistics.scores import check_level, finite_scores
from vbraille.analysis.statistics.unanswerable import Unanswerable

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

LEVEL = 0.95
FEWEST_PARTICIPANTS = 3
SEEN = "how people differ is seen of three or more"
ROUNDING = 1e-12  # values whose relative difference is smaller are the same


@dataclass(frozen=True, slots=True)
class Interval:
    """Where a quantity lies, at a level of confidence.

    Parameters
    ----------
    low, high
        Ends of the interval, in the unit of the quantity.
    level
        Level of confidence, between 0 and 1.
    """

    low: float
    high: float
    level: float

    def __post_init__(self) -> None:
        if not (math.isfinite(self.low) and math.isfinite(self.high)):
            raise ValueError(f"interval {self.low} to {self.high} is not finite")
        if self.low > self.high:
            raise ValueError(f"interval begins at {self.low}, above its end {self.high}")
        check_level(self.level)


def wilson(correct: int, trials: int, level: float = 0.95) -> Interval:
    """Score interval of a proportion (Wilson 1927), in 0…1.

    It does not shrink to a point when all or none is correct, as a reader's
    score often is.

    Parameters
    ----------
    correct, trials
        Number of correct trials, and number of all trials.
    level
        Level of confidence.

    Raises
    ------
    Unanswerable
        If there are no trials.
    ValueError
        If `correct` is not among 0…`trials`.
    """
    check_level(level)
    if not 0 <= correct <= trials:
        raise ValueError(f"{correct} correct of {trials} trials")
    if trials == 0:
        raise Unanswerable("no trials")
    ends = stats.binomtest(correct, trials).proportion_ci(level, "wilson")
    return Interval(float(ends.low), float(ends.high), level)


def mean_interval(values: ArrayLike, level: float = LEVEL) -> Interval:
    """Student's interval of the mean over the population that participants come from.

    Parameters
    ----------
    values : float[n]
        One value of each participant, in any unit, such as seconds.
    level
        Level of confidence.

    Returns
    -------
    Interval
        Interval in the unit of the values.

    Raises
    ------
    Unanswerable
        If there are fewer than three values, or all are the same: then nobody sees how people
        differ.
    """
    check_level(level)
    row = finite_scores("values", values)
    if row.size < FEWEST_PARTICIPANTS:
        raise Unanswerable(too_few(row.size))
    error = float(row.std(ddof=1)) / math.sqrt(row.size)
    if np.ptp(row) <= ROUNDING * np.abs(row).max():
        raise Unanswerable("all values are the same; how people differ is not seen")
    half = float(stats.t.ppf((1 + level) / 2, row.size - 1)) * error
    mean = float(row.mean())
    return Interval(mean - half, mean + half, level)


def mean_duration(values: ArrayLike, level: float = LEVEL) -> Interval:
    """Interval of a mean of durations, which are skewed: Cox's, with Student's t (Olsson 2005).

    Their logarithms y are taken for normal over the population, of mean μ and variance s². The
    mean duration is exp(μ + s²/2), whose logarithm has the standard error
    √(s²/n + s⁴/(2 (n - 1))).

    Parameters
    ----------
    values : float[n]
        One mean duration of each participant, in seconds.
    level
        Level of confidence.

    Raises
    ------
    Unanswerable
        If there are fewer than three values, one is 0, or all are the same.
    """
    check_level(level)
    row = finite_scores("durations", values)
    if row.size < FEWEST_PARTICIPANTS:
        raise Unanswerable(too_few(row.size))
    if row.min() <= 0:
        raise Unanswerable("a duration is 0; its interval is by logarithms")
    if np.ptp(row) <= ROUNDING * row.max():
        raise Unanswerable("all values are the same; how people differ is not seen")
    y = np.log(row)
    variance = float(y.var(ddof=1))
    middle = float(y.mean()) + variance / 2
    error = math.sqrt(variance / row.size + variance**2 / (2 * (row.size - 1)))
    half = float(stats.t.ppf((1 + level) / 2, row.size - 1)) * error
    try:
        return Interval(math.exp(middle - half), math.exp(middle + half), level)
    except OverflowError:
        raise Unanswerable("durations differ too much for an interval of their mean") from None


def too_few(participants: int) -> str:
    """Reason why there is no interval for so few participants."""
    few = ("no participants", "one participant", "two participants")[participants]
    return f"{few}; {SEEN}"
