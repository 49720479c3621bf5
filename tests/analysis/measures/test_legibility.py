"""Legibility and duration by participant and condition, and their averages."""

from statistics import fmean, stdev

import pytest

from tests.analysis.making import answers, made, record
from vbraille.analysis.measures.legibility import averages, legibility
from vbraille.analysis.statistics.intervals import mean_share, wilson


def found(*lines):
    return legibility(*made(*lines))


def test_of_each_participant_and_condition():
    table = found(
        "P1 T0 ac ac 2", "P1 T0 ac aa 3", "P1 T0 ca ca 7", "P1 T0 ca ?? -",
        "P1 T25 ac aa 4", "P2 T25 ac ac 5", "P2 T0 ac ac 6",
    )  # fmt: skip
    row = record(table, participant="P1", condition="T0")
    interval = wilson(2, 4)
    assert row == {
        "participant": "P1",
        "condition": "T0",
        "trials": 4,
        "correct": 2,
        "legibility": 0.5,
        "low": interval.low,
        "high": interval.high,
        "characters": 8,
        "characters_correct": 5,
        "character_legibility": 5 / 8,
        "timed": 3,
        "duration_mean_s": 4.0,
        "duration_sd_s": pytest.approx(stdev([2, 3, 7])),
        "note": "",
    }
    assert [row[:2] for row in table.rows] == [
        ("P1", "T0"),
        ("P1", "T25"),
        ("P2", "T0"),
        ("P2", "T25"),
    ]
    assert table.notes == ()


def test_a_participant_without_a_condition_has_a_row_that_says_so():
    table = found("P1 T0 a a 2", "P1 T25 a a 3", "P2 T25 a a 3")
    row = record(table, participant="P2", condition="T0")
    assert (row["trials"], row["correct"], row["characters"], row["timed"]) == (0, 0, 0, 0)
    assert row["legibility"] is row["low"] is row["duration_mean_s"] is None
    assert row["note"] == "no trials in this condition"


@pytest.mark.parametrize(
    ("lines", "share", "ends"),
    [(["P1 T0 a a"] * 5, 1.0, wilson(5, 5)), (["P1 T0 a c"] * 5, 0.0, wilson(0, 5)),
     (["P1 T0 a ?"] * 5, 0.0, wilson(0, 5))],
    ids=["all right", "all wrong", "nothing read"],
)  # fmt: skip
def test_all_alike_leaves_an_interval(lines, share, ends):
    row = record(legibility(*answers(*lines)), participant="P1")
    assert (row["legibility"], row["character_legibility"]) == (share, share)
    assert (row["low"], row["high"]) == (ends.low, ends.high)
    assert ends.high - ends.low > 0.4


@pytest.mark.parametrize(
    ("lines", "mean_s", "note"),
    [
        (["P1 T0 a a 2", "P1 T0 a a -"], 2.0, "one duration: no SD"),
        (["P1 T0 a a -"], None, "no duration is known"),
        (["P1 T0 a ac 2", "P1 T0 a ca 2"], 2.0, "no answer has as many places as its string"),
    ],
)
def test_what_is_missing_has_a_reason(lines, mean_s, note):
    row = record(found(*lines), participant="P1")
    assert (row["duration_mean_s"], row["note"]) == (mean_s, note)


def test_answers_of_another_length_are_wrong_and_no_part_of_characters():
    table = found("P1 T0 ac a 1", "P1 T0 ac acc 1", "P1 T0 ac aa 1")
    row = record(table, participant="P1")
    assert (row["trials"], row["correct"], row["characters"]) == (3, 0, 2)
    assert row["character_legibility"] == 0.5
    assert table.notes == (
        "2 answers of another number of places than was presented: wrong as a string, and no part "
        "of what is said of characters",
    )
    assert found("P1 T0 ac a 1").notes[0].startswith("1 answer of another")


def test_averages_are_over_the_participants_own_means():
    table = found(
        "P1 T0 ac ac 2", "P1 T0 ac ac 4", "P1 T0 ac ac 6", "P1 T0 ac aa 8", "P2 T0 ac aa 10",
        "P3 T0 ac ca 3", "P3 T25 ac ac 1",
    )  # fmt: skip
    row = record(averages(table), condition="T0")
    interval = mean_share([0.75, 0.0, 0.0], [4, 1, 1])
    assert row == {
        "condition": "T0",
        "participants": 3,
        "trials": 2,
        "legibility": 0.25,
        "low": interval.low,
        "high": interval.high,
        "character_legibility": fmean([7 / 8, 0.5, 0]),
        "duration_mean_s": fmean([5.0, 10.0, 3.0]),
        "note": "",
    }
    alone = record(averages(table), condition="T25")
    assert (alone["participants"], alone["legibility"], alone["low"]) == (1, 1.0, None)
    assert alone["note"] == (
        "no interval: one participant; how people differ is seen of three or more"
    )


def test_an_average_says_whom_it_lacks():
    table = found("P1 T0 ac ac 2", "P2 T0 ac ac -", "P1 T25 ac a -", "P2 T25 ac a -")
    some, none = averages(table).records()
    few = "no interval: two participants; how people differ is seen of three or more"
    assert (some["duration_mean_s"], some["note"]) == (2.0, f"{few}; durations of 1 participant")
    assert some["low"] is some["high"] is None
    assert none["character_legibility"] is none["duration_mean_s"] is None
    assert none["note"] == (
        f"{few}; no legibility of characters: no answer has as many places as its string; "
        "no duration: none is known"
    )
