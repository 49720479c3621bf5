"""Shapes, dots and braille as ink: strokes as thick as they are felt, true to scale.

A stroke is drawn where it is above half of its height: ε/2 narrower at each side than it is wide
(eq. 8.7 of Lévesque 2009). Strokes with a texture along them or with markers are drawn by
`inkfelt`, where they are felt. What vibrates is dotted.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import replace

from vbraille.braille.dots import PLACES
from vbraille.braille.geometry import STANDARD
from vbraille.pictures.hatching import dotted
from vbraille.pictures.ink import InkArea, InkDiscs, InkLine
from vbraille.pictures.inkfelt import felt_contours, marker_dots_mm
from vbraille.scene.dotting import dots_of
from vbraille.scene.patterns import Circle, PathShape, Polygon
from vbraille.scene.shapes import StraightLine

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from vbraille.pictures.ink import Contours, PlainMark
    from vbraille.pictures.looks import InkLook
    from vbraille.render.scene.assets import Written
    from vbraille.scene.dots import Dots
    from vbraille.scene.labels import Label
    from vbraille.scene.scene import Canvas
    from vbraille.scene.strokes import DotStyle, Dotting, Stroke

AnyShape = StraightLine | Circle | Polygon | PathShape
_SHAKING_CUT = 0.7  # gray of what is down in a stroke and vibrates
_ERROR_MM = 0.01  # of the edges that stand for a circle


def outline(shape: AnyShape) -> Contours:
    """Places of a shape's path, for each contour."""
    match shape:
        case StraightLine():
            return (np.array([shape.start_mm, shape.end_mm]),)
        case Circle():
            step = 2 * math.acos(max(1 - _ERROR_MM / shape.radius_mm, -1.0))
            angles = np.arange(0.0, math.tau - 1e-9, math.tau / max(math.ceil(math.tau / step), 8))
            ring = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
            return (np.array(shape.center_mm) + shape.radius_mm * ring,)
        case Polygon():
            return (np.array(shape.vertices_mm),)
        case PathShape():
            return tuple(map(np.array, shape.contours_mm))


def is_closed(shape: AnyShape) -> bool:
    """Whether a shape's path goes back to its beginning."""
    return isinstance(shape, Circle | Polygon) or (isinstance(shape, PathShape) and shape.closed)


def shape_marks(
    shape: AnyShape, canvas: Canvas, look: InkLook, strength: float
) -> Iterator[PlainMark]:
    """Draw the stroke or the dots of a shape, without its fill.

    Parameters
    ----------
    shape
        The shape.
    canvas
        The canvas that it is on.
    look
        The least sizes of what is drawn.
    strength
        Factor of its deflections, from 0 to 1.
    """
    if shape.dots is not None:
        yield from _dotted_marks(shape, shape.dots, look, strength)
    if shape.stroke is None:
        return
    if _is_textured(shape, shape.stroke, look):
        yield from _felt_marks(shape, shape.stroke, canvas, look, strength)
    else:
        shakes = shape.vibration is not None or shape.stroke.vibration is not None
        for contour in outline(shape):
            yield from _stroke((contour,), shape.stroke, look, strength, is_closed(shape), shakes)


def _is_textured(shape: AnyShape, stroke: Stroke, look: InkLook) -> bool:
    """Whether a stroke has more to draw than a line; stripes along it are too fine for fingers."""
    marked = isinstance(shape, Polygon) and shape.markers is not None
    return stroke.along is not None or marked or (stroke.across is not None and not look.raised)


def _dotted_marks(
    shape: AnyShape, dotting: Dotting, look: InkLook, strength: float
) -> Iterator[PlainMark]:
    """Draw the dots of a dotted shape, as far apart as a look needs them."""
    style, swing = dotting.dot, dotting.vertex_vibration
    apart_mm = 2 * (_dot_radius_mm(style, look) - style.radius_mm) + look.gap_mm
    placed = dots_of(
        replace(shape, dots=replace(dotting, separation_mm=max(dotting.separation_mm, apart_mm)))
    )
    for vertex in (False, True):
        centers = [(dot.x_mm, dot.y_mm) for dot in placed if dot.vertex == vertex]
        shakes = style.vibration is not None or (vertex and swing is not None)
        yield from _discs(np.array(centers), style, look, strength, shakes=shakes)


