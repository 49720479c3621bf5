"""d′ and criterion: against what is published, and against what made the answers."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.special import ndtr, ndtri
from scipy.stats import norm

from tests.tiers import by_tier, examples
from vbraille.analysis.statistics.detection import same_different, two_alternatives, yes_no
from vbraille.analysis.statistics.intervals import Unanswerable

MANY = 10_000_000
STUDIES = by_tier(400, 4000, 10_000)


def test_yes_and_no_by_hand():
    found = yes_no(17, 20, 4, 20)
    hits, falses = 17.5 / 21, 4.5 / 21
    assert found.d_prime == pytest.approx(ndtri(hits) - ndtri(falses))
    assert found.criterion == pytest.approx(-(ndtri(hits) + ndtri(falses)) / 2)
    variance = sum(p * (1 - p) / 20 / norm.pdf(ndtri(p)) ** 2 for p in (hits, falses))
    half = 1.959964 * math.sqrt(variance)
    assert found.d_interval.high - found.d_prime == pytest.approx(half, rel=1e-6)
    assert found.criterion_interval.high - found.criterion == pytest.approx(half / 2, rel=1e-6)


def test_all_right_is_finite():
    found = yes_no(20, 20, 0, 20)
    assert found.d_prime == pytest.approx(2 * ndtri(20.5 / 21))
    assert math.isfinite(found.d_interval.high)


def test_two_alternatives_of_a_reader_without_bias():
    share = float(
        ndtr(1.5 / math.sqrt(2))
    )  # right answers at d′ = 1.5: Macmillan and Creelman, 7.2
    right = round(share * MANY)
    found = two_alternatives(right, MANY, MANY - right, MANY)
    assert found.d_prime == pytest.approx(1.5, abs=1e-5)
    assert found.criterion == pytest.approx(0, abs=1e-6)


@pytest.mark.parametrize(("d", "k"), [(1.0, 1.0), (2.0, 1.5), (3.0, 2.5)])
def test_same_and_different_by_differencing(d, k):
    """The difference of two looks has a variance of 2: integrated here, not by the formula."""

    def beyond(centre):
        inside = quad(lambda x: math.exp(-((x - centre) ** 2) / 4) / math.sqrt(4 * math.pi), -k, k)
        return round((1 - inside[0]) * MANY)

    found = same_different(beyond(d), MANY, beyond(0.0), MANY)
    assert found.d_prime == pytest.approx(d, abs=1e-4)


@examples(60)
@given(st.integers(0, 30), st.integers(0, 30))
def test_intervals_hold_their_estimate_and_more_hits_are_more(hits, falses):
    for found in (
        yes_no(hits, 30, falses, 30),
        two_alternatives(hits, 30, falses, 30),
        same_different(hits, 30, falses, 30),
    ):
        assert found.d_interval.low <= found.d_prime <= found.d_interval.high
        assert (found.d_prime > 1e-9) == (hits > falses)


@pytest.mark.parametrize("trials", [20, 78])
@pytest.mark.parametrize("d", [0.0, 2.0])
def test_intervals_hold_the_truth(d, trials):
    random = np.random.default_rng([trials, round(d)])
    shares = ndtr([d / 2 - 0.3, -d / 2 - 0.3])
    held = 0
    for hits, falses in random.binomial(trials, shares, (STUDIES, 2)).tolist():
        ends = yes_no(hits, trials, falses, trials).d_interval
        held += ends.low <= d <= ends.high
    assert 0.92 < held / STUDIES < 0.99


def test_no_trials_have_no_answer():
    with pytest.raises(Unanswerable, match="no trials with nothing"):
        yes_no(3, 4, 0, 0)
    with pytest.raises(ValueError, match="5 answers of 4 trials"):
        yes_no(5, 4, 0, 4)
