"""Strokes, fills and dots of shapes, as kernels: Lévesque 2009, eqs. 8.7-8.14, 8.20 and 8.4.4.

``at`` is the first of a kernel's constants. Most begin with those of the profile, eq. 8.7: w/2 - ε,
1/ε, w/2, and then k_t and n/w of the texture across (k_t is 0 for none).
"""

import math

from vbraille.render.machine.shapekernels import (
    DOWN,
    END_BIAS,
    HALF_X,
    HALF_Y,
    LENGTH,
    RIGHT,
    START_Y,
)
from vbraille.render.machine.texturekernels import passed_s, phase
from vbraille.render.machine.words import (
    ACROSS_ROW,
    ALONG_ROW,
    FREE_ROW,
    INSIDE_ROW,
    MARKED_ROW,
    PART_ROW,
    SIGN_ROW,
    SPARE_ROW,
    X_ROW,
    Y_ROW,
)
from vbraille.render.waves import angle, compiled, fall, hump, wave

NO_VIBRATION, HIGH, LOW = 0.0, 1.0, 2.0
# Constants after those of the profile, of a stroke and of dots.
(
    AMPLITUDE,  # k
    OUTLINED,  # 1 if it is
    CUT,  # 0 without a texture along the stroke, 1 with one, 2 if it leaves the edges whole
    CYCLE,
    RIDGE,
    DEPTH,
    VELOCITY,
    SWING,  # what vibrates, and then the frequency and amplitude of that
    _SWING_HZ,
    _SWING_SHARE,
    CLOCK,  # signal by which a texture along the stroke moves; below 0 for time
    MARKS,  # 1 if there are markers, or dots on vertices, that vibrate in their own way; then how
    _MARKS_HZ,
    _MARKS_SHARE,
    STROKE_CUE,  # first of the numbers of a cue
) = range(5, 20)
# Numbers of a cue m: what is left of the stroke is 1 - its weight - what m hides, and what it shows
# is added.
(
    CUE_CYCLE,  # 0 for no cue
    CUE_RIDGE,
    CUE_VELOCITY,
    CUE_CLOCK,
    CUE_ROW,  # row of the places along the path
    CUE_WEIGHT,
    CUE_HIDES,  # 0 for nothing, 1 for m, 2 for as much of m as its vibration leaves
    CUE_SHOWS,
    _CUE_SWING,  # any number, and then the frequency and amplitude of the bands' vibration
    _CUE_HZ,
    _CUE_SHARE,
    CUE_NUMBERS,
) = range(12)
STROKE_NUMBERS = STROKE_CUE + CUE_NUMBERS
# A cue over a finished shape has first those of its profile, and then 1 over the distance beyond an
# end over which it fades, 0 for a path without ends.
CUE_FADE, OVER_CUE = 5, 6
# Numbers of a row of dots that moves along a segment, or around a circle, or of a dot that stays.
(
    ROW_X,  # start of the segment, or middle of the circle
    ROW_Y,
    ROW_RIGHT,
    ROW_DOWN,
    ROW_LENGTH,
    ROW_RADIUS,  # of a circle; 0 for a segment
    ROW_AT,  # place along the row where the segment begins
    ROW_PITCH,
    ROW_MOVES,  # 1 if it does, 0 for a dot that stays
    ROW_VERTEX,  # 1 for a dot on a vertex
    ROW_LOW,  # the dots of the row that are on this segment
    ROW_HIGH,
    ROW_BEGIN,  # place along the row where its window begins, and the row's direction there, as
    ROW_BEGIN_ALONG,  # seen from the segment
    ROW_BEGIN_ACROSS,
    ROW_END,
    ROW_END_ALONG,
    ROW_END_ACROSS,
    ROW_OPEN_BEGIN,  # 1 if dots are cut off beyond a round end there
    ROW_OPEN_END,
    ROW_NUMBERS,
) = range(21)
_FADES_PER_MM = 1.0  # of dots that come and go


@compiled
def profile(numbers, rows, at, top, count):
    """Profile at full amplitude, or the texture across where that is higher: the opacity mask."""
    _profile(numbers, rows, at, top, count)
    weight, cycles, edge = numbers[at + 3], numbers[at + 4], numbers[at + 2]
    if weight != 0.0:
        for n in range(count):
            r = rows[ACROSS_ROW, n]
            texture = 0.5 + 0.5 * wave(r * cycles)
            more = weight * (texture - rows[top, n])
            rows[top, n] += more if more > 0.0 and r < edge else 0.0


