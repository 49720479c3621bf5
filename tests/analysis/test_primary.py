"""The primary analysis follows the plan, says where it does not, and is the headline."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from tests.sessions.sittings import MINI, Session
from vbraille.analysis import analyse
from vbraille.analysis.chapters import Options, plan_of
from vbraille.analysis.input.study import excluding, load_study
from vbraille.errors import InputError
from vbraille.sessions.planning.analysis import PlannedAnalysis
from vbraille.sessions.planning.protocolfiles import builtin_names, load_protocol

FACTORS = """
[[factors]]
name = "texture"
levels = [{ name = "flat", texture = 0.0 }, { name = "rough", texture = 1.0 }]
[[factors]]
name = "gap"
between = true
levels = [{ name = "near", cell_gap_mm = 6.0 }, { name = "far", cell_gap_mm = 7.0 }]
"""
PLANNED = """
[analysis]
measure = "legibility"
factors = ["texture", "gap"]
correction = "bonferroni"
participants = 5
stop = "after the fifth"
"""


def written(path, rows, columns="participant,condition,presented,answered"):
    path.write_text("\n".join([columns, *(",".join(map(str, row)) for row in rows)]) + "\n")
    return path


def shares(random, people, conditions, trials=20):
    """Trials of letters that are read right with a share of each condition."""
    return [
        (f"P{who}", name, "ab", "ab" if random.random() < share else "ac")
        for who in range(people)
        for name, share in conditions.items()
        for _ in range(trials)
    ]


def study_of(protocol, people=2, state="ended"):
    """A study of as many sessions, as far as its plan needs them."""
    sessions = tuple(
        SimpleNamespace(
            protocol=protocol,
            head={"participant": f"P{who}", "protocol": protocol.name},
            state=state,
            name=f"s{who}",
            rows=[],
        )
        for who in range(people)
    )
    columns = [
        "condition",
        *map(protocol.planned_analysis.column, protocol.planned_analysis.factors),
    ]
    frame = pd.DataFrame(
        {"participant": ["P0", "P1"], "protocol": protocol.name}
        | {name: ["one", "two"] for name in columns}
    )
    return SimpleNamespace(
        sessions=sessions, trials=frame, comparisons=None, judgements=None, left_out=()
    )


@pytest.fixture(scope="module")
def sessions(tmp_path_factory):
    """Four people in two groups, in sessions that plan their analysis."""
    folder = tmp_path_factory.mktemp("planned")
    for number in range(1, 5):
        name = f"P{number}"
        Session(folder / name, MINI + FACTORS + PLANNED, name, seed=number).sit(noise=0.9)
    return [folder / f"P{number}" for number in range(1, 5)]


@pytest.mark.parametrize("name", builtin_names())
def test_each_shipped_protocol_is_followed_without_options(name):
    protocol = load_protocol(name)
    planned = protocol.planned_analysis
    found = plan_of(study_of(protocol, planned.participants), Options())
    assert found.analysis == planned
    assert found.columns == tuple(map(planned.column, planned.factors))
    assert found.departures == ()


def test_each_departure_is_said():
    protocol = load_protocol("factors")
    chosen = Options(factors=("condition",), correction="none")
    found = plan_of(study_of(protocol, 2, "stopped"), chosen)
    told = " ".join(found.departures)
    for said in ("12 participants", "Not ended: s0, s1", "Compared by condition", "no correction"):
        assert said in told


def test_the_plan_is_followed_and_is_the_headline(sessions):
    results = analyse(sessions)
    assert "legibility of strings by texture × gap" in results.question[0]
    assert "Planned were 5 participants, and here are 4." in results.question
    table = results.table("primary")
    assert table["kind"].tolist().count("effect") == 3
    named = set(table["of"])
    for name in ("flat, far", "texture × gap", "texture: flat less rough", "gap: far less near"):
        assert name in named
    assert "Bonferroni" in results.methods
    assert results.main == "primary"
    assert next(iter(results.tables)) == "primary"


def test_all_else_is_exploratory_and_corrected_together(sessions):
    results = analyse(sessions)
    raw, corrected = [], []
    for name, table in results.tables.items():
        for column in (c for c in table if c.endswith("p_corrected") and name != "primary"):
            known = table[[column.removesuffix("_corrected"), column]].dropna()
            raw += known.iloc[:, 0].tolist()
            corrected += known.iloc[:, 1].tolist()
    assert len(raw) > 3
    assert corrected == pytest.approx([min(1.0, p * len(raw)) for p in raw])


def test_what_is_planned_to_be_left_out_is(sessions):
    study = load_study(sessions)
    durations = study.trials["duration_s"]
    middle = float(durations.median())
    kept = excluding(study, PlannedAnalysis(too_fast_s=middle))
    assert len(kept.trials) == (~(durations < middle)).sum() < len(study.trials)
    assert "less than" in kept.left_out[-1].reason
    with pytest.raises(InputError, match="excludes all trials"):
        excluding(study, PlannedAnalysis(too_slow_s=1e-6))


def test_people_who_fail_catch_trials_are_left_out(sessions):
    study = load_study(sessions)
    for session in study.sessions:
        right = session.head["participant"] != "P2"
        session.rows.append({"catch": "blank", "answered": "?", "correct": int(right)})
    kept = excluding(study, PlannedAnalysis(catch_right=0.5))
    assert "P2" not in set(kept.trials["participant"])
    assert kept.left_out[-1].what == "participant P2"
    assert {session.head["participant"] for session in kept.sessions} == {"P1", "P3", "P4"}


def test_two_people_have_tables_and_no_test(tmp_path):
    rows = shares(np.random.default_rng(1), 2, {"x": 0.4, "y": 0.8})
    results = analyse(written(tmp_path / "two.csv", rows))
    assert results.table("primary")["p"].isna().all()
    assert "nothing is tested" in results.findings[1]
    assert not any("p =" in said for said in results.findings)


def test_a_difference_is_told_with_interval_effect_size_and_both_kinds_of_people(tmp_path):
    rows = shares(np.random.default_rng(2), 8, {"x": 0.3, "y": 0.8})
    results = analyse(written(tmp_path / "eight.csv", rows))
    assert "these 8 participants" in results.findings[0]
    assert "people like them" in results.findings[0]
    assert "a difference by condition is shown" in results.findings[1]
    assert "points" in results.findings[2]
    assert results.shown.headings[3] == "odds ratio"
    row = results.table("primary").iloc[-1]
    assert row["low"] < row["value"] < row["high"] < 0


def test_the_ceiling_and_chance_are_said(tmp_path):
    rows = shares(np.random.default_rng(3), 4, {"x": 0.5, "y": 1.0})
    told = " ".join(analyse(written(tmp_path / "all.csv", rows)).findings)
    assert "everything right" in told
    assert "4 of 4 in y" in told
    assert "Guessing among the 1 string" in told


def test_right_answers_alone_are_timed(tmp_path):
    columns = "participant,condition,presented,answered,duration_s"
    rows = [
        (f"P{who}", name, "ab", answer, seconds)
        for who in range(4)
        for name in "xy"
        for answer, seconds in (("ab", 2 + who / 10), ("ab", 2 + who / 10), ("ac", 50))
    ]
    table = analyse(written(tmp_path / "timed.csv", rows, columns)).table("exploratory")
    means = table[(table["measure"] == "duration of right answers") & (table["kind"] == "mean")]
    assert means["value"].tolist() == pytest.approx([2.147, 2.147], abs=0.002)


@pytest.mark.parametrize("question", ["detect", "same-different"])
def test_d_prime_has_the_value_of_a_group(tmp_path, question):
    random = np.random.default_rng(4)
    words = ("yes", "no") if question == "detect" else ("different", "same")
    columns = "participant,condition,presented,answered,question,group"
    rows = [
        (f"P{who}", "all", words[kind], words[int(random.random() < (0.2, 0.8)[kind])], question,
         "near" if who % 2 else "far")
        for who in range(8) for kind in range(2) for _ in range(30)
    ]  # fmt: skip
    path = written(tmp_path / "told.csv", rows, columns)
    table = analyse(path, factors=["group"]).table("primary")
    assert set(table["measure"]) == {"d′"}
    means = table[table["kind"] == "mean"]
    assert means["of"].tolist() == ["far", "near"]
    assert (means["low"] < means["value"]).all()
    (difference,) = table[table["kind"] == "difference"].itertuples()
    assert difference.low < difference.value < difference.high


def test_thresholds_have_the_value_of_each_group(tmp_path):
    random = np.random.default_rng(5)
    columns = "participant,condition,presented,answered,question,contrast,group"
    rows = []
    for who in range(6):
        middle = 0.2 if who % 2 else 0.4
        for contrast in (0.0, 0.1, 0.2, 0.3, 0.4, 0.6, 0.8):
            for _ in range(20):
                share = 0.05 + 0.9 / (1 + np.exp(-(contrast - middle) / 0.05)) * (contrast > 0)
                said = "yes" if random.random() < share else "no"
                there = "yes" if contrast else "no"
                group = "near" if who % 2 else "far"
                rows.append((f"P{who}", "all", there, said, "detect", contrast, group))
    path = written(tmp_path / "felt.csv", rows, columns)
    table = analyse(path, factors=["group"]).table("exploratory")
    means = table[table["measure"].str.startswith("threshold") & (table["kind"] == "mean")]
    assert means["participants"].tolist() == [6]
    assert 0.2 < means["value"].iloc[0] < 0.4


def test_an_adaptive_tuning_has_the_value_of_its_group(tmp_path):
    random = np.random.default_rng(6)
    rows = []
    for who in range(4):
        liked = 1.5 + 0.1 * who
        for _ in range(60):
            pair = random.uniform(0.5, 3.0, 2).round(2)
            near = np.abs(pair - liked + random.normal(0, 0.1, 2)).argmin()
            rows.append((f"P{who}", "all", f"{pair[0]} {pair[1]}", pair[near], "dot_width_mm"))
    columns = "participant,condition,presented,answered,parameter"
    results = analyse(written(tmp_path / "tuned.csv", rows, columns))
    row = results.table("primary").iloc[0]
    assert row["low"] < 1.65 < row["high"]
    assert row["value"] == pytest.approx(1.65, abs=0.1)
    assert " mm" in results.findings[0]
