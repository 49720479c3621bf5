"""Procedures: the levels that follow from the answers."""

import random
import re

import pytest

from vbraille.sessions.planning.design import StringList
from vbraille.sessions.planning.procedures import Outcome, QuestPlus, Staircase

DESIGN = StringList(strings=("a",))
BOUNDS = {"parameter": "contrast", "least": 0.0, "most": 1.0}


def staircase(*start, **how):
    return Staircase(**BOUNDS, start=start, **{"steps": (0.02,), **how})


def climbed(rule, answer, count):
    """The answers that a staircase is given until it is over."""
    history = []
    while len(history) < count and (level := rule.next(DESIGN, history, "1")) is not None:
        history.append(Outcome(level, answer(level[0])))
    return history


def test_two_right_answers_make_it_harder_and_one_wrong_makes_it_easier():
    answers = iter([True, True, True, True, False, True])
    history = climbed(staircase(0.5, steps=(0.2, 0.1)), lambda _: next(answers), 6)
    assert [outcome.level[0] for outcome in history] == [0.5, 0.5, 0.3, 0.3, 0.1, 0.2]


@pytest.mark.parametrize(
    ("how", "share"),
    [({}, 0.707), ({"right": 3}, 0.794)],
)
def test_staircases_converge_where_the_share_is_right(how, share):
    drawn = random.Random(2)
    rule = staircase(0.8, **how)
    history = climbed(rule, lambda level: drawn.random() < level, 900)
    level, count = re.fullmatch(
        r"([\d.]+), the mean of (\d+) reversals", rule.found(DESIGN, history, "1")
    ).groups()
    assert float(level) == pytest.approx(share, abs=0.05)
    assert int(count) % 2 == 0


def test_it_ends_after_its_reversals_and_interleaves_the_same_for_a_seed():
    drawn = random.Random(3)
    history = climbed(staircase(0.5, reversals=4), lambda _: drawn.random() < 0.6, 500)
    assert len(history) < 500
    both = staircase(0.2, 0.8)
    assert {both.next(DESIGN, [], str(seed)) for seed in range(20)} == {(0.2,), (0.8,)}


def test_quest_ends_when_it_is_precise_or_enough_was_asked():
    quest = QuestPlus(**BOUNDS, step=0.05, spread=(0.1,), sd=0.05, trials=60)
    drawn = random.Random(4)
    history = climbed(quest, lambda level: drawn.random() < level, 100)
    assert 10 <= len(history) < 60
    assert "95 % between" in quest.found(DESIGN, history, "1")
    endless = QuestPlus(**BOUNDS, step=0.05, spread=(0.1,), trials=60)
    assert len(climbed(endless, lambda level: level > 0.5, 100)) == 60
