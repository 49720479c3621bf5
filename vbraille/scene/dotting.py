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
from collections import defaultdict
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

from vbraille.scene.joints import edge_lengths_mm
from vbraille.scene.patterns import Circle, PathShape, Polygon, StraightLine

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from vbraille.scene.measures import Point
    from vbraille.scene.patterns import AnyPattern

_DOTTED = StraightLine | Circle | Polygon | PathShape
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
def rows_of(
    shape: StraightLine | Circle | Polygon | PathShape,
) -> tuple[tuple[PlacedDot, ...], tuple[DotRow, ...]]:
    """Compute which dots of a shape stay where they are, and the rows that move between them."""
    if shape.dots is None or not shape.dots.velocity_mm_s:
        return dots_of(shape), ()
    radius_mm = shape.dots.dot.radius_mm
    least_mm = 2 * radius_mm + shape.dots.separation_mm
    if isinstance(shape, Circle):
        return (), (DotRow((), math.tau * shape.radius_mm / len(dots_of(shape))),)
    rows: list[DotRow] = []
    stay: list[PlacedDot] = []
    for run in _runs_of(shape, least_mm):
        begin, end = run.points_mm[0], run.points_mm[-1]
        first, last = (angle is not None for angle in run.angles)
        if first:
            stay.append(PlacedDot(*begin, vertex=True))
        spaces, _ = _along(run)
        if spaces < 1 + (first and last):  # There is no room for a row.
            stay += [] if first else [PlacedDot(*begin)]
            stay += [] if last or run.closes else [PlacedDot(*end)]
            continue
        pitch_mm = run.length_mm / spaces
        if run.closes:
            rows.append(DotRow(run.points_mm, pitch_mm))
            continue
        window_mm = (
            -radius_mm if angle is None else max(pitch_mm / 2, radius_mm / math.tan(angle / 2))
            for angle in run.angles
        )
        rows.append(DotRow(run.points_mm, pitch_mm, *window_mm))
    return _apart(stay, least_mm), tuple(rows)


@lru_cache(maxsize=_KEPT)
def dots_of(shape: StraightLine | Circle | Polygon | PathShape) -> tuple[PlacedDot, ...]:
    """Compute where the dots of a dotted shape stand; none if it is not dotted."""
    if shape.dots is None:
        return ()
    least_mm = 2 * shape.dots.dot.radius_mm + shape.dots.separation_mm
    if isinstance(shape, Circle):
        return _on_circle(shape, least_mm)
    return _apart(_on_runs(shape, least_mm), least_mm)


def most_dots_of(shape: AnyPattern) -> int:
    """Compute how many dots stand along a shape at most, without placing them."""
    if not isinstance(shape, _DOTTED) or shape.dots is None:
        return 0
    least_mm = 2 * shape.dots.dot.radius_mm + shape.dots.separation_mm
    if isinstance(shape, Circle):
        return math.ceil(math.tau * shape.radius_mm / least_mm)
    contours, _ = shape.outline
    length_mm = sum(sum(edge_lengths_mm(contour, closed=True)) for contour in contours)
    return math.ceil(length_mm / least_mm) + sum(map(len, contours))


def _on_circle(circle: Circle, least_mm: float) -> tuple[PlacedDot, ...]:
    sine = least_mm / (2 * circle.radius_mm)
    count = 1 if sine > 1.0 else math.floor(math.pi / math.asin(sine) + 1e-9)
    x, y = circle.center_mm
    angles = (math.tau * i / count for i in range(count))
    radius = circle.radius_mm
    return tuple(PlacedDot(x + radius * math.cos(a), y + radius * math.sin(a)) for a in angles)


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
    angles: tuple[float | None, float | None] = (None, None)
    closes: bool = False

    @property
    def length_mm(self) -> float:
        """Length along the path, in mm."""
        return sum(edge_lengths_mm(self.points_mm, closed=False))


def _on_runs(shape: StraightLine | Polygon | PathShape, least_mm: float) -> Iterator[PlacedDot]:
    """Put dots on corners and ends, and evenly between those."""
    for run in _runs_of(shape, least_mm):
        begin, end = run.points_mm[0], run.points_mm[-1]
        yield PlacedDot(*begin, vertex=run.angles[0] is not None)
        if isinstance(shape, Polygon):
            yield from _between(begin, end, _spaces(math.dist(begin, end), run.least_mm))
        else:
            yield from _along(run)[1]
        if run.angles[1] is None and not run.closes:
            yield PlacedDot(*end)


