"""Two conditions of the same participants: the paired t-test."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.special import gammaln
from scipy.stats import ttest_1samp, ttest_rel

from vbraille.analysis.statistics.effectsizes import d_z_interval
from vbraille.analysis.statistics.intervals import LEVEL, ROUNDING, Unanswerable, finite_scores

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class PairedTest:
    """A paired t-test, first condition minus second.

    Parameters
    ----------
    mean_difference, low, high
        Mean of the differences and its 95 % confidence interval, in the unit of the scores.
    t, df, p
        Student's t, its degrees of freedom, the two-sided p.
    d_z
        Cohen's d of the differences, their mean by their standard deviation (Cohen 1988, 2.3.5).
    d_low, d_high
        95 % confidence interval of d, by noncentral t; None where t is too large for an interval.
    g_z
        `d_z` with Hedges' correction for few participants; None for two
        participants, where the correction would leave nothing.
    """

    mean_difference: float
    low: float
    high: float
    t: float
    df: int
    p: float
    d_z: float
    d_low: float | None
    d_high: float | None
    g_z: float | None


def hedges_correction(df: int) -> float:
    """Factor that makes a standardised mean difference unbiased, below 1.

    J = Γ(df/2) / (√(df/2) · Γ((df - 1)/2)), Hedges 1981, equation 6e. This is the
    exact factor, not its approximation 1 - 3/(4 df - 1).

    Raises
    ------
    ValueError
        If `df` is below 2.
    """
    if df < 2:
        raise ValueError(f"{df} degrees of freedom; the correction needs two")
    return math.exp(float(gammaln(df / 2) - gammaln((df - 1) / 2)) - math.log(df / 2) / 2)


def paired_t(
    first: Sequence[float] | NDArray[np.float64],
    second: Sequence[float] | NDArray[np.float64],
) -> PairedTest:
    """Student's t-test of the differences between two conditions.

    Parameters
    ----------
    first, second : float[n]
        Scores of the same participants, in the same order and unit.

    Raises
    ------
    Unanswerable
        If there are fewer than two participants, or all differences are the same.
    ValueError
        If the two are not of one length, or a score is not finite.
    """
    one, two = finite_scores("first scores", first), finite_scores("second scores", second)
    if one.size != two.size:
        raise ValueError(f"{one.size} first scores and {two.size} second ones")
    n = one.size
    if n < 2:
        raise Unanswerable(f"{'one participant' if n else 'no participants'}; a t-test needs two")
    differences = one - two
    sd = float(np.std(differences, ddof=1))
    largest = float(max(np.abs(one).max(), np.abs(two).max()))
    if sd == 0 or np.ptp(differences) <= ROUNDING * largest:
        raise Unanswerable("all differences are the same; t has no value")
    test = ttest_rel(one, two)
    interval = test.confidence_interval(LEVEL)
    try:
        of_d = d_z_interval(float(test.statistic), n)
    except Unanswerable:
        of_d = None
    mean = float(differences.mean())
    return PairedTest(
        mean_difference=mean,
        low=float(interval.low),
        high=float(interval.high),
        t=float(test.statistic),
        df=n - 1,
        p=float(test.pvalue),
        d_z=mean / sd,
        d_low=None if of_d is None else of_d.low,
        d_high=None if of_d is None else of_d.high,
        g_z=hedges_correction(n - 1) * mean / sd if n > 2 else None,
    )


def paired_p_values(differences: NDArray[np.float64]) -> NDArray[np.float64]:
    """P of paired t-tests of many studies at once, as power is simulated with.

    Parameters
    ----------
    differences : float64[studies, n]
        Differences of the participants' scores, of two participants or more.

    Returns
    -------
    float64[studies]
        Two-sided p; NaN where all differences of a study are the same.

    Raises
    ------
    Unanswerable
        If there are fewer than two participants.
    """
    n = differences.shape[1]
    if n < 2:
        raise Unanswerable(f"{'one participant' if n else 'no participants'}; a t-test needs two")
    # By their spread, since the sd of equal differences is not quite 0.
    alike = np.ptp(differences, axis=1) <= ROUNDING * np.abs(differences).max(axis=1)
    own = np.where(alike[:, None], np.nan, differences)
    test: Any = ttest_1samp(own, 0.0, axis=1)
    return test.pvalue
