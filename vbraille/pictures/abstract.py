"""Abstract and raised drawings of scenes (Lévesque 2009, 8.3.3), as ink.

Shapes are drawn as they are described, and what overwrites is drawn over what it hides. Gratings
are lines of their direction and wavelength, vibration is dots, images are gray pixels or, on raised
drawings, outlines. What has no lines of its own - tiles, products of textures, groups that are
inverted - is drawn black where it is above half of its height.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from msgspec import structs

from vbraille.pictures.hatching import grating_marks, vibration_discs, vibration_pitch_mm
from vbraille.pictures.ink import InkArea, InkClip, InkDrawing, InkLine, InkRaster
from vbraille.pictures.inkshapes import (
    dots_marks,
    label_marks,
    shape_marks,
)
from vbraille.pictures.looks import ABSTRACT, InkLook
from vbraille.pictures.regions import TEXTURES, Regions
from vbraille.scene.bitmap import WHOLE
from vbraille.scene.dots import Dots
from vbraille.scene.labels import Label
from vbraille.scene.patterns import Circle, Group, Image, PathShape, Polygon, Tile
from vbraille.scene.shapes import StraightLine
from vbraille.scene.textures import Uniform, UniformVibration

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from numpy.typing import NDArray

    from vbraille.pictures.ink import Contours, InkMark, PlainMark
    from vbraille.pictures.inkshapes import AnyShape
    from vbraille.render.scene.assets import Assets
    from vbraille.scene.patterns import AnyPattern
    from vbraille.scene.scene import Scene

    Where = NDArray[np.float32] | None  # None is everywhere

_FAINTEST = 0.25  # strength below which a raised drawing has nothing
_HALF = 0.5


def abstract_drawing(scene: Scene, assets: Assets, look: InkLook = ABSTRACT) -> InkDrawing:
    """Draw a scene by what it is made of, at the size of its canvas.

    Parameters
    ----------
    scene, assets
        A resolved scene, and what it takes from image files and labels.
    look
        `ABSTRACT`, or `RAISED` on paper, of `vbraille.pictures.looks`.

    Raises
    ------
    InputError
        If textures have more lines or dots on the canvas than can be drawn.
    """
    painter = _Painter(scene, assets, look)
    marks = tuple(painter.together(scene.operation, scene.elements))
    canvas = scene.canvas
    clipped = tuple(_within(painter.regions.canvas, marks))
    return InkDrawing(canvas.width_mm, canvas.height_mm, clipped, scene.title, scene.description)


def _within(contours: Contours, marks: Iterable[InkMark]) -> Iterator[InkMark]:
    """Keep all on the canvas; what is clipped already is so."""
    for mark in marks:
        yield mark if isinstance(mark, InkClip) else InkClip(contours, (mark,))


class _Painter:
    """Draws patterns within regions.

    Parameters
    ----------
    scene, assets, look
        As `abstract_drawing` has them.
    """

    def __init__(self, scene: Scene, assets: Assets, look: InkLook) -> None:
        self._canvas, self._assets, self._look = scene.canvas, assets, look
        self.regions = Regions(scene, assets)

    def together(
        self,
        operation: str,
        parts: Iterable[AnyPattern],
        where: Where = None,
        strength: float = 1.0,
    ) -> Iterator[InkMark]:
        """Draw patterns that are put together by an operation without further parts."""
        parts = tuple(parts)
        if operation == "multiply":
            yield from self._masked(parts, where, strength)
            return
        for number, part in enumerate(parts):
            if operation == "overwrite" and number:
                yield from self._wiped(part, where)
            yield from self.paint(part, where, strength)

    def paint(
        self, pattern: AnyPattern, where: Where = None, strength: float = 1.0
    ) -> Iterator[InkMark]:
        """Draw a pattern within a region, at a strength from 0 to 1."""
        strength *= pattern.amplitude
        if self._look.raised and strength < _FAINTEST:
            return
        if isinstance(pattern, TEXTURES):
            yield from self._texture(pattern, where, strength)
            return
        if pattern.inverted:
            yield from self._area(self.regions.felt(pattern), where, strength)
            return
        match pattern:
            case StraightLine() | Circle() | Polygon() | PathShape():
                yield from self._fill(pattern, where, strength)
                marks = shape_marks(pattern, self._canvas, self._look, strength)
                yield from self._clipped(marks, where)
            case Dots():
                yield from self._clipped(dots_marks(pattern, self._look, strength), where)
            case Label():
                written = self._assets.written[pattern]
                yield from self._clipped(label_marks(pattern, written, self._look, strength), where)
            case Image():
                yield from self._image(pattern, where, strength)
            case Group():
                yield from self._group(pattern, where, strength)
            case _:
                raise AssertionError(f"{pattern.__struct_config__.tag} is in no resolved scene")
        if pattern.vibration is not None and isinstance(pattern, Group | Image | Label):
            yield from self._shaking(_both(self.regions.of(pattern), where))

    def _group(self, group: Group, where: Where, strength: float) -> Iterator[InkMark]:
        if group.operation != "blend":
            yield from self.together(group.operation, group.parts, where, strength)
            return
        assert group.by is not None
        second = self.regions.felt(group.by)
        yield from self.paint(group.parts[0], _both(1.0 - second, where), strength)
        yield from self.paint(group.parts[1], _both(second, where), strength)

    def _masked(
        self, parts: tuple[AnyPattern, ...], where: Where, strength: float
    ) -> Iterator[InkMark]:
        """Draw a product: textures within what the other parts have in common."""
        textures = [part for part in parts if self.regions.of(part) is None]
        masks = [part for part in parts if part not in textures]
        still = [part for part in textures if not isinstance(part, UniformVibration)]
        for mask in masks:
            where = _both(self.regions.of(mask), where)
        if len(still) > 1:
            product = Group(operation="multiply", parts=tuple(still))
            yield from self._area(self.regions.felt(product), where, strength)
            textures = [part for part in textures if part not in still]
        for texture in textures:
            yield from self.paint(texture, where, strength)
        if not textures and not still:
            yield from self._area(np.ones_like(where), where, strength)  # pyright: ignore

    def _texture(self, texture: AnyPattern, where: Where, strength: float) -> Iterator[InkMark]:
        look, ink = self._look, self._look.ink(strength)
        match texture:
            case Uniform():
                level = 1.0 - texture.level if texture.inverted else texture.level
                if level >= _HALF and where is not None if look.raised else level > 0.0:
                    area = InkArea(self.regions.canvas, look.ink(strength * level))
                    yield from self._clipped([area], where)
            case UniformVibration():
                yield from self._shaking(where, ink)
            case Tile():
                yield from self._area(self.regions.felt(texture), where, strength)
            case _:
                marks = grating_marks(texture, self._canvas, look, ink)  # pyright: ignore
                yield from self._clipped(marks, where)
        swing = texture.vibration
        if swing is not None and (not look.raised or isinstance(texture, Uniform | Tile)):
            # On the ridges white dots are seen, dark ones in the gaps.
            yield from self._shaking(where, 1.0 if swing.of == "high" else ink)

    def _fill(self, shape: AnyShape, where: Where, strength: float) -> Iterator[InkMark]:
        if isinstance(shape, StraightLine) or shape.fill is None:
            return
        fill = structs.replace(shape.fill, texture=Uniform(), gap_mm=0.0, fade_mm=0.0)
        bare = structs.replace(shape, stroke=None, dots=None, inverted=False, fill=fill)
        if isinstance(bare, Polygon):
            bare = structs.replace(bare, markers=None)
        inside = self.regions.of(bare)
        assert inside is not None  # a shape is somewhere
        inside = _common(inside, where)
        wide = 0.0 if shape.stroke is None else shape.stroke.width_mm
        if shape.dots is not None:
            wide = 2 * shape.dots.dot.radius_mm
        if wide and (self._look.raised or not shape.fill.blended):
            gap = max(shape.fill.gap_mm, self._look.halo_mm)
            inside = self.regions.grown(inside, -(wide / 2 + gap))
        yield from self.paint(shape.fill.texture, inside, strength)
        if shape.vibration is not None:
            yield from self._shaking(inside)

    def _image(self, image: Image, where: Where, strength: float) -> Iterator[InkMark]:
        region = self.regions.of(image)
        if image.texture is not None:
            yield from self.paint(image.texture, _both(region, where), strength)
            return
        if self._look.raised:
            assert region is not None
            contours = self.regions.contours(region)
            if contours:
                line = InkLine(contours, max(1.0, self._look.line_mm), 0.0, closed=True)
                yield from self._clipped([line], where)
            return
        bitmap = self._assets.bitmaps[image]
        shares = bitmap.intensities / WHOLE
        pixels = (255.0 * (1.0 - 0.75 * strength * shares) + 0.5).astype(np.uint8)
        raster = InkRaster(pixels, bitmap.place_mm, bitmap.width_mm, bitmap.height_mm)
        yield from self._clipped([raster], where)

    def _wiped(self, pattern: AnyPattern, where: Where) -> Iterator[InkMark]:
        """Take away what a pattern hides, and on raised drawings a little around it."""
        region = self.regions.of(pattern)
        if region is None:
            contours = self.regions.canvas
        else:
            if self._look.halo_mm:
                region = self.regions.grown(region, self._look.halo_mm)
            contours = self.regions.contours(_common(region, where))
        if contours:
            yield from self._clipped([InkArea(contours, 1.0)], where)

    def _shaking(self, where: Where, gray: float | None = None) -> Iterator[InkMark]:
        """Draw vibration in a region as whole dots: white over what vibrates, black if raised."""
        if gray is None:
            gray = 0.0 if self._look.raised else 1.0
        discs = vibration_discs(self._canvas, self._look, gray)
        if where is not None:
            held = self.regions.holds(where, discs.centers_mm, discs.radius_mm)
            centers = discs.centers_mm[held]
            more = self.regions.spread(where, vibration_pitch_mm(self._look), centers)
            discs = replace(discs, centers_mm=np.vstack([centers, more]))
        if len(discs.centers_mm):
            yield discs

    def _area(
        self, region: NDArray[np.float32], where: Where, strength: float
    ) -> Iterator[InkMark]:
        contours = self.regions.contours(_common(region, where))
        if contours:
            yield InkArea(contours, self._look.ink(strength))

    def _clipped(self, marks: Iterable[PlainMark], where: Where) -> Iterator[InkMark]:
        marks = tuple(marks)
        if where is None:
            yield from marks
            return
        contours = self.regions.contours(where)
        if contours and marks:
            yield InkClip(contours, marks)


def _both(region: Where, where: Where) -> Where:
    """What is in two regions."""
    return where if region is None else _common(region, where)


def _common(region: NDArray[np.float32], where: Where) -> NDArray[np.float32]:
    """What is in two regions, of which the first is not everywhere."""
    return region if where is None else np.minimum(region, where)
