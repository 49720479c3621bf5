"""Strokes as areas of ink where they are felt: textures, joints and markers.

The deflections of a stroke alone are computed all over its place, and what is above half of its
height is ink: so cuts meet at joints as the three ways of going round a corner have them, run on
into round ends, and stop at markers of each span (Lévesque 2009, 8.4.3, figs. 8.16-8.20). Textures
are at their full strength for that. On raised drawings the stroke is first made coarser where
fingers need it.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, cast

import numpy as np
from msgspec.structs import replace

from vbraille.pictures.hatching import vibration_pitch_mm
from vbraille.scene.bounds import bounds
from vbraille.scene.joints import joints, marker_half_angle_rad
from vbraille.scene.patterns import Circle, PathShape, Polygon
from vbraille.scene.scene import Scene
from vbraille.scene.shapes import StraightLine
from vbraille.scene.strokes import VertexMarkers

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.pictures.ink import Contours
    from vbraille.pictures.looks import InkLook
    from vbraille.scene.scene import Canvas
    from vbraille.scene.strokes import Stroke

AnyShape = StraightLine | Circle | Polygon | PathShape

_PIXELS_PER_MM, _MOST_PIXELS = 16.0, 4_000_000
_HALF = 0.5
_ROUNDING_MM = 1e-6
# How far off a line a place may be that is left out, and how often that may add up.
_TOLERANCE_MM, _PASSES = 0.002, 5
# When vibrations of 50 Hz are down: (eq. 8.1) for actuators of parity 0.
_DOWN_S = 0.015


def felt_contours(
    shape: AnyShape, canvas: Canvas, look: InkLook, dots_mm: NDArray[np.float64]
) -> Contours:
    """Draw lines around all of a shape's stroke that is above half of its height.

    Markers that are plain are up all over. Those that vibrate are, too, unless the drawing is
    raised: there they are left out, and so is what is too near to dots that stand for them.

    Parameters
    ----------
    shape
        A shape with a stroke.
    canvas
        The canvas that it is on.
    look
        The least sizes of what is drawn.
    dots_mm : float64[n, 2]
        Middles of dots that need a blank around them.
    """
    bare = _bare(shape, look)
    box = bounds(bare)
    assert box is not None  # a shape is somewhere
    left, right = max(box.left, 0.0), min(box.right, canvas.width_mm)
    top, bottom = max(box.top, 0.0), min(box.bottom, canvas.height_mm)
    if not (left < right and top < bottom):
        return ()
    per_mm = min(_PIXELS_PER_MM, math.sqrt(_MOST_PIXELS / ((right - left) * (bottom - top))))
    x_mm, y_mm = _places_mm(left, right, per_mm), _places_mm(top, bottom, per_mm)
    felt = _deflections(bare, canvas, x_mm, y_mm)
    for x, y in dots_mm:
        near = np.hypot(x_mm - x, (y_mm - y)[:, None])
        blank_mm = look.dot_mm / 2 + look.gap_mm
        # A ramp of two pixels, which is ½ at the edge of the blank.
        felt = np.minimum(felt, np.clip(_HALF + (near - blank_mm) * per_mm / 2, 0.0, 1.0))
    if look.raised:
        felt = _without_slivers(felt, look.line_mm * per_mm)
    return _contours(felt, x_mm, y_mm)


def marker_dots_mm(polygon: Polygon, look: InkLook) -> NDArray[np.float64]:
    """Places of the dots that stand for vibrating markers: on each vertex, and along its edges.

    They go as far along the edges as the share of the marker in the stroke is above a half
    there. It is that of `vbraille.render.machine.shapekernels.markers` in the middle of the stroke.

    Parameters
    ----------
    polygon
        A polygon with a stroke and markers.
    look
        The least sizes of what is drawn.

    Returns
    -------
    float64[n, 2]
        Middles of the dots.
    """
    assert polygon.stroke is not None
    assert polygon.markers is not None
    blend_mm, pitch_mm = polygon.markers.blend_mm, vibration_pitch_mm(look)
    vertices = polygon.vertices_mm
    found: list[NDArray[np.float64]] = []
    for number, corner in enumerate(joints(vertices, polygon.stroke.width_mm / 2)):
        at = np.array(corner.vertex_mm)
        found.append(at)
        half = marker_half_angle_rad(polygon.markers, corner.angle_rad)
        slope = math.sin(half + corner.angle_rad / 2)
        away_mm = math.dist(corner.vertex_mm, corner.pivot_mm)
        reach_mm = (away_mm * math.sin(half) - blend_mm / 2) / slope + blend_mm
        for other in (vertices[number - 1], vertices[(number + 1) % len(vertices)]):
            edge = np.array(other) - at
            length_mm = float(np.hypot(*edge))
            # Only the nearest vertex is asked, and its neighbour's dots need a blank, too.
            most_mm = min(reach_mm, (length_mm - pitch_mm) / 2)
            steps = np.arange(1, math.floor(most_mm / pitch_mm) + 1)
            for place in at + steps[:, None] * pitch_mm * edge / length_mm:
                # At a sharp corner those on one edge are near those on the other.
                if np.hypot(*(np.array(found) - place).T).min() > pitch_mm - _ROUNDING_MM:
                    found.append(place)
    return np.array(found)


def _bare(shape: AnyShape, look: InkLook) -> AnyShape:
    """Leave nothing of a shape but its stroke at full strength, with the least sizes of a look."""
    assert shape.stroke is not None
    stroke = _coarse(shape.stroke, look)
    plain = {"stroke": stroke, "amplitude": 1.0, "inverted": False, "vibration": None}
    if isinstance(shape, StraightLine):
        return replace(shape, **plain)
    if not isinstance(shape, Polygon):
        return replace(shape, fill=None, **plain)
    markers = shape.markers
    if markers is not None:
        swings = look.raised and not markers.plain
        markers = VertexMarkers(
            span=markers.span,
            angle_deg=markers.angle_deg,
            blend_mm=markers.blend_mm,
            plain=not swings,
        )
    return replace(shape, fill=None, markers=markers, **plain)


def _coarse(stroke: Stroke, look: InkLook) -> Stroke:
    """Make a stroke wide enough, and its cuts long enough and few enough, for a look."""
    edge, along, across = stroke.edge, stroke.along, stroke.across
    width = max(stroke.width_mm, look.line_mm + edge)
    if along is not None:
        # A cut is half as long as its ridge (eq. 8.4), and so is what is left beside it or more.
        length = along.ridge_mm + along.gap_mm
        ridge = max(along.ridge_mm, 2 * look.gap_mm)
        longer = length * math.ceil(ridge / length - 1e-9)
        whole = along.whole_edges and edge >= look.line_mm
        along = replace(
            along,
            ridge_mm=ridge,
            gap_mm=max(longer - ridge, 0.0),
            amplitude=1.0,
            whole_edges=whole and width - 3 * edge >= max(look.gap_mm, look.line_mm),
            velocity_mm_s=0.0,
        )
    return replace(
        stroke,
        width_mm=width,
        edge_mm=edge,
        amplitude=1.0,
        across=None if look.raised or across is None else replace(across, amplitude=1.0),
        along=along,
        vibration=None,
    )


def _places_mm(first: float, last: float, per_mm: float) -> NDArray[np.float64]:
    """Places from one to another and a little beyond both."""
    count = math.ceil((last - first) * per_mm) + 2
    return first + (np.arange(count, dtype=np.float64) - 0.5) / per_mm


def _deflections(
    shape: AnyShape, canvas: Canvas, x_mm: NDArray[np.float64], y_mm: NDArray[np.float64]
) -> NDArray[np.float32]:
    from vbraille.render.scene.canvas import SceneMap  # loads the kernels

    drawn = SceneMap(Scene(canvas=canvas, elements=(shape,)))
    return drawn.deflections(x_mm, y_mm, time_s=_DOWN_S)


def _without_slivers(felt: NDArray[np.floating], wide: float) -> NDArray[np.floating]:
    """Leave out what is thinner than so many pixels: tips and splinters that no paper shows."""
    from scipy.ndimage import distance_transform_edt  # takes half a second to load

    core = np.asarray(distance_transform_edt(felt >= _HALF)) >= wide / 2
    if not core.any():
        return np.zeros_like(felt)
    return np.where(np.asarray(distance_transform_edt(~core)) <= wide / 2 + 1.0, felt, 0.0)


def _contours(
    felt: NDArray[np.floating], x_mm: NDArray[np.float64], y_mm: NDArray[np.float64]
) -> Contours:
    from contourpy import FillType, contour_generator

    step = x_mm[1] - x_mm[0]
    x, y = (np.concatenate([[at[0] - step], at, [at[-1] + step]]) for at in (x_mm, y_mm))
    lines = contour_generator(x, y, np.pad(felt, 1), fill_type=FillType.OuterOffset)
    found = cast("tuple[list[NDArray], list[NDArray]]", lines.filled(_HALF, math.inf))
    return tuple(
        _simpler(part)
        for points, breaks in zip(*found, strict=True)
        for part in np.split(points, breaks[1:-1].astype(int))
    )


def _simpler(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Leave out places of a line that are hardly off the line between their neighbours.

    Every second place is asked, several times over, so that of a straight line few are left.
    """
    for _ in range(_PASSES):
        middle, before = points[1:-1:2], points[:-2:2]
        after = points[2::2]
        chord, way = after - before, middle - before
        area = np.abs(way[:, 0] * chord[:, 1] - way[:, 1] * chord[:, 0])
        kept = np.ones(len(points), bool)
        kept[1:-1:2] = area > _TOLERANCE_MM * np.hypot(*chord.T)
        points = points[kept]
    return points
