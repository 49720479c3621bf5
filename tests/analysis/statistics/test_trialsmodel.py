"""The logistic model of trials: against statsmodels, and by what it must do."""

import numpy as np
import pytest
import statsmodels.api as sm
from scipy.optimize import minimize
from scipy.special import expit, logit

from tests.tiers import by_tier
from vbraille.analysis.statistics.intervals import Unanswerable
from vbraille.analysis.statistics.trialsmodel import (
    combine,
    compare,
    difference,
    fit_trials,
    separate_cells,
    tells_difference,
)

STUDIES = by_tier(300, 4000, 10_000)


def single_trials(correct, trials, design):
    """A row for each trial: participant, design, and whether it is right."""
    rows = [
        (who, *design[who, cell], right)
        for who, cell in np.ndindex(*trials.shape)
        for right in [1] * correct[who, cell] + [0] * (trials[who, cell] - correct[who, cell])
    ]
    return np.array(rows, np.float64)


@pytest.fixture(scope="module")
def counts():
    """Counts of eight participants in three cells, of which one is missing, with a covariate."""
    random = np.random.default_rng(3)
    trials = random.integers(5, 40, (8, 3))
    trials[2, 1] = 0
    design = np.concatenate([separate_cells(8, 3), random.normal(size=(8, 3, 1))], axis=2)
    return random.binomial(trials, 0.7), trials, design


def test_as_statsmodels_has_it(counts):
    fit = fit_trials(*counts, penalised=False)
    rows = single_trials(*counts)
    model = sm.GEE(
        rows[:, -1],
        rows[:, 1:-1],
        groups=rows[:, 0],
        family=sm.families.Binomial(),
        cov_struct=sm.cov_struct.Independence(),
    ).fit(ctol=1e-12)
    np.testing.assert_allclose(fit.coefficients[0], model.params, rtol=0, atol=1e-9)
    # Liang and Zeger's sandwich (1986), without a correction for few participants.
    plain = fit.spread[0] @ (fit.scores[0].T @ fit.scores[0]) @ fit.spread[0]
    np.testing.assert_allclose(plain, model.cov_params(), rtol=0, atol=1e-9)


def test_the_correction_for_few_participants_is_kauermann_and_carrolls(counts):
    """Worked out trial by trial, with matrices as large as a participant's trials."""
    fit = fit_trials(*counts, penalised=False)
    rows = single_trials(*counts)
    x, who = rows[:, 1:-1], rows[:, 0]
    share = expit(x @ fit.coefficients[0])
    root = np.sqrt(share * (1 - share))
    scaled = x * root[:, None]
    spread = np.linalg.inv(scaled.T @ scaled)
    meat = np.zeros((4, 4))
    for one in np.unique(who):
        mine = who == one
        hat = scaled[mine] @ spread @ scaled[mine].T
        values, vectors = np.linalg.eigh(np.eye(mine.sum()) - hat)
        inverse_root = vectors @ np.diag(values**-0.5) @ vectors.T
        pull = scaled[mine].T @ inverse_root @ ((rows[mine, -1] - share[mine]) / root[mine])
        meat += np.outer(pull, pull)
    weights = np.array([-1.0, 1.0, 0.0, 0.5])
    found = combine(fit, weights)
    assert found.errors[0] ** 2 == pytest.approx(weights @ spread @ meat @ spread @ weights)


def test_the_penalty_is_firths(counts):
    """Against a search for where the likelihood times the root of the information is greatest."""
    correct, trials, design = counts

    def lost(beta):
        share = expit(design @ beta)
        information = np.einsum("kc,kcp,kcq", trials * share * (1 - share), design, design)
        right = correct * np.log(share) + (trials - correct) * np.log1p(-share)
        return -right.sum() - np.linalg.slogdet(information)[1] / 2

    best = minimize(lost, np.zeros(4), method="BFGS", options={"gtol": 1e-9})
    np.testing.assert_allclose(fit_trials(*counts).coefficients[0], best.x, atol=1e-6)


