"""Lines, circles, polygons and dots of OpenLatero's files, with their strokes and fills."""

from __future__ import annotations

import math
from itertools import groupby
from typing import TYPE_CHECKING, Any, Final, Literal

from msgspec.structs import replace

from vbraille.errors import needing_extras
from vbraille.scene.dotting import rows_of
from vbraille.scene.intersections import meeting_edges
from vbraille.scene.joints import joints, rounding_radius_mm
from vbraille.scene.measures import LEAST_MM
from vbraille.scene.openlatero.elements import PATTERNS, makes, pattern_of
from vbraille.scene.patterns import Circle, Dots, Fill, Group, PathShape, Polygon, StraightLine
from vbraille.scene.strokes import (
    Across,
    Along,
    DotStyle,
    Dotting,
    MovingCue,
    Stroke,
    VertexMarkers,
    Vibration,
)
from vbraille.scene.textures import LinearGrating

if TYPE_CHECKING:
    from vbraille.scene.openlatero.elements import Element
    from vbraille.scene.patterns import AnyPattern

_WAYS: Final[dict[str, Literal["add", "mask", "blend", "vibrate"]]] = {
    "superposed": "add",
    "suppressed": "mask",
    "vibration": "vibrate",
    "blend": "blend",
}
_SPANS: Final[dict[str, Literal["angle", "arc", "edges", "square"]]] = {
    "user specified": "angle",
    "arc": "arc",
    "circle intercept": "edges",
    "right-angled": "square",
}
_OPERATIONS = ("multiply", "add", "max", "blend", "overwrite", "reactive")


def operation_of(operation: Element, usual: str) -> str:
    """Name that OpenLatero has for how the parts of an element are put together."""
    if not operation.there:
        return usual
    # Old files have it as text.
    return operation.word(operation.attribute("type") or operation.text, _OPERATIONS, usual)


def vibration_of(element: Element, always_up: str = "") -> Vibration | None:
    """Vibration that an element tells of; None if it is off.

    Parameters
    ----------
    element
        The element of the vibration.
    always_up
        What it is a vibration of, such as "dots", if that has nothing that is down.
    """
    if not element.there or not element.enable:
        return None
    swing = _swing(element)
    if element.blend_mode == "high":
        return swing
    if always_up:
        element.say(f"{always_up} have nothing down that could vibrate; what is up does")
        return swing
    if element.context.as_shown:
        element.say("blend_mode low is ignored, as OpenLatero does")
        return swing
    element.say("what is down vibrates, as the file says; OpenLatero ignores blend_mode low")
    return replace(swing, of="low")


def _swing(element: Element) -> Vibration:
    """Vibration of what is up, whether it is on or off."""
    return Vibration(**element.here, frequency_hz=element.context.truncated(element.frequency))


def speed_of(wave: Element, unit: str = "mm", most: float = 1000.0) -> float:
    """Speed of the ridges of a grating, in a unit per second."""
    speed, in_hertz = wave.velocity
    speed *= wave.ridge_size + wave.gap_size if in_hertz else 1.0
    if abs(speed) > most:
        wave.say(f"its ridges would move at {speed:g} {unit}/s; {most:g} is taken")
    return max(-most, min(most, speed))


def _across(ripples: Element) -> Across | None:
    """Texture across a profile; None for none."""
    if not ripples.enable or not ripples.amplitude:
        return None
    return Across(**ripples.here, cycles=2 * int(ripples.nb_cycles) + 1)


def _along(wave: Element) -> Along | None:
    """Texture along a stroke; None for none."""
    if not wave.enable:
        return None
    if wave.ridge_size < LEAST_MM:
        wave.say(f"its ridges are {wave.ridge_size:g} mm, so the stroke has no texture here")
        return None
    if wave.invert:
        wave.say("fill Grating is inverted, which a texture along a stroke cannot be here")
    if wave.PitchModulator.enable:
        wave.say("a texture along a stroke has the same lengths all along it here")
    return Along(**wave.here, whole_cycles=False)


def _look(stroke: Element, *, corners_swing: bool = False) -> dict[str, Any]:
    """Look of a shape: its amplitude, and its stroke or dots with their cue if there are any.

    Parameters
    ----------
    stroke
        Element of the stroke.
    corners_swing
        Whether dots on vertices swing where others do not, and the other way round.
    """
    look: dict[str, Any] = {"amplitude": stroke.intensity}
    width = _width(stroke)
    if width < LEAST_MM:
        stroke.say(f"stroke width is {width:g}, so there is no stroke")
        return look
    # OpenLatero reads both into one profile and one vibration, the stroke's last.
    ridge, dots, fill = stroke.ridge, stroke.dots, stroke.fill
    edge = (ridge if "edge_width" in ridge.given else dots.ridge).edge_width
    across = _across((ridge if ridge.given else dots.ridge).texture)
    swinging = (fill if fill.there else dots).vibration
    vibration = vibration_of(swinging, "dots" if dots.enable else "")
    if dots.enable:
        corner = None
        if corners_swing:
            corner = _swing(swinging) if vibration is None else Vibration(amplitude=0.0)
        look["dots"] = Dotting(
            **dots.here,
            dot=DotStyle(
                radius_mm=width / 2,
                edge_mm=edge,
                amplitude=dots.height,
                across=across,
                vibration=vibration,
            ),
            vertex_vibration=corner,
            velocity_mm_s=_own_speed(stroke, 0.0),
        )
    else:
        plain = Stroke(width_mm=width, edge_mm=edge, across=across)
        look["stroke"] = _stroke(stroke, plain, vibration)
    look["cue"] = _cue(stroke.motion) if dots.enable or look["stroke"] else None
    return look


