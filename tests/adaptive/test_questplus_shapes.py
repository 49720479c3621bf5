"""Probabilities of answers, against scipy and by what must hold of any."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from tests.tiers import examples
from vbraille.adaptive.questplus import SHAPES, detected, nearer, phi

X = np.linspace(-8, 8, 401)
MM = st.floats(0.3, 4.0)


def test_the_cumulative_normal_is_scipys():
    assert np.allclose(phi(X), stats.norm.cdf(X), rtol=1e-13, atol=0)
    assert phi(X.reshape(1, -1, 1)).shape == (1, 401, 1)


def test_shapes_are_scipys():
    assert np.allclose(SHAPES["logistic"](X, 1.0, 0.5), stats.logistic.cdf(X, 1.0, 0.5))
    x = np.linspace(0, 5, 50)
    assert np.allclose(SHAPES["weibull"](x, 2.0, 3.0), stats.weibull_min.cdf(x, 3.0, scale=2.0))


@pytest.mark.parametrize("shape", SHAPES)
def test_answers_go_from_guesses_to_all_but_the_lapses(shape):
    x = np.array([0.0, 1.0, 2.0, 3.0, 60.0])
    p = detected(shape, x, 2.0, 1.5 if shape == "weibull" else 0.1, 0.25, 0.1)
    assert (np.diff(p) > 0).all() or shape != "weibull"
    assert p[[0, -1]] == pytest.approx([0.25, 0.9])


@examples(60)
@given(MM, MM, MM, st.floats(0.02, 2), st.floats(0, 0.5), st.booleans())
def test_which_stands_first_does_not_matter(first, second, liked, spread, lapse, log):
    p = nearer(*map(np.float64, (first, second, liked, spread, lapse)), log=log)
    q = nearer(*map(np.float64, (second, first, liked, spread, lapse)), log=log)
    assert p + q == pytest.approx(1)
    away = np.log([first, second, liked]) if log else np.array([first, second, liked])
    nearer_first = abs(away[0] - away[2]) - abs(away[1] - away[2])
    assert (p - 0.5) * nearer_first <= 1e-12
    assert lapse / 2 - 1e-12 <= p <= 1 - lapse / 2 + 1e-12


def test_the_nearer_one_is_chosen_as_two_noisy_distances_are_compared():
    random = np.random.default_rng(1)
    away = np.abs(np.array([1.4, 2.3]) - 1.75) + 0.2 * random.standard_normal((200_000, 2))
    share = (away[:, 0] < away[:, 1]).mean()
    assert nearer(*map(np.float64, (1.4, 2.3, 1.75, 0.2, 0.0))) == pytest.approx(share, abs=0.004)