def test_degrees_of_freedom_are_those_of_t_where_participants_are_alike():
    """Half of the answers right, by everyone alike: n - 1 within, n - 2 between two groups."""
    correct = np.array([[10, 11], [9, 10], [11, 9], [10, 12], [10, 8]])
    fit = fit_trials(correct, np.full((5, 2), 20), separate_cells(5, 2))
    assert combine(fit, [-1, 1]).degrees[0] == pytest.approx(4, abs=0.1)
    trials = np.array([[20, 0], [20, 0], [20, 0], [0, 20], [0, 20], [0, 20]])
    correct = np.where(trials > 0, [[10], [9], [11], [10], [12], [8]], 0)
    groups = fit_trials(correct, trials, separate_cells(6, 2))
    assert combine(groups, [-1, 1]).degrees[0] == pytest.approx(4, abs=0.1)


def test_who_alone_tells_anything_leaves_few_degrees_of_freedom():
    correct = np.array([[40, 39], [40, 40], [40, 40], [39, 40], [22, 15]])
    found = combine(fit_trials(correct, np.full((5, 2), 40), separate_cells(5, 2)), [-1, 1])
    assert 1 <= found.degrees[0] < 2


def test_all_right_has_a_finite_estimate_and_says_how_sure():
    correct = np.array([[20, 12], [20, 15], [20, 17], [20, 9]])
    fit = fit_trials(correct, np.full((4, 2), 20), separate_cells(4, 2))
    assert fit.settled.all()
    # Firth's estimate of one share is (right + ½) of (trials + 1).
    assert fit.coefficients[0, 0] == pytest.approx(logit(80.5 / 81))
    found = combine(fit, [-1, 1])
    assert found.ends()[1][0] < 0
    assert not fit_trials(correct, np.full((4, 2), 20), separate_cells(4, 2),
                          penalised=False).settled.any()  # fmt: skip


def test_participants_who_are_all_alike_leave_no_error():
    fit = fit_trials([[20, 20]] * 4, [[20, 20]] * 4, separate_cells(4, 2))
    found = combine(fit, [-1, 1])
    assert np.isnan(found.errors[0])
    assert np.isnan(found.p_values()[0])


def test_a_group_of_one_has_no_error_and_the_other_has():
    trials = np.array([[20, 0], [0, 20], [0, 20], [0, 20]])
    correct = np.array([[15, 0], [0, 12], [0, 17], [0, 9]])
    fit = fit_trials(correct, trials, separate_cells(4, 2))
    assert np.isnan(combine(fit, [-1, 1]).errors[0])
    assert np.isnan(compare(fit, [-1, 1]).p_values()[0])
    low, high = combine(fit, [0, 1]).ends()
    assert low[0] < logit(38.5 / 61) < high[0]


def test_many_studies_are_fitted_as_each_alone(counts):
    correct, trials, design = counts
    more = np.stack([correct, trials - correct, trials])
    whole = combine(fit_trials(more, np.stack([trials] * 3), design), [1, -1, 0, 0])
    for at, one in enumerate(more):
        alone = combine(fit_trials(one, trials, design), [1, -1, 0, 0])
        for name in ("estimates", "errors", "degrees"):
            assert getattr(whole, name)[at] == pytest.approx(getattr(alone, name)[0], rel=1e-6)


