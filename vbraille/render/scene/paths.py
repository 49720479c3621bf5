"""Parts of shapes' paths as numbers, and what each lies in: segments, corners, markers and walls.

An array is told of those segments of a filled shape that it may touch, and of those alone. Whether
a place is inside is how often a line from it to the right crosses the shape's edges, even or odd,
and so what lies to the right of all that the array reaches has to be told in another way. Of a run
of segments there it only matters at which heights it begins and ends: the rest cancels. Each of
these two heights is told by a *wall* far to the right, from there upwards. What cannot be told so,
since it is beyond the top or the bottom of all that the array reaches, is the same for all places
there; if it is odd, it is told by a wall without ends. That one alone is left where all that the
array reaches is inside, and far from the edges.

So a filled shape has as parts its segments, the wall without ends, and a wall for each corner.
`shapekernels` has the order of their numbers.
"""

from __future__ import annotations

import itertools
import math
from typing import TYPE_CHECKING

from vbraille.render.machine import shapekernels as places
from vbraille.render.scene.grid import AROUND, CAPSULE, EDGE, RING, WALL
from vbraille.scene.bounds import around, drawn_radius_mm, reach_mm
from vbraille.scene.dotting import rows_of
from vbraille.scene.joints import (
    edge_lengths_mm,
    joints,
    marker_half_angle_rad,
    places_along_mm,
    rounding_radius_mm,
)
from vbraille.scene.patterns import Circle, Dots, PathShape, Polygon, StraightLine

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from vbraille.render.scene.nodes import Enclosed
    from vbraille.scene.dotting import DotRow
    from vbraille.scene.joints import Cycle, Joint
    from vbraille.scene.measures import Point
    from vbraille.scene.patterns import Fill


AnyShape = StraightLine | Circle | Polygon | PathShape
# What has a list of parts; making it anew for each of thousands of elements takes time.
ShapeOrDots = AnyShape | Dots
_OPEN = -1e30  # stands for minus infinity
_ROUNDING_MM = 1e-6
_NO_CORNER = (_OPEN, *(0.0,) * (places.CORNER_NUMBERS - 1))
# A wall is farther to the right than any place, and the way up has no end there.
_FAR_MM = 1e9
_WALL = (0.0, -1.0, _FAR_MM, -_FAR_MM)


def differ(cycles: Sequence[Cycle]) -> bool:
    """Tell whether textures along the contours of a path have cycles of their own."""
    return any(cycle != cycles[0] for cycle in cycles[1:])


def edges_of(shape: AnyShape) -> list[list[tuple[Point, Point]]]:
    """Start and end of each segment of each contour of a shape, in the order of its parts."""
    contours, closed = _contours(shape)
    return [_pairs(points, closed) for points in contours]


def walls(shape: AnyShape, along: bool) -> Iterator[tuple[float, ...]]:
    """Numbers of the walls of a filled shape: one without ends, then one for each corner."""
    # Those of a segment that only a stroke with a texture looks at, as far as its corners.
    rest = (0.0,) * (places.CORNER - places.END_Y - 1) if along else ()
    ends = (*_NO_CORNER, *_NO_CORNER) if along else ()
    yield (_FAR_MM, _FAR_MM, *_WALL, *rest, *ends)
    for points in _contours(shape)[0]:
        for _, y in points:
            yield (_FAR_MM, y, *_WALL, *rest)


def _contours(shape: AnyShape) -> tuple[tuple[tuple[Point, ...], ...], bool]:
    """Contours of a shape, and whether they are closed; a circle has none."""
    if isinstance(shape, StraightLine):
        return ((shape.start_mm, shape.end_mm),), False
    if isinstance(shape, Polygon):
        return (shape.vertices_mm,), True
    return (shape.contours_mm, shape.closed) if isinstance(shape, PathShape) else ((), True)


