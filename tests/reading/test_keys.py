"""Keys: names for bytes, commands for keys, and the prompt."""

import subprocess
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st

from vbraille.errors import InputError
from vbraille.reading.commands import Where, bindings, keys_of, own_keys, spoken, table, typed
from vbraille.reading.keys import KeyDecoder
from vbraille.reading.prompt import Prompt

EVERYWHERE = (Where.BOOK, Where.PICTURE, Where.FIGURE, Where.GAME, Where.TUNING)
TYPED = (
    b"a\xc3\xa9\x1b[A\x1b[1;5B\x1bOP\x1b[15~\x1bx\x1b[200~paste\nmore\x1b[201~"
    b"\xe6\x97\xa5\x1b[24;5~\r\x03"
)
NAMES = ["a", "é", "up", "ctrl-down", "f1", "f5", "alt-x", "paste:paste", "日", "ctrl-f12",
         "enter", "ctrl-c"]  # fmt: skip


def test_keys_are_the_same_however_bytes_are_cut():
    for cut in range(len(TYPED)):
        decoder = KeyDecoder()
        assert [*decoder.feed(TYPED[:cut]), *decoder.feed(TYPED[cut:])] == NAMES


@given(st.binary(max_size=60))
def test_any_bytes_end_in_keys_that_can_be_said(data):
    decoder = KeyDecoder()
    for key in [*decoder.feed(data), *decoder.settle()]:
        assert spoken(key)


def test_a_lone_escape_is_one_and_an_empty_paste_is_nothing_typed():
    decoder = KeyDecoder()
    assert list(decoder.feed(b"\x1b")) == []
    assert decoder.waits
    assert decoder.settle() == ["escape"]
    assert list(decoder.feed(b"\x1b[200~\x1b[201~n")) == ["paste:", "n"]


@pytest.mark.parametrize("where", EVERYWHERE)
@pytest.mark.parametrize("key_set", ["usual", "nvda"])
def test_no_two_commands_have_a_key_in_common(where, key_set):
    keys = [key for each in table(where) for key in (*keys_of(each, key_set), *each.also)]
    assert len(keys) == len(set(keys))
    assert all(each.help[:1].islower() or each.help[:1].isdigit() for each in table(where))


@pytest.mark.parametrize("where", EVERYWHERE)
def test_help_says_ten_keys_at_most(where):
    assert 1 <= sum(each.first for each in table(where)) <= 10


def test_names_of_keys_are_read_as_they_are_said():
    for each in table(Where.BOOK):
        for key in each.keys:
            assert typed(spoken(key)) == key


def test_keys_of_ones_own_win():
    own = own_keys({"pause": ["space", "f12"], "next-line": "shift-x"},
                   {"1": "next-heading", "knob 2": "texture", "display HOME": "pause"})  # fmt: skip
    bound = bindings("usual", Where.BOOK, own)
    assert [bound[key].name for key in ("f12", "X", "button:1", "pins:HOME")] == [
        "pause", "next-line", "next-heading", "pause",
    ]  # fmt: skip
    assert "n" not in bound
    assert own["knob:2"] == "texture"


@pytest.mark.parametrize(
    ("keys", "buttons", "named"),
    [
        ({"next-lime": ["x"]}, {}, "next-lime.*next-line"),
        ({"pause": ["x"], "quit": ["x"]}, {}, "'x'"),
        ({}, {"1": "nothing"}, "nothing"),
        ({}, {"knob 1": "dots"}, "dots"),
    ],
)
def test_wrong_keys_of_ones_own_are_refused(keys, buttons, named):
    with pytest.raises(InputError, match=named):
        own_keys(keys, buttons)


@given(st.lists(st.sampled_from([*"ab c", "left", "right", "backspace", "delete", "home", "end",
                                 "ctrl-w", "ctrl-u", "ctrl-k", "up", "down", "tab", "f9",
                                 "paste:x y"])))  # fmt: skip
def test_a_prompt_keeps_its_cursor_in_the_text(keys):
    answers = []
    prompt = Prompt("question", answers.append, ["older", "newer"])
    for key in keys:
        assert prompt.press(key) is not None
        assert 0 <= prompt.cursor <= len(prompt.text)
    text = prompt.text
    assert prompt.press("enter") is None
    assert answers == [text]


def test_a_prompt_brings_what_was_typed_before():
    prompt = Prompt("question", print, ["older", "newer"])
    assert prompt.press("up") == "newer"
    assert prompt.press("up") == prompt.press("up") == "older"
    prompt.press("down"), prompt.press("down")
    assert prompt.text == ""


@pytest.mark.parametrize("first", ["searching", "structure", "screen", "moving"])
def test_commands_stand_in_one_order_whatever_was_loaded_first(first):
    told = "from vbraille.reading.commands import Where, table\n"
    told += "print([each.name for each in table(Where.BOOK)])"
    orders = {
        subprocess.run(
            [sys.executable, "-c", before + told], capture_output=True, text=True, check=True
        ).stdout
        for before in ("", f"import vbraille.reading.{first}\n")
    }
    assert len(orders) == 1
