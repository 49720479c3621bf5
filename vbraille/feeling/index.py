"""Elements of a scene by their places: only those that have their box there are asked."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from vbraille.render.scene.canvas import SceneMap
from vbraille.scene.bounds import bounds
from vbraille.scene.patterns import Group
from vbraille.scene.scene import Scene

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from vbraille.render.scene.assets import Assets
    from vbraille.scene.bounds import Box
    from vbraille.scene.patterns import AnyPattern, Image, Label

# Ours: an element is felt where it hides half of what it stands on, or does anything if it is the
# only one there.
_FELT: Final = 0.5
_TRACE: Final = 0.02
_MOST_LOOKED_AT: Final = 64  # of those that lie over each other, from the top
_MOST_COMPILED: Final = 100


_EVERYWHERE: Final = (-math.inf, -math.inf, math.inf, math.inf)


@dataclass(frozen=True, slots=True)
class NamedElement:
    """An element of a scene that has a title, an id or a description.

    Parameters
    ----------
    name
        Title, or the id where there is no title.
    pattern
        The element.
    center_mm
        Middle of what it covers; the canvas's own where it covers all.
    """

    name: str
    pattern: AnyPattern
    center_mm: tuple[float, float]

    @property
    def description(self) -> str:
        """Description that the scene has beside its name."""
        return self.pattern.description


def label_of(pattern: AnyPattern) -> str:
    """Title of an element, or its id; empty if it has neither."""
    return pattern.title or pattern.id


class _Leaf(NamedTuple):
    pattern: AnyPattern
    element: NamedElement
    box: Box | None


class SceneIndex:
    """Elements of a scene that have a name, by place and by name.

    A part that has no name of its own goes by that of the group which it stands in.

    Parameters
    ----------
    scene
        A resolved scene.
    assets
        Bitmaps of its images and cells of its labels.
    known
        Boxes of images and labels.
    """

    def __init__(
        self,
        scene: Scene,
        assets: Assets,
        known: Mapping[Image | Label, Box] | None = None,
    ) -> None:
        self._scene, self._assets = scene, assets
        # In compiled code, which thousands of dots do not hold up.
        self._map_of = lru_cache(_MOST_COMPILED)(self._compile)
        self._known = {} if known is None else known
        self._size_mm = scene.canvas.width_mm, scene.canvas.height_mm
        self.elements: list[NamedElement] = []
        self._leaves: list[_Leaf] = []
        for pattern in scene.elements:
            self._leaves += self._leaves_of(pattern, None)
        boxes = [_EVERYWHERE if leaf.box is None else leaf.box for leaf in self._leaves]
        self._edges = np.array(boxes, float).reshape(-1, 4).T

    def here(self, x_mm: float, y_mm: float) -> NamedElement | None:
        """Find the uppermost element with a name at a place in mm; None if there is none."""
        width_mm, height_mm = self._size_mm
        if not (0 <= x_mm <= width_mm and 0 <= y_mm <= height_mm):
            return None
        left, top, right, bottom = self._edges
        there = (left <= x_mm) & (x_mm <= right) & (top <= y_mm) & (y_mm <= bottom)
        found, most = None, _TRACE
        for at in np.flatnonzero(there)[: -1 - _MOST_LOOKED_AT : -1].tolist():
            element = self._leaves[at].element
            share = self.opacity(at, x_mm, y_mm)
            if share >= _FELT:
                return element
            if share > most:
                found, most = element, share
        return found

    def opacity(self, number: int, x_mm: float, y_mm: float) -> float:
        """Tell how much of what lies below a part, by its number, it hides at a place: 0 … 1."""
        shown = self._map_of(number)
        return float(shown.opacity(np.array([x_mm]), np.array([y_mm]))[0, 0])

    def find(self, text: str) -> NamedElement | None:
        """Find an element by its id or title, or by what one of these begins with or has in it."""
        wanted = text.strip().casefold()
        if not wanted:
            return None
        names = [(e.pattern.id.casefold(), e.pattern.title.casefold()) for e in self.elements]
        for fits in (
            lambda name: name == wanted,
            lambda name: name.startswith(wanted),
            lambda name: wanted in name,
        ):
            for element, (id_, title) in zip(self.elements, names, strict=True):
                if fits(id_) or fits(title):
                    return element
        return None

    def _compile(self, number: int) -> SceneMap:
        alone = Scene(canvas=self._scene.canvas, elements=(self._leaves[number].pattern,))
        return SceneMap(alone, self._assets)

    def _leaves_of(self, pattern: AnyPattern, above: NamedElement | None) -> Iterator[_Leaf]:
        """Patterns within one that are no groups, with the elements by whose names they go."""
        box = None if isinstance(pattern, Group) and above else bounds(pattern, self._known)
        name = label_of(pattern)
        if name or (pattern.description and above is None):
            if isinstance(pattern, Group):
                box = bounds(pattern, self._known)
            center = self._size_mm[0] / 2, self._size_mm[1] / 2
            if box is not None and not box.is_empty:
                center = (box.left + box.right) / 2, (box.top + box.bottom) / 2
            above = NamedElement(name or "without a title", pattern, center)
            self.elements.append(above)
        # What a group inverts, or shows by a mask, is asked of the group as a whole.
        if isinstance(pattern, Group) and _is_open(pattern):
            for part in pattern.parts:
                yield from self._leaves_of(part, above)
        elif above is not None:
            box = bounds(pattern, self._known) if box is None else box
            yield _Leaf(pattern, above, box)


def _is_open(group: Group) -> bool:
    """Tell whether the parts of a group are felt where they are, each by itself."""
    return group.operation in ("overwrite", "maximum", "add") and not group.inverted
