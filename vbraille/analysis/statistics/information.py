"""Accuracy, kappa and transmitted information of a table of answers.

Every function takes counts of answers, int[rows, columns]: row i was presented, column j was
answered. The first columns are the rows' own, in their order; columns beyond them
are answers that are never right, such as "not read".
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.special import betaln, gammaln

from vbraille.analysis.statistics.intervals import TAIL, Interval, Unanswerable

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import ArrayLike, NDArray


FEWEST_ANSWERS = 20  # answers to a character, on average
WIDEST_BITS = 0.5  # beyond this width of its interval a number says nothing any more
_DRAWS, _FEWEST_DRAWS, _MOST_CELLS = 1000, 100, 20_000_000
_CHUNK_CELLS = 2_000_000
_TABLES = 400  # tables in a test of independence
_ROUNDING = 1e-9  # in bits
_RIGHT = np.sin(np.pi / 2 * (np.arange(60) + 0.5) / 60)[:, None] ** 2
_ALIKE = np.geomspace(0.5, 300.0, 24)  # answers that the errors of all characters count for
_SHARED = np.geomspace(0.3, 3000.0, 40)


class Transmission(NamedTuple):
    """Information transmitted, in bits a character, and its interval."""

    bits: float
    interval: Interval


def _entropy_bits(counts: NDArray[np.int64]) -> float:
    """Plug-in entropy of counts in an array of any shape; empty cells add nothing."""
    shares = counts[counts > 0] / counts.sum()
    return max(0.0, float(-(shares * np.log2(shares)).sum()))


def accuracy(counts: ArrayLike) -> float:
    """Share of answers that equal what was presented, 0…1."""
    table = np.asarray(counts)
    return float(np.trace(table) / table.sum())


def cohen_kappa(counts: ArrayLike) -> float:
    """Agreement beyond chance, -1…1 (Cohen 1960).

    κ = (p_o - p_e) / (1 - p_e); a column without a row of its own counts as a
    character that was never presented.

    Raises
    ------
    Unanswerable
        If one character alone was presented and answered.
    """
    table = np.asarray(counts)
    total = int(table.sum())
    presented, answered = table.sum(axis=1), table.sum(axis=0)[: table.shape[0]]
    # In whole numbers, so that agreement by chance alone is seen exactly.
    by_chance = int(presented @ answered)
    if by_chance == total**2:
        raise Unanswerable("one character was presented and answered throughout; kappa has none")
    return (int(np.trace(table)) * total - by_chance) / (total**2 - by_chance)


def presented_bits(counts: ArrayLike) -> float:
    """Entropy of what was presented, in bits: the most that can come through."""
    return _entropy_bits(np.asarray(counts).sum(axis=1))


def transmitted_bits(counts: ArrayLike) -> float:
    """Transmitted information, in bits per character (Miller and Nicely 1955).

    T = H(presented) + H(answered) - H(both), each with the observed shares in
    place of probabilities. With few answers T comes out too high: see
    `transmission`.
    """
    table = np.asarray(counts)
    presented, answered = table.sum(axis=1), table.sum(axis=0)
    bits = _entropy_bits(presented) + _entropy_bits(answered) - _entropy_bits(table)
    return max(0.0, bits)  # below 0 by rounding only


def transmission(counts: ArrayLike, *, seed: int) -> Transmission:
    """Information transmitted, in bits a character, given what was presented, and its interval.

    The plug-in estimate of `transmitted_bits` is too high for few answers, by more than a bit for
    some hundred answers among 26 letters: what each letter was taken for is seen a few times only,
    and looks more regular than it is. Here the answers to each character are taken for draws from
    shares of its own, and the shares of all characters for draws from one distribution, which is
    fitted (empirical Bayes; Archer, Park and Pillow 2013 compare such estimators): how often a
    character is read right, from a beta distribution of its own mean and concentration; which
    error is made, from a Dirichlet distribution around the errors of all, whose concentration says
    whether characters have errors of their own. Information is worked out of shares drawn from
    what is then likely.

    The interval's lower end is 0 where a permutation test of mutual information cannot tell the
    answers from answers that do not depend on what was presented. The interval is for these
    people's answers taken together, each as if it were independent of the others.

    Parameters
    ----------
    counts : int[rows, columns]
        Counts as in the other functions.
    seed
        Seed of the random draws: the same seed gives the same numbers.

    Raises
    ------
    Unanswerable
        If the counts cannot carry a number: one character alone was presented, there are fewer
        than twenty answers to a character, or the interval is wider than 0.5 bit.
    """
    table = np.asarray(counts)
    asked = table.sum(axis=1)
    own = np.flatnonzero(asked)
    if own.size < 2:
        raise Unanswerable("one character alone was presented")
    if asked.sum() < FEWEST_ANSWERS * own.size:
        raise Unanswerable(
            f"{asked.sum() / own.size:.1f} answers to a character on average, "
            f"fewer than {FEWEST_ANSWERS}"
        )
    rng = np.random.default_rng(seed)
    bits = np.clip(_drawn_bits(table[own], own, rng), 0.0, presented_bits(table))
    low, high = np.quantile(bits, [TAIL, 1 - TAIL]).tolist()
    if _chance_alone(table[own], rng) > TAIL:
        low = 0.0
    if high - low > WIDEST_BITS:
        raise Unanswerable(
            f"too few answers: the 95 % interval of the bits would be {high - low:.2f} wide, "
            f"more than {WIDEST_BITS}"
        )
    return Transmission(float(bits.mean()), Interval(low, high))


def _drawn_bits(
    table: NDArray[np.int64], own: NDArray[np.int64], rng: np.random.Generator
) -> NDArray[np.float64]:
    """Information of shares drawn from those that are likely, float64[draws].

    A row's shares are known from few answers, and scatter the mean of all rows: once in the
    answers and once more in the draws. This makes the entropy of the mean too low, which is put
    right by twice what the scatter of the draws takes away (Miller 1955, for any scatter).
    """
    weight = table.sum(axis=1) / table.sum()
    inner = np.zeros(0)
    mean, square = np.zeros(table.shape[1]), np.zeros(table.shape[1])
    for shares in _drawn_shares(table, own, rng):
        answered = np.einsum("r,drc->dc", weight, shares)
        bits = _entropies(answered) - _entropies(shares) @ weight
        inner = np.concatenate((inner, bits))
        mean += answered.sum(axis=0)
        square += (answered**2).sum(axis=0)
    mean /= inner.size
    scatter = np.maximum(square / inner.size - mean**2, 0.0)
    return inner + (scatter[mean > 0] / mean[mean > 0]).sum() / math.log(2)


def _drawn_shares(
    table: NDArray[np.int64], own: NDArray[np.int64], rng: np.random.Generator
) -> Iterator[NDArray[np.float64]]:
    """Shares of the answers to each character, float64[draws, rows, columns], in parts."""
    draws = int(np.clip(_MOST_CELLS // table.size, _FEWEST_DRAWS, _DRAWS))
    rows = np.arange(own.size)
    asked, right = table.sum(axis=1), table[rows, own]
    errors = table.copy()
    errors[rows, own] = 0
    around = np.tile(errors.sum(axis=0) + 0.5, (own.size, 1))
    around[rows, own] = 0.0
    around /= around.sum(axis=1, keepdims=True)
    a, b = _right_answers(asked, right, draws, rng)
    accuracy = rng.beta(a[:, None] + right, b[:, None] + asked - right)
    shared = _concentrations(errors, around, draws, rng)
    step = max(1, _CHUNK_CELLS // table.size)
    for first in range(0, draws, step):
        some = slice(first, first + step)
        # Cells without any draw, such as those of right answers, stay 0.
        shares = rng.standard_gamma(shared[some, None, None] * around + errors)
        sums = np.maximum(shares.sum(axis=2, keepdims=True), np.finfo(float).tiny)
        shares *= (1 - accuracy[some, :, None]) / sums
        shares[:, rows, own] = accuracy[some]
        yield shares


def _right_answers(
    asked: NDArray[np.int64], right: NDArray[np.int64], draws: int, rng: np.random.Generator
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Beta distributions that shares of right answers are likely to come from."""
    a, b = _RIGHT * _ALIKE, (1 - _RIGHT) * _ALIKE
    likely = np.zeros(a.shape)
    pairs, times = np.unique(np.column_stack((right, asked)), axis=0, return_counts=True)
    for (k, n), often in zip(pairs.tolist(), times.tolist(), strict=True):
        likely += often * (betaln(a + k, b + n - k) - betaln(a, b))
    at = _choose(likely.ravel(), draws, rng)
    return a.ravel()[at], b.ravel()[at]


