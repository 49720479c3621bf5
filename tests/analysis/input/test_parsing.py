"""Columns of text to trials: what is understood, what is left out, what is refused."""

import re

import numpy as np
import pandas as pd
import pytest

from tests.analysis.making import from_rows, levels, sheet
from vbraille.analysis.input.parsing import parse
from vbraille.analysis.input.sheets import Sheet, parse_cells, read_csv
from vbraille.analysis.input.trials import TRIAL_COLUMNS, LeftOut
from vbraille.errors import InputError

NAMED = "participant condition session trial presented answered"
NEEDED = "participant condition presented answered"


def trials_of(*lines, columns=NEEDED):
    return parse([sheet(*lines, columns=columns)]).trials


def compared(*rows, **more):
    """Comparisons of pairs of what was presented and answered."""
    told = [
        {"participant": "P1", "condition": "all", "presented": shown, "answered": answer} | more
        for shown, answer in rows
    ]
    return parse([from_rows("made", told)])


@pytest.mark.parametrize(
    ("text", "cells"),
    [
        ("ac", "⠁⠉"),
        ("AzC", "⠁⠵⠉"),
        ("⠁⠀⠈", "⠁⠀⠈"),
        ("a⠈?", "⠁⠈?"),
        (" a ", "⠁"),
        ("⠀", "⠀"),
        ("⣿", "⣿"),
        ("na", "⠝⠁"),
    ],
)
def test_cells_are_braille_or_letters_in_either_case(text, cells):
    assert parse_cells(text) == cells


@pytest.mark.parametrize("text", ["a1", "a c", "é", "a-", "⠁\u2900"])
def test_what_is_no_cell(text):
    with pytest.raises(ValueError, match="is no cell; give letters a to z or Unicode braille"):
        parse_cells(text)


def test_a_trial_is_right_if_all_of_it_is():
    trials = trials_of(
        "P1 T0 ac AC", "P1 T0 ac ⠁⠉", "P1 T0 ac aa", "P1 T0 ac a?", "P1 T0 ac acc", "P1 T0 ac a"
    )
    assert trials.correct.tolist() == [True, True, False, False, False, False]
    assert trials["presented"].tolist() == ["⠁⠉"] * 6
    assert trials["answered"].tolist() == ["⠁⠉", "⠁⠉", "⠁⠁", "⠁?", "⠁⠉⠉", "⠁"]


def test_what_is_optional_is_filled_in():
    trials = trials_of("P2 T0 a a", "P1 T0 a a")
    assert trials["participant"].tolist() == ["P1", "P2"]
    assert levels(trials.session) == ("made",)
    assert levels(trials.protocol) == ("",)
    assert trials.block.tolist() == [0, 0]
    assert trials.trial.tolist() == [2, 1]
    assert np.isnan(trials.duration_s).all()
    assert tuple(trials) == TRIAL_COLUMNS


def test_all_columns_are_read_and_others_are_kept():
    columns = f"{NAMED} block duration_s hand protocol correct"
    trials = trials_of(
        "P1 T25 s1 2 ac ac 1 4.5 left letters 0", "P1 T0 s1 1 ca cc 1 - right letters 1",
        columns=columns,
    )  # fmt: skip
    assert trials.trial.tolist() == [1, 2]
    assert trials.block.tolist() == [1, 1]
    assert trials["condition"].tolist() == ["T0", "T25"]
    assert levels(trials.protocol) == ("letters",)
    np.testing.assert_array_equal(trials.duration_s, [np.nan, 4.5])
    assert trials["hand"].tolist() == ["right", "left"]
    # As it is answered, whatever the table says of it.
    assert trials.correct.tolist() == [False, True]


