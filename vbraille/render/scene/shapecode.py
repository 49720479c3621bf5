"""Words of shapes and dots; `shapekernels` and `strokekernels` have what they do."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from vbraille.render.machine import shapekernels as places
from vbraille.render.machine import strokekernels as strokes
from vbraille.render.machine import words
from vbraille.scene.dotting import dots_of
from vbraille.scene.fitting import stroke_cycles
from vbraille.scene.joints import (
    joints,
    marker_half_angle_rad,
    places_along_mm,
    rounding_radius_mm,
)
from vbraille.scene.patterns import Circle, PathShape, Polygon
from vbraille.scene.shapes import StraightLine

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from vbraille.render.scene.blocks import WordBlock
    from vbraille.scene.dots import Dots
    from vbraille.scene.dotting import PlacedDot
    from vbraille.scene.fitting import Cycle
    from vbraille.scene.joints import Joint
    from vbraille.scene.measures import Point
    from vbraille.scene.patterns import Fill
    from vbraille.scene.strokes import Across, DotStyle, Stroke, Vibration

AnyShape = StraightLine | Circle | Polygon | PathShape
_SHARPEST = 1e9  # 1/mm, of a fill that does not fade in
_OPEN = -1e30  # stands for minus infinity
_NO_CORNER = (_OPEN, *(0.0,) * (places.CORNER_NUMBERS - 1))
_SWINGS = {"high": strokes.HIGH, "low": strokes.LOW}


def fill_of(shape: AnyShape) -> Fill | None:
    """Fill of a shape, if it has one."""
    return None if isinstance(shape, StraightLine) else shape.fill


# Words


def say_shape(
    shape: AnyShape, block: WordBlock, say_fill: Callable[[WordBlock], None] | None, parts: bool
) -> list[int]:
    """Say the deflection of a shape; the coordinates of its path are left for its mask.

    Parameters
    ----------
    shape
        The shape.
    block
        Where to say it.
    say_fill
        Says the texture of its fill; None if it has none.
    parts
        Whether the machine is told which of its parts are in reach.

    Returns
    -------
    list of int
        Places of its parts among the block's constants, if it is told.
    """
    fill = fill_of(shape)
    if say_fill is not None:
        say_fill(block)
    if shape.stroke is None and fill is None:
        return say_dots(_dotting(shape), dots_of(shape), block, parts, _vertices(shape))
    kept = _say_places(shape, block, parts)
    if shape.stroke is not None:
        block.say(words.STROKE, *_stroke_numbers(shape, shape.stroke))
    elif shape.dots is not None:
        say_dots(_dotting(shape), dots_of(shape), block, False, _vertices(shape))
    else:
        block.say(words.ZERO)
    if fill is None:
        return kept
    if not fill.blended:
        begin = _drawn_radius(shape) + fill.gap_mm
        slope = min(1.0 / fill.fade_mm, _SHARPEST) if fill.fade_mm else _SHARPEST
        block.say(words.FILL, begin, slope)
        return kept
    if shape.stroke is not None:
        block.say(words.PROFILE, *_profile(shape.stroke.width_mm, shape.stroke.edge, None))
    elif shape.dots is not None:
        say_dots_mask(shape.dots.dot, dots_of(shape), block, False, None)
    else:
        block.say(words.ZERO)
    block.say(words.FILL_BLENDED)
    return kept


def say_shape_mask(
    shape: AnyShape, block: WordBlock, parts: bool, paired: bool = False
) -> list[int]:
    """Say the opacity mask of a shape, whose coordinates are there already if it is paired."""
    fill = fill_of(shape)
    if shape.stroke is None and fill is None:
        style = _dotting(shape)
        return say_dots_mask(style, dots_of(shape), block, parts, style.across, paired)
    kept = [] if paired else _say_places(shape, block, parts)
    if shape.stroke is not None:
        stroke = shape.stroke
        block.say(words.PROFILE, *_profile(stroke.width_mm, stroke.edge, stroke.across))
    elif shape.dots is not None:
        say_dots_mask(shape.dots.dot, dots_of(shape), block, False, shape.dots.dot.across)
    else:
        block.say(words.ZERO)
    if fill is not None:
        block.say(words.FILL_MASK)
    return kept


def say_dots(
    style: DotStyle,
    dots: Sequence[PlacedDot],
    block: WordBlock,
    parts: bool,
    vertices: Vibration | None = None,
) -> list[int]:
    """Say dots; see `say_shape`."""
    kept = _keep_dots(dots, block, parts)
    numbers = [0.0] * strokes.STROKE_NUMBERS
    numbers[: strokes.AMPLITUDE] = _dot_profile(style, style.across)
    numbers[strokes.AMPLITUDE] = style.amplitude
    numbers[strokes.SWING : strokes.SWING + 3] = _swing(style.vibration)
    numbers[strokes.MARKS : strokes.MARKS + 3] = _swing(vertices)
    block.say(words.DOTS, *numbers)
    return kept


def say_dots_mask(
    style: DotStyle,
    dots: Sequence[PlacedDot],
    block: WordBlock,
    parts: bool,
    across: Across | None,
    paired: bool = False,
) -> list[int]:
    """Say the opacity mask of dots, or without a texture across their profile.

    Paired with their deflection, it takes the parts that are in reach from there.
    """
    kept = [] if paired and parts else _keep_dots(dots, block, parts)
    block.say(words.DOTS_MASK, *_dot_profile(style, across))
    return kept


def is_own_mask(shape: AnyShape | Dots) -> bool:
    """Whether a shape's deflection is its opacity mask, too, before what all patterns share."""
    if isinstance(shape, AnyShape):
        if fill_of(shape) is not None:
            return False
        if shape.stroke is not None:
            stroke = shape.stroke
            plain = stroke.across is None and stroke.along is None and not stroke.outlined
            marked = isinstance(shape, Polygon) and shape.markers is not None
            return plain and stroke.amplitude == 1.0 and stroke.vibration is None and not marked
        style = _dotting(shape)
        if _vertices(shape) is not None:
            return False
    else:
        style = shape.dot
    return style.amplitude == 1.0 and style.across is None and style.vibration is None


