"""Patterns as trees of nodes: what must be computed for their deflections and opacity masks."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from vbraille.render.machine import words
from vbraille.render.machine.labelplaces import TABLE
from vbraille.render.scene import shapecode, texturecode
from vbraille.render.scene.brailleplaces import box_of, pack_label
from vbraille.render.scene.nodes import Enclosed, LeafReach, Node, NodeKind, Pushes, joined
from vbraille.render.scene.shapecode import AnyShape, fill_of
from vbraille.scene.bounds import bounds, drawn_radius_mm, is_everywhere
from vbraille.scene.dots import Dots
from vbraille.scene.dotting import PlacedDot, dots_of
from vbraille.scene.labels import Label
from vbraille.scene.opaque import bitmap_box, opaque
from vbraille.scene.patterns import Circle, Group, Image, Polygon, Tile
from vbraille.scene.textures import (
    AxialGrating,
    LinearGrating,
    RadialGrating,
    Uniform,
    UniformVibration,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from vbraille.render.scene.assets import Assets
    from vbraille.render.scene.blocks import WordBlock
    from vbraille.render.scene.brailleplaces import PackedLabel
    from vbraille.scene.bitmap import Bitmap
    from vbraille.scene.pattern import Pattern
    from vbraille.scene.patterns import AnyPattern

_KINDS = {
    "multiply": NodeKind.MULTIPLY,
    "add": NodeKind.ADD,
    "weighted": NodeKind.ADD,
    "maximum": NodeKind.MAXIMUM,
    "blend": NodeKind.BLEND,
    "overwrite": NodeKind.OVER,
}


_CORNERS = 4  # of a rectangle
_JOINS = {
    NodeKind.ADD: words.ADD,
    NodeKind.MAXIMUM: words.MAXIMUM,
    NodeKind.MULTIPLY: words.MULTIPLY,
}


def deflection(pattern: AnyPattern, assets: Assets) -> Node:
    """Tree of a pattern's deflection."""
    if isinstance(pattern, Group):
        return _changed(pattern, group(pattern, assets))
    if isinstance(pattern, Image) and pattern.texture is not None:
        parts = (_image(pattern, assets), deflection(pattern.texture, assets))
        return _changed(pattern, joined(NodeKind.MULTIPLY, parts))
    return _leaf(pattern, assets)


def layer(pattern: AnyPattern, assets: Assets) -> Node:
    """Tree of a pattern as a layer over others: its deflection and what it hides."""
    if is_everywhere(pattern):
        return replace(deflection(pattern, assets), pushes=Pushes.COVER)
    if isinstance(pattern, AnyShape | Dots):
        own = _leaf(pattern, assets)
        if _is_plain(pattern) and shapecode.is_own_mask(pattern):
            return own
        return _pair(pattern, own)
    covered = mask(pattern, assets)
    own = deflection(pattern, assets)
    if covered is None:
        return replace(own, pushes=Pushes.COVER)
    depth = max(own.depth, 1 + covered.depth)
    return Node(NodeKind.LAYER, (own, covered), pushes=Pushes.PAIR, depth=depth)


def mask(pattern: AnyPattern, assets: Assets) -> Node | None:
    """Tree of a pattern's opacity mask; None if it is 1 everywhere. Lévesque 2009, 8.4.5."""
    if is_everywhere(pattern):
        return None
    match pattern:
        case Image():
            bitmap = assets.bitmaps[pattern]
            say = partial(_say_bitmap, opaque(bitmap))
            return Node(NodeKind.LEAF, say=say, box=bitmap_box(bitmap))
        case Label():
            written = assets.written[pattern]
            packed = pack_label(pattern, written)
            say = partial(_say_label, words.LABEL_MASK, packed)
            return Node(NodeKind.LEAF, say=say, box=box_of(pattern, written))
        case Dots():
            return _parted(pattern, partial(_say_dots_mask, pattern))
        case Group():
            return _group_mask(pattern, assets)
        case _ if isinstance(pattern, AnyShape):
            return _parted(pattern, partial(_say_shape_mask, pattern))
    return None


