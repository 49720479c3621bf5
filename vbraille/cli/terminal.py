"""Lines that a command says, and the progress of long work."""

from __future__ import annotations

import json
import sys
from typing import TYPE_CHECKING, Self

from vbraille.wording import printable

if TYPE_CHECKING:
    from tqdm import tqdm


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
    """Teller of how much of some work is done. A context manager.

    Parameters
    ----------
    bar
        Whether to draw a bar at a terminal.
    lines
        Whether to print lines where there is no bar.
    """

    def __init__(self, *, bar: bool = True, lines: bool = True) -> None:
        self._bar: tqdm | None = None
        self._said = 0 if lines else 100
        if sys.stderr.isatty() and bar:
            from tqdm import tqdm

            self._bar = tqdm(total=100, unit="%", bar_format="{percentage:3.0f}% |{bar}|")

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()

    def at(self, share: float) -> None:
        """Tell that a share of the work is done, 0 to 1."""
        percent = round(100 * share)
        if self._bar is not None:
            self._bar.update(percent - self._bar.n)
        elif percent >= self._said + 10:
            self._said = percent - percent % 10
            print(f"{self._said} percent", file=sys.stderr, flush=True)

    def of(self, done: int, parts: int) -> None:
        """Tell that so many of all parts of the work are done."""
        self.at(done / parts)
