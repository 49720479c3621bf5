"""Output of commands: lines, tables, JSON, and the progress of long work."""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING

from vbraille.wording import duration, printable, spelled

if TYPE_CHECKING:
    from collections.abc import Iterable

_SHORT_S = 2.0  # work that is soon over, of which nothing is said


def say(sentence: str, *, aside: bool = False) -> None:
    """Print a line at once, control characters by their names; to standard error if `aside`.

    Settings that the line names are spelled as options.
    """
    print(printable(spelled(sentence)), file=sys.stderr if aside else sys.stdout, flush=True)


def print_json(value: object) -> None:
    """Print a value as JSON; structs and dataclasses as objects."""
    import msgspec

    print(msgspec.json.format(msgspec.json.encode(value), indent=2).decode())


def show(lines: Iterable[str], value: object, *, as_json: bool) -> None:
    """Print what was found as lines, or else the value of it as JSON."""
    if as_json:
        print_json(value)
        return
    for line in lines:
        say(line)


class Progress:
    """Prints how much of long work is done, at a terminal, on standard error."""

    def __init__(self) -> None:
        self._told = sys.stderr.isatty()
        self._begun_s = time.monotonic()
        self._said = 0

    def at(self, share: float) -> None:
        """Take the share of the work that is done, 0 to 1; each tenth is printed."""
        percent = round(100 * share)
        if not self._told or percent < self._said + 10:
            return
        self._said = percent - percent % 10
        passed_s = time.monotonic() - self._begun_s
        left_s = passed_s * (1 - share) / share
        if passed_s >= _SHORT_S:
            left = f", about {duration(left_s)} left" if left_s >= _SHORT_S else ""
            print(f"{self._said} percent{left}", file=sys.stderr, flush=True)

    def of(self, done: int, parts: int) -> None:
        """Take the number of parts that are done, of all of them."""
        self.at(done / parts)
