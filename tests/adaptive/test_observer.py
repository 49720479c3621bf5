"""Observers on a grid: what their equations say."""

import random

import numpy as np
import pytest

from vbraille.adaptive.observer import Grid, Quest, psychometric, steps

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
        assert found.low <= found.mean <= found.high
    assert held >= 17


def test_a_grid_that_is_too_large_and_a_step_that_leads_nowhere_are_refused():
    with pytest.raises(ValueError, match="cells"):
        Quest(Grid(psychometric("normal"), AXES | {"spread": range(1, 10**5)}), [(0.5,)] * 50)
    with pytest.raises(ValueError, match=r"0\.3"):
        steps(0.0, 1.0, 0.3)
