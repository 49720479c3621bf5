"""The commands of a reader: one table of what keys do, from which help and documents are made.

Names are BRLTTY's where it has the command.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from vbraille.reading.commands import asking, control, moving
from vbraille.reading.commands.turning import turn
from vbraille.reading.context import Context
from vbraille.reading.keys import PASTE

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.reading.reader import Reader

ANY = "any key"
EVERYWHERE = tuple(Context)


@dataclass(frozen=True, slots=True)
class Command:
    """Something that a reader can be told to do by a key.

    Parameters
    ----------
    name
        Name in documents, in capitals as BRLTTY has it.
    keys
        Keys that call the command, as `vbraille.reading.keys` names them; `ANY` for every key that
        calls no other command of the context.
    help
        What the command does, in words for its users.
    handler
        Function that does it.
    contexts
        Contexts in which the command can be called.
    """

    name: str
    keys: tuple[str, ...]
    help: str
    handler: Callable[[Reader], None]
    contexts: tuple[Context, ...] = (Context.READING,)

    @property
    def spoken_keys(self) -> str:
        """Names of the command's keys as people say them."""
        return " or ".join("space" if key == " " else key for key in self.keys)


def commands_of(context: Context) -> tuple[Command, ...]:
    """Commands that can be called in a context."""
    return tuple(command for command in COMMANDS if context in command.contexts)


def find(key: str, context: Context) -> Command | None:
    """Command that a key calls in a context; None if it calls none."""
    return _BY_KEY.get((context, key)) or _BY_KEY.get((context, ANY))


def press(reader: Reader, key: str) -> None:
    """Call the command that a key stands for in the reader's context."""
    command = find(key, reader.context)
    if key == PASTE:
        reader.say("paste: text that is pasted is passed over; type the keys")
    elif command is None:
        reader.say(f"no command: {key!r}; h says the keys")
    else:
        command.handler(reader)


def say_keys(reader: Reader) -> None:
    """Say what the keys do."""
    for command in commands_of(reader.context):
        reader.say(f"{command.spoken_keys}: {command.help}")


COMMANDS = (
    Command("LNDN", ("n", "down"), "next line", moving.next_line),
    Command("LNUP", ("p", "up"), "previous line", moving.previous_line),
    Command("WORD", ("w",), "say the word under the finger", asking.say_word),
    Command("PAUSE", (" ",), "rest the array at once, or go on", control.pause),
    Command("TEXTURE_UP", ("t",), "more texture", turn("texture", 1)),
    Command("TEXTURE_DOWN", ("T",), "less texture", turn("texture", -1)),
    Command("CONTRAST_UP", ("c",), "more contrast", turn("contrast", 1)),
    Command("CONTRAST_DOWN", ("C",), "less contrast", turn("contrast", -1)),
    Command("HELP", ("h", "?"), "say the keys", say_keys),
    Command("QUIT", ("q",), "stop reading", control.stop, EVERYWHERE),
    Command(
        "ZERO",
        (ANY,),
        "the carriage is at the left stop, when that is asked for",
        control.set_zero,
        (Context.PLACING,),
    ),
)
_BY_KEY = {
    (context, key): command
    for command in COMMANDS
    for context in command.contexts
    for key in command.keys
}
