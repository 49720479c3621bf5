"""The evaluator of compiled scenes, and frames and rasters made by it.

The evaluator is large, and would be compiled anew into everything that makes frames: each kind of
tick, and each layout of frames. So it is compiled once, as a function of C, and those call it by
its name, as they call functions of the C library.
"""

import math

import numpy as np
from llvmlite import binding, ir
from numba import carray, cfunc, config, types  # pyright: ignore[reportPrivateImportUsage]
from numba.extending import intrinsic

from vbraille.caching import keep_compiled
from vbraille.render import instructions as i
from vbraille.render import shapekernels as shapes
from vbraille.render import texturekernels as textures
from vbraille.render.cellkernels import label, label_opacity
from vbraille.render.signalkernels import begin, compute, shut_gates
from vbraille.render.waves import compiled
from vbraille.render.work import AT, MEMORY, MOST_SIGNALS, SIGNAL, THETA, TIME, X, Y

_NO_PLACE = 1e9  # mm; a centre farther away is none
_ROUNDING_MM = 1e-6


@compiled
def _evaluate(numbers, table, rows, count, gates, time, left, top_mm, right, bottom):
    """Compute the deflections at ``count`` places, which are in the rows X and Y.

    The row of signs says which way each place swings, 1 or -1. Without a time, which is NaN then,
    it has noise from -1 to 1 that stands for vibrations. The row `GIVEN_ROW` has the signals, by
    which ``gates`` are shut. The deflections go to the row `STACK`. All places are in the box that
    is given last.
    """
    here = np.int64(i.CODE)
    top = i.STACK  # the row above the uppermost
    while True:
        operation, at = int(numbers[here]), here + 2
        here += int(numbers[here + 1])
        if operation == i.END:
            return
        if operation == i.GATE:
            if (
                gates & int(numbers[at + 4]) != 0
                or numbers[at + 2] < left
                or numbers[at] > right
                or numbers[at + 3] < top_mm
                or numbers[at + 1] > bottom
            ):
                here += int(numbers[at + 5])
                for _ in range(int(numbers[at + 6])):
                    _level(rows, top, 0.0, count)
                    top += 1
        elif operation == i.LEVEL:
            _level(rows, top, numbers[at], count)
            top += 1
        elif operation == i.SIGNAL:
            _level(rows, top, rows[i.GIVEN_ROW, int(numbers[at])], count)
            top += 1
        elif operation == i.ADD:
            top -= 1
            for n in range(count):
                value = rows[top - 1, n] + rows[top, n]
                rows[top - 1, n] = value if value < 1.0 else 1.0
        elif operation == i.MAXIMUM:
            top -= 1
            for n in range(count):
                value = rows[top, n]
                rows[top - 1, n] = value if value > rows[top - 1, n] else rows[top - 1, n]
        elif operation == i.MULTIPLY:
            top -= 1
            for n in range(count):
                rows[top - 1, n] *= rows[top, n]
        elif operation == i.OVER:
            top -= 2
            _over(rows, top, top + 1, count)
        elif operation == i.OVER_ITSELF:
            top -= 1
            _over(rows, top, top, count)
        elif operation == i.BLEND:
            top -= 2
            for n in range(count):
                first = rows[top - 1, n]
                rows[top - 1, n] = first + rows[top + 1, n] * (rows[top, n] - first)
        elif operation == i.SCALE:
            _scale(rows, top - 1, numbers[at], count)
        elif operation == i.BY_SIGNAL:
            _scale(rows, top - 1, rows[i.GIVEN_ROW, int(numbers[at])], count)
        elif operation == i.INVERT:
            for n in range(count):
                rows[top - 1, n] = 1.0 - rows[top - 1, n]
        elif operation == i.VIBRATE_HIGH:
            textures.vibrate_high(numbers, rows, at, time, top - 1, count)
        elif operation == i.VIBRATE_LOW:
            textures.vibrate_low(numbers, rows, at, time, top - 1, count)
        elif operation == i.VIBRATION:
            textures.vibrate(numbers, rows, at, time, top, count)
            top += 1
        elif operation == i.LINEAR:
            textures.linear(numbers, rows, at, time, top, count)
            top += 1
        elif operation == i.RADIAL:
            textures.radial(numbers, rows, at, time, top, count)
            top += 1
        elif operation == i.AXIAL:
            textures.axial(numbers, rows, at, time, top, count)
            top += 1
        elif operation == i.IMAGE:
            textures.image(numbers, table, rows, at, top, count)
            top += 1
        elif operation == i.PIXELS:
            textures.pixels(numbers, table, rows, at, top, count)
            top += 1
        elif operation == i.LABEL:
            label(numbers, at, table, rows[i.X_ROW], rows[i.Y_ROW], count, rows[top])
            top += 1
        elif operation == i.LABEL_MASK:
            label_opacity(numbers, at, rows[i.X_ROW], rows[i.Y_ROW], count, rows[top])
            top += 1
        elif operation == i.DOTS:
            shapes.dots(numbers, rows, at, time, top, count, left, top_mm, right, bottom)
            top += 1
        elif operation == i.CIRCLE:
            shapes.circle(numbers, rows, at, count)
        elif operation == i.PATH:
            shapes.path(numbers, rows, at, time, count, left, top_mm, right, bottom)
        elif operation == i.PROFILE:
            shapes.profile(numbers, rows, at, i.ACROSS_ROW, top, count)
            top += 1
        elif operation == i.BANDS:
            shapes.bands(numbers, rows, at, time, top, count)
            top += 1
        elif operation == i.GROOVE:
            shapes.groove(numbers, rows, at, top - 1, count)
        elif operation == i.MARKERS:
            shapes.markers(numbers, rows, at, time, top - 1, count)
        elif operation == i.BEYOND:
            shapes.beyond(numbers, rows, at, top, count)
            top += 1
        elif operation == i.CUE:
            shapes.cue(numbers, rows, at, time, top - 1, count)
            top += 1
        elif operation == i.FILL:
            top -= 1
            shapes.fill(numbers, rows, at, top, count)
        elif operation == i.FILL_BLENDED:
            top -= 2
            shapes.fill_blended(rows, top, count)
        elif operation == i.FILL_MASK:
            shapes.fill_mask(rows, top - 1, count)
        elif operation == i.WRAP or operation == i.SHIFT:
            for n in range(count):
                rows[top, n], rows[top + 1, n] = rows[i.X_ROW, n], rows[i.Y_ROW, n]
            top += 2
            if operation == i.WRAP:
                _wrap(numbers, rows, at, count)
            else:
                _shift(numbers, rows, at, time, count)
            left, top_mm, right, bottom = _bounds(rows, count)
        elif operation == i.RESTORE:
            top -= 2
            for n in range(count):
                rows[i.X_ROW, n], rows[i.Y_ROW, n] = rows[top - 1, n], rows[top, n]
                rows[top - 1, n] = rows[top + 1, n]
            left, top_mm, right, bottom = _bounds(rows, count)


