"""Estimated shares of right answers in conditions, and how far they are apart.

All come from a fitted `trialsmodel`; shares are those of the population's answers, averaged over
its people.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import expit
from scipy.stats import t as student

from vbraille.analysis.statistics.intervals import LEVEL
from vbraille.analysis.statistics.scores import check_level
from vbraille.analysis.statistics.trialsmodel import combine

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from vbraille.analysis.statistics.trialsmodel import TrialsFit

TO_D = math.sqrt(3) / math.pi
"""What a logarithm of an odds ratio is multiplied by for Cohen's d of what lies beneath: the
standard deviation of the logistic distribution (Hasselblad and Hedges 1995)."""


@dataclass(frozen=True, slots=True, eq=False)
class Estimates:
    """A quantity in several studies, with its interval.

    Parameters
    ----------
    value, low, high : float64[studies]
        The quantity and the ends of its interval, which are NaN where there is none.
    """

    value: NDArray[np.float64]
    low: NDArray[np.float64]
    high: NDArray[np.float64]


def separate_cells(participants: int, cells: int) -> NDArray[np.float64]:
    """Design in which each cell has log odds of its own: float64[participants, cells, cells].

    Cells may be conditions within participants, groups between them, or both crossed; a
    participant has no trials in the cells of other groups.
    """
    return np.tile(np.eye(cells), (participants, 1, 1))


def mean(fit: TrialsFit, weights: ArrayLike, level: float = LEVEL) -> Estimates:
    """Share of right answers where the design's columns have these values, 0…1.

    The interval is found on the scale of log odds.

    Parameters
    ----------
    fit
        A fitted model.
    weights : float[p]
        Values of the design's columns.
    level
        Level of confidence.
    """
    at = combine(fit, weights)
    low, high = at.ends(level)
    return Estimates(expit(at.estimates), expit(low), expit(high))


def difference(
    fit: TrialsFit, first: ArrayLike, second: ArrayLike, level: float = LEVEL
) -> Estimates:
    """Difference of two shares of right answers, first less second, -1…1.

    The interval is put together of the two shares' own, by the degrees of freedom of their odds
    ratio and with their correlation (Newcombe 1998; Zou and Donner 2008), so that it has not the
    same width on both sides near 0 and 1. By the slope of the difference along the coefficients
    instead (delta method), it holds the truth 91 times in 100 near the ceiling.

    Parameters
    ----------
    fit
        A fitted model.
    first, second : float[p]
        Values of the design's columns at each.
    level
        Level of confidence.
    """
    check_level(level)
    one, two = (np.asarray(of, np.float64) for of in (first, second))
    apart = combine(fit, one - two)
    quantile = student.ppf((1 + level) / 2, apart.degrees)
    ends, errors = [], []
    for of in (one, two):
        at = combine(fit, of)
        half = quantile * at.errors
        ends.append([expit(at.estimates + way * half) for way in (-1, 0, 1)])
        errors.append(at.errors)
    with np.errstate(invalid="ignore", divide="ignore"):
        common = (errors[0] ** 2 + errors[1] ** 2 - apart.errors**2) / (2 * errors[0] * errors[1])
    common = np.clip(common, -1.0, 1.0)
    (low_1, value_1, high_1), (low_2, value_2, high_2) = ends
    value = value_1 - value_2
    down = _both(value_1 - low_1, high_2 - value_2, common)
    up = _both(high_1 - value_1, value_2 - low_2, common)
    return Estimates(value, value - down, value + up)


def _both(
    one: NDArray[np.float64], other: NDArray[np.float64], common: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Half of an interval from the halves of two with a correlation."""
    return np.sqrt(np.maximum(one**2 + other**2 - 2 * common * one * other, 0.0))
