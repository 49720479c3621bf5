"""Going through the patterns of a scene, those within others included."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.scene.patterns import Circle, Group, Image, Path, Polygon, Tile

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.scene.patterns import AnyPattern


def children(pattern: AnyPattern) -> tuple[AnyPattern, ...]:
    """Patterns that stand directly in a pattern, in the order in which they are written."""
    if isinstance(pattern, Group):
        return (*pattern.parts, pattern.by) if pattern.by is not None else pattern.parts
    if isinstance(pattern, Tile):
        return (pattern.part,)
    if isinstance(pattern, Image):
        return () if pattern.texture is None else (pattern.texture,)
    if isinstance(pattern, Circle | Polygon | Path) and pattern.fill is not None:
        return (pattern.fill.texture,)
    return ()


def each(*patterns: AnyPattern) -> Iterator[AnyPattern]:
    """Patterns and all that stand in them, at any depth, each before what stands in it."""
    left = list(reversed(patterns))
    while left:
        pattern = left.pop()
        yield pattern
        left += reversed(children(pattern))