@compiled
def _level(rows, top, level, count):
    for n in range(count):
        rows[top, n] = level


@compiled
def _scale(rows, top, factor, count):
    for n in range(count):
        rows[top, n] *= factor


@compiled
def _over(rows, top, mask, count):
    """Lay the row ``top`` on the row beneath it: Lévesque 2009, eq. 8.22."""
    for n in range(count):
        value = rows[top, n] + (1.0 - rows[mask, n]) * rows[top - 1, n]
        rows[top - 1, n] = value if value < 1.0 else 1.0


@compiled
def _wrap(numbers, rows, at, count):
    """Wrap the places into a tile: constants origin, width and height."""
    x0, y0, width, height = numbers[at], numbers[at + 1], numbers[at + 2], numbers[at + 3]
    for n in range(count):
        x, y = rows[i.X_ROW, n] - x0, rows[i.Y_ROW, n] - y0
        x -= width * math.floor(x / width)
        y -= height * math.floor(y / height)
        # A quotient may be rounded up to the next tile.
        rows[i.X_ROW, n] = x if x >= 0.0 else x + width
        rows[i.Y_ROW, n] = y if y >= 0.0 else y + height


@compiled
def _shift(numbers, rows, at, time, count):
    """Move the places: constants velocity, clock, and a centre's place.

    Lévesque 2009, eq. 9.1: δ(p - vt). Where a centre is given, places are taken as if the array's
    centre stood there, so that what moves does so under the finger, not by the hand.
    """
    right = down = 0.0
    passed = textures.passed_s(rows, numbers[at + 2], time)
    if passed == passed:
        right, down = -numbers[at] * passed, -numbers[at + 1] * passed
    x, y = rows[i.GIVEN_ROW, i.CENTER_X], rows[i.GIVEN_ROW, i.CENTER_Y]
    if numbers[at + 3] < _NO_PLACE and x == x:
        right += numbers[at + 3] - x
        down += numbers[at + 4] - y
    for n in range(count):
        rows[i.X_ROW, n] += right
        rows[i.Y_ROW, n] += down


