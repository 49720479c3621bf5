"""Shapes of SVG as patterns: their outlines, what they are filled with, and holes in them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from vbraille.scene.intersections import meeting_edges
from vbraille.scene.measures import LEAST_MM
from vbraille.scene.patterns import Circle, PathShape, Polygon, StraightLine
from vbraille.scene.svg.numbers import length_px, numbers_of
from vbraille.scene.svg.outlines import Contour, contour, contours_of_path
from vbraille.scene.svg.tree import name_of

if TYPE_CHECKING:
    from vbraille.scene.measures import Point
    from vbraille.scene.patterns import AnyPattern
    from vbraille.scene.svg.numbers import AffineMap
    from vbraille.scene.svg.paint import ShapeLook
    from vbraille.scene.svg.tree import Element

SHAPES = frozenset(("path", "rect", "circle", "ellipse", "line", "polyline", "polygon"))
_MOST_COMPARED = 4_000_000  # places that are compared with contours to find holes
_MOST_CROSSED = 2000  # places of a contour that is searched for crossings
CROSSING = "it crosses itself, or may; it is filled by the even-odd rule"


def outline(element: Element, matrix: AffineMap, view: Point, room: int) -> list[Contour]:
    """Contours of a shape.

    Parameters
    ----------
    element
        One of `SHAPES`.
    matrix
        Map from its coordinates to mm on the canvas.
    view
        Width and height that percentages are of.
    room
        How many places it may have; it may be left unfinished after those.

    Returns
    -------
    list of Contour
        The contours; none if the element has no size.

    Raises
    ------
    ValueError
        If it cannot be understood, or goes too far.
    """
    match name_of(element):
        case "path":
            d = element.get("d") or ""
            return contours_of_path(d, matrix, room) if d.strip() not in ("", "none") else []
        case "rect":
            return _rectangle(element, matrix, view)
        case "circle" | "ellipse":
            place, radii = rounded(element, view)
            (x, y), (rx, ry) = place, radii
            if rx <= 0 or ry <= 0:
                return []
            arcs = f"M{x - rx!r} {y!r}A{rx!r} {ry!r} 0 0 1 {x + rx!r} {y!r}"
            return contours_of_path(f"{arcs}A{rx!r} {ry!r} 0 0 1 {x - rx!r} {y!r}Z", matrix)
        case "line":
            names = (("x1", "y1"), ("x2", "y2"))
            places = [complex(*_lengths(element, pair, view)) for pair in names]
            return contour(places, matrix, closed=False)
        case name:
            numbers = numbers_of(element.get("points"))
            places = [complex(x, y) for x, y in zip(numbers[::2], numbers[1::2], strict=False)]
            return contour(places, matrix, closed=name == "polygon")


def rounded(element: Element, view: Point) -> tuple[Point, Point]:
    """Middle and radii of a circle or an ellipse."""
    place = _lengths(element, ("cx", "cy"), view)
    if name_of(element) == "circle":
        diagonal = ((view[0] ** 2 + view[1] ** 2) / 2) ** 0.5
        (radius,) = _lengths(element, ("r",), (diagonal,))
        return (place[0], place[1]), (radius, radius)
    return (place[0], place[1]), _radii(element, view)


def circle_of(element: Element, matrix: AffineMap, view: Point, drawn: ShapeLook) -> Circle | None:
    """Circle that a circle or an ellipse is on the canvas; None if it is none there."""
    (x, y), (rx, ry) = rounded(element, view)
    radius = rx * matrix.scale
    if rx != ry or not matrix.keeps_circles or not LEAST_MM <= radius <= 10_000.0:
        return None
    center = matrix.put(complex(x, y))
    return Circle(
        center_mm=(round(center.real, 4) + 0.0, round(center.imag, 4) + 0.0),
        radius_mm=round(radius, 4),
        stroke=drawn.stroke,
        dots=drawn.dots,
        fill=drawn.fill,
    )


def patterns_of(
    name: str, contours: list[Contour], drawn: ShapeLook, *, nonzero: bool, notes: list[str]
) -> list[AnyPattern]:
    """Patterns of a shape, from the lowest on.

    Parameters
    ----------
    name
        Name of the element.
    contours
        What is drawn.
    drawn
        How it is drawn.
    nonzero
        Whether it is filled by the nonzero rule; a contour in another that goes round in the same
        way makes no hole then.
    notes
        List to which is added what is not as in the drawing.
    """
    lines = {"stroke": drawn.stroke, "dots": drawn.dots}
    shown = drawn.stroke is not None or drawn.dots is not None
    rings = [one.points_mm for one in contours if len(one.points_mm) >= 3]
    if drawn.fill is not None:
        polygon = _is_polygon(name, contours)
        if (nonzero or polygon) and any(map(_crosses, rings)):
            if nonzero:
                notes.append(CROSSING)
        elif polygon:
            return [Polygon(vertices_mm=rings[0], fill=drawn.fill, **lines)]
        edges = _edges(rings) if nonzero and len(rings) > 1 else rings
        if edges and (not shown or (edges == rings and all(one.closed for one in contours))):
            return [PathShape(contours_mm=tuple(edges), closed=True, fill=drawn.fill, **lines)]
        found: list[AnyPattern] = []
        if edges:
            found.append(PathShape(contours_mm=tuple(edges), closed=True, fill=drawn.fill))
    else:
        found = []
        if _is_polygon(name, contours) and not _crosses(rings[0]):
            return [Polygon(vertices_mm=rings[0], **lines)] if shown else []
    if not shown:
        return found
    if name == "line" and contours:
        start, end = contours[0].points_mm
        return [StraightLine(start_mm=start, end_mm=end, **lines)]
    for closed in (True, False):
        points = tuple(one.points_mm for one in contours if one.closed == closed)
        if points:
            found.append(PathShape(contours_mm=points, closed=closed, **lines))
    return found


def _is_polygon(name: str, contours: list[Contour]) -> bool:
    """Tell whether a shape was drawn by its corners, which have joints that others do not."""
    if len(contours) != 1 or not contours[0].closed:
        return False
    return name == "polygon" or (name == "rect" and len(contours[0].points_mm) == 4)


def _rectangle(element: Element, matrix: AffineMap, view: Point) -> list[Contour]:
    x, y, width, height = _lengths(element, ("x", "y", "width", "height"), (*view, *view))
    if width <= 0 or height <= 0:
        return []
    rx, ry = _radii(element, view)
    rx, ry = min(max(rx, 0.0), width / 2), min(max(ry, 0.0), height / 2)
    right, bottom = x + width, y + height
    if not rx or not ry:
        corners = [complex(x, y), complex(right, y), complex(right, bottom), complex(x, bottom)]
        return contour(corners, matrix, closed=True)
    arc = f"A{rx!r} {ry!r} 0 0 1"
    return contours_of_path(
        f"M{x + rx!r} {y!r}H{right - rx!r}{arc} {right!r} {y + ry!r}"
        f"V{bottom - ry!r}{arc} {right - rx!r} {bottom!r}"
        f"H{x + rx!r}{arc} {x!r} {bottom - ry!r}V{y + ry!r}{arc} {x + rx!r} {y!r}Z",
        matrix,
    )


def _radii(element: Element, view: Point) -> Point:
    """Radii along x and y; one that is not given, or below 0, is like the other."""
    rx, ry = (
        length_px(element.get(of), whole) for of, whole in zip(("rx", "ry"), view, strict=True)
    )
    rx, ry = (None if of is None or of < 0 else of for of in (rx, ry))
    return (rx if rx is not None else ry or 0.0), (ry if ry is not None else rx or 0.0)


def _lengths(element: Element, names: tuple[str, ...], wholes: tuple[float, ...]) -> list[float]:
    """Lengths of attributes, 0 where there are none."""
    pairs = zip(names, wholes, strict=True)
    return [length_px(element.get(name), whole) or 0.0 for name, whole in pairs]


def _crosses(points_mm: tuple[Point, ...]) -> bool:
    """Tell whether a contour crosses itself, or is so long that it may."""
    if len(points_mm) > _MOST_CROSSED:
        return True
    try:
        return not _is_convex(points_mm) and meeting_edges(points_mm) is not None
    except ValueError:  # it would take too long to find out
        return True


def _is_convex(points_mm: tuple[Point, ...]) -> bool:
    """Tell whether a contour goes round once and always turns the same way; quick to find out."""
    turned, side = 0.0, 0.0
    for before, here, after in zip(
        (points_mm[-1], *points_mm), points_mm, (*points_mm[1:], points_mm[0]), strict=False
    ):
        (x0, y0), (x1, y1), (x2, y2) = before, here, after
        turn = math.atan2(
            (x1 - x0) * (y2 - y1) - (y1 - y0) * (x2 - x1),
            (x1 - x0) * (x2 - x1) + (y1 - y0) * (y2 - y1),
        )
        if turn * side < 0:
            return False
        side = turn or side
        turned += turn
    return abs(abs(turned) - 2 * math.pi) < 0.1


def _edges(rings: list[tuple[Point, ...]]) -> list[tuple[Point, ...]]:
    """Contours at which an area filled by the nonzero rule ends, if no two of them cross."""
    if len(rings) * sum(map(len, rings)) > _MOST_COMPARED:
        return rings
    turns = [1 if _area(ring) > 0 else -1 for ring in rings]
    found = []
    for number, ring in enumerate(rings):
        around = sum(
            turn
            for other, turn in enumerate(turns)
            if other != number and _is_inside(ring[0], rings[other])
        )
        if (around == 0) != (around + turns[number] == 0):
            found.append(ring)
    return found


def _area(ring: tuple[Point, ...]) -> float:
    """Twice the area that a contour goes round, with the sign of its direction."""
    pairs = zip(ring, (*ring[1:], ring[0]), strict=True)
    return sum(x0 * y1 - x1 * y0 for (x0, y0), (x1, y1) in pairs)


def _is_inside(point: Point, ring: tuple[Point, ...]) -> bool:
    """Tell whether a place is inside a contour, by the even-odd rule."""
    x, y = point
    inside = False
    for (x0, y0), (x1, y1) in zip(ring, (*ring[1:], ring[0]), strict=True):
        if (y0 > y) != (y1 > y) and x < x0 + (y - y0) * (x1 - x0) / (y1 - y0):
            inside = not inside
    return inside
