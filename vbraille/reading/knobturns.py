"""Knobs of a device while they are being turned: felt at once, and said when they rest."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from vbraille.reading.commands.table import turn_knob

if TYPE_CHECKING:
    from vbraille.reading.reader import Reader

# A knob that nobody has turned for so long is left where it stands. Long enough for a hand that
# takes a new hold of it, and short enough to be an answer.
SETTLED_S: Final = 0.3


class KnobTurns:
    """What knobs of a device have changed and what was not said of that yet.

    A knob that is being turned tells its place fifty times a second. Each is shown at once; only
    the one at which the knob is left is said.
    """

    def __init__(self) -> None:
        self._unsaid: dict[int, tuple[float, str]] = {}

    def turn(self, reader: Reader, number: int, share: float, now_s: float) -> None:
        """Give the value of the tuning that a knob turns its place in the knob's range.

        Parameters
        ----------
        number
            Number of the knob, counted from 1.
        share
            Place of the knob, 0 to 1.
        now_s
            Time by a clock that does not go back.
        """
        if said := turn_knob(reader, number, share):
            self._unsaid[number] = now_s + SETTLED_S, said

    def settle(self, reader: Reader, now_s: float) -> None:
        """Say what knobs have changed that were turned, and are not turned any more."""
        for number, (due_s, said) in tuple(self._unsaid.items()):
            if now_s >= due_s:
                del self._unsaid[number]
                reader.say(said)
