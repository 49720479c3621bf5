"""Textures and images of scenes: Lévesque 2009, 8.4.1 and 8.4.2.

Each kernel fills one row of ``rows``, ``top``, from the places in the rows X and Y. ``at`` is the
first of its constants in ``numbers``, whose order is that of `vbraille.render.compiling`.
"""

import math

from vbraille.render.instructions import FREE_ROW, GIVEN_ROW, SIGN_ROW, SPARE_ROW, X_ROW, Y_ROW
from vbraille.render.waves import angle, compiled, hump

_TURN_DEG = 360.0
_DEG = 180.0 / math.pi
_WHOLE = 1.0 / 65_535.0


@compiled
def vibrate(numbers, rows, at, time, top, count):
    """Vibration q, alone: eq. 8.1."""
    swing = 0.5 * phase(numbers[at], time)
    for n in range(count):
        rows[top, n] = 0.5 + swing * rows[SIGN_ROW, n]


@compiled
def phase(frequency, time):
    """Compute sin 2πft; 1 without a time."""
    if math.isnan(time):
        return 1.0
    turns = frequency * time
    return math.sin(2.0 * math.pi * (turns - math.floor(turns)))


@compiled
def vibrate_high(numbers, rows, at, time, top, count):
    """Make what is up vibrate: δ δ¹, eq. 8.3."""
    amplitude = numbers[at + 1]
    swing = 0.5 * amplitude * phase(numbers[at], time)
    least = 1.0 - 0.5 * amplitude
    for n in range(count):
        rows[top, n] *= least + swing * rows[SIGN_ROW, n]


@compiled
def vibrate_low(numbers, rows, at, time, top, count):
    """Make what is down vibrate: 1 - (1 - δ) δ¹."""
    amplitude = numbers[at + 1]
    swing = 0.5 * amplitude * phase(numbers[at], time)
    least = 1.0 - 0.5 * amplitude
    for n in range(count):
        rows[top, n] = 1.0 - (1.0 - rows[top, n]) * (least + swing * rows[SIGN_ROW, n])


@compiled
def passed_s(rows, clock, time):
    """Time by which something has moved: by a signal, if a clock has its number, or by itself."""
    return rows[GIVEN_ROW, int(clock)] if clock >= 0.0 and time == time else time


@compiled
def linear(numbers, rows, at, time, top, count):
    """Linear grating: constants direction, start, then those of `_grating`."""
    right, down, start = numbers[at], numbers[at + 1], numbers[at + 2]
    for n in range(count):
        rows[top, n] = rows[X_ROW, n] * right + rows[Y_ROW, n] * down - start
    _grating(numbers, rows, at + 3, time, top, count)


@compiled
def radial(numbers, rows, at, time, top, count):
    """Radial grating: constants centre, then those of `_grating`."""
    x, y = numbers[at], numbers[at + 1]
    for n in range(count):
        dx, dy = rows[X_ROW, n] - x, rows[Y_ROW, n] - y
        rows[top, n] = math.sqrt(dx * dx + dy * dy)
    _grating(numbers, rows, at + 2, time, top, count)


@compiled
def axial(numbers, rows, at, time, top, count):
    """Axial grating: constants centre, start in degrees, middle, its fade, then the grating's."""
    x, y, start = numbers[at], numbers[at + 1], numbers[at + 2]
    for n in range(count):
        dx, dy = rows[X_ROW, n] - x, rows[Y_ROW, n] - y
        rows[SPARE_ROW, n] = math.sqrt(dx * dx + dy * dy)
        turn = angle(dx, dy) * _DEG - start
        turn -= _TURN_DEG * math.floor(turn / _TURN_DEG)
        rows[top, n] = turn if turn < _TURN_DEG else 0.0
    _grating(numbers, rows, at + 6, time, top, count)
    middle, inner, slope = numbers[at + 3], numbers[at + 4], numbers[at + 5]
    for n in range(count):
        share = (rows[SPARE_ROW, n] - inner) * slope
        share = share if share > 0.0 else 0.0
        share = share if share < 1.0 else 1.0
        rows[top, n] = middle + share * (rows[top, n] - middle)