def test_trials_are_in_the_order_of_participants_sessions_blocks_and_trials():
    keys = [("P10", "s1", 1, 1), ("P2", "s10", 1, 1), ("P2", "s2", 2, 1), ("P2", "s2", 1, 9),
            ("P2", "s2", 1, 10), ("P2", "s2", 2, 2)]  # fmt: skip
    trials = trials_of(
        *(f"{who} T0 {session} {trial} a a {block}" for who, session, block, trial in keys),
        columns=f"{NAMED} block",
    )
    found = zip(
        trials["participant"].tolist(),
        trials["session"].tolist(),
        trials.block.tolist(),
        trials.trial.tolist(),
        strict=True,
    )
    assert list(found) == [keys[n] for n in (3, 4, 2, 5, 1, 0)]


def test_a_table_with_semicolons_has_decimal_commas(tmp_path):
    path = tmp_path / "t.csv"
    path.write_text("participant;condition;presented;answered;duration_s\nP1;T0;a;a;4,75\n")
    assert parse([read_csv(path)]).trials.duration_s.tolist() == [4.75]
    path.write_text('participant,condition,presented,answered,duration_s\nP1,T0,a,a,"4,75"\n')
    with pytest.raises(InputError, match=r"^t\.csv line 2: duration_s is '4,75'; give seconds, or"):
        parse([read_csv(path)])


@pytest.mark.parametrize("unknown", ["", "n/a", "NA", "nan", " "])
def test_a_duration_may_not_be_known(unknown):
    row = {"participant": "P1", "condition": "T0", "presented": "a", "answered": "a"}
    trials = parse([from_rows("made", [row | {"duration_s": unknown}])]).trials
    assert np.isnan(trials.duration_s).all()


def test_rows_without_an_answer_are_left_out_and_counted():
    one = sheet("P1 T0 a a", "P1 T0 a -", "P1 T0 a n/a", "P1 T0 a N/A", columns=NEEDED, name="one")
    two = sheet("P1 T0 a -", columns=NEEDED, name="two")
    found = parse([one, two])
    assert len(found.trials) == 1
    assert found.left_out == (
        LeftOut("3 trials of one", "no answer"),
        LeftOut("1 trial of two", "no answer"),
    )
    assert parse([two]).trials is None
    assert parse([sheet("P1 T0 a a", columns=NEEDED)]).left_out == ()


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("P1 T0 a1 a 1 2", r"^made row 2: presented is 'a1', and '1' is no cell; give letters"),
        ("P1 T0 a a1 1 2", r"^made row 2: answered is 'a1', and '1' is no cell; give letters"),
        ("P1 T0 a? a 1 2", r"^made row 2: presented is 'a\?'; give the cells that were shown$"),
        ("P1 T0 - a 1 2", r"^made row 2: presented is ''; give the cells that were shown$"),
        ("- T0 a a 1 2", r"^made row 2: participant is empty; name it$"),
        ("P1 - a a 1 2", r"^made row 2: condition is empty; name it$"),
        ("P1 T0 a a one 2", r"^made row 2: block is 'one'; give a whole number from 1$"),
        ("P1 T0 a a 1.5 2", r"^made row 2: block is '1\.5'; give a whole number"),
        ("P1 T0 a a -1 2", r"^made row 2: block is '-1'; give a whole number"),
        ("P1 T0 a a 1 soon", r"^made row 2: duration_s is 'soon'; give seconds, or nothing"),
        ("P1 T0 a a 1 -2", r"^made row 2: duration_s is '-2'; give seconds"),
        ("P1 T0 a a 1 inf", r"^made row 2: duration_s is 'inf'; give seconds"),
        ("P1 T0 a a 1 1e300", r"^made row 2: duration_s is '1e300'; give seconds"),
    ],
)
def test_what_cannot_be_read_is_told_with_its_place(line, says):
    columns = "participant condition presented answered block duration_s"
    with pytest.raises(InputError, match=says):
        trials_of("P1 T0 a a 1 2.0", line, columns=columns)


