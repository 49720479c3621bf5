"""Trials as arrays: levels in order, cells by name, places side by side."""

import pytest

from tests.analysis.making import answers, levels, made
from vbraille.analysis.input.trials import (
    TRIAL_COLUMNS,
    UNREAD_MASK,
    Places,
    chosen,
    comparable,
    factor,
    masks_of,
    name_cell,
    name_string,
    natural,
    written,
)
from vbraille.analysis.results import to_csv


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
    found = factor(["T100", "T0", "T25", "T0"])
    assert tuple(found.categories) == ("T0", "T25", "T100")
    assert found.codes.tolist() == [2, 0, 1, 0]
    assert factor([0.25, "", 0.5]).tolist() == ["0.25", "", "0.5"]


def test_strings_are_sorted_by_code_point():
    assert tuple(factor(["⠃", "?", "⠁"], None).categories) == ("?", "⠁", "⠃")


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


def test_some_of_the_trials():
    trials, _ = made(
        "P1 T0 ac ac 2 left",
        "P1 T25 ac aa 3 left",
        "P2 T0 ca ca 4 right",
        columns="participant condition presented answered duration_s hand",
    )
    part = chosen(trials, trials["participant"] == "P1")
    assert len(part) == 2
    assert levels(part.participant) == ("P1",)
    assert levels(part.presented) == ("⠁⠉",)
    assert part["correct"].tolist() == [True, False]
    assert part["duration_s"].tolist() == [2.0, 3.0]
    assert part["hand"].tolist() == ["left", "left"]
    last = chosen(trials, trials["hand"] == "right")
    assert last[["hand", "trial"]].to_dict("list") == {"hand": ["right"], "trial": [3]}


def test_trials_as_a_file_has_them():
    trials, _ = made(
        "P1 T0 ac a? - 3 left", "P2 T25 a A 1.5 - right",
        columns="participant condition presented answered duration_s block hand",
    )  # fmt: skip
    assert to_csv(written(trials)).splitlines() == [
        "participant,session,protocol,condition,block,trial,presented,string_set,answered,correct,"
        "duration_s,hand",
        "P1,made,,T0,3,1,⠁⠉,,⠁?,0,,left",
        "P2,made,,T25,,2,⠁,,⠁,1,1.5,right",
    ]


def test_columns_have_their_types():
    trials, _ = made("P1 T0 ac ac 2")
    types = [str(kind) for kind in trials[list(TRIAL_COLUMNS)].dtypes]
    assert types == [*["category"] * 4, *["int64"] * 2, *["category"] * 3, "bool", "float64"]


def test_trials_are_compared_by_what_they_have():
    trials, _ = made(
        "P1 T0 a a 2 left",
        "P1 T25 a a 1 right",
        columns="participant condition presented answered block hand",
    )
    assert comparable(trials) == ["condition", "block", "session", "protocol", "hand"]


def test_places_are_those_of_answers_as_long_as_their_string():
    trials, places = answers("P1 T0 ac a?", "P1 T0 ca c", "P1 T0 a ca", "P1 T0 ⠈⠀c aca")
    assert trials["correct"].tolist() == [False] * 4
    assert places.frame.index.tolist() == [0, 0, 3, 3, 3]
    assert places.frame["presented"].tolist() == [1, 9, 8, 0, 9]
    assert places.frame["answered"].tolist() == [1, UNREAD_MASK, 1, 9, 1]
    assert places.frame["correct"].tolist() == [True, False, False, False, False]
    assert (places.unequal, len(places)) == (2, 5)
    wrong = places.where(~places.frame["correct"])
    assert (wrong.frame.index.tolist(), wrong.frame["presented"].tolist()) == (
        [0, 3, 3, 3],
        [9, 8, 0, 9],
    )
    assert (len(wrong), wrong.unequal) == (4, 2)


def test_places_of_answers_of_other_lengths_are_none():
    trials, places = answers("P1 T0 ac a", "P1 T0 a ac")
    assert (len(places), places.unequal) == (0, 2)
    assert len(Places.of(trials.head(1))) == 0
