"""The commands of a reader who feels a figure of a text: those of a picture, and the way back."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from vbraille.feeling.commands import BUTTONS, COMMANDS
from vbraille.reading.bindings import Bindings, Command, bind

if TYPE_CHECKING:
    from vbraille.feeling.feeler import Feeler


def back(feeler: Feeler) -> None:
    """Go back to the text."""
    feeler.quit()


# In a text Escape leads back; the way to an element is then said until the finger is there.
_OTHERS = tuple(
    replace(command, keys=()) if command.name == "CANCEL" else command for command in COMMANDS
)
FROM_TEXT = (Command("BACK", ("G", "escape"), "back to the text", back), *_OTHERS)
BOUND = bind(FROM_TEXT, Bindings(buttons=BUTTONS))
