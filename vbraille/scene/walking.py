"""Going through the patterns of a scene, those within others included, and exchanging them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec.structs import replace

from vbraille.scene.patterns import Circle, Group, Image, PathShape, Polygon, Tile

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

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
    if isinstance(pattern, Tile):
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
    if isinstance(pattern, Tile):
        return replace(pattern, part=changed["part",])
    if isinstance(pattern, Image):
        return replace(pattern, texture=changed["texture",])
    assert isinstance(pattern, Circle | Polygon | PathShape)
    assert pattern.fill is not None
    return replace(pattern, fill=replace(pattern.fill, texture=changed["fill", "texture"]))
