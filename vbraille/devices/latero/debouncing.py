"""A button that may bounce: what it reads counts once it has not changed for 5 ms."""

from __future__ import annotations

from typing import Final

DEBOUNCE_NS: Final = 5_000_000


class Debounced:
    """State of one button.

    Attributes
    ----------
    pressed : bool
        Whether the button is down, as far as that is certain.
    """

    def __init__(self) -> None:
        self.pressed = False
        self._reading = False
        self._since_ns = 0

    def take(self, reading: bool, now_ns: int) -> bool:
        """Take a reading, True while the contact is closed; tell whether `pressed` changes."""
        if reading != self._reading:
            self._reading, self._since_ns = reading, now_ns
            return False
        if reading == self.pressed or now_ns - self._since_ns < DEBOUNCE_NS:
            return False
        self.pressed = reading
        return True

    def let_go(self) -> bool:
        """Take the button for let go, as of a device that is away; tell whether that changes it."""
        was, self.pressed, self._reading = self.pressed, False, False
        return was