def group(pattern: Group, assets: Assets) -> Node:
    """Tree of a group, without its own changes."""
    if pattern.operation == "overwrite":
        children = tuple(layer(part, assets) for part in pattern.parts)
        return joined(NodeKind.OVER, children)
    children = tuple(deflection(part, assets) for part in pattern.parts)
    if pattern.weights is not None:
        pairs = zip(children, pattern.weights, strict=True)
        children = tuple(_change(child, ((words.SCALE, (weight,)),)) for child, weight in pairs)
    if pattern.by is not None:
        return _blend(children, deflection(pattern.by, assets))
    return joined(_KINDS[pattern.operation], children)


def _group_mask(pattern: Group, assets: Assets) -> Node | None:
    """Mask of a group: by its own operation, but that of layers is 1 - Π(1 - μ)."""
    masks = [mask(part, assets) for part in pattern.parts]
    known = tuple(part for part in masks if part is not None)
    if pattern.operation == "multiply":
        return joined(NodeKind.MULTIPLY, known) if known else None
    if pattern.by is not None:
        if not known:
            return None
        first, second = (ONE if part is None else part for part in masks)
        return _blend((first, second), deflection(pattern.by, assets))
    if len(known) < len(masks):
        return None
    return joined(_KINDS[pattern.operation], known)


def _blend(parts: Sequence[Node], by: Node) -> Node:
    first, second = parts
    depth = max(first.depth, 1 + second.depth, 2 + by.depth)
    return Node(NodeKind.BLEND, (first, second, by), depth=depth)


def _changed(pattern: Pattern, own: Node) -> Node:
    changes = _changes(pattern)
    return _change(own, changes, is_everywhere(pattern)) if changes else own


def _change(own: Node, changes: tuple, everywhere: bool = False) -> Node:
    return Node(NodeKind.CHANGE, (own,), changes=changes, everywhere=everywhere, depth=own.depth)


def _changes(pattern: Pattern) -> tuple[tuple[int, tuple[float, ...]], ...]:
    """Words of what any pattern may have: amplitude, then inversion, then vibration."""
    changes: list[tuple[int, tuple[float, ...]]] = []
    if pattern.amplitude != 1.0:
        changes.append((words.SCALE, (pattern.amplitude,)))
    if pattern.inverted:
        changes.append((words.INVERT, ()))
    swing = pattern.vibration
    if swing is not None:
        word = words.VIBRATE_HIGH if swing.of == "high" else words.VIBRATE_LOW
        changes.append((word, (swing.frequency_hz, swing.amplitude)))
    return tuple(changes)


def _is_plain(pattern: Pattern) -> bool:
    return pattern.amplitude == 1.0 and not pattern.inverted and pattern.vibration is None


# Leaves


def _leaf(pattern: AnyPattern, assets: Assets) -> Node:
    """Leaf with a pattern's own changes among its words."""
    changes = _changes(pattern)
    if isinstance(pattern, AnyShape | Dots):
        own = _shape(pattern, assets)
    elif isinstance(pattern, Image):
        own = _image(pattern, assets)
    elif isinstance(pattern, Label):
        written = assets.written[pattern]
        say = partial(_say_label, words.LABEL, pack_label(pattern, written))
        own = Node(NodeKind.LEAF, say=say, box=box_of(pattern, written))
    elif isinstance(pattern, Tile):
        part = deflection(pattern.part, assets)
        own = Node(NodeKind.LEAF, say=partial(_say_tile, pattern, part), depth=2 + part.depth)
    else:
        own = Node(
            NodeKind.LEAF,
            say=partial(_say_texture, pattern),
            one=isinstance(pattern, Uniform) and pattern.level == 1.0 and not changes,
        )
    if not changes:
        return own
    assert own.say is not None
    say = partial(_say_changed, own.say, changes)
    if is_everywhere(pattern):
        # Where there is nothing of it, it is something now, and so all of its parts are asked.
        return replace(own, say=say, box=None, enclosed=(), parts=False)
    return replace(own, say=say)


