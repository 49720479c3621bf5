"""Power: its closed form, the same numbers on any workers, and what cannot be asked."""

import math
from dataclasses import replace

import pytest
from statsmodels.stats.power import TTestPower

from tests.forecast.closedform import of_row, t_power
from tests.tiers import by_tier, heavy
from vbraille.errors import InputError
from vbraille.forecast.power import PowerQuestion, power
from vbraille.forecast.workers import Workers
from vbraille.sessions.planning.making import make_plan
from vbraille.sessions.planning.protocolfiles import load_protocol, parse_protocol

ONE = Workers()
LETTERS = load_protocol("letters")
EFFECT = {"T0": "0.4", "T25": "0.5", "T100": "0.7"}
QUESTION = PowerQuestion(LETTERS, EFFECT, (6, 12), studies=300)


def legibility(**changed):
    effect = {"nominal": "0.5", "textured": "0.58"}
    return PowerQuestion(load_protocol("legibility"), effect, **{"sizes": (12,), **changed})


@pytest.mark.parametrize(("d", "n"), [(0.0, 5), (0.4, 12), (-1.2, 20)])
def test_power_of_a_t_test_is_that_of_statsmodels(d, n):
    assert t_power(d, n) == pytest.approx(TTestPower().power(d, n, 0.05), abs=1e-9)


def test_power_of_a_paired_design_is_that_of_its_closed_form():
    studies = by_tier(2000, 10_000, 50_000)
    question = legibility(sizes=(5, 12, 20), studies=studies, test="paired")
    for row in power(question, ONE).rows:
        chance = 3.5 * math.sqrt(row.power * (1 - row.power) / studies)
        assert row.power == pytest.approx(of_row(question, row), abs=0.005 + chance)


def test_a_preference_is_found():
    question = PowerQuestion(
        load_protocol("tuning-width"), {"1.5": "0.65"}, (6, 20), studies=200, between=0.4
    )
    assert question.plan().trials[0] == (30,)  # with 5 other values, in 2 orders, 3 times
    few, many = power(question, ONE).rows
    assert many.second == "one half"
    assert few.power < many.power
    assert few.power == pytest.approx(of_row(question, few), abs=0.12)


def test_catch_trials_belong_to_no_condition():
    text = load_protocol("letters").text
    watched = text.replace("[design]\n", "[design]\ncatch = { every = 4 }\n", 1)
    assert watched != text
    protocol = parse_protocol(watched, "letters.toml")
    assert any(trial.catch for trial in make_plan(protocol, "P1", 1).trials)
    assert replace(QUESTION, protocol=protocol).plan().trials == QUESTION.plan().trials


def test_rows_are_of_each_size_and_pair_with_what_is_enough():
    table = power(replace(QUESTION, sizes=(4, 6, 30)), ONE)
    assert [(row.participants, row.first, row.second) for row in table.rows[3:6]] == [
        (6, "T0", "T25"), (6, "T0", "T100"), (6, "T25", "T100"),
    ]  # fmt: skip
    assert table.enough()["T0", "T100"] in (6, 30)
    assert table.enough(1.01)["T0", "T100"] is None
    row = table.rows[0]
    assert row.low < row.power < row.high
    assert row.studies == 300
    assert table.to_json()["rows"][0]["power"] == row.power


def test_an_odds_ratio_gives_the_other_shares():
    ratio = replace(QUESTION, effect={"T25": "0.5", "odds-ratio": "3"}, studies=1)
    shares = {(row.first, row.first_share) for row in power(ratio, ONE).rows}
    assert shares == {("T0", 0.75), ("T25", 0.5)}


@heavy
def test_two_workers_find_what_one_finds():
    assert power(QUESTION, Workers(2)).rows == power(QUESTION, ONE).rows


def test_work_that_was_ended_goes_on(tmp_path):
    whole = power(QUESTION, ONE, keep=tmp_path / "kept")
    lines = (tmp_path / "kept").read_text().splitlines()
    assert len(lines) == 1 + 3
    (tmp_path / "kept").write_text("\n".join([lines[0], lines[2], "1", lines[3][:9]]))
    done = []
    again = power(QUESTION, ONE, keep=tmp_path / "kept", report=lambda *now: done.append(now))
    assert done == [(2, 3), (3, 3)]
    assert again == whole
    done.clear()
    kept = tmp_path / "kept"
    assert power(QUESTION, ONE, keep=kept, report=lambda *now: done.append(now)) == whole
    assert done == []
    with pytest.raises(InputError, match="other work; give a new name"):
        power(replace(QUESTION, seed=2), ONE, keep=tmp_path / "kept")


@pytest.mark.parametrize(
    ("changed", "sentence"),
    [
        ({"effect": {"T7": "0.5"}}, "condition T7, which letters does not have; it has T0, T25"),
        ({"effect": {"T0": "0.5"}}, "no share for T25, T100; give one"),
        ({"effect": EFFECT | {"T0": "1.2"}}, "share of T0 is 1.2; it must be between 0 and 1"),
        ({"effect": EFFECT | {"T0": "high"}}, "T0 is 'high', which is not a number"),
        ({"effect": EFFECT | {"odds-ratio": "2"}}, "an odds ratio and 3 shares"),
        ({"effect": {"T0": "0.5", "odds-ratio": "0"}}, "odds-ratio is 0; it must be 0.001 to"),
        ({"sizes": (2, 3)}, "one is 2; it must be 3 to 500"),
        ({"studies": 0}, "is 0; it must be 1 to"),
        ({"between": -1.0}, "is -1 log odds; it must be 0 to 5 log odds"),
        ({"protocol": load_protocol("control")}, "control has one condition"),
        ({"protocol": load_protocol("tuning-width-adaptive")}, "chooses its trials by the answers"),
        ({"protocol": load_protocol("tuning-width")}, "compares two stimuli; give"),
        (
            {"protocol": load_protocol("tuning-width"), "effect": {"1.7": "0.5"}},
            "the value 1.7, which tuning-width does not have; give ",
        ),
        ({"protocol": load_protocol("tuning-width"), "test": "paired"}, "has one test; leave"),
    ],
)  # fmt: skip
def test_what_cannot_be_asked_is_refused_in_a_sentence(changed, sentence):
    with pytest.raises(InputError, match=sentence):
        power(replace(QUESTION, **changed), ONE)
