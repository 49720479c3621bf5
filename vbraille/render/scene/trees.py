"""Patterns as trees of nodes: what must be computed for their deflections and opacity masks."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from vbraille.render.machine import words
from vbraille.render.machine.labelplaces import TABLE
from vbraille.render.scene import shapecode, shapetrees, texturecode
from vbraille.render.scene.brailleplaces import box_of, pack_label
from vbraille.render.scene.nodes import Node, NodeKind, Pushes, joined
from vbraille.render.scene.pathparts import AnyShape, ShapeOrDots
from vbraille.render.scene.shapecode import fill_of
from vbraille.render.scene.wholes import say_whole
from vbraille.scene.bounds import is_everywhere
from vbraille.scene.dots import Dots
from vbraille.scene.labels import Label
from vbraille.scene.opaque import bitmap_box, opaque
from vbraille.scene.patterns import Group, Image, Tile
from vbraille.scene.textures import (
    AxialGrating,
    LinearGrating,
    RadialGrating,
    Uniform,
    UniformVibration,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

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


def deflection(pattern: AnyPattern, assets: Assets) -> Node:
    """Tree of a pattern's deflection."""
    if isinstance(pattern, Group):
        return _changed(pattern, group(pattern, assets))
    if isinstance(pattern, Image) and pattern.texture is not None:
        parts = (_image(pattern, assets), deflection(pattern.texture, assets))
        return _changed(pattern, joined(NodeKind.MULTIPLY, parts))
    if isinstance(pattern, AnyShape) and shapetrees.is_apart(pattern):
        return _changed(pattern, shapetrees.apart(pattern, _fill_texture(pattern, assets)))
    if isinstance(pattern, ShapeOrDots) and is_everywhere(pattern):
        # Where there is nothing of it, it is something now, and still few of its parts are asked.
        return _changed(pattern, shapetrees.leaf(pattern, _fill_texture(pattern, assets)))
    return _leaf(pattern, assets)


def layer(pattern: AnyPattern, assets: Assets) -> Node:
    """Tree of a pattern as a layer over others: its deflection and what it hides."""
    if is_everywhere(pattern):
        return replace(deflection(pattern, assets), pushes=Pushes.COVER)
    if isinstance(pattern, ShapeOrDots) and not shapetrees.is_apart(pattern):
        own = _leaf(pattern, assets)
        if _is_plain(pattern) and shapecode.is_own_mask(pattern):
            return own
        return shapetrees.pair(pattern, own)
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
            hiding = opaque(bitmap)
            return Node(NodeKind.LEAF, say=partial(_say_bitmap, hiding), box=bitmap_box(bitmap))
        case Label():
            written = assets.written[pattern]
            packed = pack_label(pattern, written)
            say, box = partial(_say_label, words.LABEL_MASK, packed), box_of(pattern, written)
            return Node(NodeKind.LEAF, say=say, box=box)
        case Group():
            return _group_mask(pattern, assets)
        case _ if isinstance(pattern, ShapeOrDots):
            return shapetrees.mask(pattern)
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
    if isinstance(pattern, ShapeOrDots):
        own = shapetrees.leaf(pattern, _fill_texture(pattern, assets))
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
        return replace(own, say=say, box=None)
    return replace(own, say=say)


def _fill_texture(pattern: ShapeOrDots, assets: Assets) -> Node | None:
    fill = None if isinstance(pattern, Dots) else fill_of(pattern)
    return None if fill is None else deflection(fill.texture, assets)


def _image(pattern: Image, assets: Assets) -> Node:
    bitmap = assets.bitmaps[pattern]
    box = bitmap_box(bitmap)
    return Node(NodeKind.LEAF, say=partial(_say_bitmap, bitmap), box=box)


# What leaves say


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
