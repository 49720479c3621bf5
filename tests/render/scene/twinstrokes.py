"""Strokes, dots and the coordinates of shapes in plain numpy, straight from the equations.

Lévesque 2009, 8.4.3 and 8.4.4. It is slow and plain on purpose; the tests hold the kernels to it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tests.render.scene.twinwaves import (
    ActuatorPlaces,
    Values,
    moved_on,
    ridges,
    share_left,
    vibrated,
)
from vbraille.scene.geometry import (
    Joint,
    PlacedDot,
    cue_cycle,
    dots_of,
    joints,
    marker_half_angle_rad,
    places_along_mm,
    rounding_radius_mm,
    rows_of,
    stroke_cycles,
)
from vbraille.scene.patterns import Circle, PathShape, Polygon, StraightLine

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from vbraille.scene.geometry import Cycle, DotRow
    from vbraille.scene.measures import Point
    from vbraille.scene.patterns import (
        Across,
        Along,
        DotStyle,
        MovingCue,
        Stroke,
        VertexMarkers,
        Vibration,
    )

AnyShape = StraightLine | Circle | Polygon | PathShape


# Profiles


def profile(r: Values, width: float, edge: float) -> Values:
    """Compute eq. 8.7 with k = 1: up in the middle, down to rest over the edge ε."""
    flat = width / 2 - edge
    falling = 0.5 + 0.5 * np.cos(math.pi * (np.abs(r) - flat) / edge)
    return np.select([np.abs(r) < flat, np.abs(r) < width / 2], [1.0, falling], 0.0)


def groove(r: Values, width: float, edge: float) -> Values:
    """Compute γ_o of eq. 8.9, with cos where the print has sin: what an outline leaves out."""
    flat = width / 2 - 2 * edge
    falling = 0.5 + 0.5 * np.cos(math.pi * (np.abs(r) - flat) / edge)
    return np.select([np.abs(r) < flat, np.abs(r) < width / 2 - edge], [1.0, falling], 0.0)


def textured(plain: Values, r: Values, width: float, across: Across | None) -> Values:
    """Compute eq. 8.10 with k = 1: n cycles across the width, within it alone."""
    if across is None:
        return plain
    k_t, n = across.amplitude, across.cycles
    wave = 0.5 + 0.5 * np.cos(math.tau * r * n / width)
    return np.where(np.abs(r) < width / 2, (1 - k_t) * plain + k_t * wave, 0.0)


# Coordinates


@dataclass(frozen=True, slots=True, eq=False)
class Coordinates:
    """Where places are, seen from a path.

    Parameters
    ----------
    across_mm : float64[n]
        Distance r from the path.
    along_mm : float64[n]
        Place l along it.
    contour : int64[n]
        Number of the contour that is nearest.
    edge : int64[n]
        Number of the edge of that contour that is nearest.
    """

    across_mm: Values
    along_mm: Values
    contour: NDArray[np.int64]
    edge: NDArray[np.int64]


def coordinates(shape: AnyShape, at: ActuatorPlaces) -> Coordinates:
    """Compute the coordinates of places, seen from a shape: eqs. 8.15-8.19 and fig. 8.18."""
    if isinstance(shape, Circle):
        return _of_circle(shape, at)
    if isinstance(shape, StraightLine):
        return _of_contour((shape.start_mm, shape.end_mm), at, closed=False)
    if isinstance(shape, Polygon):
        seen = _of_contour(shape.vertices_mm, at, closed=True)
        return _rounded(shape, seen, at) if shape.join == "rounded" else seen
    contours = [_of_contour(points, at, closed=shape.closed) for points in shape.contours_mm]
    nearest = np.argmin([seen.across_mm for seen in contours], axis=0)
    return Coordinates(
        np.choose(nearest, [seen.across_mm for seen in contours]),
        np.choose(nearest, [seen.along_mm for seen in contours]),
        nearest,
        np.choose(nearest, [seen.edge for seen in contours]),
    )


def _of_circle(circle: Circle, at: ActuatorPlaces) -> Coordinates:
    """Compute eqs. 8.18 and 8.19; the angle is from 0 to 2π, and so begins to the right."""
    dx, dy = at.from_point(*circle.center_mm)
    across = np.abs(np.hypot(dx, dy) - circle.radius_mm)
    along = circle.radius_mm * np.mod(np.arctan2(dy, dx), math.tau)
    none = np.zeros(across.shape, np.int64)
    return Coordinates(across, along, none, none)


def _of_contour(points: Sequence[Point], at: ActuatorPlaces, *, closed: bool) -> Coordinates:
    """Compute eqs. 8.15-8.17 for the nearest of the lines between points.

    Where a corner is the nearest place, two lines are; then it is the one on whose side of the
    corner's bisector the place is.
    """
    ends = [*points[1:], points[0]] if closed else list(points[1:])
    start = np.array(points[: len(ends)], np.float64)
    edges = np.array(ends, np.float64) - start
    lengths = np.hypot(edges[:, 0], edges[:, 1])
    units = edges / lengths[:, None]
    dx, dy = at.x_mm - start[:, :1], at.y_mm - start[:, 1:]
    along = dx * units[:, :1] + dy * units[:, 1:]  # of each line, not clamped: 8.17
    nearest = np.clip(along, 0.0, lengths[:, None])
    r = np.hypot(dx - nearest * units[:, :1], dy - nearest * units[:, 1:])
    edge = np.argmin(r, axis=0)
    every = np.arange(edge.size)
    count = len(lengths)
    at_end, at_start = along[edge, every] >= lengths[edge], along[edge, every] <= 0.0
    before = np.where(at_end, edge, edge - 1)
    after = before + 1
    if closed:
        before, after = before % count, after % count
        shared = at_end | at_start
    else:
        shared = (at_end & (edge < count - 1)) | (at_start & (edge > 0))
        before, after = np.clip(before, 0, count - 1), np.clip(after, 0, count - 1)
    turn = units[before] + units[after]
    side = dx[after, every] * turn[:, 0] + dy[after, every] * turn[:, 1]
    edge = np.where(shared, np.where(side < 0, before, after), edge)
    places = np.concatenate([[0.0], np.cumsum(lengths)[:-1]])
    contour = np.zeros(edge.size, np.int64)
    return Coordinates(np.min(r, axis=0), places[edge] + along[edge, every], contour, edge)


def _rounded(polygon: Polygon, seen: Coordinates, at: ActuatorPlaces) -> Coordinates:
    """Let l go along an arc at each joint, with the angle about its pivot: fig. 8.18."""
    corners = joints(polygon.vertices_mm, rounding_radius_mm(polygon))
    places = places_along_mm(polygon)
    count = len(corners)
    along = np.empty(seen.along_mm.shape)
    straight = 0.0
    for i, corner in enumerate(corners):
        following = corners[(i + 1) % count]
        length = math.dist(corner.vertex_mm, following.vertex_mm)
        here = seen.edge == i
        t = seen.along_mm - straight
        along[here] = (places[i] + corner.arc_mm / 2 + t - corner.reach_mm)[here]
        first = here & (t < corner.reach_mm)
        along[first] = (places[i] + _round_arc(corner, at))[first]
        last = here & ~first & (t > length - following.reach_mm)
        along[last] = (places[i + 1] + _round_arc(following, at))[last]
        straight += length
    return Coordinates(seen.across_mm, along, seen.contour, seen.edge)


def _round_arc(corner: Joint, at: ActuatorPlaces) -> Values:
    """Distance along a joint's arc from its middle: R' times the angle about the pivot."""
    dx, dy = at.from_point(*corner.pivot_mm)
    onward = dx * corner.onward[0] + dy * corner.onward[1]
    outward = -(dx * corner.inward[0] + dy * corner.inward[1])
    half = (math.pi - corner.angle_rad) / 2
    return corner.radius_mm * np.clip(np.arctan2(onward, outward), -half, half)


def is_inside(shape: AnyShape, at: ActuatorPlaces) -> NDArray[np.bool_]:
    """Tell which places are inside a closed shape, by the even-odd rule."""
    if isinstance(shape, Circle):
        return np.hypot(*at.from_point(*shape.center_mm)) < shape.radius_mm
    inside = np.zeros(at.x_mm.shape, bool)
    if isinstance(shape, StraightLine):
        return inside
    contours = (shape.vertices_mm,) if isinstance(shape, Polygon) else shape.contours_mm
    for points in contours:
        for i, (x1, y1) in enumerate(points):
            x0, y0 = points[i - 1]
            if y0 != y1:
                crossing = x0 + (at.y_mm - y0) * (x1 - x0) / (y1 - y0)
                inside ^= ((y0 > at.y_mm) != (y1 > at.y_mm)) & (at.x_mm < crossing)
    return inside


# Strokes


def stroke_profile(stroke: Stroke, r: Values) -> Values:
    """Compute eq. 8.7 at full amplitude: the opacity of a stroke, and what hides a fill."""
    return profile(r, stroke.width_mm, stroke.edge)


def stroke_deflection(shape: AnyShape, stroke: Stroke, at: ActuatorPlaces) -> Values:
    """Compute eqs. 8.7-8.14 and the markers of figs. 8.19 and 8.20."""
    seen = coordinates(shape, at)
    r, width = seen.across_mm, stroke.width_mm
    up = textured(stroke_profile(stroke, r), r, width, stroke.across)
    texture = np.ones(r.shape)
    if stroke.outlined:
        texture = 1 - groove(r, width, stroke.edge)  # 8.8
    swing = stroke.vibration
    if stroke.along is not None:
        moved_s = at.moved_s(stroke.along.velocity_by)
        cut = _cut(stroke.along, stroke_cycles(shape), seen, moved_s)
        if stroke.along.whole_edges:
            cut = groove(r, width, stroke.edge) * cut  # 8.12
        if swing is not None and swing.of == "low":
            cut = cut * share_left(at, swing)  # 8.14
        texture = 1 - cut  # 8.11
    if swing is not None and swing.of == "high":
        texture = texture * share_left(at, swing)  # 8.13
    if isinstance(shape, Polygon) and shape.markers is not None:
        share = marked(shape, shape.markers, width, seen, at)
        marker = vibrated(np.ones(r.shape), at, shape.markers.swing)
        texture = (1 - share) * texture + share * marker
    if shape.cue is not None and not shape.is_cued_over:
        texture = cued(texture, shape.cue, bands(shape, shape.cue, seen, at), at)
    return stroke.amplitude * up * texture


def bands(shape: AnyShape, cue: MovingCue, seen: Coordinates, at: ActuatorPlaces) -> Values:
    """Compute the bands m of a cue, fig. 9.3: a grating along the path."""
    cycle = cue_cycle(shape)
    moved_s = at.moved_s(cue.velocity_by)
    return ridges(moved_on(seen.along_mm, cycle, cue.velocity_mm_s, moved_s), cycle)


def cued(below: Values, cue: MovingCue, m: Values, at: ActuatorPlaces) -> Values:
    """Put bands over a deflection in one of the four ways of 9.3."""
    swing = vibrated(np.ones(m.shape), at, cue.swing)
    match cue.way:
        case "vibrate":
            return (1 - m) * below + m * swing
        case "blend":
            return (1 - m) * below + m * cue.level
        case "mask":
            return below * (1 - m * swing)
        case "add":
            return (1 - cue.share) * below + cue.share * m * swing


def cue_profile(shape: AnyShape, seen: Coordinates) -> Values:
    """Profile of a cue that goes over a finished shape."""
    return profile(seen.across_mm, shape.cue_width_mm, shape.cue_edge_mm)


def cued_over(below: Values, shape: AnyShape, cue: MovingCue, at: ActuatorPlaces) -> Values:
    """Put bands over a finished shape: 9.3.2.

    Past the ends of an open path they fade over half of the width of what is drawn.
    """
    seen = coordinates(shape, at)
    m = cue_profile(shape, seen) * bands(shape, cue, seen, at)
    if shape.cue_width_mm > shape.width_mm:
        m *= np.clip(1 - _past_ends(shape, seen, at) / (shape.width_mm / 2), 0, 1)
    return cued(below, cue, m, at)


def _past_ends(shape: AnyShape, seen: Coordinates, at: ActuatorPlaces) -> Values:
    """How far past an end of an open path a place is, in the direction of the path there."""
    past = np.zeros(at.x_mm.shape)
    if isinstance(shape, StraightLine):
        contours: tuple[tuple[Point, ...], ...] = ((shape.start_mm, shape.end_mm),)
    elif isinstance(shape, PathShape) and not shape.closed:
        contours = shape.contours_mm
    else:
        return past
    for number, points in enumerate(contours):
        ends = ((points[0], points[1], 0), (points[-1], points[-2], len(points) - 2))
        for end, inner, edge in ends:
            length = math.dist(end, inner)
            way = (end[0] - inner[0]) / length, (end[1] - inner[1]) / length
            dx, dy = at.from_point(*end)
            here = (seen.contour == number) & (seen.edge == edge)
            past = np.where(here, np.maximum(past, dx * way[0] + dy * way[1]), past)
    return past


def _cut(along: Along, cycles: Sequence[Cycle], seen: Coordinates, time_s: float) -> Values:
    """Depth a · g(l) of the cuts of a texture along a stroke; each contour has its own cycle."""
    cut = np.zeros(seen.along_mm.shape)
    for number, cycle in enumerate(cycles):
        here = seen.contour == number
        x = moved_on(seen.along_mm[here], cycle, along.velocity_mm_s, time_s)
        cut[here] = along.amplitude * ridges(x, cycle)
    return cut


def marked(
    polygon: Polygon, markers: VertexMarkers, width: float, seen: Coordinates, at: ActuatorPlaces
) -> Values:
    """Compute the share of the markers in a polygon's stroke: 8.4.3, figs. 8.19 and 8.20.

    A marker is a cone from the place p_a where the inner edges of the strokes meet. Each of its
    two bounds is pushed along the edge on its side by ``blend_mm``, as in the author's later code,
    and the share grows linearly over that distance from the bounds inwards.
    """
    share = np.zeros(at.x_mm.shape)
    corners = joints(polygon.vertices_mm, width / 2)
    count = len(corners)
    distances = np.array([np.hypot(*at.from_point(*corner.vertex_mm)) for corner in corners])
    nearest = np.argmin(distances, axis=0)
    for i, corner in enumerate(corners):
        half = marker_half_angle_rad(markers, corner.angle_rad)
        pushed = markers.blend_mm * math.sin(half + corner.angle_rad / 2)
        dx, dy = at.from_point(*corner.pivot_mm)
        onward = dx * corner.onward[0] + dy * corner.onward[1]
        outward = -(dx * corner.inward[0] + dy * corner.inward[1])
        # The place is so far within the bound on the side that it is nearer to.
        within = math.sin(half) * outward - math.cos(half) * np.abs(onward) + pushed
        own = (seen.edge == i) | (seen.edge == (i - 1) % count)
        here = (nearest == i) & own & (seen.across_mm < width / 2)
        share[here] = np.clip(within / markers.blend_mm, 0.0, 1.0)[here]
    return share


# Dots


def dot_profile(dot: DotStyle, r: Values) -> Values:
    """Compute eq. 8.7 about a dot's middle at full amplitude; with a plateau it is eq. 6.1."""
    return profile(r, 2 * dot.radius_mm, dot.edge)


