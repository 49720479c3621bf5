import numpy as np
import pytest
from scipy import stats

from vbraille.analysis.statistics.intervals import Unanswerable, correlation_interval


def test_of_normal_values_it_is_near_fishers(rng):
    x = rng.normal(0, 1, 400)
    y = 0.6 * x + rng.normal(0, 1, 400)
    theirs = stats.pearsonr(x, y).confidence_interval(0.95)
    found = correlation_interval(x, y)
    assert (found.low, found.high) == pytest.approx((theirs.low, theirs.high), abs=0.02)
    assert found.low <= theirs.low
    assert found.high >= theirs.high


@pytest.mark.no_cover
def test_of_skewed_values_it_holds_the_truth_more_often_than_fishers(rng):
    z = rng.normal(0, 1, (2, 400, 40))
    x, y = np.exp(z[0]), np.exp(0.7 * z[0] + 0.7 * z[1])
    many = rng.normal(0, 1, (2, 2_000_000))
    truth = np.corrcoef(np.exp(many[0]), np.exp(0.7 * many[0] + 0.7 * many[1]))[0, 1]
    ours = theirs = 0
    for a, b in zip(x, y, strict=True):
        found = correlation_interval(a, b)
        fisher = stats.pearsonr(a, b).confidence_interval(0.95)
        ours += found.low <= truth <= found.high
        theirs += fisher.low <= truth <= fisher.high
    assert ours > theirs


@pytest.mark.parametrize(
    ("one", "two", "reason"),
    [([1, 2, 3], [1, 3, 2], "needs 4"), ([1, 2, 3, 4], [2, 4, 6, 8], "on a line")],
)
def test_what_has_no_interval(one, two, reason):
    with pytest.raises(Unanswerable, match=reason):
        correlation_interval(one, two)


def test_two_lengths_are_refused():
    with pytest.raises(ValueError, match="4 first values and 3"):
        correlation_interval([1, 2, 3, 4], [1, 2, 3])
