"""The compiled inner loops of braille in a picture, of which the tests have a twin in numpy.

Both take the places of many actuators at once, x and y of the canvas in mm, and fill a number for
each. ``numbers`` is a whole program's; a label's run in it begins at ``first``, with the places
below, and its words are in the program's ``table``.
"""

import math

import numpy as np

from vbraille.render.waves import HALF_SINE, compiled, dot_swing

# Places of a label's numbers in their run.
(
    X0,  # corner of the first cell, mm
    Y0,
    COSINE,  # of the direction of its lines
    SINE,
    WIDTH,  # of the rectangle of its cells, mm
    HEIGHT,
    LINES,
    LINE_PITCH,
    LINES_PER_MM,
    ROW_PITCH,
    ROWS_PER_MM,
    CELL_PITCH,
    CELLS_PER_MM,
    DOT_SPACING,
    DOT_WIDTH,
    DOTS_PER_MM,
    CONTRAST,
    PROFILE,
    SHAPE,  # the 6 coefficients of the profile
    _S1,
    _S2,
    _S3,
    _S4,
    _S5,
    STRIDE,  # words of a line in the table: its cells, an empty one before them and one after
    TABLE,  # first of its words in the table
    APART,  # 1 if no two dots can be over one place
    COUNT,  # how many numbers there are
) = range(28)

FADE_MM = 1.0  # over which the opacity of a label ends

_LAST_ROW = 3


@compiled
def label(numbers, first, table, x, y, count, out):
    """Fill ``out[:count]`` with what a label has at places ``x[:count]``, ``y[:count]``."""
    if numbers[first + APART] != 0.0:
        _apart(numbers, first, table, x, y, count, out)
    else:
        _close(numbers, first, table, x, y, count, out)


@compiled
def _apart(numbers, first, table, x, y, count, out):
    """Fill ``out`` where each place has one dot at most: found by divisions alone."""
    x0, y0 = numbers[first + X0], numbers[first + Y0]
    cosine, sine = numbers[first + COSINE], numbers[first + SINE]
    width, height = numbers[first + WIDTH], numbers[first + HEIGHT]
    line_pitch, lines_per_mm = numbers[first + LINE_PITCH], numbers[first + LINES_PER_MM]
    row_pitch, rows_per_mm = numbers[first + ROW_PITCH], numbers[first + ROWS_PER_MM]
    cell_pitch, cells_per_mm = numbers[first + CELL_PITCH], numbers[first + CELLS_PER_MM]
    spacing, radius = numbers[first + DOT_SPACING], 0.5 * numbers[first + DOT_WIDTH]
    per_mm2 = numbers[first + DOTS_PER_MM] * numbers[first + DOTS_PER_MM]
    stride, start = int(numbers[first + STRIDE]), int(numbers[first + TABLE]) + 1
    lines = int(numbers[first + LINES])
    half_sine = numbers[first + PROFILE] == HALF_SINE
    shape = first + SHAPE
    e0, e1, e2 = numbers[shape], numbers[shape + 1], numbers[shape + 2]
    e3, e4, e5 = numbers[shape + 3], numbers[shape + 4], numbers[shape + 5]
    contrast = numbers[first + CONTRAST]
    # How far each place is from the nearest dot, whether up or not: vector instructions.
    for n in range(count):
        right, down = x[n] - x0, y[n] - y0
        u = right * cosine + down * sine
        v = down * cosine - right * sine
        v -= np.floor(v * lines_per_mm) * line_pitch
        row = np.floor(v * rows_per_mm)
        v -= (row if row < _LAST_ROW else _LAST_ROW) * row_pitch + radius
        u -= np.floor(u * cells_per_mm) * cell_pitch + radius
        u = u if u < spacing - radius else u - spacing
        q = (u * u + v * v) * per_mm2
        out[n] = q if q < 0.25 else 0.25
    for n in range(count):
        q = out[n]
        out[n] = 0.0
        if q >= 0.25:
            continue
        right, down = x[n] - x0, y[n] - y0
        u = right * cosine + down * sine
        v = down * cosine - right * sine
        if not (u > 0.0 and u < width and v > 0.0 and v < height):
            continue
        line, cell = int(v * lines_per_mm), int(u * cells_per_mm)
        line = line if line < lines else lines - 1
        row = int((v - line * line_pitch) * rows_per_mm)
        row = row if row < _LAST_ROW else _LAST_ROW
        side = 4 if u - cell * cell_pitch >= spacing else 0
        if table[start + line * stride + cell] >> (row + side) & 1:
            out[n] = contrast * dot_swing(half_sine, e0, e1, e2, e3, e4, e5, math.sqrt(q), q)


