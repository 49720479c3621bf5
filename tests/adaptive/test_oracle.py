"""Our QUEST+ beside questplus: the same question after the same answers, the same estimate."""

import json
from itertools import product
from pathlib import Path

import pytest

from vbraille.adaptive.observer import Grid, Quest, nearer, psychometric

MADE = json.loads(Path(__file__).with_name("oracle.json").read_text())
MODELS = {model["name"]: model for model in MADE["models"]}


def quest_of(model):
    if model["family"].startswith("nearer"):
        observer = nearer(log=model["family"].endswith("log"))
    else:
        observer = psychometric(model["family"])
    return Quest(Grid(observer, model["axes"]), list(product(*model["stimuli"])))


def same_questions(quest, asked):
    """How often it asks the same, each time after the answers that questplus had."""
    history, same = [], 0
    for *stimulus, outcome in asked:
        same += quest.next(history) == tuple(stimulus)
        history.append((tuple(stimulus), bool(outcome)))
    return same, history


@pytest.mark.parametrize("name", MODELS)
def test_it_asks_what_questplus_asks_and_finds_what_it_finds(name):
    model = MODELS[name]
    quest, same, all_ = quest_of(model), 0, 0
    for trace in model["traces"]:
        assert len(trace["asked"]) >= 40
        agreed, history = same_questions(quest, trace["asked"])
        same, all_ = same + agreed, all_ + len(history)
        for axis, mean in trace["found"].items():
            assert quest.estimate(axis, history).mean == pytest.approx(mean, abs=1e-6)
    assert same >= 0.99 * all_


def test_it_would_be_seen_if_the_questions_were_others():
    model = MODELS["nearer of two"]
    asked = [
        [*rest, outcome ^ (n % 2)] for n, (*rest, outcome) in enumerate(model["traces"][0]["asked"])
    ]
    assert same_questions(quest_of(model), asked)[0] < 0.5 * len(asked)