def segments(
    shape: AnyShape, along: bool, *, cycles: Sequence[Cycle] = ()
) -> Iterator[tuple[float, ...]]:
    """Numbers of the segments of a shape; fewer if only the distance from it counts.

    ``cycles`` are those of the texture along each of its contours.
    """
    contours, closed = _contours(shape)
    if not along:
        for points in contours:
            yield from (_segment(*pair) for pair in _pairs(points, closed))
        return
    for number, points in enumerate(contours):
        cycle = cycles[number] if differ(cycles) else None
        yield from _segments_along(shape, points, closed, cycle)


def _segments_along(
    shape: AnyShape, points: Sequence[Point], closed: bool, cycle: Cycle | None
) -> Iterator[tuple[float, ...]]:
    pairs = _pairs(points, closed)
    straight = [_segment(*pair) for pair in pairs]
    count = len(straight)
    texture = (0.0, 0.0, 0.0)
    if cycle is not None:
        assert shape.stroke is not None
        assert shape.stroke.along is not None
        texture = (cycle.ridge, cycle.length, shape.stroke.along.velocity_mm_s)
    corners = None
    marks: list[tuple[float, ...]] = [()] * count
    middles: Sequence[float] = ()
    corner_numbers: Sequence[tuple[float, ...]] = ()
    if isinstance(shape, Polygon):
        if shape.join == "rounded":
            corners = joints(points, rounding_radius_mm(shape))
            middles = places_along_mm(shape)
        if shape.markers is not None and shape.stroke is not None:
            inner = joints(points, shape.stroke.width_mm / 2)
            size = places.MARKED_NUMBERS
            before = [size * (1 - count), *(size,) * (count - 1)]
            marks = [_mark(shape, *at) for at in zip(inner, before, strict=True)]
            # Directions at a corner are alike for every radius.
            corner_numbers = [_corner(corner, 0.0, turns=False) for corner in inner]
    begin = 0.0
    for i, segment in enumerate(straight):
        length = segment[places.LENGTH]
        first, last = closed or i > 0, closed or i < count - 1
        before, after = straight[i - 1], straight[(i + 1) % count]
        half = _half(before, segment) if first else (0.0, 0.0)
        end_half = _half(segment, after) if last else (0.0, 0.0)
        bias = 0.0 if last else _OPEN
        if corners is not None:
            here, there = corners[i], corners[(i + 1) % count]
            start = _corner(here, middles[i])
            end = _corner(there, middles[i + 1])
            own = middles[i] + here.arc_mm / 2 - here.reach_mm
        elif marks[i]:
            start, end, own = corner_numbers[i], corner_numbers[(i + 1) % count], begin
        else:
            start, end, own = _NO_CORNER, _NO_CORNER, begin
        yield (*segment, *half, *end_half, bias, own, *texture, *start, *end, *marks[i])
        begin += length


def _pairs(points: Sequence[Point], closed: bool) -> list[tuple[Point, Point]]:
    ends = [*points[1:], points[0]] if closed else points[1:]
    return list(zip(points, ends, strict=False))


def _segment(start: Point, end: Point) -> tuple[float, ...]:
    dx, dy = end[0] - start[0], end[1] - start[1]
    length = math.hypot(dx, dy)
    return (*start, dx / length, dy / length, length, end[1])


def _half(before: Sequence[float], after: Sequence[float]) -> tuple[float, float]:
    return (
        before[places.RIGHT] + after[places.RIGHT],
        before[places.DOWN] + after[places.DOWN],
    )


def _corner(corner: Joint, middle_mm: float, *, turns: bool = True) -> tuple[float, ...]:
    half = (math.pi - corner.angle_rad) / 2
    return (
        corner.reach_mm if turns else _OPEN,
        *corner.pivot_mm,
        *corner.onward,
        *corner.inward,
        corner.radius_mm,
        half,
        middle_mm,
    )


def _mark(polygon: Polygon, corner: Joint, before: int) -> tuple[float, ...]:
    """Numbers of a marker; the segment before its corner is so much before that after it."""
    assert polygon.markers is not None
    half = marker_half_angle_rad(polygon.markers, corner.angle_rad)
    pushed = polygon.markers.blend_mm * math.sin(half + corner.angle_rad / 2)
    return (*corner.pivot_mm, math.sin(half), math.cos(half), pushed, before)