# Numbers


def _profile(width: float, edge: float, across: Across | None) -> tuple[float, ...]:
    half = width / 2
    weight, cycles = (0.0, 0) if across is None else (across.amplitude, across.cycles)
    return (half - edge, 1.0 / edge, half, weight, cycles / width)


def _dot_profile(style: DotStyle, across: Across | None) -> tuple[float, ...]:
    return _profile(2 * style.radius_mm, style.edge, across)


def _swing(vibration: Vibration | None) -> tuple[float, float, float]:
    if vibration is None:
        return (strokes.NO_VIBRATION, 0.0, 0.0)
    return (_SWINGS[vibration.of], vibration.frequency_hz, vibration.amplitude)


def _stroke_numbers(shape: AnyShape, stroke: Stroke) -> list[float]:
    numbers = [0.0] * strokes.STROKE_NUMBERS
    numbers[: strokes.AMPLITUDE] = _profile(stroke.width_mm, stroke.edge, stroke.across)
    numbers[strokes.AMPLITUDE] = stroke.amplitude
    numbers[strokes.OUTLINED] = float(stroke.outlined)
    if stroke.along is not None:
        numbers[strokes.CUT] = 2.0 if stroke.along.whole_edges else 1.0
        numbers[strokes.DEPTH] = stroke.along.amplitude
        cycles = stroke_cycles(shape)
        if _differ(cycles):  # The places along it are in ridges already.
            numbers[strokes.CYCLE], numbers[strokes.RIDGE] = 2.0, 1.0
        else:
            numbers[strokes.CYCLE], numbers[strokes.RIDGE] = cycles[0].length, cycles[0].ridge
            numbers[strokes.VELOCITY] = stroke.along.velocity_mm_s
    numbers[strokes.SWING : strokes.SWING + 3] = _swing(stroke.vibration)
    if isinstance(shape, Polygon) and shape.markers is not None:
        swing = _swing(shape.markers.swing)
        numbers[strokes.MARKS : strokes.MARKS + 3] = (1.0, *swing[1:])
    return numbers


def _differ(cycles: Sequence[Cycle]) -> bool:
    return any(cycle != cycles[0] for cycle in cycles[1:])


