"""How a finger moves along a line: made-up hands, and recorded ones."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


@dataclass(frozen=True, slots=True, eq=False)
class Motion:
    """A way along the surface, straight between its knots.

    Parameters
    ----------
    t_s : float64[n]
        Time of each knot, from 0, increasing.
    x_mm : float64[n]
        Where the array's left column is then.
    """

    t_s: NDArray[np.float64]
    x_mm: NDArray[np.float64]


class Hand(Protocol):
    """A hand that reads line after line."""

    def read_line(self, start_mm: float, end_mm: float) -> Motion:
        """The next line: from where the hand is, at start, to its end and back to the start."""
        ...