@compiled
def _close(numbers, first, table, x, y, count, out):
    """Fill ``out`` where dots overlap, of which the larger counts."""
    x0, y0 = numbers[first + X0], numbers[first + Y0]
    cosine, sine = numbers[first + COSINE], numbers[first + SINE]
    width, height = numbers[first + WIDTH], numbers[first + HEIGHT]
    lines, line_pitch = int(numbers[first + LINES]), numbers[first + LINE_PITCH]
    row_pitch, cell_pitch = numbers[first + ROW_PITCH], numbers[first + CELL_PITCH]
    dot, spacing = numbers[first + DOT_WIDTH], numbers[first + DOT_SPACING]
    radius, dots_per_mm = 0.5 * dot, numbers[first + DOTS_PER_MM]
    reach = _LAST_ROW * row_pitch + dot
    stride, start = int(numbers[first + STRIDE]), int(numbers[first + TABLE])
    half_sine = numbers[first + PROFILE] == HALF_SINE
    shape = first + SHAPE
    e0, e1, e2 = numbers[shape], numbers[shape + 1], numbers[shape + 2]
    e3, e4, e5 = numbers[shape + 3], numbers[shape + 4], numbers[shape + 5]
    for n in range(count):
        right, down = x[n] - x0, y[n] - y0
        u = right * cosine + down * sine
        v = down * cosine - right * sine
        out[n] = 0.0
        if not (u > 0.0 and u < width and v > 0.0 and v < height):
            continue
        cell = int(u * numbers[first + CELLS_PER_MM])
        cell = cell if cell < stride - 2 else stride - 2
        left = u - cell * cell_pitch - radius  # from the middle of the cell's left dots
        most = 0.0
        # Lines that are close, or have a fourth row of dots, reach into one another.
        uppermost = max(math.ceil((v - reach) * numbers[first + LINES_PER_MM]), 0)
        lowest = min(int(v * numbers[first + LINES_PER_MM]), lines - 1)
        for line in range(uppermost, lowest + 1):
            at = v - line * line_pitch
            upper = max(math.ceil((at - dot) * numbers[first + ROWS_PER_MM]), 0)
            lower = min(int(at * numbers[first + ROWS_PER_MM]), _LAST_ROW)
            base = start + line * stride + cell
            for row in range(upper, lower + 1):
                dy = at - row * row_pitch - radius
                # The right dot of the cell before, and the dots of this one.
                for which in range(3):
                    word = table[base + (which + 1) // 2]
                    if word >> (row + 4 * ((which + 1) & 1)) & 1 == 0:
                        continue
                    dx = left - (which - 1) * spacing if which else left - spacing + cell_pitch
                    q = (dx * dx + dy * dy) * dots_per_mm * dots_per_mm
                    if q < 0.25:
                        value = dot_swing(half_sine, e0, e1, e2, e3, e4, e5, math.sqrt(q), q)
                        most = max(most, value)
        out[n] = numbers[first + CONTRAST] * most


@compiled
def label_opacity(numbers, first, x, y, count, out):
    """Fill ``out[:count]`` with the opacity of a label: 1 on its cells, and a dot's radius around.

    From there it ends over `FADE_MM`; the mask is ours, after Lévesque 2009, 8.4.5.
    """
    x0, y0 = numbers[first + X0], numbers[first + Y0]
    cosine, sine = numbers[first + COSINE], numbers[first + SINE]
    width, height = numbers[first + WIDTH], numbers[first + HEIGHT]
    radius = 0.5 * numbers[first + DOT_WIDTH]
    for n in range(count):
        right, down = x[n] - x0, y[n] - y0
        u = right * cosine + down * sine
        v = down * cosine - right * sine
        beside = max(max(-u, u - width) - radius, 0.0)
        below = max(max(-v, v - height) - radius, 0.0)
        share = 1.0 - math.sqrt(beside * beside + below * below) / FADE_MM
        out[n] = share if share > 0.0 and width > 0.0 else 0.0
