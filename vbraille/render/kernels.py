"""The compiled inner loops, and nothing else.

They fill ``out`` and allocate nothing. `vbraille.render.renderer` packs what
they need into two arrays, since each further argument costs a call from Python;
`vbraille.render.reference` is the same in plain numpy.

``work`` is float64[3, n]: in its first row the parameters, in the others room
for the swing under each column of a block of positions, and for the slot each
column is over. A slot is one dot column of one cell: 2 (cell + 1) + (0 left, 1
right), with an empty cell before the line's first and one after its last.
``gains`` is float64[rows, slots]: how far each actuator row goes from its idle
end, and which way, when the swing of that slot is full.

The loops over a block are flat and without calls, so that they become vector
instructions: hence polynomials instead of the library's sine, good to 1e-14.
"""

import math

from numba import njit

from vbraille.caching import keep_compiled
from vbraille.render.work import (
    ANCHOR,
    CELL_PITCH,
    CELLS_PER_MM,
    COLUMN_PITCH,
    COLUMNS,
    DOT_SPACING,
    DOTS_PER_MM,
    IDLE,
    OVERLAP,
    PROFILE,
    SHAPE,
    SLOT,
    SWING,
)

_HALF_SINE = 0.0
_C = [(-1) ** n * math.pi ** (2 * n) / math.factorial(2 * n) for n in range(11)]
_C0, _C1, _C2, _C3, _C4, _C5, _C6, _C7, _C8, _C9, _C10 = _C
_S = [(-1) ** n * math.pi ** (2 * n + 1) / math.factorial(2 * n + 1) for n in range(10)]
_T0, _T1, _T2, _T3, _T4, _T5, _T6, _T7, _T8, _T9 = _S

_compiled = njit(cache=keep_compiled(), error_model="numpy", fastmath={"contract"})
_inlined = njit(inline="always", error_model="numpy", fastmath={"contract"})


@_inlined
def _cos_pi(q):
    """Cosine of π d, for q = d² ≤ 1/4."""
    high = _C5 + q * (_C6 + q * (_C7 + q * (_C8 + q * (_C9 + q * _C10))))
    return _C0 + q * (_C1 + q * (_C2 + q * (_C3 + q * (_C4 + q * high))))


@_inlined
def _sin_pi(d, q):
    """Sine of π d, for q = d² ≤ 1/4."""
    high = _T5 + q * (_T6 + q * (_T7 + q * (_T8 + q * _T9)))
    return d * (_T0 + q * (_T1 + q * (_T2 + q * (_T3 + q * (_T4 + q * high)))))


@_inlined
def _swings(work, count, cells, which):
    """Replace the places on the surface in ``work[SWING]`` by the swings there; fill the slots.

    ``which`` dot column of the cell: 0 left, 1 right, 2 the right one of the
    cell before, 3 the only one that can be there.
    """
    cells_per_mm = work[0, CELLS_PER_MM]
    pitch = work[0, CELL_PITCH]
    spacing = work[0, DOT_SPACING]
    dots_per_mm = work[0, DOTS_PER_MM]
    e0, e1, e2 = work[0, SHAPE], work[0, SHAPE + 1], work[0, SHAPE + 2]
    e3, e4, e5 = work[0, SHAPE + 3], work[0, SHAPE + 4], work[0, SHAPE + 5]
    half_sine = work[0, PROFILE] == _HALF_SINE
    before = 1.0 if which == 2 else 0.0
    is_right = 1.0 if which in (1, 2) else 0.0
    choose = which == 3
    for n in range(count):
        u = work[SWING, n]
        # Written so that a NaN, too, goes to the empty cell before the line.
        cell = u * cells_per_mm
        cell = cell if cell > -1.0 else -1.0
        cell = math.floor(cell if cell < cells else cells)
        t = u - cell * pitch
        right = (1.0 if t >= spacing else 0.0) if choose else is_right
        d = (t - spacing * right + pitch * before) * dots_per_mm - 0.5
        q = d * d
        q = q if q < 0.25 else 0.25
        sine = _cos_pi(q)  # sin(πu/W), u from the dot's left edge
        y = sine * sine
        if half_sine:
            # Lévesque 2009, 3.2, with sin 8θ = 8 sin θ cos θ (1 - 10y + 24y² - 16y³)
            d = d if d < 0.5 else 0.5
            d = d if d > -0.5 else -0.5
            cosine = -_sin_pi(d, q)
            value = sine * (e0 + e1 * cosine * (1.0 + y * (-10.0 + y * (24.0 - 16.0 * y))))
        else:
            # eqs. 4.1-4.3 on [0, 1]: c = cos πp, and cos kπp = T_k(c), which is odd
            c = 2.0 * y - 1.0
            z = c * c
            value = 0.5 + c * (e0 + z * (e1 + z * (e2 + z * (e3 + z * (e4 + z * e5)))))
        value = value if value > 0.0 else 0.0
        value = value if value < 1.0 else 1.0
        work[SWING, n] = value if q < 0.25 else 0.0
        slot = 2.0 * (cell + 1.0 - before) + right
        work[SLOT, n] = slot if slot > 0.0 else 0.0


