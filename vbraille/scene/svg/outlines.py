"""Outlines of shapes as places on the canvas: paths, basic shapes, fills, strokes and clips."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from vbraille.scene.measures import MOST_MM
from vbraille.scene.svg.document import name_of
from vbraille.scene.svg.values import AffineMap, length_of, numbers_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from vbraille.scene.measures import Point
    from vbraille.scene.svg.document import Element
    from vbraille.scene.svg.values import Units

SHAPES = frozenset(("path", "rect", "circle", "ellipse", "line", "polyline", "polygon"))
# How far a chord may be from its curve. No array shows less.
FLATNESS_MM = 0.05
MOST_POINTS = 500_000  # of a drawing
TOO_FAR = "it goes farther than 10 m from the drawing's corner"
_MOST_CHARACTERS = 2_000_000  # of the text of a path
_MOST_CUT = 5_000  # places of outlines that Clipper is given at once
_MOST_CHORDS = 10_000  # of a curve
_DECIMALS = 4  # of a millimetre: places that are equal so far are one
_CLIPPER = 10**_DECIMALS  # Clipper's whole numbers in a millimetre
# Commands of a path, and how many numbers each takes at a time. Flags of arcs may stand without
# spaces, so those of arcs are not counted.
_COMMAND = re.compile(r"([MmZzLlHhVvCcSsQqTtAa])([-+0-9.eE,\s]*)", re.ASCII)
_COUNTS = {"M": 2, "Z": 0, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 1}

Ring = tuple["Point", ...]


@dataclass(frozen=True, slots=True)
class Contour:
    """Places of a line, in mm, and whether it goes back to its first place."""

    points_mm: Ring
    closed: bool


@dataclass(frozen=True, slots=True)
class Corner:
    """A vertex of a path in user units, and the directions in and out of it; 0 for none."""

    place: complex
    before: complex
    after: complex


def segments_of(d: str) -> tuple[Any, bool]:
    """Segments of the text of a path, up to where it goes wrong.

    Returns
    -------
    svg.path.Path, bool
        The segments, and whether the text was read to its end.
    """
    from svg.path import Path, parse_path

    end, whole = 0, len(d) <= _MOST_CHARACTERS
    if d.lstrip()[:1].upper() != "M":
        return Path(), not d.strip()
    for found in _COMMAND.finditer(d) if whole else ():
        numbers = numbers_of(found[2])
        count = _COUNTS[found[1].upper()]
        # The sign or point of a next number may follow without a space.
        rest = re.sub(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?|[\s,]", "", found[2])
        wrong = len(numbers) % count or not numbers if count else bool(numbers)
        if wrong or rest or d[end : found.start()].strip(" \t\r\n,"):
            whole = False
            break
        end = found.end()
    whole = whole and end >= len(d.rstrip())
    try:
        return parse_path(d[:end]), whole
    # It means to raise ValueError, and for some texts raises errors of its own code.
    except (ValueError, ArithmeticError, AttributeError, IndexError, TypeError, AssertionError):
        return Path(), False


def path_of(element: Element, style: Mapping[str, str], units: Units) -> str:
    """Text of a path for a shape; empty if the shape has no size."""

    def get(name: str, whole: float) -> float:
        return _positive(style.get(name), whole, units, below=True) or 0.0

    width, height = units.view
    match name_of(element):
        case "path":
            d = element.get("d") or ""
            return "" if d.strip() == "none" else d
        case "line":
            places = [
                length_of(element.get(name), whole, units) or 0.0
                for name, whole in zip(("x1", "y1", "x2", "y2"), units.view * 2, strict=True)
            ]
            return "M{!r} {!r}L{!r} {!r}".format(*places)
        case "polyline" | "polygon" as name:
            numbers = numbers_of(element.get("points"))
            numbers = numbers[: len(numbers) // 2 * 2]
            if len(numbers) < 4:
                return ""
            return f"M{' '.join(map(repr, numbers))}{'Z' * (name == 'polygon')}"
        case "rect":
            x, y, w, h = (
                get("x", width),
                get("y", height),
                get("width", width),
                get("height", height),
            )
            if w <= 0 or h <= 0:
                return ""
            rx, ry = radii_of(style, units)
            rx, ry = min(rx, w / 2), min(ry, h / 2)
            if not rx or not ry:
                return f"M{x!r} {y!r}H{x + w!r}V{y + h!r}H{x!r}Z"
            arc = f"A{rx!r} {ry!r} 0 0 1"
            return (
                f"M{x + rx!r} {y!r}H{x + w - rx!r}{arc} {x + w!r} {y + ry!r}"
                f"V{y + h - ry!r}{arc} {x + w - rx!r} {y + h!r}"
                f"H{x + rx!r}{arc} {x!r} {y + h - ry!r}V{y + ry!r}{arc} {x + rx!r} {y!r}Z"
            )
        case _:
            (x, y), (rx, ry) = round_of(element, style, units)
            if rx <= 0 or ry <= 0:
                return ""
            arc = f"A{rx!r} {ry!r} 0 0 1"
            return f"M{x - rx!r} {y!r}{arc} {x + rx!r} {y!r}{arc} {x - rx!r} {y!r}Z"


def round_of(element: Element, style: Mapping[str, str], units: Units) -> tuple[Point, Point]:
    """Middle and radii of a circle or an ellipse, in user units."""
    x = length_of(style.get("cx"), units.view[0], units) or 0.0
    y = length_of(style.get("cy"), units.view[1], units) or 0.0
    if name_of(element) == "circle":
        radius = _positive(style.get("r"), units.diagonal, units) or 0.0
        return (x, y), (radius, radius)
    return (x, y), radii_of(style, units)


def radii_of(style: Mapping[str, str], units: Units) -> Point:
    """Radii along x and y; one that is not given, or below 0, is like the other."""
    rx = _positive(style.get("rx"), units.view[0], units)
    ry = _positive(style.get("ry"), units.view[1], units)
    return (rx if rx is not None else ry or 0.0), (ry if ry is not None else rx or 0.0)


def _positive(text: str | None, whole: float, units: Units, *, below: bool = False) -> float | None:
    """Length that may not be below 0; None if it is, or none is written."""
    length = length_of(text, whole, units)
    return length if length is None or length >= 0 or below else None


def contours_of(segments: Any, matrix: AffineMap, room: int = MOST_POINTS) -> list[Contour]:
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
    from svg.path import Close, Move

    contours: list[Contour] = []
    places: list[complex] = []
    for segment in segments:
        if isinstance(segment, Move | Close):
            _add(contours, places, closed=isinstance(segment, Close))
            room -= len(places)
            places = [matrix.put(segment.end)]
        else:
            places += _chords(segment, matrix)
        if len(places) > room:
            break
    _add(contours, places, closed=False)
    return contours


def _add(contours: list[Contour], places: list[complex], *, closed: bool) -> None:
    """Add a contour, each place of it once; none if it has no length."""
    points: list[Point] = []
    for place in places:
        x, y = round(place.real, _DECIMALS) + 0.0, round(place.imag, _DECIMALS) + 0.0
        if not (abs(x) <= MOST_MM and abs(y) <= MOST_MM):
            raise ValueError(TOO_FAR)
        if not points or points[-1] != (x, y):
            points.append((x, y))
    if closed or (len(points) > 3 and points[0] == points[-1]):
        closed = True
        while len(points) > 1 and points[-1] == points[0]:
            points.pop()
    if len(points) == 2:
        closed = False
    if len(points) >= 2:
        contours.append(Contour(tuple(points), closed))


def _chords(segment: Any, matrix: AffineMap) -> list[complex]:
    """Ends of the chords in place of a segment, without its start."""
    from svg.path import Arc, CubicBezier, QuadraticBezier

    end = matrix.put(segment.end)
    # A chord is within h² |B''| / 8 of its curve, h being its share of it.
    if isinstance(segment, CubicBezier):
        start, one, two = map(matrix.put, (segment.start, segment.control1, segment.control2))
        bend = 6 * max(abs(start - 2 * one + two), abs(one - 2 * two + end))
        return [
            start * u**3 + 3 * one * t * u * u + 3 * two * t * t * u + end * t**3
            for t, u in ((t, 1 - t) for t in _shares(bend))
        ]
    if isinstance(segment, QuadraticBezier):
        start, one = matrix.put(segment.start), matrix.put(segment.control)
        bend = 2 * abs(start - 2 * one + end)
        return [start * (1 - t) ** 2 + 2 * one * t * (1 - t) + end * t * t for t in _shares(bend)]
    if isinstance(segment, Arc) and segment.start != segment.end:
        radii = segment.radius.real, segment.radius.imag
        if all(radii):
            largest = max(radii) * segment.radius_scale * matrix.largest
            bend = largest * math.radians(segment.delta) ** 2
            return [*(matrix.put(segment.point(t)) for t in _shares(bend)[:-1]), end]
    return [end]


def _shares(bend: float) -> list[float]:
    """Places between 0 and 1, the last 1, for a second derivative of at most ``bend`` mm."""
    if not math.isfinite(bend):
        raise ValueError(TOO_FAR)
    count = max(math.ceil(math.sqrt(bend / (8 * FLATNESS_MM))), 1)
    count = min(count, _MOST_CHORDS)
    return [number / count for number in range(1, count + 1)]


def corners_of(segments: Any) -> list[Corner]:
    """Vertices of a path, at which markers stand."""
    from svg.path import Close, Move

    corners: list[Corner] = []
    first = 0
    closing = 0j
    for segment in segments:
        if isinstance(segment, Move):
            first = len(corners)
            corners.append(Corner(segment.end, 0j, 0j))
            continue
        if not corners:
            return []
        away, arrives = _directions(segment)
        last = corners[-1]
        corners[-1] = Corner(last.place, last.before, away or last.before)
        corners.append(Corner(segment.end, arrives or away, 0j))
        if isinstance(segment, Close):
            start = corners[first]
            closing = arrives or corners[-2].before
            corners[-1] = Corner(segment.end, closing, start.after)
            corners[first] = Corner(start.place, closing, start.after)
    return corners


def _directions(segment: Any) -> tuple[complex, complex]:
    """Unit vectors at the start and the end of a segment; 0 where it has no length."""
    from svg.path import Arc, CubicBezier, QuadraticBezier

    start, end = segment.start, segment.end
    if isinstance(segment, CubicBezier):
        ways = [segment.control1 - start, segment.control2 - start, end - start]
        back = [end - segment.control2, end - segment.control1, end - start]
    elif isinstance(segment, QuadraticBezier):
        ways, back = [segment.control - start, end - start], [end - segment.control, end - start]
    elif isinstance(segment, Arc) and start != end:
        ways, back = [segment.point(1e-3) - start, end - start], [end - segment.point(1 - 1e-3)]
    else:
        ways = back = [end - start]
    return _first_way(ways), _first_way(back)


def _first_way(ways: Iterable[complex]) -> complex:
    return next((way / abs(way) for way in ways if abs(way) > 1e-9), 0j)


def filled(rings: Sequence[Ring], rule: str) -> tuple[list[Ring], bool]:
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
        The rings, and whether they are right: outlines of more than 5,000 places are left as they
        are, which is wrong where they cross or overlap.
    """
    pyclipper = _clipper()
    if sum(map(len, rings)) > _MOST_CUT:
        return list(rings), rule == "evenodd"
    kind = pyclipper.PFT_EVENODD if rule == "evenodd" else pyclipper.PFT_NONZERO
    done = pyclipper.SimplifyPolygons([_whole(ring) for ring in rings], kind)
    found = [ring for ring in map(_ring, done) if len(ring) >= 3]
    same = sorted(map(sorted, found)) == sorted(map(sorted, rings))
    return (list(rings) if same else found), True


