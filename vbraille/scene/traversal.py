"""Going through the patterns of a scene, exchanging those within others, and moving them."""

from __future__ import annotations

import operator
from typing import TYPE_CHECKING, Any

from msgspec.structs import replace

from vbraille.scene.patterns import Fill, Pattern, SignalLevel, Tile, UniformVibration, Vibration

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

    from vbraille.scene.measures import Point, RidgeWave
    from vbraille.scene.patterns import AnyPattern
    from vbraille.toml import Table


# Keys, and indices of items, that lead from a pattern or a scene to a pattern in it.
Steps = tuple[str | int, ...]

# Keys of patterns under which others stand, keys of what a pattern draws with, keys of a name of a
# signal, and keys of places, of several places, and of lists of them.
_INNER = ("parts", "by", "part", "texture", "fill")
_DRAWN = ("stroke", "along", "dots", "dot", "cue", "markers")
_DRIVEN = ("factor", "velocity_by")
_WAVES: dict[Steps, str] = {
    (): "a grating",
    ("along",): "a grating along a stroke",
    ("cue",): "a cue",
    ("dots",): "a row of dots",
}
ONE = ("start_mm", "end_mm", "center_mm", "origin_mm", "place_mm", "move_mm", "array_at_mm")
SEVERAL = ("vertices_mm", "centers_mm", "contours_mm")


def with_children(
    pattern: AnyPattern, change: Callable[[Steps, AnyPattern], AnyPattern]
) -> AnyPattern:
    """Pattern in which each one that stands directly in it is exchanged for another.

    Parameters
    ----------
    pattern
        The pattern.
    change
        Function that is given the keys that lead to an inner pattern, and that pattern, and gives
        what is to stand there.
    """

    def changed(value: Any, steps: Steps) -> Any:
        if isinstance(value, Pattern):
            return change(steps, value)  # pyright: ignore[reportArgumentType]
        if isinstance(value, Fill):
            texture = change((*steps, "texture"), value.texture)
            return value if texture is value.texture else replace(value, texture=texture)
        if isinstance(value, tuple):
            items = tuple(changed(item, (*steps, number)) for number, item in enumerate(value))
            return value if all(map(operator.is_, items, value)) else items
        return value

    changes: dict[str, Any] = {}
    for key in _INNER:
        value = getattr(pattern, key, None)
        new = changed(value, (key,))
        if new is not value:
            changes[key] = new
    return replace(pattern, **changes) if changes else pattern


def placed_children(pattern: AnyPattern) -> list[tuple[Steps, AnyPattern]]:
    """Patterns that stand directly in a pattern, with the keys that lead from it to each.

    >>> from vbraille.scene.patterns import Tile
    >>> from vbraille.scene.patterns import Uniform
    >>> [steps for steps, _ in placed_children(Tile(width_mm=5, height_mm=5, part=Uniform()))]
    [('part',)]
    """
    found: list[tuple[Steps, AnyPattern]] = []

    def note(steps: Steps, part: AnyPattern) -> AnyPattern:
        found.append((steps, part))
        return part

    with_children(pattern, note)
    return found


def children(pattern: AnyPattern) -> list[AnyPattern]:
    """Patterns that stand directly in a pattern, in the order in which they are written."""
    return [part for _, part in placed_children(pattern)]


def lines_of(
    elements: Iterable[AnyPattern], made: Mapping[int, tuple[AnyPattern, int]]
) -> dict[Steps, int]:
    """Lines of the elements of a scene, and of what stands in them, by the keys that lead to them.

    Parameters
    ----------
    elements
        The elements.
    made
        Patterns that have a line, with that, by their ids.
    """
    lines: dict[Steps, int] = {}
    left: list[tuple[Steps, AnyPattern]] = [
        (("elements", n), one) for n, one in enumerate(elements)
    ]
    while left:
        steps, pattern = left.pop()
        if id(pattern) in made:
            lines[steps] = made[id(pattern)][1]
        left += [((*steps, *more), part) for more, part in placed_children(pattern)]
    return lines


