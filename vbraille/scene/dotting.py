"""Places of the dots of dotted shapes: Lévesque 2009, 8.4.4.

The source wants a dot on each end of a line and on each vertex of a polygon, the others evenly
between, and a least separation that also holds across joints. The arithmetic is that of its
author's later code, with m, the least distance of two middles, a dot's diameter and the separation:

- a line of length d has ⌊d/m⌋ + 1 dots, and so has an edge of a polygon, but with m / sin θ in
  place of m where the angle θ at one of its ends is below 90°;
- a circle has ⌊π / asin(m/2R)⌋ dots, the first to the right of its middle.

Ours is the rest. Of dots that would still be nearer than m, because edges are short or come near
each other, the later is left out, and one on a vertex counts before the others. A path has its
vertices where it turns by more than 40°; between them dots are evenly spaced along it, so that a
curve that is many short edges is dotted like a line.

Dots that move (9.3.3) do so between the vertices of a shape, whose own dots stay, or between the
ends of an open path. Dots that are evenly spaced are a row without end, which is seen as far as its
window lets it: half a spacing from a vertex, or where the strokes of its two edges part; as far as
a dot reaches beyond an open end.
"""

from __future__ import annotations

import itertools
import math
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vbraille.scene.joints import edge_lengths_mm
from vbraille.scene.patterns import Circle, Polygon, Shape

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from vbraille.scene.measures import Point
    from vbraille.scene.patterns import AnyPattern

# Dots under a hand are asked for at each move of it.
_KEPT = 100  # shapes
_CORNER = math.radians(40.0)
_TOLERANCE = 1.0 - 1e-9  # two dots whose distance is m but for rounding may stay


class PlacedDot(NamedTuple):
    """A place of the middle of a dot, and whether it is a vertex of a polygon or a path."""

    x_mm: float
    y_mm: float
    vertex: bool = False


class DotRow(NamedTuple):
    """A row of evenly spaced dots that moves along a part of a shape's path.

    Parameters
    ----------
    points_mm
        Places that the row goes through; none for a row around a circle.
    pitch_mm
        Distance between two dots along it; one of them is at its beginning at first.
    begin_mm, end_mm
        Window outside which there is nothing of it, from its beginning and from its end on. It is
        below 0 at the ends of an open path, and infinite for a row that closes.
    """

    points_mm: tuple[Point, ...]
    pitch_mm: float
    begin_mm: float = -math.inf
    end_mm: float = -math.inf


@lru_cache(maxsize=_KEPT)
def rows_of(shape: Shape) -> tuple[tuple[PlacedDot, ...], tuple[DotRow, ...]]:
    """Compute which dots of a shape stay where they are, and the rows that move between them."""
    if shape.dots is None or not shape.dots.velocity_mm_s:
        return dots_of(shape), ()
    radius_mm = shape.dots.dot.radius_mm
    least_mm = _least_mm(shape)
    if isinstance(shape, Circle):
        return (), (DotRow((), math.tau * shape.radius_mm / len(dots_of(shape))),)
    rows: list[DotRow] = []
    stay: list[PlacedDot] = []
    for run in _runs_of(shape, least_mm):
        first, last = (angle is not None for angle in run.angles)
        if first:
            stay.append(PlacedDot(*run.points_mm[0], vertex=True))
        spaces = len(run.dots()) + 1 if run.length_mm >= run.least_mm * _TOLERANCE else 0
        pitch_mm = run.length_mm / max(spaces, 1)
        if spaces < 1 + (first and last):  # There is no room for a row.
            stay += [] if first else [PlacedDot(*run.points_mm[0])]
            stay += [] if last or run.closes else [PlacedDot(*run.points_mm[-1])]
        elif run.closes:
            rows.append(DotRow(run.points_mm, pitch_mm))
        else:
            window_mm = (
                -radius_mm if angle is None else max(pitch_mm / 2, radius_mm / math.tan(angle / 2))
                for angle in run.angles
            )
            rows.append(DotRow(run.points_mm, pitch_mm, *window_mm))
    return _apart(stay, least_mm), tuple(rows)


@lru_cache(maxsize=_KEPT)
def dots_of(shape: Shape) -> tuple[PlacedDot, ...]:
    """Compute where the dots of a dotted shape stand; none if it is not dotted."""
    if shape.dots is None:
        return ()
    least_mm = _least_mm(shape)
    if isinstance(shape, Circle):
        sine = least_mm / (2 * shape.radius_mm)
        count = 1 if sine > 1.0 else math.floor(math.pi / math.asin(sine) + 1e-9)
        (x, y), radius = shape.center_mm, shape.radius_mm
        angles = (math.tau * i / count for i in range(count))
        return tuple(PlacedDot(x + radius * math.cos(a), y + radius * math.sin(a)) for a in angles)
    dots: list[PlacedDot] = []
    for run in _runs_of(shape, least_mm):
        begins, ends = run.angles
        dots += [PlacedDot(*run.points_mm[0], vertex=begins is not None), *run.dots()]
        if ends is None and not run.closes:
            dots.append(PlacedDot(*run.points_mm[-1]))
    return _apart(dots, least_mm)


