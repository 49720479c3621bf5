"""The machine that shows compiled scenes: `vbraille.render.machine.words` has what it can be told.

A pattern's words stand in a block of their own, wherever that lies in the program: their arguments
count from its beginning. The words of a tile call those patterns that its actuators can touch, and
put them together; their arguments count from the program's beginning.
"""

import math

import numpy as np

from vbraille.render.machine import shapekernels as shapes
from vbraille.render.machine import strokekernels as strokes
from vbraille.render.machine import texturekernels as textures
from vbraille.render.machine import words as w
from vbraille.render.machine.braillekernel import label, label_opacity
from vbraille.render.waves import compiled

# A number of a type, for what a plain 0 is given to would be compiled for it and for all others.
_NO_BLOCK = _NONE = np.int64(0)
_NO_PLACE = 1e9  # mm; a centre farther away is none


@compiled
def evaluate(numbers, table, rows, start, count, gates, time, left, right, top_mm, bottom_mm):
    """Compute the deflections at ``count`` places, which are in the rows X and Y, by words.

    The row of signs says which way each place swings, 1 or -1. Without a time, which is NaN then,
    it has noise from -1 to 1 that stands for vibrations. The row `GIVEN_ROW` has the signals, by
    which ``gates`` are shut. The deflections go to the row `STACK`. All places are in the box that
    is given last.
    """
    at = start
    block = _NO_BLOCK
    back, join = _NONE, _NONE
    first, parts = _NONE, _NONE
    # The row above the uppermost.
    top = w.STACK
    while True:
        word = int(numbers[at])
        at += 1
        operation, argument = word & (w.OPERATIONS - 1), word >> 6
        place = block + argument
        if operation == w.CALL or operation == w.CALL_PARTS:
            block, join = argument >> 6, argument & (w.JOINS - 1)
            if operation == w.CALL_PARTS:
                parts, first = int(numbers[at]), at + 1
                at = first + parts
            if (
                gates & int(numbers[block + w.SHUT_BY]) != 0
                or numbers[block + w.BOX_RIGHT] < left
                or numbers[block + w.BOX_LEFT] > right
                or numbers[block + w.BOX_BOTTOM] < top_mm
                or numbers[block + w.BOX_TOP] > bottom_mm
            ):
                # What cannot be touched changes nothing, or is nothing.
                block = _NO_BLOCK
                if join == w.PUSHED or join == w.PUSHED_PAIR:
                    _level(rows, top, 0.0, count)
                    top += 1
                    if join == w.PUSHED_PAIR:
                        _level(rows, top, 0.0, count)
                        top += 1
                elif join == w.MULTIPLY:
                    _level(rows, top - 1, 0.0, count)
            else:
                back, at = at, block + w.WORDS
        elif operation == w.RETURN:
            at, block = back, _NO_BLOCK
            top = _join(rows, top, join, count)
        elif w.ADD <= operation <= w.OVER_ITSELF:
            top = _join(rows, top, operation, count)
        elif operation == w.END:
            return
        elif operation == w.PARTS:
            parts, first = int(numbers[place]), place + 1
        elif operation == w.ZERO:
            _level(rows, top, 0.0, count)
            top += 1
        elif operation == w.LEVEL:
            _level(rows, top, numbers[place], count)
            top += 1
        elif operation == w.DROP:
            top -= 1
        elif operation == w.BLEND:
            top -= 2
            _blend(rows, top, count)
        elif operation == w.BLEND_FIRST:
            top -= 1
            _blend_first(rows, top, count)
        elif operation == w.SCALE:
            _scale(rows, top - 1, numbers[place], count)
        elif operation == w.INVERT:
            _invert(rows, top - 1, count)
        elif operation == w.VIBRATE_HIGH:
            textures.vibrate_high(numbers, rows, place, time, top - 1, count)
        elif operation == w.VIBRATE_LOW:
            textures.vibrate_low(numbers, rows, place, time, top - 1, count)
        elif operation == w.VIBRATION:
            textures.vibrate(numbers, rows, place, time, top, count)
            top += 1
        elif operation == w.LINEAR:
            textures.linear(numbers, rows, place, time, top, count)
            top += 1
        elif operation == w.RADIAL:
            textures.radial(numbers, rows, place, time, top, count)
            top += 1
        elif operation == w.AXIAL:
            textures.axial(numbers, rows, place, time, top, count)
            top += 1
        elif operation == w.IMAGE:
            textures.image(numbers, table, rows, place, top, count)
            top += 1
        elif operation == w.PIXELS:
            textures.pixels(numbers, table, rows, place, top, count)
            top += 1
        elif operation == w.LABEL:
            label(numbers, place, table, rows[w.X_ROW], rows[w.Y_ROW], count, rows[top])
            top += 1
        elif operation == w.LABEL_MASK:
            label_opacity(numbers, place, rows[w.X_ROW], rows[w.Y_ROW], count, rows[top])
            top += 1
        elif operation == w.DOTS:
            strokes.dots(numbers, rows, place, time, block, first, parts, top, count)
            top += 1
        elif operation == w.DOTS_MASK:
            strokes.dots_mask(numbers, rows, place, block, first, parts, top, count)
            top += 1
        elif operation == w.MOVING_DOTS:
            strokes.moving_dots(numbers, rows, place, time, block, first, parts, top, count)
            top += 1
        elif operation == w.MOVING_DOTS_MASK:
            strokes.moving_dots_mask(numbers, rows, place, time, block, first, parts, top, count)
            top += 1
        elif operation == w.CUE:
            strokes.cue(numbers, rows, place, time, top, count)
            top += 2
        elif operation == w.CIRCLE:
            shapes.circle(numbers, rows, place, count)
        elif operation == w.SEGMENTS:
            shapes.segments(numbers, rows, place, time, block, first, parts, count)
        elif operation == w.MARKERS:
            shapes.markers(numbers, rows, place, block, first, parts, count)
        elif operation == w.INSIDE:
            shapes.inside(numbers, rows, block, first, parts, count)
        elif operation == w.STROKE:
            strokes.stroke(numbers, rows, place, time, top, count)
            top += 1
        elif operation == w.PROFILE:
            strokes.profile(numbers, rows, place, top, count)
            top += 1
        elif operation == w.FILL:
            top -= 1
            strokes.fill(numbers, rows, place, top, count)
        elif operation == w.FILL_BLENDED:
            top -= 2
            strokes.fill_blended(rows, top, count)
        elif operation == w.FILL_MASK:
            strokes.fill_mask(rows, top - 1, count)
        elif operation == w.SIGNAL:
            _level(rows, top, rows[w.GIVEN_ROW, int(numbers[place])], count)
            top += 1
        elif operation == w.BY_SIGNAL:
            _scale(rows, top - 1, rows[w.GIVEN_ROW, int(numbers[place])], count)
        elif operation == w.GATE:
            if gates & int(numbers[place]) != 0:
                at += int(numbers[place + 1])
                for _ in range(int(numbers[place + 2])):
                    _level(rows, top, 0.0, count)
                    top += 1
        elif operation == w.SHIFT:
            _shift(numbers, rows, place, time, top, count)
            top += 2
        elif operation == w.WRAP:
            _wrap(numbers, rows, place, top, count)
            top += 2
        elif operation == w.UNWRAP:
            top -= 2
            _unwrap(rows, top, count)