def mapped(pattern: AnyPattern, change: Callable[[AnyPattern], AnyPattern]) -> AnyPattern:
    """Pattern in which it and all that stands in it is what a function makes of it."""
    return with_children(change(pattern), lambda _, part: mapped(part, change))


def each(*patterns: AnyPattern) -> Iterator[AnyPattern]:
    """Patterns and all that stand in them, at any depth, each before what stands in it."""
    left = list(reversed(patterns))
    while left:
        pattern = left.pop()
        yield pattern
        left += reversed(children(pattern))


def drawn_with(table: Table, steps: Steps = ()) -> Iterator[tuple[Steps, Table]]:
    """A pattern and the tables of what it draws itself: its stroke, dots, cue and the like."""
    yield steps, table
    for key in _DRAWN:
        inner = getattr(table, key, None)
        if inner is not None:
            yield from drawn_with(inner, (*steps, key))


def waves_of(pattern: AnyPattern) -> list[tuple[str, RidgeWave]]:
    """Ridges and gaps of what a pattern draws itself, with what they are."""
    waves = [(steps, getattr(table, "wave", None)) for steps, table in drawn_with(pattern)]
    return [(_WAVES[steps[-1:]], wave) for steps, wave in waves if wave is not None]


def drawn_vibrations(pattern: AnyPattern) -> list[Vibration]:
    """Vibrations of what a pattern draws itself, beside that of all of it."""
    found: list[Vibration | None] = []
    if isinstance(pattern, UniformVibration):
        found.append(Vibration(frequency_hz=pattern.frequency_hz))
    for steps, table in drawn_with(pattern):
        if steps:
            found.append(getattr(table, "swing" if hasattr(table, "swing") else "vibration", None))
            found.append(getattr(table, "vertex_vibration", None))
    return [vibration for vibration in found if vibration is not None]


def vibrations(pattern: AnyPattern) -> list[Vibration]:
    """Every vibration of a pattern and of what stands in it."""
    found = ((part.vibration, *drawn_vibrations(part)) for part in each(pattern))
    return [vibration for some in found for vibration in some if vibration is not None]


def signals_of(pattern: AnyPattern) -> list[tuple[Steps, str]]:
    """Names of the signals that a pattern itself uses, with the keys that lead to each."""
    return [
        ((*steps, key), name)
        for steps, table in drawn_with(pattern)
        for key, name in _driven(table).items()
    ]


def _driven(table: Table) -> dict[str, str]:
    """Names of the signals that a table itself uses, by their keys."""
    keys = ("name", *_DRIVEN) if isinstance(table, SignalLevel) else _DRIVEN
    return {key: name for key in keys if (name := getattr(table, key, ""))}


def driving(*patterns: AnyPattern) -> list[str]:
    """Names of the signals that are the speed of a motion in patterns and what stands in them."""
    used = (one for part in each(*patterns) for one in signals_of(part))
    return [name for steps, name in used if steps[-1] == "velocity_by"]


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
    >>> from vbraille.scene.patterns import Stroke
    >>> moved(Circle(center_mm=(10, 20), radius_mm=5, stroke=Stroke()), (1, -2)).center_mm
    (11, 18)
    """
    if move_mm == (0.0, 0.0):
        return pattern
    dx_mm, dy_mm = move_mm
    here = replace(pattern, **placed(pattern, lambda x, y: (x + dx_mm, y + dy_mm)))
    if isinstance(here, Tile):
        return here
    return with_children(here, lambda _, part: moved(part, move_mm))


def placed(pattern: AnyPattern, place: Callable[[float, float], Point]) -> dict[str, Any]:
    """Fields of a pattern that are places, each where a function has it."""

    def at(value: Any) -> Any:
        if isinstance(value[0], tuple):
            return tuple(map(at, value))
        return place(*value)

    places = {key: getattr(pattern, key, None) for key in (*ONE, *SEVERAL)}
    return {key: at(value) for key, value in places.items() if value is not None}


def points_of(pattern: AnyPattern) -> list[Point]:
    """The places that a pattern has itself."""
    found: list[Point] = []

    def note(x_mm: float, y_mm: float) -> Point:
        found.append((x_mm, y_mm))
        return x_mm, y_mm

    placed(pattern, note)
    return found
