"""QUEST+ on a grid: by brute force, by what must hold of any history, and what it refuses."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import norm

from tests.tiers import examples
from vbraille.adaptive.questplus import (
    GridAxis,
    GridQuest,
    detection_quest,
    estimate,
    geometric,
    nearer_quest,
    ordered_pairs,
    steps,
)

VALUES = steps(0.5, 3.0, 0.25)
AXES = (GridAxis("centre", VALUES), GridAxis("spread", (0.1, 0.4)), GridAxis("lapse", (0.02,)))
PAIRS = ordered_pairs(VALUES)
HISTORIES = st.lists(st.tuples(st.sampled_from(PAIRS), st.integers(0, 1)), max_size=12)


def quest(about=""):
    return nearer_quest(PAIRS, *AXES, about=about)


def entropy(p):
    p = p[p > 0]
    return -(p * np.log(p)).sum()


def expected(asks, history, of):
    """Fall of a number of the posterior that each pair is expected to bring."""
    now = asks.posterior(history)
    gains = []
    for pair in PAIRS:
        later = [asks.posterior([*history, (pair, outcome)]) for outcome in (0, 1)]
        # Bayes: the posterior is a mixture of what it becomes, weighted by the outcomes.
        first, other = (part.reshape(-1) for part in later)
        at = np.argmax(np.abs(first - other))
        share = (now.reshape(-1)[at] - other[at]) / (first[at] - other[at])
        before, *after = map(of, (now, *later))
        gains.append(before - share * after[0] - (1 - share) * after[1])
    return np.array(gains)


@examples(10)
@given(HISTORIES)
def test_it_asks_what_lowers_the_entropy_most(history):
    gains = expected(quest(), history, entropy)
    assert np.allclose(quest().gains(history), gains, atol=1e-6)
    assert gains[PAIRS.index(quest().next(history))] >= max(gains) - 1e-6


@examples(10)
@given(HISTORIES, st.sampled_from([0, 1]))
def test_about_one_parameter_it_asks_what_lowers_its_variance_most(history, place):
    asks, axis = quest(AXES[place].name), AXES[place]

    def variance(posterior):
        shares = posterior.sum(axis=tuple({0, 1, 2} - {place}))
        return estimate(axis.values, shares).sd ** 2

    gains = expected(asks, history, variance) / variance(asks.posterior(history))
    assert np.allclose(asks.gains(history), gains, atol=1e-6)
    assert gains[PAIRS.index(asks.next(history))] >= max(gains) - 1e-6


@examples(20)
@given(HISTORIES, HISTORIES)
def test_what_was_asked_of_it_before_changes_nothing(history, other):
    used = quest()
    used.next(other)
    used.next(history[: len(history) // 2])
    assert used.next(history) == quest().next(history)
    assert (used.posterior(history) == quest().posterior(history)).all()


@pytest.mark.parametrize("bit", [0.0, 1e-12, -1e-12])
@pytest.mark.parametrize("about", ["", "it"])
def test_of_equally_good_questions_it_asks_the_first(about, bit):
    """Whichever of them is ahead by a last bit, in which machines differ."""
    table = np.full((2, 3, 2), 0.5)
    table[1, 1:, 1], table[0, 1:, 1] = 0.9, 0.1
    table[:, 2] += [[0, -bit], [0, bit]]
    asks = GridQuest([(1.0,), (2.0,), (3.0,)], [GridAxis("it", (0.0, 1.0))], table, about)
    ahead = asks.gains([])[2] - asks.gains([])[1]
    assert np.sign(ahead) == np.sign(bit)
    assert asks.next([]) == (2.0,)


def test_of_two_pairs_that_mirror_each_other_it_asks_the_first():
    """The gains of both pairs differ by rounding alone, and the last pair's is larger."""
    gains = quest("spread").gains([])
    first, last = PAIRS.index((0.5, 0.75)), PAIRS.index((2.75, 3.0))
    assert set(np.flatnonzero(gains >= gains.max() - 1e-9)) == {first, last}
    assert {quest("spread").next([]) for _ in range(3)} == {PAIRS[first]}
    assert {quest().next([]) for _ in range(3)} == {(0.5, 2.75)}  # and not (0.75, 3.0)


def test_what_is_clearly_better_is_asked_wherever_it_stands():
    table = np.full((2, 3, 2), 0.5)
    table[1, 1:, 1], table[0, 1:, 1] = 0.9, 0.1
    table[:, 2] += [[0, -1e-4], [0, 1e-4]]
    asks = GridQuest([(1.0,), (2.0,), (3.0,)], [GridAxis("it", (0.0, 1.0))], table)
    assert asks.next([]) == (3.0,)


