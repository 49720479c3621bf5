"""A key of the terminal that is told as soon as it is pressed, while lines are typed as ever.

The terminal goes on to edit and to show lines by itself. The key is made a second end of lines
(VEOL of termios) for as long as it is waited for, so that a press of it on an empty line comes at
once, with no Enter.
"""

from __future__ import annotations

import os
import termios
from contextlib import suppress

_OFF = b"\0"  # the sign for none


class KeyPress(str):
    """The participant's key, where a line might have come."""

    __slots__ = ()


class TerminalKey:
    """A key of a terminal.

    Parameters
    ----------
    descriptor
        Descriptor of the terminal.
    key
        Character that the key types.
    """

    def __init__(self, descriptor: int, key: str) -> None:
        self._descriptor = descriptor
        self._key = key.encode("ascii")
        self._told = False

    @classmethod
    def at(cls, descriptor: int | None, key: str) -> TerminalKey | None:
        """Make it if the descriptor is that of a terminal which takes lines; else None."""
        if descriptor is None or not os.isatty(descriptor):
            return None
        try:
            lines = termios.tcgetattr(descriptor)[3] & termios.ICANON
        except termios.error:
            return None
        return cls(descriptor, key) if lines else None

    def tell(self, at_once: bool) -> None:
        """Have the key told at once, or be typed into lines like all others."""
        if at_once is self._told:
            return
        with suppress(termios.error):  # the terminal is gone, which reading from it tells
            attributes = termios.tcgetattr(self._descriptor)
            attributes[6][termios.VEOL] = self._key if at_once else _OFF
            termios.tcsetattr(self._descriptor, termios.TCSANOW, attributes)
            self._told = at_once

    def pressed(self, said: bytes) -> bool:
        """Whether bytes that came at the beginning of a line are presses of the key alone."""
        return self._told and not said.strip(self._key)
