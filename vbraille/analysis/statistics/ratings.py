"""Ratings on a scale: how high they are, how they spread, and how often one is the higher."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vbraille.analysis.statistics.intervals import LEVEL, Interval, mean_interval
from vbraille.analysis.statistics.scores import check_level, finite_scores
from vbraille.analysis.statistics.unanswerable import Unanswerable

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


@dataclass(frozen=True, slots=True)
class RatingSummary:
    """Ratings of one condition by several participants.

    Parameters
    ----------
    participants, ratings
        How many there are of each.
    mean, interval
        Mean of the participants' own means, and Student's interval of the population's; None
        where `note` says why.
    median, low_quartile, high_quartile
        Quartiles over all ratings, each participant weighing the same.
    note
        Why there is no interval; may be empty.
    """

    participants: int
    ratings: int
    mean: float
    interval: Interval | None
    median: float
    low_quartile: float
    high_quartile: float
    note: str


@dataclass(frozen=True, slots=True)
class RatingComparison:
    """How often a rating of the first condition is above one of the second.

    Parameters
    ----------
    participants
        Who rated both.
    higher, interval
        Mean over participants of the share of their pairs of ratings in which the first's is the
        higher, ties counting half (Vargha and Delaney 2000), and Student's interval; None where
        `note` says why.
    note
        Why there is no interval; may be empty.
    """

    participants: int
    higher: float
    interval: Interval | None
    note: str


def summarise_ratings(
    ratings: ArrayLike, participants: ArrayLike, level: float = LEVEL
) -> RatingSummary:
    """Sum up the ratings of one condition.

    Parameters
    ----------
    ratings : float[n]
        Ratings as numbers of the scale's steps.
    participants : [n]
        Participant of each rating.
    level
        Level of confidence.

    Raises
    ------
    Unanswerable
        If there are no ratings.
    ValueError
        If the two are not of one length, or a rating is not finite.
    """
    check_level(level)
    each = _by_participant(ratings, participants)
    if not each:
        raise Unanswerable("no ratings")
    rows = list(each.values())
    own = np.array([row.mean() for row in rows])
    interval, note = _interval(own, level)
    weights = np.concatenate([np.full(row.size, 1 / row.size) for row in rows])
    low, median, high = np.quantile(
        np.concatenate(rows), [0.25, 0.5, 0.75], weights=weights, method="inverted_cdf"
    ).tolist()
    total = sum(row.size for row in rows)
    return RatingSummary(len(rows), total, float(own.mean()), interval, median, low, high, note)


def compare_ratings(
    first: ArrayLike,
    first_participants: ArrayLike,
    second: ArrayLike,
    second_participants: ArrayLike,
    level: float = LEVEL,
) -> RatingComparison:
    """Compare the ratings of two conditions within participants, by order alone.

    Parameters
    ----------
    first, second : float[n], float[m]
        Ratings of each condition.
    first_participants, second_participants : [n], [m]
        Participant of each rating.
    level
        Level of confidence.

    Raises
    ------
    Unanswerable
        If nobody rated both.
    ValueError
        If columns are not of one length, or a rating is not finite.
    """
    check_level(level)
    one = _by_participant(first, first_participants)
    two = _by_participant(second, second_participants)
    both = [who for who in one if who in two]
    if not both:
        raise Unanswerable("nobody rated both")
    own = np.array(
        [(np.sign(one[who][:, None] - two[who]).mean() + 1) / 2 for who in both], np.float64
    )
    interval, note = _interval(own, level)
    if interval is not None:
        interval = Interval(max(interval.low, 0.0), min(interval.high, 1.0), level)
    return RatingComparison(len(both), float(own.mean()), interval, note)


def _interval(own: NDArray[np.float64], level: float) -> tuple[Interval | None, str]:
    try:
        return mean_interval(own, level), ""
    except Unanswerable as reason:
        return None, f"no interval: {reason}"


def _by_participant(
    ratings: ArrayLike, participants: ArrayLike
) -> dict[object, NDArray[np.float64]]:
    """Ratings of each participant, in the order of the participants' names."""
    row, who = finite_scores("ratings", ratings), np.asarray(participants)
    if row.shape != who.shape:
        raise ValueError(f"{row.size} ratings of {who.size} participants")
    return {name.item(): row[who == name] for name in np.unique(who)}
