"""The evaluator of compiled scenes.

A scene is a list of instructions. First those are found that matter to any of the places that are
asked for; then each is done for all of them, on a stack of rows of deflections. An instruction is
its operation, the number of its numbers, how many rows it adds to the stack, and its constants.

The evaluator is large, and would be compiled anew into everything that makes frames: each kind of
tick, and each layout of frames. So it is compiled once, as a function of C, and those call it by
its name, as they call functions of the C library.
"""

import math

from llvmlite import binding
from numba import carray, cfunc, config, types  # pyright: ignore[reportPrivateImportUsage]

from vbraille.caching import keep_compiled
from vbraille.render.cellkernels import highest_dot, opacity
from vbraille.render.patternkernels import (
    axial,
    beyond,
    circle,
    crossed,
    dot_row,
    dots,
    grating,
    image,
    markers,
    moved,
    nearest,
    profile,
    rounded,
)
from vbraille.render.signalkernels import shut_gates
from vbraille.render.waves import compiled, phase, ridge, swung
from vbraille.render.work import (
    ACROSS_ROW,
    ALONG_ROW,
    BOTTOM_MM,
    CODE,
    GIVEN_ROW,
    INSIDE_ROW,
    LIVE_ROW,
    MOST_SIGNALS,
    PART_ROW,
    RIGHT_MM,
    SIGN_ROW,
    STACK_ROW,
    X_ROW,
    Y_ROW,
)

(
    END,
    GATE,  # skip instructions beyond a box, or where signals shut them
    LEVEL,
    SIGNAL_VALUE,
    INVERT,
    ADD,  # join the two uppermost values: their sum, at most 1
    MAXIMUM,
    MULTIPLY,
    OVER,  # r, δ, μ -> δ + (1 - μ) r, at most 1: Lévesque 2009, eq. 8.22
    OVER_ITSELF,  # the same where δ is its own mask
    BLEND,  # δ₁, δ₂, α -> (1 - α) δ₁ + α δ₂: eq. 8.21
    VIBRATE,  # δ -> δ δ¹: eq. 8.3
    LINEAR,
    RADIAL,
    AXIAL,
    IMAGE,
    LABEL,
    LABEL_MASK,
    DOTS,  # raise to dots whose look is at a place of the program
    DOT_ROW,
    CIRCLE,  # coordinates of a shape
    PATH,
    SEGMENTS,
    CROSSINGS,
    MEASURED,
    INSIDE,  # 1 inside from a distance on, after a fade
    PROFILE,
    BANDS,  # along the path, eq. 8.11
    MARKERS,
    BEYOND,
    CUE,  # bands -> what they show, what they hide: 9.3 and 9.3.2
    WRAP,  # wrap the places into a tile, until RESTORE
    SHIFT,  # move the places, until RESTORE
    RESTORE,
) = range(34)
# Values that an instruction adds to the stack, beyond those that it takes.
ADDED = (
    dict.fromkeys((ADD, MAXIMUM, MULTIPLY, OVER_ITSELF), -1)
    | dict.fromkeys((OVER, BLEND, RESTORE), -2)
    | dict.fromkeys((LEVEL, SIGNAL_VALUE, LINEAR, RADIAL, AXIAL, IMAGE, LABEL, LABEL_MASK), 1)
    | dict.fromkeys((INSIDE, PROFILE, BANDS, BEYOND, CUE), 1)
    | dict.fromkeys((WRAP, SHIFT), 2)
)
HEAD = 3  # numbers of an instruction before its constants
_FAR = 1e30
_NO_PLACE = 1e9  # mm; a centre farther away is none
_CENTER_X, _CENTER_Y = MOST_SIGNALS, MOST_SIGNALS + 1


@compiled
def _wrapped(own, x, y):
    """Place within a tile: constants origin, width and height."""
    x, y = x - own[0], y - own[1]
    x -= own[2] * math.floor(x / own[2])
    y -= own[3] * math.floor(y / own[3])
    # A quotient may be rounded up to the next tile.
    return x if x >= 0.0 else x + own[2], y if y >= 0.0 else y + own[3]


@compiled
def _shifted(own, given, time, x, y):
    """Place before a motion: constants velocity along x, clock, along y, clock, a centre's place.

    Lévesque 2009, eq. 9.1: δ(p - vt). Where a centre is given, places are taken as if the array's
    centre stood there, so that what moves does so under the finger, not by the hand.
    """
    x -= moved(own, given, time)
    y -= moved(own[2:], given, time)
    if own[4] < _NO_PLACE and given[_CENTER_X] == given[_CENTER_X]:
        x += own[4] - given[_CENTER_X]
        y += own[5] - given[_CENTER_Y]
    return x, y


