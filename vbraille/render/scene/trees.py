"""Patterns as trees of nodes, by their deflections and opacity masks, and the words of leaves.

A leaf has one list of parts, and is told which of them may be touched. Shapes that would need two
are several leaves: a filled shape that is dotted, of segments and dots; and one in whose fill there
are shapes again.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, cast

import msgspec
import numpy as np

from vbraille.render.machine import shapekernels as places
from vbraille.render.machine import strokekernels as strokes
from vbraille.render.machine import words
from vbraille.render.machine.braillekernel import TABLE
from vbraille.render.scene.labels import box_of, pack_label
from vbraille.render.scene.nodes import Node, NodeKind, Pushes, joined, say_whole
from vbraille.render.scene.paths import (
    AnyShape,
    ShapeOrDots,
    differ,
    dots_move,
    enclosed_cue,
    enclosed_dots,
    enclosed_fill,
    enclosed_stroke,
    moving_dots,
    segments,
    walls,
)
from vbraille.render.work import MOST_SIGNALS
from vbraille.scene.bitmap import WHOLE, bitmap_box, opaque
from vbraille.scene.bounds import drawn_radius_mm, is_everywhere, unchanged_bounds
from vbraille.scene.dotting import PlacedDot, dots_of
from vbraille.scene.joints import Cycle, axial_cycle, cue_cycle, stroke_cycles
from vbraille.scene.measures import travel_deg
from vbraille.scene.patterns import (
    Circle,
    Dots,
    Group,
    Image,
    Label,
    Moving,
    PathShape,
    Polygon,
    StraightLine,
    Tile,
)
from vbraille.scene.textures import (
    AxialGrating,
    Gradual,
    LinearGrating,
    RadialGrating,
    SignalLevel,
    TurnPeak,
    Uniform,
    UniformVibration,
)
from vbraille.scene.traversal import each, signals_of, with_name

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from vbraille.render.scene.labels import Assets, PackedLabel
    from vbraille.render.scene.nodes import WordBlock
    from vbraille.scene.bitmap import Bitmap
    from vbraille.scene.pattern import Pattern
    from vbraille.scene.patterns import AnyPattern, Fill
    from vbraille.scene.strokes import Across, DotStyle, MovingCue, Stroke, Vibration

    Saying = Callable[[WordBlock, bool], list[int]]
    Changes = tuple[tuple[int, tuple[float, ...]], ...]

_NO_PLACE = 1e30
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
        own = group(pattern, assets)
    elif isinstance(pattern, Image) and pattern.texture is not None:
        parts = (_image(pattern, assets), deflection(pattern.texture, assets))
        own = joined(NodeKind.MULTIPLY, parts)
    elif isinstance(pattern, AnyShape) and is_apart(pattern):
        own = shape_apart(pattern, _fill_texture(pattern, assets), assets)
    elif isinstance(pattern, ShapeOrDots) and is_everywhere(pattern):
        # Where there is nothing of it, it is something now, and still few of its parts are asked.
        own = shape_leaf(pattern, _fill_texture(pattern, assets), assets)
    else:
        return _leaf(pattern, assets)
    changes = _changes(pattern, assets)
    if changes:
        own = _change(own, changes, is_everywhere(pattern))
    return replace(own, gate=own.gate | _gate(pattern, assets))


def layer(pattern: AnyPattern, assets: Assets) -> Node:
    """Tree of a pattern as a layer over others: its deflection and what it hides."""
    if is_everywhere(pattern) and not pattern.factor:
        return replace(deflection(pattern, assets), pushes=Pushes.COVER)
    is_everything = is_everywhere(pattern)
    if isinstance(pattern, ShapeOrDots) and not is_everything and not is_apart(pattern):
        own = _leaf(pattern, assets)
        if _is_plain(pattern) and is_own_mask(pattern):
            return own
        return shape_pair(_with_clock(pattern, assets), own, _by_signal(pattern, assets))
    covered = mask(pattern, assets)
    own = deflection(pattern, assets)
    if covered is None:
        return replace(own, pushes=Pushes.COVER)
    depth = max(own.depth, 1 + covered.depth)
    return Node(NodeKind.LAYER, (own, covered), pushes=Pushes.PAIR, depth=depth)


def mask(pattern: AnyPattern, assets: Assets) -> Node | None:
    """Tree of a pattern's opacity mask; None if it is 1 everywhere. Lévesque 2009, 8.4.5."""
    own, changes = _mask(pattern, assets), _by_signal(pattern, assets)
    if not changes:
        return own
    return replace(_change(ONE if own is None else own, changes), gate=_gate(pattern, assets))


