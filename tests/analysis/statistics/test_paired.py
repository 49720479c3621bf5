import numpy as np
import pytest
from scipy.stats import nct
from scipy.stats import t as student

from vbraille.analysis.statistics.intervals import Unanswerable
from vbraille.analysis.statistics.paired import hedges_correction, paired_p_values, paired_t


@pytest.mark.parametrize("n", [2, 3, 6, 20])
def test_it_is_pingouins(rng, pingouin, n):
    first, second = rng.normal(50, 10, n), rng.normal(56, 10, n)
    found = paired_t(first, second)
    theirs = pingouin.ttest(first, second, paired=True).iloc[0]
    assert found.df == theirs["dof"]
    assert found.t == pytest.approx(theirs["T"])
    assert found.p == pytest.approx(theirs["p_val"])
    assert (found.low, found.high) == pytest.approx(tuple(theirs["CI95"]), abs=0.006)
    assert found.mean_difference == pytest.approx(first.mean() - second.mean())
    assert found.d_z == pytest.approx(found.t / np.sqrt(n))


@pytest.mark.parametrize(("t", "p"), [(-3.246, 0.023), (-4.456, 0.007), (-1.745, 0.141)])
def test_six_readers_with_the_published_t_have_the_published_p(rng, t, p):
    second = rng.normal(60, 10, 6)
    spread = rng.normal(size=6)
    spread -= spread.mean()
    # Differences of sd √6 and mean t have exactly this t.
    first = second + t + spread * np.sqrt(6) / spread.std(ddof=1)
    found = paired_t(first, second)
    assert found.t == pytest.approx(t)
    assert round(found.p, 3) == p


def test_the_interval_leaves_out_0_exactly_if_p_is_below_its_complement():
    first = np.array([3.0, 5, 4, 6, 9, 2])
    for shift in np.linspace(-4, 4, 17):
        found = paired_t(first, first[::-1] + shift)
        assert (found.low > 0 or found.high < 0) == (found.p < 0.05)


@pytest.mark.parametrize(
    # Hedges 1981, table 1.
    ("df", "factor"),
    [(2, 0.5642), (3, 0.7236), (4, 0.7979), (10, 0.9228), (50, 0.9849)],
)
def test_hedges_correction_is_the_published_one(df, factor):
    assert hedges_correction(df) == pytest.approx(factor, abs=6e-5)


def test_the_corrected_effect_is_unbiased(rng):
    d = rng.normal(0.8, 1, (20_000, 6))
    raw = d.mean(axis=1) / d.std(axis=1, ddof=1)
    assert raw.mean() > 0.9
    one = paired_t(d[0], np.zeros(6))
    assert one.g_z is not None
    assert (raw * one.g_z / one.d_z).mean() == pytest.approx(0.8, abs=0.01)


def test_two_participants_have_no_corrected_effect():
    assert paired_t([1, 2], [0, 3]).g_z is None
    with pytest.raises(ValueError, match="needs two"):
        hedges_correction(1)


@pytest.mark.parametrize(
    ("first", "second", "reason"),
    [
        ([], [], "no participants; a t-test needs two"),
        ([1], [2], "one participant; a t-test needs two"),
        ([1, 2, 3], [1, 2, 3], "all differences are the same"),
        ([0.3, 0.6, 0.9], [0.1, 0.4, 0.7], "all differences are the same"),  # to rounding
        ([1e-170, 2e-170], [0, 0], "all differences are the same"),  # the variance underflows
    ],
)
def test_what_has_no_t(first, second, reason):
    with pytest.raises(Unanswerable, match=reason):
        paired_t(first, second)


def test_scores_belong_in_pairs():
    with pytest.raises(ValueError, match="3 first scores and 2 second"):
        paired_t([1, 2, 3], [1, 2])


def test_many_studies_are_tested_as_each_alone(rng):
    first, second = rng.normal(50, 10, (5, 7)), rng.normal(56, 10, (5, 7))
    p = paired_p_values(first - second)
    assert p == pytest.approx([paired_t(*pair).p for pair in zip(first, second, strict=True)])
    assert np.isnan(paired_p_values(np.full((1, 4), 0.1))[0])
    with pytest.raises(Unanswerable, match="one participant"):
        paired_p_values(np.ones((3, 1)))


@pytest.mark.parametrize(("n", "d_z"), [(4, 0.0), (4, 1.5), (12, 0.8), (40, 0.5)])
def test_power_by_simulation_is_that_of_the_closed_form(n, d_z):
    """By noncentral t: within 1.5 points, of 20,000 studies."""
    limit = student.ppf(0.975, n - 1)
    centre = d_z * np.sqrt(n)
    power = nct.sf(limit, n - 1, centre) + nct.cdf(-limit, n - 1, centre)
    studies = np.random.default_rng(n).normal(d_z, 1.0, (20_000, n))
    assert np.mean(paired_p_values(studies) < 0.05) == pytest.approx(power, abs=0.015)
