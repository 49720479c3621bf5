"""Moves at set times, and keys, that move buttons and knobs."""

import pytest

from vbraille.errors import InputError
from vbraille.simulation.controls import SHORT_S, Controls, parse_moves


def test_buttons_and_knobs_stand_as_they_were_moved_so_far():
    controls = Controls(parse_moves("1@2.5s-3s, knob 1 .8@4s,8@1s-2.75s,knob 4 0@0.25s"))
    assert controls.knobs == [0.5] * 4
    found = {}
    for now_s in (0.0, 0.25, 1.0, 2.5, 2.75, 3.0, 60.0):
        controls.advance(now_s)
        found[now_s] = controls.buttons, tuple(controls.knobs)
    assert found == {
        0.0: (0, (0.5, 0.5, 0.5, 0.5)),
        0.25: (0, (0.5, 0.5, 0.5, 0.0)),
        1.0: (0x80, (0.5, 0.5, 0.5, 0.0)),
        2.5: (0x81, (0.5, 0.5, 0.5, 0.0)),
        2.75: (0x01, (0.5, 0.5, 0.5, 0.0)),
        3.0: (0, (0.5, 0.5, 0.5, 0.0)),
        60.0: (0, (0.8, 0.5, 0.5, 0.0)),
    }


@pytest.mark.parametrize(
    "move",
    ["1", "9@1s", "0@1s", "1@1", "1@2s-2s", "1@-1s", "1@nans", "knob 5 0.1@1s", "knob 1 1.1@1s",
     "knob 1@1s", "1@1s,,2@2s"],
)  # fmt: skip
def test_what_is_no_move_is_refused(move):
    with pytest.raises(InputError, match="no button and no knob"):
        parse_moves(move)


def test_a_key_presses_a_button_for_a_moment():
    controls = Controls()
    assert controls.type("3", 5.0) == "button 3: pressed"
    assert controls.buttons == 0b100
    assert controls.type("1", 5.05) == "button 1: pressed"
    controls.advance(5.0 + SHORT_S)
    assert controls.buttons == 0b001
    controls.advance(5.05 + SHORT_S)
    assert controls.buttons == 0


def test_letters_turn_knobs_and_capitals_turn_them_back_as_far_as_they_go():
    controls = Controls()
    assert controls.type("a", 0.0) == "knob 1: 0.55"
    assert controls.type("A", 0.0) == "knob 1: 0.5"
    for _ in range(20):
        said = controls.type("d", 0.0)
    assert said == "knob 4: 1"
    for _ in range(30):
        said = controls.type("D", 0.0)
    assert said == "knob 4: 0"
    assert controls.knobs == [0.5, 0.5, 0.5, 0.0]


@pytest.mark.parametrize("key", ["9", "0", "e", "q", "enter", "up", "", "ä"])
def test_any_other_key_does_nothing(key):
    controls = Controls()
    assert controls.type(key, 0.0) == ""
    assert (controls.buttons, controls.knobs) == (0, [0.5] * 4)


def test_a_button_typed_again_is_held_for_the_whole_of_its_moment():
    controls = Controls()
    controls.type("1", 0.0)
    controls.type("1", 0.8 * SHORT_S)
    controls.advance(1.2 * SHORT_S)
    assert controls.buttons == 1
    controls.advance(1.9 * SHORT_S)
    assert controls.buttons == 0