def _dotting(shape: AnyShape) -> DotStyle:
    assert shape.dots is not None
    return shape.dots.dot


def _vertices(shape: AnyShape) -> Vibration | None:
    return None if shape.dots is None else shape.dots.vertex_vibration


def _drawn_radius(shape: AnyShape) -> float:
    if shape.stroke is not None:
        return shape.stroke.width_mm / 2
    return 0.0 if shape.dots is None else shape.dots.dot.radius_mm


# Parts


def _keep_dots(dots: Sequence[PlacedDot], block: WordBlock, parts: bool) -> list[int]:
    kept = block.keep((dot.x_mm, dot.y_mm, float(dot.vertex)) for dot in dots)
    if not parts:
        block.say_parts(kept)
    return kept


def _say_places(shape: AnyShape, block: WordBlock, parts: bool) -> list[int]:
    stroke = shape.stroke
    along = stroke is not None and stroke.along is not None
    marked = isinstance(shape, Polygon) and shape.markers is not None and stroke is not None
    if isinstance(shape, Circle):
        block.say(words.CIRCLE, *shape.center_mm, shape.radius_mm, float(along))
        return []
    kept = block.keep(_segments(shape, along or marked))
    if not parts:
        block.say_parts(kept)
    asked = places.ACROSS
    if along or marked:
        rounded = isinstance(shape, Polygon) and shape.join == "rounded"
        asked = places.ROUNDED if rounded or _differ(stroke_cycles(shape)) else places.ALONG
    block.say(words.SEGMENTS, float(asked))
    if fill_of(shape) is not None:
        block.say(words.INSIDE)
    if marked:
        assert isinstance(shape, Polygon)
        assert shape.markers is not None
        assert stroke is not None
        block.say(words.MARKERS, stroke.width_mm / 2, 1.0 / shape.markers.blend_mm)
    return kept


def edges_of(shape: AnyShape) -> Iterator[tuple[Point, Point]]:
    """Start and end of each segment of a shape, in the order of its parts."""
    contours, closed = _contours(shape)
    for points in contours:
        yield from _pairs(points, closed)


def _contours(shape: AnyShape) -> tuple[tuple[tuple[Point, ...], ...], bool]:
    """Contours of a shape, and whether they are closed; a circle has none."""
    if isinstance(shape, StraightLine):
        return ((shape.start_mm, shape.end_mm),), False
    if isinstance(shape, Polygon):
        return (shape.vertices_mm,), True
    return (shape.contours_mm, shape.closed) if isinstance(shape, PathShape) else ((), True)


def _segments(shape: AnyShape, along: bool) -> Iterator[tuple[float, ...]]:
    """Numbers of the segments of a shape; fewer if only the distance from it counts."""
    contours, closed = _contours(shape)
    if not along:
        for points in contours:
            yield from (_segment(*pair) for pair in _pairs(points, closed))
        return
    cycles = stroke_cycles(shape)
    for number, points in enumerate(contours):
        cycle = cycles[number] if _differ(cycles) else None
        yield from _segments_along(shape, points, closed, cycle)


def _segments_along(
    shape: AnyShape, points: Sequence[Point], closed: bool, cycle: Cycle | None
) -> Iterator[tuple[float, ...]]:
    pairs = _pairs(points, closed)
    segments = [_segment(*pair) for pair in pairs]
    count = len(segments)
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
            marks = [_mark(shape, corner) for corner in inner]
            # Directions at a corner are alike for every radius.
            corner_numbers = [_corner(corner, 0.0, turns=False) for corner in inner]
    begin = 0.0
    for i, segment in enumerate(segments):
        length = segment[places.LENGTH]
        first, last = closed or i > 0, closed or i < count - 1
        before, after = segments[i - 1], segments[(i + 1) % count]
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


def _mark(polygon: Polygon, corner: Joint) -> tuple[float, ...]:
    assert polygon.markers is not None
    half = marker_half_angle_rad(polygon.markers, corner.angle_rad)
    pushed = polygon.markers.blend_mm * math.sin(half + corner.angle_rad / 2)
    return (*corner.pivot_mm, math.sin(half), math.cos(half), pushed)
