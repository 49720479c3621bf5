"""Shapes and dots as leaves of trees, which are told which of their parts may be touched.

A leaf has one list of parts. What would need two of them is several leaves: a filled shape that is
dotted, of segments and dots; and one in whose fill there are shapes again.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from vbraille.render.machine import shapekernels as places
from vbraille.render.machine import strokekernels as strokes
from vbraille.render.machine import words
from vbraille.render.scene.nodes import Node, NodeKind, Pushes, joined, say_whole
from vbraille.render.scene.pathparts import (
    AnyShape,
    ShapeOrDots,
    differ,
    enclosed_dots,
    enclosed_fill,
    enclosed_stroke,
    segments,
    walls,
)
from vbraille.scene.bounds import drawn_radius_mm, unchanged_bounds
from vbraille.scene.dotting import PlacedDot, dots_of
from vbraille.scene.joints import stroke_cycles
from vbraille.scene.patterns import Circle, Dots, Polygon, StraightLine
from vbraille.scene.traversal import each

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.render.scene.nodes import WordBlock

    Saying = Callable[[WordBlock, bool], list[int]]
    from collections.abc import Callable, Sequence

    from vbraille.scene.patterns import Fill
    from vbraille.scene.strokes import Across, DotStyle, Stroke, Vibration


def is_apart(pattern: ShapeOrDots) -> bool:
    """Tell whether a pattern is several leaves."""
    fill = fill_of(pattern)
    if fill is None or isinstance(pattern, Dots):
        return False
    return pattern.dots is not None or any(
        isinstance(part, ShapeOrDots) for part in each(fill.texture)
    )


def apart(shape: AnyShape, texture: Node | None) -> Node:
    """Tree of a shape that is several leaves, without its own changes."""
    fill = fill_of(shape)
    assert fill is not None
    assert texture is not None
    inside = _filled(shape, partial(say_fill_alone, shape, _say_one))
    filled = joined(NodeKind.MULTIPLY, (inside, texture))
    if shape.stroke is None and shape.dots is None:
        return filled
    if not fill.blended:
        return joined(NodeKind.ADD, (filled, _drawn(shape, partial(say_shape, shape, None))))
    over = _drawn(shape, partial(say_stroke_pair, shape))
    return joined(NodeKind.OVER, (filled, replace(over, pushes=Pushes.PAIR, depth=2)))


def leaf(pattern: ShapeOrDots, texture: Node | None) -> Node:
    """Leaf of a pattern with the texture of its fill, without its own changes."""
    if isinstance(pattern, Dots):
        return _drawn(pattern, partial(say_dots, pattern.dot, _placed(pattern)))
    if texture is None:
        return _drawn(pattern, partial(say_shape, pattern, None))
    say = partial(say_shape, pattern, partial(say_whole, texture))
    return _filled(pattern, say, max(texture.depth, 3))


def pair(pattern: ShapeOrDots, own: Node) -> Node:
    """Leaf that pushes a deflection, and then its mask from the same coordinates."""
    assert own.say is not None
    say = partial(_say_pair, own.say, partial(_say_mask, pattern))
    return replace(own, say=say, pushes=Pushes.PAIR, depth=own.depth + 1)


def mask(pattern: ShapeOrDots) -> Node:
    """Tree of a pattern's opacity mask."""
    if isinstance(pattern, Dots) or fill_of(pattern) is None:
        return _drawn(pattern, partial(_say_mask, pattern))
    if pattern.dots is None:
        return _filled(pattern, partial(_say_mask, pattern), 1)
    inside = _filled(pattern, partial(say_fill_mask, pattern), 1)
    return joined(NodeKind.MAXIMUM, (inside, _drawn(pattern, partial(_say_mask, pattern))))


def _drawn(pattern: ShapeOrDots, say: Saying) -> Node:
    """Leaf of dots, or of the stroke of a shape."""
    box = unchanged_bounds(pattern)
    if isinstance(pattern, Dots) or pattern.dots is not None:
        return Node(NodeKind.LEAF, say=say, box=box, enclosed=enclosed_dots(pattern), parts=True)
    parts = not isinstance(pattern, Circle)
    return Node(NodeKind.LEAF, say=say, box=box, enclosed=enclosed_stroke(pattern), parts=parts)


