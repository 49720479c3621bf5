"""How much came through: accuracy, kappa and transmitted information of a table of answers.

Every function takes counts, int[rows, columns]: row i was presented, column j was
answered. The first columns are the rows' own, in their order; columns beyond them
are answers that are never right, such as "not read".
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vbraille.analysis.statistics.unanswerable import Unanswerable

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


def check_counts(counts: ArrayLike) -> NDArray[np.int64]:
    """Counts as int64[rows, columns], not empty.

    Raises
    ------
    Unanswerable
        If there are no answers.
    ValueError
        If these are no counts, or there are fewer columns than rows.
    """
    table = np.asarray(counts)
    if table.ndim != 2 or table.shape[1] < table.shape[0]:
        raise ValueError(f"counts of shape {table.shape}; each row needs a column of its own")
    if table.size and not np.issubdtype(table.dtype, np.integer):
        raise ValueError(f"counts are {table.dtype}, not integers")
    if (table < 0).any():
        raise ValueError(f"a count is {table.min()}, below 0")
    if table.sum() == 0:
        raise Unanswerable("no answers")
    return table.astype(np.int64)


def _entropy_bits(counts: NDArray[np.int64]) -> float:
    """Plug-in entropy of counts in an array of any shape; empty cells add nothing."""
    shares = counts[counts > 0] / counts.sum()
    return max(0.0, float(-(shares * np.log2(shares)).sum()))


def accuracy(counts: ArrayLike) -> float:
    """Share of answers that equal what was presented, 0…1.

    Raises
    ------
    Unanswerable
        If there are no answers.
    ValueError
        If these are no counts, or there are fewer columns than rows.
    """
    table = check_counts(counts)
    return float(np.trace(table) / table.sum())


def cohen_kappa(counts: ArrayLike) -> float:
    """Agreement beyond chance, -1…1 (Cohen 1960).

    κ = (p_o - p_e) / (1 - p_e); a column without a row of its own counts as a
    character that was never presented.

    Raises
    ------
    Unanswerable
        If there are no answers, or one character alone was presented and answered.
    ValueError
        If these are no counts, or there are fewer columns than rows.
    """
    table = check_counts(counts)
    total = int(table.sum())
    presented, answered = table.sum(axis=1), table.sum(axis=0)[: table.shape[0]]
    # In whole numbers, so that agreement by chance alone is seen exactly.
    by_chance = int(presented @ answered)
    if by_chance == total**2:
        raise Unanswerable("one character was presented and answered throughout; kappa has none")
    return (int(np.trace(table)) * total - by_chance) / (total**2 - by_chance)


def presented_bits(counts: ArrayLike) -> float:
    """Entropy of what was presented, in bits: the most that can come through.

    Raises
    ------
    Unanswerable
        If there are no answers.
    ValueError
        If these are no counts, or there are fewer columns than rows.
    """
    return _entropy_bits(check_counts(counts).sum(axis=1))


def transmitted_bits(counts: ArrayLike) -> float:
    """Transmitted information, in bits per character (Miller and Nicely 1955).

    T = H(presented) + H(answered) - H(both), each with the observed shares in
    place of probabilities. With few answers T comes out too high: see
    `transmission`.

    Raises
    ------
    Unanswerable
        If there are no answers.
    ValueError
        If these are no counts, or there are fewer columns than rows.
    """
    table = check_counts(counts)
    presented, answered = table.sum(axis=1), table.sum(axis=0)
    bits = _entropy_bits(presented) + _entropy_bits(answered) - _entropy_bits(table)
    return max(0.0, bits)  # below 0 by rounding only
