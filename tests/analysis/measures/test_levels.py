"""Levels compared: scores in cells, means, t-tests, analysis of variance."""

import math

import numpy as np
import pandas as pd
import pytest

from tests.analysis.making import answers, made, record
from vbraille.analysis.input import scoretable
from vbraille.analysis.input.scoretable import Scores, of_sheet, of_trials
from vbraille.analysis.input.sheets import Sheet, read_csv
from vbraille.analysis.input.trials import LeftOut, Places
from vbraille.analysis.measures import levels
from vbraille.analysis.measures.levels import analyses, level_means, t_tests
from vbraille.analysis.statistics.anova import anova
from vbraille.analysis.statistics.intervals import METHODS, adjust, mean_interval, mean_share
from vbraille.analysis.statistics.paired import paired_t
from vbraille.errors import InputError

# Four participants at three levels.
T0, T25, T100 = [40.0, 52, 47, 61], [50.0, 55, 49, 70], [66.0, 64, 52, 83]


def long_form(**columns):
    """Scores of a factor, a column a level."""
    cells = [
        (f"P{n}", level, value)
        for level, values in columns.items()
        for n, value in enumerate(values, 1)
    ]
    who, level, value = zip(*cells, strict=True)
    return Scores("score", who, {"texture": level}, value)


THREE = long_form(T100=T100, T0=T0, T25=T25)


def test_scores_are_means_of_each_participant_in_each_cell():
    trials, places = made(
        "P1 T0 ac ac 2", "P1 T0 ac aa 4", "P1 T25 ac ?? 7", "P2 T0 ac ac -", "P2 T0 ac a 5",
    )  # fmt: skip
    strings, characters, duration = of_trials(trials, places, ["condition"])
    assert [each.measure for each in (strings, characters, duration)] == [
        "legibility of strings",
        "legibility of characters",
        "duration (s)",
    ]
    assert strings.participants == ["P1", "P1", "P2", "P2"]
    assert strings.factors == {"condition": ["T0", "T25", "T0", "T25"]}
    np.testing.assert_array_equal(strings.scores, [0.5, 0, 0.5, np.nan])
    np.testing.assert_array_equal(characters.scores, [0.75, 0, 1, np.nan])
    np.testing.assert_array_equal(duration.scores, [3, 7, 5, np.nan])


def test_what_nobody_has_is_not_compared():
    trials, places = answers("P1 T0 ac a")
    assert [each.measure for each in of_trials(trials, places, ["condition"])] == [
        "legibility of strings"
    ]


def test_two_factors_make_cells():
    trials, places = made(
        "P1 T0 a a left", "P1 T0 a c right", "P1 T25 a a left",
        columns="participant condition presented answered hand",
    )  # fmt: skip
    (strings, _) = of_trials(trials, places, ["condition", "hand"])
    assert strings.factors == {
        "condition": ["T0", "T0", "T25", "T25"],
        "hand": ["left", "right", "left", "right"],
    }
    np.testing.assert_array_equal(strings.scores, [1, 0, 1, np.nan])


def test_a_factor_is_a_column_of_few_levels():
    columns = "participant condition presented answered item"
    trials, places = made(*(f"P1 T0 a a i{n}" for n in range(51)), columns=columns)
    says = r"^there is no column 'hand' to compare by; there are condition, block, .*, item$"
    with pytest.raises(InputError, match=says):
        of_trials(trials, places, ["hand"])
    says = r"^item has 51 levels, more than can be compared; give a factor of a few, such as cond"
    with pytest.raises(InputError, match=says):
        of_trials(trials, places, ["item"])
    few = trials.head(scoretable.MOST_LEVELS)
    assert len(of_trials(few, Places.of(few), ["item"])[0].scores) == 50


def test_a_table_of_scores(tmp_path):
    path = tmp_path / "t.csv"
    path.write_text(
        "participant;texture;hand;score\nP1; T0;left;4,5\n P2;T25;left;\nP1;T0;left;n/a\n"
    )
    found = of_sheet(read_csv(path))
    assert (found.measure, list(found.participants)) == ("score", ["P1", "P2", "P1"])
    assert found.factors == {"texture": ["T0", "T25", "T0"], "hand": ["left"] * 3}
    np.testing.assert_array_equal(found.scores, [4.5, np.nan, np.nan])


