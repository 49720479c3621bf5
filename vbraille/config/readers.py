"""Readers of the values of options, which refuse what is none in a sentence."""

from __future__ import annotations

import re
from argparse import ArgumentTypeError

_MOST_SIZES = 1000
_MOST_MM_S = 1000


def number(text: str) -> float:
    """Read a number."""
    try:
        return float(text)
    except ValueError:
        raise ArgumentTypeError(f"{text!r} is not a number") from None


def whole(text: str) -> int:
    """Read a whole number."""
    if not re.fullmatch(r"[+-]?[0-9]{1,18}", text):
        raise ArgumentTypeError(f"{text!r} is not a whole number")
    return int(text)


def seed(text: str) -> int:
    """Read a seed: 0 or more."""
    value = whole(text)
    if value < 0:
        raise ArgumentTypeError(f"seed is {value}; it must be 0 or more")
    return value


def lines(text: str) -> tuple[int, int | None]:
    """Read first and last of a range of lines, such as 3-10; the last is None where it is open."""
    found = re.fullmatch(r"([0-9]{1,15})?(-)?([0-9]{1,15})?", text)
    if found is None or not (found[1] or found[3]):
        raise ArgumentTypeError(f"{text!r} is not a range of lines, such as 3-10")
    first = int(found[1] or 1)
    last = int(found[3]) if found[3] else None if found[2] else first
    if first < 1 or (last is not None and last < first):
        raise ArgumentTypeError(f"{text!r} is no range: lines count from 1 upwards")
    return first, last


def checksum(text: str) -> str:
    """Read a SHA-256, or enough of its first digits to tell it from others."""
    if not re.fullmatch(r"[0-9a-fA-F]{16,64}", text):
        raise ArgumentTypeError(
            f"{text!r} is no SHA-256; give its 64 digits, 0 to 9 and a to f, or the first 16"
        )
    return text.lower()


def names(text: str) -> tuple[str, ...]:
    """Read names with commas between."""
    given = tuple(name.strip() for name in text.split(","))
    if not all(given) or len(set(given)) < len(given):
        raise ArgumentTypeError(f"{text!r} is no list of different names, such as a,b")
    return given


def marks(text: str) -> tuple[int, ...]:
    """Read counts with commas between, each larger than the one before."""
    counts = tuple(whole(count) for count in text.split(","))
    if list(counts) != sorted(set(counts)) or counts[0] < 0:
        raise ArgumentTypeError(f"{text!r} are no counts that grow, such as 4,9")
    return counts


def expected_shares(text: str) -> dict[str, str]:
    """Pairs NAME=SHARE with commas between."""
    pairs: dict[str, str] = {}
    for part in text.split(","):
        name, equals, value = (side.strip() for side in part.partition("="))
        if not equals or not name or not value:
            raise ArgumentTypeError(f"{part!r} is not NAME=SHARE, such as T0=0.5")
        if name in pairs:
            raise ArgumentTypeError(f"{name} stands there twice")
        pairs[name] = value
    return pairs


def sizes(text: str) -> tuple[int, ...]:
    """Numbers of participants: a range such as 4-40, or numbers that grow, such as 6,12."""
    found = re.fullmatch(r"([0-9]{1,6})-([0-9]{1,6})", text)
    if found is not None:
        low, high = int(found[1]), int(found[2])
        if low > high:
            raise ArgumentTypeError(
                f"{text!r} is a range backwards; give the smaller number first, such as "
                f"{high}-{low}"
            )
        if high - low >= _MOST_SIZES:
            raise ArgumentTypeError(
                f"{text!r} are {high - low + 1} sizes; give at most {_MOST_SIZES}"
            )
        return tuple(range(low, high + 1))
    if not re.fullmatch(r"[0-9]{1,6}(,[0-9]{1,6})*", text):
        raise ArgumentTypeError(f"{text!r} is no number of participants, such as 12, 6,12 or 4-40")
    given = tuple(int(part) for part in text.split(","))
    if list(given) != sorted(set(given)):
        raise ArgumentTypeError(f"{text!r} are no numbers that grow, such as 6,12")
    return given


def duration(text: str) -> float:
    """Read the seconds of a duration such as 200ms or 5s."""
    found = re.fullmatch(r"([0-9]{1,9}(?:\.[0-9]{1,9})?)(ms|s)", text)
    seconds = float(found[1]) / (1000 if found[2] == "ms" else 1) if found else 0.0
    if not 0.001 <= seconds <= 3600:
        raise ArgumentTypeError(f"{text!r} is no duration from 1ms to 3600s, such as 200ms or 5s")
    return seconds


def velocity(text: str) -> tuple[float, ...]:
    """Read a velocity X,Y in mm/s."""
    try:
        values = tuple(float(part) for part in text.split(","))
    except ValueError:
        values = ()
    if len(values) != 2 or not all(abs(value) <= _MOST_MM_S for value in values):
        raise ArgumentTypeError(
            f"{text!r} is no velocity; give X,Y in mm/s, each from -{_MOST_MM_S} to {_MOST_MM_S}"
        )
    return values


def switch_states(text: str) -> dict[int, int]:
    """Read states of switches K=N,…, from 1, as states from 0 by their keys."""
    found = re.fullmatch(r"[1-8]=[1-8](?:,[1-8]=[1-8])*", text)
    if found is None:
        raise ArgumentTypeError(
            f"{text!r} is no state of a switch; give K=N with a key and a state from 1, such as 1=2"
        )
    pairs = (one.split("=") for one in text.split(","))
    return {int(key): int(state) - 1 for key, state in pairs}


def place(text: str) -> tuple[float, ...]:
    """Read a place X,Y, or a place and an angle X,Y,θ."""
    try:
        values = tuple(float(part) for part in text.split(","))
    except ValueError:
        values = ()
    if len(values) not in (2, 3):
        raise ArgumentTypeError(
            f"{text!r} is no place; give X,Y in mm, or X,Y,θ with an angle in degrees"
        )
    return values
