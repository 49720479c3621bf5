"""What pages of the live view ask of a reader: the same as its keys, and no more."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.reading.commands.test_turning import bench
from tests.tiers import examples
from vbraille.config.settings import KNOBS
from vbraille.live.messages import PagePress, Turn
from vbraille.reading.commands.table import COMMANDS
from vbraille.reading.keys import Context
from vbraille.reading.liveview import obey_page

KEYS = {
    "texture": "tT", "contrast": "cC", "dot_width_mm": "dD", "dot_spacing_mm": "sS",
    "cell_gap_mm": "jJ",
}  # fmt: skip
NAMES = {command.name: command for command in COMMANDS}


def asked(made, *requests):
    """What is said when a page asks."""
    before = len(made.said)
    for request in requests:
        obey_page(made.reader, request)
    return made.said[before:]


@pytest.mark.parametrize("name", KEYS)
@pytest.mark.parametrize("steps", [1, -1])
def test_a_knob_turned_by_a_page_is_a_knob_turned_by_a_key(name, steps):
    by_key, by_page = bench(), bench()
    for made in (by_key, by_page):
        made.press("Tdd")
    knob = KNOBS[name]
    key = KEYS[name][steps < 0]
    value = knob.turned(knob.value(by_page.reader.style), steps)
    said = by_key.press(key)
    assert asked(by_page, Turn(name, value)) in (said, [])  # at its end a page asks for no change
    assert by_page.reader.style == by_key.reader.style
    assert by_page.press("U") == by_key.press("U")
    assert by_page.reader.style == by_key.reader.style


@examples(60)
@given(st.sampled_from(list(KNOBS)), st.floats(width=32))
def test_whatever_a_page_asks_of_a_knob_it_stays_within_its_bounds(name, value):
    made = bench()
    before = made.reader.style
    said = asked(made, Turn(name, value))
    knob = KNOBS[name]
    assert knob.low <= knob.value(made.reader.style) <= knob.high
    assert len(said) == (value != knob.value(before))
    if made.reader.style != before:
        asked(made, PagePress("UNDO"))
        assert made.reader.style == before


def test_a_knob_stops_at_its_end_and_says_why():
    made = bench()
    assert asked(made, Turn("contrast", 5.0)) == ["contrast: 1, the most"]
    assert asked(made, Turn("contrast", 0.25), Turn("contrast", -3.0)) == [
        "contrast: 0.25", "contrast: 0",
    ]  # fmt: skip
    assert asked(made, Turn("dot_width_mm", 20.0)) == [
        "dot width: 2.6 mm, the most: a dot must not be wider than the cell pitch"
    ]
    assert asked(made, Turn("texture_cycles", 8.0)) == ["texture cycles: 9"]
    assert len(made.cues) == 2


@pytest.mark.parametrize(
    ("request_", "why"),
    [
        (Turn("warmth", 1.0), "live view: warmth is no knob"),
        (Turn("\x1b[2J" + 99 * "x", 1.0), "live view: <escape>[2J" + 36 * "x" + " is no knob"),
        (Turn("texture", math.nan), "live view: texture cannot be nan; it must be a number"),
        (Turn("texture", math.inf), "live view: texture cannot be inf; it must be a number"),
        (PagePress("QUIT"), "live view: QUIT is no command that a page may call"),
        (PagePress("nothing"), "live view: nothing is no command that a page may call"),
    ],
)
def test_what_cannot_be_done_is_said_in_a_sentence(request_, why):
    made = bench()
    style = made.reader.style
    assert asked(made, request_) == [why]
    assert made.reader.style == style
    assert not made.reader.done


def test_a_command_does_and_says_what_its_key_does():
    by_key, by_page = bench(), bench()
    for name, key in (("LNDN", "n"), ("INFO", "i"), ("PAUSE", " "), ("MAPPING", "#"), ("BOT", ">")):
        assert asked(by_page, PagePress(name)) == by_key.press(key)
        assert by_page.reader.line.number == by_key.reader.line.number
    assert by_page.reader.engine.paused
    assert by_page.reader.style == by_key.reader.style


@pytest.mark.parametrize("name", sorted(name for name, command in NAMES.items() if command.paged))
def test_no_command_that_a_page_may_call_asks_for_a_text_or_ends_the_reading(name):
    made = bench()
    NAMES[name].handler(made.reader)
    assert made.reader.context is Context.READING
    assert made.reader.prompt is None
    assert made.reader.kept.bookmarks() == []
    assert not made.reader.done or name in ("LNDN", "FWINRT")


@pytest.mark.parametrize("context", [Context.PROMPT, Context.LEARNING, Context.PLACING])
def test_while_the_keys_mean_something_else_a_page_does_nothing(context):
    made = bench()
    made.reader.context = context
    style = made.reader.style
    sentence = "live view: not now; what the keys have begun comes first"
    assert asked(made, PagePress("LNDN"), Turn("texture", 0.5)) == [sentence] * 2
    assert made.reader.style == style
    assert made.reader.line.number == 1
