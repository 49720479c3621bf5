"""Intersections of the edges of a polygon."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.scene.measures import Point

# Below it, plain Python is done before numpy is loaded.
_FEW = 60
# Pairs of edges that are compared: about a second, in pieces of some 50 MB.
MOST_PAIRS, _PIECE = 20_000_000, 500_000
_SLACK_MM = 1e-9
# Edges are only compared if they overlap along a direction: that of these which leaves fewest.
_DIRECTIONS = (
    (1.0, 0.0),
    (0.0, 1.0),
    (math.sqrt(0.5), math.sqrt(0.5)),
    (math.sqrt(0.5), -math.sqrt(0.5)),
)


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
        If so many edges lie so close together that it would take too long to find out.

    >>> meeting_edges(((0, 0), (10, 10), (10, 0), (0, 10)))
    (1, 3)
    """
    number = len(vertices_mm)
    for index in range(number):
        before, here, after = (vertices_mm[(index + k) % number] for k in (-1, 0, 1))
        if _turn(before, here, after) == 0 and _dot(here, before, after) > 0:
            return tuple(sorted(((index - 1) % number + 1, index + 1)))  # pyright: ignore[reportReturnType]
    if number < _FEW:
        return next(_slowly(vertices_mm), None)
    return _quickly(vertices_mm)


def _slowly(vertices_mm: tuple[Point, ...]) -> Iterator[tuple[int, int]]:
    """Pairs of edges that meet, one after the other."""
    number = len(vertices_mm)
    edges = [(vertices_mm[i], vertices_mm[(i + 1) % number]) for i in range(number)]
    for first in range(number):
        a, b = edges[first]
        left, right = (a[0], b[0]) if a[0] < b[0] else (b[0], a[0])
        top, bottom = (a[1], b[1]) if a[1] < b[1] else (b[1], a[1])
        for second in range(first + 2, number - (first == 0)):
            c, d = edges[second]
            if (
                (c[0] < left and d[0] < left)
                or (c[0] > right and d[0] > right)
                or (c[1] < top and d[1] < top)
                or (c[1] > bottom and d[1] > bottom)
            ):
                continue
            if _turn(a, b, c) * _turn(a, b, d) <= 0 and _turn(c, d, a) * _turn(c, d, b) <= 0:
                yield first + 1, second + 1


def _turn(a: Point, b: Point, c: Point) -> float:
    """Sign of the turn at b on the way from a to c: -1, 0 or 1."""
    area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    return int(area > 0) - int(area < 0)


def _dot(origin: Point, a: Point, b: Point) -> float:
    return (a[0] - origin[0]) * (b[0] - origin[0]) + (a[1] - origin[1]) * (b[1] - origin[1])


def _quickly(vertices_mm: tuple[Point, ...]) -> tuple[int, int] | None:
    """Numbers of two edges that meet, found among those that overlap along one direction."""
    import numpy as np

    starts = np.array(vertices_mm, np.float64)
    ends = np.roll(starts, -1, axis=0)
    number = len(starts)
    best: tuple[int, NDArray[np.int64], NDArray[np.int64]] | None = None
    boxes: list[tuple[NDArray[np.float64], NDArray[np.float64]]] = []
    for direction in _DIRECTIONS:
        along, along_end = starts @ np.array(direction), ends @ np.array(direction)
        low, high = np.minimum(along, along_end), np.maximum(along, along_end)
        low, high = low - _SLACK_MM, high + _SLACK_MM
        boxes.append((low, high))
        order = np.argsort(low, kind="stable")
        last = np.searchsorted(low[order], high[order], side="right")
        counts = last - np.arange(number) - 1
        pairs = int(counts.sum())
        if best is None or pairs < best[0]:
            best = pairs, order, counts
    assert best is not None
    pairs, order, counts = best
    if pairs > MOST_PAIRS:
        raise ValueError(
            f"vertices are {number} with edges so close together that they cannot be compared; "
            "leave some out"
        )
    sums = np.concatenate([[0], np.cumsum(counts)])
    begin = 0
    while begin < number:
        end = max(begin + 1, int(np.searchsorted(sums, sums[begin] + _PIECE, side="right")) - 1)
        found = _among(starts, ends, order, counts, boxes, begin, end)
        if found is not None:
            return found
        begin = end
    return None


def _among(
    starts: NDArray[np.float64],
    ends: NDArray[np.float64],
    order: NDArray[np.int64],
    counts: NDArray[np.int64],
    boxes: list[tuple[NDArray[np.float64], NDArray[np.float64]]],
    begin: int,
    end: int,
) -> tuple[int, int] | None:
    """Numbers of two edges that meet, of which the first is among some in the order."""
    import numpy as np

    of = counts[begin:end]
    place = np.repeat(np.arange(begin, end), of)
    step = np.arange(len(place)) - np.repeat(np.cumsum(of) - of, of) + 1
    first, second = order[place], order[place + step]
    apart = np.abs(first - second)
    near = (apart > 1) & (apart < len(starts) - 1)
    for low, high in boxes:
        near &= (low[first] <= high[second]) & (low[second] <= high[first])
    first, second = first[near], second[near]
    a, b, c, d = starts[first], ends[first], starts[second], ends[second]
    meet = (_turns(a, b, c) * _turns(a, b, d) <= 0) & (_turns(c, d, a) * _turns(c, d, b) <= 0)
    if not meet.any():
        return None
    at = int(np.argmax(meet))
    one, other = sorted((int(first[at]) + 1, int(second[at]) + 1))
    return one, other


def _turns(
    a: NDArray[np.float64], b: NDArray[np.float64], c: NDArray[np.float64]
) -> NDArray[np.float64]:
    import numpy as np

    return np.sign(
        (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    )
