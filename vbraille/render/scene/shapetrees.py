"""Shapes and dots as leaves of trees, which are told which of their parts may be touched.

A leaf has one list of parts. What would need two of them is several leaves: a filled shape that is
dotted, of segments and dots; and one in whose fill there are shapes again.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from vbraille.render.machine import words
from vbraille.render.scene import shapecode
from vbraille.render.scene.enclosures import enclosed_dots, enclosed_fill, enclosed_stroke
from vbraille.render.scene.nodes import Node, NodeKind, Pushes, joined
from vbraille.render.scene.pathparts import AnyShape, ShapeOrDots
from vbraille.render.scene.shapecode import fill_of
from vbraille.render.scene.wholes import say_whole
from vbraille.scene.bounds import unchanged_bounds
from vbraille.scene.dots import Dots
from vbraille.scene.dotting import PlacedDot
from vbraille.scene.patterns import Circle
from vbraille.scene.walking import each

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.render.scene.blocks import WordBlock

    Saying = Callable[[WordBlock, bool], list[int]]


def is_apart(pattern: ShapeOrDots) -> bool:
    """Tell whether a pattern is several leaves."""
    fill = None if isinstance(pattern, Dots) else fill_of(pattern)
    if fill is None or isinstance(pattern, Dots):
        return False
    if pattern.dots is not None:
        return True
    return any(isinstance(part, ShapeOrDots) for part in each(fill.texture))


def apart(shape: AnyShape, texture: Node | None) -> Node:
    """Tree of a shape that is several leaves, without its own changes."""
    fill = fill_of(shape)
    assert fill is not None
    assert texture is not None
    inside = _filled(shape, partial(_say_fill, shape))
    filled = joined(NodeKind.MULTIPLY, (inside, texture))
    if shape.stroke is None and shape.dots is None:
        return filled
    if not fill.blended:
        return joined(NodeKind.ADD, (filled, _drawn(shape, partial(_say_shape, shape, None))))
    over = _drawn(shape, partial(_say_stroke_pair, shape))
    return joined(NodeKind.OVER, (filled, replace(over, pushes=Pushes.PAIR, depth=2)))


def leaf(pattern: ShapeOrDots, texture: Node | None) -> Node:
    """Leaf of a pattern with the texture of its fill, without its own changes."""
    if isinstance(pattern, Dots):
        return _drawn(pattern, partial(_say_dots, pattern))
    if texture is None:
        return _drawn(pattern, partial(_say_shape, pattern, None))
    say = partial(_say_shape, pattern, partial(say_whole, texture))
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
    inside = _filled(pattern, partial(_say_fill_mask, pattern), 1)
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


def _say_shape(shape: AnyShape, say_fill, block: WordBlock, parts: bool) -> list[int]:
    return shapecode.say_shape(shape, block, say_fill, parts)


def _say_fill(shape: AnyShape, block: WordBlock, parts: bool) -> list[int]:
    return shapecode.say_fill_alone(shape, block, _say_one, parts)


def _say_one(block: WordBlock) -> None:
    block.say(words.LEVEL, 1.0)


def _say_fill_mask(shape: AnyShape, block: WordBlock, parts: bool) -> list[int]:
    return shapecode.say_fill_mask(shape, block, parts)


def _say_stroke_pair(shape: AnyShape, block: WordBlock, parts: bool) -> list[int]:
    return shapecode.say_stroke_pair(shape, block, parts)


def _say_mask(
    pattern: ShapeOrDots, block: WordBlock, parts: bool, paired: bool = False
) -> list[int]:
    if isinstance(pattern, AnyShape):
        return shapecode.say_shape_mask(pattern, block, parts, paired)
    style, dots = pattern.dot, _placed(pattern)
    return shapecode.say_dots_mask(style, dots, block, parts, style.across, paired)


def _say_dots(pattern: Dots, block: WordBlock, parts: bool) -> list[int]:
    return shapecode.say_dots(pattern.dot, _placed(pattern), block, parts)


def _placed(dots: Dots) -> list[PlacedDot]:
    return [PlacedDot(x, y) for x, y in dots.centers_mm]
