"""Outlines of shapes as places on the canvas: paths, basic shapes, fills, strokes and clips.

Places are whole ten-thousandths of a millimetre, which are Clipper's numbers.
"""

from __future__ import annotations

import itertools
import math
import re
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

import pyclipper as clipper_library
from svg.path import Arc, Close, CubicBezier, Move, Path, QuadraticBezier, parse_path

from vbraille.scene.measures import MOST_MM
from vbraille.scene.svg.document import AffineMap, name_of, numbers_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from vbraille.scene.measures import Point
    from vbraille.scene.svg.document import Element, Style

pyclipper: Any = clipper_library  # its types are not declared
SHAPES = frozenset(("path", "rect", "circle", "ellipse", "line", "polyline", "polygon"))
# How far a chord may be from its curve. No array shows less.
_FLATNESS_MM = 0.05
MOST_POINTS = 500_000  # of a drawing
TOO_FAR = "it goes farther than 10 m from the drawing's corner"
_NOT_CUT = "it has too many places or crossings to be cut"
_PER_MM = 10_000
_MOST_CHARACTERS = 1_000_000  # of the text of a path
# Outlines of more places, or so long that they must cross very often, take Clipper too long.
_MOST_CUT, _MOST_DIAGONALS = 5_000, 500
_MOST_CHORDS = 10_000  # of a curve
_COMMAND = re.compile(r"[MmZzLlHhVvCcSsQqTtAa][-+0-9.eE,\s]*", re.ASCII)

Ring = list[tuple[int, int]]


class Contour(NamedTuple):
    """Places of a line, and whether it goes back to its first place."""

    ring: Ring
    closed: bool


class Corner(NamedTuple):
    """A vertex of a path in user units, and the directions in and out of it; 0 for none."""

    place: complex
    before: complex = 0.0
    after: complex = 0.0


@lru_cache(maxsize=50)
def segments_of(d: str) -> tuple[Path, bool]:
    """Segments of the text of a path, up to where it goes wrong.

    Returns
    -------
    svg.path.Path, bool
        The segments, and whether the text was read to its end.
    """
    d = d.strip()
    if d[:1] not in ("M", "m") or len(d) > _MOST_CHARACTERS:
        return Path(), not d
    whole = None if _COMMAND.sub("", d) else _parsed(d)
    if whole is not None:
        return whole, True
    end = 0
    for command in _COMMAND.finditer(d):
        if command.start() != end or _parsed(f"M0 0{command[0]}") is None:
            break
        end = command.end()
    return _parsed(d[:end]) or Path(), False


def _parsed(d: str) -> Path | None:
    """Segments of the text of a path; None if it is not right."""
    try:
        return parse_path(d)
    # It means to raise ValueError, and for some texts raises errors of its own code.
    except (ValueError, ArithmeticError, AttributeError, IndexError, AssertionError):
        return None