def test_the_place_is_the_line_of_the_file(tmp_path):
    path = tmp_path / "t.csv"
    path.write_text("participant,condition,presented,answered\n\nP1,T0,a,a\nP1,T0,a,1\n")
    with pytest.raises(InputError, match=r"^t\.csv line 4: answered is '1', and '1' is no cell"):
        parse([read_csv(path)])


def test_what_is_needed_is_needed_of_every_sheet():
    good = sheet("P1 T0 a a", columns=NEEDED)
    bad = sheet("P1 T0 a a", columns="participant condition presented answer", name="bad")
    with pytest.raises(InputError, match=r"^bad needs columns .* the nearest is answer;"):
        parse([good, bad])


def test_a_trial_given_twice():
    lines = ["P1 T0 s1 1 a a", "P1 T0 s1 2 a a"]
    one = sheet(*lines, columns=NAMED, name="one")
    says = (
        "^two row 1: trial 2 of session s1 is there a second time; give every trial once, and each "
        "session a name of its own$"
    )
    with pytest.raises(InputError, match=says):
        parse([one, sheet("P1 T0 s1 2 a b", columns=NAMED, name="two")])
    for other in ("P2 T0 s1 1 a a", "P1 T25 s1 1 a a", "P1 T0 s2 1 a a"):
        assert len(parse([one, sheet(other, columns=NAMED)]).trials) == 3
    with pytest.raises(InputError, match="second time"):
        compared(("1 2", "1"), ("2 1", "1"), session="s1", trial="3")


@pytest.mark.parametrize(
    ("columns", "line"),
    [
        ("participant condition session presented answered", "P1 T0 s1 a a"),
        ("participant condition trial presented answered", "P1 T0 1 a a"),
        (NAMED, "P1 T0 s1 - a a"),
    ],
    ids=["no trial", "no session", "no number"],
)
def test_trials_without_a_number_or_a_session_may_be_alike(columns, line):
    assert len(trials_of(line, line, columns=columns)) == 2


def test_a_table_that_scores_otherwise_is_told():
    columns = f"{NEEDED} correct"
    lines = ["P1 T0 a a 1", "P1 T0 a c 1", "P1 T0 a a 0", "P1 T0 a c 0", "P1 T0 a c -"]
    good = sheet(lines[0], lines[3], lines[4], columns=columns, name="good")
    found = parse([good, sheet(*lines, columns=columns)])
    assert found.warnings == (
        "made: column correct says otherwise than the answers in 2 trials, first in made row 2; "
        "the answers count.",
    )
    assert found.trials.correct.tolist().count(True) == 3
    assert parse([good, sheet("P1 T0 a a", columns=NEEDED)]).warnings == ()
    assert parse([sheet("P1 T0 a - 1", columns=columns)]).warnings == ()


def test_several_protocols_keep_their_conditions_apart():
    columns = f"{NEEDED} protocol"
    lines = ["P1 T0 a a letters", "P1 T0 a a words", "P1 T25 a a letters", "P1 all a a control"]
    trials = trials_of(*lines, columns=columns)
    assert trials["condition"].tolist() == ["letters T0", "words T0", "T25", "control"]
    assert trials["protocol"].tolist() == ["letters", "words", "letters", "control"]
    # Of one protocol they are as they are.
    assert levels(trials_of(lines[0], lines[2], columns=columns).condition) == ("T0", "T25")
    assert levels(trials_of(lines[3], columns=columns).condition) == ("all",)
    # A table without a protocol is one more.
    told = [sheet(lines[3], columns=columns), sheet("P1 all a a", "P2 T0 a a", columns=NEEDED)]
    assert set(levels(parse(told).trials.condition)) == {"control", "all", "T0"}


def test_other_columns_of_some_sheets():
    one = sheet("P1 T0 a a left", columns=f"{NEEDED} hand", name="one")
    two = sheet("P2 T0 a a index", columns=f"{NEEDED} finger", name="two")
    three = sheet("P3 T0 a a", columns=NEEDED, name="three")
    trials = parse([one, two, three]).trials
    assert list(trials)[len(TRIAL_COLUMNS) :] == ["hand", "finger"]
    assert trials["hand"].tolist() == ["left", "", ""]
    assert trials["finger"].tolist() == ["", "index", ""]


