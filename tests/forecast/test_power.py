"""Power: its closed form, the same numbers on any workers, and what cannot be asked."""

import math
from dataclasses import replace

import numpy as np
import pytest
from msgspec import structs
from scipy.stats import t as student
from statsmodels.stats.power import TTestPower

from tests.forecast.closedform import of_row, t_power
from tests.forecast.independent import off_by
from tests.tiers import by_tier, heavy
from vbraille.errors import InputError
from vbraille.forecast.power import PowerQuestion, names_of, power, values_of
from vbraille.forecast.studies import StudyTask, simulate
from vbraille.forecast.workers import Workers
from vbraille.sessions.planning.making import make_plan
from vbraille.sessions.planning.protocolfiles import load_protocol, parse_protocol

ONE = Workers()
LETTERS = load_protocol("letters")
EFFECT = {"T0": "0.4", "T25": "0.5", "T100": "0.7"}
QUESTION = PowerQuestion(LETTERS, EFFECT, (6, 12), studies=300)


def legibility(model="trials", **changed):
    effect = {"nominal": "0.5", "textured": "0.58"}
    protocol = load_protocol("legibility")
    analysis = structs.replace(protocol.analysis, model=model)
    protocol = structs.replace(protocol, analysis=analysis)
    return PowerQuestion(protocol, effect, **{"sizes": (12,), **changed})


@pytest.mark.parametrize(("d", "n"), [(0.0, 5), (0.4, 12), (-1.2, 20)])
def test_power_of_a_t_test_is_that_of_statsmodels(d, n):
    assert t_power(d, n) == pytest.approx(TTestPower().power(d, n, 0.05), abs=1e-9)


def test_power_of_a_paired_design_is_that_of_its_closed_form():
    studies = by_tier(600, 10_000, 50_000)
    question = legibility("means", sizes=(5, 12, 20), studies=studies)
    for row in power(question, ONE).rows:
        chance = 3.5 * math.sqrt(row.power * (1 - row.power) / studies)
        assert row.power == pytest.approx(of_row(question, row), abs=0.005 + chance)


def test_a_preference_has_the_width_of_its_interval():
    """Student's interval of normal values: its half width follows from the chi distribution."""
    protocol = load_protocol("tuning-width-adaptive")
    question = PowerQuestion(protocol, {"preferred": "2"}, (6, 20), studies=400, between=0.4)
    for row in power(question, ONE).rows:
        n = row.participants
        chi = math.exp(math.lgamma(n / 2) - math.lgamma((n - 1) / 2)) * math.sqrt(2 / (n - 1))
        wanted = float(student.ppf(0.975, n - 1)) * 0.4 * chi / math.sqrt(n)
        assert (row.kind, row.power, row.untested) == ("mean", None, 0)
        assert row.half_width == pytest.approx(wanted, rel=0.05)


def test_groups_factors_and_interactions_are_found():
    effect = {
        "flat-low": "0.4", "flat-high": "0.4", "rough-low": "0.4", "rough-high": "0.4",
        "paired:rough-high": "0.9", "paired:rough-low": "0.9",
    }  # fmt: skip
    question = PowerQuestion(load_protocol("factors"), effect, (12,), studies=100)
    rows = {(row.kind, row.compared): row.power for row in power(question, ONE).rows}
    assert rows["effect", "texture × mapping"] > 0.8
    assert rows["simple effect", "flat less rough, at mapping paired"] > 0.8
    assert rows["simple effect", "flat less rough, at mapping alternate"] < 0.1
    assert rows["effect", "contrast"] < 0.1
    assert ("difference", "texture: flat less rough") not in rows  # it is the effect


def test_ratings_are_compared_as_participants_means():
    effect = {"T0": "2", "T25": "2", "T50": "2", "T75": "2", "T100": "5"}
    rating = load_protocol("rating")
    question = PowerQuestion(rating, effect, (8,), studies=60, between=1, differing=0.7)
    table = power(question, ONE)
    rows = {row.compared: row.power for row in table.rows}
    assert rows["condition: T0 less T100"] > 0.9
    assert rows["condition: T0 less T25"] < 0.15
    assert "between people by 0.99" in dict(table.about)["people differ"]


def test_catch_trials_belong_to_no_condition():
    text = load_protocol("letters").text
    watched = text.replace("[design]\n", "[design]\ncatch = { every = 4 }\n", 1)
    assert watched != text
    protocol = parse_protocol(watched, "letters.toml")
    assert any(trial.catch for trial in make_plan(protocol, "P1", 1).trials)
    assert replace(QUESTION, protocol=protocol).plan().trials == QUESTION.plan().trials


