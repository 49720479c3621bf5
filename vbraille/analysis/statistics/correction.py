"""Several tests at once: p-values adjusted for their number."""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np
from scipy import stats

from vbraille.analysis.statistics.scores import finite_scores

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

METHODS: Mapping[str, str] = MappingProxyType(
    {
        "none": "no correction",
        "bonferroni": "Bonferroni's correction",
        "holm": "Holm's step-down",
        "fdr": "Benjamini and Hochberg's false discovery rate",
    }
)
"""What may be asked for, with the title of each."""


def adjust(p_values: Sequence[float] | NDArray[np.float64], method: str) -> NDArray[np.float64]:
    """Adjusted p-values: each can be held against the level for a single test.

    The step-down is Holm's (1979), the false discovery rate Benjamini and Hochberg's (1995).

    Parameters
    ----------
    p_values : float[n], 0…1
        p-values of the tests that belong together; there may be none.
    method
        A key of `METHODS`.

    Returns
    -------
    float64[n], 0…1
        Adjusted p-values in the order given.

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
    if method == "bonferroni":
        return np.minimum(p * p.size, 1.0)
    if method == "fdr":
        return stats.false_discovery_control(p)
    order = np.argsort(p)
    steps = np.maximum.accumulate(p[order] * np.arange(p.size, 0, -1))
    adjusted = np.empty_like(p)
    adjusted[order] = np.minimum(steps, 1.0)
    return adjusted
