"""The elements of a scene as plain arrays, of which those that stay are kept for the next scene."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.render.machine import words
from vbraille.render.scene.flat import flatten, in_a_row, side_by_side
from vbraille.render.scene.frequencies import highest_hz
from vbraille.render.scene.nodes import NodeKind
from vbraille.render.scene.trees import deflection, layer

if TYPE_CHECKING:
    from vbraille.render.scene.assets import Assets
    from vbraille.render.scene.flat import Flat, Together
    from vbraille.scene.patterns import AnyPattern, Operation
    from vbraille.scene.scene import Scene

_KINDS = {
    "multiply": NodeKind.MULTIPLY,
    "add": NodeKind.ADD,
    "maximum": NodeKind.MAXIMUM,
    "overwrite": NodeKind.OVER,
}


class FlatElements:
    """Elements of scenes that follow each other, most of which stay as they are."""

    def __init__(self) -> None:
        self._elements: tuple[AnyPattern, ...] = ()
        self._parts: list[Flat] = []
        self._whole: Together | None = None
        self._assets: Assets | None = None
        self._operation: Operation | None = None

    def put_together(self, scene: Scene, assets: Assets, rate_hz: float) -> Flat | None:
        """Make arrays of a scene; None if there is nothing in it.

        An element that was in the scene before is known by being the same object.

        Raises
        ------
        ValueError
            If a frequency is above half of the rate, patterns stand too deep in each other, or
            elements cannot be put together by the scene's operation.
        """
        if scene.operation not in _KINDS:
            raise ValueError(
                f'operation = "{scene.operation}" is for groups; put the elements into one'
            )
        if not scene.elements:
            return None
        before, parts, whole = self._elements, self._parts, self._whole
        if scene.operation != self._operation:
            before, parts, whole = (), [], None  # A layer has a mask, too.
        elif whole is not None and whole.entries and assets is not self._assets:
            # Bitmaps and labels may be others.
            kept = [n for n, part in enumerate(parts) if not part.entries]
            before, parts, whole = tuple(before[n] for n in kept), [parts[n] for n in kept], None
        first, end, new_end = _changed(before, scene.elements)
        known = dict(zip(map(id, before[first:end]), parts[first:end], strict=True))
        new = [
            known.get(id(scene.elements[n])) or _flattened(scene, n, assets, rate_hz)
            for n in range(first, new_end)
        ]
        parts = [*parts[:first], *new, *parts[end:]]
        if whole is None:
            whole = side_by_side(parts)
        elif first < max(end, new_end):
            between = (side_by_side(new),) if new else ()
            whole = in_a_row((whole.some(0, first), *between, whole.some(end, len(before))))
        flat = whole.under(_KINDS[scene.operation])
        check_depth(flat)
        self._elements, self._parts, self._whole = scene.elements, parts, whole
        self._assets, self._operation = assets, scene.operation
        return flat


def _changed(before: tuple[AnyPattern, ...], after: tuple[AnyPattern, ...]) -> tuple[int, int, int]:
    """Find what has changed: first element that has, and ends of these, before and after."""
    same = (old is new for old, new in zip(before, after, strict=False))
    shorter = min(len(before), len(after))
    first = next((n for n, is_same in enumerate(same) if not is_same), shorter)
    backwards = zip(reversed(before[first:]), reversed(after[first:]), strict=False)
    same = (old is new for old, new in backwards)
    kept = next((n for n, is_same in enumerate(same) if not is_same), shorter - first)
    return first, len(before) - kept, len(after) - kept


def _flattened(scene: Scene, n: int, assets: Assets, rate_hz: float) -> Flat:
    element = scene.elements[n]
    hz = highest_hz(element, n + 1, rate_hz)
    laid = scene.operation == "overwrite"
    return flatten(layer(element, assets) if laid else deflection(element, assets), hz)


def check_depth(flat: Flat) -> None:
    """Check that a scene needs no more rows than there are.

    Raises
    ------
    ValueError
        If its patterns stand too deep in each other.
    """
    if flat.depth > words.DEPTH:
        raise ValueError(
            f"patterns stand in each other so deep that {flat.depth} of them are half done at "
            f"once; there is room for {words.DEPTH}, so put fewer into each other"
        )
