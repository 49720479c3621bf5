"""Frames and rasters of compiled scenes.

What reads a scene's words is large, and would be compiled anew into everything that makes frames:
each kind of tick, and each layout of frames. So it is compiled once, as a function of C, and those
call it by its name, as they call functions of the C library.
"""

import math

import numpy as np
from llvmlite import binding, ir
from numba import carray, cfunc, config, types  # pyright: ignore[reportPrivateImportUsage]
from numba.extending import intrinsic

from vbraille.caching import keep_compiled
from vbraille.render.machine import words as w
from vbraille.render.machine.scenekernels import evaluate
from vbraille.render.machine.signalkernels import begin, compute, shut_gates
from vbraille.render.waves import compiled
from vbraille.render.work import AT, MEMORY, MOST_SIGNALS, SIGNAL, THETA, TIME, X, Y

_NAME = "vbraille_evaluate_scene"
_I64, _F64 = ir.IntType(64), ir.DoubleType()
_SIGNATURE = types.void(
    types.CPointer(types.float64),
    types.CPointer(types.uint16),
    types.CPointer(types.float64),
    *(types.int64,) * 4,
    *(types.float64,) * 5,
)


def _evaluate_plainly(
    numbers, table, rows, width, start, count, gates, time, left, right, top, bottom
):
    # The machine stays within what was compiled; how long that is it does not ask.
    evaluate(
        carray(numbers, (_ANY,)),
        carray(table, (_ANY,)),
        carray(rows, (w.SCRATCH_ROWS, width)),
        start,
        count,
        gates,
        time,
        left,
        right,
        top,
        bottom,
    )


_ANY = 1 << 40
_ROUNDING_MM = 1e-6


@intrinsic
def _call(
    _typing, _numbers, _table, _rows, _width, _start, _count, _gates, _time, _left, _right, _top,
    _bottom,
):  # fmt: skip
    """Call `evaluate` by its name, with addresses of arrays."""

    def code(context, builder, _signature, arguments):
        doubles, words = _F64.as_pointer(), ir.IntType(16).as_pointer()
        kinds = (doubles, words, doubles, *(_I64,) * 4, *(_F64,) * 5)
        function = builder.module.globals.get(_NAME)
        if function is None:
            kind = ir.FunctionType(ir.VoidType(), kinds)
            function = ir.Function(builder.module, kind, _NAME)
        given = list(arguments)
        for n in range(3):
            given[n] = builder.inttoptr(given[n], kinds[n])
        builder.call(function, given)
        return context.get_dummy_value()

    return types.void(*(types.int64,) * 7, *(types.float64,) * 5), code


if config.DISABLE_JIT:  # pyright: ignore[reportAttributeAccessIssue]
    run = evaluate  # pyright: ignore[reportAssignmentType]
else:
    # Kept as long as the process, for compiled code calls it by its address.
    _evaluate = cfunc(_SIGNATURE, cache=keep_compiled(), error_model="numpy", nogil=True)(
        _evaluate_plainly
    )
    binding.add_symbol(_NAME, _evaluate.address)

    @compiled
    def run(numbers, table, rows, start, count, gates, time, left, right, top, bottom):
        """Do as `scenekernels.evaluate` does, which is not compiled into the caller."""
        _call(  # pyright: ignore[reportCallIssue]
            numbers.ctypes.data,
            table.ctypes.data,
            rows.ctypes.data,
            rows.shape[1],
            start,
            count,
            gates,
            time,
            left,
            right,
            top,
            bottom,
        )


@compiled
def _words_at(numbers, x, y):
    """Place of the words of the tile that an array's centre is in; 0 if it has none."""
    column = (x - numbers[w.GRID_LEFT_MM]) * numbers[w.TILES_PER_MM]
    row = (y - numbers[w.GRID_TOP_MM]) * numbers[w.TILES_PER_MM]
    columns = int(numbers[w.GRID_COLUMNS])
    # Beyond the grid no actuator is on the canvas. NaN is nowhere, and has no whole number.
    if not (0.0 <= column < columns and 0.0 <= row < numbers[w.GRID_ROWS]):
        return 0
    start = int(numbers[w.GRID + int(row) * columns + int(column)])
    return 0 if int(numbers[start]) == w.END else start


@compiled
def _is_out_of_reach(numbers, at, gates, left, right, top, bottom):
    """Tell whether words only call patterns of which none is in a box or none is let through."""
    while True:
        word = int(numbers[at])
        at += 1
        operation, argument = word & (w.OPERATIONS - 1), word >> 6
        if operation == w.CALL or operation == w.CALL_PARTS:
            block = argument >> 6
            if not (
                gates & int(numbers[block + w.SHUT_BY]) != 0
                or numbers[block + w.BOX_RIGHT] < left
                or numbers[block + w.BOX_LEFT] > right
                or numbers[block + w.BOX_BOTTOM] < top
                or numbers[block + w.BOX_TOP] > bottom
            ):
                return False
            if operation == w.CALL_PARTS:
                at += 1 + int(numbers[at])
        elif operation == w.END:
            return True
        elif operation != w.DROP:
            return False