def _mask(pattern: AnyPattern, assets: Assets) -> Node | None:
    """Tree of a pattern's opacity mask without its factor."""
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
            return shape_mask(_with_clock(pattern, assets))
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
        return _blend(_choosable(children, pattern.by, assets), deflection(pattern.by, assets))
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
        parts = _choosable((first, second), pattern.by, assets)
        return _blend(parts, deflection(pattern.by, assets))
    if len(known) < len(masks):
        return None
    return joined(_KINDS[pattern.operation], known)


def _blend(parts: Sequence[Node], by: Node) -> Node:
    first, second = parts
    depth = max(first.depth, 1 + second.depth, 2 + by.depth)
    return Node(NodeKind.BLEND, (first, second, by), depth=depth)


def _choosable(parts: Sequence[Node], by: AnyPattern, assets: Assets) -> Sequence[Node]:
    """Parts of a blend; each is passed over while a signal chooses the other alone."""
    if not (isinstance(by, SignalLevel) and _is_plain(by)) or by.factor:
        return parts
    bit = 1 << assets.signals[by.name]
    first, second = parts
    first = replace(first, gate=first.gate | bit << MOST_SIGNALS)
    return first, replace(second, gate=second.gate | bit)


def _gate(pattern: Pattern, assets: Assets) -> int:
    """Gate of a pattern that has a factor."""
    return 1 << assets.signals[pattern.factor] if pattern.factor else 0


def _by_signal(pattern: Pattern, assets: Assets) -> Changes:
    """Word of a pattern's factor."""
    if not pattern.factor:
        return ()
    return ((words.BY_SIGNAL, (float(assets.signals[pattern.factor]),)),)


def _change(own: Node, changes: Changes, everywhere: bool = False) -> Node:
    return Node(NodeKind.CHANGE, (own,), changes=changes, everywhere=everywhere, depth=own.depth)


def _changes(pattern: Pattern, assets: Assets) -> Changes:
    """Words of what any pattern may have: amplitude, inversion, vibration, and then a factor."""
    changes: list[tuple[int, tuple[float, ...]]] = []
    if pattern.amplitude != 1.0:
        changes.append((words.SCALE, (pattern.amplitude,)))
    if pattern.inverted:
        changes.append((words.INVERT, ()))
    swing = pattern.vibration
    if swing is not None:
        word = words.VIBRATE_HIGH if swing.of == "high" else words.VIBRATE_LOW
        changes.append((word, (swing.frequency_hz, swing.amplitude)))
    return (*changes, *_by_signal(pattern, assets))


def _is_plain(pattern: Pattern) -> bool:
    return pattern.amplitude == 1.0 and not pattern.inverted and pattern.vibration is None


# Leaves


def _leaf(pattern: AnyPattern, assets: Assets) -> Node:
    """Leaf with a pattern's own changes among its words."""
    changes = _changes(pattern, assets)
    if isinstance(pattern, ShapeOrDots):
        own = shape_leaf(pattern, _fill_texture(pattern, assets), assets)
    elif isinstance(pattern, Image):
        own = _image(pattern, assets)
    elif isinstance(pattern, Label):
        written = assets.written[pattern]
        say = partial(_say_label, words.LABEL, pack_label(pattern, written))
        own = Node(NodeKind.LEAF, say=say, box=box_of(pattern, written))
    elif isinstance(pattern, Tile | Moving):
        part = deflection(pattern.part, assets)
        place = (
            (words.WRAP, *pattern.origin_mm, pattern.width_mm, pattern.height_mm)
            if isinstance(pattern, Tile)
            else (words.SHIFT, *_motion(pattern, assets))
        )
        own = Node(NodeKind.LEAF, say=partial(_say_inside, place, part), depth=2 + part.depth)
    else:
        own = Node(
            NodeKind.LEAF,
            say=partial(_say, *_texture(pattern, assets)),
            one=isinstance(pattern, Uniform) and pattern.level == 1.0 and not changes,
        )
    if not changes:
        return own
    assert own.say is not None
    own = replace(own, say=partial(_say_changed, own.say, changes), gate=_gate(pattern, assets))
    return replace(own, box=None) if is_everywhere(pattern) else own


