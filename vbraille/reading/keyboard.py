"""Keys of a terminal, one at a time, without waiting for a line."""

from __future__ import annotations

import os
import re
import select
import sys
import termios
import tty
from contextlib import suppress
from typing import Self

_SEQUENCES = {"\x1b[A": "up", "\x1b[B": "down", "\x1bOA": "up", "\x1bOB": "down"}
# What one key sends: an escape sequence, whole (ECMA-48, 5.4; a function key), or a character.
_KEY = re.compile(r"\x1b(?:\[[0-?]*[ -/]*[@-~]|O.|[^\x1b])?|.", re.DOTALL)


class Keyboard:
    """The terminal on standard input; a context manager that leaves it as it was.

    Its `pressed` gives what was typed since the last call. Where standard
    input is no terminal there are no keys.
    """

    def __init__(self) -> None:
        self._descriptor = sys.stdin.fileno() if sys.stdin and sys.stdin.isatty() else None
        self._before: list | None = None

    @property
    def attached(self) -> bool:
        """Whether there is a terminal to type at."""
        return self._descriptor is not None

    def __enter__(self) -> Self:
        if self._descriptor is not None:
            self._before = termios.tcgetattr(self._descriptor)
            try:
                tty.setcbreak(self._descriptor)
            except BaseException:  # a signal
                self._restore()
                raise
        return self

    def __exit__(self, *_: object) -> None:
        self._restore()

    def _restore(self) -> None:
        if self._descriptor is not None and self._before is not None:
            with suppress(termios.error):  # the terminal is gone
                termios.tcsetattr(self._descriptor, termios.TCSADRAIN, self._before)

    def pressed(self, wait_s: float = 0.0) -> list[str]:
        """Keys typed since the last call; arrows as "up" and "down".

        If there are none, it waits so long for one.
        """
        watched = [] if self._descriptor is None else [self._descriptor]
        if not select.select(watched, [], [], wait_s)[0] or self._descriptor is None:
            return []
        try:
            typed = os.read(self._descriptor, 4096)
        except OSError:
            typed = b""
        if not typed:  # the terminal is gone
            self._descriptor = None
            return ["q"]
        keys: list[str] = _KEY.findall(typed.decode("utf-8", "ignore"))
        named = (_SEQUENCES.get(key, key) for key in keys)
        return [key for key in named if not key.startswith("\x1b")]
