"""The compiled inner loops of rendering.

Kernels fill ``out`` and allocate nothing, but for one frame in `poses`.
`vbraille.render.braille.style` compiles what they need into two arrays, ``numbers`` and ``table``
(see `vbraille.render.work`), and `vbraille.render.braille.reference` has the same functions in
plain numpy.

``scratch`` is float64[3, n]: room for the swing under each column of a block of positions, and for
the slot that each is over; for scenes, too, it has more rows. A slot is one dot column of one cell:
2 (cell + 1) + (0 left, 1 right), with an empty cell before a line's first and one after its last.
The table has a word for each slot of each line, whose bit r is set if actuator row r shows a dot
there; a page has an empty line before its first and one after its last. Where each actuator shows
what lies freely under it, bit r stands for row r of the dots instead.

The loops over a block are flat and without calls, so that they become vector instructions: hence
the polynomials of `vbraille.render.waves` instead of the library's sine.
"""

import math

import numpy as np

from vbraille.render.cellkernels import label as _label
from vbraille.render.evaluating import show as _show_scene
from vbraille.render.evaluating import show_all as _show_scenes
from vbraille.render.frames import copy
from vbraille.render.waves import HALF_SINE
from vbraille.render.waves import compiled as _compiled
from vbraille.render.waves import dot_swing as _dot_swing
from vbraille.render.waves import inlined as _inlined
from vbraille.render.work import (
    AMPLITUDE,
    ANCHOR,
    CELL_PITCH,
    CELLS_PER_MM,
    COLUMN_PITCH,
    COLUMNS,
    DOT_SPACING,
    DOTS_PER_MM,
    FREE,
    FREQUENCY,
    HYSTERESIS,
    IDLE,
    KIND,
    LINE_PITCH,
    LINES,
    NO_PART,
    OVERLAP,
    PATIENCE_S,
    PROFILE,
    ROW_PITCH,
    ROWS,
    SHAPE,
    SLOT,
    SLOTS,
    SWING,
    THETA,
    TILT,
    TIME,
    X,
    Y,
)

VIBRATION, SCENE = 2.0, 3.0  # of `ProgramKind`; the other kinds are braille
_PAGE = 1.0
_DOT_ROWS = 4
# An array that was turned too far shows braille again once it is upright by so much more.
_UPRIGHT = 0.85


@_compiled
def _swings(numbers, scratch, count, which):
    """Replace the places on the surface in ``scratch[SWING]`` by the swings there; fill the slots.

    ``which`` names the dot column of the cell: 0 the left one, 1 the right one, 2 the right one of
    the cell before, 3 the only one that can be there.
    """
    cells = int(numbers[SLOTS]) // 2 - 2
    cells_per_mm = numbers[CELLS_PER_MM]
    pitch = numbers[CELL_PITCH]
    spacing = numbers[DOT_SPACING]
    dots_per_mm = numbers[DOTS_PER_MM]
    e0, e1, e2 = numbers[SHAPE], numbers[SHAPE + 1], numbers[SHAPE + 2]
    e3, e4, e5 = numbers[SHAPE + 3], numbers[SHAPE + 4], numbers[SHAPE + 5]
    half_sine = numbers[PROFILE] == HALF_SINE
    before = 1.0 if which == 2 else 0.0
    is_right = 1.0 if which in (1, 2) else 0.0
    choose = which == 3
    for n in range(count):
        u = scratch[SWING, n]
        # Written so that a NaN, too, goes to the empty cell before the line.
        cell = u * cells_per_mm
        cell = cell if cell > -1.0 else -1.0
        cell = math.floor(cell if cell < cells else cells)
        t = u - cell * pitch
        right = (1.0 if t >= spacing else 0.0) if choose else is_right
        d = (t - spacing * right + pitch * before) * dots_per_mm - 0.5
        q = d * d
        q = q if q < 0.25 else 0.25
        d = d if d < 0.5 else 0.5
        d = d if d > -0.5 else -0.5
        value = _dot_swing(half_sine, e0, e1, e2, e3, e4, e5, d, q)
        scratch[SWING, n] = value if q < 0.25 else 0.0
        slot = 2.0 * (cell + 1.0 - before) + right
        scratch[SLOT, n] = slot if slot > 0.0 else 0.0


