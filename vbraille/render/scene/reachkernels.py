"""Which tiles of a canvas are near to what: segments, dots and all else that leaves lie in."""

import math

import numpy as np

from vbraille.render.waves import compiled

# Columns of what leaves, and their parts, lie in.
(
    NODE,
    PART,  # its place in the leaf's block; 0 for the whole leaf
    REACH_KIND,
    A,
    B,
    C,
    D,
    REACH_MM,
) = range(8)
REACH_COLUMNS = 8

BOX, CAPSULE, RING, EDGE, WALL, AROUND = range(6)
_ROUNDING_MM = 1e-6


@compiled
def _is_near(reach, n, x, y, radius):
    """Tell whether anything of a thing is nearer than that to a place."""
    a, b, c, d = reach[n, A], reach[n, B], reach[n, C], reach[n, D]
    kind = reach[n, REACH_KIND]
    radius += reach[n, REACH_MM]
    if kind == EDGE:
        beside = a > x + radius or c < x - radius
        return not (beside or min(b, d) > y + radius or max(b, d) < y - radius)
    if kind == WALL:
        return a <= x + radius < c and y - radius <= b <= y + radius
    if kind == BOX:
        dx, dy = max(a - x, x - c, 0.0), max(b - y, y - d, 0.0)
        return dx * dx + dy * dy <= radius * radius
    if kind == RING:
        return abs(math.sqrt((x - a) ** 2 + (y - b) ** 2) - c) <= radius
    dx, dy = c - a, d - b
    u, v = x - a, y - b
    square = dx * dx + dy * dy
    if square > 0.0:
        share = min(max((u * dx + v * dy) / square, 0.0), 1.0)
        u -= share * dx
        v -= share * dy
    return u * u + v * v <= radius * radius


@compiled
def _range(reach, n, radius, left, top, tiles_per_mm, columns, rows):
    """Range of the tiles that a thing can be near to: columns, and rows."""
    a, b, c, d = reach[n, A], reach[n, B], reach[n, C], reach[n, D]
    radius += reach[n, REACH_MM]
    if reach[n, REACH_KIND] == RING:
        a, b, c, d = a - c, b - c, a + c, b + c
    x0, x1 = (min(a, c) - radius - left) * tiles_per_mm, (max(a, c) + radius - left) * tiles_per_mm
    y0, y1 = (min(b, d) - radius - top) * tiles_per_mm, (max(b, d) + radius - top) * tiles_per_mm
    return (
        int(max(math.floor(min(x0, columns)), 0.0)),
        int(min(math.floor(max(x1, -1.0)), columns - 1.0)),
        int(max(math.floor(min(y0, rows)), 0.0)),
        int(min(math.floor(max(y1, -1.0)), rows - 1.0)),
    )


@compiled
def entries(reach, radius, left, top, tile_mm, columns, rows):
    """List what is near each tile: where its list begins, and numbers of rows of ``reach``.

    ``radius`` is that of the array; the tiles are grown by it.
    """
    tiles_per_mm = 1.0 / tile_mm
    # Discs about a tile and all that is reached from it, and squares about that.
    disc, square = radius + tile_mm * math.sqrt(0.5), radius + tile_mm * 0.5
    # They are kept, so that each of the many comparisons with them is with the same number.
    across, down = np.empty(columns), np.empty(rows)
    for column in range(columns):
        across[column] = left + (column + 0.5) * tile_mm
    for row in range(rows):
        down[row] = top + (row + 0.5) * tile_mm
    odd = np.zeros((rows, columns), np.bool_)
    begins = np.zeros(columns * rows + 1, np.int64)
    free = np.zeros(columns * rows, np.int64)
    filled = np.empty(0, np.int64)
    for filling in range(2):
        if filling:
            for tile in range(columns * rows):
                begins[tile + 1] = begins[tile] + free[tile]
                free[tile] = begins[tile]
            filled = np.empty(begins[-1], np.int64)
        for n in range(reach.shape[0]):
            kind = reach[n, REACH_KIND]
            of_filled = EDGE <= kind <= AROUND
            grown = square if of_filled else disc
            farther = radius + tile_mm if of_filled else radius
            first, last, upper, lower = _range(
                reach, n, farther, left, top, tiles_per_mm, columns, rows
            )
            if kind == EDGE:
                _cross(reach, n, grown, across, down, odd)
            elif kind == AROUND:
                first, last = max(first - 2, 0), min(last + 1, columns - 1)
            for row in range(upper, lower + 1):
                if kind == AROUND:
                    _sum_up(odd, row, first, last)
                for column in range(first, last + 1):
                    if kind == AROUND:
                        near = odd[row, column]
                        odd[row, column] = False
                    else:
                        near = _is_near(reach, n, across[column], down[row], grown)
                    if not near:
                        continue
                    tile = row * columns + column
                    if filling:
                        filled[free[tile]] = n
                    free[tile] += 1
    return begins, filled


@compiled
def _cross(reach, n, radius, across, down, odd):
    """Count a segment for the tiles that it is to the right of, with all that they reach.

    It counts where it crosses the lower end of all that a row of tiles reaches; so much of what is
    to the right is the same for all places of a tile. What is kept of a row is where the count
    changes, at the last of the tiles.
    """
    radius += reach[n, REACH_MM]
    a, b, d = reach[n, A], reach[n, B], reach[n, D]
    upper = np.searchsorted(down, min(b, d) - radius - _ROUNDING_MM)
    lower = np.searchsorted(down, max(b, d) - radius + _ROUNDING_MM)
    if upper == lower:
        return
    column = np.searchsorted(across, a - radius + _ROUNDING_MM) - 1
    while column >= 0 and across[column] + radius >= a:
        column -= 1
    if column < 0:
        return
    for row in range(upper, lower):
        end = down[row] + radius
        if (b > end) != (d > end):
            odd[row, column] = not odd[row, column]


@compiled
def _sum_up(odd, row, first, last):
    """Make of the tiles where the count changes those for which it is odd."""
    count = False
    for column in range(last, first - 1, -1):
        count ^= odd[row, column]
        odd[row, column] = count
