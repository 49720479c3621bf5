"""The patterns that stand in another one: which they are, and how they are exchanged."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec.structs import replace

from vbraille.scene.patterns import Circle, Group, Image, Path, Polygon, Tile

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from vbraille.scene.patterns import AnyPattern

# Keys, and indices of items, that lead from a pattern or a scene to a pattern in it.
Steps = tuple[str | int, ...]
_FILLED = (Circle, Polygon, Path)


def inner(pattern: AnyPattern) -> list[tuple[Steps, AnyPattern]]:
    """Patterns that stand directly in another one, with the keys that lead to them.

    >>> from vbraille.scene.patterns import Tile, Uniform
    >>> inner(Tile(width_mm=5, height_mm=5, part=Uniform()))
    [(('part',), Uniform(id='', title='', description='', amplitude=1.0, inverted=False, \
vibration=None, level=1.0))]
    """
    if isinstance(pattern, Group):
        found: list[tuple[Steps, AnyPattern]] = [
            (("parts", number), part) for number, part in enumerate(pattern.parts)
        ]
        return found if pattern.by is None else [*found, (("by",), pattern.by)]
    if isinstance(pattern, Tile):
        return [(("part",), pattern.part)]
    if isinstance(pattern, Image):
        return [] if pattern.texture is None else [(("texture",), pattern.texture)]
    if isinstance(pattern, _FILLED) and pattern.fill is not None:
        return [(("fill", "texture"), pattern.fill.texture)]
    return []


def with_inner(
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
    changed = {steps: change(steps, part) for steps, part in inner(pattern)}
    if not changed:
        return pattern
    if isinstance(pattern, Group):
        parts = tuple(changed["parts", number] for number in range(len(pattern.parts)))
        return replace(pattern, parts=parts, by=changed.get(("by",)))
    if isinstance(pattern, Tile):
        return replace(pattern, part=changed["part",])
    if isinstance(pattern, Image):
        return replace(pattern, texture=changed["texture",])
    assert isinstance(pattern, _FILLED)
    assert pattern.fill is not None
    return replace(pattern, fill=replace(pattern.fill, texture=changed["fill", "texture"]))


def walk(patterns: Iterable[AnyPattern]) -> Iterator[AnyPattern]:
    """All patterns and all that stand in them, at any depth, each before what stands in it."""
    left = list(patterns)[::-1]
    while left:
        pattern = left.pop()
        yield pattern
        left += [part for _, part in reversed(inner(pattern))]
