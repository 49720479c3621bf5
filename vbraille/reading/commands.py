"""The commands of a reader and their keys; names as in BRLTTY where it has them."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Command:
    """A command.

    Parameters
    ----------
    name
        Of the method of `vbraille.reading.Reader` that does it, in capitals.
    keys
        That call it, as `vbraille.reading.keyboard` names them.
    help
        What it does, for people.
    """

    name: str
    keys: tuple[str, ...]
    help: str

    @property
    def spoken_keys(self) -> str:
        """Its keys as people call them."""
        return " or ".join("space" if key == " " else key for key in self.keys)


COMMANDS = (
    Command("LNDN", ("n", "down"), "next line"),
    Command("LNUP", ("p", "up"), "previous line"),
    Command("WORD", ("w",), "say the word under the finger"),
    Command("PAUSE", (" ",), "rest the array at once, or go on"),
    Command("TEXTURE_UP", ("t",), "more texture"),
    Command("TEXTURE_DOWN", ("T",), "less texture"),
    Command("CONTRAST_UP", ("c",), "more contrast"),
    Command("CONTRAST_DOWN", ("C",), "less contrast"),
    Command("HELP", ("h", "?"), "say the keys"),
    Command("QUIT", ("q",), "stop reading"),
)
BY_KEY = {key: command for command in COMMANDS for key in command.keys}
