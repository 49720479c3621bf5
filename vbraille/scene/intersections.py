"""Intersections of the edges of a polygon."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.scene.measures import Point

MOST_VERTICES = 20_000
_PIECE = 2_000_000  # pairs of edges whose boxes are compared at once
_SLACK_MM = 1e-9


def meeting_edges(vertices_mm: tuple[Point, ...]) -> tuple[int, int] | None:
    """Numbers, from 1, of two edges that have a place in common; None if there are none.

    Edge 1 goes from the first vertex to the second, the last one back to the first. Edges that
    follow each other have a vertex in common, which is right; they meet only if the second goes
    back over the first.

    Parameters
    ----------
    vertices_mm
        Three vertices or more, of which no two that follow each other are one place.

    Raises
    ------
    ValueError
        If there are more than 20,000.

    >>> meeting_edges(((0, 0), (10, 10), (10, 0), (0, 10)))
    (1, 3)
    """
    starts = np.array(vertices_mm, np.float64)
    number = len(starts)
    if number > MOST_VERTICES:
        raise ValueError(
            f"vertices are {number}; there can be {MOST_VERTICES}, so draw it as a path"
        )
    ends, before = np.roll(starts, -1, axis=0), np.roll(starts, 1, axis=0)
    back = (_turns(before, starts, ends) == 0) & (
        ((before - starts) * (ends - starts)).sum(axis=1) > 0
    )
    if back.any():
        index = int(np.argmax(back))
        first, second = sorted(((index - 1) % number + 1, index + 1))
        return first, second
    low, high = np.minimum(starts, ends) - _SLACK_MM, np.maximum(starts, ends) + _SLACK_MM
    rows = max(_PIECE // number, 1)
    for begin in range(0, number, rows):
        some = slice(begin, begin + rows)
        near = np.ones((len(starts[some]), number), bool)
        for axis in range(2):
            near &= low[some, None, axis] <= high[None, :, axis]
            near &= high[some, None, axis] >= low[None, :, axis]
        first, second = np.nonzero(near)
        first += begin
        apart = (second > first + 1) & ((first > 0) | (second < number - 1))
        first, second = first[apart], second[apart]
        a, b, c, d = starts[first], ends[first], starts[second], ends[second]
        meet = (_turns(a, b, c) * _turns(a, b, d) <= 0) & (_turns(c, d, a) * _turns(c, d, b) <= 0)
        if meet.any():
            at = int(np.argmax(meet))
            return int(first[at]) + 1, int(second[at]) + 1
    return None


def _turns(
    a: NDArray[np.float64], b: NDArray[np.float64], c: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Signs of the turns at b on the ways from a to c."""
    along, away = b - a, c - a
    return np.sign(along[:, 0] * away[:, 1] - along[:, 1] * away[:, 0])
