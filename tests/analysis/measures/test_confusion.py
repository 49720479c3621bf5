"""Which cells are taken for which, and how much comes through."""

from collections import Counter

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.analysis.making import answers, record
from vbraille.analysis.input.trials import name_string
from vbraille.analysis.measures.confusion import (
    CONFUSION_CHARACTERS,
    CONFUSION_PAIRS,
    MARKS,
    of_characters,
    of_pairs,
    to_table,
    transmitted,
)

TAKEN = ["P1 T0 ac ac", "P1 T0 ac a?", "P1 T25 ca aa", "P2 T25 ca cx", "P2 T25 ca ⠈a"]


def test_characters_answered_for_each_that_was_presented():
    trials, places = answers(*TAKEN)
    found = of_characters(places)
    assert tuple(found.index) == ("a", "c")
    # The rows' own first, then what was never presented, at last what was not read.
    assert tuple(found.columns) == ("a", "c", "x", "dot 4", "?")
    assert found.to_numpy().tolist() == [[4, 0, 1, 0, 0], [1, 2, 0, 1, 1]]
    table = to_table(CONFUSION_CHARACTERS, found, places)
    answered = [f"answered {name}" for name in ("a", "c", "x", "dot 4", "?")]
    assert table.schema.names == list(table.frame) == ["presented", *answered]
    assert table.rows == (("a", 4, 0, 1, 0, 0), ("c", 1, 2, 0, 1, 1))
    assert table.is_right(table.rows[0], 1)
    assert table.is_right(table.rows[1], 2)
    assert len(trials) * 2 == found.to_numpy().sum()


def test_pairs_answered_for_each_that_was_presented():
    trials, places = answers(*TAKEN)
    found = of_pairs(trials)
    assert tuple(found.index) == ("ac", "ca")
    assert tuple(found.columns) == ("ac", "ca", "aa", "a?", "cx", "dot 4, a")
    assert found.to_numpy().tolist() == [[1, 0, 0, 1, 0, 0], [0, 0, 1, 0, 1, 1]]
    assert to_table(CONFUSION_PAIRS, found, places).name == "confusion_pairs"


def test_pairs_take_answers_of_any_length_but_strings_of_two():
    trials, places = answers("P1 T0 ac acc", "P1 T0 ac a", "P1 T0 ac ac")
    found = of_pairs(trials)
    assert tuple(found.columns) == ("ac", "a", "acc")
    assert found.to_numpy().tolist() == [[1, 1, 1]]
    assert (
        to_table(CONFUSION_PAIRS, found, places).notes[0].startswith("2 answers of another number")
    )
    assert of_pairs(answers("P1 T0 ac ac", "P1 T0 acc acc")[0]) is None
    assert of_characters(answers("P1 T0 ac a")[1]) is None


def test_errors_above_the_marks_are_marked():
    trials, places = answers(*["P1 T0 a a"] * 12, *["P1 T0 a c"] * 5, *["P1 T0 c ?"] * 10)
    table = to_table(CONFUSION_CHARACTERS, of_characters(places), places)
    assert table.marks == MARKS == (4, 9)
    assert to_table(CONFUSION_CHARACTERS, of_characters(places), places, [11]).marks == (11,)
    assert len(trials) == 27


CELLS = st.text("ac⠀⠈?", min_size=2, max_size=2)


@given(st.lists(st.tuples(CELLS.filter(lambda text: "?" not in text), CELLS), min_size=1))
def test_every_answer_is_in_one_cell(pairs):
    trials, places = answers(*(f"P1 T0 {shown} {answer}" for shown, answer in pairs))
    found = of_characters(places)
    assert found.to_numpy().sum() == 2 * len(pairs)
    assert np.trace(found) == places.frame["correct"].sum()
    whole = of_pairs(trials)
    shown = whole.sum(axis=1).to_dict()
    assert shown == Counter(map(name_string, trials["presented"].tolist()))
    assert np.trace(whole) == trials.correct.sum()


def test_bits_and_agreement_of_all_and_of_each_condition():
    lines = ["P1 T0 ac ac", "P1 T0 ca ca"] * 64
    lines += [f"P1 T25 {shown} {answer}" for shown in ("ac", "ca") for answer in ("ac", "ca")] * 32
    table = transmitted(*answers(*lines), seed=1)
    assert [(row["of"], row["condition"]) for row in table.records()] == [
        *(("characters", name) for name in ("all", "T0", "T25")),
        *(("pairs", name) for name in ("all", "T0", "T25")),
    ]
    good = record(table, of="pairs", condition="T0")
    assert good == {
        "of": "pairs",
        "condition": "T0",
        "presented": 128,
        "accuracy": 1.0,
        "kappa": 1.0,
        "presented_bits": 1.0,
        "transmitted_bits": 1.0,
        "corrected_bits": pytest.approx(1, abs=0.1),
        "low": pytest.approx(0.9, abs=0.1),
        "high": pytest.approx(1, abs=0.02),
        "note": "",
    }
    bad = record(table, of="pairs", condition="T25")
    assert (bad["accuracy"], bad["kappa"], bad["transmitted_bits"]) == (0.5, 0, 0)
    assert (bad["corrected_bits"], bad["low"]) == (pytest.approx(0, abs=0.05), 0)
    both = record(table, of="pairs", condition="all")
    assert (both["presented"], both["accuracy"]) == (256, 0.75)
    assert both["presented_bits"] == 1
    assert both["transmitted_bits"] == pytest.approx(1 + 0.75 * np.log2(0.75) - 0.25 * 2)
    assert both["corrected_bits"] == pytest.approx(both["transmitted_bits"], abs=0.02)
    assert record(table, of="characters", condition="all")["presented"] == 512


def test_one_condition_is_told_once():
    table = transmitted(*answers("P1 T0 ac ac", "P1 T0 ca ca"), seed=1)
    assert table.frame["condition"].tolist() == ["all", "all"]


def test_pairs_of_one_condition_are_told_beside_other_strings_of_another():
    table = transmitted(*answers("P1 T0 ac ac", "P1 T0 ca cc", "P1 T25 acc acc"), seed=1)
    assert [row[:3] for row in table.rows] == [
        ("characters", "all", 7),
        ("characters", "T0", 4),
        ("characters", "T25", 3),
        ("pairs", "T0", 2),
    ]
    assert record(table, of="pairs")["accuracy"] == 0.5


def test_without_a_choice_there_is_no_agreement_beyond_chance():
    row = record(transmitted(*answers("P1 T0 ac ac", "P1 T0 ac ac"), seed=1), of="pairs")
    assert (row["kappa"], row["accuracy"], row["transmitted_bits"]) == (None, 1.0, 0.0)
    assert row["note"] == (
        "no kappa: one and the same was presented and answered throughout; "
        "no corrected bits: one character alone was presented"
    )


def test_without_places_there_is_nothing_to_tell():
    table = transmitted(*answers("P1 T0 aca a"), seed=1)
    assert table.rows == ()
    assert table.notes == ("no answer has as many places as its string",)
    # Of strings of three, characters alone.
    (row,) = transmitted(*answers("P1 T0 aca acc", "P1 T0 aca a"), seed=1).records()
    assert (row["of"], row["presented"], row["accuracy"]) == ("characters", 3, 2 / 3)
