"""Bounds of patterns: outside them a pattern rests, so that it is not looked at there."""

from __future__ import annotations

import math
from functools import reduce
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

from vbraille.scene.patterns import Circle, Dots, Group, Image, ImageDots, Label, Shape, Use
from vbraille.scene.traversal import points_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from vbraille.scene.measures import Point
    from vbraille.scene.pattern import Pattern
    from vbraille.scene.patterns import AnyPattern


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
