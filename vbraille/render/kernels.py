"""The compiled inner loops of rendering.

Kernels fill ``out`` and allocate nothing. A program is the two arrays
``numbers`` and ``table`` (see `vbraille.render.work`), of which the tests have a twin in plain
numpy; ``scratch`` is its `vbraille.render.program.Program.scratch`.
"""

import math

from vbraille.render.cellkernels import BEFORE, ONLY, find_dots, highest_dot
from vbraille.render.evaluating import show
from vbraille.render.frames import copy
from vbraille.render.signalkernels import compute
from vbraille.render.waves import compiled as _compiled
from vbraille.render.work import (
    APART,
    AT,
    CELL_NUMBERS,
    CELLS,
    CENTER,
    COLUMN_PITCH,
    COLUMNS,
    FREE,
    FREQUENCY,
    GIVEN_ROW,
    HYSTERESIS,
    KIND,
    LINE_PITCH,
    LINES,
    MEMORY,
    MOST_SIGNALS,
    NO_PART,
    ORIGIN_X,
    ORIGIN_Y,
    PATIENCE_S,
    ROW_PITCH,
    ROWS,
    SIGN_ROW,
    SIGNAL,
    SLOT,
    SLOTS,
    SWING,
    THETA,
    TILT,
    TIME,
    X_ROW,
    Y_ROW,
    X,
    Y,
)

_PAGE, SCENE = 1.0, 2.0  # of `ProgramKind`
_IDLE = CELLS + CELL_NUMBERS
# An array that was turned too far shows braille again once it is upright by so much more.
_UPRIGHT = 0.85


@_compiled
def part_of(numbers, y_mm, before):
    """Tell which part of a picture belongs under the array: the line of a page nearest its centre.

    A line that was there stays until the centre is beyond its edge by half of the hysteresis.
    Above and below the page are the parts -1 and LINES, which show nothing. A picture of one
    part has part 0.
    """
    if numbers[KIND] != _PAGE:
        return 0
    at = y_mm / numbers[CELLS + LINE_PITCH]
    if before != NO_PART and abs(at - before - 0.5) <= 0.5 + numbers[HYSTERESIS] / 2:
        return before
    lines = numbers[CELLS + LINES]
    at = at if at > -1.0 else -1.0  # NaN, too, gives this place
    return math.floor(at if at < lines else lines)


@_compiled
def seamless(numbers):
    """Tell whether one part of a picture goes over into the next without a fade."""
    return numbers[KIND] == _PAGE and numbers[FREE] != 0.0


@_compiled
def patience(numbers):
    """Tell how long a picture is shown to a hand that does not move, s; infinite for most.

    Vibration tires the skin (Lévesque 2009, 8.6), and a scene may have it anywhere.
    """
    return PATIENCE_S if numbers[KIND] == SCENE and numbers[FREQUENCY] > 0.0 else math.inf


@_compiled
def too_far(numbers, theta, before):
    """Tell whether an array is turned too far for a picture, where it was or was not ``before``."""
    limit = numbers[TILT]
    return abs(theta) > (_UPRIGHT * limit if before else limit)


@_compiled
def _write(numbers, table, part, scratch, first, step, out, which):
    """Fill a frame with the swings of a line's dots, or with those that are larger.

    Row r has the places from first + r · step on. A part that is no line has empty slots.
    """
    rows, columns = out.shape
    is_first = which in (BEFORE, ONLY)
    line = part if -1 <= part <= numbers[CELLS + LINES] else -1
    base = (line + 1) * int(numbers[CELLS + SLOTS])
    for row in range(rows):
        idle, gain = numbers[_IDLE + row], numbers[_IDLE + rows + row]
        for column in range(columns):
            n = first + row * step + column
            shown = table[base + int(scratch[SLOT, n])] >> row & 1
            swing = gain * shown * scratch[SWING, n]
            if is_first or abs(swing) > abs(out[row, column] - idle):
                out[row, column] = idle + swing


@_compiled
def _columns_of_dots(numbers):
    """Tell which columns of dots are looked at."""
    if numbers[CELLS + APART] != 0.0:
        return range(ONLY, ONLY + 1)
    return range(BEFORE, ONLY)


