"""Trials as arrays: levels in order, cells by name, places side by side."""

import numpy as np
import pytest

from tests.analysis.making import answers, made
from vbraille.analysis.input.trials import (
    UNREAD_MASK,
    Factor,
    Places,
    count,
    masks_of,
    name_cell,
    name_string,
    natural,
)


@pytest.mark.parametrize(
    "names",
    [
        ["T0", "T25", "T100"],
        ["P2-a", "P2-b", "P10-a"],
        ["0.5", "1", "1.5", "10"],
        ["2 mm", "10 mm", "nominal", "textured"],
        ["T", "T1", "Ta"],
    ],
)
def test_names_with_numbers_come_in_the_order_of_the_numbers(names):
    assert sorted(sorted(names), key=natural) == names


def test_a_factor_has_its_levels_in_order():
    factor = Factor.of(["T100", "T0", "T25", "T0"])
    assert factor.levels == ("T0", "T25", "T100")
    assert factor.codes.tolist() == [2, 0, 1, 0]
    assert factor.names() == ["T100", "T0", "T25", "T0"]
    assert len(factor) == 3


def test_levels_that_nothing_has_any_more_are_gone():
    part = Factor.of(["c", "a", "b", "c"])[np.array([True, False, False, True])]
    assert (part.levels, part.codes.tolist()) == (("c",), [0, 0])
    assert Factor.of(["c", "a", "b"])[np.array([2, 0])].names() == ["b", "c"]


def test_strings_are_sorted_by_code_point():
    assert Factor.of_strings(["⠃", "?", "⠁"]).levels == ("?", "⠁", "⠃")


@pytest.mark.parametrize(
    ("mask", "name"),
    [
        (0, "blank"),
        (0b1, "a"),
        (0b1001, "c"),
        (0b1000, "dot 4"),
        (0b101111, "dots 1-2-3-4-6"),
        (0b11000000, "dots 7-8"),
        (UNREAD_MASK, "?"),
    ],
)
def test_cells_have_names(mask, name):
    name_cell.cache_clear()  # laws, which are not in coverage, may have asked for it before
    assert name_cell(mask) == name


@pytest.mark.parametrize(
    ("text", "name"),
    [("⠍⠕⠞", "mot"), ("⠁?", "a?"), ("⠁⠈", "a, dot 4"), ("⠀⠉", "blank, c"), ("⠈", "dot 4")],
)
def test_strings_have_names(text, name):
    assert name_string(text) == name


def test_a_place_not_read_has_a_mask_of_its_own():
    assert masks_of("⠉?⠀") == [0b1001, UNREAD_MASK, 0]
    assert UNREAD_MASK > 0xFF


def test_things_are_counted_in_words():
    assert [count(n, "trial") for n in (0, 1, 2)] == ["0 trials", "1 trial", "2 trials"]


def test_some_of_the_trials():
    trials, _ = made(
        "P1 T0 ac ac 2 left",
        "P1 T25 ac aa 3 left",
        "P2 T0 ca ca 4 right",
        columns="participant condition presented answered duration_s hand",
    )
    part = trials[trials.participant.codes == 0]
    assert len(part) == 2
    assert part.participant.levels == ("P1",)
    assert part.presented.levels == ("⠁⠉",)
    assert part.correct.tolist() == [True, False]
    assert part.duration_s.tolist() == [2.0, 3.0]
    assert part.others == {"hand": ["left", "left"]}
    last = trials[np.array([2])]
    assert (last.others, last.trial.tolist()) == ({"hand": ["right"]}, [3])


def test_a_row_a_trial():
    trials, _ = made(
        "P1 T0 ac a? - 3 left", "P2 T25 a A 1.5 - right",
        columns="participant condition presented answered duration_s block hand",
    )  # fmt: skip
    assert trials.rows() == [
        {
            "participant": "P1", "session": "made", "protocol": "", "condition": "T0", "block": 3,
            "trial": 1, "presented": "⠁⠉", "string_set": "", "answered": "⠁?", "correct": 0,
            "duration_s": "", "hand": "left",
        },
        {
            "participant": "P2", "session": "made", "protocol": "", "condition": "T25", "block": "",
            "trial": 2, "presented": "⠁", "string_set": "", "answered": "⠁", "correct": 1,
            "duration_s": 1.5, "hand": "right",
        },
    ]  # fmt: skip


def test_trials_are_compared_by_what_they_have():
    trials, _ = made(
        "P1 T0 a a 2 left",
        "P1 T25 a a 1 right",
        columns="participant condition presented answered block hand",
    )
    assert trials.columns() == ("condition", "block", "session", "protocol", "hand")
    assert trials.factor("condition") is trials.condition
    assert trials.factor("session").levels == ("made",)
    assert trials.factor("block").levels == ("1", "2")
    assert sorted(trials.factor("hand").names()) == ["left", "right"]


def test_places_are_those_of_answers_as_long_as_their_string():
    trials, places = answers("P1 T0 ac a?", "P1 T0 ca c", "P1 T0 a ca", "P1 T0 ⠈⠀c aca")
    assert trials.correct.tolist() == [False] * 4
    assert places.at.tolist() == [0, 0, 3, 3, 3]
    assert places.presented.tolist() == [1, 9, 8, 0, 9]
    assert places.answered.tolist() == [1, UNREAD_MASK, 1, 9, 1]
    assert places.correct.tolist() == [True, False, False, False, False]
    assert (places.unequal, len(places)) == (2, 5)
    wrong = places.where(~places.correct)
    assert (wrong.at.tolist(), wrong.presented.tolist()) == ([0, 3, 3, 3], [9, 8, 0, 9])
    assert (len(wrong), wrong.unequal) == (4, 2)


def test_places_of_answers_of_other_lengths_are_none():
    trials, places = answers("P1 T0 ac a", "P1 T0 a ac")
    assert (len(places), places.unequal) == (0, 2)
    assert len(Places.of(trials[np.array([0])])) == 0
