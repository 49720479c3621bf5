"""Numbers of requests, and what an answer's number says: new, late, doubled, or nobody's."""

from __future__ import annotations

from enum import Enum
from typing import Final

# Requests whose answers are still known to be late or doubled when they come.
KEPT: Final = 256
# An answer that took longer tells an old place: the author's client waits for so long.
LATE_NS: Final = 5_000_000
_U16: Final = 0xFFFF
_HALF: Final = 0x8000


def not_before(sequence: int, other: int) -> bool:
    """Whether a number is another one or comes after it, where numbers wrap at 16 bits."""
    return (sequence - other) & _U16 < _HALF


class Fate(Enum):
    """What an answer turned out to be."""

    NEW = "new"
    LATE = "late"  # it tells an old place, and is dropped
    DOUBLED = "doubled"  # the same answer came before
    UNASKED = "unasked"  # nothing was asked by this number


class Numbering:
    """Requests that were sent, by their numbers; nobody waits for what is lost.

    Parameters
    ----------
    first
        Number of the first request.

    Attributes
    ----------
    late, doubled, unasked : int
        How many answers were dropped, by what they were.
    """

    def __init__(self, first: int = 1) -> None:
        self.late = self.doubled = self.unasked = 0
        self._next = first & _U16
        self._newest: int | None = None  # the newest request that was answered
        self._sent_ns = [0] * KEPT
        self._numbers = [-1] * KEPT
        self._open = [False] * KEPT
        self._sent = 0
        self._gone = 0  # requests whose answers never came, and are not known any more

    @property
    def next(self) -> int:
        """Number of the next request."""
        return self._next

    @property
    def caught_up(self) -> bool:
        """Whether the newest request was answered, so that nothing newer can come."""
        return self._newest is not None and self._newest == (self._next - 1) & _U16

    @property
    def lost(self) -> int:
        """How many requests were never answered, of those that are older than the last few."""
        return self._gone

    @property
    def unanswered(self) -> int:
        """How many requests were not answered until now, those on their way included."""
        return self._gone + sum(self._open)

    def sent(self, now_ns: int) -> int:
        """Note that a request goes out now; give its number."""
        sequence = self._next
        at = sequence % KEPT
        self._gone += self._open[at]
        self._numbers[at], self._sent_ns[at], self._open[at] = sequence, now_ns, True
        self._next = (sequence + 1) & _U16
        return sequence

    def sent_ns(self, sequence: int) -> int:
        """When a request went out whose answer is new."""
        return self._sent_ns[sequence % KEPT]

    def judge(self, sequence: int, now_ns: int, late_ns: int = LATE_NS) -> Fate:
        """Judge an answer by its number.

        Parameters
        ----------
        sequence
            Number that the answer bears.
        now_ns
            When it came, by the clock of `sent`.
        late_ns
            Time after its request from which an answer tells an old place.
        """
        at = sequence % KEPT
        if self._numbers[at] != sequence:
            return self._unknown(sequence)
        if not self._open[at]:
            self.doubled += 1
            return Fate.DOUBLED
        self._open[at] = False
        overtaken = self._newest is not None and not not_before(sequence, self._newest)
        if overtaken or now_ns - self._sent_ns[at] > late_ns:
            self.late += 1
            return Fate.LATE
        self._newest = sequence
        return Fate.NEW

    def _unknown(self, sequence: int) -> Fate:
        """Judge an answer to a request that is not kept: it was long ago, or never."""
        if not_before(self._next - 1, sequence) and self._numbers[sequence % KEPT] != -1:
            self.late += 1
            self._gone = max(self._gone - 1, 0)  # none is, if it was answered in time as well
            return Fate.LATE
        self.unasked += 1
        return Fate.UNASKED