def _width(stroke: Element) -> float:
    """Width of a stroke, whose profile may have another one."""
    width, other = stroke.width, stroke.ridge.width
    if "width" not in stroke.ridge.given or other == width:
        return width
    stroke.ridge.say(
        f"stroke ridge width is {other:g} and stroke width {width:g}; "
        f"the stroke is {min(other, width):g} mm wide here"
    )
    return min(other, width)


def _own_speed(stroke: Element, along: float) -> float:
    """Speed of the texture along a stroke, whose own it is without a cue, or of the dots."""
    # A speed alone is that of the cue "none", by which nothing moves.
    if not stroke.motion.given & {"cue", "velocity"}:
        return along
    return stroke.motion.velocity if stroke.motion.cue == "inherent" else 0.0


def _stroke(stroke: Element, plain: Stroke, vibration: Vibration | None) -> Stroke | None:
    """Stroke with the texture along it; None if nothing of it can be felt."""
    fill, width = stroke.fill, plain.width_mm
    along = _along(fill.Grating)
    fits = width >= 4 * plain.edge
    if along is not None:
        speed = stroke.context.truncated(
            _own_speed(stroke, speed_of(fill.Grating)), along.wave.length
        )
        along = replace(along, whole_edges=fill.gutter and fits, velocity_mm_s=speed)
        return replace(plain, along=along, vibration=vibration)
    if vibration is not None and vibration.of == "low":
        if fill.gutter:
            fill.say("the middle of an outlined stroke does not vibrate here")
        vibration = None  # there is nothing in it that is down
    if fill.gutter and not fits:
        needs = "the outline needs a stroke of four edges, and OpenLatero shows nothing"
        if stroke.context.as_shown:
            fill.say(f"{needs}, which hides what is below it there")
            return None
        fill.say(f"{needs}; an edge of {width / 4:g} mm is taken")
        plain = replace(plain, edge_mm=width / 4)
    return replace(plain, outlined=fill.gutter, vibration=vibration)


def _cue(motion: Element) -> MovingCue | None:
    """Bands that move along a shape; None for none."""
    way, level, bands = _WAYS.get(motion.cue), motion.blend_value, motion.Grating
    if way is None:
        return None
    if not bands.enable or bands.ridge_size < LEAST_MM:
        motion.say("its cue has no bands; left out")
        return None
    if bands.invert:
        motion.say("the bands of its cue are inverted, which they cannot be here")
    vibration = vibration_of(motion.vibration, "bands")
    stands = motion.context.as_shown or motion.vibration.there
    if way == "vibrate" and vibration is None and stands:  # what does not vibrate is up
        way, level = "blend", 1.0
    speed = speed_of(bands) if "velocity" in bands.given else motion.velocity
    return MovingCue(
        **motion.here,
        **bands.here,
        way=way,
        velocity_mm_s=motion.context.truncated(speed, bands.ridge_size + bands.gap_size),
        level=level,
        vibration=vibration,
        whole_cycles=False,
    )


def _fill(element: Element, look: dict[str, Any]) -> Fill | None:
    """Fill of a closed shape of a look; None for nothing."""
    if not element.enable:
        return None
    # Without a texture OpenLatero takes one of its own.
    part = element.Pattern
    texture = pattern_of(part) if part.there else LinearGrating(ridge_mm=8.0)
    if texture is None:
        element.say("the fill is left out, since there is nothing of its texture to show")
        return None
    cue, stroke, blended = look.get("cue"), look.get("stroke"), element.gap < 0
    if blended and look.get("dots"):
        element.say("dots stand in the place of the fill there, and are blended into it here")
    if element.context.as_shown and stroke and cue and cue.way == "add" and not blended:
        weakened = Group(operation="maximum", parts=(texture,), amplitude=1.0 - cue.share)
        texture = weakened if stroke.width_mm >= cue.width_mm else texture
    if blended:
        return Fill(texture=texture, blended=True)
    return Fill(**element.here, texture=texture, gap_mm=element.gap)


