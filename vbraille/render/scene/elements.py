"""The elements of a scene as plain arrays, of which those that stay are kept for the next scene."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.render.machine import words
from vbraille.render.scene.flat import exchanged, flatten, put_together
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
        if scene.operation != self._operation:
            self._elements, self._parts, self._whole = (), [], None
        pairs = zip(self._elements, scene.elements, strict=False)
        changed = [n for n, (old, new) in enumerate(pairs) if old is not new]
        before = self._whole
        same = len(self._elements) == len(scene.elements)
        if before is not None and same and (assets is self._assets or not before.flat.entries):
            parts = self._parts.copy()
            for n in changed:
                parts[n] = _flattened(scene, n, assets, rate_hz)
            whole = exchanged(before, parts, changed)
        else:
            known = self._known(assets)
            parts = [
                known.get(id(element)) or _flattened(scene, n, assets, rate_hz)
                for n, element in enumerate(scene.elements)
            ]
            whole = None
        whole = whole or put_together(parts, _KINDS[scene.operation])
        check_depth(whole.flat)
        self._elements, self._parts, self._whole = scene.elements, parts, whole
        self._assets, self._operation = assets, scene.operation
        return whole.flat

    def _known(self, assets: Assets) -> dict[int, Flat]:
        """Arrays of the elements before, by their identity, but for other bitmaps and labels."""
        pairs = zip(self._elements, self._parts, strict=True)
        same = assets is self._assets
        return {id(element): part for element, part in pairs if same or not part.entries}


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