def _runs_of(shape: StraightLine | Polygon | PathShape, least_mm: float) -> Iterator[_Run]:
    """Cut a shape's path at its corners, which are all vertices of a polygon, and at its ends."""
    if isinstance(shape, StraightLine):
        yield _Run((shape.start_mm, shape.end_mm), least_mm)
        return
    every = isinstance(shape, Polygon)
    closed = isinstance(shape, Polygon) or shape.closed
    for points in (shape.vertices_mm,) if isinstance(shape, Polygon) else shape.contours_mm:
        count = len(points)
        corners = {
            i: turn
            for i in (range(count) if closed else range(1, count - 1))
            if (turn := _turn(points[i - 1], points[i], points[(i + 1) % count]))
            < math.pi - _CORNER
            or every
        }
        for run in _runs(count, closed, sorted(corners)):
            ends = corners.get(run[0]), corners.get(run[-1])
            widening = max(1.0 if angle is None else _widening(angle) for angle in ends)
            places = tuple(points[i] for i in run)
            yield _Run(places, least_mm * widening, ends, closed and not corners)


def _runs(count: int, closed: bool, corners: list[int]) -> Iterator[list[int]]:
    """Cut a contour at its corners, and at its ends."""
    if not closed:
        cuts = [0, *corners, count - 1]
    else:
        cuts = [*corners, corners[0] + count] if corners else [0, count]
    for start, end in itertools.pairwise(cuts):
        yield [i % count for i in range(start, end + 1)]


def _along(run: _Run) -> tuple[int, list[PlacedDot]]:
    """Divide a run evenly: into how many spaces, and the dots between them.

    Where it is bent dots are nearer to each other than along it, so there may be fewer of them.
    """
    places, least_mm = run.points_mm, run.least_mm
    lengths = edge_lengths_mm(places, closed=False)
    whole = sum(lengths)
    spaces = _spaces(whole, least_mm)
    while spaces > 1:
        inner = list(_at(places, lengths, [whole * i / spaces for i in range(1, spaces)]))
        chain = [places[0], *inner, places[-1]]
        share = min(map(math.dist, chain, chain[1:])) / least_mm
        # Where it turns back on itself no even spacing does, and dots are left out afterwards.
        if share >= _TOLERANCE or share < 0.5:
            return spaces, [PlacedDot(x, y) for x, y in inner]
        spaces = min(spaces - 1, math.floor(spaces * share) + 1)
    return spaces, []


def _at(
    places: Sequence[Point], lengths: Sequence[float], wanted: Iterable[float]
) -> Iterator[Point]:
    """Find the points that are so far along a line through places, in growing order."""
    edge, before = 0, 0.0
    for distance in wanted:
        while edge < len(lengths) - 1 and before + lengths[edge] < distance:
            before += lengths[edge]
            edge += 1
        (ax, ay), (bx, by) = places[edge], places[edge + 1]
        u = min(1.0, (distance - before) / lengths[edge])
        yield ax + u * (bx - ax), ay + u * (by - ay)


def _between(start: Point, end: Point, spaces: int) -> Iterator[PlacedDot]:
    for i in range(1, spaces):
        u = i / spaces
        yield PlacedDot(start[0] + u * (end[0] - start[0]), start[1] + u * (end[1] - start[1]))


def _spaces(length_mm: float, least_mm: float) -> int:
    return math.floor(length_mm / least_mm + 1e-9)


def _turn(before: Point, at: Point, after: Point) -> float:
    """Angle θ between two edges at their joint, 0 to π."""
    ux, uy = before[0] - at[0], before[1] - at[1]
    vx, vy = after[0] - at[0], after[1] - at[1]
    return math.atan2(abs(ux * vy - uy * vx), ux * vx + uy * vy)


def _widening(angle: float) -> float:
    """Tell how much farther apart dots are at a corner sharper than 90°: 1 / sin θ."""
    return 1.0 / max(math.sin(angle), 1e-6) if angle < math.pi / 2 else 1.0


def _apart(dots: Iterable[PlacedDot], least_mm: float) -> tuple[PlacedDot, ...]:
    """Leave out dots that are nearer than that to one that counts before them."""
    numbered = list(enumerate(dots))
    kept: list[tuple[int, PlacedDot]] = []
    near: defaultdict[tuple[int, int], list[Point]] = defaultdict(list)
    for number, dot in sorted(numbered, key=lambda item: not item[1].vertex):
        column, row = math.floor(dot.x_mm / least_mm), math.floor(dot.y_mm / least_mm)
        around = (
            place
            for i in (column - 1, column, column + 1)
            for j in (row - 1, row, row + 1)
            for place in near.get((i, j), ())
        )
        if all(math.dist(place, dot[:2]) >= least_mm * _TOLERANCE for place in around):
            kept.append((number, dot))
            near[column, row].append(dot[:2])
    return tuple(dot for _, dot in sorted(kept))