@compiled
def _profile(numbers, rows, at, top, count):
    flat, sharp = numbers[at], numbers[at + 1]
    for n in range(count):
        rows[top, n] = fall((rows[ACROSS_ROW, n] - flat) * sharp)


@compiled
def _groove(numbers, rows, at, row, factor, count):
    """Multiply a row by what an outline leaves out, γ_o of eq. 8.9, and a factor."""
    flat, sharp = numbers[at], numbers[at + 1]
    for n in range(count):
        rows[row, n] *= factor * fall((rows[ACROSS_ROW, n] - flat) * sharp + 1.0)


@compiled
def stroke(numbers, rows, at, time, top, count):
    """Deflection of a stroke, eqs. 8.7-8.14, at the coordinates of its shape."""
    _profile(numbers, rows, at, top, count)
    weight, cycles, edge = numbers[at + 3], numbers[at + 4], numbers[at + 2]
    if weight != 0.0:
        for n in range(count):
            r = rows[ACROSS_ROW, n]
            texture = 0.5 + 0.5 * wave(r * cycles)
            texture = texture if r < edge else 0.0
            rows[top, n] += weight * (texture - rows[top, n])
    amplitude = numbers[at + AMPLITUDE]
    if amplitude != 1.0:
        for n in range(count):
            rows[top, n] *= amplitude
    outlined, cut = numbers[at + OUTLINED], numbers[at + CUT]
    swing, marks = numbers[at + SWING], numbers[at + MARKS]
    cued = numbers[at + STROKE_CUE + CUE_CYCLE] != 0.0
    if outlined == 0.0 and cut == 0.0 and swing == NO_VIBRATION and marks == 0.0 and not cued:
        return
    if cut != 0.0:
        _cut(numbers, rows, at, time, count)
        if cut == 2.0:
            _groove(numbers, rows, at, FREE_ROW, 1.0, count)
    else:
        for n in range(count):
            rows[FREE_ROW, n] = outlined
        if outlined != 0.0:
            _groove(numbers, rows, at, FREE_ROW, 1.0, count)
    if swing == LOW:
        _share_left(numbers, rows, at + SWING, time, count)
        for n in range(count):
            rows[FREE_ROW, n] = 1.0 - rows[FREE_ROW, n] * rows[SPARE_ROW, n]
    elif swing == HIGH:
        _share_left(numbers, rows, at + SWING, time, count)
        for n in range(count):
            rows[FREE_ROW, n] = (1.0 - rows[FREE_ROW, n]) * rows[SPARE_ROW, n]
    else:
        for n in range(count):
            rows[FREE_ROW, n] = 1.0 - rows[FREE_ROW, n]
    if marks != 0.0:
        _share_left(numbers, rows, at + MARKS, time, count)
        for n in range(count):
            change = rows[SPARE_ROW, n] - rows[FREE_ROW, n]
            rows[FREE_ROW, n] += rows[MARKED_ROW, n] * change
    if cued:
        _bands(numbers, rows, at + STROKE_CUE, time, count)
        weight, hides = numbers[at + STROKE_CUE + CUE_WEIGHT], numbers[at + STROKE_CUE + CUE_HIDES]
        shows, swing, least = _cue_swing(numbers, at + STROKE_CUE, time)
        for n in range(count):
            band = rows[SPARE_ROW, n]
            left = least + swing * rows[SIGN_ROW, n]
            hidden = hides * band if hides < 2.0 else left * band
            rows[FREE_ROW, n] = rows[FREE_ROW, n] * (1.0 - weight - hidden) + shows * left * band
    for n in range(count):
        rows[top, n] *= rows[FREE_ROW, n]


@compiled
def _bands(numbers, rows, at, time, count):
    """Bands m of a cue along a path, whose numbers begin at ``at``: Lévesque 2009, fig. 9.3."""
    cycle, velocity = numbers[at + CUE_CYCLE], numbers[at + CUE_VELOCITY]
    shift = 0.0
    passed = passed_s(rows, numbers[at + CUE_CLOCK], time)
    if velocity != 0.0 and passed == passed:
        shift = velocity * passed / cycle
        shift = cycle * (shift - math.floor(shift))
    place, cycles, ridges = int(numbers[at + CUE_ROW]), 1.0 / cycle, 1.0 / numbers[at + CUE_RIDGE]
    for n in range(count):
        u = rows[place, n] - shift
        u -= cycle * math.floor(u * cycles)
        rows[SPARE_ROW, n] = hump(u * ridges - 0.5)