def marker_reach_mm(shape: AnyShape) -> float:
    """Distance from a polygon's corners beyond which there is nothing of their markers.

    Along an edge, from a corner whose edges meet at θ, a marker of the half angle h goes on as far
    as its bound meets the stroke's outer edge, and then as far as that is pushed. A corner has no
    marker beyond the middle of its edges either, as only the nearest one is asked. The greatest of
    all corners' distances is returned; 0 without markers.
    """
    if not isinstance(shape, Polygon) or shape.markers is None or shape.stroke is None:
        return 0.0
    half_mm = shape.stroke.width_mm / 2
    corners = joints(shape.vertices_mm, half_mm)
    lengths = edge_lengths_mm(shape.vertices_mm, closed=True)
    reach = 0.0
    for n, corner in enumerate(corners):
        half = marker_half_angle_rad(shape.markers, corner.angle_rad)
        away = math.hypot(corner.reach_mm, corner.radius_mm)
        sine = max(math.sin(half + corner.angle_rad / 2), 1e-9)
        own = (math.sin(half) * away + half_mm) / sine + shape.markers.blend_mm
        # On the other side of a sharp corner's bisector it is no farther than its edges meet.
        own = max(own, half_mm / max(math.tan(corner.angle_rad / 2), 1e-9))
        reach = max(reach, min(own, max(lengths[n - 1], lengths[n]) / 2) + half_mm)
    return reach + _ROUNDING_MM


def dots_move(pattern: ShapeOrDots) -> bool:
    """Tell whether the dots of a pattern move along its path."""
    return not isinstance(pattern, Dots) and bool(pattern.dots and pattern.dots.velocity_mm_s)


def moving_dots(shape: AnyShape) -> list[tuple[float, ...]]:
    """Numbers of the dots of a shape that stay, then of the segments of its rows that move."""
    stay, rows = rows_of(shape)
    there = (0.0, -_OPEN, 0.0)  # length, pitch, motion
    found = [_row_numbers((dot[:2], (1.0, 0.0), *there), vertex=float(dot.vertex)) for dot in stay]
    for row in rows:
        if isinstance(shape, Circle):
            place = (shape.center_mm, (1.0, 0.0), 0.0, row.pitch_mm, 1.0)
            found.append(_row_numbers(place, radius=shape.radius_mm))
        else:
            found += _row_segments(row, drawn_radius_mm(shape))
    return found


def _row_segments(row: DotRow, radius_mm: float) -> Iterator[tuple[float, ...]]:
    """Numbers of the segments of a row of dots of a radius."""
    pairs = [_segment(*pair) for pair in itertools.pairwise(row.points_mm)]
    closes = math.isinf(row.begin_mm)
    whole = sum(pair[places.LENGTH] for pair in pairs)
    begin, end = max(row.begin_mm, _OPEN), min(whole - row.end_mm, -_OPEN)
    first, last = pairs[0], pairs[-1]
    along = 0.0
    for number, pair in enumerate(pairs):
        length = pair[places.LENGTH]
        is_first, is_last = number == 0, number == len(pairs) - 1
        low = _OPEN if is_first and not closes else along
        high = -_OPEN if is_last and not closes else along + length
        # A dot beyond a bend that is nearer than it reaches might be cut off, too.
        long = length >= 2 * radius_mm
        open_begin = is_first and row.begin_mm < 0 and not closes and long
        open_end = is_last and row.end_mm < 0 and not closes and long
        yield _row_numbers(
            (pair[:2], pair[2:4], length, row.pitch_mm, 1.0),
            start=along,
            owns=(low, high),
            begin=(begin, *_turned(first, pair)),
            end=(end, *_turned(last, pair)),
            open_ends=(float(open_begin), float(open_end)),
        )
        along += length


