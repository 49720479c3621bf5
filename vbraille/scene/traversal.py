"""Going through the patterns of a scene, exchanging those within others, and moving them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from msgspec.structs import replace

from vbraille.scene.patterns import (
    Circle,
    Dots,
    Group,
    Image,
    ImageDots,
    Moving,
    PathShape,
    Polygon,
    Shape,
    Tile,
)
from vbraille.scene.strokes import Vibration
from vbraille.scene.textures import SignalLevel, UniformVibration

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from vbraille.scene.measures import Point
    from vbraille.scene.patterns import AnyPattern


# Keys, and indices of items, that lead from a pattern or a scene to a pattern in it.
Steps = tuple[str | int, ...]


def children(pattern: AnyPattern) -> tuple[AnyPattern, ...]:
    """Patterns that stand directly in a pattern, in the order in which they are written."""
    return tuple(part for _, part in placed_children(pattern))


def placed_children(pattern: AnyPattern) -> list[tuple[Steps, AnyPattern]]:
    """Patterns that stand directly in a pattern, with the keys that lead from it to each.

    >>> from vbraille.scene.patterns import Tile
    >>> from vbraille.scene.textures import Uniform
    >>> [steps for steps, _ in placed_children(Tile(width_mm=5, height_mm=5, part=Uniform()))]
    [('part',)]
    """
    if isinstance(pattern, Group):
        parts: list[tuple[Steps, AnyPattern]] = [
            (("parts", number), part) for number, part in enumerate(pattern.parts)
        ]
        return parts if pattern.by is None else [*parts, (("by",), pattern.by)]
    if isinstance(pattern, Tile | Moving):
        return [(("part",), pattern.part)]
    if isinstance(pattern, Image):
        return [] if pattern.texture is None else [(("texture",), pattern.texture)]
    if isinstance(pattern, Circle | Polygon | PathShape) and pattern.fill is not None:
        return [(("fill", "texture"), pattern.fill.texture)]
    return []


def each(*patterns: AnyPattern) -> Iterator[AnyPattern]:
    """Patterns and all that stand in them, at any depth, each before what stands in it."""
    left = list(reversed(patterns))
    while left:
        pattern = left.pop()
        yield pattern
        left += reversed(children(pattern))


def vibrations(pattern: AnyPattern) -> list[Vibration]:
    """Every vibration of a pattern and of what stands in it."""
    return [
        vibration
        for part in each(pattern)
        for vibration in (part.vibration, *drawn_vibrations(part))
        if vibration is not None
    ]


def drawn_vibrations(pattern: AnyPattern) -> list[Vibration]:
    """Vibrations of what a pattern draws itself, beside that of all of it."""
    found: list[Vibration | None] = []
    if isinstance(pattern, UniformVibration):
        found.append(Vibration(frequency_hz=pattern.frequency_hz))
    elif isinstance(pattern, Dots | ImageDots):
        found.append(pattern.dot.vibration)
    elif isinstance(pattern, Shape):
        found += [pattern.stroke.vibration] if pattern.stroke else []
        if pattern.dots is not None:
            found += [pattern.dots.dot.vibration, pattern.dots.vertex_vibration]
        if pattern.cue is not None:
            found.append(pattern.cue.swing)
        if isinstance(pattern, Polygon) and pattern.markers is not None:
            found.append(pattern.markers.swing)
    return [vibration for vibration in found if vibration is not None]


def driving(*patterns: AnyPattern) -> list[str]:
    """Names of the signals that are the speed of a motion in patterns and what stands in them."""
    return [
        name
        for part in each(*patterns)
        for key, name in signals_of(part)
        if key[-1] == "velocity_by"
    ]


def signals_of(pattern: AnyPattern) -> list[tuple[Steps, str]]:
    """Names of the signals that a pattern itself uses, with the keys that lead to each."""
    found: list[tuple[Steps, str]] = [(("factor",), pattern.factor)]
    if isinstance(pattern, SignalLevel):
        found.append((("name",), pattern.name))
    elif isinstance(pattern, Shape):
        if pattern.stroke is not None and pattern.stroke.along is not None:
            found.append((("stroke", "along", "velocity_by"), pattern.stroke.along.velocity_by))
        if pattern.dots is not None:
            found.append((("dots", "velocity_by"), pattern.dots.velocity_by))
        if pattern.cue is not None:
            found.append((("cue", "velocity_by"), pattern.cue.velocity_by))
    else:
        found.append((("velocity_by",), getattr(pattern, "velocity_by", "")))
    return [(steps, name) for steps, name in found if name]


def with_name(pattern: AnyPattern, steps: Steps, name: str) -> AnyPattern:
    """Pattern with another name of a signal where `signals_of` found one."""
    values: list[Any] = [pattern]
    for key in steps[:-1]:
        values.append(getattr(values[-1], str(key)))
    made: Any = name
    for value, key in zip(reversed(values), reversed(steps), strict=True):
        made = replace(value, **{str(key): made})
    return made


def with_signals(pattern: AnyPattern, names: Mapping[str, str]) -> AnyPattern:
    """Pattern that uses signals under other names, as does all that stands in it."""
    for steps, name in signals_of(pattern):
        pattern = with_name(pattern, steps, names[name])
    return with_children(pattern, lambda _, part: with_signals(part, names))


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
    changed = {steps: change(steps, part) for steps, part in placed_children(pattern)}
    if all(changed[steps] is part for steps, part in placed_children(pattern)):
        return pattern
    if isinstance(pattern, Group):
        parts = tuple(changed["parts", number] for number in range(len(pattern.parts)))
        return replace(pattern, parts=parts, by=changed.get(("by",)))
    if isinstance(pattern, Tile | Moving):
        return replace(pattern, part=changed["part",])
    if isinstance(pattern, Image):
        return replace(pattern, texture=changed["texture",])
    assert isinstance(pattern, Circle | Polygon | PathShape)
    assert pattern.fill is not None
    return replace(pattern, fill=replace(pattern.fill, texture=changed["fill", "texture"]))


# The fields of patterns that are a place, places, and lists of places.
ONE = (
    "start_mm",
    "end_mm",
    "center_mm",
    "origin_mm",
    "place_mm",
    "move_mm",
    "array_at_mm",
)
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
    dx_mm, dy_mm = move_mm
    here = replace(pattern, **placed(pattern, lambda x, y: (x + dx_mm, y + dy_mm)))
    if isinstance(here, Tile):
        return here
    return with_children(here, lambda _, part: moved(part, move_mm))


def placed(pattern: AnyPattern, place: Callable[[float, float], Point]) -> dict[str, Any]:
    """Fields of a pattern that are places, each where a function has it."""
    found: dict[str, Any] = {}
    for name in pattern.__struct_fields__:
        value = getattr(pattern, name)
        if value is None:
            continue
        if name in ONE:
            found[name] = place(*value)
        elif name in SEVERAL:
            found[name] = tuple(place(x, y) for x, y in value)
        elif name in LISTS:
            found[name] = tuple(tuple(place(x, y) for x, y in one) for one in value)
    return found
