"""``vbraille keys``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.cli.old.terminal import print_json
from vbraille.config.settings import load_settings
from vbraille.reading.commands.table import bound_for
from vbraille.reading.keys import spoken

if TYPE_CHECKING:
    import argparse

    from vbraille.reading.keys import Bound


def run(arguments: argparse.Namespace) -> int:
    """Print a line for each command: its name, its keys, and what it does."""
    bound = bound_for(load_settings(arguments.settings), arguments.keys)
    if arguments.json:
        print_json(_rows(bound))
        return 0
    for command in bound.commands:
        print(f"{command.name}: {command.spoken_keys}: {command.help}")
    for number, command in sorted(bound.buttons.items()):
        print(f"{command.name}: button {number}: {command.help}")
    for number, name in sorted(bound.knobs.items()):
        print(f"{name}: knob {number}")
    return 0


def _rows(bound: Bound) -> list[dict[str, object]]:
    return [
        {
            "command": command.name,
            "keys": [spoken(key) for key in command.keys],
            "buttons": [n for n, called in sorted(bound.buttons.items()) if called is command],
            "help": command.help,
            "when": [context.value for context in command.contexts],
        }
        for command in bound.commands
    ]
