"""Pace of a session, its sounds, and the questions asked before it."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Literal

from vbraille.errors import check_range
from vbraille.tomlfile import Table, which

if TYPE_CHECKING:
    from collections.abc import Sequence

# Form of the names of conditions and fields, which become columns of tables and parts of file
# names.
NAME = re.compile(r"[A-Za-z0-9_-]{1,40}")
_FILE = re.compile(r"[A-Za-z0-9_-]{1,40}\.(\w+)")
LONGEST_LINE = 200
ENTER = "key:enter"
# Keys with names, and what they type; other keys are called by the character that they type.
KEYS = {"enter": "\n", "space": " ", "tab": "\t"}
MOST_BUTTONS = 8  # the wire has a bit for each
_BUTTON = re.compile(r"button:([1-8])")
_KEY = re.compile(r"key:([!-~]|enter|space|tab)")


def check_name(what: str, name: str) -> None:
    """Check the name of a condition or field.

    Raises
    ------
    ValueError
        If the name does not match `NAME`.
    """
    if not NAME.fullmatch(name):
        raise ValueError(
            f"{what} is {name!r}; it must be 1 to 40 letters a to z, digits, hyphens or underscores"
        )


def check_line(what: str, text: str) -> None:
    """Check a line of text that is for people.

    Raises
    ------
    ValueError
        If the line is empty or too long.
    """
    if not 1 <= len(text.strip()) <= LONGEST_LINE:
        raise ValueError(
            f"{what} has {len(text.strip())} characters; it must have 1 to {LONGEST_LINE}"
        )


def check_file_name(name: str, what: str, ends: Sequence[str] = ("csv", "txt")) -> None:
    """Check the name of a file that stands beside a protocol.

    Raises
    ------
    ValueError
        If it is no plain name, or does not end in one of ``ends``.
    """
    found = _FILE.fullmatch(name)
    if found is None or found[1] not in ends:
        raise ValueError(
            f"{what} is {name!r}; it must be the name of a file beside the protocol: 1 to 40 "
            f"letters a to z, digits, hyphens or underscores, and .{' or .'.join(ends)}"
        )


class TrialPace(Table, frozen=True):
    """Times of a trial.

    Parameters
    ----------
    gap_s
        Seconds from the answer to the next start signal.
    warning_s
        Seconds from the start signal to the audible warning; None for no warning.
    end
        What the participant ends reading by: "button:N" for button N of the device, from 1, or
        "key:NAME" for a key: "key:enter", "key:space", "key:tab", or the character of another one,
        as in "key:+"; None if the hand's way to the end and back ends it.
    exposure_s
        Seconds for which a stimulus can be felt; it then fades. None for no limit.
    exposure_from
        Event that the exposure counts from: the start signal, "cue", or the hand's first touch of
        a dot, "contact".
    answer_s
        Seconds for an answer, from the end of the exposure, or from the start signal if there is
        no limit to that; an answer after it is late. None for no limit.
    late
        Rule for an answer that has not come in time: "kept" takes it and marks it, "missed" ends
        the trial without it.

    Raises
    ------
    ValueError
        If a time is out of range, or nothing can end reading in this way.
    """

    gap_s: float = 0.5
    warning_s: float | None = None
    end: str | None = None
    exposure_s: float | None = None
    exposure_from: Literal["cue", "contact"] = "cue"
    answer_s: float | None = None
    late: Literal["kept", "missed"] = "kept"

    def __post_init__(self) -> None:
        if self.end is not None and self.key is None and self.button is None:
            raise ValueError(
                f"end is {self.end!r}; it must be 'button:1' to 'button:{MOST_BUTTONS}', "
                f"{ENTER!r}, 'key:space', 'key:tab', or a key that types one character, such as "
                f"'key:+'"
            )
        check_range("gap_s", self.gap_s, 0, 60, " s")
        check_range("warning_s", self.warning_s, 1, 3600, " s")
        check_range("exposure_s", self.exposure_s, 0.05, 3600, " s")
        check_range("answer_s", self.answer_s, 0.1, 3600, " s")
        if self.exposure_s is None and self.exposure_from != "cue":
            raise ValueError("exposure_from is of exposure_s; give that, or leave it out")
        if self.answer_s is None and self.late != "kept":
            raise ValueError("late is of answer_s; give that, or leave it out")

    @property
    def key(self) -> str | None:
        """Character that the key which ends reading types; None if no key does."""
        found = _KEY.fullmatch(self.end or "")
        return KEYS.get(found[1], found[1]) if found else None

    @property
    def button(self) -> int | None:
        """Number of the device's button that ends reading; None if no button does."""
        found = _BUTTON.fullmatch(self.end or "")
        return int(found[1]) if found else None


