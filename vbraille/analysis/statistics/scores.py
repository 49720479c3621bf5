"""What every test asks of the scores it is given."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

# Squares of larger scores overflow; no score in seconds, millimetres or per cent comes near.
LARGEST = 1e100


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


def check_level(level: float) -> None:
    """Refuse a confidence level that is not between 0 and 1."""
    if not 0 < level < 1:
        raise ValueError(f"level {level} is not between 0 and 1")