def _felt_marks(
    shape: AnyShape, stroke: Stroke, canvas: Canvas, look: InkLook, strength: float
) -> Iterator[PlainMark]:
    """Draw a stroke with a texture along it or with markers, as areas where it is felt."""
    edge, ink = stroke.edge, look.ink(strength * stroke.amplitude)
    closed, contours = is_closed(shape), outline(shape)
    low = stroke.vibration is not None and stroke.vibration.of == "low"
    shakes = not low and (shape.vibration is not None or stroke.vibration is not None)
    markers = shape.markers if isinstance(shape, Polygon) else None
    dots_mm = np.zeros((0, 2))
    if isinstance(shape, Polygon) and markers is not None and markers.swing is not None:
        dots_mm = marker_dots_mm(shape, look)
    width = max(stroke.width_mm - edge, look.line_mm)
    if look.raised and shakes:
        for contour in contours:
            yield from _stroke((contour,), stroke, look, strength, closed, shakes)
        return
    textures = [texture for texture in (stroke.along, stroke.across) if texture is not None]
    if textures:
        depth = 1.0 if look.raised else max(texture.amplitude for texture in textures)
        blank = 1.0 - (1.0 - ink) * (1.0 - depth)
        if low and not look.raised:
            blank = _SHAKING_CUT
        yield InkLine(contours, width, blank, closed)
    areas = felt_contours(shape, canvas, look, dots_mm if look.raised else dots_mm[:0])
    if areas:
        yield InkArea(areas, ink)
    dot = min(look.dot_mm, width if look.raised else 0.5 * width)
    if shakes:
        for contour in contours:
            length = _length_mm(contour) if closed else None
            yield InkLine((contour,), dot, 1.0, closed, dotted(dot, look, length))
    if len(dots_mm):
        yield InkDiscs(dots_mm, dot / 2, ink if look.raised else 1.0)


def dots_marks(dots: Dots, look: InkLook, strength: float) -> Iterator[PlainMark]:
    """Draw dots as discs, or as rings if they vibrate and the look has grays."""
    shakes = dots.vibration is not None or dots.dot.vibration is not None
    yield from _discs(np.array(dots.centers_mm), dots.dot, look, strength, shakes=shakes)


def label_marks(
    label: Label, written: Written, look: InkLook, strength: float
) -> Iterator[PlainMark]:
    """Draw the dots of braille, on raised drawings at the distances that are standard on paper."""
    geometry, scale = written.style.geometry, look.scale
    if look.raised:
        geometry = STANDARD
    else:
        scale = 1.0
    angle = math.radians(label.angle_deg)
    along = np.array([math.cos(angle), math.sin(angle)])
    down = np.array([-along[1], along[0]])
    half = geometry.dot_width_mm / 2
    centers = []
    for line, masks in enumerate(written.lines):
        for cell, mask in enumerate(masks.tolist()):
            for dot, (side, row) in PLACES.items():
                if mask >> (dot - 1) & 1:
                    u = cell * geometry.cell_pitch_mm + side * geometry.dot_spacing_mm + half
                    v = line * geometry.line_pitch_mm + row * geometry.row_spacing_mm + half
                    centers.append((u * along + v * down) / scale)
    if centers:
        radius = 0.3 * geometry.dot_width_mm if look.label_dot_mm is None else look.label_dot_mm / 2
        yield InkDiscs(np.array(label.place_mm) + np.array(centers), radius, look.ink(strength))


def _stroke(
    contours: Contours,
    stroke: Stroke,
    look: InkLook,
    strength: float,
    closed: bool,
    shakes: bool,
) -> Iterator[PlainMark]:
    """Draw a stroke without a texture along it as a line, or as dots if it vibrates."""
    whole, edge = stroke.width_mm, stroke.edge
    width = max(whole - edge, look.line_mm)
    ink = look.ink(strength * stroke.amplitude)
    length = _length_mm(contours[0]) if closed else None
    if look.raised and shakes:
        dot = min(width, look.dot_mm)
        yield InkLine(contours, dot, ink, closed, dotted(dot, look, length))
        return
    yield InkLine(contours, width, ink, closed)
    inner = whole - 3 * edge  # between the edges of an outline
    if stroke.outlined and edge >= look.line_mm and inner >= max(look.gap_mm, look.line_mm):
        yield InkLine(contours, inner, 1.0, closed)
    if shakes:
        dot = min(look.dot_mm, 0.5 * width)
        yield InkLine(
            contours, dot, ink if stroke.outlined else 1.0, closed, dotted(dot, look, length)
        )


def _length_mm(contour: NDArray[np.float64]) -> float:
    """Length of a closed contour."""
    return float(np.hypot(*(np.roll(contour, -1, axis=0) - contour).T).sum())


def _discs(
    centers_mm: NDArray[np.float64],
    style: DotStyle,
    look: InkLook,
    strength: float,
    *,
    shakes: bool,
) -> Iterator[PlainMark]:
    if not len(centers_mm):
        return
    radius = _dot_radius_mm(style, look)
    yield InkDiscs(centers_mm, radius, look.ink(strength * style.amplitude))
    if shakes and not look.raised:
        yield InkDiscs(centers_mm, radius / 2, 1.0)


def _dot_radius_mm(style: DotStyle, look: InkLook) -> float:
    """Radius at which a dot is half as high, or the least that is drawn."""
    return max(style.radius_mm - style.edge / 2, look.dot_mm / 2 if look.raised else 0.1)