def _fill_texture(pattern: ShapeOrDots, assets: Assets) -> Node | None:
    fill = fill_of(pattern)
    return None if fill is None else deflection(fill.texture, assets)


def _image(pattern: Image, assets: Assets) -> Node:
    bitmap = assets.bitmaps[pattern]
    box = bitmap_box(bitmap)
    return Node(NodeKind.LEAF, say=partial(_say_bitmap, bitmap), box=box)


# What leaves say


def _texture(pattern: AnyPattern, assets: Assets) -> tuple[int, tuple[float, ...]]:
    """Word of a texture, and its constants.

    Raises
    ------
    TypeError
        If it is none that is rendered.
    """
    match pattern:
        case Uniform():
            return words.LEVEL, (pattern.level,)
        case SignalLevel():
            return words.SIGNAL, (float(assets.signals[pattern.name]),)
        case UniformVibration():
            return words.VIBRATION, (pattern.frequency_hz,)
        case LinearGrating():
            return words.LINEAR, _linear(pattern, assets)
        case RadialGrating():
            cycle = Cycle(pattern.ridge_mm, pattern.gap_mm)
            waveform = _waveform(cycle, pattern, pattern.velocity_mm_s, assets)
            return words.RADIAL, (*pattern.center_mm, *waveform)
        case AxialGrating():
            return words.AXIAL, _axial(pattern, assets)
    raise TypeError(f"a {type(pattern).__name__} is not rendered; resolve the scene first")


def _say(word: int, constants: tuple[float, ...], block: WordBlock, _parts: bool) -> list[int]:
    block.say(word, *constants)
    return []


ONE = Node(NodeKind.LEAF, say=partial(_say, words.LEVEL, (1.0,)), one=True)


def _say_label(word: int, packed: PackedLabel, block: WordBlock, _parts: bool) -> list[int]:
    block.say_table(word, *packed.numbers.tolist(), at=TABLE, entries=packed.table)
    return []


def _say_inside(place: tuple[float, ...], part: Node, block: WordBlock, _parts: bool) -> list[int]:
    """Say a pattern that is seen at other places, by the word that finds these."""
    block.say(int(place[0]), *place[1:])
    say_whole(part, block)
    block.say(words.UNWRAP)
    return []


def _clock(velocity_by: str, assets: Assets) -> float:
    """Number of the signal whose integral is the time of a motion; below 0 for time itself."""
    return float(assets.signals[f"∫{velocity_by}"]) if velocity_by else -1.0


def _motion(moving: Moving, assets: Assets) -> tuple[float, ...]:
    center = moving.array_at_mm or (_NO_PLACE, _NO_PLACE)
    return (*moving.velocity_mm_s, _clock(moving.velocity_by, assets), *center)


def _say_changed(say, changes, block: WordBlock, parts: bool) -> list[int]:
    kept = say(block, parts)
    for operation, constants in changes:
        block.say(operation, *constants)
    return kept


def _linear(grating: LinearGrating, assets: Assets) -> tuple[float, ...]:
    angle = math.radians(travel_deg(grating.wave_angle_deg, grating.ridge_angle_deg))
    right, down = math.cos(angle), math.sin(angle)
    x, y = grating.start_mm
    cycle = Cycle(grating.ridge_mm, grating.gap_mm)
    waveform = _waveform(cycle, grating, grating.velocity_mm_s, assets)
    return (right, down, x * right + y * down, *waveform)