def _filled(shape: AnyShape, say: Saying, depth: int = 3) -> Node:
    """Leaf of the fill of a shape, as a rule with its stroke."""
    box, fill = unchanged_bounds(shape), fill_of(shape)
    assert fill is not None
    if isinstance(shape, Circle):
        return Node(NodeKind.LEAF, say=say, box=box, depth=depth)
    enclosed = enclosed_fill(shape, fill)
    return Node(NodeKind.LEAF, say=say, box=box, enclosed=enclosed, parts=True, depth=depth)


# What leaves say


def _say_pair(say, say_mask, block: WordBlock, parts: bool) -> list[int]:
    kept = say(block, parts)
    say_mask(block, parts, paired=True)
    return kept


def _say_one(block: WordBlock) -> None:
    block.say(words.LEVEL, 1.0)


def _say_mask(
    pattern: ShapeOrDots, block: WordBlock, parts: bool, paired: bool = False
) -> list[int]:
    if isinstance(pattern, AnyShape):
        return say_shape_mask(pattern, block, parts, paired)
    style, dots = pattern.dot, _placed(pattern)
    return say_dots_mask(style, dots, block, parts, style.across, paired)


def _placed(dots: Dots) -> list[PlacedDot]:
    return [PlacedDot(x, y) for x, y in dots.centers_mm]


_SHARPEST = 1e9  # 1/mm, of a fill that does not fade in
_SWINGS = {"high": strokes.HIGH, "low": strokes.LOW}


def fill_of(pattern: ShapeOrDots) -> Fill | None:
    """Fill of a shape, if it has one."""
    return None if isinstance(pattern, StraightLine | Dots) else pattern.fill


# Words


def say_shape(
    shape: AnyShape, say_fill: Callable[[WordBlock], None] | None, block: WordBlock, parts: bool
) -> list[int]:
    """Say the deflection of a shape; the coordinates of its path are left for its mask.

    Parameters
    ----------
    shape
        The shape.
    say_fill
        Says the texture of its fill; None if it has none, or that is said elsewhere.
    block
        Where to say it.
    parts
        Whether the machine is told which of its parts are in reach.

    Returns
    -------
    list of int
        Places of its parts among the block's constants, if it is told.
    """
    if shape.dots is not None:
        return say_dots(_dotting(shape), dots_of(shape), block, parts, _vertices(shape))
    if say_fill is None:
        return _say_stroke(shape, block, parts)
    return say_fill_alone(shape, say_fill, block, parts, drawn=True)


def _say_stroke(shape: AnyShape, block: WordBlock, parts: bool, filled: bool = False) -> list[int]:
    kept = _say_places(shape, block, parts, filled)
    assert shape.stroke is not None
    block.say(words.STROKE, *_stroke_numbers(shape, shape.stroke))
    return kept


def say_fill_alone(
    shape: AnyShape,
    say_fill: Callable[[WordBlock], None],
    block: WordBlock,
    parts: bool,
    drawn: bool = False,
) -> list[int]:
    """Say the fill of a shape without what it is drawn with, or with its stroke."""
    fill = fill_of(shape)
    assert fill is not None
    say_fill(block)
    stroke = shape.stroke if drawn else None
    if stroke is not None:
        kept = _say_stroke(shape, block, parts, filled=True)
    else:
        kept = _say_places(shape, block, parts, filled=True, drawn=False)
        block.say(words.ZERO)
    if not fill.blended:
        begin = drawn_radius_mm(shape) + fill.gap_mm
        slope = min(1.0 / fill.fade_mm, _SHARPEST) if fill.fade_mm else _SHARPEST
        block.say(words.FILL, begin, slope)
        return kept
    if stroke is not None:
        block.say(words.PROFILE, *_profile(stroke.width_mm, stroke.edge, None))
    else:
        block.say(words.ZERO)
    block.say(words.FILL_BLENDED)
    return kept


