"""Values of options, out of what was typed."""

from __future__ import annotations

import argparse
import re

TYPE_CHECKING = False  # as in vbraille.cli
if TYPE_CHECKING:
    from collections.abc import Sequence


class Pairs(argparse.Action):
    """Options NAME=VALUE, gathered in a dictionary."""

    def __call__(
        self,
        _parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: str | Sequence[object] | None,
        _option: str | None = None,
    ) -> None:
        """Add a pair to those before."""
        name, equals, value = str(values).partition("=")
        if not equals or not name:
            raise argparse.ArgumentError(self, f"{values!r} is not NAME=VALUE")
        setattr(namespace, self.dest, {**getattr(namespace, self.dest), name: value})


def duration(text: str) -> float:
    """Seconds of a duration such as 200ms or 5s."""
    found = re.fullmatch(r"([0-9]{1,9}(?:\.[0-9]{1,9})?)(ms|s)", text)
    seconds = float(found[1]) / (1000 if found[2] == "ms" else 1) if found else 0.0
    if not 0.001 <= seconds <= 3600:
        raise argparse.ArgumentTypeError(
            f"{text!r} is no duration from 1ms to 3600s, such as 200ms or 5s"
        )
    return seconds


def number(text: str) -> float:
    """A number."""
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number") from None


def checksum(text: str) -> str:
    """A SHA-256, or enough of its first digits to tell it from others."""
    if not re.fullmatch(r"[0-9a-fA-F]{16,64}", text):
        raise argparse.ArgumentTypeError(
            f"{text!r} is no SHA-256; give its 64 digits, 0 to 9 and a to f, or the first 16"
        )
    return text.lower()


def whole(text: str) -> int:
    """A whole number."""
    if not re.fullmatch(r"[+-]?[0-9]{1,18}", text):
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number")
    return int(text)


def seed(text: str) -> int:
    """A seed: 0 or more."""
    value = whole(text)
    if value < 0:
        raise argparse.ArgumentTypeError(f"seed is {value}; it must be 0 or more")
    return value


def names(text: str) -> tuple[str, ...]:
    """Names with commas between."""
    given = tuple(name.strip() for name in text.split(","))
    if not all(given) or len(set(given)) < len(given):
        raise argparse.ArgumentTypeError(f"{text!r} is no list of different names, such as a,b")
    return given


def marks(text: str) -> tuple[int, ...]:
    """Counts with commas between, each larger than the one before."""
    counts = tuple(whole(count) for count in text.split(","))
    if list(counts) != sorted(set(counts)) or counts[0] < 0:
        raise argparse.ArgumentTypeError(f"{text!r} are no counts that grow, such as 4,9")
    return counts


def lines(text: str) -> tuple[int, int | None]:
    """First and last of a range of lines, such as 3-10; the last is None where it is open."""
    found = re.fullmatch(r"([0-9]{1,15})?(-)?([0-9]{1,15})?", text)
    if found is None or not (found[1] or found[3]):
        raise argparse.ArgumentTypeError(f"{text!r} is not a range of lines, such as 3-10")
    first = int(found[1] or 1)
    last = int(found[3]) if found[3] else None if found[2] else first
    if first < 1 or (last is not None and last < first):
        raise argparse.ArgumentTypeError(f"{text!r} is no range: lines count from 1 upwards")
    return first, last