@pytest.mark.parametrize(
    ("columns", "says"),
    [
        ({"participant": ["P1"], "scor": ["1"]}, r"^t needs columns participant, score: .* scor;"),
        ({"participant": ["P1"], "score": ["1"]}, r"^t has no column but participant and score;"),
        ({"participant": [], "score": [], "a": []}, r"^t has no scores; add a line for each$"),
        (
            {"participant": [""], "score": ["1"], "a": ["x"]},
            r"^t row 1: participant is empty; fill it in$",
        ),
        (
            {"participant": ["P1", "P2"], "score": ["1", "2"], "a": ["x", " "]},
            r"^t row 2: a is empty; fill it in$",
        ),
        (
            {"participant": ["P1"], "score": ["good"], "a": ["x"]},
            r"^t row 1: score is 'good'; give a number, or nothing if it is missing$",
        ),
        ({"participant": ["P1"], "score": ["inf"], "a": ["x"]}, r"^t row 1: score is 'inf'; "),
        ({"participant": ["P1"], "score": ["-1e200"], "a": ["x"]}, r"^t row 1: score is '-1e200"),
    ],
)
def test_what_is_no_table_of_scores(columns, says):
    with pytest.raises(InputError, match=says):
        of_sheet(Sheet("t", pd.DataFrame(columns, range(1, len(next(iter(columns.values()))) + 1))))


def test_means_of_the_levels():
    table = level_means([THREE])
    assert table.frame["level"].tolist() == ["T0", "T25", "T100"]
    row = record(table, level="T25")
    interval = mean_interval(T25)
    assert (row["measure"], row["factor"], row["participants"]) == ("score", "texture", 4)
    assert (row["mean"], row["low"], row["high"]) == (np.mean(T25), interval.low, interval.high)


def test_means_of_shares_are_of_their_numbers_of_trials():
    lines = [f"P{n} T0 ab {answer}" for n in (1, 2, 3) for answer in ("ab", "ab", "aa")]
    lines += [f"P{n} T25 ab ab" for n in (1, 2, 3)]
    table = level_means(of_trials(*answers(*lines), ["condition"]))
    for measure, trials in (("legibility of strings", 3), ("legibility of characters", 6)):
        row = record(table, measure=measure, level="T0")
        right = (2 if trials == 3 else 5) / trials
        interval = mean_share([right] * 3, [trials] * 3)
        assert (row["mean"], row["low"], row["high"]) == (
            pytest.approx(right),
            pytest.approx(interval.low),
            pytest.approx(interval.high),
        )
        # All right, and an interval all the same.
        assert record(table, measure=measure, level="T25")["low"] < 0.9


def test_every_pair_of_levels_is_tested():
    table = t_tests([THREE], "none")
    assert [row[2:4] for row in table.rows] == [("T0", "T25"), ("T0", "T100"), ("T25", "T100")]
    theirs = paired_t(T0, T100)
    row = record(table, first="T0", second="T100")
    for name in ("mean_difference", "low", "high", "t", "df", "p", "d_z", "g_z"):
        assert row[name] == getattr(theirs, name)
    assert (row["participants"], row["p_corrected"], row["note"]) == (4, theirs.p, "")


@pytest.mark.parametrize("method", sorted(METHODS))
def test_p_is_corrected_for_the_tests_of_one_measure_and_factor(method):
    other = Scores("other", THREE.participants, THREE.factors, [-v * v for v in THREE.scores])
    table = t_tests([THREE, other], method)
    for measure in ("score", "other"):
        rows = [row for row in table.records() if row["measure"] == measure]
        p = [row["p"] for row in rows]
        assert [row["p_corrected"] for row in rows] == adjust(p, method).tolist()
        assert (adjust(p, method) > p).any() == (method != "none")


