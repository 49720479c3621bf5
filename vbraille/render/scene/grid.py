"""The canvas in tiles: for each, the words that an array with its centre there has to work on.

Tiles are squares. An array reaches beyond its tile by its own radius, and so a tile's words tell
all that lies in the tile, grown by that radius. The grid is wider than the canvas by as much.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vbraille.render.machine import words
from vbraille.render.scene import gridkernels as g
from vbraille.render.scene.gridkernels import entries
from vbraille.render.scene.nodes import EVERYWHERE

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.render.scene.flat import Flat
    from vbraille.scene.scene import Canvas

# With what is not touched left out again by its box, tiles need not be smaller than the array.
TILE_MM = 8.0
_FAR_MM = 1e9
_MOST_TILES = 40_000


@dataclass(frozen=True, slots=True)
class TileGrid:
    """Tiles over a canvas.

    Parameters
    ----------
    left_mm, top_mm
        Corner of the first tile.
    tile_mm
        Length of a tile's sides.
    columns, rows
        How many tiles there are.
    radius_mm
        How far arrays reach beyond the tile that their centre is in.
    prunes
        Whether what an array cannot touch is left out.
    """

    left_mm: float
    top_mm: float
    tile_mm: float
    columns: int
    rows: int
    radius_mm: float
    prunes: bool = True

    @classmethod
    def over(
        cls, canvas: Canvas, radius_mm: float, pruned: bool = True, tile_mm: float = TILE_MM
    ) -> TileGrid:
        """Lay a grid over a canvas, for arrays of a radius; not pruned it is one tile."""
        width_mm, height_mm = canvas.width_mm + 2 * radius_mm, canvas.height_mm + 2 * radius_mm
        # The array is on the canvas still where its centre is on the grid's far edge.
        width_mm, height_mm = width_mm + 1e-6, height_mm + 1e-6
        if not pruned:
            side_mm = max(width_mm, height_mm)
            return cls(-radius_mm, -radius_mm, side_mm, 1, 1, _FAR_MM, prunes=False)
        tile_mm = max(tile_mm, math.sqrt(width_mm * height_mm / _MOST_TILES))
        columns, rows = math.ceil(width_mm / tile_mm), math.ceil(height_mm / tile_mm)
        return cls(-radius_mm, -radius_mm, tile_mm, columns, rows, radius_mm)


def assemble(
    head: NDArray[np.float64], canvas: Canvas, grid: TileGrid, flat: Flat | None
) -> tuple[NDArray[np.float64], NDArray[np.uint16]]:
    """Make the numbers and the table of a program.

    Parameters
    ----------
    head : float64[GRID]
        Head of the program, with what belongs to the display.
    canvas, grid
        The canvas, and the tiles over it.
    flat
        What is on it; None for nothing.

    Returns
    -------
    float64[n], uint16[m]
        Numbers and table.
    """
    head = head.copy()
    head[words.RIGHT_MM], head[words.BOTTOM_MM] = canvas.width_mm, canvas.height_mm
    head[words.GRID_LEFT_MM], head[words.GRID_TOP_MM] = grid.left_mm, grid.top_mm
    head[words.TILES_PER_MM] = 1.0 / grid.tile_mm
    head[words.GRID_COLUMNS], head[words.GRID_ROWS] = grid.columns, grid.rows
    tiles = grid.columns * grid.rows
    base = words.GRID + tiles
    if flat is None:
        return np.concatenate([head, np.full(tiles, float(base)), [words.END]]), np.zeros(
            1, np.uint16
        )
    nodes, changes = flat.nodes.copy(), flat.changes + words.OPERATIONS * base
    nodes[:, g.BLOCK] += base
    begins, listed = entries(
        flat.reach,
        grid.radius_mm,
        grid.left_mm,
        grid.top_mm,
        grid.tile_mm,
        grid.columns,
        grid.rows,
    )
    always = np.flatnonzero(nodes[:, g.ALWAYS])
    starts, said = g.say(
        nodes, changes, always, flat.reach, begins, listed, base + flat.numbers.size
    )
    numbers = np.concatenate([head, starts, flat.numbers, said])
    if not grid.prunes:
        blocks = nodes[nodes[:, g.KIND] == g.LEAF, g.BLOCK].astype(np.int64)
        numbers[blocks[:, None] + range(len(EVERYWHERE))] = EVERYWHERE
    return numbers, _table(numbers, flat, base)


def _table(numbers: NDArray[np.float64], flat: Flat, base: int) -> NDArray[np.uint16]:
    """Make the table, and write into the numbers where in it each entry is."""
    entries = [np.zeros(1, np.uint16)]
    size = 1
    for at, part in flat.entries:
        numbers[base + at] = size
        entries.append(part)
        size += part.size
    return np.concatenate(entries)