@compiled
def _join(rows, top, word, count):
    """Put the uppermost row or pair together with the row below it; return the place above."""
    if word == w.ADD:
        top -= 1
        _add(rows, top, count)
    elif word == w.MAXIMUM:
        top -= 1
        _maximum(rows, top, count)
    elif word == w.MULTIPLY:
        top -= 1
        _multiply(rows, top, count)
    elif word == w.OVER:
        top -= 2
        _over(rows, top, top + 1, count)
    elif word == w.OVER_ITSELF:
        top -= 1
        _over(rows, top, top, count)
    return top


@compiled
def _level(rows, top, level, count):
    for n in range(count):
        rows[top, n] = level


@compiled
def _add(rows, top, count):
    for n in range(count):
        value = rows[top - 1, n] + rows[top, n]
        rows[top - 1, n] = value if value < 1.0 else 1.0


@compiled
def _maximum(rows, top, count):
    for n in range(count):
        value = rows[top, n]
        rows[top - 1, n] = value if value > rows[top - 1, n] else rows[top - 1, n]


@compiled
def _multiply(rows, top, count):
    for n in range(count):
        rows[top - 1, n] *= rows[top, n]


@compiled
def _over(rows, top, mask, count):
    """Lay what is in ``top`` on what is beneath it: Lévesque 2009, eq. 8.22."""
    for n in range(count):
        value = rows[top, n] + (1.0 - rows[mask, n]) * rows[top - 1, n]
        rows[top - 1, n] = value if value < 1.0 else 1.0


