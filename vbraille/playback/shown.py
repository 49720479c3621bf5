"""What a page shows of a line of braille that was recorded."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.live.messages import LineShown

if TYPE_CHECKING:
    from collections.abc import Iterable


def line_shown(
    number: int, masks: Iterable[int], top_mm: float = 0.0, *, under: bool = False
) -> LineShown:
    """Describe a line of cells, of whose text nothing is known."""
    cells = [int(mask) for mask in masks]
    return LineShown(number, "", 0.0, top_mm, cells, [(0, 0)] * len(cells), under)
