"""The arrays of actuators that touch the fingertip."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class ActuatorArray:
    """Rows and columns of actuators; row 0 is far from the reader, column 0 is the left one.

    Parameters
    ----------
    rows, columns
        At least 1 each.
    column_pitch_mm, row_pitch_mm
        Between neighbouring columns (along x), and rows (along y).

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    rows: int
    columns: int
    column_pitch_mm: float
    row_pitch_mm: float

    def __post_init__(self) -> None:
        if not (1 <= self.rows <= 16 and 1 <= self.columns <= 64):
            raise ValueError(
                f"an array of {self.rows} × {self.columns} is not possible; "
                f"it must be 1 to 16 rows × 1 to 64 columns"
            )
        for pitch in (self.column_pitch_mm, self.row_pitch_mm):
            if not 0.05 <= pitch <= 50:
                raise ValueError(f"a pitch of {pitch:g} mm is out of range 0.05 to 50 mm")

    @property
    def span_mm(self) -> float:
        """From the left column to the right one: S = (columns - 1) · pitch."""
        return (self.columns - 1) * self.column_pitch_mm

    @property
    def shape(self) -> tuple[int, int]:
        """Shape of a frame: rows, columns."""
        return self.rows, self.columns

    def column_offsets_mm(self) -> NDArray[np.float64]:
        """Where each column is, right of the left one; float64[columns]."""
        return np.arange(self.columns, dtype=np.float64) * self.column_pitch_mm

    def row_offsets_mm(self) -> NDArray[np.float64]:
        """Where each row is, towards the reader from row 0; float64[rows]."""
        return np.arange(self.rows, dtype=np.float64) * self.row_pitch_mm


# Lévesque 2009, ch. 3: one row, pitch ε = 0.7 mm; the row pitch has no meaning.
VBD_ARRAY = ActuatorArray(rows=1, columns=12, column_pitch_mm=0.7, row_pitch_mm=0.7)
# Lévesque 2009, 4.2 and 5.2: an active area of 12.0 × 10.8 mm.
STRESS2_ARRAY = ActuatorArray(rows=6, columns=10, column_pitch_mm=1.2, row_pitch_mm=1.8)
# Lévesque 2009, ch. 8, by its author's later code.
LATERO = ActuatorArray(rows=8, columns=8, column_pitch_mm=1.2, row_pitch_mm=1.6125)
