"""Patterns moved over the canvas."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from msgspec.structs import replace

from vbraille.scene.patterns import Tile
from vbraille.scene.walking import with_children

if TYPE_CHECKING:
    from vbraille.scene.measures import Point
    from vbraille.scene.patterns import AnyPattern

# The fields of patterns that are a place, places, and lists of places.
ONE = ("start_mm", "end_mm", "center_mm", "origin_mm", "place_mm", "move_mm")
SEVERAL = ("vertices_mm", "centers_mm")
LISTS = ("contours_mm",)


def moved(pattern: AnyPattern, move_mm: Point) -> AnyPattern:
    """Pattern moved by value: all its places, and those of what stands in it, are changed.

    Parameters
    ----------
    pattern
        The pattern. A tile's part stays where it is in its tile, which moves.
    move_mm
        How far it is moved, right and down.

    Raises
    ------
    ValueError
        If something would be farther than 10 m from the origin.

    >>> from vbraille.scene.patterns import Circle
    >>> from vbraille.scene.strokes import Stroke
    >>> moved(Circle(center_mm=(10, 20), radius_mm=5, stroke=Stroke()), (1, -2)).center_mm
    (11, 18)
    """
    if move_mm == (0.0, 0.0):
        return pattern
    here = replace(pattern, **_places(pattern, move_mm))
    if isinstance(here, Tile):
        return here
    return with_children(here, lambda _, part: moved(part, move_mm))


def _places(pattern: AnyPattern, move_mm: Point) -> dict[str, Any]:
    """Fields of a pattern that are places, moved."""
    dx_mm, dy_mm = move_mm
    found: dict[str, Any] = {}
    for name in pattern.__struct_fields__:
        value = getattr(pattern, name)
        if name in ONE:
            found[name] = (value[0] + dx_mm, value[1] + dy_mm)
        elif name in SEVERAL:
            found[name] = tuple((x + dx_mm, y + dy_mm) for x, y in value)
        elif name in LISTS:
            found[name] = tuple(tuple((x + dx_mm, y + dy_mm) for x, y in one) for one in value)
    return found
