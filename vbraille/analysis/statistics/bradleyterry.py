"""Paired comparisons: a scale of the values, the preferred one, the side that was favoured."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.special import bdtr, expit, stdtr

from vbraille.analysis.statistics.intervals import (
    FEWEST_PARTICIPANTS,
    ROUNDING,
    TAIL,
    Interval,
    Unanswerable,
    mean_interval,
    mean_share,
    wilson,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

SMALLEST_STEP = 1e-10
LARGEST_STEP = 1.0  # keeps the first steps of one-sided comparisons from overshooting
MOST_STEPS = 1000  # convergence is linear; tens of thousands of sparse tables took fewer than 400
SAME = 1e-8
"""Strengths that differ by less are equal; the fit goes on until steps are far below it."""


class Scale(NamedTuple):
    """Bradley and Terry's scale: value i is chosen over j with odds exp(s_i - s_j) to 1.

    Parameters
    ----------
    strengths : float64[k]
        Natural logarithms of the strengths, with sum 0; bias-reduced (Firth 1993), see
        `bradley_terry`.
    covariance : float64[k, k]
        Covariance of the strengths; the variance of s_i - s_j is c_ii + c_jj - 2 c_ij.
    """

    strengths: NDArray[np.float64]
    covariance: NDArray[np.float64]


class Preference(NamedTuple):
    """The value that is liked best.

    Parameters
    ----------
    value, interval
        Preferred value and its interval, in the unit of the values; None for no interval.
    how
        Clause for a report on what the interval comes from; empty if there is no interval.
    note
        Why there is no interval, or what else to know of it; otherwise empty.
    """

    value: float
    interval: Interval | None
    how: str
    note: str


class PositionBias(NamedTuple):
    """Share of choices of the first of a pair, with its interval and p, which may be None."""

    share_first: float
    interval: Interval | None
    p: float | None


def bradley_terry(wins: ArrayLike) -> Scale:
    """Scale of values that were compared in pairs (Bradley and Terry 1952).

    The likelihood is fitted with Jeffreys' prior as a penalty (Firth 1993), which takes
    away the first-order bias of the strengths and keeps them finite when a value
    is always or never chosen (Kosmidis and Firth 2021); it is the `br` of R's
    BradleyTerry2 (Turner and Firth 2012). With many comparisons it is the plain
    maximum-likelihood scale.

    Parameters
    ----------
    wins : int[k, k]
        wins[i, j] is how often value i was chosen over value j; the diagonal is 0.

    Raises
    ------
    Unanswerable
        If there are no comparisons, or they fall into groups of values that were
        never compared with each other.
    """
    table = np.asarray(wins)
    if table.sum() == 0:
        raise Unanswerable("no comparisons")
    counts = table.astype(np.float64)[None]
    if not connected(counts)[0]:
        raise Unanswerable(
            "some values were never compared with the others, even by way of a third"
        )
    strengths, covariance = fit(counts)
    return Scale(strengths[0], covariance[0])


def preferred(
    values: Sequence[float] | NDArray[np.float64],
    first: ArrayLike,
    second: ArrayLike,
    chosen: ArrayLike,
    groups: ArrayLike,
    *,
    seed: int,
    resamples: int = 2000,
) -> Preference:
    """Preferred value: the mean over participants of where their own scale is highest.

    A parabola goes through the highest strength of a participant's scale and its two
    neighbours among the ordered values, so that two neighbours chosen equally often give the
    value between them; at an end it is the end. The interval is Student's, over three
    participants or more, for the population that they come from; of one participant it is the
    percentile bootstrap over the comparisons (Efron and Tibshirani 1993, ch. 13), for this
    participant. Both end where the tested values do.

    Parameters
    ----------
    values : float[k]
        Values that were compared, in any order, none of them twice.
    first, second : int[n]
        Which value came first and which second, 0…k - 1.
    chosen : int[n]
        0 if the first was chosen, 1 if the second.
    groups : int[n]
        Number of each comparison's participant.
    seed
        Seed of the resampling for one participant: the same seed gives the same interval.
    resamples
        Number of resamples; those that leave some values uncompared are left out.

    Raises
    ------
    Unanswerable
        If there are no comparisons, or no participant's make a scale with a highest value.
    """
    values = np.asarray(values, np.float64)
    wins = _wins_of_each(values.size, first, second, chosen, groups)
    order = np.argsort(values)
    values, wins = values[order], wins[:, order][:, :, order]
    if np.ptp(bradley_terry(wins.sum(axis=0)).strengths) <= SAME:
        raise Unanswerable("all values were chosen equally often; none is preferred")
    own = _own_peaks(values, wins.astype(np.float64))
    notes = []
    if own.size < len(wins):
        left = len(wins) - own.size
        notes.append(
            f"without {left} of {len(wins)} participants, whose own comparisons prefer no value"
        )
    at_end = int(np.isin(own, values[[0, -1]]).sum())
    value, ends, how = float(own.mean()), None, ""
    if at_end:
        whose = "it" if len(wins) == 1 else f"the value of {at_end} of {own.size} participants"
        notes.append(f"{whose} is at the end of what was tested, and the best may lie beyond")
    if at_end == own.size:
        notes.append("no interval")
    elif len(wins) == 1:
        try:
            ends = _of_comparisons(values, wins[0], seed, resamples)
            how = "bootstrap over the comparisons of one participant"
        except Unanswerable as reason:
            notes.append(f"no interval: {reason}")
    else:
        try:
            ends = mean_interval(own)
            how = f"Student's t over {own.size} participants' own values"
        except Unanswerable as reason:
            notes.append(f"no interval: {reason}")
    if ends is not None and (ends.low <= values[0] or ends.high >= values[-1]):
        ends = Interval(max(ends.low, values[0]), min(ends.high, values[-1]))
        if not at_end:
            notes.append("the interval reaches the end of what was tested; the best may lie beyond")
    return Preference(value, ends, how, "; ".join(notes))


def position_bias(chosen: ArrayLike, groups: ArrayLike) -> PositionBias:
    """True if the first of two is chosen more or less often than the second.

    For one participant: the share of the first, Wilson's interval, and the exact binomial test
    against a half. For several: the mean of their own shares, its interval for the population that
    they come from, and Student's t-test of the own shares against a half.

    Parameters
    ----------
    chosen : int[n]
        0 if the first was chosen, 1 if the second.
    groups : int[n]
        Number of each choice's participant.

    Returns
    -------
    PositionBias
        Share of the first, 0…1; its interval and p, None where there are too few participants or
        all are alike.

    Raises
    ------
    Unanswerable
        If there are no comparisons.
    """
    choice, who = np.asarray(chosen), np.asarray(groups)
    if choice.size == 0:
        raise Unanswerable("no comparisons")
    index = np.unique(who, return_inverse=True)[1]
    trials = np.bincount(index)
    own = np.bincount(index, choice == 0) / trials
    if own.size == 1:
        firsts, n = int((choice == 0).sum()), choice.size
        p = min(1.0, 2 * float(bdtr(min(firsts, n - firsts), n, 0.5)))
        return PositionBias(firsts / n, wilson(firsts, n), p)
    if own.size < FEWEST_PARTICIPANTS:
        return PositionBias(float(own.mean()), None, None)
    interval = mean_share(own, trials)
    if np.ptp(own) <= ROUNDING:
        return PositionBias(float(own.mean()), interval, None)
    t = (float(own.mean()) - 0.5) * math.sqrt(own.size) / float(own.std(ddof=1))
    return PositionBias(float(own.mean()), interval, 2 * float(stdtr(own.size - 1, -abs(t))))


def _wins_of_each(
    k: int, first: ArrayLike, second: ArrayLike, chosen: ArrayLike, groups: ArrayLike
) -> NDArray[np.int64]:
    """Count each participant's choices of one value over another, int64[participants, k, k]."""
    one, two, choice, who = (np.asarray(column) for column in (first, second, chosen, groups))
    names, index = np.unique(who, return_inverse=True)
    wins = np.zeros((len(names), k, k), dtype=np.int64)
    np.add.at(wins, (index, np.where(choice, two, one), np.where(choice, one, two)), 1)
    return wins


