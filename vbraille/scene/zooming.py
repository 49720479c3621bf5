"""Scenes as they are at a zoom: their places are farther apart, and what is felt keeps its size."""

from __future__ import annotations

import operator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from msgspec.structs import replace

from vbraille.scene.patterns import Circle, Group, Image, Label, PathShape, Polygon, Tile
from vbraille.scene.scene import Canvas
from vbraille.scene.textures import Gradual, LinearGrating, Peak, RadialGrating, Uniform
from vbraille.scene.traversal import each, placed, placed_children, with_children

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from vbraille.scene.bitmap import Bitmap
    from vbraille.scene.pattern import Pattern
    from vbraille.scene.patterns import AnyPattern
    from vbraille.scene.scene import Scene

# Operations by which a part that is not there leaves the others as they are.
_LEAVES = ("overwrite", "maximum", "add", "multiply")
_AT_REST = Uniform(level=0.0)


@dataclass(frozen=True, slots=True, eq=False)
class Zoomed:
    """A scene at a zoom.

    Parameters
    ----------
    scene
        The scene, with what is there at this zoom.
    numbers
        Numbers of its elements in the scene that it was made of, from 0.
    labels, images
        Labels and images of that scene by those that have become of them.
    """

    scene: Scene
    numbers: tuple[int, ...]
    labels: Mapping[Label, Label]
    images: Mapping[Image, Image]


def zoomed(
    scene: Scene, zoom: float = 1.0, bitmaps: Mapping[Image, Bitmap] | None = None
) -> Zoomed:
    """Make a scene as it is at a zoom.

    Places, radii, sizes of images and where a distortion is are multiplied by the zoom. Widths of
    strokes, dots, waves, tiles, gaps, speeds and braille stay. A pattern that is not there at the
    zoom is left out, as if it were not written; in a blend or a weighted sum it is at rest.

    Parameters
    ----------
    scene
        A resolved scene.
    zoom
        The zoom, above 0; 1 for the scene as it is written.
    bitmaps
        Bitmaps of the images, which tell the size of those that have none of their own.

    Raises
    ------
    ValueError
        If something would be too large or too small for a scene, or farther than 10 m away.
    """
    zooming = _Zooming(zoom, bitmaps or {})
    found = {
        number: pattern
        for number, element in enumerate(scene.elements)
        if (pattern := zooming.at(element, zoom)) is not None
    }
    elements = tuple(found.values())
    if zoom != 1.0 or not _are_same(elements, scene.elements):
        canvas = scene.canvas
        size = Canvas(width_mm=canvas.width_mm * zoom, height_mm=canvas.height_mm * zoom)
        scene = replace(scene, canvas=size, elements=elements)
    return Zoomed(scene, tuple(found), zooming.labels, zooming.images)


def is_there(pattern: Pattern, zoom: float) -> bool:
    """Tell whether a pattern is there at a zoom."""
    begins, ends = pattern.zoom_from, pattern.zoom_to
    return (begins is None or begins <= zoom) and (ends is None or zoom < ends)


def levels(*patterns: AnyPattern) -> list[float]:
    """Zooms but 1 from which on something else is there, in patterns and what stands in them."""
    found = {zoom for one in each(*patterns) for zoom in (one.zoom_from, one.zoom_to)}
    return sorted(zoom for zoom in found if zoom not in (None, 1.0))


def _are_same(some: Sequence[object], others: Sequence[object]) -> bool:
    return len(some) == len(others) and all(map(operator.is_, some, others))


class _Zooming:
    """Patterns at one zoom, and what their images and labels were."""

    def __init__(self, zoom: float, bitmaps: Mapping[Image, Bitmap]) -> None:
        self.labels: dict[Label, Label] = {}
        self.images: dict[Image, Image] = {}
        self._zoom, self._bitmaps = zoom, bitmaps

    def at(self, pattern: AnyPattern, scale: float) -> AnyPattern | None:
        """Make a pattern whose places are multiplied; None if it is not there at the zoom."""
        inner = self._with_parts(pattern, scale) if is_there(pattern, self._zoom) else None
        if inner is None:
            return None
        changes: dict[str, Any] = {}
        if inner.zoom_from is not None or inner.zoom_to is not None:
            changes |= {"zoom_from": None, "zoom_to": None}
        if scale != 1.0:
            changes |= placed(inner, lambda x, y: (x * scale, y * scale))
            changes |= self._sizes(pattern, inner, scale)
        shown = replace(inner, **changes) if changes else inner
        if isinstance(shown, Label) and isinstance(pattern, Label):
            self.labels[shown] = pattern
        elif isinstance(shown, Image) and isinstance(pattern, Image):
            self.images[shown] = pattern
        return shown

    def _with_parts(self, pattern: AnyPattern, scale: float) -> AnyPattern | None:
        """Pattern with what stands in it; None if nothing is left of it."""
        if isinstance(pattern, Group):
            return self._group(pattern, scale)
        # A tile keeps its size, and so does what is in it.
        inner = 1.0 if isinstance(pattern, Tile) else scale
        parts = {steps: self.at(part, inner) for steps, part in placed_children(pattern)}
        there = {steps: part for steps, part in parts.items() if part is not None}
        if len(there) == len(parts):
            return with_children(pattern, lambda steps, _: there[steps])
        # Of what stands in one pattern alone only a fill can be left out.
        filled = isinstance(pattern, Circle | Polygon | PathShape)
        if filled and (pattern.stroke is not None or pattern.dots is not None):
            return replace(pattern, fill=None)
        return None

    def _group(self, group: Group, scale: float) -> Group | None:
        parts = [self.at(part, scale) for part in group.parts]
        if group.operation in _LEAVES:
            there = tuple(part for part in parts if part is not None)
        else:
            there = tuple(_AT_REST if part is None else part for part in parts)
        by = None if group.by is None else self.at(group.by, scale) or _AT_REST
        if by is group.by and _are_same(there, group.parts):
            return group
        return replace(group, parts=there, by=by) if there else None

    def _sizes(self, pattern: AnyPattern, inner: AnyPattern, scale: float) -> dict[str, Any]:
        """Fields of a pattern that are sizes of what is drawn, multiplied."""
        if isinstance(inner, Circle):
            return {"radius_mm": inner.radius_mm * scale}
        if isinstance(inner, Image):
            width_mm, height_mm = inner.width_mm, inner.height_mm
            if width_mm is None and height_mm is None and isinstance(pattern, Image):
                bitmap = self._bitmaps[pattern]  # which reaches beyond its place if it is blurred
                beside, above = map(operator.sub, pattern.place_mm, bitmap.place_mm)
                width_mm, height_mm = bitmap.width_mm - 2 * beside, bitmap.height_mm - 2 * above
            sizes = {"width_mm": width_mm, "height_mm": height_mm}
            return {name: value * scale for name, value in sizes.items() if value is not None}
        if isinstance(inner, LinearGrating | RadialGrating):
            match inner.distortion:
                case Gradual() as gradual:
                    start_mm, length_mm = gradual.start_mm * scale, gradual.length_mm * scale
                    return {"distortion": replace(gradual, start_mm=start_mm, length_mm=length_mm)}
                case Peak() as peak:
                    center_mm, length_mm = peak.center_mm * scale, peak.length_mm * scale
                    return {"distortion": replace(peak, center_mm=center_mm, length_mm=length_mm)}
        return {}
