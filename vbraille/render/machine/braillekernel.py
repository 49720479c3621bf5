"""The compiled inner loops of braille in a picture; `referencebraille` is their twin in numpy.

Both take the places of many actuators at once, x and y of the canvas in mm, and fill a number for
each. ``numbers`` is a whole program's; a label's run in it begins at ``first``, with the places
that `vbraille.render.scene.brailleplaces` names, and its words are in the program's ``table``.
"""

import math

from vbraille.render.machine.labelplaces import (
    CELL_PITCH,
    CELLS_PER_MM,
    CONTRAST,
    COSINE,
    DOT_SPACING,
    DOT_WIDTH,
    DOTS_PER_MM,
    FADE_MM,
    HEIGHT,
    LINE_PITCH,
    LINES,
    LINES_PER_MM,
    PROFILE,
    ROW_PITCH,
    ROWS_PER_MM,
    SHAPE,
    SINE,
    STRIDE,
    TABLE,
    WIDTH,
    X0,
    Y0,
)
from vbraille.render.waves import compiled, cos_pi, inlined, sin_pi

_HALF_SINE = 0.0
_LAST_ROW = 3


@inlined
def _swing(numbers, first, q):
    """Swing of a dot, which is round, at q = (distance from its middle / its width)² < 1/4."""
    sine = cos_pi(q)
    y = sine * sine
    if numbers[first + PROFILE] == _HALF_SINE:
        # Lévesque 2009, 3.2, with sin 8θ = 8 sin θ cos θ (1 - 10y + 24y² - 16y³)
        wave = -sin_pi(math.sqrt(q), q) * (1.0 + y * (-10.0 + y * (24.0 - 16.0 * y)))
        value = sine * (numbers[first + SHAPE] + numbers[first + SHAPE + 1] * wave)
    else:
        # eqs. 4.1-4.3 on [0, 1]: c = cos πp, and cos kπp = T_k(c), which is odd
        c = 2.0 * y - 1.0
        z = c * c
        value = numbers[first + SHAPE + 5]
        for n in range(4, -1, -1):
            value = numbers[first + SHAPE + n] + z * value
        value = 0.5 + c * value
    return min(max(value, 0.0), 1.0)


@compiled
def label(numbers, first, table, x, y, count, out):
    """Fill ``out[:count]`` with what a label has at places ``x[:count]``, ``y[:count]``."""
    x0, y0 = numbers[first + X0], numbers[first + Y0]
    cosine, sine = numbers[first + COSINE], numbers[first + SINE]
    width, height = numbers[first + WIDTH], numbers[first + HEIGHT]
    lines, line_pitch = int(numbers[first + LINES]), numbers[first + LINE_PITCH]
    row_pitch, cell_pitch = numbers[first + ROW_PITCH], numbers[first + CELL_PITCH]
    dot, spacing = numbers[first + DOT_WIDTH], numbers[first + DOT_SPACING]
    radius, dots_per_mm = 0.5 * dot, numbers[first + DOTS_PER_MM]
    reach = _LAST_ROW * row_pitch + dot
    stride, start = int(numbers[first + STRIDE]), int(numbers[first + TABLE])
    for n in range(count):
        right, down = x[n] - x0, y[n] - y0
        u = right * cosine + down * sine
        v = down * cosine - right * sine
        out[n] = 0.0
        if not (u > 0.0 and u < width and v > 0.0 and v < height):  # NaN is outside, too
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
                        most = max(most, _swing(numbers, first, q))
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
