"""Arrows over pictures for what moves, and for hands that signals answer; Lévesque 2009, 9.6."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vbraille.scene.bounds import Box, bounds
from vbraille.scene.measures import travel_deg
from vbraille.scene.patterns import Circle, Moving, PathShape, Polygon, Shape, StraightLine
from vbraille.scene.signals import Direction, made_of
from vbraille.scene.textures import AxialGrating, LinearGrating, RadialGrating
from vbraille.scene.traversal import each, signals_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from numpy.typing import NDArray

    from vbraille.scene.measures import Point
    from vbraille.scene.patterns import AnyPattern, Image, Label
    from vbraille.scene.scene import Scene

_LEAST_MM, _MOST_MM = 4.0, 16.0
_SECONDS = 0.5  # an arrow is as long as the way in that time, within these bounds
_LARGEST = 0.5  # of the smaller side of what an arrow stands in
_BESIDE_MM = 4.0  # from one arrow of an element to its next
_ARC_STEPS = 12


class Arrow(NamedTuple):
    """An arrow on a picture.

    Parameters
    ----------
    points_mm : float64[n, 2]
        Points of the line, two or more; the head is at the last.
    hollow
        Whether it stands for a direction of the hand, not for a motion.
    both
        Whether it has a head at the first point, too.
    """

    points_mm: NDArray[np.float64]
    hollow: bool = False
    both: bool = False


def arrows(scene: Scene, known: Mapping[Image | Label, Box]) -> list[Arrow]:
    """Find the arrows of a scene, as its patterns stand in each other.

    Parameters
    ----------
    scene
        A resolved scene.
    known
        Boxes of its images and labels.
    """
    canvas = Box(0.0, 0.0, scene.canvas.width_mm, scene.canvas.height_mm)
    found: list[Arrow] = []
    for element in scene.elements:
        box = (bounds(element, known) or canvas).common(canvas)
        if box.is_empty:
            continue
        beside = 0
        preferred: dict[str, Direction] = {}
        for part in each(element):
            moving = list(_motion(part, box))
            free = bool(moving) and not isinstance(part, Shape)
            found += [_lower(arrow, beside if free else 0) for arrow in moving]
            beside += free
            for _, name in signals_of(part):
                preferred.update(_directions(scene, name))
        for way in preferred.values():
            points = _straight(_middle(box), way.angle_deg, _size(math.inf, box))
            found.append(_lower(Arrow(points, hollow=True, both=way.axis), beside))
            beside += 1
    return found


def _directions(scene: Scene, name: str) -> Iterator[tuple[str, Direction]]:
    """Names and values of the signals of directions that a signal is made of."""
    signal = scene.signals[name]
    if isinstance(signal, Direction):
        yield name, signal
    for one in made_of(signal):
        yield from _directions(scene, one)


def _motion(part: AnyPattern, box: Box) -> Iterator[Arrow]:
    """Arrows of what a pattern itself moves, in the box of its element."""
    middle, wave = _middle(box), next(iter(part.flows), None)
    if isinstance(part, Moving) and any(part.velocity_mm_s):
        right, down = part.velocity_mm_s
        length_mm = _size(math.hypot(right, down), box)
        yield Arrow(_straight(middle, math.degrees(math.atan2(down, right)), length_mm))
    if wave is None:
        return
    back = wave.speed < 0
    length_mm = _size(abs(wave.speed), box)
    if isinstance(part, LinearGrating):
        angle = travel_deg(part.wave_angle_deg, part.ridge_angle_deg) + 180.0 * back
        yield Arrow(_straight(middle, angle, length_mm))
    elif isinstance(part, RadialGrating):
        for angle in range(0, 360, 90):
            unit = np.array((math.cos(math.radians(angle)), math.sin(math.radians(angle))))
            ends = part.center_mm + np.outer((0.25, 1.25), length_mm * unit)
            yield Arrow(ends[::-1] if back else ends)
    elif isinstance(part, AxialGrating):
        radius_mm = _size(math.inf, box) / 2
        for angle in (0.0, 180.0):
            yield Arrow(_arc(part.center_mm, radius_mm, angle, angle + 120.0, back=back))
    elif isinstance(part, Circle):
        turn = math.degrees(length_mm / part.radius_mm)
        for angle in (0.0, 180.0):
            arc = _arc(part.center_mm, part.radius_mm, angle, angle + min(turn, 120.0), back=back)
            yield Arrow(arc)
    elif isinstance(part, StraightLine | Polygon | PathShape):
        for first, last in _edges(part):
            away = np.subtract(last, first)
            angle = math.degrees(math.atan2(away[1], away[0])) + 180.0 * back
            length = min(length_mm, 0.8 * float(np.hypot(*away)))
            yield Arrow(_straight(np.add(first, last) / 2, angle, length))


def _edges(shape: StraightLine | Polygon | PathShape) -> list[tuple[Point, Point]]:
    """Longest straight piece of each path of a shape, by its ends."""
    if isinstance(shape, StraightLine):
        return [(shape.start_mm, shape.end_mm)]
    closed = isinstance(shape, Polygon) or shape.closed
    contours = (shape.vertices_mm,) if isinstance(shape, Polygon) else shape.contours_mm
    return [
        max(
            zip(points, (*points[1:], *(points[:1] if closed else ())), strict=False),
            key=lambda ends: math.dist(*ends),
        )
        for points in contours
        if len(points) > 1
    ]


def _middle(box: Box) -> NDArray[np.float64]:
    return np.array((box.left + box.right, box.top + box.bottom)) / 2


def _size(speed_mm_s: float, box: Box) -> float:
    """Length of an arrow for a speed, in mm."""
    length_mm = min(max(_SECONDS * speed_mm_s, _LEAST_MM), _MOST_MM)
    room = max(box.right - box.left, box.bottom - box.top)
    return min(length_mm, max(_LARGEST * room, _LEAST_MM / 2))


def _straight(
    middle_mm: NDArray[np.float64], angle_deg: float, length_mm: float
) -> NDArray[np.float64]:
    angle = math.radians(angle_deg)
    half = 0.5 * length_mm * np.array((math.cos(angle), math.sin(angle)))
    return np.array((middle_mm - half, middle_mm + half))


def _arc(
    center_mm: Point, radius_mm: float, first_deg: float, last_deg: float, *, back: bool
) -> NDArray[np.float64]:
    angles = np.radians(np.linspace(first_deg, last_deg, _ARC_STEPS))
    points = center_mm + radius_mm * np.stack((np.cos(angles), np.sin(angles)), axis=-1)
    return points[::-1] if back else points


def _lower(arrow: Arrow, places: int) -> Arrow:
    """Put an arrow below others of its element."""
    return arrow._replace(points_mm=np.add(arrow.points_mm, (0.0, places * _BESIDE_MM)))
