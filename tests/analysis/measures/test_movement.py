"""How strings were read, as tables: from readings made by hand, and from a session."""

from dataclasses import fields

import numpy as np
import pytest
from scipy import stats

from tests.analysis.making import made, record
from tests.sessions.sittings import Session
from vbraille.analysis.input.sessions import (
    IN_PART,
    ONE_PASS,
    RESCAN,
    Reading,
    SessionTrials,
    read_session,
)
from vbraille.analysis.measures.movement import correlations, patterns, trajectories
from vbraille.analysis.statistics.intervals import correlation_interval
from vbraille.sessions.record.export import NEVER_CAME


def reading(pattern=ONE_PASS, duration_s=4.5, passes=1, right=20.0, left=80.0):
    return Reading(pattern, duration_s, left is not None, passes, 0, right, left)


def sitting(readings, who="P1", conditions=("T0",), session="s1"):
    """A session of as many trials as there are readings, its conditions in turns."""
    rows = [
        {
            "participant": who,
            "condition": conditions[n % len(conditions)],
            "session": session,
            "trial": n + 1,
            "presented": "⠁⠈",
            "paused_s": 0.0,
            "early": 0,
        }
        for n in range(len(readings) + 1)  # the last is not read
    ]
    nothing = dict.fromkeys(field.name for field in fields(SessionTrials))
    return SessionTrials(**nothing | {"rows": rows, "readings": dict(enumerate(readings, 1))})


def test_a_row_a_trial_with_what_the_hand_did():
    table = trajectories([sitting([reading(), NEVER_CAME, reading(IN_PART, 2.0, 0, 3.5, None)])])
    first, second, third = table.records()
    assert first == {
        "participant": "P1",
        "condition": "T0",
        "session": "s1",
        "trial": 1,
        "presented": "a, dot 4",
        "duration_s": 4.5,
        "returned": 1,
        "passes": 1,
        "rescans": 0,
        "speed_right_mm_s": 20.0,
        "speed_left_mm_s": 80.0,
        "pattern": ONE_PASS,
        "note": "",
    }
    assert (second["trial"], second["duration_s"], second["pattern"]) == (2, None, None)
    assert second["note"] == "the hand never came to the first dot"
    assert (third["returned"], third["speed_left_mm_s"]) == (0, None)
    assert third["note"] == "no stroke to the left"
    neither = trajectories([sitting([reading(right=None, left=None)])]).records()[0]
    assert neither["note"] == "no stroke to the right; no stroke to the left"


def test_patterns_are_counted_by_participant_and_condition():
    table = trajectories(
        [
            sitting([reading(RESCAN, passes=0, right=5.0, left=None), NEVER_CAME], "P10"),
            sitting([reading(), reading(RESCAN, passes=0, right=30.0)] * 2, conditions=("T25",)),
            sitting([reading(passes=3, left=None), reading()], conditions=("T0", "T25")),
        ]
    )
    found = patterns(table)
    assert [row[:3] for row in found.rows] == [("P1", "T0", 1), ("P1", "T25", 5), ("P10", "T0", 1)]
    both = record(found, participant="P1", condition="T25")
    names = ("one_pass", "two_passes", "more_passes", "rescan", "in_part")
    assert [both[name] for name in names] == [3, 0, 0, 2, 0]
    assert both["passes"] == pytest.approx(3 / 5)
    assert both["speed_right_mm_s"] == pytest.approx((3 * 20 + 2 * 30) / 5)
    assert (both["speed_left_mm_s"], both["note"]) == (80.0, "")
    alone = record(found, participant="P10")
    assert (alone["speed_left_mm_s"], alone["note"]) == (None, "no stroke to the left")


@pytest.mark.parametrize("sittings", [[], [sitting([])], [sitting([NEVER_CAME])]])
def test_without_readings_there_are_no_patterns(sittings):
    table = trajectories(sittings)
    assert patterns(table).rows == ()
    assert patterns(table).notes == ("no trial has a trajectory",)
    assert table.notes == (() if table.rows else ("no trial has a trajectory",))