def _own_peaks(values: NDArray[np.float64], wins: NDArray[np.float64]) -> NDArray[np.float64]:
    """Value at which each participant's scale is highest, for those who have one; float64[n]."""
    whole = wins[connected(wins)]
    if len(whole):
        strengths = fit(whole)[0]
        strengths = strengths[np.ptp(strengths, axis=1) > SAME]
        if len(strengths):
            return _peaks(values, strengths)
    raise Unanswerable("too few comparisons of each participant for a scale of their own")


def _of_comparisons(
    values: NDArray[np.float64], wins: NDArray[np.int64], seed: int, resamples: int
) -> Interval:
    """Percentile bootstrap over one participant's comparisons."""
    rng = np.random.default_rng(seed)
    # Comparisons drawn with replacement are multinomial counts of their outcomes.
    drawn = rng.multinomial(int(wins.sum()), wins.ravel() / wins.sum(), size=resamples)
    drawn = drawn.reshape(resamples, *wins.shape).astype(np.float64)
    usable = connected(drawn)
    if usable.mean() < 0.5:
        raise Unanswerable("too few comparisons; most resamples leave some values uncompared")
    low, high = np.quantile(_peaks(values, fit(drawn[usable])[0]), [TAIL, 1 - TAIL]).tolist()
    if high <= low:
        raise Unanswerable("too few comparisons that differ; all resamples prefer the same value")
    return Interval(low, high)


