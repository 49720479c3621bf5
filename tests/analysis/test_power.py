"""Power by simulation, against closed forms."""

import numpy as np
import pytest
from scipy import stats as scipy_stats

from vbraille.analysis.power import Study, power, simulate, study_of
from vbraille.errors import InputError
from vbraille.sessions.planning.loading import load_protocol, parse_protocol

LETTERS = {"T0": 0.5, "T25": 0.56, "T100": 0.64}


def plain_study(gap, spread, **changes):
    """A study of a value in two conditions that differ by so much."""
    named = {"scale": "values", "factors": ["condition"], "levels": [["a", "b"]]}
    named |= {"middles": np.array([[0.0, gap]]), "trials": np.ones((1, 2))}
    return Study(**(named | {"between": 1.0, "differing": spread} | changes))


@pytest.mark.parametrize(("gap", "people"), [(1.0, 8), (0.5, 20), (0.0, 6)])
def test_the_paired_t_test_has_its_known_power(gap, people):
    (row,) = power(plain_study(gap, 0.7), [people], studies=20_000)
    noncentral = gap / (0.7 * np.sqrt(2 / people))
    reach = scipy_stats.t.isf(0.025, people - 1)
    known = scipy_stats.nct.sf(reach, people - 1, noncentral)
    known += scipy_stats.nct.cdf(-reach, people - 1, noncentral)
    assert row.power == pytest.approx(known, abs=0.01)
    assert row.low < row.power < row.high


def test_groups_take_turns_and_are_tested_by_welch():
    study = plain_study(
        0, 0.5, factors=["group"], levels=[["x", "y"]],
        middles=np.array([[0.0], [3.0]]), trials=np.ones((2, 1)),
    )  # fmt: skip
    (row,) = power(study, [12], studies=500)
    assert (row.compared, row.power) == ("x and y", pytest.approx(1, abs=0.02))


def test_shares_average_to_what_was_asked_for():
    study = study_of(load_protocol("letters"), LETTERS, between=1.0)
    assert study.trials.tolist() == [[26, 26, 26]]
    values = simulate(study, 400, 50, np.random.default_rng(1))
    assert values.mean(axis=(0, 1)) == pytest.approx([0.5, 0.56, 0.64], abs=0.01)
    assert set(np.unique(values * 26 % 1).round(9)) <= {0, 1}


def test_a_condition_alone_has_the_width_of_its_interval():
    text = (
        'name = "one"\ntitle = "One"\nmodel = "vbd"\n[design]\nkind = "combinations"\n'
        'characters = ["a", "c"]\nlength = 2\nrepeats = 5\n'
    )
    protocol = parse_protocol({"protocol.toml": text.encode()}, "one.toml")
    (row,) = power(study_of(protocol, {"legibility": 0.8}), [6], studies=200)
    assert row.power is None
    assert 0.02 < row.half_width < 0.3


@pytest.mark.parametrize(
    ("effect", "named"),
    [({"T0": 0.5}, "T25"), (LETTERS | {"T9": 0.5}, "T25"), (LETTERS | {"T0": 0.0}, "above 0")],
)
def test_values_that_cannot_be_used(effect, named):
    with pytest.raises(InputError, match=named):
        study_of(load_protocol("letters"), effect)