@compiled
def _grating(numbers, rows, at, time, top, count):
    """Waveform g of the abscissa in ``top``, eq. 8.4, after a distortion, eqs. 8.5 and 8.6.

    Constants: cycle, ridge, velocity, clock, then of the distortion its change of frequency
    K - 1 (0 for none), where it begins, its length, and 1 if it is a peak.
    """
    cycle, ridge, velocity = numbers[at], numbers[at + 1], numbers[at + 2]
    change = numbers[at + 4]
    if change != 0.0:
        begin, length, peak = numbers[at + 5], numbers[at + 6], numbers[at + 7]
        half = 0.5 / length
        for n in range(count):
            x = rows[top, n]
            u = x - begin
            # Area of the rise up to here, and of what comes after it: 1 for ever, or a fall.
            v = u - length
            u = u if u > 0.0 else 0.0
            u = u if u < length else length
            v = v if v > 0.0 else 0.0
            w = v if v < length else length
            after = w - half * w * w if peak != 0.0 else v
            rows[top, n] = x + change * (half * u * u + after)
    shift = 0.0
    passed = passed_s(rows, numbers[at + 3], time)
    if velocity != 0.0 and passed == passed:
        shift = velocity * passed / cycle
        shift = cycle * (shift - math.floor(shift))
    cycles, ridges = 1.0 / cycle, 1.0 / ridge
    for n in range(count):
        x = rows[top, n] - shift
        x -= cycle * math.floor(x * cycles)
        rows[top, n] = hump(x * ridges - 0.5)


@compiled
def image(numbers, table, rows, at, top, count):
    """Bilinear image: constants middle of the first pixel, pixels a mm, size, place in ``table``.

    In the table there is a ring of pixels around it, of the intensity beyond its edges.
    """
    x0, y0, columns_per_mm, rows_per_mm = (
        numbers[at],
        numbers[at + 1],
        numbers[at + 2],
        numbers[at + 3],
    )
    columns, lines = numbers[at + 4], numbers[at + 5]
    base, width = int(numbers[at + 6]), int(columns)
    for n in range(count):
        # Written so that whatever comes, the four pixels are in the table.
        u, v = (rows[X_ROW, n] - x0) * columns_per_mm, (rows[Y_ROW, n] - y0) * rows_per_mm
        u = u if u > 0.0 else 0.0
        v = v if v > 0.0 else 0.0
        u = u if u < columns - 1.0 else columns - 1.0
        v = v if v < lines - 1.0 else lines - 1.0
        left, above = math.floor(u), math.floor(v)
        left = left if left < columns - 2.0 else columns - 2.0
        above = above if above < lines - 2.0 else lines - 2.0
        rows[top, n] = above * columns + left
        rows[FREE_ROW, n], rows[SPARE_ROW, n] = u - left, v - above
    for n in range(count):
        pixel = base + int(rows[top, n])
        u, v = rows[FREE_ROW, n], rows[SPARE_ROW, n]
        a, b = float(table[pixel]), float(table[pixel + 1])
        c, d = float(table[pixel + width]), float(table[pixel + width + 1])
        above = a + u * (b - a)
        below = c + u * (d - c)
        rows[top, n] = _WHOLE * (above + v * (below - above))


@compiled
def pixels(numbers, table, rows, at, top, count):
    """Image by the pixel that each place is in; constants as for `image`."""
    x0, y0 = numbers[at], numbers[at + 1]
    columns_per_mm, rows_per_mm = numbers[at + 2], numbers[at + 3]
    columns, lines = numbers[at + 4], numbers[at + 5]
    base = int(numbers[at + 6])
    for n in range(count):
        u = math.floor((rows[X_ROW, n] - x0) * columns_per_mm + 0.5)
        v = math.floor((rows[Y_ROW, n] - y0) * rows_per_mm + 0.5)
        u = u if u > 0.0 else 0.0
        v = v if v > 0.0 else 0.0
        u = u if u < columns - 1.0 else columns - 1.0
        v = v if v < lines - 1.0 else lines - 1.0
        rows[FREE_ROW, n] = v * columns + u
    for n in range(count):
        rows[top, n] = _WHOLE * float(table[base + int(rows[FREE_ROW, n])])
