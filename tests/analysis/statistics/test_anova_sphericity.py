"""Mauchly's test as R's; Huynh and Feldt's epsilon as pingouin's."""

import numpy as np
import pytest
from scipy.stats import chi2

from tests.analysis.statistics.test_anova import frame, long_form, random_cube
from vbraille.analysis.statistics.anova import anova, huynh_feldt, mauchly_p


def rs_mauchly_test(scores):
    """P as ``stats:::mauchly.test.SSD`` of R reckons it, X = ~1: matrices, not eigenvalues."""
    n, k = scores.shape
    deviations = scores - scores.mean(axis=0)
    among = np.linalg.qr(np.column_stack([np.ones(k), np.eye(k)[:, 1:]]))[0][:, 1:].T
    u = np.linalg.solve(among @ among.T, among @ deviations.T @ deviations @ among.T)
    d, df = k - 1, n - 1
    w = np.linalg.det(u) / (np.trace(u) / d) ** d
    rho = 1 - (2 * d**2 + d + 2) / (6 * d * df)
    omega = (d + 2) * (d - 1) * (d - 2) * (2 * d**3 + 6 * d**2 + 3 * k + 2)
    omega /= 288 * (df * d * rho) ** 2
    z, f = -df * rho * np.log(w), d * (d + 1) / 2 - 1
    first, second = chi2.sf(z, f), chi2.sf(z, f + 4)
    return w, first + omega * (second - first)


def test_four_participants_and_four_levels():
    """Printed was .0457, which is the first term alone; R's mauchly.test has .0790."""
    p = mauchly_p(np.log(0.00141), 4, 3, 4)
    assert p == pytest.approx(0.0790, abs=2e-4)  # W is rounded


@pytest.mark.parametrize(
    # By the formula of Anderson 2003, 10.7.4, itself; R's 3 k for 3 d adds less than 0.0009.
    ("n", "d", "w", "p"),
    [
        (4, 3, 0.00141, 0.0781),
        (6, 2, 0.3, 0.0900),
        (6, 3, 0.1, 0.1391),
        (7, 5, 0.005, 0.1308),
        (10, 5, 0.05, 0.1114),
        (20, 8, 0.05, 0.0765),
    ],
)
def test_the_expansion(n, d, w, p):
    assert mauchly_p(np.log(w), n, d, d) == pytest.approx(p, abs=6e-5)
    assert mauchly_p(np.log(w), n, d, d + 1) == pytest.approx(p, abs=9e-4)


@pytest.mark.parametrize("shape", [(4, 4), (5, 5), (6, 4), (7, 6), (12, 5), (30, 8)])
def test_an_analysis_has_rs_p(rng, shape):
    cube = random_cube(rng, *shape)
    (ours,) = anova(*long_form(cube)).effects
    w, p = rs_mauchly_test(cube)
    assert ours.mauchly_w == pytest.approx(w)
    assert ours.mauchly_p == pytest.approx(p)


@pytest.mark.parametrize(("n", "w"), [(3, 0.2), (6, 0.3), (40, 0.8)])
def test_two_contrasts_are_exact(n, w):
    exact = w ** ((n - 2) / 2)  # Mauchly 1940: the determinant of two has this distribution
    assert mauchly_p(np.log(w), n, 2, 3) == pytest.approx(exact)


@pytest.mark.parametrize("shape", [(3, 3), (6, 3), (12, 4), (5, 7)])
def test_huynh_and_feldts_epsilon_is_pingouins(rng, pingouin, shape):
    table = long_form(random_cube(rng, *shape))
    (ours,) = anova(*table).effects
    theirs = pingouin.epsilon(frame(*table), dv="score", within="A", subject="who", correction="hf")
    assert ours.huynh_feldt == pytest.approx(max(theirs, ours.epsilon))
    assert ours.p <= ours.p_huynh_feldt <= ours.p_corrected or ours.p > 0.5


def test_huynh_and_feldts_epsilon_has_ends():
    assert huynh_feldt(1.0, 4, 3) == 1  # its denominator is 0
    assert huynh_feldt(1.0, 10, 3) == 1
    assert huynh_feldt(1 / 3, 2, 3) == 1 / 3  # two participants tell nothing
    assert huynh_feldt(1 / 3, 10, 3) == pytest.approx(1 / 3)