def most_dots_of(shape: AnyPattern) -> int:
    """Compute how many dots stand along a shape at most, without placing them."""
    if not isinstance(shape, Shape) or shape.dots is None:
        return 0
    contours, _ = shape.outline
    length_mm = sum(sum(edge_lengths_mm(contour, closed=True)) for contour in contours)
    if isinstance(shape, Circle):
        length_mm = math.tau * shape.radius_mm
    return math.ceil(length_mm / _least_mm(shape)) + sum(map(len, contours))


def _least_mm(shape: Shape) -> float:
    """Least distance of the middles of two dots of a dotted shape."""
    return 2 * shape.dots.dot.radius_mm + shape.dots.separation_mm if shape.dots else 0.0


class _Run(NamedTuple):
    """A part of a path from one of its corners or ends to the next.

    Parameters
    ----------
    points_mm
        Places that it goes through.
    least_mm
        Least distance of two dots on it.
    angles
        Angles θ of the corners where it begins and ends; None at an end of the path.
    closes
        Whether it is a closed path without a corner.
    """

    points_mm: tuple[Point, ...]
    least_mm: float
    angles: tuple[float | None, ...]
    closes: bool

    @property
    def length_mm(self) -> float:
        """Length along the path, in mm."""
        return sum(edge_lengths_mm(self.points_mm, closed=False))

    def dots(self) -> list[PlacedDot]:
        """Dots that divide it evenly, without those at its ends.

        Where it is bent dots are nearer to each other than along it, so there may be fewer of them.
        """
        places = np.array(self.points_mm)
        along = np.concatenate(([0.0], np.cumsum(edge_lengths_mm(self.points_mm, closed=False))))
        spaces = math.floor(along[-1] / self.least_mm + 1e-9)
        while spaces > 1:
            wanted = along[-1] * np.arange(spaces + 1) / spaces
            chain = np.stack([np.interp(wanted, along, axis) for axis in places.T], axis=1)
            share = np.hypot(*np.diff(chain, axis=0).T).min() / self.least_mm
            # Where it turns back on itself no even spacing does, and dots are left out afterwards.
            if share >= _TOLERANCE or share < 0.5:
                return [PlacedDot(x, y) for x, y in chain[1:-1].tolist()]
            spaces = min(spaces - 1, math.floor(spaces * share) + 1)
        return []


def _runs_of(shape: Shape, least_mm: float) -> Iterator[_Run]:
    """Cut a shape's path at its corners, which are all vertices of a polygon, and at its ends."""
    contours, closed = shape.outline
    for points in contours:
        count = len(points)
        corners: dict[int, float] = {}
        for i in range(count) if closed else range(1, count - 1):
            turn = _turn(points[i - 1], points[i], points[(i + 1) % count])
            if turn < math.pi - _CORNER or isinstance(shape, Polygon):
                corners[i] = turn
        cuts = [*corners, min(corners) + count] if corners else [0, count]
        for start, end in itertools.pairwise(cuts if closed else [0, *corners, count - 1]):
            run = [i % count for i in range(start, end + 1)]
            ends = corners.get(run[0]), corners.get(run[-1])
            # At corners sharper than 90° dots are farther apart.
            sines = (math.sin(angle) for angle in ends if angle is not None and angle < math.pi / 2)
            widening = 1.0 / max(min(sines, default=1.0), 1e-6)
            places = tuple(points[i] for i in run)
            yield _Run(places, least_mm * widening, ends, closed and not corners)


def _turn(before: Point, at: Point, after: Point) -> float:
    """Angle θ between two edges at their joint, 0 to π."""
    ux, uy = before[0] - at[0], before[1] - at[1]
    vx, vy = after[0] - at[0], after[1] - at[1]
    return math.atan2(abs(ux * vy - uy * vx), ux * vx + uy * vy)


def _apart(dots: Sequence[PlacedDot], least_mm: float) -> tuple[PlacedDot, ...]:
    """Leave out dots that are nearer than that to one that counts before them."""
    kept: list[int] = []
    near: dict[tuple[int, int], list[Point]] = {}
    for number in sorted(range(len(dots)), key=lambda number: not dots[number].vertex):
        x, y, _ = dots[number]
        column, row = math.floor(x / least_mm), math.floor(y / least_mm)
        cells = itertools.product((column - 1, column, column + 1), (row - 1, row, row + 1))
        around = (place for cell in cells for place in near.get(cell, ()))
        if all(math.dist(place, (x, y)) >= least_mm * _TOLERANCE for place in around):
            kept.append(number)
            near.setdefault((column, row), []).append((x, y))
    return tuple(dots[number] for number in sorted(kept))
