"""Lines that are typed at a terminal, key by key, so that they can be edited and spoken."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from vbraille.reading.keys import Keyboard
from vbraille.reading.prompt import Prompt
from vbraille.sessions.running.answers import Line, Typed

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import Self


class TypedKeys(Typed):
    """Lines of a person at a terminal; a context manager that leaves the terminal as it was.

    Parameters
    ----------
    speak
        Function that speaks what is said, and what the cursor comes to.
    """

    def __init__(self, speak: Callable[[str], None]) -> None:
        super().__init__()
        self._speak = speak
        self._keyboard = Keyboard()
        self._prompt = self._new()

    def __enter__(self) -> Self:
        self.take()
        return self

    def __exit__(self, *_: object) -> None:
        self.release()

    def say(self, sentence: str) -> None:
        """Print a sentence in a line of its own, with what is being typed after it."""
        print(f"\r\x1b[K{sentence}")
        self._draw()
        self._speak(sentence)

    def take(self) -> None:
        """Have the terminal give each key at once."""
        self._keyboard.take()

    def release(self) -> None:
        """Leave the terminal as it was."""
        self._keyboard.give_back()

    def _new(self) -> Prompt:
        return Prompt("line", lambda text: self._given.append(Line(text)))

    def _read(self, wait_s: float) -> None:
        """Take the keys that were pressed within some time."""
        for key in self._keyboard.pressed(wait_s):
            try:
                said = self._prompt.press(key)
            except KeyError:
                self._over = key == "ctrl-d" and not self._prompt.text
                said = None
            if said is None:
                print()
                self._prompt = self._new()
                continue
            self._draw()
            if len(key) > 1:
                self._speak(said)
        self._over = self._over or not self._keyboard.attached

    def _draw(self) -> None:
        """Show what is being typed, with the cursor in its place."""
        text, cursor = self._prompt.text, self._prompt.cursor
        sys.stdout.write(f"\r\x1b[K{text}" + "\b" * (len(text) - cursor))
        sys.stdout.flush()