@compiled
def _find_live(numbers, rows, count):
    """List the places of the instructions that matter to any place, and return how many."""
    left, top, right, bottom = _FAR, _FAR, -_FAR, -_FAR
    for n in range(count):
        x, y = rows[X_ROW, n], rows[Y_ROW, n]
        left, right = min(left, x), max(right, x)
        top, bottom = min(top, y), max(bottom, y)
    # Written so that NaN is nowhere.
    if not (left <= numbers[RIGHT_MM] and right >= 0.0):
        return 0
    if not (top <= numbers[BOTTOM_MM] and bottom >= 0.0):
        return 0
    gates = shut_gates(numbers, rows[GIVEN_ROW])
    width = rows.shape[1]
    here, found, depth = CODE, 0, 0
    while numbers[here] != END:
        operation, own = int(numbers[here]), numbers[here + HEAD :]
        if operation == GATE:
            # Without branches, which could not be foreseen.
            aside = (own[0] > right) | (own[2] < left)
            beside = aside | (own[1] > bottom) | (own[3] < top)
            # In a tile, or in what moves, places are elsewhere.
            if (beside and depth == 0) or gates & int(own[4]) != 0:
                here = int(own[5])
                continue
        else:
            rows[LIVE_ROW + found // width, found % width] = here
            found += 1
        depth += (operation in (WRAP, SHIFT)) - (operation == RESTORE)
        here += int(numbers[here + 1])
    return found


@compiled
def _evaluate(numbers, table, rows, count, time):
    """Compute the deflections at ``count`` places, which are in the rows X and Y, on the stack.

    The row of signs says which way each place swings, 1 or -1. Without a time, which is NaN then,
    it has noise from -1 to 1 that stands for vibrations. The row `GIVEN_ROW` has the signals.
    """
    x, y, sign = rows[X_ROW], rows[Y_ROW], rows[SIGN_ROW]
    across, along, inside = rows[ACROSS_ROW], rows[ALONG_ROW], rows[INSIDE_ROW]
    part, given = rows[PART_ROW], rows[GIVEN_ROW]
    width, above = rows.shape[1], STACK_ROW  # the row above the uppermost value
    for k in range(_find_live(numbers, rows, count)):
        here = int(rows[LIVE_ROW + k // width, k % width])
        operation, end = int(numbers[here]), here + int(numbers[here + 1])
        own = numbers[here + HEAD :]
        new, first, second, third = rows[above], rows[above - 1], rows[above - 2], rows[above - 3]
        above += int(numbers[here + 2])
        if operation in (LEVEL, SIGNAL_VALUE):
            level = own[0] if operation == LEVEL else given[int(own[0])]
            for n in range(count):
                new[n] = level
        elif operation == INVERT:
            for n in range(count):
                first[n] = 1.0 - first[n]
        elif operation == ADD:
            for n in range(count):
                second[n] = min(second[n] + first[n], 1.0)
        elif operation == MAXIMUM:
            for n in range(count):
                second[n] = max(second[n], first[n])
        elif operation == MULTIPLY:
            for n in range(count):
                second[n] *= first[n]
        elif operation == OVER:
            for n in range(count):
                third[n] = min(second[n] + (1.0 - first[n]) * third[n], 1.0)
        elif operation == OVER_ITSELF:
            for n in range(count):
                second[n] = min(first[n] + (1.0 - first[n]) * second[n], 1.0)
        elif operation == BLEND:
            for n in range(count):
                third[n] += first[n] * (second[n] - third[n])
        elif operation == VIBRATE:
            amplitude, swing = own[1], phase(own[0], time)
            for n in range(count):
                first[n] *= swung(amplitude, swing * sign[n])
        elif operation == LINEAR:
            right_share, down_share, start = own[8], own[9], own[10]
            for n in range(count):
                new[n] = x[n] * right_share + y[n] * down_share - start
            grating(own, new, count, given, time)
        elif operation == RADIAL:
            for n in range(count):
                new[n] = math.sqrt((x[n] - own[8]) ** 2 + (y[n] - own[9]) ** 2)
            grating(own, new, count, given, time)
        elif operation == AXIAL:
            axial(own, x, y, new, count, given, time)
        elif operation == IMAGE:
            for n in range(count):
                new[n] = image(own, table, x[n], y[n])
        elif operation == LABEL:
            for n in range(count):
                new[n] = highest_dot(own, table, x[n], y[n])
        elif operation == LABEL_MASK:
            for n in range(count):
                new[n] = opacity(own, x[n], y[n])
        elif operation == DOTS:
            look, begin = numbers[int(own[0]) :], here + HEAD + 1
            for n in range(count):
                first[n] = dots(look, numbers, begin, end, x[n], y[n], sign[n], time, first[n])
        elif operation == DOT_ROW:
            look, row = numbers[int(own[0]) :], own[1:]
            for n in range(count):
                first[n] = dot_row(look, row, x[n], y[n], sign[n], given, time, first[n])
        elif operation == CIRCLE:
            circle(own, x, y, across, along, inside, count)
        elif operation == PATH:
            for n in range(count):
                across[n], along[n], inside[n], part[n] = _FAR, 0.0, 0.0, own[0]
        elif operation == SEGMENTS:
            begin, size = here + HEAD + 1, int(own[0])
            nearest(numbers, begin, end, size, x, y, across, along, part, count)
        elif operation == CROSSINGS:
            begin, size = int(own[0]), int(own[2])
            crossed(numbers, begin, int(own[1]), size, x, y, inside, count)
        elif operation == MEASURED:
            for n in range(count):
                across[n] = math.sqrt(across[n])
            if own[0] != 0.0:
                for n in range(count):
                    along[n] = rounded(numbers[int(part[n]) :], x[n], y[n], along[n])
        elif operation == INSIDE:
            begins, slope = own[0], own[1]
            for n in range(count):
                new[n] = min(max((across[n] - begins) * slope, 0.0), 1.0) * inside[n]
        elif operation == PROFILE:
            profile(own, across, new, count)
        elif operation == BANDS:
            cycle, length, height, shift = own[2], own[3], own[4], moved(own, given, time)
            if own[5] == 0.0:
                for n in range(count):
                    new[n] = height * ridge(along[n] - shift, cycle, length)
            else:  # each contour has a cycle of its own
                for n in range(count):
                    segment = numbers[int(part[n]) :]
                    new[n] = height * ridge(along[n] - shift, segment[14], segment[13])
        elif operation == MARKERS:
            for n in range(count):
                number = int(numbers[int(part[n]) + 12])
                first[n] = markers(own, x[n], y[n], sign[n], time, number, first[n])
        elif operation == BEYOND:
            for n in range(count):
                new[n] = beyond(numbers[int(part[n]) :], x[n], y[n], own[0])
        elif operation == CUE:
            # What of the bands is added, and what they hide: nothing for 0, the bands for 1, or as
            # much of them as their vibration leaves for 2.
            swing = phase(own[2], time)
            for n in range(count):
                left_over = swung(own[3], swing * sign[n]) * first[n]
                new[n] = own[1] * first[n] if own[1] < 2.0 else left_over
                first[n] = own[0] * left_over
        elif operation in (WRAP, SHIFT):
            newer = rows[above - 1]
            for n in range(count):
                new[n], newer[n] = x[n], y[n]
                if operation == WRAP:
                    x[n], y[n] = _wrapped(own, x[n], y[n])
                else:
                    x[n], y[n] = _shifted(own, given, time, x[n], y[n])
        elif operation == RESTORE:
            for n in range(count):
                x[n], y[n], third[n] = third[n], second[n], first[n]


_NAME = "vbraille_evaluate_scene"
_ANY = 1 << 40
_POINTERS = types.CPointer(types.float64), types.CPointer(types.uint16)
_SIGNATURE = types.void(*_POINTERS, _POINTERS[0], types.int64, types.int64, types.float64)


def _evaluate_plainly(numbers, table, rows, width, count, time):
    # The evaluator stays within the program that was compiled; how long that is it does not ask.
    numbers, table = carray(numbers, (_ANY,)), carray(table, (_ANY,))
    _evaluate(numbers, table, carray(rows, (LIVE_ROW, width)), count, time)


if config.DISABLE_JIT:  # pyright: ignore[reportAttributeAccessIssue]
    evaluate = _evaluate  # pyright: ignore[reportAssignmentType]
else:
    # Kept as long as the process, for compiled code calls it by its address.
    _function = cfunc(_SIGNATURE, cache=keep_compiled(), error_model="numpy", nogil=True)(
        _evaluate_plainly
    )
    binding.add_symbol(_NAME, _function.address)
    _call = types.ExternalFunction(_NAME, _SIGNATURE)

    @compiled
    def evaluate(numbers, table, rows, count, time):
        """Do as `_evaluate` does, which is not compiled into the caller."""
        _call(numbers.ctypes, table.ctypes, rows.ctypes, rows.shape[1], count, time)


@compiled
def show(numbers, table, rows, time, out):
    """Fill lines of deflections of a scene, at the places that are in the rows X and Y.

    The row of signs, and that of the values of signals, are filled in, too.
    """
    lines, columns = out.shape
    evaluate(numbers, table, rows, lines * columns, time)
    right_mm, bottom_mm = numbers[RIGHT_MM], numbers[BOTTOM_MM]
    n = 0
    for line in range(lines):
        for column in range(columns):
            on_canvas = 0.0 <= rows[X_ROW, n] <= right_mm and 0.0 <= rows[Y_ROW, n] <= bottom_mm
            out[line, column] = min(max(rows[STACK_ROW, n], 0.0), 1.0) if on_canvas else 0.0
            n += 1
