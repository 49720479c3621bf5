"""Mappings of dots to actuator rows, with their phases: a table per method.

Lévesque 2009, fig. 4.5. Rows count from 0, the row far from the reader, and dot
row r owns actuator rows 2r and 2r + 1. Where the source's scan cannot be read
(which rows are "odd", which rows of a pair serve which dot column) the tables
follow its author's later published code.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vbraille.braille.cells import DOT_ROWS, PLACES, mask_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

NONE = -1


@dataclass(frozen=True, slots=True)
class Mapping:
    """Dots that each row of actuators shows.

    Parameters
    ----------
    name
        Name of the method.
    left, right
        For each actuator row, the dot row that it shows of a cell's left and of its right dot
        column: 0, 1, 2, or 3 for dots 7 and 8; `NONE` for none.
    inverted
        For each actuator row, whether its phase is inverted: its idle end is then 1, and a dot
        swings it towards 0.

    Raises
    ------
    ValueError
        If the tables differ in length or name no dot row.
    """

    name: str
    left: tuple[int, ...]
    right: tuple[int, ...]
    inverted: tuple[bool, ...]

    def __post_init__(self) -> None:
        if not len(self.left) == len(self.right) == len(self.inverted) > 0:
            raise ValueError(f"the tables of mapping {self.name} differ in length")
        for row in (*self.left, *self.right):
            if not NONE <= row < DOT_ROWS:
                raise ValueError(f"mapping {self.name} shows dot row {row}; there are 0 to 3")

    @property
    def rows(self) -> int:
        """Number of actuator rows that the method needs."""
        return len(self.left)

    def idle(self) -> NDArray[np.float64]:
        """Tell the deflection of each row off the dots, while a line is shown; float64[rows]."""
        return np.array(self.inverted, np.float64)

    def shown_dots(self) -> int:
        """Tell which dots any row shows, as a mask; bit 0 is dot 1."""
        sides = (self.left, self.right)
        return mask_of(dot for dot, (column, row) in PLACES.items() if row in sides[column])

    def row_bits(self) -> NDArray[np.uint16]:
        """Tell which actuator rows show a dot of each possible cell; uint16[256, 2].

        For each dot mask and dot column (0 = left), bit r is set if actuator row r shows a dot.
        """
        bits = np.zeros((256, 2), np.uint16)
        masks = np.arange(256)
        for dot, (column, dot_row) in PLACES.items():
            table = self.right if column else self.left
            rows = sum(1 << r for r, shown in enumerate(table) if shown == dot_row)
            bits[:, column] |= np.where(masks & mask_of([dot]), rows, 0).astype(np.uint16)
        return bits


_ALL = tuple(range(DOT_ROWS))
# Which rows of dots each cell has in its left and in its right dot column; uint16[256, 2].
DOT_BITS = Mapping("dots", _ALL, _ALL, (False,) * DOT_ROWS).row_bits()

_NO = (False,) * 6
_PAIRS = (0, 0, 1, 1, 2, 2)
_EVEN = (0, NONE, 1, NONE, 2, NONE)
_ODD = (NONE, 0, NONE, 1, NONE, 2)
_TOP = (0, 1, 2, NONE, NONE, NONE)
_EIGHT = (0, NONE, 1, NONE, 2, NONE, 3, NONE)

MAPPINGS = {
    mapping.name: mapping
    for mapping in (
        # Preferred, and used in the source's experiments: dot rows stand two actuator rows apart.
        Mapping("alternate", _EVEN, _EVEN, _NO),
        # Each dot row drives a pair of actuator rows.
        Mapping("paired", _PAIRS, _PAIRS, _NO),
        # As paired, but the rows of a pair move against each other, which shears the skin most.
        Mapping("sheared", _PAIRS, _PAIRS, (True, False) * 3),
        # The two dot columns of a cell drive different actuator rows.
        Mapping("split-columns", _EVEN, _ODD, _NO),
        # The middle dot row moves against its neighbours (later code, not in fig. 4.5).
        Mapping("row-sheared", _PAIRS, _PAIRS, (False, False, True, True, False, False)),
        # Dot rows stand one actuator row apart (later code, not in fig. 4.5).
        Mapping("compact", _TOP, _TOP, _NO),
        # Our own: as compact, in the middle of any array of three rows or more.
        Mapping("three-rows", (0, 1, 2), (0, 1, 2), (False,) * 3),
        # For arrays of eight rows: alternate from the first row on, as the later code has it there.
        # What is left are two rows, of which one takes dots 7 and 8: our own.
        Mapping("eight-dots", _EIGHT, _EIGHT, (False,) * 8),
    )
}


def single_row(dot_row: int) -> Mapping:
    """Show one dot row on a one-row array.

    Parameters
    ----------
    dot_row
        1 (dots 1 and 4), 2 or 3, as readers count them.

    Raises
    ------
    ValueError
        If it is another number.
    """
    if dot_row not in (1, 2, 3):
        raise ValueError(f"dot row is {dot_row}; it must be 1, 2 or 3")
    return Mapping(f"dot-row-{dot_row}", (dot_row - 1,), (dot_row - 1,), (False,))