@compiled
def _cue_swing(numbers, at, time):
    """Tell what a cue shows, and by how much it swings about what its vibration leaves of it."""
    amplitude = numbers[at + _CUE_SHARE]
    swing = 0.5 * amplitude * phase(numbers[at + _CUE_HZ], time)
    return numbers[at + CUE_SHOWS], swing, 1.0 - 0.5 * amplitude


@compiled
def cue(numbers, rows, at, time, top, count):
    """Push what bands along a shape add to it, and then what they hide of it: 9.3.2."""
    flat, sharp, fades = numbers[at], numbers[at + 1], numbers[at + CUE_FADE]
    _bands(numbers, rows, at + OVER_CUE, time, count)
    hides = numbers[at + OVER_CUE + CUE_HIDES]
    shows, swing, least = _cue_swing(numbers, at + OVER_CUE, time)
    for n in range(count):
        band = rows[SPARE_ROW, n] * fall((rows[ACROSS_ROW, n] - flat) * sharp)
        if fades != 0.0 and band > 0.0:
            beyond = _beyond(numbers, int(rows[PART_ROW, n]), rows[X_ROW, n], rows[Y_ROW, n])
            rest = 1.0 - fades * beyond
            band *= rest if rest > 0.0 else 0.0
        left = least + swing * rows[SIGN_ROW, n]
        rows[top, n] = shows * left * band
        rows[top + 1, n] = hides * band if hides < 2.0 else left * band


@compiled
def _beyond(numbers, part, x, y):
    """Distance in a path's direction beyond its end, if the nearest segment is there; 0 else."""
    dx, dy = x - numbers[part], y - numbers[part + START_Y]
    u = dx * numbers[part + RIGHT] + dy * numbers[part + DOWN]
    if u < 0.0:
        is_open = numbers[part + HALF_X] == 0.0 and numbers[part + HALF_Y] == 0.0
        return -u if is_open else 0.0
    u -= numbers[part + LENGTH]
    return u if u > 0.0 and numbers[part + END_BIAS] < 0.0 else 0.0


@compiled
def _share_left(numbers, rows, at, time, count):
    """Tell what a vibration leaves: δ¹ of eq. 8.3; constants any, frequency, amplitude."""
    amplitude = numbers[at + 2]
    swing = 0.5 * amplitude * phase(numbers[at + 1], time)
    least = 1.0 - 0.5 * amplitude
    for n in range(count):
        rows[SPARE_ROW, n] = least + swing * rows[SIGN_ROW, n]


@compiled
def _cut(numbers, rows, at, time, count):
    """Depth of the cuts of a texture along a stroke: a · g(l)."""
    cycle, ridge = numbers[at + CYCLE], numbers[at + RIDGE]
    depth, velocity = numbers[at + DEPTH], numbers[at + VELOCITY]
    shift = 0.0
    passed = passed_s(rows, numbers[at + CLOCK], time)
    if velocity != 0.0 and passed == passed:
        shift = velocity * passed / cycle
        shift = cycle * (shift - math.floor(shift))
    cycles, ridges = 1.0 / cycle, 1.0 / ridge
    for n in range(count):
        u = rows[ALONG_ROW, n] - shift
        u -= cycle * math.floor(u * cycles)
        rows[FREE_ROW, n] = depth * hump(u * ridges - 0.5)


@compiled
def dots(numbers, rows, at, time, block, first, parts, top, count):
    """Dots, of which the highest counts: 8.4.4 and eq. 6.1.

    Numbers of a part: its middle, and 1 if it is on a vertex, where it vibrates as `MARKS` says.
    """
    weight, cycles = numbers[at + 3], numbers[at + 4]
    flat, sharp, edge = numbers[at], numbers[at + 1], numbers[at + 2]
    amplitude, swing, marks = numbers[at + AMPLITUDE], numbers[at + SWING], numbers[at + MARKS]
    for n in range(count):
        rows[top, n] = 0.0
    for number in range(parts):
        part = block + int(numbers[first + number])
        x, y = numbers[part], numbers[part + 1]
        on_vertex = numbers[part + 2] != 0.0 and marks != 0.0
        if weight == 0.0 and swing == NO_VIBRATION and not on_vertex:
            for n in range(count):
                dx, dy = rows[X_ROW, n] - x, rows[Y_ROW, n] - y
                value = fall((math.sqrt(dx * dx + dy * dy) - flat) * sharp)
                value *= amplitude
                rows[top, n] = value if value > rows[top, n] else rows[top, n]
            continue
        for n in range(count):
            dx, dy = rows[X_ROW, n] - x, rows[Y_ROW, n] - y
            r = math.sqrt(dx * dx + dy * dy)
            value = fall((r - flat) * sharp)
            texture = 0.5 + 0.5 * wave(r * cycles)
            texture = texture if r < edge else 0.0
            rows[FREE_ROW, n] = amplitude * (value + weight * (texture - value))
        if on_vertex or swing == HIGH:
            _share_left(numbers, rows, at + (MARKS if on_vertex else SWING), time, count)
            for n in range(count):
                rows[FREE_ROW, n] *= rows[SPARE_ROW, n]
        for n in range(count):
            value = rows[FREE_ROW, n]
            rows[top, n] = value if value > rows[top, n] else rows[top, n]


