"""Trials by a logistic model: what its tables say of trials in a few words."""

import numpy as np
import pandas as pd
import pytest

from tests.analysis.making import made, record
from vbraille.analysis.input.parsing import parse
from vbraille.analysis.input.sheets import from_rows
from vbraille.analysis.measures.trialsmodel import trials_model

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
    return trials_model(trials, factors, correction)


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


def test_where_no_block_is_given_there_is_none():
    assert not any("block" in row["covariate"] for row in tables(study(covered=False))[2].records())


def test_all_right_is_said():
    trials = study(conditions={"T0": 1.0, "T25": 0.5})
    (row,) = tables(trials)[1].records()
    assert row["note"] == (
        "everything is right in T0: the odds are Firth's finite ones; "
        "no interval of the difference: all are alike in one of them"
    )
    assert 1 < row["low"] < row["odds_ratio"]


def test_two_participants_have_no_interval():
    means, contrasts, covariates = tables(study(2))
    reason = "no interval: two participants; how people differ is seen of three or more"
    assert {row["note"] for row in means.records()} == {reason}
    assert {row["note"] for row in contrasts.records()} == {reason}
    assert covariates.notes[0].startswith("no covariates: two participants")


def test_participants_all_alike_have_none_either():
    trials, _ = made(*(f"P{n} {c} ac ac 2" for n in range(4) for c in ("T0", "T25")))
    means, contrasts, _ = tables(trials)
    assert {row["low"] for row in means.records()} == {None}
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