def test_who_has_one_of_two_levels_is_named():
    table = t_tests([long_form(T0=[*T0, 1.0], T25=T25, T100=[1.0])], "holm")
    row = record(table, first="T0", second="T25")
    assert (row["participants"], row["note"]) == (4, "without P5: a score is missing")
    assert row["t"] == paired_t(T0, T25).t
    row = record(table, first="T25", second="T100")
    assert (row["participants"], row["t"], row["p_corrected"]) == (1, None, None)
    assert row["note"] == (
        "without P2, P3, P4, P5: a score is missing; one participant; a t-test needs two"
    )
    # The one test that there is, is not corrected for those that are none.
    assert record(table, first="T0", second="T25")["p_corrected"] == paired_t(T0, T25).p


@pytest.mark.parametrize(
    ("first", "second", "note"),
    [
        ([1.0, 2, 3], [2.0, 3, 4], "all differences are the same; t has no value"),
        ([1.0, 1, 1], [1.0, 1, 1], "all differences are the same; t has no value"),
        ([1.0, 4], [2.0, 3], "no g_z of two participants"),
    ],
)
def test_what_cannot_be_tested_says_why(first, second, note):
    (row,) = t_tests([long_form(T0=first, T25=second)], "holm").records()
    assert row["note"] == note
    assert (row["t"] is None) == ("differences" in note)


def test_repeated_scores_are_averaged_within_the_participant_first():
    # P1 was asked three times at T0 with the left hand and once with the right.
    told = [
        ("P1", "T0", "left", 10.0), ("P1", "T0", "left", 20), ("P1", "T0", "left", 30),
        ("P1", "T0", "right", 40), ("P1", "T25", "left", 50), ("P1", "T25", "right", 70),
        ("P2", "T0", "left", 10), ("P2", "T0", "right", math.nan), ("P2", "T25", "left", 15),
    ]  # fmt: skip
    who, texture, hand, value = zip(*told, strict=True)
    table = level_means([Scores("score", who, {"texture": texture, "hand": hand}, value)])
    left = record(table, level="left")
    assert (left["participants"], left["mean"]) == (2, np.mean([np.mean([20, 50]), 12.5]))
    # P2, who read nothing with the right hand, has not all of a texture.
    for level, mean in (("T0", np.mean([20, 40])), ("T25", 60), ("right", 55)):
        row = record(table, level=level)
        assert (row["participants"], row["mean"]) == (1, mean)
        assert row["note"].startswith(
            "without P2: a score is missing; no interval: one participant"
        )


def test_groups_of_participants_have_no_empty_tests():
    """Nobody is in two of them: no row without a test, but a note, and means without one."""
    who, hand = ["P1", "P2", "P3", "P4"] * 2, ["left"] * 4 + ["right"] * 4
    vision = ["blind", "blind", "sighted", "sighted"] * 2
    scores = Scores("score", who, {"vision": vision, "hand": hand}, [1.0, 2, 4, 5, 3, 3, 7, 9])
    table = t_tests([scores], "holm")
    (row,) = table.records()
    assert (row["factor"], row["participants"]) == ("hand", 4)
    (note,) = table.notes
    assert note.startswith("score: vision has groups of participants, and nobody is in two")
    means = [row for row in level_means([scores]).records() if row["factor"] == "vision"]
    assert [row["participants"] for row in means] == [2, 2]
    assert not any("a score is missing" in row["note"] for row in means)
    effects = {row["effect"]: row for row in analyses([scores])[0].records()}
    assert effects["vision"]["f"] is not None


def test_groups_alone_are_no_analysis_of_levels_within_people():
    vision = {"vision": ["blind", "blind", "sighted", "sighted"]}
    table, left_out = analyses([Scores("score", ["P1", "P2", "P3", "P4"], vision, [1.0, 2, 4, 5])])
    assert (table.records(), left_out) == ([], [])
    assert table.notes == ("score: vision: groups alone; nothing varies within people",)


