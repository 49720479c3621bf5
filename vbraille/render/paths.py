"""Numbers of the paths of shapes for the kernels: segments with their corners, and dots.

`vbraille.render.instructions` has the order of their numbers.
"""

from __future__ import annotations

import itertools
import math
from typing import TYPE_CHECKING

from vbraille.render.instructions import (
    ACROSS,
    CHUNK,
    CORNER_NUMBERS,
    DOWN,
    LENGTH,
    RIGHT,
    ROUNDED,
)
from vbraille.scene.bounds import around, drawn_radius_mm
from vbraille.scene.dotting import dots_of, rows_of
from vbraille.scene.joints import (
    joints,
    marker_half_angle_rad,
    places_along_mm,
    rounding_radius_mm,
    stroke_cycles,
)
from vbraille.scene.patterns import Circle, PathShape, Polygon, StraightLine

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from vbraille.scene.dotting import DotRow, PlacedDot
    from vbraille.scene.joints import Cycle, Joint
    from vbraille.scene.measures import Point

AnyShape = StraightLine | Circle | Polygon | PathShape
Numbers = tuple[float, ...]
_OPEN = -1e30  # stands for minus infinity
_NO_CORNER = (_OPEN, *(0.0,) * (CORNER_NUMBERS - 1))


def cycles_differ(shape: AnyShape) -> bool:
    """Tell whether textures along the contours of a shape have cycles of their own."""
    cycles = stroke_cycles(shape)
    return any(cycle != cycles[0] for cycle in cycles[1:])


