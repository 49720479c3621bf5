"""Observers on a grid, and staircases: what their equations say."""

import random

import numpy as np
import pytest

from vbraille.adaptive.observer import Grid, Quest, psychometric, steps
from vbraille.adaptive.staircase import Rule, Staircases

VALUES = steps(0.0, 1.0, 0.05)
AXES = {"threshold": VALUES, "spread": (0.05, 0.1), "guess": (0.0,), "lapse": (0.02,)}


@pytest.mark.parametrize("shape", ["normal", "logistic"])
def test_half_of_the_way_from_guesses_to_lapses_is_at_the_threshold(shape):
    at = psychometric(shape)(0.4, 0.4, 0.1, 0.5, 0.1)
    assert at == pytest.approx(0.5 + 0.4 / 2)
    falling = psychometric(shape, falls=True)
    assert falling(0.2, 0.4, 0.1, 0.0, 0.0) > falling(0.6, 0.4, 0.1, 0.0, 0.0)


def test_the_likelihood_of_counts_is_that_of_single_answers():
    quest = Quest(Grid(psychometric("normal"), AXES), [(value,) for value in VALUES])
    history = [((0.5,), True), ((0.5,), False), ((0.25,), False), ((0.5,), True)]
    counted = quest.grid.log_likelihood([(0.5,), (0.25,)], [2, 0], [3, 1])
    np.testing.assert_allclose(quest.log_likelihood(history), counted)


@pytest.mark.parametrize("about", ["", "threshold"])
def test_a_threshold_is_found_within_its_interval(about):
    quest = Quest(Grid(psychometric("normal"), AXES), [(value,) for value in VALUES], about)
    drawn, held = random.Random(1), 0
    for _ in range(20):
        history = []
        for _ in range(30):
            stimulus = quest.next(history)
            chance = psychometric("normal")(stimulus[0], 0.35, 0.05, 0.0, 0.02)
            history.append((stimulus, drawn.random() < float(chance)))
        found = quest.estimate("threshold", history)
        held += found.low <= 0.35 <= found.high
        assert found.low <= found.median <= found.high
    assert held >= 17


def test_a_grid_that_is_too_large_and_a_step_that_leads_nowhere_are_refused():
    with pytest.raises(ValueError, match="cells"):
        Quest(Grid(psychometric("normal"), AXES | {"spread": range(1, 10**5)}), [(0.5,)] * 50)
    with pytest.raises(ValueError, match=r"0\.3"):
        steps(0.0, 1.0, 0.3)


def climbed(rule, answer, count, seed="1"):
    staircases, history = Staircases([rule], seed), []
    for _ in range(count):
        level = staircases.next(history)
        if level is None:
            break
        history.append((level, answer(level)))
    return staircases, history


def test_two_right_answers_make_it_harder_and_one_wrong_makes_it_easier():
    rule = Rule(0.5, 0.0, 1.0, (0.2, 0.1))
    answers = iter([True, True, True, True, False, True])
    _, history = climbed(rule, lambda _: next(answers), 6)
    assert [level for level, _ in history] == [0.5, 0.5, 0.3, 0.3, 0.1, 0.2]


@pytest.mark.parametrize(
    ("rule", "share"),
    [
        (Rule(0.8, 0.0, 1.0, (0.02,)), 0.707),
        (Rule(0.8, 0.0, 1.0, (0.02,), right=3), 0.794),
        (Rule(0.8, 0.0, 1.0, (0.02,), right=1, easier=3.0), 0.75),
    ],
)
def test_staircases_converge_where_the_share_is_right(rule, share):
    drawn = random.Random(2)
    staircases, history = climbed(rule, lambda level: drawn.random() < level, 900)
    level, count = staircases.estimate(history)
    assert level == pytest.approx(share, abs=0.05)
    assert count % 2 == 0


def test_it_ends_after_its_reversals_and_interleaves_the_same_for_a_seed():
    rule = Rule(0.5, 0.0, 1.0, (0.1,), reversals=4)
    drawn = random.Random(3)
    staircases, history = climbed(rule, lambda _: drawn.random() < 0.6, 500)
    assert staircases.next(history) is None
    rules = [Rule(0.2, 0.0, 1.0, (0.1,)), Rule(0.8, 0.0, 1.0, (0.1,))]
    firsts = {Staircases(rules, str(seed)).next([]) for seed in range(20)}
    assert firsts == {0.2, 0.8}