class SessionPace(Table, frozen=True):
    """Length of a session, its breaks, and what those see who watch it.

    Parameters
    ----------
    limit_s
        Seconds after which no further trial begins; None for no limit.
    break_every
        Number of trials in a block from one break to the next; None for breaks between blocks
        only.
    break_s
        Planned seconds of a break, whose end the console says; None if it is as long as it takes.
    blind
        Whether the live view keeps back all from which a stimulus or an answer could be read.

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    limit_s: float | None = None
    break_every: int | None = None
    break_s: float | None = None
    blind: bool = True

    def __post_init__(self) -> None:
        check_range("limit_s", self.limit_s, 1, 86_400, " s")
        check_range("break_every", self.break_every, 1, 10_000)
        check_range("break_s", self.break_s, 1, 7200, " s")


FIRST_CODE, LEAST_CODE, MOST_CODE = 101, 40, 254  # bytes below the least are those of events


class MarkerCodes(Table, frozen=True):
    """Codes by which markers tell other recorders the condition of what is shown.

    Parameters
    ----------
    codes
        Byte of each condition, 40 to 254, by the condition's name; conditions that are not named
        have 101 for the first of the protocol, 102 for the second, and so on.

    Raises
    ------
    ValueError
        If a code is out of range, or is there twice.
    """

    codes: dict[str, int] = {}  # noqa: RUF012  (msgspec copies an empty default)

    def __post_init__(self) -> None:
        for code in self.codes.values():
            check_range("codes: one", code, LEAST_CODE, MOST_CODE)
        if len(set(self.codes.values())) < len(self.codes):
            raise ValueError("codes have one twice; give each condition its own")

    def of(self, conditions: Sequence[str]) -> dict[str, int]:
        """Code of each condition.

        Raises
        ------
        ValueError
            If a code is of no condition, or two conditions would have the same.
        """
        for name in self.codes:
            if name not in conditions:
                raise ValueError(f"codes have {name!r}{which(name, conditions)}")
        found = {
            name: self.codes.get(name, min(FIRST_CODE + place, MOST_CODE))
            for place, name in enumerate(conditions)
        }
        doubled = len(set(found.values())) < len(found)
        if doubled and (self.codes or len(found) <= MOST_CODE - FIRST_CODE + 1):
            raise ValueError("codes give two conditions the same; name all of them")
        return found


class Tone(Table, frozen=True, array_like=True):
    """A sound: a sine, which a file gives as a list of its frequency and its duration.

    Parameters
    ----------
    frequency_hz, duration_ms
        Frequency of the sine in Hz, and how long it lasts in ms.

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    frequency_hz: float
    duration_ms: float

    def __post_init__(self) -> None:
        check_range("frequency", self.frequency_hz, 20, 20_000, " Hz")
        check_range("duration", self.duration_ms, 1, 5_000, " ms")


class SignalSound(Table, frozen=True):
    """The sounds that the participant hears.

    Parameters
    ----------
    cue
        Sound which says that a trial begins.
    warning
        Sound which says that the trial has gone on for ``warning_s`` of ``[trial]``.
    """

    cue: Tone = Tone(880.0, 150.0)
    warning: Tone = Tone(440.0, 400.0)


class ParticipantField(Table, frozen=True):
    """A question about the participant, asked before the session. It asks for nothing personal.

    Parameters
    ----------
    name
        Name of the question, and of the column of its answers in tables.
    ask
        The question as it is asked, in one line.
    choices
        The answers that may be given; empty if any answer may.

    Raises
    ------
    ValueError
        If a text cannot be used, or a choice is given twice.
    """

    name: str
    ask: str
    choices: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        check_name("name", self.name)
        check_line("ask", self.ask)
        for choice in self.choices:
            check_line("choices: one", choice)
            if self.choices.count(choice) > 1:
                raise ValueError(f"choices have {choice!r} twice; leave one out")


class FaultRules(Table, frozen=True):
    """Rule for a trial in which the device failed.

    Parameters
    ----------
    repeat
        Whether the trial is shown again; if not, it counts as it is, and is marked.
    """

    repeat: bool = True
