"""Outlines of SVG's shapes as places on the canvas, with curves flattened once."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from vbraille.scene.measures import MOST_MM

if TYPE_CHECKING:
    from vbraille.scene.measures import Point
    from vbraille.scene.svg.numbers import AffineMap

# How far a chord may be from its curve. No array shows less.
FLATNESS_MM = 0.05
MOST_POINTS = 500_000  # of a drawing
_MOST_CHARACTERS = 2_000_000  # of the text of a path
_NOT_UNDERSTOOD = "its text is not understood"
# What may stand between commands, and how many numbers each command takes at a time. The flags of
# arcs may stand without spaces, so theirs are not counted.
_COMMAND = re.compile(r"([MmZzLlHhVvCcSsQqTtAa])([-+0-9.eE,\s]*)", re.ASCII)
_NUMBERS = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?", re.ASCII)
_COUNTS = {"M": 2, "Z": 0, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 1}
_DECIMALS = 4  # of a millimetre: points that are equal so far are one
_MOST_CHORDS = 10_000  # of a curve


@dataclass(frozen=True, slots=True)
class Contour:
    """Places of a line, in mm, and whether it goes back to its first place."""

    points_mm: tuple[Point, ...]
    closed: bool


def contours_of_path(d: str, matrix: AffineMap, room: int = MOST_POINTS) -> list[Contour]:
    """Contours of the text of a path.

    Parameters
    ----------
    d
        The text, as of the attribute ``d``.
    matrix
        Map from its coordinates to mm on the canvas.
    room
        How many places it may have; after those it is not read on.

    Returns
    -------
    list of Contour
        The contours, without those that have no length.

    Raises
    ------
    ValueError
        If the text is not understood, or goes too far.
    """
    from svg.path import Close, Move

    contours: list[Contour] = []
    places: list[complex] = []
    for segment in _segments(d):
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


def contour(places: list[complex], matrix: AffineMap, *, closed: bool) -> list[Contour]:
    """Contour through places that are given in other coordinates; none if it has no length.

    Raises
    ------
    ValueError
        If it goes too far.
    """
    contours: list[Contour] = []
    _add(contours, [matrix.put(place) for place in places], closed=closed)
    return contours


def _add(contours: list[Contour], places: list[complex], *, closed: bool) -> None:
    """Add a contour, each place of it once."""
    points: list[Point] = []
    for place in places:
        x, y = round(place.real, _DECIMALS) + 0.0, round(place.imag, _DECIMALS) + 0.0
        if not (abs(x) <= MOST_MM and abs(y) <= MOST_MM):
            raise ValueError("it goes farther than 10 m from the drawing's corner")
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


def _segments(d: str) -> Any:
    """Segments of the text of a path, which is one as a whole.

    The library leaves off without a word where some texts go wrong.
    """
    from svg.path import parse_path

    end = 0
    for found in _COMMAND.finditer(d):
        numbers = _NUMBERS.findall(found[2])
        count = _COUNTS[found[1].upper()]
        wrong = len(numbers) % count or not numbers if count else numbers
        if wrong or d[end : found.start()].strip() or len(d) > _MOST_CHARACTERS:
            raise ValueError(_NOT_UNDERSTOOD)
        end = found.end()
    if end < len(d.rstrip()) or d.lstrip()[:1].upper() != "M":
        raise ValueError(_NOT_UNDERSTOOD)
    try:
        return parse_path(d)
    # It means to raise ValueError, and for some texts raises what its own code does.
    except (ValueError, ArithmeticError, AttributeError, IndexError, TypeError, AssertionError):
        raise ValueError(_NOT_UNDERSTOOD) from None


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
        raise ValueError("it goes farther than 10 m from the drawing's corner")
    count = max(math.ceil(math.sqrt(bend / (8 * FLATNESS_MM))), 1)
    count = min(count, _MOST_CHORDS)
    return [number / count for number in range(1, count + 1)]
