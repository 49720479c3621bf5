"""Lines, circles, polygons and dots of OpenLatero's files, with their strokes and fills."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import groupby
from typing import TYPE_CHECKING, Final, Literal

from msgspec.structs import replace

from vbraille.errors import needing_extras
from vbraille.scene.dotting import rows_of
from vbraille.scene.intersections import meeting_edges
from vbraille.scene.joints import joints, rounding_radius_mm
from vbraille.scene.measures import LEAST_MM, MOST_MM
from vbraille.scene.openlatero.context import (
    SURFACE_MM,
    VIBRATION,
    Kinds,
    swung,
    travelled,
    vibration,
)
from vbraille.scene.openlatero.elements import (
    ANGLE,
    OFF,
    ON,
    ORIGIN,
    SHARE,
    NumberField,
    PlaceField,
    WordField,
)
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
    from vbraille.scene.measures import Point
    from vbraille.scene.openlatero.context import GenContext
    from vbraille.scene.openlatero.elements import GenElement
    from vbraille.scene.patterns import AnyPattern

ROWS = Kinds()
_CUES = ("none", "inherent", "superposed", "suppressed", "vibration", "blend")
_MOST_SPEED = 1000.0
_OPERATIONS = ("multiply", "add", "max", "blend", "overwrite", "reactive")
_SPANS = {
    "user specified": "angle",
    "arc": "arc",
    "circle intercept": "edges",
    "right-angled": "square",
}

# Parts of shapes.
STROKE = {"width": NumberField(10.0), "intensity": SHARE}
DOTS = {"enable": OFF, "height": SHARE, "min_spacing": NumberField(1.0)}
RIDGE = {"edge_width": NumberField(1.0, 0.1)}
DOT_RIDGE = {"edge_width": NumberField(0.2, 0.1)}
ACROSS = {
    "enable": OFF,
    "amplitude": NumberField(0.0, 0.0, 1.0, "share"),
    "nb_cycles": NumberField(3, 0, 49, ""),  # on one side of a stroke
}
FILL = {"gutter": OFF}
ALONG = {"enable": OFF, "ridge_size": NumberField(2.0), "gap_size": NumberField(0.0), "invert": OFF}
CUE = {
    "cue": WordField("none", _CUES),
    "velocity": NumberField(50.0, -_MOST_SPEED, _MOST_SPEED, "mm/s"),
    "superposed_ratio": NumberField(0.2, 0.0, 1.0, "share"),
    "blend_value": NumberField(0.5, 0.0, 1.0, "share"),
    "min_width": NumberField(10.0),
}
BANDS = {"enable": ON, "ridge_size": NumberField(2.0), "gap_size": NumberField(30.0), "invert": OFF}
_WAYS: Final[dict[str, Literal["add", "mask", "blend", "vibrate"]]] = {
    "superposed": "add",
    "suppressed": "mask",
    "vibration": "vibrate",
    "blend": "blend",
}
FILL_TEXTURE = {"enable": OFF, "gap": NumberField(0.0, -MOST_MM), "edge_size": NumberField(1.0)}
JOIN = {"type": WordField("round", ("straight", "round")), "rounding_offset": NumberField(0.0)}
CORNER = {
    "enable": OFF,
    "span": WordField("circle intercept", _SPANS),
    "type": WordField("solid", ("solid", "invert vib")),
    "user_angle": NumberField(30.0, 1.0, 180.0, "°"),
    "blend": WordField("out", ("in", "out")),
    "blend_size": NumberField(1.0, LEAST_MM),
}


@dataclass(frozen=True, slots=True)
class StrokeLook:
    """Look of a shape as it is drawn.

    Parameters
    ----------
    intensity
        Factor of the stroke, and of the fill with it.
    stroke, dots
        The stroke, or the dots in its place; neither if nothing of it can be felt.
    cue
        Bands that move along it; None for none.
    """

    intensity: float
    stroke: Stroke | None
    dots: Dotting | None
    cue: MovingCue | None = None


def drawn(shape: GenElement, context: GenContext, *, corners_swing: bool = False) -> StrokeLook:
    """Tell how the stroke of a shape is drawn.

    Parameters
    ----------
    shape
        Element of the shape.
    context
        How the file is read.
    corners_swing
        Whether dots on vertices swing where others do not, and the other way round.
    """
    element = shape.part("stroke", STROKE)
    width, intensity = element["width"], element["intensity"]
    row = element.part("dots", DOTS)
    is_dotted = row["enable"]
    # OpenLatero reads both into one profile and one vibration, the stroke's last.
    ridge, beneath = element.part("ridge", RIDGE), row.part("ridge", RIDGE)
    edge = ridge.read("edge_width", RIDGE["edge_width"]._replace(default=beneath["edge_width"]))
    across = across_of(ridge) if ridge.children else across_of(beneath)
    fill = element.one("fill", FILL)
    swinging = row if fill is None else fill
    corners = _against(swinging, context) if corners_swing and is_dotted else None
    swing = vibration(swinging, context, "dots" if is_dotted else "")
    row.skip("vibration")
    width = _profiled(ridge, width)
    if width < LEAST_MM:
        element.forget()
        element.say(f"stroke width is {width:g}, so there is no stroke")
        return StrokeLook(intensity, None, None)
    if is_dotted:
        speed = _speed(element, fill, None, context)
        if fill is not None:
            fill.skip("Grating", "gutter")
        dot = DotStyle(
            radius_mm=width / 2,
            edge_mm=edge,
            amplitude=row["height"],
            across=across,
            vibration=swing,
        )
        dots = Dotting(
            dot=dot,
            separation_mm=row["min_spacing"],
            vertex_vibration=corners,
            velocity_mm_s=speed,
        )
        return StrokeLook(intensity, None, dots, _cue(element, context))
    row.forget()
    stroke = _stroke(fill, context, Stroke(width_mm=width, edge_mm=edge, across=across), swing)
    along = None if stroke is None else stroke.along
    speed = _speed(element, fill, along, context)
    if stroke is not None and along is not None and speed:
        stroke = replace(stroke, along=replace(along, velocity_mm_s=speed))
    cue = _cue(element, context) if stroke is not None else None
    return StrokeLook(intensity, stroke, None, cue)


def _cue(stroke: GenElement, context: GenContext) -> MovingCue | None:
    """Bands that move along a shape; None for none."""
    motion = stroke.part("motion", CUE)
    way = _WAYS.get(motion["cue"])
    if way is None:
        motion.forget()
        return None
    share, level, width = motion["superposed_ratio"], motion["blend_value"], motion["min_width"]
    speed = motion["velocity"]
    grating = motion.part("Grating", BANDS)
    ridge, gap = grating["ridge_size"], grating["gap_size"]
    if not grating["enable"] or ridge < LEAST_MM:
        motion.forget()
        motion.say("its cue has no bands; left out")
        return None
    if grating["invert"]:
        grating.say("the bands of its cue are inverted, which they cannot be here")
    if grating.one("velocity") is not None:
        speed = speed_of(grating, "mm", ridge + gap)
    element = motion.one("vibration")
    swing = vibration(motion, context, "bands")
    if way == "vibrate" and swing is None and (context.as_shown or element is not None):
        way, level = "blend", 1.0  # what does not vibrate is up
    motion.forget()
    return MovingCue(
        way=way,
        ridge_mm=ridge,
        gap_mm=gap,
        velocity_mm_s=travelled(speed, ridge + gap, context),
        width_mm=width,
        share=share,
        level=level,
        vibration=swing,
        whole_cycles=False,
    )


def across_of(ridge: GenElement) -> Across | None:
    """Texture across a profile; None for none."""
    texture = ridge.part("texture", ACROSS)
    if not texture["enable"]:
        texture.forget()
        return None
    amplitude, cycles = texture["amplitude"], int(texture["nb_cycles"])
    return Across(amplitude=amplitude, cycles=2 * cycles + 1) if amplitude else None


def filling(shape: GenElement, context: GenContext) -> Fill | None:
    """Tell what fills a closed shape; None for nothing."""
    element = shape.part("fill_texture", FILL_TEXTURE)
    if not element["enable"]:
        element.forget()
        return None
    gap, fade = element["gap"], element["edge_size"]
    found = element.one("Pattern")
    # Without a texture OpenLatero takes one of its own.
    texture = LinearGrating(ridge_mm=8.0) if found is None else context.pattern(found)
    if texture is None:
        element.say("the fill is left out, since there is nothing of its texture to show")
        return None
    if gap < 0:
        return Fill(texture=texture, blended=True)
    return Fill(texture=texture, gap_mm=gap, fade_mm=fade)


def _profiled(ridge: GenElement, width: float) -> float:
    """Width of a stroke whose profile may have another one."""
    other = ridge.read("width", NumberField(width))
    if other != width:
        narrower = min(other, width)
        ridge.say(
            f"stroke ridge width is {other:g} and stroke width {width:g}; "
            f"the stroke is {narrower:g} mm wide here"
        )
        return narrower
    return width


def _stroke(
    fill: GenElement | None, context: GenContext, plain: Stroke, swing: Vibration | None
) -> Stroke | None:
    """Stroke with the texture along it; None if nothing of it can be felt."""
    along = None
    gutter = False
    if fill is not None:
        gutter = fill["gutter"]
        along = _along(fill)
    fits = plain.width_mm >= 4 * plain.edge
    if along is not None:
        along = replace(along, whole_edges=gutter and fits)
        return replace(plain, along=along, vibration=swing)
    if swing is not None and swing.of == "low":
        if gutter and fill is not None:
            fill.say("the middle of an outlined stroke does not vibrate here")
        swing = None  # there is nothing in it that is down
    if not gutter or fill is None:
        return replace(plain, vibration=swing)
    if fits:
        return replace(plain, outlined=True, vibration=swing)
    if context.as_shown:
        fill.say(
            "the outline needs a stroke of four edges, so OpenLatero shows nothing of the stroke, "
            "which hides what is below it there"
        )
        return None
    edge = plain.width_mm / 4
    fill.say(
        f"the outline needs a stroke of four edges, and OpenLatero shows nothing; "
        f"an edge of {edge:g} mm is taken"
    )
    return replace(plain, edge_mm=edge, outlined=True, vibration=swing)


def _along(fill: GenElement) -> Along | None:
    """Grating along a stroke; None for none."""
    grating = fill.part("Grating", ALONG)
    if not grating["enable"]:
        grating.forget()
        return None
    ridge, gap = grating["ridge_size"], grating["gap_size"]
    if ridge < LEAST_MM:
        grating.forget()
        grating.say(f"fill Grating has ridges of {ridge:g} mm, so the stroke has no texture here")
        return None
    if grating["invert"]:
        grating.say("fill Grating is inverted, which a texture along a stroke cannot be here")
    modulator = grating.one("PitchModulator")
    if modulator is not None:
        if modulator.read("enable", OFF):
            modulator.say("a texture along a stroke has the same lengths all along it here")
        modulator.forget()
    return Along(ridge_mm=ridge, gap_mm=gap, whole_cycles=False)


def _speed(
    stroke: GenElement, fill: GenElement | None, along: Along | None, context: GenContext
) -> float:
    """Speed of the texture along a stroke, or of the dots in its place, in mm/s."""
    own = 0.0
    if fill is not None and along is not None:
        own = speed_of(fill.part("Grating"), "mm", along.wave.length)
    motion = stroke.one("motion", CUE)
    if motion is None:
        return own if along is None else travelled(own, along.wave.length, context)
    cue = motion["cue"] if motion.one("cue") else None
    speed = motion["velocity"] if cue == "inherent" else 0.0
    # A speed alone is that of the cue "none", by which nothing moves.
    stands = cue is not None or motion.one("velocity") is not None
    shown = speed if cue == "inherent" else 0.0 if stands else own
    return shown if along is None else travelled(shown, along.wave.length, context)


def speed_of(grating: GenElement, unit: str, cycle: float, most: float = _MOST_SPEED) -> float:
    """Speed of a grating, in mm/s or °/s.

    Parameters
    ----------
    grating
        Element of the grating.
    unit
        "mm", or "°" for an axial grating.
    cycle
        Length of a ridge and a gap, which a speed in Hz counts.
    most
        Largest speed.
    """
    element = grating.one("velocity")
    if element is None:
        return 0.0
    in_hertz = element.units() == "Hz"
    speed = grating.read("velocity", ANGLE._replace(unit="Hz" if in_hertz else f"{unit}/s"))
    if in_hertz:
        speed *= cycle
    if abs(speed) > most:
        element.say(f"its ridges would move at {speed:g} {unit}/s; {most:g} is taken")
    return max(-most, min(most, speed))


def _against(above: GenElement, context: GenContext) -> Vibration:
    """Vibration of dots on vertices, which swing where the others do not."""
    element = above.part("vibration", VIBRATION)
    if element.children and element["enable"]:
        return Vibration(amplitude=0.0)
    return swung(element, context)


@ROWS.row("Line", start_point=ORIGIN, end_point=PlaceField(SURFACE_MM))
def _line(element: GenElement, context: GenContext) -> AnyPattern | None:
    start, end = element["start_point"], element["end_point"]
    look = drawn(element, context)
    if look.stroke is None and look.dots is None:
        return _nothing(element)
    made = StraightLine(
        start_mm=start,
        end_mm=end,
        amplitude=look.intensity,
        stroke=look.stroke,
        dots=look.dots,
        cue=look.cue,
    )
    _, rows = rows_of(made)
    return _paced(made, math.dist(start, end) + rows[0].pitch_mm, context) if rows else made


@ROWS.row("Circle", center=ORIGIN, radius=NumberField(100.0))
def _circle(element: GenElement, context: GenContext) -> AnyPattern | None:
    center, radius = element["center"], element["radius"]
    look = drawn(element, context)
    fill = _fill(element, context, look)
    if look.stroke is None and look.dots is None and fill is None:
        return _nothing(element)
    made = Circle(
        center_mm=center,
        radius_mm=radius,
        amplitude=look.intensity,
        stroke=look.stroke,
        dots=look.dots,
        cue=look.cue,
        fill=fill,
    )
    return _paced(made, math.tau * radius, context)


def _paced(
    shape: StraightLine | Circle, length_mm: float, context: GenContext
) -> StraightLine | Circle:
    """Shape whose dots, if they move, come round after whole microseconds, as they do there."""
    if shape.dots is None:
        return shape
    speed = travelled(shape.dots.velocity_mm_s, length_mm, context)
    return replace(shape, dots=replace(shape.dots, velocity_mm_s=speed))


@ROWS.row("Polygon")
def _polygon(element: GenElement, context: GenContext) -> AnyPattern | None:
    vertices = _vertices(element.part("vertices"))
    join = element.part("join", JOIN)
    straight, offset = join["type"] == "straight", join["rounding_offset"]
    corner = element.part("corner", CORNER)
    has_markers = corner["enable"]
    look = drawn(element, context, corners_swing=has_markers)
    markers = None
    if has_markers and look.stroke is not None:
        markers = _markers(corner, context, look)
    else:
        corner.forget()
    fill = _fill(element, context, look)
    if look.stroke is None and look.dots is None and fill is None:
        return _nothing(element)
    if len(vertices) > 2 and meeting_edges(vertices) is not None:
        return _path(element, vertices, look, fill, markers)
    made = Polygon(
        vertices_mm=vertices,
        join="straight" if straight else "rounded",
        rounding_offset_mm=offset,
        amplitude=look.intensity,
        stroke=look.stroke,
        dots=look.dots,
        cue=look.cue,
        fill=fill,
        markers=markers,
    )
    if look.stroke is not None and (markers is not None or (look.stroke.along and not straight)):
        _say_tight(element, made)
    if context.as_shown and look.dots is not None and look.dots.velocity_mm_s:
        element.say(
            "its dots come round after whole microseconds there, on each edge by itself; in 10 s "
            "they are up to 0.001 mm apart from those here"
        )
    return made


def _say_tight(element: GenElement, polygon: Polygon) -> None:
    """Say so if arcs at two corners overlap, which are smaller here."""
    wanted = rounding_radius_mm(polygon)
    if any(joint.radius_mm < wanted for joint in joints(polygon.vertices_mm, wanted)):
        element.say("an edge is too short for the round joints at its ends, which are smaller here")


def _path(
    element: GenElement,
    vertices: tuple[Point, ...],
    look: StrokeLook,
    fill: Fill | None,
    markers: VertexMarkers | None,
) -> PathShape:
    """Path for a polygon whose edges cross, which no polygon is here."""
    lost = " and its markers are left out" if markers is not None else ""
    element.say(f"its edges cross, so it is a path here; textures jump at its corners{lost}")
    return PathShape(
        contours_mm=(vertices,),
        closed=True,
        amplitude=look.intensity,
        stroke=look.stroke,
        dots=look.dots,
        cue=look.cue,
        fill=fill,
    )


@ROWS.row("Dot", "Dots", dot_radius=NumberField(100.0), height=SHARE)
def _dots(element: GenElement, context: GenContext) -> AnyPattern | None:
    one = element.attribute("type") == "Dot"
    places = element.every("dot")[: 1 if one else None]
    centers = tuple(ORIGIN.read(place) for place in places)
    if one and not centers:
        centers = ((0.0, 0.0),)
    if not centers:
        element.forget()
        element.say("it has no dots; left out")
        return None
    radius = element["dot_radius"]
    ridge = element.part("ridge", DOT_RIDGE)
    ridge.skip("width")  # the radius counts
    dot = DotStyle(
        radius_mm=radius,
        edge_mm=ridge["edge_width"],
        amplitude=element["height"],
        across=across_of(ridge),
        vibration=vibration(element, context, "dots"),
    )
    operation = "add" if one else operation_of(element, "add")
    if len(centers) > 1 and operation not in ("add", "max"):
        element.say(f'dots are put together by "maximum" here, and by "{operation}" there')
    elif operation == "add" and _touch(centers, 2 * radius):
        element.say("dots that overlap add up in OpenLatero, and the larger one counts here")
    return Dots(centers_mm=centers, dot=dot)


def operation_of(element: GenElement, default: str) -> str:
    """Name that OpenLatero has for how the parts of an element are put together."""
    operation = element.one("operation")
    if operation is None:
        return default
    # Old files have it as text.
    written = operation.attribute("type") or operation.text
    return operation.chosen(written, _OPERATIONS, default)


def _vertices(element: GenElement) -> tuple[Point, ...]:
    """Vertices of a polygon, without those that stand on the one before."""
    places = (ORIGIN.read(vertex) for vertex in element.every("vertex"))
    kept = [place for place, _ in groupby(places)]
    return tuple(kept[:-1] if len(kept) > 1 and kept[0] == kept[-1] else kept)


def _markers(corner: GenElement, context: GenContext, look: StrokeLook) -> VertexMarkers | None:
    """Markers at the vertices of a polygon."""
    span, kind, blend = corner["span"], corner["type"], corner["blend_size"]
    angle = corner["user_angle"] if span == "user specified" else 30.0
    if corner["blend"] == "in":
        corner.say("markers blend outwards here, not inwards")
    if look.cue is not None and not corner.read("motion", ON):
        corner.say("its cue goes over the markers here")
    swing = vibration(corner, context, "markers")
    stroke = look.stroke
    if kind == "invert vib" and stroke is not None:
        if stroke.along is not None or stroke.outlined:
            corner.say("markers are plain here, and have the texture of the stroke there")
        swing = Vibration() if stroke.vibration is None else None
    corner.forget()
    made = VertexMarkers(span=_SPANS[span], angle_deg=angle, blend_mm=blend)  # pyright: ignore[reportArgumentType]
    return replace(made, plain=True) if swing is None else replace(made, vibration=swing)


def _fill(element: GenElement, context: GenContext, look: StrokeLook) -> Fill | None:
    fill = filling(element, context)
    if fill is not None and fill.blended and look.dots is not None:
        element.say("dots stand in the place of the fill there, and are blended into it here")
    cue, stroke = look.cue, look.stroke
    if fill is None or cue is None or stroke is None or not context.as_shown:
        return fill
    if cue.way != "add" or stroke.width_mm < cue.width_mm:
        return fill
    if fill.blended:
        element.say("its superposed cue weakens all of the fill there, and only its stroke here")
        return fill
    # It weakens what is beyond the stroke, too.
    whole = Group(operation="maximum", parts=(fill.texture,), amplitude=1.0 - cue.share)
    return replace(fill, texture=whole)


def _nothing(element: GenElement) -> None:
    element.forget()
    element.say("nothing of it can be felt; left out")


def _touch(centers: tuple[Point, ...], apart: float) -> bool:
    """Tell whether two of many places are nearer than a distance."""
    if apart <= 0 or len(centers) < 2:
        return False
    if len(set(centers)) < len(centers):
        return True
    with needing_extras():
        from scipy.spatial import KDTree
    nearest, _ = KDTree(centers).query(centers, k=2)
    return bool(nearest[:, 1].min() < apart - 1e-9)