def shares_of(question):
    """Mean share of right answers in each condition of simulated studies."""
    plan = question.plan()
    made = simulate(StudyTask(plan, 1, 0, 400))
    return (made.sum(axis=(0, 1)) / (400 * np.array(plan.trials).sum(axis=0))).tolist()


def test_lapses_are_answered_by_chance_and_false_alarms_whatever_is_felt():
    attended = shares_of(QUESTION)
    lapsing = shares_of(replace(QUESTION, lapses=0.2))
    assert lapsing == pytest.approx([0.8 * share for share in attended], abs=0.01)
    shipped = load_protocol("same-different")
    judged = structs.replace(shipped, analysis=structs.replace(shipped.analysis, measure="right"))
    name = names_of(judged, judged.planned_analysis)[0]
    question = PowerQuestion(judged, {name: "0.7"}, (6,), between=0.4)
    differ = np.mean([
        judged.asks.has_signal(trial) for trial in make_plan(judged, "P1", 1).trials
    ])  # fmt: skip
    # A tenth is said to differ, and is right where it does; of the rest, a fifth is chance.
    told = replace(question, lapses=0.2, false_alarms=0.1)
    assert shares_of(told) == pytest.approx(
        [0.2 * 0.5 + 0.8 * (0.1 * differ + 0.9 * 0.7)], abs=0.01
    )
    assert "20 % of lapses and 10 % of false alarms" in dict(power(told, ONE).about)["assumed"]


def test_rows_are_of_each_size_and_pair_with_what_is_enough():
    table = power(replace(QUESTION, sizes=(4, 6, 30)), ONE)
    assert [(row.participants, row.compared) for row in table.rows[4:8]] == [
        (6, "condition"),
        (6, "condition: T0 less T25"),
        (6, "condition: T0 less T100"),
        (6, "condition: T25 less T100"),
    ]
    assert table.enough()["condition: T0 less T100"] in (6, 30)
    assert table.enough(1.01)["condition: T0 less T100"] is None
    row = table.rows[0]
    assert row.low < row.power < row.high
    assert row.studies == 300
    assert table.to_json()["rows"][0]["power"] == row.power


def test_an_odds_ratio_gives_the_other_shares():
    analysis = LETTERS.planned_analysis
    shares = values_of(LETTERS, analysis, {"T25": "0.5", "odds-ratio": "3"})
    assert shares == {"T0": 0.75, "T25": 0.5, "T100": 0.75}


@heavy  # by a closed form it is tested above
def test_power_of_a_crossed_design_is_that_of_an_independent_simulation():
    """2 × 3 within people, and 2 groups; bench_power has as many studies as 1.5 points need."""
    studies = by_tier(150, 2000, 10_000)
    off, compared = off_by(studies)
    assert off <= 0.01 + 3.5 * math.sqrt(0.5 / studies), compared


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
        ({"effect": EFFECT | {"odds-ratio": "2"}}, "an odds ratio and 3 values"),
        ({"effect": {"T0": "0.5", "odds-ratio": "0"}}, "odds-ratio is 0; it must be 0.001 to"),
        ({"sizes": (2, 3)}, "one is 2; it must be 3 to 500"),
        ({"studies": 0}, "is 0; it must be 1 to"),
        ({"between": -1.0}, "is -1 log odds; it must be 0 to 5 log odds"),
        ({"protocol": load_protocol("control")}, "condition T0, which control does not have"),
        ({"protocol": load_protocol("rating"), "between": 0.0}, "people would not differ"),
        (
            {"protocol": load_protocol("detection"), "effect": {"threshold": "0"}},
            "threshold is 0; it must be above 0|blank is 0; it must be above 0",
        ),
        (
            {"protocol": load_protocol("factors"), "effect": {"far:flat-low": "0.5"}},
            "and a group before a colon",
        ),
        (
            {"protocol": load_protocol("icons"), "effect": {"all": "0.5"}},
            "circle-upright-2-mm",
        ),
        ({"lapses": 1.5}, "lapses are 1.5"),
        ({"false_alarms": 0.1}, "false alarms are of the questions detect and same-different"),
        (
            {"protocol": load_protocol("rating"), "lapses": 0.1},
            "lapses and false alarms are of shares",
        ),
    ],
)  # fmt: skip
def test_what_cannot_be_asked_is_refused_in_a_sentence(changed, sentence):
    with pytest.raises(InputError, match=sentence):
        power(replace(QUESTION, **changed), ONE)
