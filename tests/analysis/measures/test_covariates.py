"""Covariates of right answers, in trials of a few words each."""

import numpy as np

from tests.analysis.making import from_rows, record
from vbraille.analysis.input.parsing import parse
from vbraille.analysis.measures.covariates import covariates

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
    found = covariates(parse([from_rows("made", rows)]).trials, ["condition"])
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
    found = covariates(parse([from_rows("made", rows)]).trials, ["condition"])
    row = record(found, covariate="twice the time for each cell")
    assert 1 < row["low"] < np.exp(1.2) < row["high"]
    for at in range(10):
        rows[at]["duration_s"] = ""
    part = covariates(parse([from_rows("made", rows)]).trials, ["condition"])
    assert part.notes == ("without 10 of 480 trials, whose duration is not known",)
    assert record(part, covariate="twice the time for each cell")["trials"] == 470
    for at in range(300):
        rows[at]["duration_s"] = ""
    rest = covariates(parse([from_rows("made", rows)]).trials, ["condition"])
    assert [row["covariate"] for row in rest.records()] == ["10 trials later in the session"]
    assert rest.records()[0]["trials"] == 480


def test_where_no_block_is_given_there_is_none():
    found = covariates(study(covered=False), ["condition"])
    assert not any("block" in row["covariate"] for row in found.records())


def test_two_participants_have_none():
    found = covariates(study(2), ["condition"])
    assert found.notes[0].startswith("no covariates: two participants")
