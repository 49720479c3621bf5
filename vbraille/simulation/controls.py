"""Buttons and knobs of a simulated device: presses, scripts of times and events, and keys.

A script is a text with an event in each line, as in ``2.5s press 1``, ``3s release 1`` and
``4s knob 1 0.8``. Times are from the beginning, which is the first greeting where there is one.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final, NamedTuple

from vbraille.errors import InputError, check_range
from vbraille.files import read_text

if TYPE_CHECKING:
    from collections.abc import Iterable

MOST_BUTTONS: Final = 8
MOST_KNOBS: Final = 4
LONGEST_S: Final = 3600.0
SHORT_S: Final = 0.1  # how long a button is held if its end is not given
KEY_STEP: Final = 0.05  # by which a key turns a knob
_NUMBER = r"[0-9]{1,7}(?:\.[0-9]{1,9})?"
_PRESS = re.compile(rf"([0-9]{{1,3}})@({_NUMBER})s(?:-({_NUMBER})s)?")
_LINE = re.compile(
    rf"({_NUMBER})(ms|s)\s+(?:(press|release)\s+([0-9]{{1,3}})|knob\s+([0-9]{{1,3}})\s+({_NUMBER}))"
)


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


def _checked(event: ControlEvent, where: str) -> ControlEvent:
    """Return an event whose numbers are in their ranges; else raise InputError."""
    what, most = ("knob", MOST_KNOBS) if event.knob else ("button", MOST_BUTTONS)
    try:
        check_range("time", event.at_s, 0, LONGEST_S, " s")
        check_range(what, event.number, 1, most)
        check_range("position of the knob", event.value, 0, 1)
    except ValueError as error:
        raise InputError(f"{where}: {error}") from None
    return event


class Controls:
    """Buttons and knobs of a device, as scripts, presses and keys have moved them so far.

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
        self._due = sorted(events, key=_time_of)
        self._typed: dict[int, ControlEvent] = {}  # ends of presses by keys, by their buttons

    def advance(self, now_s: float) -> None:
        """Do what is due by a time since the device began."""
        while self._due and self._due[0].at_s <= now_s:
            self._do(self._due.pop(0))
        for button, event in list(self._typed.items()):
            if event.at_s <= now_s:
                self._do(self._typed.pop(button))

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


def _time_of(event: ControlEvent) -> float:
    return event.at_s


def parse_script(text: str, name: str) -> list[ControlEvent]:
    """Return the events of a script.

    Parameters
    ----------
    text
        Lines of a time and an event. Blank lines, and those that begin with ``#``, are passed over.
    name
        Name of the script, for messages.

    Raises
    ------
    InputError
        If a line is none; the message has its number.
    """
    events = []
    for number, line in enumerate(map(str.strip, text.splitlines()), 1):
        if not line or line.startswith("#"):
            continue
        where = f"{name}, line {number}"
        found = _LINE.fullmatch(line)
        if found is None:
            raise InputError(
                f"{where}: {line[:40]!r} is no event; write a time and what is done then, such as "
                f"2.5s press 1, 3s release 1 or 4s knob 1 0.8"
            )
        time, unit, what, button, knob, value = found.groups()
        at_s = float(time) / (1000 if unit == "ms" else 1)
        if knob:
            event = ControlEvent(at_s, True, int(knob), float(value))
        else:
            event = ControlEvent(at_s, False, int(button), float(what == "press"))
        events.append(_checked(event, where))
    return events


def parse_presses(text: str) -> list[ControlEvent]:
    """Return the events of presses with commas between; none if the text is empty.

    A press is ``1@2.5s``, or ``1@2.5s-4s`` to hold the button till then.

    Raises
    ------
    InputError
        If one of them is none.
    """
    events = []
    for press in text.split(",") if text.strip() else ():
        found = _PRESS.fullmatch(press.strip())
        if found is None:
            raise InputError(
                f"{press.strip()!r} is no press of a button; give its number and its time, such "
                f"as 1@2.5s, or 1@2.5s-4s to hold it"
            )
        begun_s = float(found[2])
        ended_s = float(found[3] or begun_s + SHORT_S)
        if ended_s <= begun_s:
            raise InputError(f"{press.strip()}: a button is let go after it is pressed")
        for at_s, value in ((begun_s, 1.0), (ended_s, 0.0)):
            events.append(_checked(ControlEvent(at_s, False, int(found[1]), value), press.strip()))
    return events


def load_script(path: str) -> list[ControlEvent]:
    """Return the events of a script in a file.

    Raises
    ------
    InputError
        If the file cannot be read, or a line of it is none.
    """
    return parse_script(read_text(path, "script"), path)
