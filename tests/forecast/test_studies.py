"""Simulated studies: the same however they are portioned, with the shares asked for."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import expit

from tests.forecast.closedform import mean_and_spread
from vbraille.analysis.statistics.comparisons import CellScores, CellShares, effects
from vbraille.forecast.studies import (
    StudyPlan,
    StudyTask,
    _in_cells,
    count_found,
    log_odds_of,
    simulate,
)

PLAN = StudyPlan(
    trials=((26, 26, 20),) * 8,
    middles=(0.0, 0.3, 1.0),
    cells=(0, 1, 2),
    levels=((0,), (1,), (2,)),
    between=0.5,
    differing=0.3,
    sizes=(5, 8),
    model="trials",
    correction="holm",
)


def test_studies_are_the_same_in_whatever_portions():
    whole = simulate(StudyTask(PLAN, 7, 0, 6))
    parts = [simulate(StudyTask(PLAN, 7, first, 2)) for first in (0, 2, 4)]
    assert np.array_equal(whole, np.concatenate(parts))
    assert not np.array_equal(whole, simulate(StudyTask(PLAN, 8, 0, 6)))


def test_a_smaller_study_is_the_beginning_of_a_larger_one():
    smaller = replace(PLAN, trials=PLAN.trials[:5])
    whole = simulate(StudyTask(PLAN, 7, 0, 4))
    assert np.array_equal(whole[:, :5], simulate(StudyTask(smaller, 7, 0, 4)))


def test_participants_have_trials_in_the_conditions_of_their_own_alone():
    groups = replace(PLAN, trials=((10, 0, 5), (0, 20, 5)) * 4, middles=(39.0, 39.0, -39.0))
    correct = simulate(StudyTask(groups, 7, 0, 2))
    assert correct[0, :2].tolist() == [[10, 0, 0], [0, 20, 0]]


@pytest.mark.parametrize(("share", "spread"), [(0.5, 0.0), (0.64, 0.5), (0.97, 1.5)])
def test_the_population_has_the_share_asked_for(share, spread):
    people = np.random.default_rng(1).standard_normal(400_000)
    assert expit(log_odds_of(share, spread) + spread * people).mean() == pytest.approx(
        share, abs=0.001
    )


def test_shares_differ_as_the_closed_form_says():
    correct = simulate(StudyTask(PLAN, 7, 0, 2500)) / np.array(PLAN.trials)
    apart = (correct[..., 0] - correct[..., 2]).ravel()
    mean, spread = mean_and_spread(PLAN, 0, 2, PLAN.trials[0])
    assert apart.mean() == pytest.approx(mean, abs=4 * spread / 20_000**0.5)
    assert apart.std() == pytest.approx(spread, rel=0.02)
    half = mean_and_spread(PLAN, 1, None, PLAN.trials[0])
    assert correct[..., 1].mean() - 0.5 == pytest.approx(half[0], abs=4 * half[1] / 20_000**0.5)
    assert correct[..., 1].std() == pytest.approx(half[1], rel=0.02)


@pytest.mark.parametrize("model", ["trials", "means", "scores"])
def test_a_study_is_tested_as_the_analysis_does(model):
    """A simulated study finds what its report would find."""
    plan = replace(PLAN, model=model, sizes=(8,))
    found = np.zeros(4, int)
    for study in range(12):
        made = simulate(StudyTask(plan, 7, study, 1))[0]
        asked = np.array(plan.trials)
        group, groups = np.zeros(8, int), np.zeros(3, int)
        if model == "trials":
            data = CellShares(made.astype(int), asked, plan.design)
        else:
            own = made if model == "scores" else made / asked
            data = CellScores(own, plan.design, group, groups)
        (effect,) = effects(data, "holm")
        found += np.array([effect.p, *(p for *_, p in effect.pairs)], float) < 0.05
    assert [one for one, _ in count_found(StudyTask(plan, 7, 0, 12))[0]] == found.tolist()


def test_conditions_are_put_together_in_the_cells_of_the_analysis():
    plan = replace(PLAN, cells=(0, 0, 1), levels=((0,), (1,)))
    values, asked = _in_cells(plan, simulate(StudyTask(plan, 7, 0, 2)))
    assert values.shape == (2, 8, 2)
    assert asked.tolist() == [[52, 20]] * 8


def test_what_differs_is_found_and_what_does_not_is_not():
    counts = count_found(StudyTask(replace(PLAN, middles=(0.0, 0.0, 3.0)), 7, 0, 40))
    _, (effect, alike, one, _) = counts
    assert effect[0] >= one[0] >= 35
    assert alike[0] <= 6


def test_a_study_in_which_nobody_differs_is_told_of():
    sure = replace(PLAN, middles=(39.0, 39.0, -39.0), between=0.0, differing=0.0, model="means")
    assert count_found(StudyTask(sure, 7, 0, 3))[0][1] == [0, 3]