@_inlined
def _places(scratch, left_mm, first, columns, pitch):
    """Fill in where on the surface each column is (eq. 3.1: all columns sample one surface)."""
    for column in range(columns):
        scratch[SWING, first + column] = left_mm + column * pitch


@_compiled
def _write(numbers, table, base, scratch, first, out, above, below):
    """Fill rows of a frame with the swings of a block."""
    rows, columns = out.shape
    for row in range(above, below):
        idle = numbers[IDLE + row]
        gain = numbers[IDLE + rows + row]
        for column in range(columns):
            shown = table[base + int(scratch[SLOT, first + column])] >> row & 1
            out[row, column] = idle + gain * shown * scratch[SWING, first + column]


@_compiled
def _write_larger(numbers, table, base, scratch, first, out, above, below):
    """Fill rows of a frame where dots overlap, with the larger of their swings."""
    rows, columns = out.shape
    for row in range(above, below):
        idle = numbers[IDLE + row]
        gain = numbers[IDLE + rows + row]
        for column in range(columns):
            shown = table[base + int(scratch[SLOT, first + column])] >> row & 1
            swing = gain * shown * scratch[SWING, first + column]
            if abs(swing) > abs(out[row, column] - idle):
                out[row, column] = idle + swing


@_compiled
def _rows(numbers, table, base, scratch, left_mm, pitch, out, above, below):
    """Fill rows of a frame, all of which have their left columns at the same place."""
    columns = out.shape[1]
    _places(scratch, left_mm, 0, columns, pitch)
    if numbers[OVERLAP] == 0.0:
        _swings(numbers, scratch, columns, 3)
        _write(numbers, table, base, scratch, 0, out, above, below)
        return
    _swings(numbers, scratch, columns, 0)
    _write(numbers, table, base, scratch, 0, out, above, below)
    for which in range(1, 3):
        _places(scratch, left_mm, 0, columns, pitch)
        _swings(numbers, scratch, columns, which)
        _write_larger(numbers, table, base, scratch, 0, out, above, below)


@_inlined
def _base(numbers, part):
    """Tell where in the table the slots of a part begin; a part that is no line has empty slots."""
    if numbers[KIND] != _PAGE:
        return 0
    lines = int(numbers[LINES])
    line = part if -1 <= part <= lines else -1
    return (line + 1) * int(numbers[SLOTS])


@_compiled
def part_of(numbers, y_mm, before):
    """Tell which part of a picture belongs under the array: the line of a page nearest its centre.

    A line that was there stays until the centre is beyond its edge by half of the hysteresis.
    Above and below the page are the parts -1 and LINES, which show nothing. A picture of one
    part has part 0.
    """
    if numbers[KIND] != _PAGE:
        return 0
    at = y_mm / numbers[LINE_PITCH]
    if before != NO_PART and abs(at - before - 0.5) <= 0.5 + numbers[HYSTERESIS] / 2:
        return before
    lines = numbers[LINES]
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
def _free(numbers, table, scratch, at, out):
    """Fill a frame with what lies under each actuator: the dots of a page are round there.

    Lévesque 2009, eq. 6.1 and 8.3.1, with the profile of a line's dots for that of a dot.
    """
    rows, columns = out.shape
    cosine, sine = math.cos(at[THETA]), math.sin(at[THETA])
    n = 0
    for row in range(rows):
        down = (row - 0.5 * (rows - 1)) * numbers[ROW_PITCH]
        for column in range(columns):
            right = column * numbers[COLUMN_PITCH] - numbers[ANCHOR]
            scratch[0, n] = at[X] + right * cosine + down * sine
            scratch[1, n] = at[Y] + down * cosine - right * sine
            n += 1
    _label(numbers, IDLE + 2 * rows, table, scratch[0], scratch[1], n, scratch[2])
    n = 0
    for row in range(rows):
        for column in range(columns):
            out[row, column] = scratch[2, n]
            n += 1