def _shape(pattern: AnyShape | Dots, assets: Assets) -> Node:
    if isinstance(pattern, Dots):
        return _parted(pattern, partial(_say_dots, pattern))
    fill = fill_of(pattern)
    if fill is None:
        return _parted(pattern, partial(_say_shape, pattern, None))
    texture = deflection(fill.texture, assets)
    say = partial(_say_shape, pattern, partial(say_whole, texture))
    return _parted(pattern, say, max(texture.depth, 3))


def _pair(pattern: AnyShape | Dots, own: Node) -> Node:
    """Leaf that pushes a deflection, and then its mask from the same coordinates."""
    assert own.say is not None
    say_mask = _say_dots_mask if isinstance(pattern, Dots) else _say_shape_mask
    say = partial(_say_pair, own.say, partial(say_mask, pattern))
    return replace(own, say=say, pushes=Pushes.PAIR, depth=own.depth + 1, inside=_inside(pattern))


def _inside(pattern: AnyShape | Dots) -> Enclosed | None:
    """Where a filled shape is opaque, if it is a circle or an upright rectangle."""
    if isinstance(pattern, Dots) or fill_of(pattern) is None:
        return None
    if isinstance(pattern, Circle):
        return Enclosed(LeafReach.DISC_INSIDE, (*pattern.center_mm, pattern.radius_mm, 0.0))
    if not isinstance(pattern, Polygon) or len(pattern.vertices_mm) != _CORNERS:
        return None
    (x0, y0), (x1, y1), (x2, y2), (x3, y3) = pattern.vertices_mm
    lying, standing = (y0, x1, y2, x3) == (y1, x2, y3, x0), (x0, y1, x2, y3) == (x1, y2, x3, y0)
    if not (lying or standing):
        return None
    box = (min(x0, x2), min(y0, y2), max(x0, x2), max(y0, y2))
    return Enclosed(LeafReach.BOX_INSIDE, box)


def _parted(
    pattern: AnyShape | Dots, say: Callable[[WordBlock, bool], list[int]], depth: int = 1
) -> Node:
    """Leaf of a shape or of dots, with what they lie in."""
    box = bounds(pattern)
    marked = isinstance(pattern, Polygon) and pattern.markers is not None
    filled = not isinstance(pattern, Dots) and fill_of(pattern) is not None
    if box is None or marked or filled:
        return Node(NodeKind.LEAF, say=say, box=box, depth=depth)
    enclosed = tuple(_enclosed(pattern))
    parts = not isinstance(pattern, Circle) or pattern.dots is not None
    return Node(NodeKind.LEAF, say=say, box=box, enclosed=enclosed, parts=parts, depth=depth)


def _enclosed(pattern: AnyShape | Dots) -> Iterable[Enclosed]:
    """What each of the parts lies in, in their order."""
    if isinstance(pattern, Dots):
        radius = pattern.dot.radius_mm
        return (Enclosed(LeafReach.CAPSULE, (x, y, x, y), radius) for x, y in pattern.centers_mm)
    radius = drawn_radius_mm(pattern)
    if pattern.dots is not None:
        places = dots_of(pattern)
        dots = ((dot.x_mm, dot.y_mm) for dot in places)
        return (Enclosed(LeafReach.CAPSULE, (x, y, x, y), radius) for x, y in dots)
    if isinstance(pattern, Circle):
        ring = (*pattern.center_mm, pattern.radius_mm, 0.0)
        return (Enclosed(LeafReach.RING, ring, radius),)
    return (
        Enclosed(LeafReach.CAPSULE, (*start, *end), radius)
        for start, end in shapecode.edges_of(pattern)
    )


