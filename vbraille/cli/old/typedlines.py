"""Lines that are typed at a terminal, and edited as the texts of a reading are.

The terminal gives each key at once, and this echoes what is typed: with blanks and backspaces
alone, as any terminal has them. What the cursor comes to is said in a line, for speech and for
braille.
"""

from __future__ import annotations

import os
import select
import termios
import time
import tty
from contextlib import suppress
from typing import TYPE_CHECKING, Final

from vbraille.cli.old.reading.commands.table import TYPING
from vbraille.cli.old.reading.keys import Keys
from vbraille.cli.old.reading.view import Prompt
from vbraille.sessions.running.responses import KeyPress, Typed

if TYPE_CHECKING:
    from collections.abc import Callable

_LONGEST: Final = 4095  # characters of a line, as a terminal takes them by itself
_END_OF_FILE: Final = "\x04"
_WHOLE: Final = ("ENTER", "GIVE_UP")  # commands that are of a question of a reading
_EDITS: Final = {
    key: command.handler for command in TYPING if command.name not in _WHOLE for key in command.keys
}


class _Line:
    """A line that is being typed, as the commands that edit one know it, and what they say."""

    def __init__(self) -> None:
        self.prompt = Prompt("line", lambda _: None, longest=_LONGEST)
        self.said: list[str] = []

    def say(self, sentence: str) -> None:
        self.said.append(sentence)


class EditedLines(Typed):
    """Lines of a person at a terminal, whose keys come one at a time once it is taken.

    Parameters
    ----------
    say
        Function that prints a line.
    """

    def __init__(self, say: Callable[[str], None]) -> None:
        super().__init__()
        self._print = say
        self._keys = Keys()
        self._line = _Line()
        self._before: list | None = None  # settings of the terminal
        self._single: str | None = None  # the key that is told at once where it is awaited

    def say(self, sentence: str) -> None:
        """Say a sentence in a line of its own, with what is typed in the line after it."""
        typed, cursor = self._line.prompt.typed, self._line.prompt.cursor
        if typed:
            self._echo("\b" * cursor + " " * len(typed) + "\r")
        self._print(sentence)
        self._echo(typed + "\b" * (len(typed) - cursor))

    def take(self) -> None:
        """Have the terminal give each key at once, and echo none."""
        if self._descriptor is not None:
            with suppress(termios.error):  # the terminal is gone, which reading from it tells
                self._before = termios.tcgetattr(self._descriptor)
                tty.setcbreak(self._descriptor, termios.TCSANOW)

    def release(self) -> None:
        """Leave the terminal as it was."""
        before, self._before = self._before, None
        if self._descriptor is not None and before is not None:
            with suppress(termios.error):
                termios.tcsetattr(self._descriptor, termios.TCSANOW, before)

    def watch(self, key: str) -> bool:
        """Look out for a key, whose presses `lines` gives as a `KeyPress`."""
        self._single = key
        return True

    def await_key(self, awaited: bool) -> None:
        """Have the key that is looked out for told at once, or typed like all others."""
        self._awaited = awaited

    def lines(self, wait_s: float) -> list[str] | None:
        """Lines typed since the last call; see `Responses`."""
        if self._waiting:
            lines, self._waiting = self._waiting, []
            return lines
        if self._descriptor is None:
            return None
        ready = select.select([self._descriptor], [], [], wait_s)[0]
        now_s = time.monotonic()
        if not ready:
            keys = self._keys.wait(now_s)
        else:
            try:
                typed = os.read(self._descriptor, 1 << 16)
            except OSError:  # the terminal was closed
                typed = b""
            # One byte at a time: lines that come together are lines, and no paste.
            keys = [key for byte in typed for key in self._keys.feed(bytes((byte,)), now_s)]
            keys = keys if typed else [_END_OF_FILE]
        lines: list[str] = []
        for key in keys:
            self._press(key, lines)
        return lines if lines or self._descriptor is not None else None

    def _press(self, key: str, lines: list[str]) -> None:
        typed = self._line.prompt.typed
        if key in ("\n", "\r"):
            self._echo("\n")
            self._end(lines)
        elif key == _END_OF_FILE:
            if typed:
                self._end(lines)
            self.release()
            self._descriptor = None
        elif key == self._single and self._awaited and not typed:
            if not (lines and isinstance(lines[-1], KeyPress)):  # presses together are one
                lines.append(KeyPress())
        else:
            self._edit(key)

    def _end(self, lines: list[str]) -> None:
        lines.append(self._line.prompt.typed)
        self._line = _Line()

    def _edit(self, key: str) -> None:
        """Change the line by a key, show it so, and say what the change says."""
        line, prompt = self._line, self._line.prompt
        before, at = prompt.typed, prompt.cursor
        if key in _EDITS:
            _EDITS[key](line)
        else:
            prompt.press(key)
        kept = min(at, prompt.cursor)  # all before both places is as it was
        rest = prompt.typed[kept:] + " " * max(len(before) - len(prompt.typed), 0)
        if (prompt.typed, prompt.cursor) != (before, at):
            back = kept + len(rest) - prompt.cursor
            self._echo("\b" * (at - kept) + rest + "\b" * back)
        for sentence in line.said:
            self.say(sentence)
        line.said.clear()

    def _echo(self, text: str) -> None:
        if text and self._descriptor is not None:
            with suppress(OSError):  # it can be read alone, or is gone
                os.write(self._descriptor, text.encode("utf-8", "replace"))
