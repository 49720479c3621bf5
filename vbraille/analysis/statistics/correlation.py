"""Interval of Pearson's correlation of values that need not be normal."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from scipy import stats

from vbraille.analysis.statistics.intervals import LEVEL, Interval
from vbraille.analysis.statistics.scores import check_level, finite_scores
from vbraille.analysis.statistics.unanswerable import Unanswerable

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

FEWEST = 4
_STRAIGHT = 1 - 1e-12


def correlation_interval(first: ArrayLike, second: ArrayLike, level: float = LEVEL) -> Interval:
    """Interval of Pearson's r, on Fisher's scale (Fisher 1921).

    The standard error of atanh r is the larger of two: Fisher's 1 / √(n - 3), which is right for
    normal values, and that of the values' own fourth moments (Steiger and Hakstian 1982), which is
    right for many values of any kind. Durations are skewed, and an answer is right or wrong.

    Parameters
    ----------
    first, second : float[n]
        Values of the same n things; neither may be the same throughout.
    level
        Level of confidence.

    Raises
    ------
    Unanswerable
        If there are fewer than four values, or all lie on a line.
    ValueError
        If the two are not of one length, or a value is not finite.
    """
    check_level(level)
    one, two = finite_scores("first values", first), finite_scores("second values", second)
    if one.size != two.size:
        raise ValueError(f"{one.size} first values and {two.size} second ones")
    n = one.size
    if n < FEWEST:
        raise Unanswerable(f"{n} values; it needs {FEWEST}")
    x, y = ((row - row.mean()) / row.std() for row in (one, two))
    r = float(x @ y) / n
    if not abs(r) < _STRAIGHT:
        raise Unanswerable("all values lie on a line")
    own = float(np.std(x * y - r / 2 * (x**2 + y**2), ddof=1)) / (1 - r**2)
    error = max(1 / math.sqrt(n - 3), own / math.sqrt(n))
    half = float(stats.norm.ppf((1 + level) / 2)) * error
    return Interval(math.tanh(math.atanh(r) - half), math.tanh(math.atanh(r) + half), level)
