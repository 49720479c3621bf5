"""Help: sentences that stand alone, and examples that work."""

import argparse
import shlex

import pytest

from vbraille.cli.commandtable import ACTIONS, COMMANDS
from vbraille.cli.parser import CommandParser, parse

ALL = {
    **COMMANDS,
    **{f"{name} {action}": ACTIONS[name][action] for name in ACTIONS for action in ACTIONS[name]},
}


def options_of(command):
    parser = CommandParser(command=ALL[command])
    parser.complete()
    return parser._actions


def test_an_option_is_one_thing_whatever_the_command():
    """An option has the same sentence, form and reader in each command; defaults may differ."""
    given = {}
    for command in ALL:
        for option in options_of(command):
            if option.option_strings and option.dest not in ("help", "participants"):
                does = option.help.partition(" (default: ")[0].rstrip(".")
                form = type(option).__name__, option.type, bool(option.choices), does
                assert given.setdefault(option.dest, form) == form, command


def test_what_prints_a_table_prints_json_and_what_writes_a_file_can_replace_it():
    """Folders are new: none that holds answers or a report is replaced."""
    for command in ALL:
        options = {option.dest: option for option in options_of(command)}
        if "out" in options and options["out"].metavar != "DIR":
            assert "force" in options, command
    for command in (
        *("books", "keys", "settings", "tables", "structure", "analyse", "power", "predict"),
        *("device list", "device info", "scene check", "scene cost"),
        *("session protocols", "session plan"),
    ):
        assert "json" in {option.dest for option in options_of(command)}, command


@pytest.mark.parametrize("command", ALL)
def test_each_option_has_a_sentence_with_its_default(command):
    text = ALL[command].does
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
            assert "(default: " in said, said


@pytest.mark.parametrize("command", ALL)
def test_each_example_is_in_the_help_and_can_be_given(command, capsys):
    example = ALL[command].example
    with pytest.raises(SystemExit):
        parse([*command.split(), "--help"])
    assert f"example:\n  {example}\n" in capsys.readouterr().out
    arguments = parse(shlex.split(example.partition(" > ")[0])[1:])
    assert arguments.command == command.split()[0]
