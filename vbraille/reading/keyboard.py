"""Keys of a terminal, one at a time, without waiting for a line."""

from __future__ import annotations

import os
import select
import sys
import termios
import tty
from typing import Self

_SEQUENCES = {"\x1b[A": "up", "\x1b[B": "down", "\x1bOA": "up", "\x1bOB": "down"}


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
            tty.setcbreak(self._descriptor)
        return self

    def __exit__(self, *_: object) -> None:
        if self._descriptor is not None and self._before is not None:
            termios.tcsetattr(self._descriptor, termios.TCSADRAIN, self._before)

    def pressed(self) -> list[str]:
        """Keys typed since the last call; arrows as "up" and "down". Never waits."""
        if self._descriptor is None or not select.select([self._descriptor], [], [], 0)[0]:
            return []
        typed = os.read(self._descriptor, 64).decode("utf-8", "ignore")
        if not typed:  # the terminal is gone
            self._descriptor = None
            return ["q"]
        for sequence, name in _SEQUENCES.items():
            if typed == sequence:
                return [name]
        return [] if typed.startswith("\x1b") else list(typed)
