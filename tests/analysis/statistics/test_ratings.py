"""Ratings: by hand, and by what made them."""

import numpy as np
import pytest

from tests.tiers import by_tier
from vbraille.analysis.statistics.intervals import mean_interval
from vbraille.analysis.statistics.ratings import compare_ratings, summarise_ratings
from vbraille.analysis.statistics.unanswerable import Unanswerable

STUDIES = by_tier(300, 2000, 10_000)


def test_each_participant_weighs_the_same():
    found = summarise_ratings([1, 1, 1, 1, 5, 3], list("aaaabc"))
    assert (found.participants, found.ratings) == (3, 6)
    assert found.mean == pytest.approx(3)
    assert found.interval == mean_interval([1, 5, 3])
    assert (found.low_quartile, found.median, found.high_quartile) == (1, 3, 5)


def test_ties_count_half():
    found = compare_ratings([3, 4], ["a", "a"], [3, 2, 1], ["a", "a", "b"])
    assert found.higher == pytest.approx((0.5 + 1 + 1 + 1) / 4)
    assert found.participants == 1
    assert found.note == "no interval: one participant; how people differ is seen of three or more"


def test_an_interval_of_order_ends_where_shares_do():
    found = compare_ratings([3, 3, 2], list("abc"), [1, 2, 2], list("abc"))
    assert found.higher == pytest.approx(2.5 / 3)
    assert found.interval.high == 1


@pytest.mark.parametrize("people", [3, 8])
def test_the_interval_of_the_mean_holds_the_truth(people):
    random = np.random.default_rng(people)
    own = random.normal(4.0, 1.0, (STUDIES, people, 1))
    rated = np.clip(np.round(own + random.normal(0, 1, (STUDIES, people, 10))), 1, 7)
    many = random.normal(4.0, 1.0, 400_000) + random.normal(0, 1, 400_000)
    truth = np.clip(np.round(many), 1, 7).mean()
    who = np.repeat(np.arange(people), 10)
    ends = [summarise_ratings(one.ravel(), who).interval for one in rated]
    # There is none where all people have rated alike.
    held = np.mean([end.low <= truth <= end.high for end in ends if end is not None])
    assert 0.92 < held < 0.985


def test_no_ratings():
    with pytest.raises(Unanswerable, match="no ratings"):
        summarise_ratings([], [])
    with pytest.raises(Unanswerable, match="nobody rated both"):
        compare_ratings([1], ["a"], [1], ["b"])
    with pytest.raises(ValueError, match="1 ratings of 2 participants"):
        summarise_ratings([1], ["a", "b"])