@_compiled
def frame(numbers, table, scratch, part, at, out):
    """Fill one frame, float[rows, columns], of a part of a picture.

    ``at`` is what it is evaluated at, float64[6]: pose, time and velocity, by `work`.
    """
    rows, columns = out.shape
    # Compiled code would otherwise read beyond the numbers.
    if rows != numbers[ROWS] or columns != numbers[COLUMNS]:
        raise ValueError("the frame has not the shape of the array")
    if numbers[KIND] == VIBRATION:
        # Lévesque 2009, eqs. 8.1 and 8.2: neighbours swing against each other.
        phase = math.sin(2.0 * math.pi * numbers[FREQUENCY] * at[TIME])
        for row in range(rows):
            for column in range(columns):
                sign = 1.0 - 2.0 * ((row + column) & 1)
                out[row, column] = numbers[AMPLITUDE] * (0.5 + 0.5 * sign * phase)
        return
    if numbers[KIND] == SCENE:
        _show_scene(numbers, table, scratch, at, out)
        return
    if numbers[FREE] != 0.0:
        _free(numbers, table, scratch, at, out)
        return
    base = _base(numbers, part)
    theta = at[THETA]
    if theta == 0.0:
        left_mm = at[X] - numbers[ANCHOR]
        _rows(numbers, table, base, scratch, left_mm, numbers[COLUMN_PITCH], out, 0, rows)
        return
    cosine, sine = math.cos(theta), math.sin(theta)
    for row in range(rows):
        down_mm = (row - 0.5 * (rows - 1)) * numbers[ROW_PITCH]
        left_mm = at[X] - numbers[ANCHOR] * cosine + down_mm * sine
        pitch = numbers[COLUMN_PITCH] * cosine
        _rows(numbers, table, base, scratch, left_mm, pitch, out, row, row + 1)


@_compiled
def path(numbers, table, scratch, x_mm, out):
    """Fill a frame for each place along a line; out is float[n, rows, columns].

    The places of a block are computed by vector instructions, which is several times as fast as
    calling `frame` for each.
    """
    rows, columns = out.shape[1:]
    if rows != numbers[ROWS] or columns != numbers[COLUMNS]:
        raise ValueError("the frames have not the shape of the array")
    pitch = numbers[COLUMN_PITCH]
    if numbers[OVERLAP] != 0.0:
        for n in range(x_mm.size):
            left_mm = x_mm[n] - numbers[ANCHOR]
            _rows(numbers, table, 0, scratch, left_mm, pitch, out[n], 0, rows)
        return
    block = scratch.shape[1] // columns
    for first in range(0, x_mm.size, block):
        count = min(block, x_mm.size - first)
        for n in range(count):
            left_mm = x_mm[first + n] - numbers[ANCHOR]
            _places(scratch, left_mm, n * columns, columns, pitch)
        _swings(numbers, scratch, count * columns, 3)
        for n in range(count):
            _write(numbers, table, 0, scratch, n * columns, out[first + n], 0, rows)


@_compiled
def poses(numbers, table, scratch, at, parts, out):
    """Fill a frame for each pose over a picture, and the part that belongs under the array there.

    ``at`` is float64[n, 6], each row as `frame` takes it; ``parts``, int64[n], and ``out``,
    float[n, rows, columns], are filled. An array that is turned too far is at rest.
    """
    if numbers[KIND] == SCENE:
        if out.shape[1] != numbers[ROWS] or out.shape[2] != numbers[COLUMNS]:
            raise ValueError("the frames have not the shape of the array")
        # It has one part, and is shown at any angle.
        for n in range(parts.size):
            parts[n] = 0
        _show_scenes(numbers, table, scratch, at, out)
        return
    # Made as ticks make them, so that `frame` is compiled once.
    made = np.zeros(out.shape[1:])
    part = NO_PART
    turned = False
    for n in range(at.shape[0]):
        part = part_of(numbers, at[n, Y], part)
        parts[n] = part
        turned = too_far(numbers, at[n, THETA], turned)
        if turned:
            out[n] = 0.0
        else:
            frame(numbers, table, scratch, part, at[n], made)
            copy(made, out[n])
