import numpy as np
import pytest

from vbraille.analysis.statistics.intervals import Interval, bootstrap_mean, wilson
from vbraille.analysis.statistics.unanswerable import Unanswerable


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
        assert wilson(0, trials, level=0.8).low >= 0


def test_a_proportion_needs_trials():
    with pytest.raises(Unanswerable, match="no trials"):
        wilson(0, 0)


@pytest.mark.parametrize(("correct", "trials"), [(3, 2), (-1, 2), (0, -1)])
def test_a_proportion_is_of_counts(correct, trials):
    with pytest.raises(ValueError, match="trials"):
        wilson(correct, trials)


def test_bootstrap_is_the_same_on_every_run_and_hangs_on_its_seed(rng):
    values = rng.normal(60, 15, 7)
    assert bootstrap_mean(values, seed=4) == bootstrap_mean(list(values), seed=4)
    assert bootstrap_mean(values, seed=4) != bootstrap_mean(values, seed=5)


def test_bootstrap_comes_near_the_normal_interval_of_many_values(rng):
    values = rng.normal(60, 15, 400)
    half = 1.96 * values.std() / 20
    found = bootstrap_mean(values, seed=1, resamples=4000)
    assert found.low == pytest.approx(values.mean() - half, abs=0.15)
    assert found.high == pytest.approx(values.mean() + half, abs=0.15)


def test_bootstrap_of_two_values_is_known():
    # A quarter of the resamples are each value alone, half are their mean.
    assert bootstrap_mean([0, 1], seed=1, level=0.95) == Interval(0, 1, 0.95)
    assert bootstrap_mean([0, 1], seed=1, level=0.4) == Interval(0.5, 0.5, 0.4)


def test_bootstrap_of_values_all_the_same_is_that_value():
    assert bootstrap_mean([0.1] * 6, seed=1) == Interval(0.1, 0.1, 0.95)


@pytest.mark.parametrize(
    ("values", "reason"),
    [([], "no participants"), ([3.0], "one participant; a bootstrap needs two")],
)
def test_bootstrap_needs_two_values(values, reason):
    with pytest.raises(Unanswerable, match=reason):
        bootstrap_mean(values, seed=1)


def test_bootstrap_refuses_what_it_cannot_use():
    with pytest.raises(ValueError, match="finite"):
        bootstrap_mean([1, np.nan], seed=1)
    with pytest.raises(ValueError, match="dimensions"):
        bootstrap_mean(np.ones((2, 2)), seed=1)
    with pytest.raises(ValueError, match="resamples"):
        bootstrap_mean([1, 2], seed=1, resamples=0)
    with pytest.raises(ValueError, match="level"):
        bootstrap_mean([1, 2], seed=1, level=1)


def test_an_interval_checks_itself():
    with pytest.raises(ValueError, match="above its end"):
        Interval(2, 1, 0.95)
    with pytest.raises(ValueError, match="not finite"):
        Interval(0, np.inf, 0.95)
    with pytest.raises(ValueError, match="level"):
        Interval(0, 1, 95)
