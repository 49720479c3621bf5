"""How a line stays under the finger when its distances change, and the page is laid out around it.

The cell under the middle of the array stays there, to the same share of its width. The line then
begins a little to the right of the left stop, or loses cells that would be left of it to the line
before; what no longer has room at its end goes to the line after. Nothing is lost or shown twice.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from vbraille.layout.blocks import Break

if TYPE_CHECKING:
    from vbraille.braille.geometry import Geometry
    from vbraille.layout.pages import Line

_ROUNDING = 1e-9


@dataclass(frozen=True, slots=True)
class Held:
    """A line as it goes on under the finger.

    Parameters
    ----------
    forced
        Places at which lines of the new page begin: this line, and the one after it.
    start_mm
        Place along x at which the line's first cell begins.
    """

    forced: tuple[Break, ...]
    start_mm: float

    @property
    def character(self) -> int:
        """Source character that the line begins with."""
        return self.forced[0].character


def hold(
    line: Line,
    following: int | None,
    before: Geometry,
    after: Geometry,
    *,
    x_mm: float | None,
    start_mm: float,
    span_mm: float,
) -> Held | None:
    """Tell how a line goes on under the finger in another geometry; None for a line of no cells.

    Parameters
    ----------
    line
        Line under the array.
    following
        Source character that the line after it begins with; None if there is none.
    before, after
        Distances until now, and from now on; a line has room for a cell in both.
    x_mm
        Place of the array's centre; None if not known.
    start_mm
        Place at which the line's first cell has begun until now.
    span_mm
        Width of the array, from its left column to its right one.
    """
    if not len(line.cells):
        return None
    old_mm, new_mm = before.cell_pitch_mm, after.cell_pitch_mm
    cells = len(line)
    own_mm = 0.0 if x_mm is None else x_mm - start_mm
    within_mm = min(max(own_mm, 0.0), cells * old_mm)
    under = min(math.floor(within_mm / old_mm), cells - 1)
    begin_mm = start_mm + within_mm * (1 - new_mm / old_mm)
    left = min(max(math.ceil(-begin_mm / new_mm - _ROUNDING), 0), under)
    left, first = _beginning(line, left, under)
    begin_mm += left * new_mm
    room_mm = after.travel_mm - span_mm - begin_mm - after.dot_width_mm - after.dot_spacing_mm
    fit = math.floor(room_mm / new_mm + _ROUNDING) + 1
    most = min(fit, after.cells_per_line(span_mm))
    if cells - left > most:
        following = _cut(line, max(left + most, under + 1) - line.indent, under, following)
    forced = (first,) if following is None else (first, Break(following))
    return Held(forced, begin_mm)


def _beginning(line: Line, left: int, under: int) -> tuple[int, Break]:
    """Number of cells that the line loses at its beginning, and how it begins after them."""
    starts, masks = line.cells.starts, line.cells.masks
    at = max(left - line.indent, 0)
    while 0 < at < under - line.indent and starts[at] == starts[at - 1]:
        at, left = at + 1, left + 1  # the cells of a character stay together
    while at > 0 and starts[at] == starts[at - 1]:
        at, left = at - 1, left - 1
    inked = at
    while inked < len(masks) - 1 and not masks[inked]:
        inked += 1
    return left, Break(int(starts[inked]), line.indent + inked - left)


def _cut(line: Line, full: int, under: int, following: int | None) -> int | None:
    """Source character that the next line begins with, if this one is full before a cell."""
    starts, masks = line.cells.starts, line.cells.masks
    if full >= len(masks):
        return following
    least = max(under - line.indent, 0)
    blank = full
    while blank > least and masks[blank]:
        blank -= 1
    at = blank + 1 if blank > least else full
    while at > least + 1 and starts[at] == starts[at - 1]:
        at -= 1
    return int(starts[at])
