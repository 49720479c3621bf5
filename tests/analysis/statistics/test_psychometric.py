"""Psychometric functions: against a search of their likelihood, and against what made them."""

import math

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.stats import norm

from tests.tiers import by_tier
from vbraille.analysis.statistics.psychometric import fit_psychometric
from vbraille.analysis.statistics.unanswerable import Unanswerable

LEVELS = np.linspace(0.25, 1.75, 7)
COUNTS = {0.5: [10, 13, 12, 17, 19, 19, 20], None: [1, 0, 4, 9, 17, 18, 20]}
STUDIES = by_tier(8, 200, 1000)


def written_out(shape, x, m, s):
    """The curves as textbooks have them."""
    if shape == "logistic":
        return 1 / (1 + math.exp(-(x - m) / s))
    if shape == "normal":
        return 0.5 * math.erfc((m - x) / (s * math.sqrt(2)))
    return 1 - 2 ** -((x / m) ** (1 / s))


@pytest.mark.parametrize("guess", [0.5, None], ids=["which of two", "yes and no"])
@pytest.mark.parametrize("shape", ["logistic", "normal", "weibull"])
def test_the_estimate_is_the_most_likely(shape, guess):
    counts = COUNTS[guess]

    def lost(at):
        m, log_s, lapse = at[:3]
        floor = at[3] if guess is None else guess
        if not (0 <= lapse <= 0.1 and 0 <= floor <= 0.5 and m > 0):
            return np.inf
        shares = [
            floor + (1 - floor - lapse) * written_out(shape, x, m, math.exp(log_s)) for x in LEVELS
        ]
        prior = 19 * math.log1p(-lapse) + (19 * math.log1p(-floor) if guess is None else 0)
        right = sum(
            of * math.log(max(share, 1e-9)) + (20 - of) * math.log(max(1 - share, 1e-9))
            for of, share in zip(counts, shares, strict=True)
        )
        return -right - prior

    found = fit_psychometric(LEVELS, counts, [20] * 7, shape=shape, guess=guess)
    ours = [found.threshold, math.log(found.spread), found.lapse, found.guess]
    start = [0.9, -1.3, 0.02] + ([0.02] if guess is None else [])
    exactly = {"xatol": 1e-9, "fatol": 1e-12, "maxiter": 8000, "maxfev": 8000}
    best = minimize(lost, start, method="Nelder-Mead", options=exactly)
    for _ in range(3):  # a simplex that is caught at a bound goes on when it is made anew
        best = minimize(lost, best.x + 1e-3, method="Nelder-Mead", options=exactly)
    assert lost(ours[: len(start)]) <= best.fun + 1e-7
    assert found.threshold == pytest.approx(best.x[0], abs=2e-4)
    assert math.log(found.spread) == pytest.approx(best.x[1], abs=2e-3)
    assert found.threshold_interval.low < found.threshold < found.threshold_interval.high
    assert found.spread_interval.low < found.spread < found.spread_interval.high
    step = 1e-4
    rise = written_out(shape, found.threshold + step, found.threshold, found.spread)
    rise -= written_out(shape, found.threshold - step, found.threshold, found.spread)
    whole = 1 - found.guess - found.lapse
    assert found.slope == pytest.approx(whole * rise / (2 * step), rel=1e-5)


def test_answers_that_fit_are_told_from_others():
    fits = fit_psychometric(LEVELS, COUNTS[0.5], [20] * 7)
    assert fits.df == 5
    assert fits.p > 0.2
    odd = fit_psychometric(LEVELS, [10, 19, 6, 19, 8, 20, 20], [20] * 7)
    assert odd.p < 0.01


def test_a_level_that_stands_there_twice_is_one():
    levels = [*LEVELS, 1.0, 2.0]
    counts, trials = [*COUNTS[0.5], 8, 0], [20] * 7 + [10, 0]
    counts[3], trials[3] = 9, 10
    twice = fit_psychometric(levels, counts, trials)
    assert twice == fit_psychometric(LEVELS, COUNTS[0.5], [20] * 7)


def test_all_below_a_level_and_all_above_have_an_interval():
    found = fit_psychometric(LEVELS, [0, 0, 0, 20, 20, 20, 20], [20] * 7, guess=0.0)
    assert 0.7 < found.threshold_interval.low < found.threshold_interval.high < 1.05


def test_a_threshold_that_was_not_reached_is_said():
    found = fit_psychometric(LEVELS, [10, 9, 10, 11, 10, 12, 13], [20] * 7)
    assert "beyond the levels" in found.note or found.threshold_interval.high > 1.75


@pytest.mark.parametrize("guess", [0.5, 0.0])
def test_intervals_hold_the_truth(guess):
    random = np.random.default_rng(7)
    shares = guess + (1 - guess - 0.02) * norm.cdf(LEVELS, 1.0, 0.3)
    held = 0
    for _ in range(STUDIES):
        found = fit_psychometric(
            LEVELS, random.binomial(20, shares), [20] * 7, shape="normal", guess=guess
        )
        held += found.threshold_interval.low <= 1.0 <= found.threshold_interval.high
    assert held / STUDIES > 0.95 - 3 * math.sqrt(0.05 / STUDIES)


@pytest.mark.parametrize(
    ("change", "error", "reason"),
    [
        ({"positive": [20] * 7}, Unanswerable, "all answers are the same"),
        ({"positive": [20, 18, 15, 12, 9, 4, 1]}, Unanswerable, "does not rise"),
        ({"levels": [1.0] * 7}, Unanswerable, "1 levels; a curve needs 3"),
        ({"shape": "gumbel"}, ValueError, "no shape 'gumbel'; there are logistic, normal"),
        ({"guess": 1.5}, ValueError, "guess 1.5"),
        ({"positive": [30] * 7}, ValueError, "no more than the trials"),
        ({"levels": LEVELS - 1, "shape": "weibull"}, ValueError, "above 0"),
    ],
    ids=["all", "falling", "one level", "shape", "guess", "counts", "weibull"],
)
def test_what_is_no_curve(change, error, reason):
    given = {"levels": LEVELS, "positive": COUNTS[0.5], "trials": [20] * 7}
    with pytest.raises(error, match=reason):
        fit_psychometric(**{**given, **change})
