"""Tests of several contrasts together: against t, against Hotelling's T², and under the null."""

import numpy as np
import pytest
from scipy.special import expit
from scipy.stats import f as fisher

from tests.tiers import by_tier
from vbraille.analysis.statistics.intervals import Unanswerable
from vbraille.analysis.statistics.trialsmodel import (
    compare,
    compare_all,
    fit_trials,
    separate_cells,
)

STUDIES = by_tier(300, 4000, 10_000)
THREE = [[-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]]


def studies(people, cells, *, sd=0.5, trials=40, many=1, seed=1):
    """Counts of people who read all cells alike."""
    random = np.random.default_rng(seed)
    own = expit(random.normal(0.0, sd, (many, people, 1)))
    asked = np.full((many, people, cells), trials)
    return random.binomial(asked, np.broadcast_to(own, asked.shape)), asked


def fitted(correct, asked):
    """Model in which each cell has log odds of its own."""
    return fit_trials(correct, asked, separate_cells(*asked.shape[1:]))


def test_of_one_contrast_it_is_the_square_of_t():
    fit = fitted(*studies(6, 2, many=20))
    t, found = compare(fit, [1, -1]), compare_all(fit, [[1, -1]])
    np.testing.assert_allclose(found.f, (t.estimates / t.errors) ** 2, rtol=1e-9)
    np.testing.assert_allclose(found.df2, t.degrees, rtol=1e-9)
    np.testing.assert_allclose(found.p, t.p_values(), rtol=1e-9)


def test_which_contrasts_span_the_same_is_of_no_matter():
    fit = fitted(*studies(7, 3, many=5))
    one = compare_all(fit, THREE)
    for other in ([[1, -1, 0], [0.5, 0.5, -1]], [[10, -10, 0], [0, 1, -1]]):
        found = compare_all(fit, other)
        np.testing.assert_allclose(found.f, one.f, rtol=1e-8)
        np.testing.assert_allclose(found.df2, one.df2, rtol=1e-8)


def test_near_a_half_it_is_hotellings_t_squared():
    """Of many trials, half of them right: own shares are as good as normal scores."""
    random = np.random.default_rng(2)
    shares = 0.5 + random.normal(0, 0.01, (9, 3)) + random.normal(0, 0.01, (9, 1))
    shares -= shares.mean() - 0.5
    asked = np.full((1, 9, 3), 100_000)
    correct = np.rint(shares * 100_000).astype(int)
    found = compare_all(fitted(correct[None], asked), THREE)
    apart = correct[:, 1:] / 1e5 - correct[:, :1] / 1e5
    mean, spread = apart.mean(axis=0), np.cov(apart.T)
    t_squared = 9 * mean @ np.linalg.solve(spread, mean)
    assert found.df2[0] == pytest.approx(7, rel=1e-3)  # n - q
    assert found.f[0] == pytest.approx(7 / (8 * 2) * t_squared, rel=1e-2)
    assert found.p[0] == pytest.approx(fisher.sf(7 / 16 * t_squared, 2, 7), rel=3e-2)


@pytest.mark.parametrize("people", [5, 12])
def test_false_positives(people):
    p = compare_all(fitted(*studies(people, 3, many=STUDIES, trials=26)), THREE).p
    assert np.isfinite(p).mean() > 0.99
    assert 0.02 < np.mean(p < 0.05) < 0.06 + 2 * np.sqrt(0.05 / STUDIES)


def test_what_differs_is_found():
    random = np.random.default_rng(3)
    asked = np.full((1, 8, 3), 30)
    correct = random.binomial(asked, [0.5, 0.7, 0.9])
    assert compare_all(fitted(correct, asked), THREE).p[0] < 0.01


def test_too_few_participants_are_refused():
    correct, asked = studies(2, 3)
    with pytest.raises(Unanswerable, match="2 participants; it takes 3 or more"):
        compare_all(fitted(correct, asked), THREE)


def test_participants_who_do_not_differ_leave_no_p():
    asked = np.full((1, 5, 3), 20)
    found = compare_all(fitted(np.full_like(asked, 20), asked), THREE)
    assert np.isnan(found.p[0])
    assert np.isnan(found.f[0])