@dataclass(frozen=True, slots=True, eq=False)
class SeenDot:
    """A dot as places see it.

    Parameters
    ----------
    r : float64[n]
        Distance from its middle.
    share : float64[n]
        What of it is seen there.
    vertex
        Whether it is on a vertex.
    """

    r: Values
    share: Values
    vertex: bool


def placed(dots: Sequence[PlacedDot], at: ActuatorPlaces) -> list[SeenDot]:
    """See dots that stand still."""
    whole = np.ones(at.x_mm.shape)
    return [SeenDot(np.hypot(*at.from_point(x, y)), whole, v) for x, y, v in dots]


def dots_deflection(
    dots: Sequence[SeenDot], dot: DotStyle, at: ActuatorPlaces, vertices: Vibration | None = None
) -> Values:
    """Compute dots; where they overlap, the largest deflection counts: 8.4.4.

    Those on vertices may have a vibration of their own.
    """
    most = np.zeros(at.x_mm.shape)
    for one in dots:
        up = textured(dot_profile(dot, one.r), one.r, 2 * dot.radius_mm, dot.across)
        own = one.vertex and vertices is not None
        swing = vertices if own else dot.vibration
        most = np.maximum(most, vibrated(dot.amplitude * up * one.share, at, swing))
    return most


def dots_profile(
    dots: Sequence[SeenDot], dot: DotStyle, at: ActuatorPlaces, *, mask: bool
) -> Values:
    """Compute the profile of dots at full amplitude, which hides a fill.

    As a mask, which hides all, it is a texture of theirs where that is higher.
    """
    most = np.zeros(at.x_mm.shape)
    for one in dots:
        up = dot_profile(dot, one.r)
        if mask:
            up = np.maximum(up, textured(up, one.r, 2 * dot.radius_mm, dot.across))
        most = np.maximum(most, up * one.share)
    return most


