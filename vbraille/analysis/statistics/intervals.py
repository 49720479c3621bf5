"""Intervals of a proportion and of a mean."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.stats import bootstrap
from statsmodels.stats.proportion import proportion_confint

from vbraille.analysis.statistics.scores import check_level, finite_scores
from vbraille.analysis.statistics.unanswerable import Unanswerable

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

LEVEL = 0.95


@dataclass(frozen=True, slots=True)
class Interval:
    """Where a quantity lies, at a level of confidence.

    Parameters
    ----------
    low, high
        Its ends, in the unit of the quantity.
    level
        Confidence, between 0 and 1.
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
        How many of how many.
    level
        Confidence.

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
    ends = proportion_confint(correct, trials, alpha=1 - level, method="wilson")
    low, high = np.clip(np.asarray(ends, dtype=np.float64), 0.0, 1.0)
    return Interval(float(low), float(high), level)


def wilson_each(
    correct: NDArray[np.int64], trials: NDArray[np.int64], level: float = LEVEL
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """`wilson` of many proportions at once.

    Parameters
    ----------
    correct, trials : int64[n]
        How many of how many; of at least one.

    Returns
    -------
    low, high : float64[n]
    """
    low, high = proportion_confint(correct, trials, alpha=1 - level, method="wilson")
    return np.clip(low, 0.0, 1.0), np.clip(high, 0.0, 1.0)


def bootstrap_mean(
    values: Sequence[float] | NDArray[np.float64],
    *,
    seed: int,
    resamples: int = 9999,
    level: float = 0.95,
) -> Interval:
    """Percentile bootstrap of the mean over participants (Efron and Tibshirani 1993, ch. 13).

    The percentile method, not BCa: the acceleration of BCa is estimated from the
    very few participants of such a study, and it has no value where many of them
    score alike (all at 100 %, say). The interval stays within the scores; with
    fewer than about ten participants it is known to be somewhat too narrow.

    Parameters
    ----------
    values : float[n]
        One value of each participant, in any unit.
    seed
        Of the resampling: the same seed, the same interval.
    resamples
        How many.
    level
        Confidence.

    Returns
    -------
    Interval
        In the unit of the values. A single point if all values are the same.

    Raises
    ------
    Unanswerable
        If there are fewer than two values.
    """
    check_level(level)
    if resamples < 1:
        raise ValueError(f"{resamples} resamples; one at least is needed")
    row = finite_scores("values", values)
    if row.size < 2:
        raise Unanswerable(
            f"{'one participant' if row.size else 'no participants'}; a bootstrap needs two"
        )
    if np.ptp(row) == 0:
        return Interval(float(row[0]), float(row[0]), level)
    found = bootstrap(
        (row,),
        np.mean,
        n_resamples=resamples,
        batch=1000,
        vectorized=True,
        confidence_level=level,
        method="percentile",
        rng=np.random.default_rng(seed),
    ).confidence_interval
    return Interval(float(found.low), float(found.high), level)
