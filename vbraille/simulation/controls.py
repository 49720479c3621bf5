"""Buttons and knobs of a simulated device: presses, scripts of times and events, and keys.

A script is a text with an event in each line, as in ``2.5s press 1``, ``3s release 1`` and
``4s knob 1 0.8``. Times are from the beginning, which is the first greeting where there is one.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

from vbraille.errors import InputError, check_range

if TYPE_CHECKING:
    from collections.abc import Iterable

MOST_BUTTONS: Final = 8
MOST_KNOBS: Final = 4
LONGEST_S: Final = 3600.0
SHORT_S: Final = 0.1  # how long a button is held if its end is not given
_TIME = r"([0-9]{1,6}(?:\.[0-9]{1,6})?)s"
_PRESS = re.compile(rf"([0-9]{{1,3}})@{_TIME}(?:-{_TIME})?")


KEY_STEP: Final = 0.05  # by which a key turns a knob
_LINE = re.compile(
    r"(?P<time>[0-9]{1,7}(?:\.[0-9]{1,6})?)(?P<unit>ms|s)\s+"
    r"(?:(?P<what>press|release)\s+(?P<button>[0-9]{1,3})"
    r"|knob\s+(?P<knob>[0-9]{1,3})\s+(?P<value>[0-9]{1,3}(?:\.[0-9]{1,9})?))"
)


@dataclass(frozen=True, slots=True)
class ControlEvent:
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

    Raises
    ------
    ValueError
        If a value is out of range.
    """

    at_s: float
    knob: bool
    number: int
    value: float

    def __post_init__(self) -> None:
        what, most = ("knob", MOST_KNOBS) if self.knob else ("button", MOST_BUTTONS)
        check_range(what, self.number, 1, most)
        check_range("position of the knob", self.value, 0, 1)


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
        self._typed: list[ControlEvent] = []
        self._due = sorted(events, key=_time_of)[::-1]  # the next is the last

    def advance(self, now_s: float) -> None:
        """Do what is due by a time since the device began."""
        for waiting in (self._due, self._typed):
            while waiting and waiting[-1].at_s <= now_s:
                self._do(waiting.pop())

    def type(self, key: str, now_s: float) -> str:
        """Do at once what a key stands for, and give a sentence; empty for a key without a meaning.

        The keys 1 to 8 press a button for a moment. The letters a to d turn the knobs 1 to 4 up,
        and the capitals A to D turn them down.
        """
        if len(key) != 1:
            return ""
        if key in "12345678":
            button = int(key)
            self._do(ControlEvent(0.0, False, button, 1.0))
            release = ControlEvent(now_s + SHORT_S, False, button, 0.0)
            others = [event for event in self._typed if event.number != button]
            self._typed = [release, *others]  # the next is the last
            return f"button {button}: pressed"
        knob = "abcd".find(key.lower())
        if knob < 0:
            return ""
        step = KEY_STEP if key.islower() else -KEY_STEP
        self.knobs[knob] = round(min(max(self.knobs[knob] + step, 0.0), 1.0), 9)
        return f"knob {knob + 1}: {self.knobs[knob]:g}"

    def _do(self, event: ControlEvent) -> None:
        if event.knob:
            self.knobs[event.number - 1] = event.value
            return
        bit = 1 << (event.number - 1)
        self.buttons = self.buttons | bit if event.value else self.buttons & ~bit


def _time_of(event: ControlEvent) -> float:
    return event.at_s


def parse_script(text: str, name: str) -> tuple[ControlEvent, ...]:
    """Events of a script, in the order of their times.

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
    events: list[ControlEvent] = []
    for number, line in enumerate(text.splitlines(), 1):
        said = line.strip()
        if not said or said.startswith("#"):
            continue
        found = _LINE.fullmatch(said)
        if found is None:
            raise InputError(
                f"{name}, line {number}: {said[:40]!r} is no event; write a time and what is "
                f"done then, such as 2.5s press 1, 3s release 1 or 4s knob 1 0.8"
            )
        try:
            events.append(_event(found))
        except ValueError as error:
            raise InputError(f"{name}, line {number}: {error}") from None
    return tuple(sorted(events, key=_time_of))


def _event(found: re.Match[str]) -> ControlEvent:
    at_s = float(found["time"]) / (1000 if found["unit"] == "ms" else 1)
    check_range("time", at_s, 0, LONGEST_S, " s")
    if found["knob"]:
        return ControlEvent(at_s, True, int(found["knob"]), float(found["value"]))
    return ControlEvent(at_s, False, int(found["button"]), float(found["what"] == "press"))


def parse_press(text: str) -> tuple[ControlEvent, ControlEvent]:
    """Events of a press: ``1@2.5s``, or ``1@2.5s-4s`` to hold the button till then.

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
    button, from_s = int(found[1]), float(found[2])
    till_s = from_s + SHORT_S if found[3] is None else float(found[3])
    try:
        check_range("time of the press", from_s, 0, LONGEST_S, " s")
        if till_s <= from_s:
            raise ValueError(
                f"button {button} is let go at {till_s:g} s; it must be after it is pressed, at "
                f"{from_s:g} s"
            )
        return ControlEvent(from_s, False, button, 1.0), ControlEvent(till_s, False, button, 0.0)
    except ValueError as error:
        raise InputError(str(error)) from None


def parse_presses(text: str) -> tuple[ControlEvent, ...]:
    """Events of presses with commas between; none if the text is empty.

    Raises
    ------
    InputError
        If one of them is none.
    """
    presses = text.split(",") if text.strip() else ()
    return tuple(event for press in presses for event in parse_press(press.strip()))


def load_script(path: str) -> tuple[ControlEvent, ...]:
    """Events of a script in a file.

    Raises
    ------
    InputError
        If the file cannot be read, or a line of it is none.
    """
    try:
        text = Path(path).read_text("utf-8")
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "it is no text"
        raise InputError(f"the script {path} cannot be read: {reason}; check the name") from None
    return parse_script(text, path)