@_compiled
def frame(numbers, table, scratch, part, at, out):
    """Fill one frame, float[rows, columns], of a part of a picture.

    ``at`` is what it is evaluated at, float64[AT] by `work`: pose, time, velocity and signals.
    """
    rows, columns = out.shape
    # Compiled code would otherwise read beyond the numbers.
    if rows != numbers[ROWS] or columns != numbers[COLUMNS]:
        raise ValueError("the frame has not the shape of the array")
    is_free = seamless(numbers)
    x0, y0 = numbers[ORIGIN_X] + at[X], numbers[ORIGIN_Y] + at[Y]
    cosine, sine = math.cos(at[THETA]), math.sin(at[THETA])
    pitch, row_pitch, center = numbers[COLUMN_PITCH], numbers[ROW_PITCH], numbers[CENTER]
    n = 0
    for row in range(rows):
        down = (row - 0.5 * (rows - 1)) * row_pitch
        for column in range(columns):
            right = (column - 0.5 * (columns - 1)) * pitch + center
            x, y = x0 + right * cosine + down * sine, y0 + down * cosine - right * sine
            sign = 1.0 - 2.0 * ((row + column) & 1)
            scratch[X_ROW, n], scratch[Y_ROW, n], scratch[SIGN_ROW, n] = x, y, sign
            n += 1
            if is_free:
                out[row, column] = highest_dot(numbers[CELLS:], table, x, y)
    if numbers[KIND] == SCENE:
        for k in range(MOST_SIGNALS):
            scratch[GIVEN_ROW, k] = at[SIGNAL + k]
        scratch[GIVEN_ROW, MOST_SIGNALS], scratch[GIVEN_ROW, MOST_SIGNALS + 1] = x0, y0
        show(numbers, table, scratch, at[TIME], out)
    elif not is_free:
        for which in _columns_of_dots(numbers):
            find_dots(numbers[CELLS:], scratch, n, which)
            _write(numbers, table, part, scratch, 0, columns, out, which)


@_compiled
def path(numbers, table, scratch, x_mm, out):
    """Fill a frame for each place along a line; out is float[n, rows, columns].

    The places of a block are computed by vector instructions, which is several times as fast as
    calling `frame` for each.
    """
    columns = out.shape[2]
    block = scratch.shape[1] // columns
    for first in range(0, x_mm.size, block):
        count = min(block, x_mm.size - first)
        for n in range(count):
            middle_mm = x_mm[first + n] + numbers[CENTER]
            for column in range(columns):
                right = (column - 0.5 * (columns - 1)) * numbers[COLUMN_PITCH]
                scratch[X_ROW, n * columns + column] = middle_mm + right
        for which in _columns_of_dots(numbers):
            find_dots(numbers[CELLS:], scratch, count * columns, which)
            for n in range(count):
                _write(numbers, table, 0, scratch, n * columns, 0, out[first + n], which)


@_compiled
def poses(numbers, table, scratch, at, made, parts, out):
    """Fill a frame for each pose over a picture, and the part that belongs under the array there.

    ``at`` is float64[n, AT], each row as `frame` takes it, in order of time; ``parts``, int64[n],
    and ``out``, float[n, rows, columns], are filled. An array that is turned too far is at rest.
    Signals are computed, too: they begin as when the picture is first shown, unless the first row
    has what they remember; without it that is NaN. In ``made``, float64[rows,
    columns], frames are made as ticks make them, so that `frame` is compiled once.
    """
    part = NO_PART
    turned = False
    for n in range(at.shape[0]):
        if numbers[KIND] == SCENE and n > 0:
            for k in range(MEMORY, AT):
                at[n, k] = at[n - 1, k]
            compute(numbers, at[n], max(at[n, TIME] - at[n - 1, TIME], 0.0))
        elif numbers[KIND] == SCENE and math.isnan(at[0, MEMORY]):
            compute(numbers, at[0], 0.0)
        part = part_of(numbers, at[n, Y], part)
        parts[n] = part
        turned = too_far(numbers, at[n, THETA], turned)
        if turned:
            out[n] = 0.0
        else:
            frame(numbers, table, scratch, part, at[n], made)
            copy(made, out[n])
