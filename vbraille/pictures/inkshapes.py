"""Shapes, dots and braille as ink: strokes as thick as they are felt, true to scale.

A stroke is drawn where it is above half of its height: ε/2 narrower at each side than it is wide
(eq. 8.7 of Lévesque 2009). Cuts of a texture along it are half as long as its ridges, for the same
reason. What vibrates is dotted.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from vbraille.braille.dots import PLACES
from vbraille.braille.geometry import STANDARD
from vbraille.pictures.hatching import dotted
from vbraille.pictures.ink import InkDiscs, InkLine
from vbraille.scene.dotting import dots_of
from vbraille.scene.fitting import stroke_cycles
from vbraille.scene.patterns import Circle, PathShape, Polygon
from vbraille.scene.shapes import StraightLine

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from vbraille.pictures.ink import Contours, PlainMark
    from vbraille.pictures.looks import InkLook
    from vbraille.render.scene.assets import Written
    from vbraille.scene.dots import Dots
    from vbraille.scene.fitting import Cycle
    from vbraille.scene.labels import Label
    from vbraille.scene.strokes import DotStyle, Stroke

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


def shape_marks(shape: AnyShape, look: InkLook, strength: float) -> Iterator[PlainMark]:
    """Draw the stroke or the dots of a shape, without its fill.

    Parameters
    ----------
    shape
        The shape.
    look
        The least sizes of what is drawn.
    strength
        Factor of its deflections, from 0 to 1.
    """
    if shape.dots is not None:
        style, swing = shape.dots.dot, shape.dots.vertex_vibration
        placed = dots_of(shape)
        for vertex in (False, True):
            centers = [(dot.x_mm, dot.y_mm) for dot in placed if dot.vertex == vertex]
            shakes = style.vibration is not None or (vertex and swing is not None)
            yield from _discs(np.array(centers), style, look, strength, shakes=shakes)
    if shape.stroke is not None:
        shakes = shape.vibration is not None or shape.stroke.vibration is not None
        for contour, cycle in zip(
            outline(shape), stroke_cycles(shape) or (None,) * len(outline(shape)), strict=True
        ):
            yield from _stroke(
                (contour,), shape.stroke, cycle, look, strength, is_closed(shape), shakes
            )
    if isinstance(shape, Polygon) and shape.markers is not None:
        radius = max((shape.stroke.width_mm if shape.stroke else 2.0) / 2, look.dot_mm / 2)
        yield InkDiscs(np.array(shape.vertices_mm), radius, look.ink(1.0))
        if shape.markers.swing is not None and not look.raised:
            yield InkDiscs(np.array(shape.vertices_mm), radius / 2, 1.0)


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
    cycle: Cycle | None,
    look: InkLook,
    strength: float,
    closed: bool,
    shakes: bool,
) -> Iterator[PlainMark]:
    whole, edge = stroke.width_mm, stroke.edge
    width = max(whole - edge, look.line_mm)
    ink = look.ink(strength * stroke.amplitude)
    length = _length_mm(contours[0]) if closed else None
    low = stroke.vibration is not None and stroke.vibration.of == "low"
    if look.raised and shakes and not low:
        dot = min(width, look.dot_mm)
        yield InkLine(contours, dot, ink, closed, dotted(dot, look, length))
        return
    yield InkLine(contours, width, ink, closed)
    inner = whole - 3 * edge  # between the edges of an outline
    if stroke.outlined and edge >= look.line_mm and inner >= max(look.gap_mm, look.line_mm):
        yield InkLine(contours, inner, 1.0, closed)
    along = stroke.along
    if along is not None and cycle is not None:
        cut = max(cycle.ridge / 2, look.gap_mm)
        cycle_mm = cycle.length * math.ceil((cut + look.line_mm) / cycle.length - 1e-9)
        cuts = max(inner, look.line_mm) if along.whole_edges and not look.raised else width
        blank = 1.0 if look.raised else 1.0 - (1.0 - ink) * (1.0 - along.amplitude)
        if low and not look.raised:
            blank = _SHAKING_CUT
        # A ridge of the grating begins where the path does, and its middle is cut.
        into = cycle_mm - max(cycle.ridge / 2 - cut / 2, 0.0)
        dashes = (cut, cycle_mm - cut)
        yield InkLine(contours, 1.02 * cuts, blank, closed, dashes, into, round_ends=False)
    if stroke.across is not None and not look.raised:
        yield InkLine(contours, 0.1 * width, 1.0, closed)
    if shakes and not low:
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
    radius = max(style.radius_mm - style.edge / 2, look.dot_mm / 2 if look.raised else 0.1)
    yield InkDiscs(centers_mm, radius, look.ink(strength * style.amplitude))
    if shakes and not look.raised:
        yield InkDiscs(centers_mm, radius / 2, 1.0)
