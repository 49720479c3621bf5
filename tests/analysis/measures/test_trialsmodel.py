"""Trials by a logistic model: what its tables say of trials in a few words."""

import numpy as np
import pandas as pd
import pytest

from tests.analysis.making import from_rows, made, record
from vbraille.analysis.input.parsing import parse
from vbraille.analysis.measures.trialsmodel import covariates, trials_model

CONDITIONS = {"T0": 0.4, "T25": 0.6, "T100": 0.9}


def study(people=6, trials=20, conditions=CONDITIONS, seed=1, covered=True):
    """Trials of a few people whose share of right answers is that of the condition."""
    random = np.random.default_rng(seed)
    rows = [
        {
            "participant": f"P{who}",
            "condition": name,
            "presented": "abc"[number % 3],
            "answered": "abc"[number % 3] if random.random() < share else "z",
            "block": str(1 + number // 10) if covered else "",
        }
        for who in range(people)
        for number in range(trials)
        for name, share in conditions.items()
    ]
    return parse([from_rows("made", rows)]).trials


def tables(trials, correction="holm", factors=("condition",)):
    means, _, contrasts = trials_model(trials, factors, correction)
    return means, contrasts, covariates(trials, factors)


def effects(trials, *factors):
    return trials_model(trials, factors or ("condition",), "holm")[1]


def test_means_are_the_shares_of_balanced_trials():
    trials = study()
    means, contrasts, _ = tables(trials)
    assert [row["condition"] for row in means.records()] == ["T0", "T25", "T100"]
    for name in CONDITIONS:
        right = trials.loc[trials["condition"] == name, "correct"]
        row = record(means, condition=name)
        assert row["legibility"] == pytest.approx((right.sum() + 0.5) / (right.size + 1))
        assert row["low"] < row["legibility"] < row["high"]
        assert (row["participants"], row["trials"], row["note"]) == (6, 120, "")
    row = record(contrasts, first="T0", second="T100")
    odds = [s / (1 - s) for s in (record(means, condition=c)["legibility"] for c in ("T0", "T100"))]
    assert row["odds_ratio"] == pytest.approx(odds[0] / odds[1])
    assert row["low_together"] < row["low"] < row["odds_ratio"] < row["high"] < row["high_together"]
    assert row["difference_high"] < 0
    assert row["d"] == pytest.approx(np.log(row["odds_ratio"]) * 0.551329, abs=1e-5)
    assert row["p"] < row["p_corrected"] < 0.05


def test_corrections_are_those_that_are_asked_for():
    trials = study()
    plain = tables(trials, "none")[1].frame
    three = tables(trials, "bonferroni")[1].frame
    np.testing.assert_allclose(plain["p"], plain["p_corrected"])
    np.testing.assert_allclose(np.minimum(3 * plain["p"], 1), three["p_corrected"])


def test_who_misses_a_condition_still_counts():
    trials = study()
    lacking = (trials["participant"] == "P0") & (trials["condition"] == "T0")
    means, contrasts, _ = tables(trials[~lacking].reset_index(drop=True))
    assert record(means, condition="T0")["participants"] == 5
    assert record(contrasts, first="T0", second="T25")["participants"] == 6


def test_groups_between_participants_are_compared():
    trials = study(8, conditions={"T0": 0.5})
    group = trials["participant"].isin(["P0", "P1", "P2", "P3"]).map({True: "old", False: "new"})
    means, contrasts, _ = tables(trials.assign(group=group), factors=("group",))
    assert [row["participants"] for row in means.records()] == [4, 4]
    (row,) = contrasts.records()
    assert row["participants"] == 8
    assert 3 < row["df"] <= 6.01
    (row,) = effects(trials.assign(group=group), "group").records()
    assert (row["effect"], row["participants"], row["df1"]) == ("group", 8, 1)


def test_factors_and_their_interaction_are_tested():
    """One of two factors acts, and only at one level of the other."""
    random = np.random.default_rng(4)
    shares = {("T0", "V1"): 0.5, ("T0", "V2"): 0.5, ("T1", "V1"): 0.5, ("T1", "V2"): 0.95}
    rows = [
        {
            "participant": f"P{who}", "condition": texture, "speed": speed, "presented": "a",
            "answered": "a" if random.random() < share else "z",
        }
        for who in range(8) for (texture, speed), share in shares.items() for _ in range(30)
    ]  # fmt: skip
    trials = parse([from_rows("made", rows)]).trials
    table = effects(trials, "condition", "speed")
    assert [row["effect"] for row in table.records()] == [
        "condition", "speed", "condition × speed",
    ]  # fmt: skip
    assert {row["df1"] for row in table.records()} == {1}
    assert record(table, effect="condition × speed")["p"] < 0.01
    one = trials[(trials["condition"] == "T0") | (trials["speed"] == "V1")].reset_index(drop=True)
    part = effects(one, "condition", "speed")
    row = record(part, effect="condition")
    assert row["note"].startswith("over the 1 of 2 combinations of the other factors")
    assert row["p"] > 0.05
    row = record(part, effect="condition × speed")
    assert row["p"] is None
    assert row["note"] == "no test: no combination of the other factors has all of its levels"


def test_several_levels_are_tested_at_once():
    (row,) = effects(study()).records()
    assert (row["df1"], row["trials"]) == (2, 360)
    assert row["p"] < 0.01
    (row,) = effects(study(conditions=dict.fromkeys(CONDITIONS, 0.5), seed=3)).records()
    assert row["p"] > 0.05


def test_factors_are_crossed():
    means, contrasts, _ = tables(study(), factors=("condition", "block"))
    assert record(means, condition="T0, 1")["trials"] == 60
    assert len(contrasts) == 15


def test_covariates_tell_of_a_decline():
    """One more block takes away what makes the answers right, and nothing else does."""
    random = np.random.default_rng(5)
    rows = [
        {
            "participant": f"P{who}",
            "condition": "T0",
            "presented": "ag"[number % 2],
            "answered": "ag"[number % 2] if random.random() < 0.9 - 0.2 * block else "z",
            "block": str(block + 1),
        }
        for who in range(8)
        for block in range(4)
        for number in range(20)
    ]
    _, contrasts, found = tables(parse([from_rows("made", rows)]).trials)
    assert contrasts.notes == ("T0 alone; nothing to compare",)
    assert [row["covariate"] for row in found.records()] == [
        "10 trials later in the session",
        "a block later",
        "a dot more in each cell",
    ]
    dots = record(found, covariate="a dot more in each cell")
    assert dots["low"] < 1 < dots["high"]
    assert (dots["trials"], dots["participants"]) == (640, 8)


def test_who_reads_slowly_reads_better():
    """Answers are right by the time taken, which is on the scale of a doubling."""
    random = np.random.default_rng(6)
    rows = []
    for who in range(8):
        for _ in range(60):
            doubled = random.normal()
            right = random.random() < 1 / (1 + np.exp(-1.2 * doubled))
            rows.append({
                "participant": f"P{who}", "condition": "T0", "presented": "ab",
                "answered": "ab" if right else "zz", "duration_s": f"{3 * 2**doubled:.4f}",
            })  # fmt: skip
    found = tables(parse([from_rows("made", rows)]).trials)[2]
    row = record(found, covariate="twice the time for each cell")
    assert 1 < row["low"] < np.exp(1.2) < row["high"]
    for at in range(10):
        rows[at]["duration_s"] = ""
    part = tables(parse([from_rows("made", rows)]).trials)[2]
    assert part.notes == ("without 10 of 480 trials, whose duration is not known",)
    assert record(part, covariate="twice the time for each cell")["trials"] == 470
    for at in range(300):
        rows[at]["duration_s"] = ""
    rest = tables(parse([from_rows("made", rows)]).trials)[2]
    assert [row["covariate"] for row in rest.records()] == ["10 trials later in the session"]
    assert rest.records()[0]["trials"] == 480


def test_where_no_block_is_given_there_is_none():
    assert not any("block" in row["covariate"] for row in tables(study(covered=False))[2].records())


def test_all_right_is_said():
    trials = study(conditions={"T0": 1.0, "T25": 0.5})
    (row,) = tables(trials)[1].records()
    assert row["note"] == "everything is right in T0: the odds are Firth's finite ones"
    assert 1 < row["low"] < row["odds_ratio"]
    assert 0 < row["difference_low"] < row["difference"] < row["difference_high"] < 1


def test_two_participants_have_no_interval():
    means, contrasts, covariates = tables(study(2))
    reason = "no interval: two participants; how people differ is seen of three or more"
    assert {row["note"] for row in means.records()} == {reason}
    assert {row["note"] for row in contrasts.records()} == {reason}
    assert covariates.notes[0].startswith("no covariates: two participants")


def test_participants_all_alike_have_none_either():
    trials, _ = made(*(f"P{n} {c} ac ac 2" for n in range(4) for c in ("T0", "T25")))
    means, contrasts, _ = tables(trials)
    assert all(0 < row["low"] < row["legibility"] <= row["high"] for row in means.records())
    assert "do not differ" in contrasts.records()[0]["note"]
    assert contrasts.records()[0]["odds_ratio"] == pytest.approx(1)


def test_many_conditions_have_no_contrasts():
    names = {f"C{n}": 0.5 for n in range(13)}
    contrasts = tables(study(3, 2, names))[1]
    assert contrasts.notes == ("13 conditions; the pairs of more than 12 are not told",)


def test_the_order_of_the_trials_of_others_is_of_no_matter():
    trials = study()
    first = tables(trials)[1].frame
    turned = trials.sort_values("condition", kind="stable").reset_index(drop=True)
    pd.testing.assert_frame_equal(first, tables(turned)[1].frame)
