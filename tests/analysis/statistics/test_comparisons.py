"""Cells of a design compared: each number is that of a simpler test where there is one."""

import math

import numpy as np
import pytest
from scipy import stats

from tests.tiers import by_tier
from vbraille.analysis.statistics.anova import anova
from vbraille.analysis.statistics.comparisons import (
    CellDesign,
    CellScores,
    CellShares,
    effects,
    hedges_correction,
)
from vbraille.analysis.statistics.intervals import Interval, adjust

ANY = Interval(-math.inf, math.inf)
TWO_BY_THREE = np.array([[a, b] for a in range(2) for b in range(3)])


def within(scores, levels, scale=ANY):
    """Scores of one group."""
    people, cells = (np.zeros(many, np.int64) for many in scores.shape)
    return CellScores(scores, CellDesign(np.array(levels)), people, cells, scale)


def in_groups(scores, levels, group):
    """Scores of groups, which are the levels of the last factor."""
    levels = np.array(levels)
    own = np.where(levels[:, -1] == np.array(group)[:, None], scores, np.nan)
    return CellScores(own, CellDesign(levels), np.array(group), levels[:, -1])


@pytest.fixture
def random():
    return np.random.default_rng(5)


@pytest.mark.parametrize("n", [3, 6, 20])
def test_two_levels_within_people_are_pingouins_paired_t(random, pingouin, n):
    scores = random.normal([50, 56], 10, (n, 2))
    told = within(scores, [[0], [1]]).contrast(np.array([1.0, -1.0]))
    theirs = pingouin.ttest(scores[:, 0], scores[:, 1], paired=True).iloc[0]
    assert (told.t, told.df, told.p) == pytest.approx((theirs["T"], theirs["dof"], theirs["p_val"]))
    assert (told.low, told.high) == pytest.approx(tuple(theirs["CI95"]), abs=0.006)


@pytest.mark.parametrize(("t", "p"), [(-3.246, 0.023), (-4.456, 0.007), (-1.745, 0.141)])
def test_six_readers_with_the_published_t_have_the_published_p(random, t, p):
    """Lévesque 2009, 4.3."""
    second, spread = random.normal(60, 10, 6), random.normal(size=6)
    spread -= spread.mean()
    # Differences of sd √6 and mean t have exactly this t.
    first = second + t + spread * np.sqrt(6) / spread.std(ddof=1)
    told = within(np.column_stack([first, second]), [[0], [1]]).contrast(np.array([1.0, -1.0]))
    assert told.t == pytest.approx(t)
    assert round(told.p, 3) == p


def test_the_corrected_effect_is_unbiased(random):
    d = random.normal(0.8, 1, (4000, 6))
    weights = np.array([1.0, -1.0])
    each = [within(np.column_stack([own, 0 * own]), [[0], [1]]).contrast(weights) for own in d]
    assert np.mean([one.size for one in each]) == pytest.approx(0.8, abs=0.03)


def test_two_levels_within_people_are_the_paired_t(random):
    scores = random.normal([3, 4], 1, (8, 2))
    (effect,) = effects(within(scores, [[0], [1]]), "holm")
    ((pair, told, p),) = effect.pairs
    test = stats.ttest_rel(scores[:, 0], scores[:, 1])
    ends, apart = test.confidence_interval(), scores[:, 0] - scores[:, 1]
    assert (pair.first, pair.second) == (0, 1)
    assert (told.value, told.low, told.high) == pytest.approx((apart.mean(), ends.low, ends.high))
    assert (told.t, told.df, told.p) == pytest.approx((test.statistic, test.df, test.pvalue))
    assert told.size == pytest.approx(apart.mean() / apart.std(ddof=1) * hedges_correction(7))
    assert (effect.test.f, effect.p, p) == pytest.approx(
        (test.statistic**2, test.pvalue, test.pvalue)
    )


def test_two_groups_are_welchs_t(random):
    scores = random.normal(size=(9, 2)) * np.array([1, 3])
    group = [0] * 4 + [1] * 5
    (effect,) = effects(in_groups(scores, [[0], [1]], group), "holm")
    ((_, told, _),) = effect.pairs
    one, two = scores[:4, 0], scores[4:, 1]
    test = stats.ttest_ind(one, two, equal_var=False)
    ends = test.confidence_interval()
    assert (told.t, told.df, told.p) == pytest.approx((test.statistic, test.df, test.pvalue))
    assert (told.low, told.high) == pytest.approx((ends.low, ends.high))


def test_several_levels_are_the_analysis_of_variance(random):
    scores = random.normal(size=(7, 6)) + TWO_BY_THREE[:, 1]
    data = within(scores, TWO_BY_THREE)
    who, cell = np.indices(scores.shape).reshape(2, -1)
    factors = {name: [str(n) for n in TWO_BY_THREE[cell, at]] for at, name in enumerate("ab")}
    wanted = {
        effect.name: effect
        for effect in anova([str(n) for n in who], factors, scores.ravel()).effects
    }
    found = {effect.factors: effect.test for effect in effects(data, "none")}
    for own, name in (((0,), "a"), ((1,), "b"), ((0, 1), "a × b")):
        assert found[own].f == pytest.approx(wanted[name].f)
        assert found[own].p == pytest.approx(wanted[name].p_corrected)