@pytest.mark.parametrize("sd", [0.5, 1.5])
@pytest.mark.parametrize("people", [3, 12])
def test_false_positives_and_coverage(people, sd):
    """Two conditions alike of 39 trials each: about 5 in 100 differ, and 95 intervals hold 0."""
    random = np.random.default_rng([people, round(10 * sd)])
    own = expit(random.normal(1.0, sd, (STUDIES, people, 1)))
    correct = random.binomial(39, np.broadcast_to(own, (STUDIES, people, 2)))
    fit = fit_trials(correct, np.full(correct.shape, 39), separate_cells(people, 2))
    for p in (combine(fit, [-1, 1]).p_values(), compare(fit, [-1, 1]).p_values()):
        assert np.mean(p < 0.05) < 0.06 + 2 * np.sqrt(0.05 / STUDIES)
        assert np.mean(p < 0.05) > 0.02
    for low, high in (combine(fit, [1, -1]).ends(), difference(fit, [1, -1])):
        assert 0.92 < np.mean((low <= 0) & (high >= 0)) < 0.99


@pytest.mark.parametrize(
    ("wrong", "told"),
    [([1, 0, 2, 0], False), ([1, 1, 2, 0], True), ([20, 20, 19, 3], False), ([20, 9, 9, 3], True)],
)
def test_three_must_have_something_wrong_and_three_something_right(wrong, told):
    correct = np.column_stack([[20] * 4, 20 - np.array(wrong)])
    if min(wrong) > 2:
        correct[:, 0] = 0
    assert tells_difference(correct, np.full((4, 2), 20)) == told


@pytest.mark.parametrize("people", [2, 5])
def test_in_the_middle_shares_are_compared_as_by_student(people):
    """Where as many answers are right as wrong, and everybody has as many trials."""
    random = np.random.default_rng(people)
    correct = random.integers(70, 90, (people, 2))
    correct[:, 1] += 160 - (correct.sum() - correct[:, 0].sum() + correct[:, 0].sum()) // people
    fit = fit_trials(correct, np.full((people, 2), 160), separate_cells(people, 2))
    apart = (correct[:, 1] - correct[:, 0]) / 160
    found = compare(fit, [-1, 1])
    assert found.estimates[0] / found.errors[0] == pytest.approx(
        apart.mean() / (apart.std(ddof=1) / np.sqrt(people)), rel=2e-2
    )


def test_a_large_study_is_fitted_as_a_small_one(counts):
    correct, trials, design = counts
    each = [np.repeat(of, 300, axis=1) for of in (correct, trials, design)]
    assert 8 * 900 * 16 < 1_000_000
    many = [np.repeat(of, 9, axis=1) for of in each]
    small, large = fit_trials(*each), fit_trials(*many)
    np.testing.assert_allclose(9 * large.spread, small.spread, rtol=1e-3)
    np.testing.assert_allclose(large.coefficients, small.coefficients, atol=1e-3)
    np.testing.assert_allclose(large.leverages, 9 * small.leverages, rtol=1e-3)


def test_a_difference_of_shares_goes_with_its_odds_ratio():
    correct = np.array([[30, 20], [28, 22], [35, 19], [31, 27]])
    fit = fit_trials(correct, np.full((4, 2), 40), separate_cells(4, 2))
    (least,), (most,) = difference(fit, [1, -1])
    low, high = combine(fit, [1, -1]).ends()
    assert low[0] > 0
    assert least > 0
    assert least < 124.5 / 161 - 88.5 / 161 < most
    assert low[0] < combine(fit, [1, -1]).estimates[0] < high[0]


@pytest.mark.parametrize(
    ("arrays", "error", "reason"),
    [
        (([[1]], [[2]], [[[1.0, 1.0]]]), Unanswerable, "follows from the others"),
        (([[1, 0]], [[2, 0]], separate_cells(1, 2)), Unanswerable, "has no trials"),
        (([[0]], [[0]], [[[1.0]]]), Unanswerable, "no trials"),
    ],
    ids=["aliased", "empty column", "no trials"],
)
def test_what_cannot_be_fitted(arrays, error, reason):
    with pytest.raises(error, match=reason):
        fit_trials(*arrays)


def test_one_participant_is_refused():
    fit = fit_trials([[3, 4]], [[8, 8]], separate_cells(1, 2))
    with pytest.raises(Unanswerable, match="one participant"):
        combine(fit, [-1, 1])
