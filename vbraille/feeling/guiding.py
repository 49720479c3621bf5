"""The way to a place of the picture, said to whoever moves the device."""

from __future__ import annotations

import math
from typing import Final

_EVERY_S: Final = 1.0
_THERE_MM: Final = 3.0


class Guide:
    """Says the way to a place once a second, until the finger is there.

    Parameters
    ----------
    name
        What is there.
    at_mm
        The place.
    down
        Whether the hand can go up and down.

    Attributes
    ----------
    there : bool
        Whether the finger has come to the place.
    """

    def __init__(self, name: str, at_mm: tuple[float, float], *, down: bool = True) -> None:
        self.there = False
        self._name = name
        self._at_mm = at_mm
        self._down = down
        self._said_s = -math.inf

    def sentence(self, place: tuple[float, float], now_s: float) -> str:
        """Words for the way from a place in mm; empty if nothing is to be said now."""
        right_mm = self._at_mm[0] - place[0]
        down_mm = self._at_mm[1] - place[1] if self._down else 0.0
        if math.hypot(right_mm, down_mm) <= _THERE_MM:
            self.there = True
            return f"there: {self._name}"
        if now_s - self._said_s < _EVERY_S:
            return ""
        self._said_s = now_s
        ways = (_way(right_mm, "right", "left"), _way(down_mm, "down", "up"))
        return f"way: {', '.join(way for way in ways if way)}"


def _way(mm: float, forward: str, back: str) -> str:
    return f"{abs(mm):.0f} mm {forward if mm > 0 else back}" if abs(mm) >= 1 else ""