def test_three_outcomes():
    random = np.random.default_rng(1)
    table = random.dirichlet((1, 1, 1), size=(4, 5)).transpose(2, 0, 1)
    asks = GridQuest([(float(n),) for n in range(4)], [GridAxis("it", VALUES[:5])], table)
    post = asks.posterior([((0.0,), 2), ((3.0,), 0)])
    by_hand = table[2, 0] * table[0, 3]
    assert np.allclose(post, by_hand / by_hand.sum())
    gains = [
        entropy(np.full(5, 0.2))
        - sum(p.sum() / 5 * entropy(p / p.sum()) for p in table[:, stimulus])
        for stimulus in range(4)
    ]
    assert np.allclose(asks.gains([]), gains)


def test_what_falls_is_the_mirror_image_of_what_grows():
    values = steps(-1.0, 1.0, 0.1)
    rest = [GridAxis("spread", (0.2, 0.4)), GridAxis("guess", (0.0,)), GridAxis("lapse", (0.02,))]
    grows = detection_quest("normal", values, GridAxis("threshold", values), *rest)
    falls = detection_quest("normal", values, GridAxis("threshold", values), *rest, falls=True)
    history = [((values[n],), n % 3 // 2) for n in (1, 5, 13, 14, 15)]
    mirrored = [((-x[0],), yes) for x, yes in history]
    found = grows.estimate(history, "threshold").mean
    assert falls.estimate(mirrored, "threshold").mean == pytest.approx(-found)


def test_false_alarms_do_not_move_thresholds_where_guesses_are_free():
    """Readers of one threshold who say yes to a fifth of what they do not feel."""
    values = steps(0.0, 1.0, 0.05)
    axes = [GridAxis("threshold", values), GridAxis("spread", (0.05, 0.1, 0.2))]
    free, lapse = GridAxis("guess", (0.01, 0.05, 0.1, 0.2, 0.3, 0.4)), GridAxis("lapse", (0.03,))
    errors = {}
    for guess in (free, GridAxis("guess", (0.0,))):
        asks = detection_quest("normal", values, *axes, guess, lapse, about="threshold")
        random = np.random.default_rng(3)
        found = []
        for _ in range(10):
            history = []
            for _ in range(50):
                (x,) = asks.next(history)
                yes = 0.2 + (1 - 0.2 - 0.02) * norm.cdf(x, 0.4, 0.1)
                history.append(((x,), int(random.random() < yes)))
            found.append(asks.estimate(history, "threshold").mean - 0.4)
        errors[len(guess.values)] = np.mean(found)
    assert abs(errors[6]) < 0.02
    assert errors[1] < -0.03


def test_an_estimate_is_of_the_posterior():
    values = tuple(np.linspace(0, 10, 2001).tolist())
    shares = np.exp(-((np.array(values) - 4) ** 2) / 2 / 0.5**2)
    found = estimate(values, shares / shares.sum())
    assert (found.mean, found.median, found.sd) == pytest.approx((4, 4, 0.5), abs=1e-3)
    assert (found.low, found.high) == pytest.approx((4 - 0.98, 4 + 0.98), abs=1e-3)
    assert estimate((2.0,), np.ones(1)).width == 0


def test_grids():
    assert steps(0.5, 3.0, 0.05)[1] == 0.55
    assert (len(steps(0.5, 3.0, 0.05)), len(PAIRS)) == (51, 55)
    assert geometric(0.05, 1.0, 3) == pytest.approx((0.05, 0.2236, 1.0), abs=1e-4)


AXIS = GridAxis("it", (0.0, 1.0))


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: steps(1, 1, 0.1), "step is 0.1; it must be above 0 and at most 0"),
        (lambda: steps(0, 1, 0.3), "step is 0.3, and steps of it from 0 do not meet 1"),
        (lambda: GridAxis("it", ()), "it has no values"),
        (lambda: GridAxis("it", (1.0, 1.0)), "values that do not increase"),
        (lambda: GridQuest([], [AXIS], np.ones((2, 0, 2))), "stimuli are none"),
        (lambda: GridQuest([(1.0,)], [GridAxis("it", (0.0,))], np.full((2, 1, 1), 0.5)),
         "1 to 3 parameters must have several values"),
        (lambda: GridQuest([(1.0,)], [AXIS], np.full((2, 1, 2), 0.5), "that"),
         "there is no parameter 'that'; there is it"),
        (lambda: detection_quest("weibull", (0.0, 1.0), *[AXIS] * 4), "for values above 0"),
        (lambda: nearer_quest(PAIRS, GridAxis("centre", steps(0, 1, 1e-5)), *AXES[1:]),
         "the grid has 11000110 cells; it must have at most 4000000"),
    ],
)  # fmt: skip
def test_refusals(make, says):
    with pytest.raises(ValueError, match=says):
        make()


def test_a_parameter_that_there_is_not():
    with pytest.raises(KeyError):
        quest().estimate([], "that")
