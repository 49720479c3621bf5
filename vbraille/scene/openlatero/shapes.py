"""Lines, circles, polygons and dots of OpenLatero's files."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from msgspec.structs import replace

from vbraille.scene.crossing import meeting_edges
from vbraille.scene.dots import Dots
from vbraille.scene.joints import joints, rounding_radius_mm
from vbraille.scene.measures import LEAST_MM, MOST_MM
from vbraille.scene.openlatero.context import SURFACE_MM, vibration
from vbraille.scene.openlatero.strokes import across_of, drawn, edge_of, filling
from vbraille.scene.patterns import Circle, PathShape, Polygon
from vbraille.scene.shapes import StraightLine
from vbraille.scene.strokes import DotStyle, VertexMarkers, Vibration

if TYPE_CHECKING:
    from vbraille.scene.measures import Point
    from vbraille.scene.openlatero.context import GenContext
    from vbraille.scene.openlatero.elements import GenElement
    from vbraille.scene.openlatero.strokes import StrokeLook
    from vbraille.scene.patterns import AnyPattern, Fill

_OPERATIONS = ("multiply", "add", "max", "blend", "overwrite", "reactive")
_LEAST_BLEND_MM = LEAST_MM
_SPANS = {
    "user specified": "angle",
    "arc": "arc",
    "circle intercept": "edges",
    "right-angled": "square",
}


def read_line(element: GenElement, context: GenContext) -> AnyPattern | None:
    """Line of an element; None if there is nothing to show.

    Raises
    ------
    ValueError
        If there can be no such line.
    """
    start = element.point("start_point", (0.0, 0.0))
    end = element.point("end_point", SURFACE_MM)
    look = drawn(element, context)
    if look.stroke is None and look.dots is None:
        return _nothing(element)
    return StraightLine(
        start_mm=start, end_mm=end, amplitude=look.intensity, stroke=look.stroke, dots=look.dots
    )


def read_circle(element: GenElement, context: GenContext) -> AnyPattern | None:
    """Circle of an element; None if there is nothing to show.

    Raises
    ------
    ValueError
        If there can be no such circle.
    """
    center = element.point("center", (0.0, 0.0))
    radius = element.number("radius", 100.0, 0.0, MOST_MM)
    look = drawn(element, context)
    fill = _fill(element, context, look)
    if look.stroke is None and look.dots is None and fill is None:
        return _nothing(element)
    return Circle(
        center_mm=center,
        radius_mm=radius,
        amplitude=look.intensity,
        stroke=look.stroke,
        dots=look.dots,
        fill=fill,
    )


def read_polygon(element: GenElement, context: GenContext) -> AnyPattern | None:
    """Polygon of an element; None if there is nothing to show.

    Raises
    ------
    ValueError
        If there can be no such polygon.
    """
    vertices = _vertices(element.part("vertices"))
    join = element.part("join")
    straight = join.word("type", ("straight", "round"), "round") == "straight"
    offset = join.number("rounding_offset", 0.0, 0.0, MOST_MM)
    corner = element.part("corner")
    has_markers = corner.switch("enable", False)
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
        fill=fill,
        markers=markers,
    )
    if look.stroke is not None and (markers is not None or (look.stroke.along and not straight)):
        _say_tight(element, made)
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
        fill=fill,
    )


def read_dots(element: GenElement, context: GenContext) -> AnyPattern | None:
    """Dots of an element; None if there are none.

    Raises
    ------
    ValueError
        If there can be no such dots.
    """
    one = element.attribute("type") == "Dot"
    places = element.every("dot")[: 1 if one else None]
    centers = tuple(place.place((0.0, 0.0)) for place in places)
    if one and not centers:
        centers = ((0.0, 0.0),)
    if not centers:
        element.forget()
        element.say("it has no dots; left out")
        return None
    radius = element.number("dot_radius", 100.0, 0.0, MOST_MM)
    height = element.number("height", 1.0, 0.0, 1.0, "share")
    ridge = element.part("ridge")
    ridge.skip("width")  # the radius counts
    dot = DotStyle(
        radius_mm=radius,
        edge_mm=edge_of(ridge, 0.2),
        amplitude=height,
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
    kept: list[Point] = []
    for vertex in element.every("vertex"):
        point = vertex.place((0.0, 0.0))
        if kept and kept[-1] == point:
            vertex.say("this vertex is where the one before is; left out")
        else:
            kept.append(point)
    if len(kept) > 1 and kept[0] == kept[-1]:
        element.say("the last vertex is where the first is; left out")
        kept.pop()
    return tuple(kept)


def _markers(corner: GenElement, context: GenContext, look: StrokeLook) -> VertexMarkers | None:
    """Markers at the vertices of a polygon."""
    span = corner.word("span", _SPANS, "circle intercept")
    kind = corner.word("type", ("solid", "invert vib"), "solid")
    angle = corner.number("user_angle", 30.0, 1.0, 180.0, "°") if span[0] == "u" else 30.0
    if corner.word("blend", ("in", "out"), "out") == "in":
        corner.say("markers blend outwards here, not inwards")
    blend = corner.number("blend_size", 1.0, _LEAST_BLEND_MM, MOST_MM)
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
    return fill


def _nothing(element: GenElement) -> None:
    element.forget()
    element.say("nothing of it can be felt; left out")


def _touch(centers: tuple[Point, ...], apart: float) -> bool:
    """Whether two of many places are nearer than a distance."""
    cells: dict[tuple[int, int], list[Point]] = {}
    if apart <= 0:
        return False
    for x, y in centers:
        column, row = math.floor(x / apart), math.floor(y / apart)
        for i in (column - 1, column, column + 1):
            for j in (row - 1, row, row + 1):
                for other in cells.get((i, j), ()):
                    if math.dist(other, (x, y)) < apart - 1e-9:
                        return True
        cells.setdefault((column, row), []).append((x, y))
    return False
