"""The elements of a scene as plain arrays, of which those that stay are kept for the next scene."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.render.scene import words
from vbraille.render.scene.flat import Flat, flatten, put_together
from vbraille.render.scene.frequencies import check_rate, frequency_hz
from vbraille.render.scene.nodes import NodeKind
from vbraille.render.scene.trees import deflection, layer

if TYPE_CHECKING:
    from vbraille.render.scene.assets import Assets
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
        self._known: dict[int, tuple[AnyPattern, Flat]] = {}
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
        self._forget(scene.operation, assets)
        laid = scene.operation == "overwrite"
        known: dict[int, tuple[AnyPattern, Flat]] = {}
        parts = []
        for element in scene.elements:
            found = self._known.get(id(element))
            if found is None:
                check_rate(element, len(parts) + 1, rate_hz)
                tree = layer(element, assets) if laid else deflection(element, assets)
                found = (element, flatten(tree, frequency_hz(element)))
            # The element is kept, too, so that no other can be at its place in memory.
            known[id(element)] = found
            parts.append(found[1])
        self._known = known
        flat = put_together(parts, _KINDS[scene.operation])
        check_depth(flat)
        return flat

    def _forget(self, operation: Operation, assets: Assets) -> None:
        """Forget what was made for another operation, or of other bitmaps and labels."""
        if operation != self._operation:
            self._known = {}
        elif assets is not self._assets:
            kept = self._known.items()
            self._known = {place: found for place, found in kept if not found[1].entries}
        self._operation, self._assets = operation, assets


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