def say_shape_mask(
    shape: AnyShape, block: WordBlock, parts: bool, paired: bool = False
) -> list[int]:
    """Say the opacity mask of a shape, whose coordinates are there already if it is paired.

    That of a dotted shape is without its fill.
    """
    if shape.dots is not None:
        style = _dotting(shape)
        return say_dots_mask(style, dots_of(shape), block, parts, style.across, paired)
    filled = fill_of(shape) is not None
    kept = [] if paired else _say_places(shape, block, parts, filled)
    if shape.stroke is not None:
        stroke = shape.stroke
        block.say(words.PROFILE, *_profile(stroke.width_mm, stroke.edge, stroke.across))
    else:
        block.say(words.ZERO)
    if filled:
        block.say(words.FILL_MASK)
    return kept


def say_fill_mask(shape: AnyShape, block: WordBlock, parts: bool) -> list[int]:
    """Say what is inside of a shape, which is the opacity mask of its fill."""
    kept = _say_places(shape, block, parts, filled=True, drawn=False)
    block.say(words.ZERO)
    block.say(words.FILL_MASK)
    return kept


def say_stroke_pair(shape: AnyShape, block: WordBlock, parts: bool) -> list[int]:
    """Say what a filled shape is drawn with, and its profile, which blends it into the fill."""
    if shape.dots is not None:
        style, dots = _dotting(shape), dots_of(shape)
        kept = say_dots(style, dots, block, parts, _vertices(shape))
        say_dots_mask(style, dots, block, parts, None, paired=True)
        return kept
    assert shape.stroke is not None
    kept = _say_stroke(shape, block, parts)
    block.say(words.PROFILE, *_profile(shape.stroke.width_mm, shape.stroke.edge, None))
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
        if differ(cycles):  # The places along it are in ridges already.
            numbers[strokes.CYCLE], numbers[strokes.RIDGE] = 2.0, 1.0
        else:
            numbers[strokes.CYCLE], numbers[strokes.RIDGE] = cycles[0].length, cycles[0].ridge
            numbers[strokes.VELOCITY] = stroke.along.velocity_mm_s
    numbers[strokes.SWING : strokes.SWING + 3] = _swing(stroke.vibration)
    if isinstance(shape, Polygon) and shape.markers is not None:
        swing = _swing(shape.markers.swing)
        numbers[strokes.MARKS : strokes.MARKS + 3] = (1.0, *swing[1:])
    return numbers


def _dotting(shape: AnyShape) -> DotStyle:
    assert shape.dots is not None
    return shape.dots.dot


def _vertices(shape: AnyShape) -> Vibration | None:
    return None if shape.dots is None else shape.dots.vertex_vibration


# Parts


def _keep_dots(dots: Sequence[PlacedDot], block: WordBlock, parts: bool) -> list[int]:
    kept = block.keep((dot.x_mm, dot.y_mm, float(dot.vertex)) for dot in dots)
    if not parts:
        block.say_parts(kept)
    return kept


def _say_places(
    shape: AnyShape, block: WordBlock, parts: bool, filled: bool, drawn: bool = True
) -> list[int]:
    """Say the coordinates of a shape's path: those for its fill, and for its stroke if drawn.

    Its parts are its segments, and if it is filled the walls of `pathparts`.
    """
    stroke = shape.stroke if drawn else None
    along = stroke is not None and stroke.along is not None
    marked = isinstance(shape, Polygon) and shape.markers is not None and stroke is not None
    if isinstance(shape, Circle):
        block.say(words.CIRCLE, *shape.center_mm, shape.radius_mm, float(along))
        return []
    kept = block.keep(segments(shape, along or marked))
    if not parts:
        block.say_parts(kept)
    elif filled:
        kept += block.keep(walls(shape, along or marked))
    asked = places.ACROSS
    if along or marked:
        rounded = isinstance(shape, Polygon) and shape.join == "rounded"
        asked = places.ROUNDED if rounded or differ(stroke_cycles(shape)) else places.ALONG
    block.say(words.SEGMENTS, float(asked))
    if filled:
        block.say(words.INSIDE)
    if marked:
        assert isinstance(shape, Polygon)
        assert shape.markers is not None
        assert stroke is not None
        block.say(words.MARKERS, stroke.width_mm / 2, 1.0 / shape.markers.blend_mm)
    return kept
