"""The table of commands: every key does what it says, where it says."""

import pytest

from tests.reading.test_reader import Bench
from vbraille.reading import COMMANDS, Context
from vbraille.reading.commands.table import BOUND
from vbraille.reading.keys import ANY, PASTE, PASTE_REST


@pytest.mark.parametrize("context", Context)
def test_a_key_has_one_meaning_in_a_context(context):
    commands = tuple(BOUND.of(context))
    keys = [key for command in commands for key in command.keys]
    assert len(set(keys)) == len(keys) > 0
    assert [BOUND.find(key, context) for command in commands for key in command.keys] == [
        command for command in commands for _ in command.keys
    ]


def test_names_are_unique_and_each_is_called_somewhere():
    assert len({command.name for command in COMMANDS}) == len(COMMANDS)
    assert all(command.contexts and command.keys for command in COMMANDS)


@pytest.mark.parametrize(
    "command", list(BOUND.of(Context.READING)), ids=lambda command: command.name
)
def test_every_command_says_something_or_ends_the_reading(command):
    for key in command.keys:
        bench = Bench()
        assert bench.press([key]) or bench.reader.done


def test_help_says_every_key_of_the_context():
    bench = Bench()
    said = bench.press("h")
    assert said == [
        f"{command.spoken_keys}: {command.help}" for command in BOUND.of(Context.READING)
    ]
    assert "n or down: next line" in said
    assert "space: rest the array at once, or go on" in said
    assert not any(ANY in sentence for sentence in said)


def test_a_key_that_calls_nothing_says_how_to_learn_the_keys():
    bench = Bench()
    assert bench.press("é") == ["no command: é; h says the keys"]
    assert bench.press([PASTE]) == ["paste: text that is pasted is passed over; type the keys"]
    bench.press("q")
    assert bench.reader.done


def test_a_pasted_line_is_typed_where_a_text_is_asked_for():
    bench = Bench("one two\n\nthree four")
    pastes = [PASTE + "ee\tfo\x1b", PASTE_REST + "u"]
    assert bench.press(["/", "e", *pastes, "r", "\x7f", "\n"])[1] == "text: eeefou"
    said = bench.press(["m", PASTE + "here, " * 100, "\n"])
    assert said[1:] == [f"name: {('here, ' * 100)[:200].strip()}", f"bookmark {said[1][6:]}: set"]
    assert bench.press([PASTE_REST + "u"]) == []


def test_while_the_left_stop_is_asked_for_any_key_is_the_answer():
    bench = Bench()
    bench.reader.context = Context.PLACING
    for number, key in enumerate(("n", "x", " ", "down"), 1):
        assert bench.press([key]) == []
        assert bench.device.zeroed == number
    assert bench.press([PASTE]) == ["paste: text that is pasted is passed over; type the keys"]
    assert bench.device.zeroed == 4
    assert bench.reader.line.number == 1
    bench.reader.press("q")
    assert bench.reader.done
