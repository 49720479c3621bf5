"""Legibility of characters and strings: means of participants' own means, and pooled."""

from collections import defaultdict
from statistics import fmean

import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.analysis.making import answers, from_rows, record
from vbraille.analysis.input.parsing import parse
from vbraille.analysis.input.trials import UNREAD_MASK
from vbraille.analysis.measures.legibility import (
    cell_order,
    characters,
    dots,
    over_participants,
    strings,
)
from vbraille.analysis.results import mean_or_none
from vbraille.analysis.statistics.intervals import mean_share, wilson

# P1 has a right in 3 of 4 trials of T0 and in none of one of T25, P2 in one of one.
UNEQUAL = ["P1 T0 a a", "P1 T0 a a", "P1 T0 a a", "P1 T0 a c", "P1 T25 a ?", "P2 T0 a a"]


@pytest.mark.parametrize("table", ["characters", "strings", "dots"])
def test_conditions_are_averaged_within_a_participant_first_then_participants(table):
    trials, places = answers(*UNEQUAL)
    found = {
        "characters": characters(places),
        "strings": strings(trials),
        "dots": dots(places),
    }[table]
    (row,) = found.records()
    assert row["legibility"] == fmean([fmean([3 / 4, 0]), 1])
    assert row["pooled"] == 4 / 6
    assert (row["low"], row["note"]) == (
        None,
        "no interval: two participants; how people differ is seen of three or more",
    )
    assert (row["presented"], row["correct"], row["participants"]) == (6, 4, 2)


@pytest.mark.parametrize("of", [characters, dots])
def test_the_interval_is_of_the_participants_means(of):
    # Pooled it would be Wilson's, as if all were one person's.
    lines = ["P1 T0 a a"] * 4 + ["P2 T0 a a", "P2 T0 a c", "P3 T0 a ?", "P3 T25 a a"]
    (row,) = of(answers(*lines)[1]).records()
    interval = mean_share([1, 0.5, 0.5], [4, 2, 2])
    assert row["legibility"] == fmean([1, 0.5, 0.5])
    assert (row["low"], row["high"]) == pytest.approx((interval.low, interval.high))
    assert row["note"] == ""
    pooled = wilson(6, 8)
    assert row["high"] - row["low"] > pooled.high - pooled.low


OBSERVED = st.lists(
    st.tuples(st.integers(0, 3), st.booleans(), st.integers(0, 3), st.integers(0, 2)), min_size=1
)


@given(OBSERVED)
def test_means_are_those_taken_one_by_one(observed):
    frame = pd.DataFrame(observed, columns=["level", "correct", "participant", "condition"])
    whose = {name: frame[name].astype("category") for name in ("participant", "condition")}
    of = defaultdict(lambda: defaultdict(lambda: defaultdict(list)))
    for what, right, who, when in observed:
        of[what][who][when].append(right)
    means = {
        what: fmean(fmean(map(fmean, whens.values())) for whens in whos.values())
        for what, whos in of.items()
    }
    own = over_participants(frame["level"].to_numpy(), frame.assign(**whose))
    each = own.groupby(level="level")["mean"]
    assert each.size().to_dict() == {what: len(whos) for what, whos in of.items()}
    assert own["number"].sum() == len(observed)
    assert each.mean().to_dict() == pytest.approx(means)


def test_equal_numbers_of_trials_make_means_and_pooled_the_same():
    lines = [f"P{who} T{t} a {answer}" for who in (1, 2) for t in (0, 25) for answer in "aac"]
    (row,) = characters(answers(*lines)[1]).records()
    assert row["legibility"] == pytest.approx(row["pooled"]) == pytest.approx(2 / 3)


def test_characters_are_told_by_name_braille_and_dots():
    table = characters(answers("P1 T0 ⠈⠀ca ⠈⠈cc", "P1 T0 Ca ca")[1])
    told = [
        (r["name"], r["braille"], r["dots"], r["presented"], r["correct"]) for r in table.records()
    ]
    assert told == [
        ("a", "⠁", 1, 2, 1),
        ("c", "⠉", 2, 2, 2),
        ("blank", "⠀", 0, 1, 0),
        ("dot 4", "⠈", 1, 1, 1),
    ]
    assert table.notes == ()


def test_letters_come_before_other_cells_and_what_is_not_read_last():
    masks = [UNREAD_MASK, 0b1000, 0, 0b1001, 0b1, 0b11000000]
    assert sorted(masks, key=cell_order) == [0b1, 0b1001, 0, 0b1000, 0b11000000, UNREAD_MASK]


def test_strings_are_right_whole():
    table = strings(answers("P1 T0 ca ca", "P1 T0 ac ac", "P1 T0 ac aa", "P1 T0 ac a")[0])
    told = [(r["name"], r["braille"], r["presented"], r["correct"]) for r in table.records()]
    assert told == [("ac", "⠁⠉", 3, 1), ("ca", "⠉⠁", 1, 1)]


def test_by_number_of_dots():
    table = dots(answers("P1 T0 ⠈a⠀ ⠈c⠁", "P1 T0 xc ??")[1])
    told = [(row["dots"], row["presented"], row["correct"]) for row in table.records()]
    assert told == [(0, 1, 0), (1, 2, 1), (2, 1, 0), (4, 1, 0)]


@pytest.mark.parametrize("of", [characters, dots])
def test_answers_of_another_length_are_told(of):
    table = of(answers("P1 T0 ac aa", "P1 T0 ac a")[1])
    assert sum(table.frame["presented"].tolist()) == 2
    assert table.notes[0].startswith("1 answer of another number of places")
    none = of(answers("P1 T0 ac a")[1])
    assert none.rows == ()
    assert none.notes[0] == "no answer has as many places as its string"
    assert len(none.notes) == 2


def test_legibility_of_a_character_in_all_of_its_strings():
    table = characters(answers("P1 T0 ac aa", "P2 T0 ca ca")[1])
    assert record(table, name="a")["legibility"] == 1
    assert record(table, name="c")["legibility"] == 0.5


def test_of_nothing_there_is_no_mean():
    assert mean_or_none([]) is None
    assert mean_or_none([1, 2]) == 1.5


def test_a_string_made_by_a_braille_table_is_named_as_in_print():
    head = {"participant": "P1", "condition": "T0"}
    rows = [
        head | {"presented": cells, "answered": cells, "text": text}
        for cells, text in (("⠿⠞⠿", "été"), ("⠁", ""))
    ]
    table = strings(parse([from_rows("made", rows)]).trials)
    assert {row["name"]: row["braille"] for row in table.records()} == {"été": "⠿⠞⠿", "a": "⠁"}
