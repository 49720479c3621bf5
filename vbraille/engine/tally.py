"""Counts of what a loop has done."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

if TYPE_CHECKING:
    import numpy as np


@dataclass(slots=True)
class Tally:
    """What happened so far, in numbers.

    Parameters
    ----------
    ticks, late
        Number of ticks done, and of deadlines that passed before their tick could begin.
    overruns
        Number of ticks whose own work took longer than a period.
    forward_mm, forward_s
        How far the hand went to the right in all, and how long that took.
    """

    ticks: int = 0
    late: int = 0
    overruns: int = 0
    forward_mm: float = 0.0
    forward_s: float = 0.0

    @property
    def scanning_mm_s(self) -> float:
        """Mean speed of the hand while it moved right; 0 if it never did."""
        return self.forward_mm / self.forward_s if self.forward_s else 0.0

    @classmethod
    def of(cls, tick: np.void) -> Self:
        """Make a tally from a record of the ring."""
        return cls(
            ticks=int(tick["tick"]) + 1,
            late=int(tick["late"]),
            overruns=int(tick["overruns"]),
            forward_mm=float(tick["forward_mm"]),
            forward_s=float(tick["forward_s"]),
        )

    def __add__(self, other: Tally) -> Tally:
        """Add two tallies."""
        return Tally(
            self.ticks + other.ticks,
            self.late + other.late,
            self.overruns + other.overruns,
            self.forward_mm + other.forward_mm,
            self.forward_s + other.forward_s,
        )
