"""Geometry of shapes: bounds, corners, whole cycles of textures along paths, and places of dots.

Where strokes meet at a corner, and how a texture along them goes round, is of Lévesque 2009, 8.4.3,
figs. 8.18-8.20; the arithmetic is that of its author's later code.

Lévesque 2009, 8.4.1 and 8.4.3, asks for a whole number of cycles and does not say how. The rule is
that of its author's later code: the number of cycles is the nearest whole one; without a gap the
ridge changes; with a gap the gap alone changes if there is still room for one, or else both.

Of dots (8.4.4) the source wants one on each end of a line and on each vertex of a polygon, the
others evenly between, and a least separation that also holds across joints. With m, the least
distance of two middles, a dot's diameter and the separation:

- a line of length d has ⌊d/m⌋ + 1 dots, and so has an edge of a polygon, but with m / sin θ in
  place of m where the angle θ at one of its ends is below 90°;
- a circle has ⌊π / asin(m/2R)⌋ dots, the first to the right of its middle.

Ours is the rest. Of dots that would still be nearer than m, because edges are short or come near
each other, the later is left out, and one on a vertex counts before the others. A path has its
vertices where it turns by more than 40°; between them dots are evenly spaced along it, so that a
curve that is many short edges is dotted like a line.

Dots that move (9.3.3) do so between the vertices of a shape, whose own dots stay, or between the
ends of an open path. Dots that are evenly spaced are a row without end, which is seen as far as its
window lets it: half a spacing from a vertex, or where the strokes of its two edges part; as far as
a dot reaches beyond an open end.
"""

from __future__ import annotations

import itertools
import math
from functools import lru_cache, reduce
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vbraille.scene.patterns import (
    Circle,
    Dots,
    Group,
    Image,
    ImageDots,
    Label,
    Polygon,
    Shape,
    Use,
)
from vbraille.scene.traversal import points_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from vbraille.scene.measures import Point
    from vbraille.scene.patterns import (
        Along,
        AnyPattern,
        AxialGrating,
        MovingCue,
        Pattern,
        TurnPeak,
        VertexMarkers,
    )


class Box(NamedTuple):
    """A rectangle of the canvas, in mm; an empty one ends before it begins."""

    left: float
    top: float
    right: float
    bottom: float

    @property
    def is_empty(self) -> bool:
        """Tell whether there is nothing in it, not even a point."""
        return self.right < self.left or self.bottom < self.top

    def grown(self, by_mm: float) -> Box:
        """Make the box that reaches so much farther on each side."""
        if self.is_empty:
            return self
        return Box(self.left - by_mm, self.top - by_mm, self.right + by_mm, self.bottom + by_mm)

    def holds(self, x_mm: float, y_mm: float) -> bool:
        """Tell whether a place is in the box or on its edge."""
        return self.left <= x_mm <= self.right and self.top <= y_mm <= self.bottom

    def joined(self, other: Box) -> Box:
        """Make the smallest box that holds both."""
        return Box(
            min(self.left, other.left),
            min(self.top, other.top),
            max(self.right, other.right),
            max(self.bottom, other.bottom),
        )

    def common(self, other: Box) -> Box:
        """Make the box of what is in both; `EMPTY` if that is nothing."""
        box = Box(
            max(self.left, other.left),
            max(self.top, other.top),
            min(self.right, other.right),
            min(self.bottom, other.bottom),
        )
        return EMPTY if box.is_empty else box


EMPTY = Box(math.inf, math.inf, -math.inf, -math.inf)
_NOWHERE_KNOWN: Mapping[Image | Label, Box] = MappingProxyType({})


def bounds(pattern: AnyPattern, known: Mapping[Image | Label, Box] = _NOWHERE_KNOWN) -> Box | None:
    """Compute a rectangle outside which a pattern and its opacity mask are 0.

    It is as small as the pattern's parts allow, but for groups, of which it takes the parts' boxes
    together. Vibrations and amplitudes do not change it.

    Parameters
    ----------
    pattern
        A pattern of a resolved scene.
    known
        Boxes of images and labels, which only their pixels and cells can tell; those that are not
        in it are taken to be everywhere.

    Returns
    -------
    Box or None
        The rectangle; None for everywhere.

    Raises
    ------
    TypeError
        If the pattern is a `Use` or has dots of an image, which only a resolved scene can place.
    """
    if isinstance(pattern, Use | ImageDots):
        raise TypeError(f"a {type(pattern).__name__} has no place before the scene is resolved")
    if is_everywhere(pattern):
        return None
    if isinstance(pattern, Image | Label):
        return known.get(pattern)
    if isinstance(pattern, Dots):
        return around(pattern.centers_mm).grown(pattern.dot.radius_mm)
    if isinstance(pattern, Shape):
        radius_mm = pattern.radius_mm if isinstance(pattern, Circle) else 0.0
        return around(points_of(pattern)).grown(radius_mm + reach_mm(pattern))
    if not isinstance(pattern, Group):
        return None
    boxes = [bounds(part, known) for part in pattern.parts]
    limited = [box for box in boxes if box is not None]
    if pattern.operation == "multiply" and limited:
        return reduce(Box.common, limited)
    return reduce(Box.joined, limited) if len(limited) == len(boxes) else None


