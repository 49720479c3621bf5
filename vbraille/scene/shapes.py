"""What shapes have in common, and the line, which has nothing in it: Lévesque 2009, 8.4.3.

Shapes with a fill are in `vbraille.scene.patterns`, since any pattern may fill them.
"""

from __future__ import annotations

import math

from vbraille.scene.measures import LEAST_APART_MM, Point, check_point
from vbraille.scene.pattern import Pattern
from vbraille.scene.strokes import Dotting, Stroke


class Shape(Pattern, frozen=True, kw_only=True):
    """What shapes of every kind have in common: a stroke, or dots in its place.

    Parameters
    ----------
    stroke
        Stroke along the shape; None for none.
    dots
        Dots along the shape, in place of a stroke; None for none.

    Raises
    ------
    ValueError
        If it has both.
    """

    stroke: Stroke | None = None
    dots: Dotting | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.stroke is not None and self.dots is not None:
            raise ValueError("dots cannot be given beside a stroke; leave one out")


class StraightLine(Shape, frozen=True, kw_only=True, tag="line"):
    """A straight line with round ends: Lévesque 2009, eqs. 8.15-8.17.

    Parameters
    ----------
    start_mm, end_mm
        The two ends; textures along it begin at the first.

    Raises
    ------
    ValueError
        If a number is out of range, or both ends are one place.
    """

    start_mm: Point
    end_mm: Point

    def __post_init__(self) -> None:
        super().__post_init__()
        check_point("start", self.start_mm)
        check_point("end", self.end_mm)
        if math.dist(self.start_mm, self.end_mm) < LEAST_APART_MM:
            raise ValueError("end is where the line starts; a line needs two places")
        check_drawn(self, None)


def check_points(what: str, points_mm: tuple[Point, ...], least: int, *, closed: bool) -> None:
    """Refuse too few places, and places that follow each other and are one."""
    if len(points_mm) < least:
        raise ValueError(f"{what} are {len(points_mm)}; there must be {least} or more")
    for number, point in enumerate(points_mm, 1):
        check_point(f"{what}, number {number}", point)
        if number > 1 and math.dist(point, points_mm[number - 2]) < LEAST_APART_MM:
            raise ValueError(f"{what}, number {number} is the place before it; leave it out")
    if closed and math.dist(points_mm[-1], points_mm[0]) < LEAST_APART_MM:
        raise ValueError(f"{what}, number {len(points_mm)} is the first place; leave it out")


def check_drawn(shape: Shape, fill: object) -> None:
    """Refuse a shape of which nothing can be felt."""
    if shape.stroke is None and shape.dots is None and fill is None:
        raise ValueError("a shape needs a stroke, dots or a fill; add one")
