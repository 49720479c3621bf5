"""Estimated shares of right answers in conditions, and how far they are apart.

All come from a fitted `trialsmodel`; shares are those of the population's answers, averaged over
its people.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import expit
from scipy.stats import t as student

from vbraille.analysis.statistics.intervals import FEWEST_PARTICIPANTS, LEVEL
from vbraille.analysis.statistics.jointtest import try_jointly
from vbraille.analysis.statistics.scores import check_level
from vbraille.analysis.statistics.trialsmodel import combine

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from vbraille.analysis.statistics.jointtest import JointTest
    from vbraille.analysis.statistics.trialsmodel import Contrasts, TrialsFit

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


def odds_ratio(
    fit: TrialsFit, first: ArrayLike, second: ArrayLike, level: float = LEVEL
) -> Estimates:
    """Logarithm of the odds ratio of two shares of right answers, first against second.

    Parameters
    ----------
    fit
        A fitted model.
    first, second : float[p]
        Values of the design's columns at each.
    level
        Level of confidence.
    """
    apart = combine(fit, np.asarray(first, np.float64) - np.asarray(second, np.float64))
    return Estimates(apart.estimates, *apart.ends(level))


def difference(
    fit: TrialsFit, first: ArrayLike, second: ArrayLike, level: float = LEVEL
) -> Estimates:
    """Difference of two shares of right answers, first less second, -1…1.

    The interval is that of the inverse hyperbolic tangent of the difference, by the slope along
    the coefficients (delta method) and t with the degrees of freedom of the difference itself.
    With those of the odds ratio instead it would hold the truth 91 times in 100 near the ceiling,
    and 99 times when put together of the two shares' own intervals (Newcombe 1998).

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
    (one, up), (two, down) = (_share(fit, of) for of in (first, second))
    value = one - two
    apart = combine(fit, up - down)
    half = student.ppf((1 + level) / 2, apart.degrees) * apart.errors / (1 - value**2)
    middle = np.arctanh(value)
    return Estimates(value, np.tanh(middle - half), np.tanh(middle + half))


def tells_difference(correct: ArrayLike, trials: ArrayLike) -> NDArray[np.bool_]:
    """Whether three participants or more have something wrong, and as many something right.

    Where fewer have, `difference` is wider than it says: of three people near the ceiling it then
    holds the truth 99 to 100 times in 100.

    Parameters
    ----------
    correct, trials : int[studies, k, c]
        Right answers and all answers of each participant in each of the cells that are compared.

    Returns
    -------
    bool[studies]
    """
    right, asked = (np.asarray(of).sum(axis=-1) for of in (correct, trials))
    some = [(of > 0).sum(axis=-1) >= FEWEST_PARTICIPANTS for of in (right, asked - right)]
    return some[0] & some[1]


def compare(fit: TrialsFit, first: ArrayLike, second: ArrayLike) -> Contrasts:
    """Test that two shares of right answers are the same.

    They are compared as 2 asin √share, by the slope along the coefficients: the errors of this do
    not depend on the share. Log odds find too much in two groups of twenty people near the ceiling
    (6.2 % of studies in which there is nothing, where this finds 5.4).

    Parameters
    ----------
    fit
        A fitted model.
    first, second : float[p]
        Values of the design's columns at each.

    Returns
    -------
    Contrasts
        Difference of the two, first less second, with its error and degrees of freedom of t.
    """
    (one, up), (two, down) = (_even(fit, of) for of in (first, second))
    return replace(combine(fit, up - down), estimates=one - two)


def compare_all(fit: TrialsFit, contrasts: ArrayLike) -> JointTest:
    """Test that several contrasts of shares are 0 together, the shares as 2 asin √share.

    Parameters
    ----------
    fit
        A model whose columns are cells of their own, as `separate_cells` makes them.
    contrasts : float[q, cells]
        Weights of the cells in each contrast.

    Raises
    ------
    Unanswerable
        If there are no more participants than contrasts.
    """
    rows = np.asarray(contrasts, np.float64)
    values, slopes = zip(*(_even(fit, cell) for cell in np.eye(rows.shape[-1])), strict=True)
    # The slope of a cell is along its own coefficient alone.
    weights = rows[None] * np.sum(slopes, axis=0)[:, None]
    return try_jointly(fit, weights, np.stack(values, axis=-1) @ rows.T)


def _share(fit: TrialsFit, at: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Share at values of the design's columns, and its slope along the coefficients."""
    columns = np.asarray(at, np.float64)
    share = expit(fit.coefficients @ columns)
    return share, (share * (1 - share))[:, None] * columns


def _even(fit: TrialsFit, at: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The same of 2 asin √share."""
    columns = np.asarray(at, np.float64)
    share = expit(fit.coefficients @ columns)
    return 2 * np.arcsin(np.sqrt(share)), np.sqrt(share * (1 - share))[:, None] * columns