def _axial(grating: AxialGrating, assets: Assets) -> tuple[float, ...]:
    cycle = axial_cycle(grating)
    waveform = _waveform(cycle, grating, grating.velocity_deg_s, assets)
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
    word = words.PIXELS if bitmap.nearest else words.IMAGE
    block.say_table(word, *numbers, at=6, entries=framed.ravel())
    return []


def _waveform(
    cycle: Cycle,
    grating: LinearGrating | RadialGrating | AxialGrating,
    velocity: float,
    assets: Assets,
) -> tuple[float, ...]:
    own = (cycle.length, cycle.ridge, velocity, _clock(grating.velocity_by, assets))
    distortion = grating.distortion
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


def is_apart(pattern: ShapeOrDots) -> bool:
    """Tell whether a pattern is several leaves."""
    if isinstance(pattern, Dots):
        return False
    if pattern.is_cued_over:
        return True
    fill = fill_of(pattern)
    if fill is None:
        return False
    return pattern.dots is not None or any(
        isinstance(part, ShapeOrDots) for part in each(fill.texture)
    )


def _with_clock(pattern: ShapeOrDots, assets: Assets) -> ShapeOrDots:
    """Shape in which signals that move something along it have their numbers for their names."""
    for steps, name in signals_of(pattern):
        if steps[-1] == "velocity_by":
            pattern = cast("ShapeOrDots", with_name(pattern, steps, str(_clock(name, assets))))
    return pattern


def shape_apart(shape: AnyShape, texture: Node | None, assets: Assets) -> Node:
    """Tree of a shape that is several leaves, without its own changes."""
    if shape.is_cued_over:
        return _cued_over(shape, texture, assets)
    shape = cast("AnyShape", _with_clock(shape, assets))
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


def _cued_over(shape: AnyShape, texture: Node | None, assets: Assets) -> Node:
    """Tree of a shape with a cue over all of it: what the cue shows lies on it as a layer."""
    cue, bare = shape.cue, msgspec.structs.replace(shape, cue=None)
    assert cue is not None
    own = (shape_apart if is_apart(bare) else shape_leaf)(bare, texture, assets)
    if cue.way == "add":
        own = _change(own, ((words.SCALE, (1.0 - cue.share,)),))
    shape = cast("AnyShape", _with_clock(shape, assets))
    over = replace(_cue_leaf(shape, partial(_say_cue, shape)), pushes=Pushes.PAIR, depth=2)
    return joined(NodeKind.OVER, (own, over))


def _cue_leaf(shape: AnyShape, say: Saying) -> Node:
    """Leaf of the cue over a shape, or of its opacity mask."""
    enclosed, parts = enclosed_cue(shape), not isinstance(shape, Circle)
    return Node(NodeKind.LEAF, say=say, box=unchanged_bounds(shape), enclosed=enclosed, parts=parts)


def shape_leaf(pattern: ShapeOrDots, texture: Node | None, assets: Assets) -> Node:
    """Leaf of a pattern with the texture of its fill, without its own changes."""
    pattern = _with_clock(pattern, assets)
    if isinstance(pattern, Dots):
        return _drawn(pattern, partial(say_dots, pattern.dot, _placed(pattern)))
    if texture is None:
        return _drawn(pattern, partial(say_shape, pattern, None))
    say = partial(say_shape, pattern, partial(say_whole, texture))
    return _filled(pattern, say, max(texture.depth, 3))


def shape_pair(pattern: ShapeOrDots, own: Node, changes: Changes) -> Node:
    """Leaf that pushes a deflection, and then its changed mask from the same coordinates."""
    assert own.say is not None
    say = partial(_say_pair, own.say, partial(_say_mask, pattern), changes)
    return replace(own, say=say, pushes=Pushes.PAIR, depth=own.depth + 1)


def shape_mask(pattern: ShapeOrDots) -> Node:
    """Tree of a pattern's opacity mask."""
    if not isinstance(pattern, Dots) and pattern.is_cued_over:
        own = shape_mask(msgspec.structs.replace(pattern, cue=None))
        over = _cue_leaf(pattern, partial(_say_cue_mask, pattern))
        return joined(NodeKind.OVER, (own, over))
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


