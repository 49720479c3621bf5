"""Errors by dots added, removed and moved."""

import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.analysis.making import answers
from vbraille.analysis.input.trials import UNREAD_MASK, Places
from vbraille.analysis.measures.confusion import errors


def kinds(table):
    return {row["error"]: row["count"] for row in table.records()}


def of_masks(*pairs):
    frame = pd.DataFrame(pairs, columns=["presented", "answered"])
    return errors(Places(frame.assign(correct=frame["presented"] == frame["answered"]), 0))


@pytest.mark.parametrize(
    ("presented", "answered", "name", "numbers"),
    [
        ("⠁", "⠉", "1 dot added", (1, 0, 0)),
        ("⠉", "⠁", "1 dot removed", (0, 1, 0)),
        ("⠁", "⠈", "1 dot moved", (0, 0, 1)),
        ("⠀", "⠉", "2 dots added", (2, 0, 0)),
        ("⠉", "⠀", "2 dots removed", (0, 2, 0)),
        ("⠃", "⠘", "2 dots moved", (0, 0, 2)),
        ("⠁", "⠘", "1 dot moved, 1 dot added", (1, 0, 1)),
        ("⠿", "⡀", "1 dot moved, 5 dots removed", (0, 5, 1)),
        ("⠉", "?", "not read", (0, 0, 0)),
    ],
)
def test_what_is_wrong_with_an_answer(presented, answered, name, numbers):
    table = errors(answers(f"P1 T0 {presented} {answered}")[1])
    assert table.rows == ((name, *numbers, 1, 1.0),)
    assert table.notes == ()


def test_the_most_frequent_come_first_and_those_not_read_last():
    lines = ["a c"] + ["a ⠈"] * 2 + ["c a"] + ["c c"] * 9 + ["c ?"] * 3
    table = errors(answers(*(f"P1 T0 {line}" for line in lines))[1])
    assert list(kinds(table).items()) == [
        ("1 dot moved", 2),
        ("1 dot removed", 1),
        ("1 dot added", 1),
        ("not read", 3),
    ]
    assert table.frame["share"].tolist() == [2 / 7, 1 / 7, 1 / 7, 3 / 7]


def test_without_errors_it_is_said_so():
    table = errors(answers("P1 T0 ac ac")[1])
    assert (table.rows, table.notes) == ((), ("no place was answered wrongly",))
    table = errors(answers("P1 T0 ac a")[1])
    assert table.rows == ()
    assert table.notes[0].startswith("1 answer of another number of places")
    assert table.notes[1] == "no place was answered wrongly"


MASKS = st.integers(0, 255)


@given(st.lists(st.tuples(MASKS, MASKS | st.just(UNREAD_MASK)), min_size=1))
def test_dots_add_up(pairs):
    table = of_masks(*pairs)
    wrong = [(shown, answer) for shown, answer in pairs if shown != answer]
    assert sum(table.frame["count"].tolist()) == len(wrong)
    read = [(shown, answer) for shown, answer in wrong if answer != UNREAD_MASK]
    more = sum((row["added"] - row["removed"]) * row["count"] for row in table.records())
    assert more == sum(answer.bit_count() - shown.bit_count() for shown, answer in read)
    changed = sum(
        (row["added"] + row["removed"] + 2 * row["moved"]) * row["count"] for row in table.records()
    )
    assert changed == sum((shown ^ answer).bit_count() for shown, answer in read)
    assert all(row["added"] == 0 or row["removed"] == 0 for row in table.records())
    if wrong:
        assert sum(table.frame["share"].tolist()) == pytest.approx(1)


@given(st.lists(st.tuples(MASKS, MASKS), min_size=1))
def test_what_is_presented_and_what_is_answered_change_places(pairs):
    there, back = of_masks(*pairs), of_masks(*((answer, shown) for shown, answer in pairs))
    turned = {(r["removed"], r["added"], r["moved"], r["count"]) for r in back.records()}
    assert {(r["added"], r["removed"], r["moved"], r["count"]) for r in there.records()} == turned
