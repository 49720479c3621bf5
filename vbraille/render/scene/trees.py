"""Patterns as trees of nodes, by their deflections and opacity masks, and the words of textures."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from vbraille.render.machine import words
from vbraille.render.machine.labelplaces import TABLE
from vbraille.render.scene import shapetrees
from vbraille.render.scene.brailleplaces import box_of, pack_label
from vbraille.render.scene.nodes import Node, NodeKind, Pushes, joined, say_whole
from vbraille.render.scene.pathparts import AnyShape, ShapeOrDots
from vbraille.render.scene.shapetrees import fill_of, is_own_mask
from vbraille.scene.bitmap import WHOLE, bitmap_box, opaque
from vbraille.scene.bounds import is_everywhere
from vbraille.scene.joints import Cycle, axial_cycle
from vbraille.scene.measures import travel_deg
from vbraille.scene.patterns import Group, Image, Label, Tile
from vbraille.scene.textures import (
    AxialGrating,
    Gradual,
    LinearGrating,
    RadialGrating,
    TurnPeak,
    Uniform,
    UniformVibration,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vbraille.render.scene.assets import Assets
    from vbraille.render.scene.brailleplaces import PackedLabel
    from vbraille.render.scene.nodes import WordBlock
    from vbraille.scene.bitmap import Bitmap
    from vbraille.scene.pattern import Pattern
    from vbraille.scene.patterns import AnyPattern
    from vbraille.scene.textures import Peak


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
        if _is_plain(pattern) and is_own_mask(pattern):
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
            say=partial(_say, *_texture(pattern)),
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
    fill = fill_of(pattern)
    return None if fill is None else deflection(fill.texture, assets)


def _image(pattern: Image, assets: Assets) -> Node:
    bitmap = assets.bitmaps[pattern]
    box = bitmap_box(bitmap)
    return Node(NodeKind.LEAF, say=partial(_say_bitmap, bitmap), box=box)


# What leaves say


def _texture(pattern: AnyPattern) -> tuple[int, tuple[float, ...]]:
    """Word of a texture, and its constants.

    Raises
    ------
    TypeError
        If it is none that is rendered.
    """
    match pattern:
        case Uniform():
            return words.LEVEL, (pattern.level,)
        case UniformVibration():
            return words.VIBRATION, (pattern.frequency_hz,)
        case LinearGrating():
            return words.LINEAR, _linear(pattern)
        case RadialGrating():
            cycle = Cycle(pattern.ridge_mm, pattern.gap_mm)
            waveform = _waveform(cycle, pattern.velocity_mm_s, pattern.distortion)
            return words.RADIAL, (*pattern.center_mm, *waveform)
        case AxialGrating():
            return words.AXIAL, _axial(pattern)
    raise TypeError(f"a {type(pattern).__name__} is not rendered; resolve the scene first")


def _say(word: int, constants: tuple[float, ...], block: WordBlock, _parts: bool) -> list[int]:
    block.say(word, *constants)
    return []


ONE = Node(NodeKind.LEAF, say=partial(_say, words.LEVEL, (1.0,)), one=True)


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


def _linear(grating: LinearGrating) -> tuple[float, ...]:
    angle = math.radians(travel_deg(grating.wave_angle_deg, grating.ridge_angle_deg))
    right, down = math.cos(angle), math.sin(angle)
    x, y = grating.start_mm
    cycle = Cycle(grating.ridge_mm, grating.gap_mm)
    waveform = _waveform(cycle, grating.velocity_mm_s, grating.distortion)
    return (right, down, x * right + y * down, *waveform)


def _axial(grating: AxialGrating) -> tuple[float, ...]:
    cycle = axial_cycle(grating)
    waveform = _waveform(cycle, grating.velocity_deg_s, grating.distortion)
    factor = 1.0 if grating.distortion is None else max(1.0, grating.distortion.factor)
    inner_mm, outer_mm = grating.fade_mm
    radius = factor / math.radians(cycle.length)
    slope = 1.0 / ((outer_mm - inner_mm) * radius)
    fade = (grating.middle, inner_mm * radius, slope)
    return (*grating.center_mm, grating.start_deg, *fade, *waveform)


def _say_bitmap(bitmap: Bitmap, block: WordBlock, _parts: bool) -> list[int]:
    rows, columns = bitmap.intensities.shape
    outside = round(bitmap.outside * WHOLE)
    framed = np.pad(bitmap.intensities, 1, constant_values=outside)
    per_mm = columns / bitmap.width_mm, rows / bitmap.height_mm
    x, y = bitmap.place_mm
    # The middle of the frame's first pixel is half a pixel beyond the corner.
    first = x - 0.5 / per_mm[0], y - 0.5 / per_mm[1]
    numbers = (*first, *per_mm, columns + 2, rows + 2, 0.0)
    block.say_table(words.IMAGE, *numbers, at=6, entries=framed.ravel())
    return []


def _waveform(
    cycle: Cycle, velocity: float, distortion: Gradual | Peak | TurnPeak | None
) -> tuple[float, ...]:
    own = (cycle.length, cycle.ridge, velocity, 1.0)
    if distortion is None:
        return (*own, 0.0)
    if isinstance(distortion, Gradual):
        begin, length, is_peak = distortion.start_mm, distortion.length_mm, False
    elif isinstance(distortion, TurnPeak):
        begin, length = distortion.center_deg - distortion.length_deg, distortion.length_deg
        is_peak = True
    else:
        begin, length = distortion.center_mm - distortion.length_mm, distortion.length_mm
        is_peak = True
    return (*own, distortion.factor - 1.0, begin, length, float(is_peak))
