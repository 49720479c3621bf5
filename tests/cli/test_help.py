"""Help: sentences that stand alone, and examples that work."""

import argparse
import shlex

import pytest

from vbraille.cli.parser import (
    COMMANDS,
    DEVICE_ACTIONS,
    SCENE_ACTIONS,
    SESSION_ACTIONS,
    CommandParser,
    parse,
)

ALL = {
    **COMMANDS,
    **{f"device {name}": action for name, action in DEVICE_ACTIONS.items()},
    **{f"scene {name}": action for name, action in SCENE_ACTIONS.items()},
    **{f"session {name}": action for name, action in SESSION_ACTIONS.items()},
}


def options_of(command):
    parser = CommandParser(add_help=False)
    _, add_options, _ = ALL[command]
    add_options(parser)
    return parser._actions


@pytest.mark.parametrize("command", ALL)
def test_each_option_has_a_sentence_with_its_default(command):
    text, *_ = ALL[command]
    assert text[0].isupper()
    assert text.endswith(".")
    for option in options_of(command):
        if isinstance(option, argparse._SubParsersAction):
            continue
        said = option.help
        assert said[0].isupper(), said
        assert said.endswith("."), said
        assert len(said.split()) > 3, said
        takes_a_value = option.option_strings and option.nargs != 0
        if takes_a_value and not option.required and "may be given again" not in said:
            tells = (
                "default: ",
                "Take only",
                "Refuse a",
                "List only",
                "See that",
                "Instead of",
                "Make a link",
            )
            assert any(words in said for words in tells), said


@pytest.mark.parametrize("command", ALL)
def test_each_example_is_in_the_help_and_can_be_given(command, capsys):
    *_, example = ALL[command]
    with pytest.raises(SystemExit):
        parse([*command.split(), "--help"])
    assert f"example:\n  {example}\n" in capsys.readouterr().out
    arguments = parse(shlex.split(example.partition(" > ")[0])[1:])
    assert arguments.command == command.split()[0]
