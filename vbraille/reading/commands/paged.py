"""What pages of the live view ask of a reader: commands by their names, and knobs by values."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from vbraille.config.knobs import KNOBS
from vbraille.errors import InputError
from vbraille.live.messages import PagePress, Turn
from vbraille.reading.bindings import Context
from vbraille.reading.commands.table import COMMANDS
from vbraille.reading.commands.turning import turn_to
from vbraille.wording import printable, spelled

if TYPE_CHECKING:
    from vbraille.reading.reader import Reader

_COMMANDS: Final = {command.name: command for command in COMMANDS if command.paged}
_MOST_NAMED = 40  # characters of a name that nobody knows


def obey(reader: Reader, asked: PagePress | Turn) -> None:
    """Do what a page asks, as if the reader had pressed a key, or say why it cannot be done."""
    if reader.context is not Context.READING:
        reader.say("live view: not now; what the keys have begun comes first")
        return
    try:
        if isinstance(asked, PagePress):
            _press(reader, asked.command)
        else:
            _turn(reader, asked.knob, asked.value)
    except InputError as error:  # reading goes on
        reader.say(f"live view: {spelled(str(error))}")


def _press(reader: Reader, name: str) -> None:
    command = _COMMANDS.get(name)
    if command is None:
        raise InputError(f"{printable(name[:_MOST_NAMED])} is no command that a page may call")
    command.handler(reader)


def _turn(reader: Reader, name: str, value: float) -> None:
    if name not in KNOBS:
        raise InputError(f"{printable(name[:_MOST_NAMED])} is no knob")
    if not math.isfinite(value):
        raise InputError(f"{KNOBS[name].label} cannot be {value}; it must be a number")
    turn_to(reader, name, value)
