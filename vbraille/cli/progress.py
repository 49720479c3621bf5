"""Progress of long work, on standard error: a bar at a terminal, otherwise a line a tenth."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Self

if TYPE_CHECKING:
    from tqdm import tqdm


class WorkProgress:
    """Teller of how many parts of some work are done."""

    def __init__(self) -> None:
        self._bar: tqdm | None = None
        self._said = 0

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()

    def at(self, done: int, parts: int) -> None:
        """Tell that so many of all parts are done."""
        percent = 100 * done // parts
        if sys.stderr.isatty():
            if self._bar is None:
                from tqdm import tqdm

                self._bar = tqdm(total=100, unit="%", bar_format="{percentage:3.0f}% |{bar}|")
            self._bar.update(percent - self._bar.n)
        elif percent >= self._said + 10:
            self._said = percent - percent % 10
            print(f"{self._said} percent", file=sys.stderr, flush=True)