def test_comparisons_are_told_from_strings():
    found = compared(("1.5 2", "2"), ("2 1.5", "2"), ("ac", "ac"), ("3  0.5", " 3 "))
    assert found.comparisons.first.tolist() == [1.5, 2.0, 3.0]
    assert found.comparisons.second.tolist() == [2.0, 1.5, 0.5]
    assert found.comparisons.chosen.tolist() == [1, 0, 0]
    assert levels(found.comparisons.parameter) == ("value",)
    assert levels(found.comparisons.participant) == ("P1",)
    assert len(found.comparisons) == 3
    assert levels(found.trials.presented) == ("⠁⠉",)
    named = compared(("1.5 2", "2"), parameter="dot_width_mm")
    assert levels(named.comparisons.parameter) == ("dot_width_mm",)
    assert named.trials is None


def test_comparisons_of_a_table_with_semicolons(tmp_path):
    path = tmp_path / "t.csv"
    path.write_text("participant;condition;presented;answered\nP1;all;1,5 2;1,5\n")
    found = parse([read_csv(path)]).comparisons
    assert (found.first.tolist(), found.second.tolist(), found.chosen.tolist()) == ([1.5], [2], [0])


@pytest.mark.parametrize(
    ("presented", "answered", "more"),
    [
        ("1 2", "3", {}),
        ("1 2", "first", {}),
        ("1 2", "nan", {}),
        ("1 1", "1", {}),
        ("1..5 2", "2", {}),
        ("1,5 2", "2", {}),
        (f"{'9' * 400} 2", "2", {}),
        ("ab", "1", {"parameter": "dot_width_mm"}),
        ("1 2 3", "1", {"parameter": "dot_width_mm"}),
    ],
)
def test_what_is_no_comparison(presented, answered, more):
    says = f"^made row 1: presented is '{presented}' and answered '{answered}'; a comparison prese"
    with pytest.raises(InputError, match=says):
        compared((presented, answered), **more)


def test_a_table_without_rows_has_nothing():
    found = parse([Sheet("t", pd.DataFrame(columns=NEEDED.split(), dtype=object))])
    assert (found.trials, found.comparisons, found.left_out) == (None, None, ())


OWN = "participant,condition,question,presented,answered\n"


@pytest.mark.parametrize(
    ("row", "outcome"),
    [
        ("detect,yes,yes", "hit"),
        ("detect,yes,no", "miss"),
        ("detect,no,yes", "false alarm"),
        ("detect,no,no", "correct rejection"),
        ("same-different,different,different", "hit"),
        ("same-different,different,same", "miss"),
        ("same-different,same,different", "false alarm"),
        ("same-different,same,same", "correct rejection"),
    ],
)
def test_an_outcome_follows_from_what_was_presented_and_answered(tmp_path, row, outcome):
    path = tmp_path / "own.csv"
    path.write_text(f"{OWN}A,all,{row}\n")
    assert [*parse([read_csv(path)]).judgements["outcome"]] == [outcome]


@pytest.mark.parametrize(
    ("row", "said"),
    [
        ("detect,st,yes", "outcome is missing, and presented is 'st', which does not tell it"),
        ("detect,yes,y", "answered is 'y'; to the question 'detect' it must be yes or no"),
        ("same-different,0.5,same", "give outcome, or presented as different or same"),
    ],
)
def test_an_outcome_that_does_not_follow_is_asked_for(tmp_path, row, said):
    path = tmp_path / "own.csv"
    path.write_text(f"{OWN}A,all,detect,yes,yes\nA,all,{row}\n")
    with pytest.raises(InputError, match=re.escape(said)) as caught:
        parse([read_csv(path)])
    assert str(caught.value).startswith("own.csv line 3: ")
