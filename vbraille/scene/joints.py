"""Corners of polygons, and whole cycles of textures on paths that close.

Where strokes meet at a corner, and how a texture along them goes round, is of Lévesque 2009, 8.4.3,
figs. 8.18-8.20; the arithmetic is that of its author's later code.

Lévesque 2009, 8.4.1 and 8.4.3, asks for a whole number of cycles and does not say how. The rule is
that of its author's later code: the number of cycles is the nearest whole one; without a gap the
ridge changes; with a gap the gap alone changes if there is still room for one, or else both.
"""

from __future__ import annotations

import itertools
import math
from typing import TYPE_CHECKING, NamedTuple

from vbraille.scene.patterns import Circle, Polygon

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vbraille.scene.measures import Point
    from vbraille.scene.patterns import Shape
    from vbraille.scene.strokes import Along, MovingCue, VertexMarkers
    from vbraille.scene.textures import AxialGrating, TurnPeak


class Joint(NamedTuple):
    """A corner of a closed polygon, with the arc round which a texture along the stroke goes.

    Parameters
    ----------
    vertex_mm
        Place of the corner.
    angle_rad
        Angle θ between its two edges, 0 to π.
    reach_mm
        Distance s from the corner, along both edges, at which the arc begins and ends.
    radius_mm
        Radius R' of the arc, which touches both edges.
    pivot_mm
        Middle of the arc: the place where the inner edges of strokes meet whose half width is R'.
    inward : tuple[float, float]
        Direction from the corner to the pivot, of length 1.
    onward : tuple[float, float]
        Direction at right angles to it, of length 1, on the side of the edge after the corner.
    """

    vertex_mm: Point
    angle_rad: float
    reach_mm: float
    radius_mm: float
    pivot_mm: Point
    inward: Point
    onward: Point

    @property
    def arc_mm(self) -> float:
        """Length of the arc, (π - θ) R'."""
        return (math.pi - self.angle_rad) * self.radius_mm


def joint(before_mm: Point, vertex_mm: Point, after_mm: Point, radius_mm: float) -> Joint:
    """Compute the corner between two edges.

    With θ the angle between the edges the arc begins s = R' / tan(θ/2) from the corner, and its
    middle lies on the bisector √(s² + R'²) from it. Where an edge is too short for the arcs at its
    two ends, R' is smaller, so that none reaches beyond the middle of an edge; this is ours.

    Parameters
    ----------
    before_mm, vertex_mm, after_mm
        The corner, and the corners before and after it; no two that follow are one place.
    radius_mm
        Radius R' that the arc would have if there were room: half of the stroke's width and the
        rounding offset.
    """
    x, y = vertex_mm
    ux, uy = before_mm[0] - x, before_mm[1] - y
    vx, vy = after_mm[0] - x, after_mm[1] - y
    turn = math.atan2(ux * vy - uy * vx, ux * vx + uy * vy)  # from the edge before to that after
    middle = math.atan2(uy, ux) + turn / 2
    inward = (math.cos(middle), math.sin(middle))
    side = math.copysign(1.0, turn)
    onward = (-side * inward[1], side * inward[0])
    room = min(math.hypot(ux, uy), math.hypot(vx, vy)) / 2
    tangent = math.tan(abs(turn) / 2)
    if radius_mm < room * tangent:
        reach = radius_mm / tangent
    else:
        reach, radius_mm = room, room * tangent
    away = math.hypot(reach, radius_mm)
    pivot = (x + away * inward[0], y + away * inward[1])
    return Joint(vertex_mm, abs(turn), reach, radius_mm, pivot, inward, onward)


def joints(vertices_mm: Sequence[Point], radius_mm: float) -> tuple[Joint, ...]:
    """Compute the corners of a closed polygon, in the order of its vertices."""
    count = len(vertices_mm)
    return tuple(
        joint(vertices_mm[i - 1], vertices_mm[i], vertices_mm[(i + 1) % count], radius_mm)
        for i in range(count)
    )


def rounding_radius_mm(polygon: Polygon) -> float:
    """Radius R' of a polygon's rounded corners: half of its stroke's width, and the offset.

    A cue that is wider than the stroke counts as the stroke does.
    """
    width_mm = 0.0 if polygon.stroke is None else polygon.stroke.width_mm
    return max(width_mm, polygon.cue_width_mm) / 2 + polygon.rounding_offset_mm


def edge_lengths_mm(points_mm: Sequence[Point], *, closed: bool) -> list[float]:
    """Compute the lengths of the edges between points, the last one back to the first if closed."""
    lengths = [math.dist(a, b) for a, b in itertools.pairwise(points_mm)]
    return [*lengths, math.dist(points_mm[-1], points_mm[0])] if closed else lengths


