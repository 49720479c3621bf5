"""Regions of a canvas: where patterns are, as shares over a grid and as contours."""

from __future__ import annotations

import math
from dataclasses import replace as exchange
from functools import reduce
from typing import TYPE_CHECKING, cast

import numpy as np
from msgspec.structs import replace

from vbraille.pictures.scenes import map_places
from vbraille.scene.labels import Label
from vbraille.scene.patterns import Group, Image, Tile
from vbraille.scene.scene import Scene
from vbraille.scene.textures import (
    AxialGrating,
    LinearGrating,
    RadialGrating,
    Uniform,
    UniformVibration,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.pictures.ink import Contours
    from vbraille.render.scene.assets import Assets
    from vbraille.scene.patterns import AnyPattern

# Patterns that cover the whole canvas.
TEXTURES = (Uniform, UniformVibration, LinearGrating, RadialGrating, AxialGrating, Tile)
_PIXELS_PER_MM, _MOST_PIXELS = 4.0, 1_000_000
_HALF = 0.5
# When vibrations of 50 Hz are at one end; the actuators of parity 0 are up then.
_UP_S = 0.005


class Regions:
    """Regions of a scene's canvas.

    Parameters
    ----------
    scene, assets
        A resolved scene, and what it takes from image files and labels.
    """

    def __init__(self, scene: Scene, assets: Assets) -> None:
        self._scene, self._assets = scene, assets
        area = scene.canvas.width_mm * scene.canvas.height_mm
        self._per_mm = min(_PIXELS_PER_MM, math.sqrt(_MOST_PIXELS / area))
        self.x_mm, self.y_mm = map_places(scene.canvas, self._per_mm)

    @property
    def canvas(self) -> Contours:
        """The canvas as a contour."""
        width, height = self._scene.canvas.width_mm, self._scene.canvas.height_mm
        return (np.array([(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)]),)

    def of(self, pattern: AnyPattern) -> NDArray[np.float32] | None:
        """Compute where a pattern is that is no texture; None if it is everywhere.

        That is its opacity mask, but for images what they show.
        """
        region = self._plainly(pattern)
        if region is None or not pattern.inverted:
            return region
        return 1.0 - region

    def felt(self, pattern: AnyPattern) -> NDArray[np.float32]:
        """Compute the deflections of a pattern, with all that vibrates up."""
        drawn = self._map(pattern)
        return drawn.deflections(self.x_mm, self.y_mm, time_s=_UP_S, parity=0)

    def contours(self, region: NDArray[np.floating]) -> Contours:
        """Draw lines around all that is above ½; holes run the other way round."""
        from contourpy import FillType, contour_generator

        padded = np.pad(_smoothed(region), 1)
        step = 1 / self._per_mm
        x = np.concatenate([[self.x_mm[0] - step], self.x_mm, [self.x_mm[-1] + step]])
        y = np.concatenate([[self.y_mm[0] - step], self.y_mm, [self.y_mm[-1] + step]])
        lines = contour_generator(x, y, padded, fill_type=FillType.OuterOffset)
        found = cast("tuple[list[NDArray], list[NDArray]]", lines.filled(_HALF, math.inf))
        edge = np.array([self._scene.canvas.width_mm, self._scene.canvas.height_mm])
        return tuple(
            np.clip(part, 0.0, edge)
            for points, breaks in zip(*found, strict=True)
            for part in np.split(points, breaks[1:-1].astype(int))
        )

    def grown(self, region: NDArray[np.floating], by_mm: float) -> NDArray[np.float32]:
        """Make a region larger by a distance on all sides, or smaller by a negative one."""
        from scipy.ndimage import distance_transform_edt  # takes half a second to load

        inside = region >= _HALF
        if by_mm < 0.0:
            return 1.0 - self.grown(1.0 - inside, -by_mm)
        if not inside.any():
            return np.zeros(region.shape, np.float32)
        away_mm = np.asarray(distance_transform_edt(~inside)) / self._per_mm
        return np.clip(_HALF + (by_mm - away_mm) * self._per_mm, 0.0, 1.0).astype(np.float32)

    def spread(
        self, region: NDArray[np.floating], pitch_mm: float, before_mm: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Find places for dots where a region is thinner than their pitch, along its middle.

        No two are nearer to each other, or to one of those before, than the pitch. All are
        float64[n, 2].
        """
        from scipy.ndimage import distance_transform_edt, maximum_filter

        thick = self.grown(self.grown(region, -pitch_mm / 2), 0.75 * pitch_mm)
        thin = (region >= _HALF) & (thick < _HALF)
        if not thin.any():
            return np.zeros((0, 2))
        inside = np.asarray(distance_transform_edt(region >= _HALF))
        rows, columns = np.nonzero(thin & (inside >= maximum_filter(inside, 3)))
        taken: dict[tuple[int, int], list[tuple[float, float]]] = {}
        for x, y in before_mm.tolist():
            taken.setdefault((int(x / pitch_mm), int(y / pitch_mm)), []).append((x, y))
        found = []
        for x, y in zip(self.x_mm[columns].tolist(), self.y_mm[rows].tolist(), strict=True):
            at = int(x / pitch_mm), int(y / pitch_mm)
            near = (
                other
                for across in (-1, 0, 1)
                for down in (-1, 0, 1)
                for other in taken.get((at[0] + across, at[1] + down), ())
            )
            if all(math.dist((x, y), other) >= pitch_mm for other in near):
                taken.setdefault(at, []).append((x, y))
                found.append((x, y))
        return np.array(found).reshape(-1, 2)

    def holds(
        self, region: NDArray[np.floating], centers_mm: NDArray[np.float64], radius_mm: float
    ) -> NDArray[np.bool_]:
        """Tell which discs are wholly in a region; float64[n, 2] to bool[n]."""
        held = np.ones(len(centers_mm), bool)
        for angle in np.arange(0.0, math.tau, math.tau / 8):
            at = centers_mm + radius_mm * np.array([math.cos(angle), math.sin(angle)])
            column, row = np.floor(at * self._per_mm).astype(int).T
            rows, columns = region.shape
            on = (column >= 0) & (column < columns) & (row >= 0) & (row < rows)
            held &= on
            held[on] &= region[row[on], column[on]] >= _HALF
        return held

    def _plainly(self, pattern: AnyPattern) -> NDArray[np.float32] | None:
        if isinstance(pattern, TEXTURES):
            return None
        if isinstance(pattern, Group):
            return self._of_group(pattern)
        if isinstance(pattern, Image):
            plain = replace(pattern, texture=None, amplitude=1.0, inverted=False, vibration=None)
            bitmaps = {**self._assets.bitmaps, plain: self._assets.bitmaps[pattern]}
            assets = exchange(self._assets, bitmaps=bitmaps)
            return self._map(plain, assets).deflections(self.x_mm, self.y_mm)
        upright = replace(pattern, inverted=False)
        assets = self._assets
        if isinstance(pattern, Label) and isinstance(upright, Label):
            written = {**assets.written, upright: assets.written[pattern]}
            assets = exchange(assets, written=written)
        return self._map(upright, assets).opacity(self.x_mm, self.y_mm)

    def _of_group(self, group: Group) -> NDArray[np.float32] | None:
        parts = [self.of(part) for part in group.parts]
        some = [part for part in parts if part is not None]
        if group.operation == "multiply":
            return reduce(np.minimum, some) if some else None
        if group.by is not None:
            second = np.clip(self.felt(group.by), 0.0, 1.0)
            one, other = (np.float32(1.0) if part is None else part for part in parts)
            chosen = (1.0 - second) * one + second * other
            return np.asarray(chosen, np.float32) if some else None
        if len(some) < len(parts):
            return None
        return reduce(np.maximum, some)

    def _map(self, pattern: AnyPattern, assets: Assets | None = None):
        from vbraille.render.scene.canvas import SceneMap  # loads the kernels

        scene = Scene(canvas=self._scene.canvas, elements=(pattern,))
        return SceneMap(scene, self._assets if assets is None else assets)


def _smoothed(region: NDArray[np.floating]) -> NDArray[np.floating]:
    """Blur by a pixel, so that edges as sharp as pixels make lines without steps."""
    for _ in range(2):
        padded = np.pad(region, ((1, 1), (0, 0)), mode="edge")
        region = ((padded[:-2] + 2 * padded[1:-1] + padded[2:]) / 4).T
    return region
