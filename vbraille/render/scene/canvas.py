"""The whole canvas at once: deflections and opacity of scenes and patterns as rasters."""

from __future__ import annotations

import math
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING

import numpy as np

from vbraille.render import work
from vbraille.render.machine import words
from vbraille.render.scene.assets import Assets
from vbraille.render.scene.compiling import flatten_scene
from vbraille.render.scene.flat import flatten
from vbraille.render.scene.grid import TileGrid, assemble
from vbraille.render.scene.trees import ONE, mask
from vbraille.render.work import ProgramKind
from vbraille.scene.patterns import Group

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.render.scene.flat import Flat
    from vbraille.scene.scene import Scene

_THREADS = 2
_Numbers = tuple["NDArray[np.float64]", "NDArray[np.uint16]", TileGrid]


class SceneMap:
    """A scene as a whole, for pictures of it.

    Parameters
    ----------
    scene
        A resolved scene: without `Use` and `ImageDots`.
    assets
        Bitmaps of its images and cells of its labels.

    Raises
    ------
    ValueError
        If patterns stand too deep in each other.
    """

    def __init__(self, scene: Scene, assets: Assets | None = None) -> None:
        self._scene, self._assets = scene, assets or Assets()
        self._shown: _Numbers | None = None
        self._hiding: _Numbers | None = None

    def deflections(
        self,
        x_mm: NDArray[np.float64],
        y_mm: NDArray[np.float64],
        *,
        time_s: float = 0.0,
        parity: int = 0,
        noise_seed: int | None = None,
    ) -> NDArray[np.float32]:
        """Compute the deflections of actuators at the places of a raster: Lévesque 2009, 8.3.3.

        Parameters
        ----------
        x_mm, y_mm : float64[w], float64[h]
            Places of its columns and lines on the canvas.
        time_s
            Time since the scene was first shown, in seconds.
        parity
            0 for actuators whose column and row are both even or both odd, 1 for the others.
        noise_seed
            Seed of the noise that stands for vibrations; None shows them as they are at the time.
            Gratings that travel stand where they do at first then.

        Returns
        -------
        float32[h, w]
            Deflections, 0 … 1; 0 beyond the canvas.
        """
        if self._shown is None:
            self._shown = self._assemble(flatten_scene(self._scene, self._assets))
        return _raster(self._shown, x_mm, y_mm, time_s, parity, noise_seed)

    def opacity(
        self,
        x_mm: NDArray[np.float64],
        y_mm: NDArray[np.float64],
        *,
        time_s: float = 0.0,
        parity: int = 0,
        noise_seed: int | None = None,
    ) -> NDArray[np.float32]:
        """Compute the opacity mask of the scene at the places of a raster: Lévesque 2009, 8.4.5.

        The arguments are those of `deflections`; only the mask of a blend that is chosen by what
        moves depends on the time. A scene of one element has the mask of that.

        Returns
        -------
        float32[h, w]
            Opacity, 0 … 1; 0 beyond the canvas.
        """
        if self._hiding is None:
            self._hiding = self._assemble(self._mask())
        return _raster(self._hiding, x_mm, y_mm, time_s, parity, noise_seed)

    def _mask(self) -> Flat | None:
        elements = self._scene.elements
        if not elements:
            return None
        whole = Group(operation=self._scene.operation, parts=elements)
        tree = mask(elements[0] if len(elements) == 1 else whole, self._assets)
        return flatten(ONE if tree is None else tree)

    def _assemble(self, flat: Flat | None) -> _Numbers:
        head = np.zeros(words.GRID)
        head[work.KIND] = ProgramKind.SCENE
        grid = TileGrid.over(self._scene.canvas, 0.0)
        return (*assemble(head, self._scene.canvas, grid, flat), grid)


def _raster(
    compiled: _Numbers,
    x_mm: NDArray[np.float64],
    y_mm: NDArray[np.float64],
    time_s: float,
    parity: int,
    noise_seed: int | None,
) -> NDArray[np.float32]:
    # Importing kernels loads numba, which only a process that makes pictures has to wait for.
    from vbraille.render.machine import showkernels

    numbers, table, grid = compiled
    x_mm, y_mm = np.ascontiguousarray(x_mm, np.float64), np.ascontiguousarray(y_mm, np.float64)
    out = np.empty((y_mm.size, x_mm.size), np.float32)
    if out.size == 0:
        return out
    noise = np.empty((0, 0), np.float32)
    if noise_seed is not None:
        noise = np.random.default_rng(noise_seed).random(out.shape, np.float32) * 2 - 1
    columns = showkernels.runs(_tiles(x_mm, grid.left_mm, grid.tile_mm, grid.columns))
    lines = showkernels.runs(_tiles(y_mm, grid.top_mm, grid.tile_mm, grid.rows))
    time = math.nan if noise_seed is not None else time_s

    def fill(some: NDArray[np.int64]) -> None:
        rows = np.zeros((words.SCRATCH_ROWS, showkernels.LANES))
        sign = -1.0 if parity else 1.0
        showkernels.raster(numbers, table, rows, x_mm, y_mm, columns, some, sign, noise, time, out)

    # Neighbouring lines cost alike, so the threads take turns.
    with ThreadPoolExecutor(_THREADS) as threads:
        for done in [threads.submit(fill, lines[n::_THREADS].copy()) for n in range(_THREADS)]:
            done.result()
    return out


def _tiles(places_mm: NDArray[np.float64], first_mm: float, tile_mm: float, count: int):
    tiles = np.floor((places_mm - first_mm) / tile_mm)
    return np.where((tiles >= 0) & (tiles < count), tiles, -1)
