"""Averages over participants' own means, so that unequal numbers of trials weigh the same."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vbraille.analysis.input.trials import codes

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pandas as pd
    from numpy.typing import NDArray


def mean_or_none(values: Sequence[float]) -> float | None:
    """Mean of some values; None if there are none."""
    return float(np.mean(values)) if len(values) else None


class OwnMeans(NamedTuple):
    """Participants' own means at each of k levels.

    Parameters
    ----------
    levels : int64[k]
        Codes of the levels that occur, ascending.
    starts : int64[k]
        Where the means of each level begin in the two that follow.
    means : float64[n]
        Means of the participants who have a level, level by level.
    numbers : int64[n]
        Number of observations behind each of these means.
    """

    levels: NDArray[np.int64]
    starts: NDArray[np.int64]
    means: NDArray[np.float64]
    numbers: NDArray[np.int64]


def over_participants(level: NDArray[np.int64], frame: pd.DataFrame) -> OwnMeans:
    """Mean of each level over conditions within each participant.

    Tables 3.2 and 3.3 of Lévesque 2009 were most likely found in this way: "computed across
    all subjects using individual subject means to compensate for the unequal number of trials
    under the different conditions".

    Parameters
    ----------
    level : int64[n]
        Level of each observation.
    frame
        Data frame of observations: whether each is ``correct``, its ``participant`` and
        ``condition``.
    """
    participant, condition = codes(frame["participant"]), codes(frame["condition"])
    shape = (int(level.max()) + 1, int(participant.max()) + 1)
    cell = np.ravel_multi_index((level, participant), shape)
    numbers = np.unique(cell, return_counts=True)[1]
    correct = frame["correct"].to_numpy()
    (level, participant, _), means = _means((level, participant, condition), correct)
    (level, _), means = _means((level, participant), means)
    levels, starts = np.unique(level, return_index=True)
    return OwnMeans(levels, starts, means, numbers)


def _means(
    of: tuple[NDArray[np.int64], ...], value: NDArray
) -> tuple[tuple[NDArray[np.int64], ...], NDArray[np.float64]]:
    """Codes that occur, in order, and the mean of the observations that have each of them."""
    shape = tuple(int(code.max()) + 1 for code in of)
    cells, cell = np.unique(np.ravel_multi_index(of, shape), return_inverse=True)
    sums = np.bincount(cell, value, cells.size)
    return np.unravel_index(cells, shape), sums / np.bincount(cell, minlength=cells.size)
