"""A text that the reader types, which is collected without a word until Enter."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

LONGEST = 200  # characters


@dataclass(slots=True)
class Prompt:
    """A question that is answered by typing.

    Parameters
    ----------
    label
        What the answer is, as in "text: …", when it is said at the end.
    then
        Function that is called with the answer, without blanks around it.
    again
        The answer if nothing is typed; empty if there is none.
    typed
        What has been typed so far.
    """

    label: str
    then: Callable[[str], None]
    again: str = ""
    typed: str = ""

    def press(self, key: str) -> None:
        """Take a key that is a character; others are passed over."""
        if len(key) == 1 and key.isprintable() and len(self.typed) < LONGEST:
            self.typed += key

    def paste(self, text: str) -> None:
        """Take those characters of a pasted line that could have been typed."""
        for character in text:
            self.press(character)

    def erase(self) -> None:
        """Take the last character away."""
        self.typed = self.typed[:-1]
