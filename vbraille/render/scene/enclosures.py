"""What shapes and dots lie in, part by part.

An array is told of those segments of a filled shape that it may touch, and of those alone. Whether
a place is inside is how often a line from it to the right crosses the shape's edges, even or odd,
and so what lies to the right of all that the array reaches has to be told in another way. Of a run
of segments there it only matters at which heights it begins and ends: the rest cancels. Each of
these two heights is told by a *wall* far to the right, from there upwards. What cannot be told so,
since it is beyond the top or the bottom of all that the array reaches, is the same for all places
there; if it is odd, it is told by a wall without ends. That one alone is left where all that the
array reaches is inside, and far from the edges.

So a filled shape has as parts its segments, the wall without ends, and a wall for each corner.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.render.scene import pathparts
from vbraille.render.scene.nodes import LeafReach
from vbraille.scene.bounds import around, drawn_radius_mm
from vbraille.scene.dots import Dots
from vbraille.scene.dotting import dots_of
from vbraille.scene.patterns import Circle

if TYPE_CHECKING:
    from vbraille.render.scene.nodes import Enclosed
    from vbraille.render.scene.pathparts import AnyShape
    from vbraille.scene.measures import Point
    from vbraille.scene.patterns import Fill

# As plain numbers, which are many times faster to put into an array.
_CAPSULE, _RING, _EDGE, _WALL, _AROUND = map(
    int,
    (
        LeafReach.CAPSULE,
        LeafReach.RING,
        LeafReach.EDGE,
        LeafReach.WALL,
        LeafReach.AROUND,
    ),
)
_ROUNDING_MM = 1e-6


def enclosed_dots(pattern: AnyShape | Dots) -> tuple[Enclosed, ...]:
    """What each of the dots of a pattern, or of a dotted shape, lies in."""
    if isinstance(pattern, Dots):
        radius, places = pattern.dot.radius_mm, pattern.centers_mm
    else:
        radius, places = drawn_radius_mm(pattern), [dot[:2] for dot in dots_of(pattern)]
    return tuple((_CAPSULE, x, y, x, y, radius) for x, y in places)


def enclosed_stroke(shape: AnyShape) -> tuple[Enclosed, ...]:
    """What a circle's stroke, or each segment of another shape, lies in."""
    radius = drawn_radius_mm(shape)
    if isinstance(shape, Circle):
        return ((_RING, *shape.center_mm, shape.radius_mm, 0.0, radius),)
    radius = max(radius, pathparts.marker_reach_mm(shape))
    return tuple(
        (_CAPSULE, *start, *end, radius)
        for points in pathparts.edges_of(shape)
        for start, end in points
    )


def enclosed_fill(shape: AnyShape, fill: Fill) -> tuple[Enclosed, ...]:
    """What each part of a filled shape lies in, in the order in which they are said."""
    reach = drawn_radius_mm(shape)
    if not fill.blended:
        reach += fill.gap_mm + fill.fade_mm
    reach = max(reach, pathparts.marker_reach_mm(shape)) + _ROUNDING_MM
    edges: list[Enclosed] = []
    walls: list[Enclosed] = []
    places: list[Point] = []
    for contour in pathparts.edges_of(shape):
        (x0, _), (x1, _) = contour[-1]
        before = x0 if x0 < x1 else x1
        for start, end in contour:
            (x0, y0), (x1, y1) = start, end
            left, right = (x0, x1) if x0 < x1 else (x1, x0)
            edges.append((_EDGE, left, y0, right, y1, reach))
            less, more = (before, left) if before < left else (left, before)
            walls.append((_WALL, less, y0, more, y0, reach))
            before = left
            places.append(start)
    left, top, right, bottom = around(places)
    return (*edges, (_AROUND, left, top, right, bottom, reach), *walls)
