import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.special import expit
from scipy.stats import binom, norm

from tests.benchmarks.coverage_people import shares
from tests.tiers import examples
from vbraille.analysis.statistics.intervals import (
    MEANS,
    SPREADS,
    Unanswerable,
    grid_of_means,
    log_likelihood,
    mean_share,
)


def test_the_grid_has_the_means_that_it_says():
    grid = grid_of_means()
    middle = np.sin(np.pi / 2 * (np.arange(MEANS) + 0.5) / MEANS) ** 2
    for i, j in ((3, 2), (120, 20), (200, SPREADS - 1)):
        mu, sd = grid.centre[i, j], grid.spread[j]
        mean = quad(lambda z, m=mu, s=sd: expit(m + s * z) * norm.pdf(z), -9, 9, limit=200)[0]
        assert mean == pytest.approx(middle[i], abs=1e-6)


@pytest.mark.parametrize(("correct", "trials"), [(1, 1), (38, 40), (40, 40), (700, 1666)])
def test_the_likelihood_is_the_integral(correct, trials):
    grid = grid_of_means()
    cells = [(60, 10), (120, 15), (150, 20), (200, 25)]
    theirs = []
    for i, j in cells:
        mu, sd = grid.centre[i, j], grid.spread[j]
        x = np.linspace(mu - 9 * sd, mu + 9 * sd, 200_001)
        integrand = binom.pmf(correct, trials, expit(x)) * norm.pdf(x, mu, sd)
        theirs.append(np.log(np.trapezoid(integrand, x)))
    ours = [float(log_likelihood(correct, trials)[cell]) for cell in cells]
    np.testing.assert_allclose(np.diff(ours), np.diff(theirs), atol=0.03)


def test_many_people_with_many_trials_have_the_normal_interval(rng):
    own = expit(rng.normal(0.5, 0.7, 60))
    found = mean_share(own, [5000] * 60)
    half = 1.96 * own.std(ddof=1) / np.sqrt(60)
    assert (found.low, found.high) == pytest.approx(
        (own.mean() - half, own.mean() + half), abs=0.01
    )


def test_it_is_the_same_of_right_and_wrong():
    right = mean_share([0.9, 0.75, 1.0], [40, 40, 40])
    wrong = mean_share([0.1, 0.25, 0.0], [40, 40, 40])
    assert (right.low, right.high) == pytest.approx((1 - wrong.high, 1 - wrong.low), abs=1e-4)


@examples(15)
@given(st.lists(st.tuples(st.integers(0, 9), st.integers(9, 12)), min_size=3, max_size=6))
def test_it_stays_in_its_range_and_has_a_width(answers):
    found = mean_share([right / of for right, of in answers], [of for _, of in answers])
    assert 0 <= found.low < found.high <= 1


def test_all_right_leave_an_interval():
    found = mean_share([1.0, 1.0, 1.0], [40, 40, 40])
    assert 0.5 < found.low < 0.9
    assert found.high > 0.999


def test_more_people_say_more():
    few, many = (mean_share([0.8, 0.9, 1.0] * n, [40] * 3 * n) for n in (1, 4))
    assert many.high - many.low < few.high - few.low


@pytest.mark.no_cover
@pytest.mark.parametrize(
    ("people", "share", "sd"), [(3, 0.5, 0.5), (3, 0.95, 1.5), (6, 0.8, 1.0), (10, 0.95, 1.5)]
)
def test_it_holds_the_truth_as_often_as_it_says(people, share, sd):
    # A percentile bootstrap: 70 to 90 %. The whole table is made by the benchmark of coverage.
    assert 91.5 <= shares(people, 40, share, sd, "mean", 1000).coverage <= 99


@pytest.mark.parametrize("people", [0, 1, 2])
def test_few_people_have_no_interval(people):
    with pytest.raises(Unanswerable, match="how people differ is seen of three or more"):
        mean_share([0.5] * people, [10] * people)


@pytest.mark.parametrize(
    ("own", "trials", "reason"),
    [
        ([0.5, 1.1, 0.2], [9, 9, 9], "in 0…1"),
        ([0.5, np.nan, 0.2], [9, 9, 9], "in 0…1"),
        ([0.5, 1.0, 0.2], [9, 0, 9], "1 or more"),
        ([0.5, 1.0], [9, 9, 9], "numbers of trials"),
    ],
)
def test_what_are_no_shares(own, trials, reason):
    with pytest.raises(ValueError, match=reason):
        mean_share(own, trials)