def _say_cue(shape: AnyShape, block: WordBlock, parts: bool) -> list[int]:
    """Say what the cue over a shape adds, and what it hides."""
    assert shape.cue is not None
    kept = _say_path(shape, block, parts, along=True)
    is_open = isinstance(shape, StraightLine) or (isinstance(shape, PathShape) and not shape.closed)
    # Those that are not wider than a row of dots end as the row does.
    fades = is_open and shape.cue_width_mm > shape.width_mm
    profile = _profile(shape.cue_width_mm, shape.cue_edge_mm, None)
    fade = 2.0 / shape.width_mm if fades else 0.0
    block.say(words.CUE, *profile, fade, *_cue_numbers(shape, shape.cue, words.ALONG_ROW))
    return kept


def _say_cue_mask(shape: AnyShape, block: WordBlock, parts: bool) -> list[int]:
    kept = _say_path(shape, block, parts, along=False)
    block.say(words.PROFILE, *_profile(shape.cue_width_mm, shape.cue_edge_mm, None))
    return kept


def _say_path(shape: AnyShape, block: WordBlock, parts: bool, *, along: bool) -> list[int]:
    """Say the coordinates of a shape's path alone, whatever it is drawn with."""
    if isinstance(shape, Circle):
        block.say(words.CIRCLE, *shape.center_mm, shape.radius_mm, float(along))
        return []
    kept = _keep_parts(segments(shape, along), block, parts)
    rounded = isinstance(shape, Polygon) and shape.join == "rounded"
    asked = (places.ROUNDED if rounded else places.ALONG) if along else places.ACROSS
    block.say(words.SEGMENTS, float(asked), -1.0)
    return kept


def _say_pair(say, say_mask, changes: Changes, block: WordBlock, parts: bool) -> list[int]:
    kept = say(block, parts)
    say_mask(block, parts, paired=True)
    for operation, constants in changes:
        block.say(operation, *constants)
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
        return _say_dotted(shape, block, parts)
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
        return _say_dotted_mask(shape, block, parts, _dotting(shape).across, paired)
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
        kept = _say_dotted(shape, block, parts)
        _say_dotted_mask(shape, block, parts, None, paired=True)
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
    block.say(words.DOTS, *_dot_numbers(style, vertices))
    return kept


def _say_dotted(shape: AnyShape, block: WordBlock, parts: bool) -> list[int]:
    """Say the dots along a shape, which may move."""
    if not dots_move(shape):
        return say_dots(_dotting(shape), dots_of(shape), block, parts, _vertices(shape))
    kept = _keep_parts(moving_dots(shape), block, parts)
    block.say(words.MOVING_DOTS, *_moving_numbers(shape, _dotting(shape).across))
    return kept


def _say_dotted_mask(
    shape: AnyShape, block: WordBlock, parts: bool, across: Across | None, paired: bool
) -> list[int]:
    """Say the opacity mask of the dots along a shape; see `say_dots_mask`."""
    if not dots_move(shape):
        return say_dots_mask(_dotting(shape), dots_of(shape), block, parts, across, paired)
    kept = [] if paired and parts else _keep_parts(moving_dots(shape), block, parts)
    block.say(words.MOVING_DOTS_MASK, *_moving_numbers(shape, across))
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
    """Tell whether a shape's deflection is its mask, too, before what all patterns share."""
    if isinstance(shape, AnyShape):
        if fill_of(shape) is not None:
            return False
        if shape.stroke is not None:
            stroke = shape.stroke
            plain = stroke.across is None and stroke.along is None and not stroke.outlined
            marked = isinstance(shape, Polygon) and shape.markers is not None
            marked = marked or shape.cue is not None
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


def _dot_numbers(style: DotStyle, vertices: Vibration | None) -> list[float]:
    numbers = [0.0] * strokes.STROKE_NUMBERS
    numbers[: strokes.AMPLITUDE] = _dot_profile(style, style.across)
    numbers[strokes.AMPLITUDE] = style.amplitude
    numbers[strokes.SWING : strokes.SWING + 3] = _swing(style.vibration)
    numbers[strokes.MARKS : strokes.MARKS + 3] = _swing(vertices)
    return numbers


