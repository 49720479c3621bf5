"""Scripts and keys that move buttons and knobs."""

import pytest

from vbraille.errors import InputError
from vbraille.simulation.controls import (
    SHORT_S,
    Controls,
    load_script,
    parse_presses,
    parse_script,
)

SCRIPT = """# what a finger does
2.5s press 1

4s knob 1 0.8
3s release 1
250ms knob 4 0
"""


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("press 1", r"'press 1' is no event; write a time and what is done then, such as 2.5s"),
        ("2 press 1", "is no event"),
        ("-1s press 1", "is no event"),
        ("2s push 1", "is no event"),
        ("2s press", "is no event"),
        ("2s press 1 2", "is no event"),
        ("2s knob 1", "is no event"),
        ("2s knob 1 high", "is no event"),
        ("2s press 9", "button is 9; it must be 1 to 8"),
        ("2s release 0", "button is 0; it must be 1 to 8"),
        ("2s knob 5 0.1", "knob is 5; it must be 1 to 4"),
        ("2s knob 1 1.1", "position of the knob is 1.1; it must be 0 to 1"),
        ("4000s press 1", "time is 4000 s; it must be 0 to 3600 s"),
    ],
)
def test_a_bad_line_is_named_by_its_number(line, said):
    with pytest.raises(InputError, match=rf"script\.txt, line 3: .*{said}"):
        parse_script(f"1s press 1\n\n{line}\n", "script.txt")


def test_a_script_that_cannot_be_read_is_one_sentence(tmp_path):
    with pytest.raises(InputError, match="there is no file"):
        load_script(str(tmp_path / "script.txt"))


def test_a_script_in_a_file(tmp_path):
    path = tmp_path / "script.txt"
    path.write_text(SCRIPT)
    assert load_script(str(path)) == parse_script(SCRIPT, "")


def test_buttons_and_knobs_stand_as_the_script_has_moved_them_so_far():
    controls = Controls((*parse_script(SCRIPT, ""), *parse_presses("8@1s-2.75s")))
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


def test_events_of_one_time_are_done_in_the_order_of_the_script():
    controls = Controls(parse_script("1s knob 1 0.2\n1s knob 1 0.9\n1s knob 1 0.4\n", ""))
    controls.advance(1.0)
    assert controls.knobs[0] == 0.4


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