def _peaks(values: NDArray[np.float64], strengths: NDArray[np.float64]) -> NDArray[np.float64]:
    """Value at which each scale is highest: float64[r] of float64[k] rising and float64[r, k]."""
    k = values.size
    level = strengths >= strengths.max(axis=1, keepdims=True) - SAME
    # Of equally high values an inner one is taken, so that the parabola has two neighbours.
    inner = np.r_[0, np.ones(max(0, k - 2), dtype=int), 0][:k]
    top = np.argmax(level * (1 + inner), axis=1)
    at_end = (top == 0) | (top == k - 1)
    middle = np.where(at_end, 1, top) if k > 2 else top
    if k <= 2:
        return values[top]
    rows = np.arange(len(strengths))
    left, mid, right = (values[middle + i] for i in (-1, 0, 1))
    down_left, down_right = (strengths[rows, middle] - strengths[rows, middle + i] for i in (-1, 1))
    # Newton's divided differences: slopes of the two chords, and the bend between them.
    slope_left, slope_right = down_left / (mid - left), -down_right / (right - mid)
    bend = slope_left - slope_right
    flat = np.abs(down_left) + np.abs(down_right) <= 2 * SAME
    share = slope_left / np.where(flat | at_end, 1, bend)
    vertex = (left + mid) / 2 + share * (right - left) / 2
    return np.where(at_end, values[top], np.where(flat, mid, vertex))


def connected(wins: NDArray[np.float64]) -> NDArray[np.bool_]:
    """True if comparisons lead from every value to every other, bool[r] of float64[r, k, k]."""
    k = wins.shape[-1]
    ways = (wins + wins.swapaxes(1, 2) > 0) + np.eye(k)
    for _ in range(k.bit_length()):  # each squaring doubles the length of the ways
        ways = np.minimum(ways @ ways, 1.0)
    return np.asarray(ways.min(axis=(1, 2)) > 0)


def fit(
    wins: NDArray[np.float64], *, most_steps: int = MOST_STEPS
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Strengths and their covariances, by Fisher scoring on Firth's modified score.

    Firth 1993: to the wins of i over j and of j over i half the leverage of their
    pair is added, h_ij = w_ij var(s_i - s_j), where w_ij = n_ij π_ij π_ji is the
    pair's information. It depends on the strengths, so that it is worked out anew
    in every step.

    Parameters
    ----------
    wins : float64[r, k, k]
        wins[., i, j] is how often i was chosen over j; every table must be connected.
    most_steps
        Number of steps after which the fit is given up.

    Returns
    -------
    strengths : float64[r, k]
        Natural logarithms of the strengths, with sum 0.
    covariance : float64[r, k, k]
        Inverse of the information.

    Raises
    ------
    RuntimeError
        If a table has not settled after so many steps.
    """
    r, k, _ = wins.shape
    strengths, covariance = np.zeros((r, k)), np.empty((r, k, k))
    going = np.arange(r)
    for _ in range(most_steps):
        s, won = strengths[going], wins[going]
        share = expit(s[:, :, None] - s[:, None, :])
        both = share * share.swapaxes(1, 2)
        weight = (won + won.swapaxes(1, 2)) * both
        inverse = _inverse(weight)
        own = np.diagonal(inverse, axis1=1, axis2=2)
        leverage = weight * (own[:, :, None] + own[:, None, :] - 2 * inverse)
        # Wins that were not expected less losses that were not. The large numbers of one-sided
        # comparisons are left out, since their difference would be lost in rounding.
        surprise = (won + leverage / 2) * share.swapaxes(1, 2)
        score = (surprise - surprise.swapaxes(1, 2)).sum(axis=2)
        # Where the leverage is as large as the comparisons (one for each pair, say), steps by the
        # information alone would be too long and never settle.
        step = np.einsum("rij,rj->ri", _inverse(weight + leverage * both), score)
        longest = np.abs(step).max(axis=1)
        step *= (LARGEST_STEP / np.maximum(longest, LARGEST_STEP))[:, None]
        strengths[going] = s + step
        covariance[going] = inverse
        going = going[longest > SMALLEST_STEP]
        if not going.size:
            return strengths - strengths.mean(axis=1, keepdims=True), covariance
    raise RuntimeError(f"{going.size} scales of paired comparisons did not settle")


def _inverse(weight: NDArray[np.float64]) -> NDArray[np.float64]:
    """Covariances of strengths of sum 0, from the information of each pair, float64[r, k, k].

    1/k in every place takes up the direction in which all strengths move together.
    """
    k = weight.shape[-1]
    information = np.eye(k) * weight.sum(axis=2, keepdims=True) - weight
    return np.linalg.inv(information + 1 / k) - 1 / k
