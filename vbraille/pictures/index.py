"""Elements of a scene by place and by name: what is at a place, near it, and where one is felt."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Final, Literal, NamedTuple

import numpy as np
from msgspec.structs import replace

from vbraille.render.compiling import SceneMap
from vbraille.scene.geometry import Box, bounds
from vbraille.scene.patterns import Circle, Group, Label, PathShape, Polygon, Shape

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from numpy.typing import NDArray

    from vbraille.render.labels import Assets
    from vbraille.scene.patterns import AnyPattern, Image
    from vbraille.scene.scene import Scene

# Ours: an element is felt where it hides half of what it stands on, or does anything if it is the
# only one there.
_FELT: Final = 0.5
_TRACE: Final = 0.02
_MOST_LOOKED_AT: Final = 64  # of those that lie over each other, from the top
_MOST_COMPILED: Final = 100
_STEP_MM: Final = 0.5  # between places at which it is looked where an element is felt
_MOST_STEPS: Final = 400  # of these along each side of its box
_MOST_TRIED: Final = 60  # of the places where it is felt, for one that nothing hides
_MOST_NEAR: Final = 3  # elements whose boxes are near, of which the nearest is found
_EDGE_MM: Final = 1.0  # so near to an outline without a stroke is its edge
_ARC: Final = np.linspace(0.0, math.tau, 181)
_EVERYWHERE: Final = Box(-math.inf, -math.inf, math.inf, math.inf)


@dataclass(frozen=True, slots=True, eq=False)
class NamedElement:
    """An element of a scene that has a title, an id or a description, or is a label.

    Parameters
    ----------
    name
        Title, or the id where there is no title; of a label, its text.
    pattern
        The element.
    box
        What it covers of the canvas, which is all of that for what is everywhere.
    """

    name: str
    pattern: AnyPattern
    box: Box

    @property
    def description(self) -> str:
        """Description that the scene has beside its name."""
        return self.pattern.description


class Spot(NamedTuple):
    """An element at a place, and where the place is in it.

    Parameters
    ----------
    element
        The element.
    where
        "edge" on its outline, "inside" where the outline is around the place and nothing is felt
        there, "on" elsewhere.
    """

    element: NamedElement
    where: Literal["edge", "inside", "on"]


def label_of(pattern: AnyPattern) -> str:
    """Title of an element, or the text of a label, or the id; empty if it has none."""
    text = " ".join(pattern.text.split()) if isinstance(pattern, Label) else ""
    return pattern.title or text or pattern.id or pattern.words


class _Leaf(NamedTuple):
    pattern: AnyPattern
    element: NamedElement
    box: Box


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

    Attributes
    ----------
    elements : list of NamedElement
        The elements, as they are written.
    switches : int
        States of the scene's switches; other states show other elements.
    """

    def __init__(
        self,
        scene: Scene,
        assets: Assets,
        known: Mapping[Image | Label, Box] | None = None,
    ) -> None:
        self._scene, self._assets, self._known = scene, assets, known or {}
        self.switches = 0
        # In compiled code, which thousands of dots do not hold up.
        self._leaf_map = lru_cache(_MOST_COMPILED)(lambda at: self._alone(self._leaves[at].pattern))
        self._points = lru_cache(_MOST_COMPILED)(self._find_points)
        self._canvas = Box(0.0, 0.0, scene.canvas.width_mm, scene.canvas.height_mm)
        self.elements: list[NamedElement] = []
        self._leaves = [leaf for one in scene.elements for leaf in self._leaves_of(one, None)]
        self._edges = np.array([leaf.box for leaf in self._leaves], float).reshape(-1, 4).T

    def here(self, x_mm: float, y_mm: float) -> NamedElement | None:
        """Find the uppermost element with a name at a place in mm; None if there is none."""
        found = self._leaf_at(x_mm, y_mm)
        return None if found is None else found.element

    def where(self, x_mm: float, y_mm: float) -> Spot | None:
        """Find what is at a place in mm, or else the smallest outline around it; None if none is.

        What is felt there counts more than an outline around it.
        """
        leaf = self._leaf_at(x_mm, y_mm)
        if leaf is not None:
            stroke = leaf.pattern.stroke if isinstance(leaf.pattern, Shape) else None
            half_mm = _EDGE_MM if stroke is None else stroke.width_mm / 2
            is_near = _distance_mm(leaf.pattern, x_mm, y_mm) <= half_mm
            return Spot(leaf.element, "edge" if is_near else "on")
        around = self._around(x_mm, y_mm)
        if not around:
            return None
        smallest = min(around, key=lambda leaf: math.prod(np.subtract(leaf.box[2:], leaf.box[:2])))
        return Spot(smallest.element, "inside")

    def encloses(self, element: NamedElement, x_mm: float, y_mm: float) -> bool:
        """Tell whether an outline of an element is around a place in mm."""
        return any(leaf.element is element for leaf in self._around(x_mm, y_mm))

    def point_on(self, element: NamedElement) -> tuple[float, float]:
        """Find a place in mm where an element is felt, as near to its middle as there is one.

        A place that nothing else hides goes before one that is nearer.
        """
        box = element.box
        middle = (box.left + box.right) / 2, (box.top + box.bottom) / 2
        nearest = _sorted_from(middle, self._points(element, self.switches))
        tried = [middle, *nearest[:: max(1, len(nearest) // _MOST_TRIED)]]
        shown = (point for point in tried if self.here(*point) is element)
        return next(shown, (nearest or tried)[0])

    def nearest(self, x_mm: float, y_mm: float) -> tuple[NamedElement, tuple[float, float]] | None:
        """Find the element that is felt nearest to a place, and where; both in mm."""
        here = x_mm, y_mm

        def to_box(element: NamedElement) -> float:
            left, top, right, bottom = element.box
            return math.hypot(
                max(left - x_mm, x_mm - right, 0.0), max(top - y_mm, y_mm - bottom, 0.0)
            )

        found = [
            (element, points[0])
            for element in sorted(self.elements, key=to_box)[:_MOST_NEAR]
            if (points := _sorted_from(here, self._points(element, self.switches)))
        ]
        return min(found, key=lambda one: math.dist(one[1], here), default=None)

    def inside(self) -> tuple[float, float]:
        """Find a place in mm where the picture is felt, as near to its middle as there is one."""
        middle = self._canvas.right / 2, self._canvas.bottom / 2
        if self.here(*middle) is not None:
            return middle
        found = self.nearest(*middle)
        if found is not None:
            return found[1]
        whole = self._felt(SceneMap(self._scene, self._assets), self._canvas)
        return next(iter(_sorted_from(middle, whole)), middle)

    def find(self, text: str) -> NamedElement | None:
        """Find an element by its id or title, or by what one of these begins with or has in it."""
        wanted = text.strip().casefold()
        names = [(element.name.casefold(), element) for element in self.elements]
        names += [(element.pattern.id.casefold(), element) for element in self.elements]
        for fits in (str.__eq__, str.startswith, str.__contains__):
            for name, element in names:
                if wanted and fits(name, wanted):
                    return element
        return None

    def _alone(self, pattern: AnyPattern) -> SceneMap:
        alone = replace(self._scene, elements=(pattern,), operation="overwrite")
        return SceneMap(alone, self._assets)

    def _find_points(self, element: NamedElement, switches: int) -> NDArray[np.float64]:
        """Places where an element by itself is felt, float64[n, 2] in mm."""
        del switches  # which tell one answer from another
        return self._felt(self._alone(element.pattern), element.box)

    def _felt(self, drawn: SceneMap, box: Box) -> NDArray[np.float64]:
        """Places of a box where something is felt, float64[n, 2] in mm."""
        if box.is_empty:
            return np.empty((0, 2))
        x_mm, y_mm = (
            low + (np.arange(count) + 0.5) * (high - low) / count
            for low, high in ((box.left, box.right), (box.top, box.bottom))
            for count in [min(max(int((high - low) / _STEP_MM), 1), _MOST_STEPS)]
        )
        shown = drawn.deflections(x_mm, y_mm, is_mask=True, switches=self.switches)
        rows, columns = np.nonzero(shown >= min(_FELT, max(float(shown.max()) / 2, _TRACE)))
        return np.stack((x_mm[columns], y_mm[rows]), axis=1)

    def _covering(self, x_mm: float, y_mm: float) -> list[int]:
        """Numbers of the leaves whose boxes a place is in, the uppermost first."""
        left, top, right, bottom = self._edges
        there = (left <= x_mm) & (x_mm <= right) & (top <= y_mm) & (y_mm <= bottom)
        return np.flatnonzero(there)[: -1 - _MOST_LOOKED_AT : -1].tolist()

    def _around(self, x_mm: float, y_mm: float) -> list[_Leaf]:
        """Parts that have an outline around a place."""
        covering = [self._leaves[at] for at in self._covering(x_mm, y_mm)]
        return [leaf for leaf in covering if _is_within(leaf.pattern, x_mm, y_mm)]

    def _leaf_at(self, x_mm: float, y_mm: float) -> _Leaf | None:
        """Uppermost part that is felt at a place."""
        if not self._canvas.holds(x_mm, y_mm):
            return None
        place = np.array([x_mm]), np.array([y_mm])
        found, most = None, _TRACE
        for at in self._covering(x_mm, y_mm):
            hides = self._leaf_map(at).deflections(*place, is_mask=True, switches=self.switches)
            share = float(hides[0, 0])
            if share >= _FELT:
                return self._leaves[at]
            if share > most:
                found, most = self._leaves[at], share
        return found

    def _leaves_of(self, pattern: AnyPattern, above: NamedElement | None) -> Iterator[_Leaf]:
        """Patterns within one that are no groups, with the elements by whose names they go."""
        name = label_of(pattern)
        box = bounds(pattern, self._known) or _EVERYWHERE
        if name or ((pattern.description or pattern.sound) and above is None):
            above = NamedElement(name or "without a title", pattern, box.common(self._canvas))
            self.elements.append(above)
        # What a group inverts, or shows by a mask, is asked of the group as a whole.
        if isinstance(pattern, Group) and is_open(pattern):
            for part in pattern.parts:
                yield from self._leaves_of(part, above)
        elif above is not None:
            yield _Leaf(pattern, above, box)


def is_open(group: Group) -> bool:
    """Tell whether the parts of a group are felt where they are, each by itself."""
    return group.operation in ("overwrite", "maximum", "add") and not group.inverted


def _sorted_from(
    place: tuple[float, float], points: NDArray[np.float64]
) -> list[tuple[float, float]]:
    """Places by their distance from one, the nearest first."""
    order = np.argsort(np.hypot(*(points - place).T), kind="stable")
    return [(x, y) for x, y in points[order].tolist()]


def _outlines(pattern: AnyPattern) -> list[NDArray[np.floating]]:
    """Closed outlines of a shape, each float64[n, 2] with its first corner again at its end."""
    if isinstance(pattern, Circle):
        around = np.stack((np.cos(_ARC), np.sin(_ARC)), axis=1)
        return [np.array(pattern.center_mm) + pattern.radius_mm * around]
    if isinstance(pattern, Polygon):
        return [np.array([*pattern.vertices_mm, pattern.vertices_mm[0]])]
    if isinstance(pattern, PathShape) and pattern.closed:
        return [np.array([*contour, contour[0]]) for contour in pattern.contours_mm]
    return []


def _distance_mm(pattern: AnyPattern, x_mm: float, y_mm: float) -> float:
    """Distance of a place from the outlines of a shape, in mm; infinite without one."""
    nearest = math.inf
    for outline in _outlines(pattern):
        along = np.diff(outline, axis=0)
        to = (x_mm, y_mm) - outline[:-1]
        length = np.maximum((along * along).sum(axis=1), 1e-12)
        share = np.clip((to * along).sum(axis=1) / length, 0.0, 1.0)
        nearest = min(nearest, float(np.hypot(*(to - share[:, None] * along).T).min()))
    return nearest


def _is_within(pattern: AnyPattern, x_mm: float, y_mm: float) -> bool:
    """Tell whether a place is inside of the outlines of a shape, by the even-odd rule."""
    crossed = 0
    for outline in _outlines(pattern):
        (x, y), (x_next, y_next) = outline[:-1].T, outline[1:].T
        passes = (y > y_mm) != (y_next > y_mm)
        at = x[passes] + (y_mm - y[passes]) * (x_next - x)[passes] / (y_next - y)[passes]
        crossed += int((at > x_mm).sum())
    return crossed % 2 == 1