def path_chunks(shape: AnyShape, size: int) -> list[float]:
    """Numbers of the segments of a shape, in chunks with their boxes, after the number of these.

    Parameters
    ----------
    shape
        The shape, no circle.
    size
        Numbers of each segment: `ACROSS`, `ALONG` or `ROUNDED` of the instructions.
    """
    contours, closed = shape.outline
    cycles = stroke_cycles(shape) if cycles_differ(shape) else ()
    found: list[tuple[Point, Point, Numbers]] = []
    for number, points in enumerate(contours):
        pairs = _pairs(points, closed)
        if size == ACROSS:
            segments = [_segment(*pair) for pair in pairs]
        else:
            cycle = cycles[number] if cycles else None
            segments = [one[:size] for one in _segments_along(shape, points, closed, cycle, size)]
        found += [(*pair, one) for pair, one in zip(pairs, segments, strict=True)]
    numbers: list[float] = [-(-len(found) // CHUNK)]
    for first in range(0, len(found), CHUNK):
        some = found[first : first + CHUNK]
        numbers += around(place for start, end, _ in some for place in (start, end))
        numbers.append(len(some))
        for _, _, segment in some:
            numbers += segment
    return numbers


def _pairs(points: Sequence[Point], closed: bool) -> list[tuple[Point, Point]]:
    ends = [*points[1:], points[0]] if closed else points[1:]
    return list(zip(points, ends, strict=False))


def _segment(start: Point, end: Point) -> Numbers:
    dx, dy = end[0] - start[0], end[1] - start[1]
    length = math.hypot(dx, dy)
    return (*start, dx / length, dy / length, length, end[1])


def _segments_along(
    shape: AnyShape, points: Sequence[Point], closed: bool, cycle: Cycle | None, size: int
) -> Iterator[Numbers]:
    """Numbers of segments with all that tells places along them."""
    straight = [_segment(*pair) for pair in _pairs(points, closed)]
    count = len(straight)
    texture = (0.0, 0.0, 0.0)
    if cycle is not None:
        assert shape.stroke is not None
        assert shape.stroke.along is not None
        texture = (cycle.ridge, cycle.length, shape.stroke.along.velocity_mm_s)
    corners: Sequence[Joint] = ()
    middles: Sequence[float] = ()
    if size == ROUNDED and isinstance(shape, Polygon) and shape.join == "rounded":
        corners = joints(points, rounding_radius_mm(shape))
        middles = places_along_mm(shape)
    begin = 0.0
    for i, segment in enumerate(straight):
        before, after = straight[i - 1], straight[(i + 1) % count]
        half = _half(before, segment) if closed or i > 0 else (0.0, 0.0)
        is_last = not closed and i == count - 1
        end_half = (0.0, 0.0, _OPEN) if is_last else (*_half(segment, after), 0.0)
        start, end, own = _NO_CORNER, _NO_CORNER, begin
        if corners:
            here, there = corners[i], corners[(i + 1) % count]
            start, end = _corner(here, middles[i]), _corner(there, middles[i + 1])
            own = middles[i] + here.arc_mm / 2 - here.reach_mm
        yield (*segment, *half, *end_half, own, float(i), *texture, *start, *end)
        begin += segment[LENGTH]


def _half(before: Numbers, after: Numbers) -> tuple[float, float]:
    return before[RIGHT] + after[RIGHT], before[DOWN] + after[DOWN]


def _corner(corner: Joint, middle_mm: float) -> Numbers:
    half = (math.pi - corner.angle_rad) / 2
    directions = (*corner.pivot_mm, *corner.onward, *corner.inward)
    return (corner.reach_mm, *directions, corner.radius_mm, half, middle_mm)


def marker_numbers(polygon: Polygon) -> list[float]:
    """Numbers of the markers at a polygon's corners, after the number of these."""
    assert polygon.markers is not None
    assert polygon.stroke is not None
    numbers: list[float] = [len(polygon.vertices_mm)]
    for corner in joints(polygon.vertices_mm, polygon.stroke.width_mm / 2):
        half = marker_half_angle_rad(polygon.markers, corner.angle_rad)
        pushed = polygon.markers.blend_mm * math.sin(half + corner.angle_rad / 2)
        numbers += (*corner.vertex_mm, *corner.pivot_mm, *corner.onward, *corner.inward)
        numbers += (math.sin(half), math.cos(half), pushed)
    return numbers


def dot_chunks(dots: Sequence[PlacedDot]) -> list[float]:
    """Numbers of dots that stay, in chunks with their boxes, after the number of these."""
    numbers: list[float] = [-(-len(dots) // CHUNK)]
    for first in range(0, len(dots), CHUNK):
        some = dots[first : first + CHUNK]
        numbers += around((dot.x_mm, dot.y_mm) for dot in some)
        numbers.append(len(some))
        for dot in some:
            numbers += (dot.x_mm, dot.y_mm, float(dot.vertex))
    return numbers


def dotted_numbers(shape: AnyShape) -> list[float]:
    """Numbers of the dots along a shape, after the number of chunks or of rows."""
    assert shape.dots is not None
    if not shape.dots.velocity_mm_s:
        return dot_chunks(dots_of(shape))
    stay, rows = rows_of(shape)
    there = (0.0, -_OPEN, 0.0)  # length, pitch, motion
    found = [_row_numbers((dot[:2], (1.0, 0.0), *there), vertex=float(dot.vertex)) for dot in stay]
    for row in rows:
        if isinstance(shape, Circle):
            place = (shape.center_mm, (1.0, 0.0), 0.0, row.pitch_mm, 1.0)
            found.append(_row_numbers(place, radius=shape.radius_mm))
        else:
            found += _row_segments(row, drawn_radius_mm(shape))
    return [len(found), *itertools.chain.from_iterable(found)]


def _row_segments(row: DotRow, radius_mm: float) -> Iterator[Numbers]:
    """Numbers of the segments of a row of dots of a radius."""
    pairs = [_segment(*pair) for pair in itertools.pairwise(row.points_mm)]
    closes = math.isinf(row.begin_mm)
    whole = sum(pair[LENGTH] for pair in pairs)
    begin, end = max(row.begin_mm, _OPEN), min(whole - row.end_mm, -_OPEN)
    along = 0.0
    for number, pair in enumerate(pairs):
        length = pair[LENGTH]
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
            begin=(begin, *_turned(pairs[0], pair)),
            end=(end, *_turned(pairs[-1], pair)),
            open_ends=(float(open_begin), float(open_end)),
        )
        along += length


def _turned(seen: Numbers, segment: Numbers) -> tuple[float, float]:
    """Direction of a segment as it is seen from another: along that, and across."""
    right, down = seen[RIGHT], seen[DOWN]
    along, across = segment[RIGHT], segment[DOWN]
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
) -> Numbers:
    """Numbers of dots that may move."""
    at, direction, length, pitch, moves = place
    own = (*at, *direction, length, radius, start, pitch, moves, vertex)
    return (*own, *owns, *begin, *end, *open_ends)