@compiled
def dots_mask(numbers, rows, at, block, first, parts, top, count):
    """Opacity mask of dots: the profile, or a texture across where that is higher."""
    weight, cycles = numbers[at + 3], numbers[at + 4]
    flat, sharp, edge = numbers[at], numbers[at + 1], numbers[at + 2]
    for n in range(count):
        rows[top, n] = 0.0
    for number in range(parts):
        part = block + int(numbers[first + number])
        x, y = numbers[part], numbers[part + 1]
        for n in range(count):
            dx, dy = rows[X_ROW, n] - x, rows[Y_ROW, n] - y
            r = math.sqrt(dx * dx + dy * dy)
            value = fall((r - flat) * sharp)
            if weight != 0.0:
                more = weight * (0.5 + 0.5 * wave(r * cycles) - value)
                value += more if more > 0.0 and r < edge else 0.0
            rows[top, n] = value if value > rows[top, n] else rows[top, n]


@compiled
def _nearest_dot(numbers, rows, part, moved, edge, count):
    """Find the distance r of the nearest dot of a row, and what its window leaves of it: 9.3.3.

    ``moved`` is how far the row has moved, and ``edge`` how far a dot reaches.
    """
    x, y, pitch = numbers[part + ROW_X], numbers[part + ROW_Y], numbers[part + ROW_PITCH]
    shift = numbers[part + ROW_MOVES] * moved / pitch
    shift = pitch * (shift - math.floor(shift))
    radius = numbers[part + ROW_RADIUS]
    if radius > 0.0:
        for n in range(count):
            dx, dy = rows[X_ROW, n] - x, rows[Y_ROW, n] - y
            along = radius * angle(dx, dy) - shift
            along -= pitch * math.floor(along / pitch + 0.5)
            away, half = math.sqrt(dx * dx + dy * dy), math.sin(0.5 * along / radius)
            across = away - radius
            r = math.sqrt(across * across + 4.0 * away * radius * half * half)
            rows[FREE_ROW, n], rows[SPARE_ROW, n] = r, 1.0
        return
    right, down = numbers[part + ROW_RIGHT], numbers[part + ROW_DOWN]
    start, length = numbers[part + ROW_AT], numbers[part + ROW_LENGTH]
    low, high = numbers[part + ROW_LOW], numbers[part + ROW_HIGH]
    begin, end = numbers[part + ROW_BEGIN], numbers[part + ROW_END]
    begin_along, begin_across = numbers[part + ROW_BEGIN_ALONG], numbers[part + ROW_BEGIN_ACROSS]
    end_along, end_across = numbers[part + ROW_END_ALONG], numbers[part + ROW_END_ACROSS]
    open_begin = numbers[part + ROW_OPEN_BEGIN] != 0.0
    open_end = numbers[part + ROW_OPEN_END] != 0.0
    for n in range(count):
        dx, dy = rows[X_ROW, n] - x, rows[Y_ROW, n] - y
        u, across = dx * right + dy * down, dy * right - dx * down
        along = start + u - shift
        along -= pitch * math.floor(along / pitch + 0.5)
        dot = start + u - along
        share = (dot + along * begin_along + across * begin_across - begin) * _FADES_PER_MM
        share = share if share > 0.0 else 0.0
        share = share if share < 1.0 else 1.0
        rest = (end - dot - along * end_along - across * end_across) * _FADES_PER_MM
        rest = rest if rest > 0.0 else 0.0
        rest = rest if rest < 1.0 else 1.0
        beyond = (-u if open_begin and u < 0.0 else 0.0) + (
            u - length if open_end and u > length else 0.0
        )
        seen = (low <= dot < high) & (
            (beyond == 0.0) | (beyond * beyond + across * across <= edge * edge)
        )
        rows[FREE_ROW, n] = math.sqrt(along * along + across * across)
        rows[SPARE_ROW, n] = share * rest if seen else 0.0