# Dots that move: 9.3.3


def seen_dots(shape: AnyShape, at: ActuatorPlaces) -> list[SeenDot]:
    """Place each dot of a shape, one by one, where it is at the time."""
    assert shape.dots is not None
    if not shape.dots.velocity_mm_s:
        return placed(dots_of(shape), at)
    radius = shape.dots.dot.radius_mm
    moved = shape.dots.velocity_mm_s * at.moved_s(shape.dots.velocity_by)
    stay, rows = rows_of(shape)
    whole = np.ones(at.x_mm.shape)
    found = placed(stay, at)
    if isinstance(shape, Circle):
        (x, y), across = shape.center_mm, shape.radius_mm
        for still in dots_of(shape):
            turn = math.atan2(still.y_mm - y, still.x_mm - x) + math.fmod(moved / across, math.tau)
            place = x + across * math.cos(turn), y + across * math.sin(turn)
            found.append(SeenDot(np.hypot(*at.from_point(*place)), whole, False))
        return found
    for row in rows:
        found += _row_dots(row, radius, math.fmod(moved, row.pitch_mm), at)
    return found


def _row_dots(row: DotRow, radius: float, moved: float, at: ActuatorPlaces) -> Iterator[SeenDot]:
    """Dots of a row: they come and go over a millimetre, within its window."""
    places = np.array(row.points_mm)
    steps = np.diff(places, axis=0)
    lengths = np.hypot(*steps.T)
    ways = steps / lengths[:, np.newaxis]
    ends = np.cumsum(lengths)
    whole, closes = float(ends[-1]), math.isinf(row.begin_mm)
    first = 0 if closes else -math.ceil(2 * radius / row.pitch_mm) - 1
    last = round(whole / row.pitch_mm) - (1 if closes else first)
    for k in range(first, last + 1):
        along = k * row.pitch_mm + moved
        along = along % whole if closes else along
        n = min(int(np.searchsorted(ends, along, side="right")), len(lengths) - 1)
        x, y = places[n] + (along - (ends[n] - lengths[n])) * ways[n]
        dx, dy = at.from_point(x, y)
        share = np.ones(dx.shape)
        if not closes:
            # Along the row's own direction where it begins, and where it ends.
            begun = along + dx * ways[0, 0] + dy * ways[0, 1] - row.begin_mm
            left = whole - row.end_mm - along - dx * ways[-1, 0] - dy * ways[-1, 1]
            share = np.clip(begun, 0, 1) * np.clip(left, 0, 1)
            for end, way, size, own, is_open in (
                (places[0], -ways[0], lengths[0], n == 0, row.begin_mm < 0),
                (places[-1], ways[-1], lengths[-1], n == len(lengths) - 1, row.end_mm < 0),
            ):
                if is_open and own and size >= 2 * radius:
                    ex, ey = at.from_point(*end)
                    past = ex * way[0] + ey * way[1] > 0
                    share = np.where(past & (np.hypot(ex, ey) > radius), 0.0, share)
        yield SeenDot(np.hypot(dx, dy), share, False)