def places_along_mm(polygon: Polygon) -> tuple[float, ...]:
    """Compute how far along a polygon's path each of its corners is, and the whole length last.

    With straight joins the corners are places of the path. With rounded ones the path is shorter:
    it goes along the arcs, whose middles these places are. The first is at 0.
    """
    lengths = edge_lengths_mm(polygon.vertices_mm, closed=True)
    if polygon.join == "rounded":
        corners = joints(polygon.vertices_mm, rounding_radius_mm(polygon))
        saved = [corner.arc_mm / 2 - corner.reach_mm for corner in corners]
        lengths = [
            length + saved[i] + saved[(i + 1) % len(saved)] for i, length in enumerate(lengths)
        ]
    places = [0.0]
    for length in lengths:
        places.append(places[-1] + length)
    return tuple(places)


def marker_half_angle_rad(markers: VertexMarkers, angle_rad: float) -> float:
    """Half of the angle that a marker spans, seen from the place where the inner edges meet.

    Lévesque 2009, fig. 8.20, as angles in its author's later code: the angle given, but no more
    than the larger of the next two; π - θ, square to the edges; θ, where the strokes' edges go on;
    or the angle under which that place sees the ends of the round arc about the corner.
    """
    if markers.span == "square":
        return (math.pi - angle_rad) / 2
    if markers.span == "edges":
        return angle_rad / 2
    if markers.span == "arc":
        sine, cosine = math.sin(angle_rad / 2), math.cos(angle_rad / 2)
        return math.atan2(sine * cosine, 1 + sine * sine)
    return min(math.radians(markers.angle_deg), max(angle_rad, math.pi - angle_rad)) / 2


TURN_DEG = 360.0


class Cycle(NamedTuple):
    """Lengths of a grating's ridge and of the gap after it, in mm or in degrees."""

    ridge: float
    gap: float

    @property
    def length(self) -> float:
        """Length λ of the cycle."""
        return self.ridge + self.gap


def fitted(cycle: Cycle, length: float) -> Cycle:
    """Change a cycle a little, so that a whole number of it, at least one, fills a length."""
    cycles = max(1, math.floor(length / cycle.length + 0.5))
    new = length / cycles
    if cycle.gap == 0.0:
        return Cycle(new, 0.0)
    if new > cycle.ridge:
        return Cycle(cycle.ridge, new - cycle.ridge)
    factor = new / cycle.length
    return Cycle(cycle.ridge * factor, cycle.gap * factor)


def path_lengths_mm(shape: Shape) -> tuple[float, ...]:
    """Compute the length of a shape's path, or of each of a path's contours.

    A circle has 2πR; a polygon what is left of its edges between its corners and, if they are
    rounded, the arcs round them.
    """
    if isinstance(shape, Circle):
        return (math.tau * shape.radius_mm,)
    if isinstance(shape, Polygon):
        return (places_along_mm(shape)[-1],)
    contours, closed = shape.outline
    return tuple(sum(edge_lengths_mm(contour, closed=closed)) for contour in contours)


def stroke_cycles(shape: Shape) -> tuple[Cycle, ...]:
    """Compute the cycles that a texture along a shape's stroke has, one for each contour.

    Where the path is open, or the texture wants no whole cycles, they are as they were written.
    Without a texture along the stroke there are none.
    """
    along = None if shape.stroke is None else shape.stroke.along
    return () if along is None else _along(shape, along)


def cue_cycle(shape: Shape) -> Cycle:
    """Compute the cycle of the bands of a shape's cue."""
    cue = shape.cue
    assert cue is not None
    cycle, *others = _along(shape, cue)
    return Cycle(cue.ridge_mm, cue.gap_mm) if others else cycle


def _along(shape: Shape, grating: Along | MovingCue) -> tuple[Cycle, ...]:
    cycle = Cycle(grating.ridge_mm, grating.gap_mm)
    _, closed = shape.outline
    whole = grating.whole_cycles and closed
    return tuple(fitted(cycle, length) if whole else cycle for length in path_lengths_mm(shape))


def axial_cycle(grating: AxialGrating) -> Cycle:
    """Compute the cycle that an axial grating has, in degrees.

    With a distortion the cycles fill what the turn is then: the difference of x' (eq. 8.6) at its
    end and at its beginning.
    """
    cycle = Cycle(grating.ridge_deg, grating.gap_deg)
    if not grating.whole_cycles:
        return cycle
    peak = grating.distortion
    turn = TURN_DEG if peak is None else _distorted(TURN_DEG, peak) - _distorted(0.0, peak)
    return fitted(cycle, turn)


def _distorted(x: float, peak: TurnPeak) -> float:
    """X' of eq. 8.6: x and (K - 1) times the area of the tent over the part up to x."""
    length, u = peak.length_deg, x - peak.center_deg
    if u <= 0.0:
        tent = max(0.0, length + u) ** 2
    else:
        tent = 2 * length * length - max(0.0, length - u) ** 2
    return x + (peak.factor - 1.0) * tent / (2 * length)
