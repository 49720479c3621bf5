"""Scenes as they are at a zoom: their places are farther apart, and what is felt keeps its size."""

from __future__ import annotations

import operator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from msgspec.structs import replace

from vbraille.scene.patterns import Circle, Gradual, Group, Image, Label, Peak, Shape, Tile, Uniform
from vbraille.scene.scene import Canvas
from vbraille.scene.traversal import children, each, placed, with_children

if TYPE_CHECKING:
    from collections.abc import Mapping

    from vbraille.scene.bitmap import Bitmap
    from vbraille.scene.patterns import AnyPattern, Pattern
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
    shown = [(number, zooming.at(element, zoom)) for number, element in enumerate(scene.elements)]
    found = {number: element for number, element in shown if element is not None}
    elements = tuple(found.values())
    same = len(elements) == len(scene.elements) and all(map(operator.is_, elements, scene.elements))
    if zoom != 1.0 or not same:
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


class _Zooming:
    """Patterns at one zoom, and what their images and labels were."""

    def __init__(self, zoom: float, bitmaps: Mapping[Image, Bitmap]) -> None:
        self.labels: dict[Label, Label] = {}
        self.images: dict[Image, Image] = {}
        self._zoom, self._bitmaps = zoom, bitmaps

    def at(self, pattern: AnyPattern, scale: float) -> AnyPattern | None:
        """Make a pattern whose places are multiplied; None if nothing of it is there."""
        if not is_there(pattern, self._zoom):
            return None
        # A tile keeps its size, and so does what is in it.
        inner = 1.0 if isinstance(pattern, Tile) else scale
        made = with_children(pattern, lambda _, part: self.at(part, inner) or _AT_REST)
        there = _without_rest(made)
        if there is None:
            return None
        changes: dict[str, Any] = {}
        if pattern.zoom_from is not None or pattern.zoom_to is not None:
            changes |= {"zoom_from": None, "zoom_to": None}
        if scale != 1.0:
            changes |= placed(there, lambda x, y: (x * scale, y * scale))
            sizes = self._sizes(pattern)
            changes |= {key: size * scale for key, size in sizes.items() if size is not None}
            distortion = getattr(there, "distortion", None)
            if isinstance(distortion, Gradual | Peak):
                changes["distortion"] = _longer(distortion, scale)
        shown = replace(there, **changes) if changes else there
        if isinstance(shown, Label) and isinstance(pattern, Label):
            self.labels[shown] = pattern
        elif isinstance(shown, Image) and isinstance(pattern, Image):
            self.images[shown] = pattern
        return shown

    def _sizes(self, pattern: AnyPattern) -> dict[str, float | None]:
        """Fields of a pattern that are sizes of what is drawn."""
        if isinstance(pattern, Circle):
            return {"radius_mm": pattern.radius_mm}
        if not isinstance(pattern, Image):
            return {}
        width_mm, height_mm = pattern.width_mm, pattern.height_mm
        if width_mm is None and height_mm is None:
            bitmap = self._bitmaps[pattern]  # which reaches beyond its place if it is blurred
            beside, above = map(operator.sub, pattern.place_mm, bitmap.place_mm)
            width_mm, height_mm = bitmap.width_mm - 2 * beside, bitmap.height_mm - 2 * above
        return {"width_mm": width_mm, "height_mm": height_mm}


def _without_rest(pattern: AnyPattern) -> AnyPattern | None:
    """Pattern without parts that are not there; None if nothing is left of it."""
    if all(part is not _AT_REST for part in children(pattern)):
        return pattern
    if isinstance(pattern, Group):
        if pattern.operation not in _LEAVES:
            return pattern
        parts = tuple(part for part in pattern.parts if part is not _AT_REST)
        return replace(pattern, parts=parts) if parts else None
    # Of what stands in one pattern alone only a fill can be left out.
    is_drawn = isinstance(pattern, Shape) and pattern.width_mm
    return replace(pattern, fill=None) if is_drawn else None


def _longer(distortion: Gradual | Peak, scale: float) -> Gradual | Peak:
    lengths = [key for key in distortion.__struct_fields__ if key.endswith("_mm")]
    return replace(distortion, **{key: scale * getattr(distortion, key) for key in lengths})
