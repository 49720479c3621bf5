"""What a loop has done, counted."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

if TYPE_CHECKING:
    import numpy as np


@dataclass(slots=True)
class Tally:
    """How many ticks there were so far, and what happened in them.

    Parameters
    ----------
    ticks, late
        Ticks done, and deadlines that passed before their tick could begin.
    overruns
        Ticks whose own work took longer than a period.
    forward_mm, forward_s
        Way to the right, and the time that it took.
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
        """Make a tally of a record of the ring."""
        return cls(
            ticks=int(tick["tick"]) + 1,
            late=int(tick["late"]),
            overruns=int(tick["overruns"]),
            forward_mm=float(tick["forward_mm"]),
            forward_s=float(tick["forward_s"]),
        )

    def __add__(self, other: Tally) -> Tally:
        """The tally of the ticks of both."""
        return Tally(
            self.ticks + other.ticks,
            self.late + other.late,
            self.overruns + other.overruns,
            self.forward_mm + other.forward_mm,
            self.forward_s + other.forward_s,
        )
