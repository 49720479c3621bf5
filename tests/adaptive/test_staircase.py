"""Staircases: by hand, where they converge, and what cannot move."""

import numpy as np
import pytest

from vbraille.adaptive.questplus import GridEstimate
from vbraille.adaptive.staircase import Asked, StaircaseRule, Staircases, StopRule


def rule(**changed):
    given = {"start": 0.8, "least": 0.0, "most": 1.0, "steps": (0.2, 0.1)}
    return StaircaseRule(**given | changed)


def levels(staircases, rights):
    """Levels at which these answers are given, and the one after them."""
    history, shown = [], []
    for right in rights:
        shown.append(staircases.next(history))
        history.append(Asked((shown[-1],), int(right)))
    return [*shown, staircases.next(history)]


def test_two_down_one_up_by_hand():
    shown = levels(Staircases((rule(),)), [1, 1, 1, 1, 0, 1, 1, 0, 1, 0])
    #                                      harder twice; a wrong one turns it round: the step is 0.1
    by_hand = [0.8, 0.8, 0.6, 0.6, 0.4, 0.5, 0.5, 0.4, 0.5, 0.5, 0.6]
    assert shown == pytest.approx(by_hand)


def test_more_can_be_harder_and_bounds_hold():
    rising = rule(start=0.5, harder_is_less=False, right=1, steps=(0.4,))
    assert levels(Staircases((rising,)), [1, 1, 1, 0]) == pytest.approx([0.5, 0.9, 1, 1, 0.6])


def test_it_is_over_after_its_reversals():
    shown = levels(Staircases((rule(right=1, reversals=3),)), [1, 0, 1, 0])
    assert shown[-1] is None
    assert None not in shown[:-1]


@pytest.mark.parametrize(
    ("changed", "share"), [({"right": 2}, 0.707), ({"right": 3}, 0.794),
                           ({"right": 1, "easier": 3.0}, 0.75)],
)  # fmt: skip
def test_where_they_converge(changed, share):
    """A reader who is right with a probability that is the level stays at the level's own share."""
    random, both = np.random.default_rng(2), Staircases((rule(steps=(0.02,), **changed),))
    history = []
    for _ in range(800):
        level = both.next(history) if len(history) < 40 else both.climbs(history)[0].level
        history.append(Asked((level,), int(random.random() < level)))
    assert both.estimate(history).mean == pytest.approx(share, abs=0.05)


def test_interleaved_ones_are_drawn_by_the_seed_and_follow_their_own_answers():
    high, low = rule(right=1, steps=(0.1,)), rule(start=0.2, right=1, steps=(0.1,))
    rights = [1, 0, 1, 1, 0, 0, 1, 1, 1, 0] * 3
    orders = [levels(Staircases((high, low), f"seed {n}"), rights) for n in range(5)]
    assert orders[0] == levels(Staircases((high, low), "seed 0"), rights)
    assert len({tuple(order) for order in orders}) > 1
    history = [Asked((0.8,), 1)] * 9
    assert sum(climb.running + (climb.harder is not None) for climb in
               Staircases((high, low)).climbs(history)) >= 1  # fmt: skip
    only = Staircases((rule(right=1, reversals=1), low), "x")
    shown = levels(only, rights)
    assert {low.start, high.start} <= set(shown)


def test_an_estimate_leaves_out_the_first_steps_and_an_odd_turn():
    stairs = Staircases((rule(right=1, steps=(0.2, 0.1)),))
    history = []
    for right in [1, 0, 1, 0, 1, 0]:
        history.append(Asked((stairs.next(history),), right))
    turned = stairs.climbs(history)[0].turned
    assert len(turned) == 5
    assert stairs.estimate(history).mean == pytest.approx(np.mean(turned[1:]))
    assert stairs.estimate(history).reversals == 4
    assert stairs.estimate(history[:2]) is None


@pytest.mark.parametrize(
    ("changed", "says"),
    [
        ({"least": 0.5, "most": 0.5}, "least is 0.5 and most is 0.5: the staircase cannot move"),
        ({"start": 2.0}, "start is 2; it must be 0 to 1"),
        ({"steps": ()}, "steps must all be above 0, or the staircase cannot move"),
        ({"steps": (0.1, 0.0)}, "steps must all be above 0, or the staircase cannot move"),
        ({"steps": (3.0,)}, "could only stand at its ends; make it smaller"),
        ({"steps": (0.5,), "easier": 4.0}, "could only stand at its ends; make it smaller"),
        ({"right": 0}, "right is 0; it must be 1 or more"),
        ({"easier": 0.0}, "easier is 0; it must be 0.01 to 100"),
        ({"reversals": 0}, "reversals is 0; it must be 1 or more"),
    ],
)
def test_refusals(changed, says):
    with pytest.raises(ValueError, match=says):
        rule(**changed)
    with pytest.raises(ValueError, match="staircases are none"):
        Staircases(())


def test_when_enough_was_asked():
    asked = [Asked((1.0,), 1, t_s) for t_s in (3.0, 9.5)]
    assert StopRule(trials=2).out_of_limits(asked)
    assert not StopRule(trials=3).out_of_limits(asked)
    assert StopRule(seconds=9.5).out_of_limits(asked)
    assert not StopRule(seconds=9.6).out_of_limits(asked)
    assert not StopRule(seconds=1).out_of_limits([])
    known = GridEstimate(1.0, 1.0, 0.1, 0.8, 1.2)
    for stop, enough in (
        (StopRule(sd=0.1), True), (StopRule(sd=0.09), False), (StopRule(width=0.5), True),
        (StopRule(width=0.3, sd=0.1), False), (StopRule(trials=5), False),
        (StopRule(sd=1.0, at_least=6), False),
    ):  # fmt: skip
        assert stop.precise(5, known) is enough
    with pytest.raises(ValueError, match="sd is 0; it must be above 0"):
        StopRule(sd=0.0)