# Shapes


def drawn(shape: AnyShape, at: ActuatorPlaces) -> Values:
    """Compute a shape's stroke or its dots, without its fill."""
    if shape.stroke is not None:
        return stroke_deflection(shape, shape.stroke, at)
    if shape.dots is not None:
        return dots_deflection(
            seen_dots(shape, at), shape.dots.dot, at, shape.dots.vertex_vibration
        )
    return np.zeros(at.x_mm.shape)


def drawn_profile(shape: AnyShape, at: ActuatorPlaces) -> Values:
    """Compute the profile of a shape's stroke or of its dots, at full amplitude."""
    if shape.stroke is not None:
        return stroke_profile(shape.stroke, coordinates(shape, at).across_mm)
    if shape.dots is not None:
        return dots_profile(seen_dots(shape, at), shape.dots.dot, at, mask=False)
    return np.zeros(at.x_mm.shape)


def drawn_mask(shape: AnyShape, at: ActuatorPlaces) -> Values:
    """Compute the opacity of a shape's stroke or of its dots: their profile at full amplitude.

    A texture across them may be above the profile near their edges; the mask is then the texture,
    since a mask is nowhere below its pattern.
    """
    up = drawn_profile(shape, at)
    if shape.stroke is not None:
        r = coordinates(shape, at).across_mm
        return np.maximum(up, textured(up, r, shape.stroke.width_mm, shape.stroke.across))
    if shape.dots is not None:
        return dots_profile(seen_dots(shape, at), shape.dots.dot, at, mask=True)
    return up
