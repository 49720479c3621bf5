"""Buttons and knobs of a simulated device: moves at set times, and keys that move them."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final, NamedTuple

from vbraille.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterable

MOST_BUTTONS: Final = 8
MOST_KNOBS: Final = 4
SHORT_S: Final = 0.1  # how long a button is held if its end is not given
KEY_STEP: Final = 0.05  # by which a key turns a knob
_TIME = r"([0-9]{1,5}(?:\.[0-9]{1,6})?)s"
_PRESS = re.compile(rf"([1-{MOST_BUTTONS}])@{_TIME}(?:-{_TIME})?")
_TURN = re.compile(rf"knob ([1-{MOST_KNOBS}]) (0|1|0?\.[0-9]{{1,6}})@{_TIME}")


class ControlEvent(NamedTuple):
    """Move of a button or a knob, and its time.

    Parameters
    ----------
    at_s
        When it is done, in seconds since the device began.
    knob
        Whether it is a knob that is turned, and not a button.
    number
        Number of the button or the knob, counted from 1.
    value
        Position of the knob, 0 to 1; of a button, 1 if it is pressed and 0 if it is let go.
    """

    at_s: float
    knob: bool
    number: int
    value: float


class Controls:
    """Buttons and knobs of a device, as presses and keys have moved them so far.

    Parameters
    ----------
    events
        What happens at set times.

    Attributes
    ----------
    buttons : int
        Bits of the buttons that are held, bit 0 for button 1.
    knobs : list[float]
        Position of each knob, 0 to 1; all begin in the middle.
    """

    def __init__(self, events: Iterable[ControlEvent] = ()) -> None:
        self.buttons = 0
        self.knobs = [0.5] * MOST_KNOBS
        self._due = sorted(events)
        self._typed: dict[int, ControlEvent] = {}  # ends of presses by keys, by their buttons

    def advance(self, now_s: float) -> list[ControlEvent]:
        """Do what is due by a time since the device began, and give it in order."""
        due = [event for event in (*self._due, *self._typed.values()) if event.at_s <= now_s]
        for event in due:
            self._do(event)
        if due:
            self._due = [event for event in self._due if event.at_s > now_s]
            self._typed = {n: event for n, event in self._typed.items() if event.at_s > now_s}
        return due

    def type(self, key: str, now_s: float) -> str:
        """Do at once what a key stands for, and return a sentence; empty for any other key.

        The keys 1 to 8 press a button for a moment. The letters a to d turn the knobs 1 to 4 up,
        and the capitals A to D turn them down.
        """
        if len(key) == 1 and key in "12345678":
            button = int(key)
            self._do(ControlEvent(now_s, False, button, 1.0))
            self._typed[button] = ControlEvent(now_s + SHORT_S, False, button, 0.0)
            return f"button {button}: pressed"
        if len(key) == 1 and key.lower() in "abcd":
            knob = "abcd".index(key.lower())
            step = KEY_STEP if key.islower() else -KEY_STEP
            self.knobs[knob] = round(min(max(self.knobs[knob] + step, 0.0), 1.0), 9)
            return f"knob {knob + 1}: {self.knobs[knob]:g}"
        return ""

    def _do(self, event: ControlEvent) -> None:
        if event.knob:
            self.knobs[event.number - 1] = event.value
            return
        bit = 1 << (event.number - 1)
        self.buttons = self.buttons | bit if event.value else self.buttons & ~bit


def parse_moves(text: str) -> list[ControlEvent]:
    """Return moves of buttons and knobs, with commas between; none if the text is empty.

    ``1@2.5s`` presses a button for a moment, ``1@2.5s-4s`` holds it till then, and
    ``knob 1 0.8@4s`` turns a knob. Times are from the beginning, which is the first greeting where
    there is one.

    Raises
    ------
    InputError
        If one of them is none.
    """
    events = []
    for move in map(str.strip, text.split(",") if text.strip() else ()):
        if turned := _TURN.fullmatch(move):
            knob, value, at_s = turned.groups()
            events.append(ControlEvent(float(at_s), True, int(knob), float(value)))
            continue
        pressed = _PRESS.fullmatch(move)
        button, begun_s, ended_s = pressed.groups() if pressed else ("", "0", "0")
        ended_s = float(ended_s or float(begun_s) + SHORT_S)
        if ended_s <= float(begun_s):
            raise InputError(
                f"{move!r} moves no button and no knob; give a press and its time such as 1@2.5s, "
                f"1@2.5s-4s to hold it, or knob 1 0.8@4s"
            )
        events.append(ControlEvent(float(begun_s), False, int(button), 1.0))
        events.append(ControlEvent(ended_s, False, int(button), 0.0))
    return events
