"""Keys of the terminal that move buttons and knobs of a simulated device."""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from typing import TYPE_CHECKING, Self

if TYPE_CHECKING:
    from vbraille.cli.old.reading.keyboard import Keyboard


class ControlKeys:
    """Keys typed at the terminal on standard input; a context manager that leaves it as it was.

    A program that runs in the background takes none: they are the foreground's.
    """

    def __init__(self) -> None:
        self._keyboard: Keyboard | None = None
        self._taken = False
        if sys.stdin and sys.stdin.isatty():
            from vbraille.cli.old.reading.keyboard import Keyboard

            self._keyboard = Keyboard()

    @property
    def attached(self) -> bool:
        """Tell whether there is a terminal to type at, and the program is in its foreground."""
        return self._keyboard is not None and self._keyboard.attached and _in_front()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        if self._keyboard is not None and self._taken and _in_front():
            self._keyboard.release()

    def pressed(self) -> list[str]:
        """Keys typed since the last call; none in the background."""
        if self._keyboard is None or not self.attached:
            self._taken = False  # the program that has the terminal now sets it as it likes
            return []
        if not self._taken:
            self._keyboard.take()
            self._taken = True
        return self._keyboard.pressed()


def _in_front() -> bool:
    """Tell whether the program is in the foreground of the terminal on standard input."""
    with suppress(OSError, ValueError, AttributeError):
        return os.tcgetpgrp(sys.stdin.fileno()) == os.getpgrp()
    return False
