"""Numbers of the paths of shapes for the kernels: segments with their corners, and rows of dots.

`vbraille.render.patternkernels` has the order of their numbers.
"""

from __future__ import annotations

import itertools
import math
from typing import TYPE_CHECKING

from vbraille.scene.geometry import (
    drawn_radius_mm,
    joints,
    marker_half_angle_rad,
    places_along_mm,
    rounding_radius_mm,
    rows_of,
    stroke_cycles,
)
from vbraille.scene.patterns import Circle, PathShape, Polygon, StraightLine

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.scene.geometry import DotRow, Joint
    from vbraille.scene.measures import Point

AnyShape = StraightLine | Circle | Polygon | PathShape
Numbers = tuple[float, ...]
_FAR = 1e30  # stands for infinity


def segments_of(shape: StraightLine | Polygon | PathShape, *, rounded: bool) -> Iterator[Numbers]:
    """Numbers of the segments of a shape, with those of their corners if these are rounded."""
    contours, closed = shape.outline
    cycles = stroke_cycles(shape)
    corners: list[tuple[Numbers, float]] = []
    if rounded and isinstance(shape, Polygon):
        middles = places_along_mm(shape)
        found = joints(shape.vertices_mm, rounding_radius_mm(shape))
        for corner, middle_mm in zip((*found, found[0]), middles, strict=True):
            begin_mm = middle_mm + corner.arc_mm / 2 - corner.reach_mm
            corners.append((_corner(corner, middle_mm), begin_mm))
    for number, points in enumerate(contours):
        texture = (cycles[number].ridge, cycles[number].length) if cycles else (0.0, 0.0)
        straight = list(itertools.starmap(_straight, itertools.pairwise(points)))
        if closed:
            straight.append(_straight(points[-1], points[0]))
        count = len(straight)
        begin_mm = 0.0
        for i, segment in enumerate(straight):
            half, end_half = (0.0, 0.0), (0.0, 0.0, -_FAR)
            if i > 0 or closed:
                half = _half(straight[i - 1], segment)
            if i < count - 1 or closed:
                end_half = (*_half(segment, straight[(i + 1) % count]), 0.0)
            own_mm, ends = begin_mm, ()
            if corners:
                (start, own_mm), (end, _) = corners[i : i + 2]
                ends = (*start, *end)
            yield (*segment, *half, *end_half, own_mm, float(i), *texture, *ends)
            begin_mm += segment[4]


def _straight(start: Point, end: Point) -> Numbers:
    """Start, direction and length of a segment, and y of its end."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    length = math.hypot(dx, dy)
    return (*start, dx / length, dy / length, length, end[1])


def _half(before: Numbers, after: Numbers) -> tuple[float, float]:
    return before[2] + after[2], before[3] + after[3]


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


def moving_rows(shape: AnyShape) -> Iterator[Numbers]:
    """Numbers of the rows of dots that move along a shape, one of each segment that they are on."""
    for row in rows_of(shape)[1]:
        if isinstance(shape, Circle):
            place = (*shape.center_mm, 0.0, 0.0, 0.0, shape.radius_mm, 0.0, row.pitch_mm)
            yield (*place, *(0.0,) * 10)
        else:
            yield from _row_segments(row, drawn_radius_mm(shape))


def _row_segments(row: DotRow, radius_mm: float) -> Iterator[Numbers]:
    """Numbers of the segments of a row of dots of a radius."""
    segments = list(itertools.starmap(_straight, itertools.pairwise(row.points_mm)))
    first, last = segments[0], segments[-1]
    closes = math.isinf(row.begin_mm)
    begin_mm = max(row.begin_mm, -_FAR)
    end_mm = min(sum(segment[4] for segment in segments) - row.end_mm, _FAR)
    at_mm = 0.0
    for segment in segments:
        length_mm = segment[4]
        place = (*segment[:5], 0.0, at_mm, row.pitch_mm)
        opens, ends = segment is first and not closes, segment is last and not closes
        owns = (-_FAR if opens else at_mm, _FAR if ends else at_mm + length_mm)
        begin = (begin_mm, _along(first, segment), _across(first, segment))
        end = (end_mm, _along(last, segment), _across(last, segment))
        # A dot beyond a bend that is nearer than it reaches might be cut off, too.
        is_long = length_mm >= 2 * radius_mm
        cut = opens and row.begin_mm < 0 and is_long, ends and row.end_mm < 0 and is_long
        yield (*place, *owns, *begin, *end, *cut)
        at_mm += length_mm


def _along(seen: Numbers, segment: Numbers) -> float:
    """Share of a segment along another one's direction, and below across it."""
    return segment[2] * seen[2] + segment[3] * seen[3]


def _across(seen: Numbers, segment: Numbers) -> float:
    return segment[2] * seen[3] - segment[3] * seen[2]
