"""A picture out of a mailbox, for the loop to show."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vbraille.engine.mailbox import slot_dtype
from vbraille.render import kernels, work

if TYPE_CHECKING:
    from numpy.typing import NDArray

_SCRATCH = 64  # places for which a kernel has room beside its parameters


class PostedPicture:
    """A picture out of a mailbox: its own copy, in the memory that it was made with.

    Parameters
    ----------
    shape, cells
        As the mailbox's.
    """

    def __init__(self, shape: tuple[int, int], cells: int) -> None:
        rows, columns = shape
        self.slot = np.zeros((), slot_dtype(shape, cells))
        self._work = np.zeros((3, max(_SCRATCH, columns, work.IDLE + rows)))
        self._work[0, work.COLUMNS] = columns
        self._parameters = self._work[0, : work.IDLE + rows]
        self._gains = self.slot["gains"]

    @property
    def line(self) -> int:
        """Number of its line."""
        return int(self.slot["line"])

    @property
    def end_mm(self) -> float:
        """Where its last dot ends."""
        return float(self.slot["end_mm"])

    @property
    def number(self) -> int:
        """How many were posted with it."""
        return int(self.slot["number"])

    def update(self) -> None:
        """Have the kernel see what was copied in."""
        np.copyto(self._parameters, self.slot["parameters"])

    def frame(self, x_mm: float, out: NDArray[np.float64]) -> None:
        """Fill the frame for the array's centre at x."""
        kernels.frame(self._work, self._gains, x_mm, out)
