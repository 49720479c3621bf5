"""Presses of a simulated device's buttons, at times that are set beforehand."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from vbraille.errors import InputError, check_range

if TYPE_CHECKING:
    from collections.abc import Iterable

MOST_BUTTONS: Final = 8
LONGEST_S: Final = 3600.0
SHORT_S: Final = 0.1  # how long a button is held if nobody says till when
_TIME = r"([0-9]{1,6}(?:\.[0-9]{1,6})?)s"
_PRESS = re.compile(rf"([0-9]{{1,3}})@{_TIME}(?:-{_TIME})?")


@dataclass(frozen=True, slots=True)
class Press:
    """A button that is held for a time.

    Parameters
    ----------
    button
        Number of the button, 1 to 8.
    from_s, till_s
        When it is pressed and when it is let go, in seconds since the device began.

    Raises
    ------
    ValueError
        If there is no such button or no such time.
    """

    button: int
    from_s: float
    till_s: float

    def __post_init__(self) -> None:
        check_range("button", self.button, 1, MOST_BUTTONS)
        check_range("time of the press", self.from_s, 0, LONGEST_S, " s")
        if self.till_s <= self.from_s:
            raise ValueError(
                f"button {self.button} is let go at {self.till_s:g} s; it must be after it is "
                f"pressed, at {self.from_s:g} s"
            )


def parse_press(text: str) -> Press:
    """Press that a text describes: ``1@2.5s``, or ``1@2.5s-4s`` to hold the button till then.

    Raises
    ------
    InputError
        If the text describes none.
    """
    found = _PRESS.fullmatch(text)
    if found is None:
        raise InputError(
            f"{text!r} is no press of a button; give its number and its time, such as 1@2.5s, or "
            f"1@2.5s-4s to hold it"
        )
    from_s = float(found[2])
    till_s = from_s + SHORT_S if found[3] is None else float(found[3])
    try:
        return Press(int(found[1]), from_s, till_s)
    except ValueError as error:
        raise InputError(str(error)) from None


def parse_presses(text: str) -> tuple[Press, ...]:
    """Presses that a text describes, with commas between; none if it is empty.

    Raises
    ------
    InputError
        If one of them is none.
    """
    return tuple(parse_press(one.strip()) for one in text.split(",")) if text.strip() else ()


def held(presses: Iterable[Press], now_s: float) -> int:
    """Bits of the buttons that are held at a time, bit 0 for button 1."""
    bits = 0
    for press in presses:
        if press.from_s <= now_s < press.till_s:
            bits |= 1 << (press.button - 1)
    return bits