def path_of(element: Element, style: Style) -> str:
    """Text of a path for a shape; empty if the shape has no size."""
    name = name_of(element)
    if name == "path":
        d = element.get("d") or ""
        return "" if d.strip() == "none" else d
    if name == "line":
        start = style.place(element.get("x1"), element.get("y1"))
        end = style.place(element.get("x2"), element.get("y2"))
        return f"M{start.real!r} {start.imag!r}L{end.real!r} {end.imag!r}"
    if name in ("polyline", "polygon"):
        numbers = numbers_of((element.get("points") or "")[:_MOST_CHARACTERS])
        places = " ".join(map(repr, numbers[: len(numbers) // 2 * 2]))
        return f"M{places}{'Z' * (name == 'polygon')}" if len(numbers) >= 4 else ""
    if name == "rect":
        place, size = (
            style.place(style["x"], style["y"]),
            style.place(style["width"], style["height"]),
        )
        x, y, w, h = place.real, place.imag, size.real, size.imag
        rx, ry = _radii(style)
        rx, ry = min(rx, w / 2), min(ry, h / 2)
    else:
        middle, (rx, ry) = round_of(element, style)
        x, y, w, h = middle.real - rx, middle.imag - ry, 2 * rx, 2 * ry
    if w <= 0 or h <= 0:
        return ""
    if not rx or not ry:
        return f"M{x!r} {y!r}H{x + w!r}V{y + h!r}H{x!r}Z"
    arc = f"A{rx!r} {ry!r} 0 0 1"
    return (
        f"M{x + rx!r} {y!r}H{x + w - rx!r}{arc} {x + w!r} {y + ry!r}"
        f"V{y + h - ry!r}{arc} {x + w - rx!r} {y + h!r}"
        f"H{x + rx!r}{arc} {x!r} {y + h - ry!r}V{y + ry!r}{arc} {x + rx!r} {y!r}Z"
    )


def round_of(element: Element, style: Style) -> tuple[complex, Point]:
    """Middle and radii of a circle or an ellipse, in user units; 0 for one without a size."""
    middle = style.place(style["cx"], style["cy"])
    if name_of(element) == "ellipse":
        return middle, _radii(style)
    radius = max(style.length(style["r"], style.diagonal) or 0.0, 0.0)
    return middle, (radius, radius)


def _radii(style: Style) -> Point:
    """Radii along x and y; one that is not given, or below 0, is like the other."""
    radii = style.length(style["rx"], style.view[0]), style.length(style["ry"], style.view[1])
    rx, ry = (None if one is None or one < 0 else one for one in radii)
    return rx if rx is not None else ry or 0.0, ry if ry is not None else rx or 0.0


def contours_of(segments: Path, matrix: AffineMap, room: int = MOST_POINTS) -> list[Contour]:
    """Contours of segments of a path, with curves flattened to 0.05 mm.

    Parameters
    ----------
    segments
        Segments of `segments_of`.
    matrix
        Map from their coordinates to mm on the canvas.
    room
        How many places they may have; after those they are not followed.

    Raises
    ------
    ValueError
        If they go farther than 10 m.
    """
    contours: list[Contour] = []
    ring: Ring = []
    closed = False

    def add() -> None:
        if len(ring) > 3 and ring[0] == ring[-1]:
            ring.pop()
            contours.append(Contour(ring, closed=True))
        elif len(ring) > 1:
            contours.append(Contour(ring, closed and len(ring) > 2))

    for segment in segments:
        if isinstance(segment, Move):
            add()
            ring = []
        closed = isinstance(segment, Close)
        for place in _chords(segment, matrix.largest):
            at = matrix(place)
            if not max(abs(at.real), abs(at.imag)) <= MOST_MM:  # or it is no number
                raise ValueError(TOO_FAR)
            point = round(at.real * _PER_MM), round(at.imag * _PER_MM)
            if point != (ring[-1] if ring else None):
                ring.append(point)
                room -= 1
        if closed:
            if ring[-1] == ring[0] and len(ring) > 1:
                ring.pop()
            add()
            closed, ring = False, [ring[0]]
        if room < 0:
            break
    add()
    return contours


def _chords(segment: Any, scale: float) -> list[complex]:
    """Ends of the chords in place of a segment, without its start."""
    start, end, bend = getattr(segment, "start", segment.end), segment.end, 0.0
    # A chord is within h² |B''| / 8 of its curve, h being its share of it.
    if isinstance(segment, CubicBezier):
        one, two = segment.control1, segment.control2
        bend = 6 * max(abs(start - 2 * one + two), abs(one - 2 * two + end))
    elif isinstance(segment, QuadraticBezier):
        bend = 2 * abs(start - 2 * segment.control + end)
    elif isinstance(segment, Arc) and start != end and all(_parts(segment.radius)):
        largest = max(_parts(segment.radius)) * segment.radius_scale
        bend = largest * math.radians(segment.delta) ** 2
    bend = min(bend * scale, MOST_MM * MOST_MM)
    count = min(math.ceil(math.sqrt(bend / (8 * _FLATNESS_MM))), _MOST_CHORDS)
    return [*(segment.point(number / count) for number in range(1, count)), end]


def _parts(number: complex) -> Point:
    return number.real, number.imag


def corners_of(segments: Path) -> list[Corner]:
    """Vertices of a path, at which markers stand."""
    corners: list[Corner] = []
    first = 0
    for segment in segments:
        if isinstance(segment, Move):
            first = len(corners)
            corners.append(Corner(segment.end))
            continue
        # At its very ends a curve may have no direction.
        away, arrives = (
            way / abs(way) if abs(way) > 1e-12 else 0.0
            for way in (
                segment.point(1e-5) - segment.start,
                segment.end - segment.point(1 - 1e-5),
            )
        )
        last = corners[-1]
        corners[-1] = last._replace(after=away or last.before)
        corners.append(Corner(segment.end, arrives or last.before))
        if isinstance(segment, Close):
            corners[-1] = corners[-1]._replace(after=corners[first].after)
            corners[first] = corners[first]._replace(before=corners[-1].before)
    return corners


def _too_tangled(rings: Sequence[Ring]) -> bool:
    """Tell whether Clipper may take too long for outlines."""
    places = [place for ring in rings for place in ring]
    sides = [max(side) - min(side) for side in zip(*places, strict=True)]
    length = sum(math.dist(*edge) for ring in rings for edge in itertools.pairwise(ring))
    return len(places) > _MOST_CUT or length > _MOST_DIAGONALS * math.hypot(*sides)


def filled(rings: list[Ring], rule: str) -> tuple[list[Ring], bool]:
    """Rings by which the even-odd rule fills an area.

    Parameters
    ----------
    rings
        Outlines of the area.
    rule
        Fill rule of the drawing: "nonzero" or "evenodd".

    Returns
    -------
    list of rings, bool
        The rings, and whether they are right: outlines of more than 5,000 places, or that cross
        very often, are left as they are, which is wrong where they overlap.
    """
    if not rings or _too_tangled(rings):
        return rings, not rings or rule == "evenodd"
    kind = pyclipper.PFT_EVENODD if rule == "evenodd" else pyclipper.PFT_NONZERO
    found = _rings(pyclipper.SimplifyPolygons(rings, kind))
    same = sorted(map(sorted, found)) == sorted(map(sorted, rings))
    return (rings if same else found), True


def cut(rings: list[Ring], clip: list[Ring]) -> list[Ring]:
    """Parts of an area that are within another, both by the even-odd rule.

    Raises
    ------
    ValueError
        If it takes too long to find them.
    """
    if not rings or not clip:
        return []
    if _too_tangled(rings):
        raise ValueError(_NOT_CUT)
    clipper = pyclipper.Pyclipper()
    try:
        clipper.AddPaths(rings, pyclipper.PT_SUBJECT, True)
        clipper.AddPaths(clip, pyclipper.PT_CLIP, True)
        rule = pyclipper.PFT_EVENODD
        return _rings(clipper.Execute(pyclipper.CT_INTERSECTION, rule, rule))
    except pyclipper.ClipperException:  # nothing with an area is left
        return []


def stroked(contours: Sequence[Contour], width_mm: float) -> list[Ring]:
    """Area of a stroke, as rings by the even-odd rule.

    Raises
    ------
    ValueError
        If it takes too long to find it.
    """
    if _too_tangled([one.ring for one in contours]):
        raise ValueError(_NOT_CUT)
    offset = pyclipper.PyclipperOffset(2.0, _FLATNESS_MM * _PER_MM)
    for contour in contours:
        end = pyclipper.ET_CLOSEDLINE if contour.closed else pyclipper.ET_OPENROUND
        offset.AddPath(contour.ring, pyclipper.JT_ROUND, end)
    return _rings(offset.Execute(width_mm / 2 * _PER_MM))


def is_within(contours: Sequence[Contour], reach_mm: float, clip: list[Ring]) -> bool:
    """Tell whether the rectangle around contours, and so far around them, is within an area."""
    xs, ys = zip(*(place for one in contours for place in one.ring), strict=True)
    reach = round(reach_mm * _PER_MM)
    left, top, right, bottom = min(xs) - reach, min(ys) - reach, max(xs) + reach, max(ys) + reach
    box = [(left, top), (right, top), (right, bottom), (left, bottom)]
    return [sorted(ring) for ring in cut([box], clip)] == [sorted(box)]


def ring_of(places_mm: Iterable[complex]) -> Ring:
    """Ring of places in mm."""
    return [(round(place.real * _PER_MM), round(place.imag * _PER_MM)) for place in places_mm]


def in_mm(ring: Ring) -> tuple[Point, ...]:
    """Places of a ring in mm."""
    return tuple((x / _PER_MM, y / _PER_MM) for x, y in ring)


def _rings(paths: Sequence[Sequence[Sequence[int]]]) -> list[Ring]:
    """Rings of Clipper's that have an area."""
    return [[(x, y) for x, y in path] for path in paths if len(path) >= 3]
