"""Effect sizes: Hedges's correction, and intervals by noncentral distributions."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from scipy.optimize import root_scalar
from scipy.special import gammaln
from scipy.stats import ncf

from vbraille.analysis.statistics.intervals import TAIL, Interval, Unanswerable

if TYPE_CHECKING:
    from collections.abc import Callable

LARGEST = 1e4  # F beyond this is not of this world, and its interval neither
_TRIES = 60


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