def test_differences_of_shares_are_within_1():
    who, texture = ["P1", "P2", "P3"] * 2, ["T0"] * 3 + ["T25"] * 3
    given = [0.0, 0.0, 0.1, 1.0, 1.0, 0.4]
    for trials, ends in (([10] * 6, (True, True)), (None, (False, True))):
        scores = Scores("legibility", who, {"texture": texture}, given, trials=trials)
        (row,) = t_tests([scores], "holm").records()
        assert (row["low"] >= -1, row["high"] <= 1) == ends


def test_a_level_without_scores_is_a_level_all_the_same():
    lone = long_form(T0=[1.0, 2, 4], T25=[math.nan] * 3)
    row = record(level_means([lone]), level="T25")
    assert (row["participants"], row["mean"]) == (0, None)
    assert row["note"].startswith("without P1, P2, P3: a score is missing; no interval: no part")
    (row,) = t_tests([lone], "holm").records()
    assert row["participants"] == 0
    assert row["note"].endswith("no participants; a t-test needs two")
    table, left_out = analyses([lone])
    assert table.notes[0].startswith("score: nobody has a score for 'T25'")
    assert left_out == []


def test_the_analysis_of_variance():
    table, left_out = analyses([THREE])
    (effect,) = anova(THREE.participants, THREE.factors, THREE.scores).effects
    (row,) = table.records()
    assert (row["measure"], row["effect"], row["participants"]) == ("score", "texture", 4)
    assert (row["df1"], row["df2"]) == (2, 6)
    for name in ("f", "p", "epsilon", "p_corrected", "mauchly_w", "partial_eta2", "note"):
        assert row[name] == getattr(effect, name)
    assert row["f"] > 5
    assert (table.notes, left_out) == ((), [])


def test_who_lacks_a_cell_is_left_out_and_who_has_several_is_named():
    some = long_form(T0=[*T0, 5.0], T25=[*T25, math.nan], T100=T100)
    some = Scores(
        "score", [*some.participants, "P1"],
        {"texture": [*some.factors["texture"], "T0"]}, [*some.scores, 44.0],
    )  # fmt: skip
    table, left_out = analyses([some])
    assert left_out == [LeftOut("participant P5, of the analysis of score", "no T25, T100")]
    assert table.notes == ("score: repeated scores were averaged first, of P1",)
    (row,) = table.records()
    same = long_form(T0=[42.0, *T0[1:]], T25=T25, T100=T100)
    assert row["participants"] == 4
    assert row["f"] == pytest.approx(analyses([same])[0].records()[0]["f"])


@pytest.mark.parametrize(
    ("one", "note"),
    [
        (long_form(T0=T0), "score: every score has the same texture, 'T0'; there is nothing to"),
        (long_form(T0=[1.0], T25=[2.0]), "score: one participant, 'P1', has a score in every cell"),
        (
            Scores("score", ["P1"], {str(n): ["x"] for n in range(5)}, [1.0]),
            "score: 5 factors; one to 4 are needed",
        ),
        (
            Scores("score", ["P1"], {"texture": ["T0"]}, [math.nan]),
            "score: no scores",
        ),
    ],
)
def test_what_cannot_be_analysed_says_why(one, note):
    table, left_out = analyses([one])
    assert (table.rows, left_out) == ((), [])
    assert table.notes[0].startswith(note)


def test_nothing_varies():
    table, _ = analyses([long_form(T0=[1.0, 1, 1], T25=[1.0, 1, 1])])
    (row,) = table.records()
    assert row["f"] is row["p"] is None
    assert row["note"]


def test_one_level_or_too_many_are_not_tested():
    many = long_form(**{f"L{n}": [1.0, 2.0] for n in range(levels.MOST_LEVELS + 1)})
    assert t_tests([many], "holm").notes == (
        "score: texture has 13 levels; the pairs of more than 12 are not tested",
    )
    alone = t_tests([long_form(T0=T0)], "holm")
    assert alone.notes == ("score: texture is T0 alone; nothing to compare",)
    assert alone.rows == ()


def test_without_scores_all_three_say_so():
    for table in (level_means([]), t_tests([], "holm"), analyses([])[0]):
        assert (table.rows, table.notes) == ((), ("there are no scores to compare",))
