"""Rasters of compiled scenes: many places at once, tile by tile."""

import numpy as np

from vbraille.render.machine import words as w
from vbraille.render.machine.showkernels import run
from vbraille.render.waves import compiled

LANES = 512  # places whose rows stay in the processor's nearer caches


@compiled
def raster(numbers, table, rows, x_mm, y_mm, columns, lines, sign, noise, time, out):
    """Fill lines of a raster, whose places are runs in tiles.

    Parameters
    ----------
    numbers, table
        The program, with a grid for arrays that are points.
    rows : float64[SCRATCH_ROWS, LANES]
        Room to work in.
    x_mm, y_mm : float64[w], float64[h]
        Places of the raster's columns and lines.
    columns, lines : int64[n, 3]
        Runs of columns and lines in one column or row of tiles: first, end, and which; a run
        off the grid has -1.
    sign : float
        1 or -1, by which vibrations swing.
    noise : float32[h, w] or float32[0, 0]
        Noise from -1 to 1 that stands for vibrations, if there is no time.
    time : float
        Time in seconds, or NaN.
    out : float32[h, w]
        Deflections.
    """
    left, right = numbers[w.LEFT_MM], numbers[w.RIGHT_MM]
    top, bottom = numbers[w.TOP_MM], numbers[w.BOTTOM_MM]
    across = int(numbers[w.GRID_COLUMNS])
    for k in range(lines.shape[0]):
        for m in range(columns.shape[0]):
            first, end = columns[m, 0], columns[m, 1]
            if lines[k, 2] < 0 or columns[m, 2] < 0:
                out[lines[k, 0] : lines[k, 1], first:end] = 0.0
                continue
            start = int(numbers[w.GRID + lines[k, 2] * across + columns[m, 2]])
            if numbers[start] == w.END:
                out[lines[k, 0] : lines[k, 1], first:end] = 0.0
                continue
            height = max(LANES // min(end - first, LANES), 1)
            for i0 in range(lines[k, 0], lines[k, 1], height):
                i1 = min(i0 + height, lines[k, 1])
                for j0 in range(first, end, LANES):
                    j1 = min(j0 + LANES, end)
                    _block(
                        numbers, table, rows, x_mm, y_mm, i0, i1, j0, j1, sign, noise, time, start
                    )
                    n = 0
                    for i in range(i0, i1):
                        for j in range(j0, j1):
                            on = left <= x_mm[j] <= right and top <= y_mm[i] <= bottom
                            value = min(max(rows[w.STACK, n], 0.0), 1.0)
                            out[i, j] = value if on else 0.0
                            n += 1


@compiled
def _block(numbers, table, rows, x_mm, y_mm, i0, i1, j0, j1, sign, noise, time, start):
    n = 0
    for i in range(i0, i1):
        for j in range(j0, j1):
            rows[w.X_ROW, n], rows[w.Y_ROW, n] = x_mm[j], y_mm[i]
            rows[w.SIGN_ROW, n] = noise[i, j] if noise.size else sign
            n += 1
    x0, x1 = _span(x_mm, j0, j1)
    y0, y1 = _span(y_mm, i0, i1)
    run(numbers, table, rows, start, n, time, x0, x1, y0, y1)


@compiled
def _span(places, first, end):
    low = high = places[first]
    for n in range(first + 1, end):
        low, high = min(low, places[n]), max(high, places[n])
    return low, high


def runs(indices: np.ndarray) -> np.ndarray:
    """List the runs of equal numbers: first, end and number; int64[n, 3]."""
    ends = np.append(np.flatnonzero(np.diff(indices)) + 1, indices.size)
    starts = np.concatenate([[0], ends[:-1]])
    return np.stack([starts, ends, indices[starts]], axis=1).astype(np.int64)