@compiled
def _bounds(rows, count):
    """Find the box of all places."""
    left = right = rows[i.X_ROW, 0]
    top = bottom = rows[i.Y_ROW, 0]
    for n in range(1, count):
        x, y = rows[i.X_ROW, n], rows[i.Y_ROW, n]
        left, right = min(left, x), max(right, x)
        top, bottom = min(top, y), max(bottom, y)
    return left, top, right, bottom


_NAME = "vbraille_evaluate_scene"
_I64, _F64 = ir.IntType(64), ir.DoubleType()
_ANY = 1 << 40
_SIGNATURE = types.void(
    types.CPointer(types.float64),
    types.CPointer(types.uint16),
    types.CPointer(types.float64),
    *(types.int64,) * 3,
    *(types.float64,) * 5,
)


def _evaluate_plainly(numbers, table, rows, width, count, gates, time, left, top, right, bottom):
    # The evaluator stays within the program that was compiled; how long that is it does not ask.
    _evaluate(
        carray(numbers, (_ANY,)),
        carray(table, (_ANY,)),
        carray(rows, (i.SCRATCH_ROWS, width)),
        count,
        gates,
        time,
        left,
        top,
        right,
        bottom,
    )


@intrinsic
def _call(
    _typing, _numbers, _table, _rows, _width, _count, _gates, _time, _left, _top, _right, _bottom
):
    """Call `_evaluate` by its name, with addresses of arrays."""

    def code(context, builder, _signature, arguments):
        doubles, words = _F64.as_pointer(), ir.IntType(16).as_pointer()
        kinds = (doubles, words, doubles, *(_I64,) * 3, *(_F64,) * 5)
        function = builder.module.globals.get(_NAME)
        if function is None:
            kind = ir.FunctionType(ir.VoidType(), kinds)
            function = ir.Function(builder.module, kind, _NAME)
        given = list(arguments)
        for n in range(3):
            given[n] = builder.inttoptr(given[n], kinds[n])
        builder.call(function, given)
        return context.get_dummy_value()

    return types.void(*(types.int64,) * 6, *(types.float64,) * 5), code


if config.DISABLE_JIT:  # pyright: ignore[reportAttributeAccessIssue]
    evaluate = _evaluate  # pyright: ignore[reportAssignmentType]
else:
    # Kept as long as the process, for compiled code calls it by its address.
    _function = cfunc(_SIGNATURE, cache=keep_compiled(), error_model="numpy", nogil=True)(
        _evaluate_plainly
    )
    binding.add_symbol(_NAME, _function.address)

    @compiled
    def evaluate(numbers, table, rows, count, gates, time, left, top, right, bottom):
        """Do as `_evaluate` does, which is not compiled into the caller."""
        _call(  # pyright: ignore[reportCallIssue]
            numbers.ctypes.data,
            table.ctypes.data,
            rows.ctypes.data,
            rows.shape[1],
            count,
            gates,
            time,
            left,
            top,
            right,
            bottom,
        )


