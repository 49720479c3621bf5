"""Lines that a command says, and the progress of long work."""

from __future__ import annotations

import json
import sys
import time
from typing import TYPE_CHECKING, Final

from vbraille.wording import duration, printable

if TYPE_CHECKING:
    from collections.abc import Callable

_SHORT_S: Final = 2.0  # which is soon over, so that nothing is said of it


def say_line(sentence: str, *, aside: bool = False) -> None:
    """Print a line at once, with control characters named.

    Parameters
    ----------
    sentence
        The line, without its end.
    aside
        Whether it goes to standard error, so that it is not taken for what the command prints.
    """
    print(printable(sentence), file=sys.stderr if aside else sys.stdout, flush=True)


def print_json(value: object, indent: int = 2) -> None:
    """Print a value as JSON, for another program."""
    print(json.dumps(value, ensure_ascii=False, indent=indent))


class WorkProgress:
    """Teller of how much of some work is done, a line for each tenth, on standard error.

    Work of less than two seconds says nothing, and neither does work whose standard error is no
    terminal, unless more is to be said.

    Parameters
    ----------
    verbose
        Whether each tenth is told in any case.
    now_s
        Clock in seconds that does not go back.
    """

    def __init__(self, *, verbose: bool, now_s: Callable[[], float] = time.monotonic) -> None:
        self._verbose, self._now_s = verbose, now_s
        self._told = verbose or sys.stderr.isatty()
        self._begun_s = now_s()
        self._said = 0

    def at(self, share: float) -> None:
        """Tell that a share of the work is done, 0 to 1, and about how long the rest takes."""
        percent = round(100 * share)
        if not self._told or percent < self._said + 10:
            return
        self._said = percent - percent % 10
        passed_s = self._now_s() - self._begun_s
        if passed_s < _SHORT_S and not self._verbose:
            return
        left_s = passed_s * (1 - share) / share
        left = f", about {duration(left_s)} left" if left_s >= _SHORT_S else ""
        print(f"{self._said} percent{left}", file=sys.stderr, flush=True)

    def of(self, done: int, parts: int) -> None:
        """Tell that so many of all parts of the work are done."""
        self.at(done / parts)
