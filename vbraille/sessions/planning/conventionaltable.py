"""The table of a protocol that says what stands on a conventional braille display, and where."""

from __future__ import annotations

from typing import Literal

from vbraille.errors import check_range
from vbraille.sessions.planning.spellings import Masks
from vbraille.toml.tomlfile import Table

Where = Literal["device", "brlapi"]
CONVENTIONAL: Where = "brlapi"  # on the display that BRLTTY drives
MOST_CELLS = 200  # no conventional display has a longer row


class ConventionalTable(Table, frozen=True, kw_only=True):
    """The table ``[conventional]``.

    Parameters
    ----------
    cell
        Cell of the conventional display at which everything on it begins, from 1.
    reference
        Dot masks of what stands there throughout each trial on the device, to be compared with;
        empty for nothing.

    Raises
    ------
    ValueError
        If the number is out of range.
    """

    cell: int = 1
    reference: Masks = Masks()

    def __post_init__(self) -> None:
        check_range("cell", self.cell, 1, MOST_CELLS)

    def placed(self, masks: tuple[int, ...]) -> bytes:
        """Cells of the display, from its left, on which some cells stand in their place."""
        return bytes((0,) * (self.cell - 1) + tuple(masks))