@compiled
def show(numbers, table, rows, at, out):
    """Fill a frame with the deflections of a scene at a pose and a time."""
    above, across = out.shape
    x, y = at[X] + numbers[i.ORIGIN_X], at[Y] + numbers[i.ORIGIN_Y]
    cosine, sine = 1.0, 0.0
    theta = at[THETA]
    if theta != 0.0:
        cosine, sine = math.cos(theta), math.sin(theta)
    half_down = 0.5 * (above - 1) * numbers[i.ROW_MM]
    half_aside = 0.5 * (across - 1) * numbers[i.COLUMN_MM]
    wide = half_aside * abs(cosine) + half_down * abs(sine) + _ROUNDING_MM
    high = half_down * abs(cosine) + half_aside * abs(sine) + _ROUNDING_MM
    x0, x1, y0, y1 = x - wide, x + wide, y - high, y + high
    right, bottom = numbers[i.RIGHT_MM], numbers[i.BOTTOM_MM]
    # Written so that NaN is nowhere.
    if not (x0 <= right and x1 >= 0.0 and y0 <= bottom and y1 >= 0.0):
        for row in range(above):
            for column in range(across):
                out[row, column] = 0.0
        return
    for n in range(MOST_SIGNALS):
        rows[i.GIVEN_ROW, n] = at[SIGNAL + n]
    rows[i.GIVEN_ROW, i.CENTER_X], rows[i.GIVEN_ROW, i.CENTER_Y] = x, y
    n = 0
    for row in range(above):
        down = (row - 0.5 * (above - 1)) * numbers[i.ROW_MM]
        for column in range(across):
            aside = (column - 0.5 * (across - 1)) * numbers[i.COLUMN_MM]
            rows[i.X_ROW, n] = x + aside * cosine + down * sine
            rows[i.Y_ROW, n] = y + down * cosine - aside * sine
            rows[i.SIGN_ROW, n] = 1.0 - 2.0 * ((row + column) & 1)
            n += 1
    gates = shut_gates(numbers, rows[i.GIVEN_ROW])
    evaluate(numbers, table, rows, n, gates, at[TIME], x0, y0, x1, y1)
    whole = x0 >= 0.0 and x1 <= right and y0 >= 0.0 and y1 <= bottom
    n = 0
    for row in range(above):
        for column in range(across):
            value = rows[i.STACK, n]
            if not whole:
                px, py = rows[i.X_ROW, n], rows[i.Y_ROW, n]
                value = value if 0.0 <= px <= right and 0.0 <= py <= bottom else 0.0
            value = value if value > 0.0 else 0.0
            out[row, column] = value if value < 1.0 else 1.0
            n += 1


@compiled
def show_all(numbers, table, rows, at, out):
    """Fill a frame for each pose and time, of which each is a row of ``at``, in order of time.

    Signals are computed, too. They begin as when the picture is first shown, unless the first row
    has what they remember; without it the first number of that is NaN.
    """
    for n in range(out.shape[0]):
        if numbers[i.SIGNALS] != 0.0:
            if n:
                # A slice given to a slice would be compiled with all words of its refusal.
                for k in range(MEMORY, AT):
                    at[n, k] = at[n - 1, k]
                compute(numbers, at[n], max(at[n, TIME] - at[n - 1, TIME], 0.0))
            elif at[0, MEMORY] != at[0, MEMORY]:
                begin(numbers, at[0])
                compute(numbers, at[0], 0.0)
        show(numbers, table, rows, at[n], out[n])


# Places of a raster that are computed together, so that their rows stay in the nearer caches.
TILE_COLUMNS, TILE_LINES = 32, 16


@compiled
def raster(numbers, table, rows, x_mm, y_mm, sign, noise, time, out):
    """Fill a raster.

    Parameters
    ----------
    numbers, table
        The program.
    rows : float64[SCRATCH_ROWS, TILE_COLUMNS · TILE_LINES]
        Room to work in, with the values of the signals.
    x_mm, y_mm : float64[w], float64[h]
        Places of the raster's columns and lines.
    sign : float
        1 or -1, by which vibrations swing.
    noise : float32[h, w] or float32[0, 0]
        Noise from -1 to 1 that stands for vibrations, if there is no time.
    time : float
        Time in seconds, or NaN.
    out : float32[h, w]
        Deflections.
    """
    right, bottom = numbers[i.RIGHT_MM], numbers[i.BOTTOM_MM]
    gates = shut_gates(numbers, rows[i.GIVEN_ROW])
    for first in range(0, y_mm.size, TILE_LINES):
        last = min(first + TILE_LINES, y_mm.size)
        for begins in range(0, x_mm.size, TILE_COLUMNS):
            ends = min(begins + TILE_COLUMNS, x_mm.size)
            n = 0
            for line in range(first, last):
                for column in range(begins, ends):
                    rows[i.X_ROW, n], rows[i.Y_ROW, n] = x_mm[column], y_mm[line]
                    rows[i.SIGN_ROW, n] = noise[line, column] if noise.size else sign
                    n += 1
            x0, y0, x1, y1 = _bounds(rows, n)
            evaluate(numbers, table, rows, n, gates, time, x0, y0, x1, y1)
            n = 0
            for line in range(first, last):
                for column in range(begins, ends):
                    x, y = x_mm[column], y_mm[line]
                    value = min(max(rows[i.STACK, n], 0.0), 1.0)
                    out[line, column] = value if 0 <= x <= right and 0 <= y <= bottom else 0.0
                    n += 1