def _image(pattern: Image, assets: Assets) -> Node:
    bitmap = assets.bitmaps[pattern]
    box = bitmap_box(bitmap)
    return Node(NodeKind.LEAF, say=partial(_say_bitmap, bitmap), box=box)


# What leaves say


def say_whole(node: Node, block: WordBlock) -> None:
    """Say all of a tree in one block, wherever its parts are."""
    if node.kind is NodeKind.LEAF:
        assert node.say is not None
        node.say(block, False)
        return
    children = node.children
    if node.kind is NodeKind.OVER:
        lowest = max((n for n, c in enumerate(children) if c.pushes is Pushes.COVER), default=0)
        children = children[lowest:]
    for number, child in enumerate(children):
        say_whole(child, block)
        if node.kind in _JOINS and number:
            block.say(_JOINS[node.kind])
        elif node.kind is NodeKind.OVER:
            pair = child.pushes is Pushes.PAIR
            if number:
                block.say(words.OVER if pair else words.OVER_ITSELF)
            elif pair:
                # The lowest layer hides nothing.
                block.say(words.DROP)
    if node.kind is NodeKind.BLEND:
        block.say(words.BLEND)
    for operation, constants in node.changes:
        block.say(operation, *constants)


def _say_texture(pattern: AnyPattern, block: WordBlock, _parts: bool) -> list[int]:
    match pattern:
        case Uniform():
            block.say(words.LEVEL, pattern.level)
        case UniformVibration():
            block.say(words.VIBRATION, pattern.frequency_hz)
        case LinearGrating():
            texturecode.say_linear(pattern, block)
        case RadialGrating():
            texturecode.say_radial(pattern, block)
        case AxialGrating():
            texturecode.say_axial(pattern, block)
        case _:
            raise TypeError(f"a {type(pattern).__name__} is not rendered; resolve the scene first")
    return []


def _say_one(block: WordBlock, _parts: bool) -> list[int]:
    block.say(words.LEVEL, 1.0)
    return []


ONE = Node(NodeKind.LEAF, say=_say_one, one=True)


def _say_bitmap(bitmap: Bitmap, block: WordBlock, _parts: bool) -> list[int]:
    texturecode.say_bitmap(bitmap, block)
    return []


def _say_label(word: int, packed: PackedLabel, block: WordBlock, _parts: bool) -> list[int]:
    block.say_table(word, *packed.numbers.tolist(), at=TABLE, entries=packed.table)
    return []


def _say_tile(tile: Tile, part: Node, block: WordBlock, _parts: bool) -> list[int]:
    block.say(words.WRAP, *tile.origin_mm, tile.width_mm, tile.height_mm)
    say_whole(part, block)
    block.say(words.UNWRAP)
    return []


def _say_changed(say, changes, block: WordBlock, parts: bool) -> list[int]:
    kept = say(block, parts)
    for operation, constants in changes:
        block.say(operation, *constants)
    return kept


def _say_pair(say, say_mask, block: WordBlock, parts: bool) -> list[int]:
    kept = say(block, parts)
    say_mask(block, parts, paired=True)
    return kept


def _say_shape(pattern: AnyShape, say_fill, block: WordBlock, parts: bool) -> list[int]:
    return shapecode.say_shape(pattern, block, say_fill, parts)


def _say_shape_mask(
    pattern: AnyShape, block: WordBlock, parts: bool, paired: bool = False
) -> list[int]:
    return shapecode.say_shape_mask(pattern, block, parts, paired)


def _say_dots(pattern: Dots, block: WordBlock, parts: bool) -> list[int]:
    return shapecode.say_dots(pattern.dot, _placed(pattern), block, parts)


def _say_dots_mask(pattern: Dots, block: WordBlock, parts: bool, paired: bool = False) -> list[int]:
    style, dots = pattern.dot, _placed(pattern)
    return shapecode.say_dots_mask(style, dots, block, parts, style.across, paired)


def _placed(dots: Dots) -> list[PlacedDot]:
    return [PlacedDot(x, y) for x, y in dots.centers_mm]
