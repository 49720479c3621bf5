"""Intervals of effect sizes: published ones, the test they belong to, and the distribution."""

import numpy as np
import pytest
from scipy.stats import f, nct, t

from vbraille.analysis.statistics.effectsizes import (
    d_z_interval,
    noncentral_t_cdf,
    partial_eta2_interval,
)
from vbraille.analysis.statistics.intervals import Unanswerable
from vbraille.analysis.statistics.paired import paired_t


def test_the_noncentral_distribution_is_scipys_where_that_has_one(rng):
    for _ in range(200):
        value, df, delta = rng.uniform(0, 8), int(rng.integers(1, 40)), rng.uniform(-3, 12)
        theirs = nct.cdf(value, df, delta)
        if np.isfinite(theirs):
            assert noncentral_t_cdf(value, df, delta) == pytest.approx(theirs, abs=1e-11)


def test_the_noncentral_distribution_is_that_of_samples(rng):
    samples = (rng.normal(size=200_000) - 4) / np.sqrt(rng.chisquare(1, 200_000))
    assert noncentral_t_cdf(2.0, 1, -4.0) == pytest.approx((samples <= 2).mean(), abs=1e-3)


@pytest.mark.parametrize("n", [2, 6, 30])
def test_ds_interval_leaves_out_0_exactly_if_p_is_below_its_complement(n):
    edge = t.isf(0.025, n - 1)
    assert d_z_interval(edge * 1.001, n).low > 0
    assert d_z_interval(edge * 0.999, n).low < 0
    turned = d_z_interval(-edge * 1.001, n)
    assert turned.high < 0
    assert turned.low == -d_z_interval(edge * 1.001, n).high


def test_ds_interval_covers_what_it_says(rng):
    """Of 2,000 studies of six participants with d = 0.8."""
    d = rng.normal(0.8, 1, (2000, 6))
    ts = d.mean(axis=1) / d.std(axis=1, ddof=1) * np.sqrt(6)
    # Of the noncentral distribution's own ends, as an interval for each would take its time.
    low, high = (nct.ppf(p, 5, 0.8 * np.sqrt(6)) for p in (0.025, 0.975))
    assert d_z_interval(low, 6).high == pytest.approx(0.8, abs=1e-6)
    assert d_z_interval(high, 6).low == pytest.approx(0.8, abs=1e-6)
    assert ((low < ts) & (ts < high)).mean() == pytest.approx(0.95, abs=0.015)


def test_the_published_t_has_an_interval():
    """t(5) = 3.246 of Lévesque 2009, ch. 4: d_z is 1.325."""
    found = d_z_interval(3.246, 6)
    assert (found.low, found.high) == pytest.approx((0.166, 2.425), abs=5e-4)


def test_a_paired_test_has_its_ends(rng):
    first, second = rng.normal(1, 1, 8), rng.normal(0, 1, 8)
    found = paired_t(first, second)
    ends = d_z_interval(found.t, 8)
    assert (found.d_low, found.d_high) == (ends.low, ends.high)
    assert found.d_low < found.d_z < found.d_high


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


def test_what_is_beyond_all_effects_has_no_interval():
    with pytest.raises(Unanswerable, match="t is beyond 10000"):
        d_z_interval(-2e4, 5)
    with pytest.raises(Unanswerable, match="F is beyond 10000"):
        partial_eta2_interval(2e4, 2, 10)
    assert paired_t([1.0, 2.0, 3.0], [-1e8, -1e8, -1e8 + 2.5]).d_low is None