def _moving_numbers(shape: AnyShape, across: Across | None) -> list[float]:
    """Numbers of dots that move along a shape, with this texture across them."""
    assert shape.dots is not None
    numbers = _dot_numbers(shape.dots.dot, shape.dots.vertex_vibration)
    numbers[: strokes.AMPLITUDE] = _dot_profile(shape.dots.dot, across)
    numbers[strokes.VELOCITY] = shape.dots.velocity_mm_s
    numbers[strokes.CLOCK] = float(shape.dots.velocity_by or -1.0)
    return numbers


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
            numbers[strokes.CLOCK] = _clock_of(shape)
    numbers[strokes.SWING : strokes.SWING + 3] = _swing(stroke.vibration)
    if isinstance(shape, Polygon) and shape.markers is not None:
        swing = _swing(shape.markers.swing)
        numbers[strokes.MARKS : strokes.MARKS + 3] = (1.0, *swing[1:])
    if shape.cue is not None:
        row = words.PLACE_ROW if differ(stroke_cycles(shape)) else words.ALONG_ROW
        numbers[strokes.STROKE_CUE :] = _cue_numbers(shape, shape.cue, row)
    return numbers


def _cue_numbers(shape: AnyShape, cue: MovingCue, row: int) -> tuple[float, ...]:
    """Numbers of a cue whose places along the path are in a row."""
    cycle = cue_cycle(shape)
    motion = (cue.velocity_mm_s, float(cue.velocity_by or -1.0), float(row))
    weight, hides, shows = {
        "vibrate": (0.0, 1.0, 1.0),
        "blend": (0.0, 1.0, cue.level),
        "mask": (0.0, 2.0, 0.0),
        "add": (cue.share, 0.0, cue.share),
    }[cue.way]
    return (cycle.length, cycle.ridge, *motion, weight, hides, shows, *_swing(cue.swing))


def _clock_of(shape: AnyShape) -> float:
    """Number of the signal that moves a texture along a shape, as `_with_clock` left it."""
    along = None if shape.stroke is None else shape.stroke.along
    return float(along.velocity_by or -1.0) if along is not None else -1.0


def _dotting(shape: AnyShape) -> DotStyle:
    assert shape.dots is not None
    return shape.dots.dot


def _vertices(shape: AnyShape) -> Vibration | None:
    return None if shape.dots is None else shape.dots.vertex_vibration


# Parts


def _keep_dots(dots: Sequence[PlacedDot], block: WordBlock, parts: bool) -> list[int]:
    return _keep_parts(((dot.x_mm, dot.y_mm, float(dot.vertex)) for dot in dots), block, parts)


def _keep_parts(numbers: Iterable[tuple[float, ...]], block: WordBlock, parts: bool) -> list[int]:
    kept = block.keep(numbers)
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
    along = stroke is not None and (stroke.along is not None or shape.cue is not None)
    marked = isinstance(shape, Polygon) and shape.markers is not None and stroke is not None
    if isinstance(shape, Circle):
        block.say(words.CIRCLE, *shape.center_mm, shape.radius_mm, float(along))
        return []
    cycles = stroke_cycles(shape) if stroke is not None else ()
    kept = block.keep(segments(shape, along or marked, cycles=cycles))
    if not parts:
        block.say_parts(kept)
    elif filled:
        kept += block.keep(walls(shape, along or marked))
    asked = places.ACROSS
    if along or marked:
        rounded = isinstance(shape, Polygon) and shape.join == "rounded"
        asked = places.ROUNDED if rounded or differ(stroke_cycles(shape)) else places.ALONG
    block.say(words.SEGMENTS, float(asked), _clock_of(shape))
    if filled:
        block.say(words.INSIDE)
    if marked:
        assert isinstance(shape, Polygon)
        assert shape.markers is not None
        assert stroke is not None
        block.say(words.MARKERS, stroke.width_mm / 2, 1.0 / shape.markers.blend_mm)
    return kept
