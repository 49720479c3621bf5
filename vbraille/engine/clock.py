"""Clocks: the machine's, and one that tests and fast runs turn on themselves."""

from __future__ import annotations

import select
import time
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Sequence

# Python needs so long to come back from a sleep, and is woken so much earlier.
_RETURN_NS = 6_000


class RealClock:
    """The machine's monotonic clock."""

    def now_ns(self) -> int:
        """Time since some fixed moment."""
        return time.monotonic_ns()

    def sleep_until_ns(self, deadline_ns: int) -> None:
        """Return at the deadline, or at once if it has passed."""
        left = deadline_ns - _RETURN_NS - time.monotonic_ns()
        if left > 0:
            time.sleep(left / 1e9)
        while time.monotonic_ns() < deadline_ns:
            pass

    def wait_ns(self, readers: Sequence[Any], deadline_ns: int) -> list[Any]:
        """Return once a descriptor or a socket can be read, or at the deadline; give those."""
        left_s = max(deadline_ns - time.monotonic_ns(), 0) / 1e9
        return select.select(readers, (), (), left_s)[0]


class ManualClock:
    """A clock that goes only when a caller sleeps on it or turns it."""

    def __init__(self) -> None:
        self._now_ns = 0

    def now_ns(self) -> int:
        """Time by which the clock was turned so far."""
        return self._now_ns

    def sleep_until_ns(self, deadline_ns: int) -> None:
        """Turn the clock to the deadline."""
        self._now_ns = max(self._now_ns, deadline_ns)

    def wait_ns(self, readers: Sequence[Any], deadline_ns: int) -> list[Any]:
        """Give those that can be read; turn the clock to the deadline if none can."""
        ready = select.select(readers, (), (), 0)[0]
        if not ready:
            self.sleep_until_ns(deadline_ns)
        return ready

    def advance_ns(self, step_ns: int) -> None:
        """Turn the clock on."""
        self._now_ns += step_ns


Clock = RealClock | ManualClock
