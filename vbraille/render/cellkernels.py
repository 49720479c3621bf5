"""Braille: dots along a line that rows of actuators show, and dots under each actuator.

A slot is one column of dots of one cell: 2 (cell + 1) + (0 left, 1 right), with an empty cell
before a line's first and one after its last. The table has a word for each slot of each line, with
an empty line before the first and one after the last. Bit r of a word is set if actuator row r
shows a dot there; where each actuator shows what lies freely under it, bit r is row r of the dots.
"""

import math

import numpy as np

from vbraille.render.waves import compiled, cos_pi, inlined
from vbraille.render.work import (
    CELL_PITCH,
    CONTRAST,
    COSINE,
    DOT_ROW_PITCH,
    DOT_SPACING,
    DOT_WIDTH,
    FADE_MM,
    HEIGHT,
    LAST_ROW,
    LEFT,
    LINE_PITCH,
    LINES,
    PROFILE,
    SHAPE,
    SINE,
    SLOT,
    SLOTS,
    SWING,
    TABLE,
    TOP,
    WIDTH,
    X_ROW,
)

HALF_SINE = 0.0  # of `Profile`
# Columns of dots that a place may be over: the right one of the cell before, the left and the right
# one of its own, or the only one that there can be.
BEFORE, OWN_LEFT, _OWN_RIGHT, ONLY = range(-1, 3)


@inlined
def _shape(cells):
    """Profile of the dots, and its coefficients."""
    return (
        cells[PROFILE] == HALF_SINE,
        cells[SHAPE],
        cells[SHAPE + 1],
        cells[SHAPE + 2],
        cells[SHAPE + 3],
        cells[SHAPE + 4],
        cells[SHAPE + 5],
    )


@inlined
def _dot_swing(shape, d):
    """Compute the swing of a dot at d = (place - its middle) / its width, from -1/2 to 1/2."""
    half_sine, e0, e1, e2, e3, e4, e5 = shape
    q = d * d
    sine = cos_pi(q)  # sin(πu/W), u from the dot's left edge
    y = sine * sine
    if half_sine:
        # Lévesque 2009, 3.2, with sin 8θ = 8 sin θ cos θ (1 - 10y + 24y² - 16y³)
        aside = abs(d) - 0.5
        cosine = cos_pi(aside * aside)
        cosine = -cosine if d > 0.0 else cosine
        value = sine * (e0 + e1 * cosine * (1.0 + y * (-10.0 + y * (24.0 - 16.0 * y))))
    else:
        # eqs. 4.1-4.3 on [0, 1]: c = cos πp, and cos kπp = T_k(c), which is odd
        c = 2.0 * y - 1.0
        z = c * c
        value = 0.5 + c * (e0 + z * (e1 + z * (e2 + z * (e3 + z * (e4 + z * e5)))))
    value = value if value > 0.0 else 0.0
    value = value if value < 1.0 else 1.0
    return value if q < 0.25 else 0.0


@compiled
def find_dots(cells, rows, count, which):
    """Find a dot along the line for each place in the row X: its swing there, and its slot.

    ``which`` is `BEFORE`, `OWN_LEFT`, the right one's number, or `ONLY`. The loop is flat, so that
    it becomes vector instructions.
    """
    last = 0.5 * cells[SLOTS] - 2.0
    pitch, spacing = cells[CELL_PITCH], cells[DOT_SPACING]
    cells_per_mm, dots_per_mm = 1.0 / pitch, 1.0 / cells[DOT_WIDTH]
    shape = _shape(cells)
    for n in range(count):
        u = rows[X_ROW, n]
        # Written so that a NaN, too, goes to the empty cell before the line, and is on no dot.
        cell = u * cells_per_mm
        cell = cell if cell > -1.0 else -1.0
        cell = np.floor(cell if cell < last else last)
        t = u - cell * pitch
        right = (1.0 if t >= spacing else 0.0) if which == ONLY else float(which)
        d = (t - (spacing * right if right >= 0.0 else spacing - pitch)) * dots_per_mm - 0.5
        d = d if d < 0.5 else 0.5
        d = d if d > -0.5 else -0.5
        rows[SWING, n] = _dot_swing(shape, d)
        slot = 2.0 * (cell + 1.0) + right
        rows[SLOT, n] = slot if slot > 0.0 else 0.0


@inlined
def _own_place(cells, x, y):
    """Place along lines of cells, and across them."""
    right, down = x - cells[LEFT], y - cells[TOP]
    u = right * cells[COSINE] + down * cells[SINE]
    return u, down * cells[COSINE] - right * cells[SINE]


@compiled
def highest_dot(cells, table, x, y):
    """Compute what a place has of lines of cells whose dots are round; the highest dot counts."""
    u, v = _own_place(cells, x, y)
    if not (0.0 < u < cells[WIDTH] and 0.0 < v < cells[HEIGHT]):
        return 0.0
    pitch, dot, row_pitch = cells[CELL_PITCH], cells[DOT_WIDTH], cells[DOT_ROW_PITCH]
    line_pitch, slots = cells[LINE_PITCH], int(cells[SLOTS])
    cell = int(min(u / pitch, 0.5 * slots - 2.0))
    most = 0.0
    # Lines that are close, or have a fourth row of dots, reach into one another.
    uppermost = math.ceil(max((v - LAST_ROW * row_pitch - dot) / line_pitch, 0.0))
    for line in range(uppermost, int(min(v / line_pitch, cells[LINES] - 1.0)) + 1):
        below = v - line * line_pitch
        base = int(cells[TABLE]) + (line + 1) * slots + 2 * cell + 2
        upper = math.ceil(max((below - dot) / row_pitch, 0.0))
        for row in range(upper, int(min(below / row_pitch, LAST_ROW)) + 1):
            dy = (below - row * row_pitch) / dot - 0.5
            for which in range(BEFORE, ONLY):
                edge = (cell - (which < 0)) * pitch + abs(which) * cells[DOT_SPACING]
                dx = (u - edge) / dot - 0.5
                d = math.sqrt(dx * dx + dy * dy)
                if d < 0.5 and table[base + which] >> row & 1:
                    most = max(most, _dot_swing(_shape(cells), d))
    return cells[CONTRAST] * most


@compiled
def opacity(cells, x, y):
    """Compute the opacity of lines of cells: 1 on the cells, and a dot's radius around.

    From there it ends over `FADE_MM`; the mask is ours, after Lévesque 2009, 8.4.5.
    """
    u, v = _own_place(cells, x, y)
    radius = 0.5 * cells[DOT_WIDTH]
    beside = max(max(-u, u - cells[WIDTH]) - radius, 0.0)
    below = max(max(-v, v - cells[HEIGHT]) - radius, 0.0)
    share = 1.0 - math.sqrt(beside * beside + below * below) / FADE_MM
    return share if share > 0.0 and cells[WIDTH] > 0.0 else 0.0