def cut(rings: Sequence[Ring], clip: Sequence[Ring]) -> list[Ring]:
    """Parts of an area that are within another, both by the even-odd rule."""
    pyclipper = _clipper()
    if not rings or not clip or sum(map(len, (*rings, *clip))) > 10 * _MOST_CUT:
        return list(rings) if clip else []
    clipper = pyclipper.Pyclipper()
    try:
        clipper.AddPaths([_whole(ring) for ring in rings], pyclipper.PT_SUBJECT, True)
        clipper.AddPaths([_whole(ring) for ring in clip], pyclipper.PT_CLIP, True)
        done = clipper.Execute(
            pyclipper.CT_INTERSECTION, pyclipper.PFT_EVENODD, pyclipper.PFT_EVENODD
        )
    except pyclipper.ClipperException:  # nothing with an area is left
        return []
    return [ring for ring in map(_ring, done) if len(ring) >= 3]


def stroked(contours: Sequence[Contour], width_mm: float, style: Mapping[str, str]) -> list[Ring]:
    """Area of a stroke, as rings by the even-odd rule."""
    pyclipper = _clipper()
    joins = {"round": pyclipper.JT_ROUND, "bevel": pyclipper.JT_SQUARE}
    ends = {"round": pyclipper.ET_OPENROUND, "square": pyclipper.ET_OPENSQUARE}
    join = joins.get(style.get("stroke-linejoin", "miter"), pyclipper.JT_MITER)
    end = ends.get(style.get("stroke-linecap", "butt"), pyclipper.ET_OPENBUTT)
    offset = pyclipper.PyclipperOffset(4.0, FLATNESS_MM * _CLIPPER)
    for contour in contours:
        kind = pyclipper.ET_CLOSEDLINE if contour.closed else end
        offset.AddPath(_whole(contour.points_mm), join, kind)
    return [ring for ring in map(_ring, offset.Execute(width_mm / 2 * _CLIPPER)) if len(ring) >= 3]


def is_within(rings: Sequence[Ring], clip: Sequence[Ring]) -> bool:
    """Tell whether an area is wholly within another, but for a thousandth of it."""
    return area(cut(rings, clip)) >= area(rings) * 0.999


def area(rings: Sequence[Ring]) -> float:
    """Area of rings of Clipper's, whose holes go round the other way, in mm²."""
    return abs(sum(_turned_area(ring) for ring in rings))


def _turned_area(ring: Ring) -> float:
    pairs = zip(ring, (*ring[1:], ring[0]), strict=True)
    return sum(x0 * y1 - x1 * y0 for (x0, y0), (x1, y1) in pairs) / 2


def _clipper() -> Any:
    """Library of Clipper, whose types are not declared."""
    import pyclipper

    return pyclipper


def _whole(ring: Iterable[Point]) -> list[tuple[int, int]]:
    return [(round(x * _CLIPPER), round(y * _CLIPPER)) for x, y in ring]


def _ring(path: Iterable[Sequence[int]]) -> Ring:
    return tuple((x / _CLIPPER + 0.0, y / _CLIPPER + 0.0) for x, y in path)
