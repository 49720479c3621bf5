"""The dots of a cell: their numbers, their places, and the bits that they are in a dot mask."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

# Column (0 is the left one) and row of each dot in its cell.
PLACES = {1: (0, 0), 2: (0, 1), 3: (0, 2), 4: (1, 0), 5: (1, 1), 6: (1, 2), 7: (0, 3), 8: (1, 3)}
DOT_ROWS = 4  # dots 7 and 8 make a fourth row


def mask_of(dots: Iterable[int]) -> int:
    """Mask of some dots, of which each may be named more than once; bit 0 is dot 1.

    >>> mask_of([1, 4])
    9
    """
    return sum({1 << dot - 1 for dot in dots})


def dots_of(mask: int) -> list[int]:
    """Numbers of the dots that are raised.

    >>> dots_of(9)
    [1, 4]
    """
    return [dot for dot in PLACES if mask & 1 << dot - 1]