def is_everywhere(pattern: Pattern) -> bool:
    """Tell whether a pattern is changed so that it is up where there is nothing of it.

    That is so if it is inverted, or if what is down in it vibrates: its opacity mask is 1 then.
    """
    low = pattern.vibration is not None and pattern.vibration.of == "low"
    return pattern.inverted or low


def drawn_radius_mm(shape: Shape) -> float:
    """Tell how far a shape's stroke or its dots reach from its path, to one side."""
    return shape.width_mm / 2


def reach_mm(shape: Shape) -> float:
    """Tell how far anything of what a shape is drawn with reaches from its path."""
    # Dots that move go on in the path's direction beyond its ends, as far as they reach.
    beyond = math.sqrt(2.0) if shape.dots is not None and shape.dots.velocity_mm_s else 1.0
    return max(beyond * drawn_radius_mm(shape), shape.cue_width_mm / 2)


def around(points_mm: Iterable[Point]) -> Box:
    """Make the smallest box that holds all these places."""
    points = tuple(points_mm)
    if not points:
        return EMPTY
    xs, ys = zip(*points, strict=True)
    return Box(min(xs), min(ys), max(xs), max(ys))


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


# Dots under a hand are asked for at each move of it.
_KEPT = 100  # shapes
_CORNER = math.radians(40.0)
_TOLERANCE = 1.0 - 1e-9  # two dots whose distance is m but for rounding may stay


class PlacedDot(NamedTuple):
    """A place of the middle of a dot, and whether it is a vertex of a polygon or a path."""

    x_mm: float
    y_mm: float
    vertex: bool = False


class DotRow(NamedTuple):
    """A row of evenly spaced dots that moves along a part of a shape's path.

    Parameters
    ----------
    points_mm
        Places that the row goes through; none for a row around a circle.
    pitch_mm
        Distance between two dots along it; one of them is at its beginning at first.
    begin_mm, end_mm
        Window outside which there is nothing of it, from its beginning and from its end on. It is
        below 0 at the ends of an open path, and infinite for a row that closes.
    """

    points_mm: tuple[Point, ...]
    pitch_mm: float
    begin_mm: float = -math.inf
    end_mm: float = -math.inf


@lru_cache(maxsize=_KEPT)
def rows_of(shape: Shape) -> tuple[tuple[PlacedDot, ...], tuple[DotRow, ...]]:
    """Compute which dots of a shape stay where they are, and the rows that move between them."""
    if shape.dots is None or not shape.dots.velocity_mm_s:
        return dots_of(shape), ()
    radius_mm = shape.dots.dot.radius_mm
    least_mm = _least_mm(shape)
    if isinstance(shape, Circle):
        return (), (DotRow((), math.tau * shape.radius_mm / len(dots_of(shape))),)
    rows: list[DotRow] = []
    stay: list[PlacedDot] = []
    for run in _runs_of(shape, least_mm):
        first, last = (angle is not None for angle in run.angles)
        if first:
            stay.append(PlacedDot(*run.points_mm[0], vertex=True))
        spaces = len(run.dots()) + 1 if run.length_mm >= run.least_mm * _TOLERANCE else 0
        pitch_mm = run.length_mm / max(spaces, 1)
        if spaces < 1 + (first and last):  # There is no room for a row.
            stay += [] if first else [PlacedDot(*run.points_mm[0])]
            stay += [] if last or run.closes else [PlacedDot(*run.points_mm[-1])]
        elif run.closes:
            rows.append(DotRow(run.points_mm, pitch_mm))
        else:
            window_mm = (
                -radius_mm if angle is None else max(pitch_mm / 2, radius_mm / math.tan(angle / 2))
                for angle in run.angles
            )
            rows.append(DotRow(run.points_mm, pitch_mm, *window_mm))
    return _apart(stay, least_mm), tuple(rows)


@lru_cache(maxsize=_KEPT)
def dots_of(shape: Shape) -> tuple[PlacedDot, ...]:
    """Compute where the dots of a dotted shape stand; none if it is not dotted."""
    if shape.dots is None:
        return ()
    least_mm = _least_mm(shape)
    if isinstance(shape, Circle):
        sine = least_mm / (2 * shape.radius_mm)
        count = 1 if sine > 1.0 else math.floor(math.pi / math.asin(sine) + 1e-9)
        (x, y), radius = shape.center_mm, shape.radius_mm
        angles = (math.tau * i / count for i in range(count))
        return tuple(PlacedDot(x + radius * math.cos(a), y + radius * math.sin(a)) for a in angles)
    dots: list[PlacedDot] = []
    for run in _runs_of(shape, least_mm):
        begins, ends = run.angles
        dots += [PlacedDot(*run.points_mm[0], vertex=begins is not None), *run.dots()]
        if ends is None and not run.closes:
            dots.append(PlacedDot(*run.points_mm[-1]))
    return _apart(dots, least_mm)


