"""Our QUEST+ beside questplus: the same question after the same answers, the same estimate.

`oracle.json` has what questplus 2023.1 (GPL, so that it is no requirement) asks in simulated
sessions of 72 trials: stim_selection_method "min_entropy", param_estimation_method "mean",
stim_scale "linear". Its `norm_cdf` and `weibull` are of the first three models; the likelihoods of
pairs were put in its place, by equation (5) of `vbraille.adaptive.observer`.
"""

import json
from itertools import product
from pathlib import Path

import pytest

from vbraille.adaptive.observer import Grid, Quest, nearer, psychometric

MADE = json.loads(Path(__file__).with_name("oracle.json").read_text())
MODELS = {model["name"]: model for model in MADE["models"]}


def quest_of(model):
    observer = nearer if model["family"] == "nearer" else psychometric(model["family"])
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
