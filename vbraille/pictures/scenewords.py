"""Words for the picture of a scene: one thing a line, for people who do not see it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from vbraille.pictures.words import plain
from vbraille.scene.patterns import (
    Circle,
    Dots,
    Group,
    Image,
    ImageDots,
    Label,
    Moving,
    PathShape,
    Polygon,
    StraightLine,
    Tile,
    Use,
)
from vbraille.scene.signals import Direction, Inverse, Product, Pulse, Speed, Switch
from vbraille.scene.textures import (
    AxialGrating,
    LinearGrating,
    RadialGrating,
    SignalLevel,
    Uniform,
    UniformVibration,
)
from vbraille.scene.traversal import vibrations
from vbraille.wording import count

if TYPE_CHECKING:
    from vbraille.scene.measures import Point
    from vbraille.scene.patterns import AnyPattern
    from vbraille.scene.scene import Scene
    from vbraille.scene.signals import AnySignal
    from vbraille.scene.strokes import Along, DotStyle, Dotting, MovingCue, Stroke, Vibration

# How groups put their parts together, in words that need no formula.
_TOGETHER = {
    "overwrite": "one on top of the other",
    "multiply": "each masking the others",
    "add": "added",
    "weighted": "added by weights",
    "maximum": "the largest of them",
    "blend": "blended by a third",
}
# Directions on the canvas, an eighth of a turn after each other, from +x towards +y.
WAYS = (
    *("right", "right and down", "down", "left and down"),
    *("left", "left and up", "up", "right and up"),
)
_AT_REST = {"high": "1 at rest", "low": "0 at rest", "keep": "at rest what it was before"}


def scene_lines(scene: Scene) -> list[str]:
    """Tell what a scene holds, a line for each thing: "label: value".

    The lines are title and description if it has them, its size, how many elements it has and what
    each is, its signals, and what vibrates.
    """
    told = [("title", scene.title), ("description", scene.description)]
    lines = [f"{label}: {plain(text)}" for label, text in told if text.strip()]
    lines.append(f"size: {scene.canvas.width_mm:g} × {scene.canvas.height_mm:g} mm")
    lines.append(f"elements: {len(scene.elements)}, {_TOGETHER[scene.operation]}")
    for number, element in enumerate(scene.elements, 1):
        lines.append(f"element {number}: {pattern_words(element)}")
    lines += [f"signal {plain(name)}: {signal_words(one)}" for name, one in scene.signals.items()]
    shaking = [
        f"{plain(name_of(element)) or number}, {', '.join(dict.fromkeys(swings))}"
        for number, element in enumerate(scene.elements, 1)
        if (swings := [_swing_words(vibration) for vibration in vibrations(element)])
    ]
    lines += [f"vibrates: element {said}" for said in shaking] or ["vibrates: nothing"]
    return lines


def scene_text(scene: Scene) -> str:
    """Tell the same in one text, for the file of a picture."""
    return "; ".join(scene_lines(scene))


def name_of(pattern: AnyPattern) -> str:
    """Tell what a pattern is called: by its title, else by its id, else not at all."""
    return pattern.title or pattern.id


def signal_words(signal: AnySignal) -> str:
    """Tell in a line when a signal is 1 and when it is 0."""
    match signal:
        case Speed():
            end = signal.below_mm_s + signal.transition_mm_s
            words = f"1 under a hand slower than {signal.below_mm_s:g} mm/s, 0 from {end:g} mm/s on"
            if not signal.delay_s:
                return words
            return f"{words}; it waits {signal.delay_s:g} s and rises as long"
        case Direction():
            end = signal.tolerance_deg + signal.transition_deg
            way = _way(signal.angle_deg)
            back = _way(signal.angle_deg + 180.0)
            return (
                f"1 under a hand that goes {f'{way} or {back}' if signal.axis else way} within "
                f"{signal.tolerance_deg:g}°, 0 from {end:g}° on, {_AT_REST[signal.at_rest]}"
            )
        case Switch():
            levels = zip(signal.states or map(str, range(1, 9)), signal.levels, strict=False)
            states = ", ".join(f"{plain(state)} {level:g}" for state, level in levels)
            title = f"{plain(signal.title)}, " if signal.title else ""
            return f"{title}key {signal.key}: {states}"
        case Pulse():
            return f"{signal.shape}, again every {signal.period_s:g} s"
        case Product():
            return " × ".join(map(plain, signal.of))
        case Inverse():
            return f"1 - {plain(signal.of)}"


def _way(angle_deg: float) -> str:
    """Tell a direction by the nearest eighth of a turn, and by its angle if it is between two."""
    turned = angle_deg % 360.0
    eighth, beside = divmod(turned + 22.5, 45.0)
    way = WAYS[int(eighth) % len(WAYS)]
    return way if math.isclose(beside, 22.5) else f"at {turned:g}° ({way})"


def _moving_by(speed: float, way: str, by: str, unit: str = "mm/s") -> str:
    """Tell that something moves, and by which signal; nothing if it does not."""
    if not speed:
        return ""
    by = f" times signal {plain(by)}" if by else ""
    return f", moving {way} at {abs(speed):g} {unit}{by}"


def pattern_words(pattern: AnyPattern) -> str:
    """Tell in a line what a pattern is: its name, its kind and where it is."""
    words = [_kind_words(pattern)]
    if pattern.amplitude != 1.0:
        words.append(f"amplitude {pattern.amplitude:g}")
    if pattern.inverted:
        words.append("inverted")
    if pattern.vibration is not None:
        words.append(f"vibrating: {_swing_words(pattern.vibration)}")
    if pattern.factor:
        words.append(f"times signal {plain(pattern.factor)}")
    name = plain(name_of(pattern))
    return (f"{name}, " if name else "") + ", ".join(words)


def _kind_words(pattern: AnyPattern) -> str:
    match pattern:
        case Uniform():
            return f"uniform deflection {pattern.level:g}"
        case SignalLevel():
            return f"signal {plain(pattern.name)}"
        case Moving():
            return _moving_words(pattern)
        case UniformVibration():
            return f"uniform vibration at {pattern.frequency_hz:g} Hz"
        case LinearGrating() | RadialGrating() | AxialGrating():
            return _grating_words(pattern)
        case Tile():
            return (
                f"tiles of {pattern.width_mm:g} × {pattern.height_mm:g} mm with "
                f"{pattern_words(pattern.part)}"
            )
        case Image():
            masked = "" if pattern.texture is None else f", of {pattern_words(pattern.texture)}"
            return f"image {plain(pattern.file)} at {_place(pattern.place_mm)}{masked}"
        case ImageDots():
            return f"dots of image {plain(pattern.file)} at {_place(pattern.place_mm)}"
        case Dots():
            return f"{count(len(pattern.centers_mm), 'dot')} {_dot_words(pattern.dot)}"
        case Label():
            return f'braille "{plain(pattern.text)}" at {_place(pattern.place_mm)}'
        case Group():
            parts = "; ".join(map(pattern_words, pattern.parts))
            together = _TOGETHER[pattern.operation]
            if pattern.by is not None:
                together = f"blended by {pattern_words(pattern.by)}"
            return f"{len(pattern.parts)} parts, {together} ({parts})"
        case Use():
            return f"{plain(pattern.name)} again"
        case StraightLine() | Circle() | Polygon() | PathShape():
            return _shape_words(pattern)


def _moving_words(moving: Moving) -> str:
    """Tell how a texture moves, and what it is."""
    right, down = moving.velocity_mm_s
    moves = f"moving by ({right:g}, {down:g}) mm/s"
    if moving.velocity_by:
        moves += f" times signal {plain(moving.velocity_by)}"
    if moving.array_at_mm is not None:
        moves += ", not by the hand"
    return f"{pattern_words(moving.part)}, {moves}"


def _grating_words(grating: LinearGrating | RadialGrating | AxialGrating) -> str:
    if isinstance(grating, AxialGrating):
        words = f"spokes of {grating.ridge_deg:g}° with gaps of {grating.gap_deg:g}° around"
        way = "against the clock" if grating.velocity_deg_s < 0 else "with the clock"
        turns = _moving_by(grating.velocity_deg_s, way, grating.velocity_by, "°/s")
        return f"{words} {_place(grating.center_mm)}{turns}"
    lengths = f"ridges of {grating.ridge_mm:g} mm with gaps of {grating.gap_mm:g} mm"
    if isinstance(grating, RadialGrating):
        words = f"rings: {lengths} around {_place(grating.center_mm)}"
        way = "inward" if grating.velocity_mm_s < 0 else "outward"
    else:
        words = f"{lengths}, the wave at {grating.travel_deg:g}°"
        way = _way(grating.travel_deg + 180.0 * (grating.velocity_mm_s < 0))
    words += _moving_by(grating.velocity_mm_s, way, grating.velocity_by)
    return words if grating.distortion is None else f"{words}, frequency changed"


def _shape_words(shape: StraightLine | Circle | Polygon | PathShape) -> str:
    match shape:
        case StraightLine():
            words = f"line from {_place(shape.start_mm)} to {_place(shape.end_mm)}"
        case Circle():
            words = f"circle of radius {shape.radius_mm:g} mm around {_place(shape.center_mm)}"
        case Polygon():
            corners = ", ".join(f"({x:g}, {y:g})" for x, y in shape.vertices_mm[:8])
            more = ", …" if len(shape.vertices_mm) > 8 else ""
            words = f"polygon of {len(shape.vertices_mm)} vertices at {corners}{more} mm"
        case PathShape():
            kind = "closed " if shape.closed else ""
            places = sum(map(len, shape.contours_mm))
            words = f"{kind}path through {places} places from {_place(shape.contours_mm[0][0])}"
    said = [words]
    if shape.stroke is not None:
        said.append(_stroke_words(shape.stroke))
    if shape.dots is not None:
        said.append(f"of dots {_dot_words(shape.dots.dot)}{_along_words(shape.dots)}")
    if shape.cue is not None:
        bands = f"under bands every {shape.cue.wave.length:g} mm"
        said.append(f"{bands}{_along_words(shape.cue)}")
    if isinstance(shape, Polygon) and shape.markers is not None:
        said.append("with markers")
    if not isinstance(shape, StraightLine) and shape.fill is not None:
        said.append(f"filled with {pattern_words(shape.fill.texture)}")
    return ", ".join(said)


def _stroke_words(stroke: Stroke) -> str:
    words = [f"stroke of {stroke.width_mm:g} mm"]
    if stroke.outlined:
        words.append("outlined")
    if stroke.along is not None:
        words.append(f"cut every {stroke.along.wave.length:g} mm{_along_words(stroke.along)}")
    if stroke.across is not None:
        words.append(f"with {stroke.across.cycles} cycles across")
    if stroke.vibration is not None:
        words.append(f"vibrating: {_swing_words(stroke.vibration)}")
    return " ".join(words)


def _along_words(moving: Along | Dotting | MovingCue) -> str:
    """Tell how something moves along a path."""
    way = "from its end to its beginning" if moving.velocity_mm_s < 0 else "along it"
    return _moving_by(moving.velocity_mm_s, way, moving.velocity_by)


def _dot_words(dot: DotStyle) -> str:
    swing = "" if dot.vibration is None else f", vibrating: {_swing_words(dot.vibration)}"
    return f"of radius {dot.radius_mm:g} mm{swing}"


def _swing_words(vibration: Vibration) -> str:
    share = "" if vibration.amplitude == 1.0 else f", amplitude {vibration.amplitude:g}"
    part = "" if vibration.of == "high" else ", of what is down"
    return f"{vibration.frequency_hz:g} Hz{share}{part}"


def _place(point_mm: Point) -> str:
    return f"({point_mm[0]:g}, {point_mm[1]:g}) mm"