@_inlined
def _places(work, x_mm, first, columns):
    """Where on the surface each column is (eq. 3.1: all sample one and the same)."""
    pitch = work[0, COLUMN_PITCH]
    left = x_mm - work[0, ANCHOR]
    for column in range(columns):
        work[SWING, first + column] = left + column * pitch


@_inlined
def _write(work, gains, first, out):
    rows, columns = out.shape
    for row in range(rows):
        idle = work[0, IDLE + row]
        for column in range(columns):
            slot = int(work[SLOT, first + column])
            out[row, column] = idle + gains[row, slot] * work[SWING, first + column]


@_inlined
def _write_larger(work, gains, first, out):
    """Of dots that overlap, the one with the larger swing."""
    rows, columns = out.shape
    for row in range(rows):
        idle = work[0, IDLE + row]
        for column in range(columns):
            slot = int(work[SLOT, first + column])
            swing = gains[row, slot] * work[SWING, first + column]
            if abs(swing) > abs(out[row, column] - idle):
                out[row, column] = idle + swing


@_compiled
def frame(work, gains, x_mm, out):
    """Fill one frame, float[rows, columns], for the array's anchor (its centre) at x."""
    rows, columns = out.shape
    # Compiled, nothing else would stop it from reading beyond the gains.
    if rows != gains.shape[0] or columns != work[0, COLUMNS]:
        raise ValueError("the frame has not the shape of the array")
    cells = gains.shape[1] // 2 - 2
    _places(work, x_mm, 0, columns)
    if work[0, OVERLAP] == 0.0:
        _swings(work, columns, cells, 3)
        _write(work, gains, 0, out)
        return
    _swings(work, columns, cells, 0)
    _write(work, gains, 0, out)
    for which in range(1, 3):
        _places(work, x_mm, 0, columns)
        _swings(work, columns, cells, which)
        _write_larger(work, gains, 0, out)


@_compiled
def path(work, gains, x_mm, out):
    """Fill a frame for each position of a path; out is float[n, rows, columns]."""
    columns = out.shape[2]
    cells = gains.shape[1] // 2 - 2
    if work[0, OVERLAP] != 0.0:
        for n in range(x_mm.size):
            frame(work, gains, x_mm[n], out[n])
        return
    block = work.shape[1] // columns
    for first in range(0, x_mm.size, block):
        count = min(block, x_mm.size - first)
        for n in range(count):
            _places(work, x_mm[first + n], n * columns, columns)
        _swings(work, count * columns, cells, 3)
        for n in range(count):
            _write(work, gains, n * columns, out[first + n])


@_compiled
def blend(before, after, share, out):
    """Fill ``out`` with (1 - share) · before + share · after, frames of one shape.

    Reckoned from the nearer end, so that both ends are exact and rounding never
    goes beyond them.
    """
    rows, columns = out.shape
    for row in range(rows):
        for column in range(columns):
            change = after[row, column] - before[row, column]
            if share < 0.5:
                out[row, column] = before[row, column] + share * change
            else:
                out[row, column] = after[row, column] - (1.0 - share) * change
