"""Intervals of effect sizes: published ones, the test they belong to, and the distribution."""

import pytest
from scipy.stats import f

from vbraille.analysis.statistics.effectsizes import (
    hedges_correction,
    partial_eta2_interval,
)
from vbraille.analysis.statistics.intervals import Unanswerable


def test_partial_eta2_is_that_of_noncentral_f(rng):
    """Of the published F(2, 10) = 10.849: ends at which F is as rare as 2.5 %."""
    found = partial_eta2_interval(10.849, 2, 10)
    for share, end in ((0.975, found.low), (0.025, found.high)):
        noncentrality = end * 13 / (1 - end)
        samples = rng.noncentral_chisquare(2, noncentrality, 200_000) / 2
        samples /= rng.chisquare(10, 200_000) / 10
        assert (samples <= 10.849).mean() == pytest.approx(share, abs=2e-3)


def test_partial_eta2s_interval_begins_at_0_where_p_is_large():
    assert partial_eta2_interval(f.isf(0.026, 2, 10), 2, 10).low == 0
    assert partial_eta2_interval(f.isf(0.024, 2, 10), 2, 10).low > 0


@pytest.mark.parametrize("people", [2, 3, 6, 20])
@pytest.mark.parametrize("df1", [1, 2, 4])
def test_partial_eta2s_interval_has_its_estimate_in_it(df1, people):
    """However small F is, where the noncentral distribution leaves nothing above 0."""
    df2 = df1 * (people - 1)
    for ratio in (0.0, 0.001, 0.01, 0.05, 0.2, 1.0, 4.0, 100.0):
        found = partial_eta2_interval(ratio, df1, df2)
        assert 0 <= found.low <= df1 * ratio / (df1 * ratio + df2) <= found.high < 1


@pytest.mark.parametrize(
    # Hedges 1981, table 1.
    ("df", "factor"),
    [(2, 0.5642), (3, 0.7236), (4, 0.7979), (10, 0.9228), (50, 0.9849)],
)
def test_hedges_correction_is_the_published_one(df, factor):
    assert hedges_correction(df) == pytest.approx(factor, abs=6e-5)


def test_what_has_no_correction_and_no_interval():
    with pytest.raises(ValueError, match="needs two"):
        hedges_correction(1)
    with pytest.raises(Unanswerable, match="F is beyond"):
        partial_eta2_interval(2e4, 1, 5)