def _turned(seen: Sequence[float], segment: Sequence[float]) -> tuple[float, float]:
    """Direction of a segment as it is seen from another: along that, and across."""
    right, down = seen[places.RIGHT], seen[places.DOWN]
    along, across = segment[places.RIGHT], segment[places.DOWN]
    return along * right + across * down, along * down - across * right


def _row_numbers(
    place: tuple[Sequence[float], Sequence[float], float, float, float],
    *,
    radius: float = 0.0,
    start: float = 0.0,
    vertex: float = 0.0,
    owns: tuple[float, float] = (_OPEN, -_OPEN),
    begin: tuple[float, float, float] = (_OPEN, 0.0, 0.0),
    end: tuple[float, float, float] = (-_OPEN, 0.0, 0.0),
    open_ends: tuple[float, float] = (0.0, 0.0),
) -> tuple[float, ...]:
    """Numbers of a part of dots that may move, as `strokekernels` has them."""
    at, direction, length, pitch, moves = place
    own = (*at, *direction, length, radius, start, pitch, moves, vertex)
    return (*own, *owns, *begin, *end, *open_ends)


def enclosed_dots(pattern: ShapeOrDots) -> tuple[Enclosed, ...]:
    """Tell what each of the dots of a pattern, or of a dotted shape, lies in.

    Of a shape whose dots move these are the parts of `moving_dots`.
    """
    if isinstance(pattern, Dots):
        dots, rows, radius = pattern.centers_mm, (), pattern.dot.radius_mm
    else:
        dots, rows = rows_of(pattern)
        radius = reach_mm(pattern)
        if isinstance(pattern, Circle) and rows:
            return ((RING, *pattern.center_mm, pattern.radius_mm, 0.0, radius),)
    capsules = [(dot[:2], dot[:2]) for dot in dots]
    capsules += [pair for row in rows for pair in itertools.pairwise(row.points_mm)]
    return tuple((CAPSULE, *start, *end, radius) for start, end in capsules)


def enclosed_stroke(shape: AnyShape) -> tuple[Enclosed, ...]:
    """Tell what a circle's stroke, or each segment of another shape, lies in."""
    return _enclosed_path(shape, max(drawn_radius_mm(shape), marker_reach_mm(shape)))


def enclosed_cue(shape: AnyShape) -> tuple[Enclosed, ...]:
    """Tell what the cue over a circle, or over each segment of another shape, lies in."""
    return _enclosed_path(shape, shape.cue_width_mm / 2)


def _enclosed_path(shape: AnyShape, radius: float) -> tuple[Enclosed, ...]:
    if isinstance(shape, Circle):
        return ((RING, *shape.center_mm, shape.radius_mm, 0.0, radius),)
    return tuple(
        (CAPSULE, *start, *end, radius) for points in edges_of(shape) for start, end in points
    )


def enclosed_fill(shape: AnyShape, fill: Fill) -> tuple[Enclosed, ...]:
    """Tell what each part of a filled shape lies in, in the order in which they are said."""
    reach = drawn_radius_mm(shape)
    if not fill.blended:
        reach += fill.gap_mm + fill.fade_mm
    reach = max(reach, reach_mm(shape), marker_reach_mm(shape)) + _ROUNDING_MM
    edges: list[Enclosed] = []
    walls: list[Enclosed] = []
    places: list[Point] = []
    for contour in edges_of(shape):
        (x0, _), (x1, _) = contour[-1]
        before = x0 if x0 < x1 else x1
        for start, end in contour:
            (x0, y0), (x1, y1) = start, end
            left, right = (x0, x1) if x0 < x1 else (x1, x0)
            edges.append((EDGE, left, y0, right, y1, reach))
            less, more = (before, left) if before < left else (left, before)
            walls.append((WALL, less, y0, more, y0, reach))
            before = left
            places.append(start)
    left, top, right, bottom = around(places)
    return (*edges, (AROUND, left, top, right, bottom, reach), *walls)