@compiled
def _moved_mm(numbers, rows, at, time):
    """Tell how far the dots of a shape have moved."""
    passed = passed_s(rows, numbers[at + CLOCK], time)
    return numbers[at + VELOCITY] * passed if passed == passed else 0.0


@compiled
def moving_dots(numbers, rows, at, time, block, first, parts, top, count):
    """Dots of which some move along a path, of which the highest counts: 9.3.3."""
    weight, cycles = numbers[at + 3], numbers[at + 4]
    flat, sharp, edge = numbers[at], numbers[at + 1], numbers[at + 2]
    amplitude, swing, marks = numbers[at + AMPLITUDE], numbers[at + SWING], numbers[at + MARKS]
    moved = _moved_mm(numbers, rows, at, time)
    for n in range(count):
        rows[top, n] = 0.0
    for number in range(parts):
        part = block + int(numbers[first + number])
        _nearest_dot(numbers, rows, part, moved, edge, count)
        for n in range(count):
            r = rows[FREE_ROW, n]
            value = fall((r - flat) * sharp)
            if weight != 0.0:
                texture = 0.5 + 0.5 * wave(r * cycles)
                value += weight * ((texture if r < edge else 0.0) - value)
            rows[FREE_ROW, n] = amplitude * value * rows[SPARE_ROW, n]
        on_vertex = numbers[part + ROW_VERTEX] != 0.0 and marks != 0.0
        if on_vertex or swing == HIGH:
            _share_left(numbers, rows, at + (MARKS if on_vertex else SWING), time, count)
            for n in range(count):
                rows[FREE_ROW, n] *= rows[SPARE_ROW, n]
        for n in range(count):
            value = rows[FREE_ROW, n]
            rows[top, n] = value if value > rows[top, n] else rows[top, n]


@compiled
def moving_dots_mask(numbers, rows, at, time, block, first, parts, top, count):
    """Opacity mask of dots of which some move."""
    weight, cycles = numbers[at + 3], numbers[at + 4]
    flat, sharp, edge = numbers[at], numbers[at + 1], numbers[at + 2]
    moved = _moved_mm(numbers, rows, at, time)
    for n in range(count):
        rows[top, n] = 0.0
    for number in range(parts):
        part = block + int(numbers[first + number])
        _nearest_dot(numbers, rows, part, moved, edge, count)
        for n in range(count):
            r = rows[FREE_ROW, n]
            value = fall((r - flat) * sharp)
            if weight != 0.0:
                more = weight * (0.5 + 0.5 * wave(r * cycles) - value)
                value += more if more > 0.0 and r < edge else 0.0
            value *= rows[SPARE_ROW, n]
            rows[top, n] = value if value > rows[top, n] else rows[top, n]


@compiled
def fill(numbers, rows, at, top, count):
    """Add a fill, in ``top - 1``, to the stroke in ``top``; the result is in ``top - 1``.

    Constants: distance from the path at which the fill begins, and 1 over that of its fade.
    """
    begin, slope = numbers[at], numbers[at + 1]
    for n in range(count):
        share = (rows[ACROSS_ROW, n] - begin) * slope
        share = share if share > 0.0 else 0.0
        share = share if share < 1.0 else 1.0
        value = rows[top, n] + share * rows[INSIDE_ROW, n] * rows[top - 1, n]
        rows[top - 1, n] = value if value < 1.0 else 1.0


@compiled
def fill_blended(rows, top, count):
    """Blend a stroke into a fill: fill, stroke, profile -> δ + (1 - profile) fill, eq. 8.20."""
    for n in range(count):
        share = (1.0 - rows[top + 1, n]) * rows[INSIDE_ROW, n]
        value = rows[top, n] + share * rows[top - 1, n]
        rows[top - 1, n] = value if value < 1.0 else 1.0


@compiled
def fill_mask(rows, top, count):
    """Raise the mask in ``top`` to 1 inside."""
    for n in range(count):
        within = rows[INSIDE_ROW, n]
        rows[top, n] = within if within > rows[top, n] else rows[top, n]