@compiled
def _blend(rows, top, count):
    """Blend two patterns, of which the second is in ``top``, by what is above: eq. 8.21."""
    for n in range(count):
        first = rows[top - 1, n]
        rows[top - 1, n] = first + rows[top + 1, n] * (rows[top, n] - first)


@compiled
def _blend_first(rows, top, count):
    for n in range(count):
        rows[top - 1, n] *= 1.0 - rows[top, n]


@compiled
def _scale(rows, top, factor, count):
    for n in range(count):
        rows[top, n] *= factor


@compiled
def _invert(rows, top, count):
    for n in range(count):
        rows[top, n] = 1.0 - rows[top, n]


@compiled
def _wrap(numbers, rows, at, top, count):
    """Keep the places in two rows and wrap them: constants origin, width and height of a tile."""
    x0, y0, width, height = numbers[at], numbers[at + 1], numbers[at + 2], numbers[at + 3]
    for n in range(count):
        x, y = rows[w.X_ROW, n], rows[w.Y_ROW, n]
        rows[top, n], rows[top + 1, n] = x, y
        x -= x0
        y -= y0
        x -= width * math.floor(x / width)
        y -= height * math.floor(y / height)
        # A quotient may be rounded up to the next tile.
        rows[w.X_ROW, n] = x if x >= 0.0 else x + width
        rows[w.Y_ROW, n] = y if y >= 0.0 else y + height


@compiled
def _shift(numbers, rows, at, time, top, count):
    """Keep the places in two rows and move them: constants velocity, clock, and a centre's place.

    Lévesque 2009, eq. 9.1: δ(p - vt). Where a centre is given, places are taken as if the array's
    centre stood there, so that what moves does so under the finger, not by the hand.
    """
    right = down = 0.0
    passed = textures.passed_s(rows, numbers[at + 2], time)
    if passed == passed:
        right, down = -numbers[at] * passed, -numbers[at + 1] * passed
    x, y = rows[w.GIVEN_ROW, w.CENTER_X], rows[w.GIVEN_ROW, w.CENTER_Y]
    if numbers[at + 3] < _NO_PLACE and x == x:
        right += numbers[at + 3] - x
        down += numbers[at + 4] - y
    for n in range(count):
        rows[top, n], rows[top + 1, n] = rows[w.X_ROW, n], rows[w.Y_ROW, n]
        rows[w.X_ROW, n] += right
        rows[w.Y_ROW, n] += down


@compiled
def _unwrap(rows, top, count):
    """Take the places back, from under what was pushed since."""
    for n in range(count):
        rows[w.X_ROW, n], rows[w.Y_ROW, n] = rows[top - 1, n], rows[top, n]
        rows[top - 1, n] = rows[top + 1, n]