def most_dots_of(shape: AnyPattern) -> int:
    """Compute how many dots stand along a shape at most, without placing them."""
    if not isinstance(shape, Shape) or shape.dots is None:
        return 0
    contours, _ = shape.outline
    length_mm = sum(sum(edge_lengths_mm(contour, closed=True)) for contour in contours)
    if isinstance(shape, Circle):
        length_mm = math.tau * shape.radius_mm
    return math.ceil(length_mm / _least_mm(shape)) + sum(map(len, contours))


def _least_mm(shape: Shape) -> float:
    """Least distance of the middles of two dots of a dotted shape."""
    return 2 * shape.dots.dot.radius_mm + shape.dots.separation_mm if shape.dots else 0.0


class _Run(NamedTuple):
    """A part of a path from one of its corners or ends to the next.

    Parameters
    ----------
    points_mm
        Places that it goes through.
    least_mm
        Least distance of two dots on it.
    angles
        Angles θ of the corners where it begins and ends; None at an end of the path.
    closes
        Whether it is a closed path without a corner.
    """

    points_mm: tuple[Point, ...]
    least_mm: float
    angles: tuple[float | None, ...]
    closes: bool

    @property
    def length_mm(self) -> float:
        """Length along the path, in mm."""
        return sum(edge_lengths_mm(self.points_mm, closed=False))

    def dots(self) -> list[PlacedDot]:
        """Dots that divide it evenly, without those at its ends.

        Where it is bent dots are nearer to each other than along it, so there may be fewer of them.
        """
        places = np.array(self.points_mm)
        along = np.concatenate(([0.0], np.cumsum(edge_lengths_mm(self.points_mm, closed=False))))
        spaces = math.floor(along[-1] / self.least_mm + 1e-9)
        while spaces > 1:
            wanted = along[-1] * np.arange(spaces + 1) / spaces
            chain = np.stack([np.interp(wanted, along, axis) for axis in places.T], axis=1)
            share = np.hypot(*np.diff(chain, axis=0).T).min() / self.least_mm
            # Where it turns back on itself no even spacing does, and dots are left out afterwards.
            if share >= _TOLERANCE or share < 0.5:
                return [PlacedDot(x, y) for x, y in chain[1:-1].tolist()]
            spaces = min(spaces - 1, math.floor(spaces * share) + 1)
        return []


def _runs_of(shape: Shape, least_mm: float) -> Iterator[_Run]:
    """Cut a shape's path at its corners, which are all vertices of a polygon, and at its ends."""
    contours, closed = shape.outline
    for points in contours:
        count = len(points)
        corners: dict[int, float] = {}
        for i in range(count) if closed else range(1, count - 1):
            turn = _turn(points[i - 1], points[i], points[(i + 1) % count])
            if turn < math.pi - _CORNER or isinstance(shape, Polygon):
                corners[i] = turn
        cuts = [*corners, min(corners) + count] if corners else [0, count]
        for start, end in itertools.pairwise(cuts if closed else [0, *corners, count - 1]):
            run = [i % count for i in range(start, end + 1)]
            ends = corners.get(run[0]), corners.get(run[-1])
            # At corners sharper than 90° dots are farther apart.
            sines = (math.sin(angle) for angle in ends if angle is not None and angle < math.pi / 2)
            widening = 1.0 / max(min(sines, default=1.0), 1e-6)
            places = tuple(points[i] for i in run)
            yield _Run(places, least_mm * widening, ends, closed and not corners)


def _turn(before: Point, at: Point, after: Point) -> float:
    """Angle θ between two edges at their joint, 0 to π."""
    ux, uy = before[0] - at[0], before[1] - at[1]
    vx, vy = after[0] - at[0], after[1] - at[1]
    return math.atan2(abs(ux * vy - uy * vx), ux * vx + uy * vy)


def _apart(dots: Sequence[PlacedDot], least_mm: float) -> tuple[PlacedDot, ...]:
    """Leave out dots that are nearer than that to one that counts before them."""
    kept: list[int] = []
    near: dict[tuple[int, int], list[Point]] = {}
    for number in sorted(range(len(dots)), key=lambda number: not dots[number].vertex):
        x, y, _ = dots[number]
        column, row = math.floor(x / least_mm), math.floor(y / least_mm)
        cells = itertools.product((column - 1, column, column + 1), (row - 1, row, row + 1))
        around = (place for cell in cells for place in near.get(cell, ()))
        if all(math.dist(place, (x, y)) >= least_mm * _TOLERANCE for place in around):
            kept.append(number)
            near.setdefault((column, row), []).append((x, y))
    return tuple(dots[number] for number in sorted(kept))