@compiled
def show(numbers, table, rows, at, out):
    """Fill a frame with the deflections of a scene at a pose and a time."""
    x, y = at[X] + numbers[w.ORIGIN_X], at[Y] + numbers[w.ORIGIN_Y]
    start = _words_at(numbers, x, y)
    if start == 0 or not _show_tile(numbers, table, rows, start, x, y, at, out):
        above, across = out.shape
        for i in range(above):
            for j in range(across):
                out[i, j] = 0.0


@compiled
def show_all(numbers, table, rows, at, out):
    """Fill a frame for each pose and time, of which each is a row of ``at``, in order of time.

    Signals are computed, too. They begin as when the picture is first shown, unless the first row
    has what they remember; without it the first number of that is NaN.
    """
    count, above, across = out.shape
    for n in range(count):
        if numbers[w.SIGNALS] != 0.0:
            if n:
                # A slice given to a slice would be compiled with all words of its refusal.
                for k in range(MEMORY, AT):
                    at[n, k] = at[n - 1, k]
                compute(numbers, at[n], max(at[n, TIME] - at[n - 1, TIME], 0.0))
            elif at[0, MEMORY] != at[0, MEMORY]:
                begin(numbers, at[0])
                compute(numbers, at[0], 0.0)
        x, y = at[n, X] + numbers[w.ORIGIN_X], at[n, Y] + numbers[w.ORIGIN_Y]
        start = _words_at(numbers, x, y)
        if start == 0 or not _show_tile(numbers, table, rows, start, x, y, at[n], out[n]):
            for i in range(above):
                for j in range(across):
                    out[n, i, j] = 0.0


@compiled
def _show_tile(numbers, table, rows, start, x, y, at, out):
    """Fill a frame by the words of a tile; False, and nothing is done, if nothing is in reach.

    The array's centre is at x, y on the canvas.
    """
    above, across = out.shape
    lanes = above * across
    cosine, sine = 1.0, 0.0
    theta = at[THETA]
    if theta != 0.0:
        cosine, sine = math.cos(theta), math.sin(theta)
    half_down = 0.5 * (above - 1) * numbers[w.ROW_MM]
    half_aside = 0.5 * (across - 1) * numbers[w.COLUMN_MM]
    wide = half_aside * abs(cosine) + half_down * abs(sine) + _ROUNDING_MM
    high = half_down * abs(cosine) + half_aside * abs(sine) + _ROUNDING_MM
    x0, x1, y0, y1 = x - wide, x + wide, y - high, y + high
    for n in range(MOST_SIGNALS):
        rows[w.GIVEN_ROW, n] = at[SIGNAL + n]
    rows[w.GIVEN_ROW, w.CENTER_X], rows[w.GIVEN_ROW, w.CENTER_Y] = x, y
    gates = shut_gates(numbers, rows[w.GIVEN_ROW])
    if _is_out_of_reach(numbers, start, gates, x0, x1, y0, y1):
        return False
    n = 0
    for i in range(above):
        down = (i - 0.5 * (above - 1)) * numbers[w.ROW_MM]
        for j in range(across):
            aside = (j - 0.5 * (across - 1)) * numbers[w.COLUMN_MM]
            rows[w.X_ROW, n] = x + aside * cosine + down * sine
            rows[w.Y_ROW, n] = y + down * cosine - aside * sine
            rows[w.SIGN_ROW, n] = 1.0 - 2.0 * ((i + j) & 1)
            n += 1
    run(numbers, table, rows, start, lanes, gates, at[TIME], x0, x1, y0, y1)
    left, right = numbers[w.LEFT_MM], numbers[w.RIGHT_MM]
    top, bottom = numbers[w.TOP_MM], numbers[w.BOTTOM_MM]
    if not (left <= x0 and x1 <= right and top <= y0 and y1 <= bottom):
        for n in range(lanes):
            px, py = rows[w.X_ROW, n], rows[w.Y_ROW, n]
            on = left <= px <= right and top <= py <= bottom
            rows[w.STACK, n] = rows[w.STACK, n] if on else 0.0
    n = 0
    for i in range(above):
        for j in range(across):
            value = rows[w.STACK, n]
            value = value if value > 0.0 else 0.0
            out[i, j] = value if value < 1.0 else 1.0
            n += 1
    return True


LANES = 512  # places whose rows stay in the processor's nearer caches


@compiled
def raster(numbers, table, rows, x_mm, y_mm, columns, lines, sign, noise, time, out):
    """Fill lines of a raster, whose places are runs in tiles.

    Parameters
    ----------
    numbers, table
        The program, with a grid for arrays that are points.
    rows : float64[SCRATCH_ROWS, LANES]
        Room to work in, with the values of the signals.
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
    gates = shut_gates(numbers, rows[w.GIVEN_ROW])
    run(numbers, table, rows, start, n, gates, time, x0, x1, y0, y1)


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
