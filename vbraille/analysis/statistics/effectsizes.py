"""Intervals of effect sizes: the noncentralities under which the test would be as it came out."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import root_scalar
from scipy.special import chdtrc, ndtr
from scipy.stats import chi2, ncf

from vbraille.analysis.statistics.intervals import TAIL, Interval, Unanswerable

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

LARGEST = 1e4  # t or F beyond this is not of this world, and its interval neither
_TRIES = 60
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(120)
_FAR = 9.0  # standard deviations, beyond which a normal variable is not looked for


def d_z_interval(t: float, n: int) -> Interval:
    """Interval of Cohen's d of paired differences.

    d_z = t / √n, and t is noncentral with δ = √n times the population's d_z (Cumming and
    Finch 2001; Steiger and Fouladi 1997), if differences are normal.

    Parameters
    ----------
    t
        Student's t of the differences.
    n
        Number of participants, 2 or more.

    Raises
    ------
    Unanswerable
        If t is beyond ±10⁴.
    """
    if abs(t) > LARGEST:
        raise Unanswerable(f"t is beyond {LARGEST:g}")
    # Where t is negative, the interval is that of -t with its ends turned round.
    ends = [
        _root(lambda delta, p=p: noncentral_t_cdf(abs(t), n - 1, delta) - p, abs(t) - 1, abs(t) + 1)
        for p in (1 - TAIL, TAIL)
    ]
    low, high = (end / math.sqrt(n) for end in ends)
    return Interval(low, high) if t >= 0 else Interval(-high, -low)


def partial_eta2_interval(ratio: float, df1: int, df2: int) -> Interval:
    """Interval of partial eta squared, λ / (λ + df1 + df2 + 1) (Steiger 2004).

    F is noncentral with λ if sphericity holds and differences are normal; an end is 0 where F
    is smaller than chance alone would have it. For such an F the upper end would be below the
    estimate, df1 F / (df1 F + df2), to which it is raised then: the interval has its estimate in
    it, and holds the truth no less often.

    Parameters
    ----------
    ratio
        Value of F.
    df1, df2
        Degrees of freedom of the effect and of its error.

    Raises
    ------
    Unanswerable
        If F is beyond 10⁴.
    """
    if ratio > LARGEST:
        raise Unanswerable(f"F is beyond {LARGEST:g}")
    ends = []
    for p in (1 - TAIL, TAIL):
        if float(ncf.cdf(ratio, df1, df2, 0)) <= p:
            ends.append(0.0)
            continue
        found = _root(lambda nc, p=p: float(ncf.cdf(ratio, df1, df2, nc)) - p, 0.0, df1 * ratio + 1)
        ends.append(found / (found + df1 + df2 + 1))
    estimate = df1 * ratio / (df1 * ratio + df2)
    return Interval(min(ends[0], estimate), max(ends[1], estimate))


def noncentral_t_cdf(t: float, df: int, delta: float) -> float:
    """Probability that noncentral t is at most t, for t of 0 or more.

    With Z normal and s² chi-square over its degrees of freedom, t is (Z + δ) / s. The integral is
    over whichever of Z and s makes the integrand smoother. scipy's ``nct`` has no value where δ is
    negative and t is large, or both are large.

    Parameters
    ----------
    t, df, delta
        Value of t, degrees of freedom, noncentrality.
    """
    if t >= 1:
        # No s is below 0, whatever Z is, so that the integrand has a kink where Z is -δ.
        parts = sorted({-_FAR, min(max(-delta, -_FAR), _FAR), _FAR})
        return sum(_integral(_given_z, *ends, t, df, delta) for ends in pairwise(parts))
    ends = (math.sqrt(chi2.isf(p, df) / df) for p in (1 - 1e-13, 1e-13))
    return _integral(_given_s, *ends, t, df, delta)


def _given_z(z: NDArray, t: float, df: int, delta: float) -> NDArray:
    s = np.maximum(z + delta, 0) / t
    return np.exp(-(z**2) / 2) / math.sqrt(2 * math.pi) * chdtrc(df, df * s**2)


def _given_s(s: NDArray, t: float, df: int, delta: float) -> NDArray:
    return 2 * df * s * chi2.pdf(df * s**2, df) * ndtr(t * s - delta)


def _integral(density: Callable[..., NDArray], low: float, high: float, *given: float) -> float:
    at = (low + high) / 2 + (high - low) / 2 * _NODES
    return float((high - low) / 2 * (_WEIGHTS @ density(at, *given)))


def _root(falling: Callable[[float], float], low: float, high: float) -> float:
    """Place where a falling function is 0; the bracket widens until it holds that place.

    Raises
    ------
    Unanswerable
        If there is no such place within reach.
    """
    for _ in range(_TRIES):
        at_low, at_high = falling(low), falling(high)
        if not (math.isfinite(at_low) and math.isfinite(at_high)):
            break
        if at_low >= 0 >= at_high:
            return root_scalar(falling, bracket=(low, high), xtol=1e-10, rtol=1e-10).root
        width = high - low
        low, high = (low, high + width) if at_low >= 0 else (low - width, high)
    raise Unanswerable("its noncentral distribution cannot be inverted")