def _is_felt(element: Element, look: dict[str, Any]) -> bool:
    """Tell whether there is anything in a look, and say so if not."""
    felt = any(look.get(part) for part in ("stroke", "dots", "fill"))
    if not felt:
        element.say("nothing of it can be felt; left out")
    return felt


def _paced(shape: StraightLine | Circle, length_mm: float, element: Element) -> AnyPattern:
    """Shape whose dots, if they move, come round after whole microseconds, as they do there."""
    if shape.dots is None:
        return shape
    speed = element.context.truncated(shape.dots.velocity_mm_s, length_mm)
    return replace(shape, dots=replace(shape.dots, velocity_mm_s=speed))


@makes(PATTERNS, "Line")
def _line(element: Element) -> AnyPattern | None:
    look = _look(element.stroke)
    if not _is_felt(element, look):
        return None
    line = StraightLine(**element.here, **look)
    _, rows = rows_of(line)
    length = math.dist(line.start_mm, line.end_mm)
    return _paced(line, length + rows[0].pitch_mm, element) if rows else line


@makes(PATTERNS, "Circle")
def _circle(element: Element) -> AnyPattern | None:
    look = _look(element.stroke)
    look["fill"] = _fill(element.fill_texture, look)
    if not _is_felt(element, look):
        return None
    return _paced(Circle(**element.here, **look), math.tau * element.radius, element)


@makes(PATTERNS, "Polygon")
def _polygon(element: Element) -> AnyPattern | None:
    """Polygon, or a path if its edges cross."""
    # Vertices that stand on the one before are passed over.
    vertices = [vertex for vertex, _ in groupby(element.vertices.vertex)]
    if len(vertices) > 1 and vertices[0] == vertices[-1]:
        del vertices[-1]
    look = _look(element.stroke, corners_swing=element.corner.enable)
    markers = _markers(element.corner, look)
    look["fill"] = _fill(element.fill_texture, look)
    if not _is_felt(element, look):
        return None
    if len(vertices) > 2 and meeting_edges(tuple(vertices)) is not None:
        lost = " and its markers are left out" if markers is not None else ""
        element.say(f"its edges cross, so it is a path here; textures jump at its corners{lost}")
        return PathShape(contours_mm=(tuple(vertices),), closed=True, **look)
    rounded = element.join.type == "round"
    polygon = Polygon(
        vertices_mm=tuple(vertices),
        join="rounded" if rounded else "straight",
        rounding_offset_mm=element.join.rounding_offset,
        markers=markers,
        **look,
    )
    along = polygon.stroke is not None and polygon.stroke.along is not None
    if markers is not None or (rounded and along):
        wanted = rounding_radius_mm(polygon)
        if any(joint.radius_mm < wanted for joint in joints(polygon.vertices_mm, wanted)):
            element.say(
                "an edge is too short for the round joints at its ends, which are smaller here"
            )
    return polygon


def _markers(corner: Element, look: dict[str, Any]) -> VertexMarkers | None:
    """Markers at the vertices of a polygon of a look; None for none."""
    stroke = look.get("stroke")
    if not corner.enable or stroke is None:
        return None
    if corner.blend == "in":
        corner.say("markers blend outwards here, not inwards")
    if look["cue"] and not corner.motion:
        corner.say("its cue goes over the markers here")
    vibration = vibration_of(corner.vibration, "markers")
    if corner.type == "invert vib":
        if stroke.along is not None or stroke.outlined:
            corner.say("markers are plain here, and have the texture of the stroke there")
        vibration = Vibration() if stroke.vibration is None else None
    angle = corner.user_angle if corner.span == "user specified" else 30.0
    markers = VertexMarkers(**corner.here, span=_SPANS[corner.span], angle_deg=angle)
    if vibration is None:
        return replace(markers, plain=True)
    return replace(markers, vibration=vibration)


@makes(PATTERNS, "Dot", "Dots")
def _dots(element: Element) -> AnyPattern | None:
    centers = tuple(element.dot)
    operation = "max"
    if element.owner == "Dot":
        centers = centers[:1] or ((0.0, 0.0),)
    elif not centers:
        element.say("it has no dots; left out")
        return None
    else:
        operation = operation_of(element.operation, "add")
    style = DotStyle(
        **element.here,
        edge_mm=element.ridge.edge_width,
        across=_across(element.ridge.texture),
        vibration=vibration_of(element.vibration, "dots"),
    )
    if len(centers) > 1 and operation == "add":
        with needing_extras():
            from scipy.spatial import KDTree
        nearest, _ = KDTree(centers).query(centers, k=2)
        if nearest[:, 1].min() < 2 * element.dot_radius - 1e-9:
            element.say("dots that overlap add up in OpenLatero, and the larger one counts here")
    elif len(centers) > 1 and operation != "max":
        element.say(f'dots are put together by "maximum" here, and by "{operation}" there')
    return Dots(centers_mm=centers, dot=style)
