import numpy as np
import pytest
from scipy import stats

from vbraille.analysis.statistics.intervals import (
    Unanswerable,
    mean_duration,
    mean_interval,
    wilson,
)


@pytest.mark.parametrize(
    ("correct", "trials", "low", "high"),
    # Newcombe 1998, table I, method 3 (score, without continuity correction).
    [
        (81, 263, 0.2553, 0.3662),
        (15, 148, 0.0624, 0.1605),
        (0, 20, 0, 0.1611),
        (1, 29, 0.0061, 0.1718),
    ],
)
def test_wilsons_interval_is_the_published_one(correct, trials, low, high):
    found = wilson(correct, trials)
    assert (round(found.low, 4), round(found.high, 4)) == (low, high)


def test_wilsons_interval_stays_in_its_range_when_all_are_correct():
    for trials in range(1, 60):
        assert wilson(trials, trials).high <= 1
        assert wilson(0, trials).low >= 0


def test_a_proportion_needs_trials():
    with pytest.raises(Unanswerable, match="no trials"):
        wilson(0, 0)


@pytest.mark.parametrize(("correct", "trials"), [(3, 2), (-1, 2), (0, -1)])
def test_a_proportion_is_of_counts(correct, trials):
    with pytest.raises(ValueError, match="trials"):
        wilson(correct, trials)


def test_the_interval_of_a_mean_is_students(rng):
    values = rng.normal(7, 2, 6)
    theirs = stats.ttest_1samp(values, 0).confidence_interval(0.95)
    found = mean_interval(values)
    assert (found.low, found.high) == pytest.approx((theirs.low, theirs.high))


@pytest.mark.parametrize(
    ("values", "reason"),
    [
        ([], "no participants"),
        ([3.0], "one participant"),
        ([3.0, 4.0], "two participants; how people differ is seen of three or more"),
        ([0.1] * 6, "all values are the same"),
        ([0.0] * 3, "all values are the same"),
    ],
)
def test_what_leaves_no_interval_of_a_mean(values, reason):
    with pytest.raises(Unanswerable, match=reason):
        mean_interval(values)


def test_the_interval_of_a_mean_refuses_what_it_cannot_use():
    with pytest.raises(ValueError, match="finite"):
        mean_interval([1, 2, np.nan])
    with pytest.raises(ValueError, match="dimension"):
        mean_interval(np.ones((2, 2)))


def test_the_interval_of_durations_is_coxs():
    # y = 1, 2, 3: variance 1, so that log of the mean is 2.5, its error √(1/3 + 1/4).
    found = mean_duration(np.exp([1.0, 2, 3]))
    half = 4.302653 * np.sqrt(1 / 3 + 1 / 4)
    assert np.log([found.low, found.high]) == pytest.approx([2.5 - half, 2.5 + half])
    with pytest.raises(Unanswerable, match="a duration is 0"):
        mean_duration([0.0, 1, 2])
    with pytest.raises(Unanswerable, match="two participants"):
        mean_duration([1.0, 2])
    with pytest.raises(Unanswerable, match="all values are the same"):
        mean_duration([2.0] * 3)
    with pytest.raises(Unanswerable, match="differ too much"):
        mean_duration([1e-90, 1.0, 1e90])