def _concentrations(
    errors: NDArray[np.int64], around: NDArray[np.float64], draws: int, rng: np.random.Generator
) -> NDArray[np.float64]:
    """Draw how closely the errors of each character follow those of all."""
    seen = errors > 0
    counts, shares, sums = errors[seen], around[seen], errors.sum(axis=1)
    likely = [
        float(
            (gammaln(much) - gammaln(much + sums)).sum()
            + (gammaln(much * shares + counts) - gammaln(much * shares)).sum()
        )
        for much in _SHARED.tolist()
    ]
    return _SHARED[_choose(np.array(likely), draws, rng)]


def _choose(likely: NDArray[np.float64], draws: int, rng: np.random.Generator) -> NDArray[np.int64]:
    """Indices drawn with probabilities that are given by log likelihoods."""
    weight = np.exp(likely - likely.max())
    return rng.choice(likely.size, draws, p=weight / weight.sum())


def _chance_alone(table: NDArray[np.int64], rng: np.random.Generator) -> float:
    """Share of shuffles of the answers that seem to transmit as much information."""
    tables = int(np.clip(_MOST_CELLS // table.size, _FEWEST_DRAWS, _TABLES))
    kept = table[:, table.sum(axis=0) > 0]
    draw = _shuffles(kept, rng)
    # With the same row and column sums, more information means a lower joint entropy.
    most = float(_entropies(kept.ravel() / kept.sum())) + _ROUNDING
    as_much = sum(float(_entropies(draw().ravel() / kept.sum())) <= most for _ in range(tables))
    return (1 + as_much) / (1 + tables)


def _shuffles(table: NDArray[np.int64], rng: np.random.Generator) -> Callable[[], NDArray]:
    """Function that draws tables with the same row and column sums, all pairings as likely."""
    rows, columns, answers = table.sum(axis=1), table.sum(axis=0), int(table.sum())
    if answers > table.size * math.log(answers + 1):
        from scipy.stats import random_table  # takes longer to load than small tables to draw

        made = random_table(rows, columns)
        return lambda: made.rvs(random_state=rng)
    of_row = np.repeat(np.arange(rows.size) * columns.size, rows)
    column = np.repeat(np.arange(columns.size), columns)

    def drawn() -> NDArray[np.int64]:
        given = column.copy()
        rng.shuffle(given)
        return np.bincount(of_row + given, minlength=table.size)

    return drawn


def _entropies(shares: NDArray[np.float64]) -> NDArray[np.float64]:
    """Entropy along the last axis, in bits; a share of 0 adds nothing."""
    return -(shares * np.log2(np.where(shares > 0, shares, 1.0))).sum(axis=-1)