def test_a_session_that_was_sat(tmp_path):
    session = Session(tmp_path / "s", hand="sweep:60")
    session.sit()
    sat = read_session(session.folder)
    table = trajectories([sat])
    assert table.frame["trial"].tolist() == [1, 2, 3, 4]
    assert sorted(table.frame["presented"].tolist()) == ["a", "blank", "c", "dot 4"]
    durations = [row["duration_s"] for row in sat.rows]
    assert table.frame["duration_s"].tolist() == pytest.approx(durations, abs=1e-6)
    row = record(patterns(table), participant="P1")
    assert (row["trials"], row["one_pass"], row["passes"]) == (4, 4, 1.0)
    assert row["speed_right_mm_s"] == pytest.approx(60, rel=0.01)


TIMED = [
    "P1 T0 ac ac 1", "P1 T0 ac aa 2", "P1 T0 ca ca 4", "P1 T0 ca cc 7", "P1 T0 ca ca -",
    "P2 T0 ac ac 3", "P2 T0 cc ac 9", "P2 T25 ac ac 4", "P3 T25 cc cc 5", "P3 T25 aa cc 6",
]  # fmt: skip


def test_duration_goes_with_legibility_of_trials_strings_and_participants():
    table = correlations(made(*TIMED)[0])
    told = [(r["of"], r["participant"], r["condition"], r["n"]) for r in table.records()]
    assert told == [
        ("trials", "P1", "T0", 4),
        ("trials", "P2", "T0", 2),
        ("trials", "P2", "T25", 1),
        ("trials", "P3", "T25", 2),
        ("strings", "all", "all", 4),
        ("participants", "all", "all", 3),
    ]
    for of, duration, correct in (
        ("trials", [1, 2, 4, 7], [1, 0, 1, 0]),
        ("strings", [10 / 4, 11 / 2, 14 / 2, 6], [3 / 4, 1 / 2, 1 / 2, 0]),
        ("participants", [14 / 4, 16 / 3, 11 / 2], [1 / 2, 2 / 3, 1 / 2]),
    ):
        row = record(table, of=of, n=len(duration))
        theirs = stats.pearsonr(duration, correct)
        assert (row["r"], row["p"]) == pytest.approx((theirs.statistic, theirs.pvalue))
        if of == "strings":
            assert (row["low"], row["note"]) == (
                None,
                "no interval: the same people read all strings",
            )
        elif len(duration) > 3:
            ends = correlation_interval(duration, correct)
            assert (row["low"], row["high"]) == pytest.approx((ends.low, ends.high))
        else:
            assert (row["low"], row["note"]) == (None, "no interval of 3 participants")


@pytest.mark.parametrize(
    ("lines", "of", "note"),
    [
        (["P1 T0 a a 1", "P1 T0 a c 2"], "trials", "2 trials: a correlation needs three"),
        (["P1 T0 a a 1", "P1 T0 a c 2"], "strings", "1 string: a correlation needs three"),
        (["P1 T0 a a 1"] * 3, "participants", "1 participant: a correlation needs three"),
        (
            [f"P1 T0 a a {n}" for n in range(3)],
            "trials",
            "legibility is the same in all trials",
        ),
        (
            [f"P1 T0 a {answer} 0.1" for answer in "aac"],
            "trials",
            "duration is the same in all trials",
        ),
        (
            [f"P{n} T0 {s} {s} {n}" for n, s in enumerate("acb")],
            "participants",
            "legibility is the same in all participants",
        ),
    ],
)
def test_what_has_no_correlation(lines, of, note):
    row = record(correlations(made(*lines)[0]), of=of)
    assert row["r"] is row["low"] is row["high"] is row["p"] is None
    assert row["note"] == note


def test_of_a_straight_line_there_is_no_interval():
    lines = [f"P1 T0 a {answer} {seconds}" for answer, seconds in zip("aacc", "1122", strict=True)]
    row = record(correlations(made(*lines)[0]), of="trials")
    assert row["r"] == pytest.approx(-1)
    assert (row["low"], row["note"]) == (None, "no interval of 4 trials")


def test_without_durations_there_is_nothing_to_correlate():
    trials, _ = made("P1 T0 a a -", "P1 T0 a c -")
    assert np.isnan(trials.duration_s).all()
    assert correlations(trials).notes == ("no duration is known",)