def test_an_interaction_with_groups_is_welchs_t_of_their_differences(random):
    levels = [[a, g] for a in range(2) for g in range(2)]
    group = [0] * 5 + [1] * 6
    data = in_groups(random.normal(size=(11, 4)), levels, group)
    found = {effect.factors: effect for effect in effects(data, "none")}
    own = [data.scores[data.group == g][:, [g, 2 + g]] @ np.array([1, -1]) for g in range(2)]
    test = stats.ttest_ind(*own, equal_var=False)
    assert found[0, 1].test.f == pytest.approx(test.statistic**2)
    assert found[0, 1].test.p == pytest.approx(test.pvalue)
    at_first = found[0, 1].pairs[0]
    alone = stats.ttest_rel(data.scores[:5, 0], data.scores[:5, 2])
    apart = (data.scores[:5, 0] - data.scores[:5, 2]).mean()
    assert at_first[0].at == (1, 0)
    assert (at_first[1].value, at_first[1].p) == pytest.approx((apart, alone.pvalue))


def test_shares_have_the_same_effects_by_single_trials(random):
    asked = np.full((10, 6), 20)
    correct = random.binomial(20, 0.5 + 0.15 * (TWO_BY_THREE[:, 1] - 1), (10, 6))
    data = CellShares(correct, asked, CellDesign(TWO_BY_THREE))
    found = {effect.factors: effect for effect in effects(data, "holm")}
    assert found[1,].p < 0.01 < found[0,].p
    for pair, told, p in found[1,].pairs:
        raw = (correct[:, pair.weights != 0] @ np.sign(pair.weights[pair.weights != 0])).mean() / 40
        assert told.value == pytest.approx(raw, abs=0.005)
        assert -1 < told.low < told.value < told.high < 1
        assert p >= found[1,].p


def test_a_family_is_corrected_together_and_a_pair_counts_as_far_as_its_effect(random):
    data = within(random.normal(size=(9, 6)) + 0.6 * TWO_BY_THREE[:, 1], TWO_BY_THREE)
    raw, corrected = effects(data, "none"), effects(data, "holm")
    wanted = adjust([effect.test.p for effect in raw], "holm")
    assert [effect.p for effect in corrected] == pytest.approx(wanted.tolist())
    for effect in corrected:
        own = adjust([told.p for _, told, _ in effect.pairs], "holm")
        if len(own) > 1:
            assert [p for *_, p in effect.pairs] == pytest.approx(
                np.maximum(own, effect.p).tolist()
            )


def test_no_interval_leaves_its_scale():
    scores = np.array([[1.0, 7], [1, 6.5], [1.2, 7], [1, 3]])
    data = within(scores, [[0], [1]], Interval(1, 7))
    for cell in range(2):
        mean = data.mean(cell)
        assert 1 <= mean.low <= mean.value <= mean.high <= 7
    told = data.contrast(np.array([1.0, -1]))
    assert -6 <= told.low < told.value < told.high <= 6


@pytest.mark.parametrize("people", [1, 2])
def test_one_or_two_people_have_numbers_and_no_test(people, random):
    scores = random.normal(size=(people, 2))
    for data in (
        within(scores, [[0], [1]]),
        CellShares(
            np.full((people, 2), 3), np.full((people, 2), 9), CellDesign(np.array([[0], [1]]))
        ),
    ):
        assert data.mean(0).value is not None
        assert data.mean(0).low is None
        (effect,) = effects(data, "holm")
        assert (effect.test.p, effect.p) == (None, None)
        ((_, told, p),) = effect.pairs
        assert told.value is not None
        assert (told.low, told.p, p) == (None, None, None)
        assert "participant" in told.note


def test_people_alike_are_not_tested():
    (effect,) = effects(within(np.tile([1.0, 2.0], (5, 1)), [[0], [1]]), "holm")
    assert effect.p is None
    assert "do not differ" in effect.pairs[0][1].note


def test_three_groups_alone_have_the_smallest_p_of_their_pairs(random):
    group = np.repeat([0, 1, 2], 4)
    data = in_groups(random.normal(size=(12, 3)) + np.arange(3), [[0], [1], [2]], group)
    (effect,) = effects(data, "none")
    least = min(told.p for _, told, _ in effect.pairs)
    assert effect.test.p == pytest.approx(min(1, 3 * least))


@pytest.mark.no_cover
def test_wrong_findings_are_as_rare_as_said(random):
    """Any of the first layer's tests of a 2 × 3 design in which there is nothing."""
    wrong = 0
    studies = by_tier(60, 200, 2000)
    for _ in range(studies):
        own = random.normal(0, 1, (8, 1))
        found = effects(within(own + random.normal(size=(8, 6)), TWO_BY_THREE), "holm")
        every = [effect.p for effect in found] + [p for e in found for *_, p in e.pairs]
        wrong += min(every) < 0.05
    # A twentieth of the studies is expected; chance exceeds this bound once in some hundred runs.
    assert wrong <= studies / 20 + 3 * math.sqrt(studies * 0.05 * 0.95)


@pytest.mark.parametrize(
    # Hedges 1981, table 1.
    ("df", "factor"),
    [(2, 0.5642), (3, 0.7236), (4, 0.7979), (10, 0.9228), (50, 0.9849)],
)
def test_hedges_correction_is_the_published_one(df, factor):
    assert hedges_correction(df) == pytest.approx(factor, abs=6e-5)


def test_one_degree_of_freedom_has_no_correction():
    with pytest.raises(ValueError, match="needs two"):
        hedges_correction(1)
