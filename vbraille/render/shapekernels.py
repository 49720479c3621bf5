"""Coordinates of shapes, and their strokes, dots and fills, as kernels: Lévesque 2009, 8.4.3-8.4.4.

A shape gives every place its distance across the path and along it, and whether it is inside.
``at`` is the first of an instruction's constants.
"""

import math

from vbraille.render.instructions import (
    ACROSS,
    ACROSS_ROW,
    ALONG_ROW,
    ARC_HALF,
    ARC_RADIUS,
    BEGIN,
    CORNER,
    CORNER_NUMBERS,
    CYCLE,
    DOT_ROW,
    DOWN,
    END_BIAS,
    END_HALF_X,
    END_HALF_Y,
    END_Y,
    FREE_ROW,
    HALF_X,
    HALF_Y,
    INDEX,
    INSIDE_ROW,
    INWARD_X,
    INWARD_Y,
    LENGTH,
    MIDDLE,
    ONWARD_X,
    ONWARD_Y,
    PART_ROW,
    PIVOT_X,
    PIVOT_Y,
    PLACE_ROW,
    REACH,
    RIDGE,
    RIGHT,
    ROUNDED,
    ROW_AT,
    ROW_BEGIN,
    ROW_BEGIN_ACROSS,
    ROW_BEGIN_ALONG,
    ROW_DOWN,
    ROW_END,
    ROW_END_ACROSS,
    ROW_END_ALONG,
    ROW_HIGH,
    ROW_LENGTH,
    ROW_LOW,
    ROW_MOVES,
    ROW_NUMBERS,
    ROW_OPEN_BEGIN,
    ROW_OPEN_END,
    ROW_PITCH,
    ROW_RADIUS,
    ROW_RIGHT,
    ROW_VERTEX,
    ROW_X,
    ROW_Y,
    SIGN_ROW,
    SPARE_ROW,
    START_Y,
    VELOCITY,
    X_ROW,
    Y_ROW,
)
from vbraille.render.texturekernels import passed_s, phase
from vbraille.render.waves import angle, compiled, fall, hump, wave

_FAR = 1e12  # mm²
_TURN = 2 * math.pi
_FADES_PER_MM = 1.0  # of dots that come and go


@compiled
def circle(numbers, rows, at, count):
    """Coordinates of a circle, eqs. 8.18 and 8.19: constants centre, radius, 1 if along counts."""
    x, y, radius = numbers[at], numbers[at + 1], numbers[at + 2]
    for n in range(count):
        dx, dy = rows[X_ROW, n] - x, rows[Y_ROW, n] - y
        distance = math.sqrt(dx * dx + dy * dy)
        rows[ACROSS_ROW, n] = abs(distance - radius)
        rows[INSIDE_ROW, n] = 1.0 if distance < radius else 0.0
    if numbers[at + 3] != 0.0:
        for n in range(count):
            turn = angle(rows[X_ROW, n] - x, rows[Y_ROW, n] - y)
            rows[ALONG_ROW, n] = radius * (turn if turn >= 0.0 else turn + _TURN)


@compiled
def path(numbers, rows, at, time, count, left, top, right, bottom):
    """Coordinates of lines through places, eqs. 8.15-8.17.

    Constants: which coordinates are wanted, 1 if inside counts, the distance beyond which nothing
    of the shape is felt, a clock, the number of chunks, and for each chunk its box, how many
    segments it has, and their numbers. All places are in the box that is given.
    """
    size, filled, reach = int(numbers[at]), numbers[at + 1] != 0.0, numbers[at + 2]
    time = passed_s(rows, numbers[at + 3], time)
    chunks = int(numbers[at + 4])
    at += 5
    first = float(at + 5)
    for n in range(count):
        rows[ACROSS_ROW, n], rows[INSIDE_ROW, n] = _FAR, 0.0
        rows[FREE_ROW, n], rows[ALONG_ROW, n], rows[PART_ROW, n] = 0.0, 0.0, first
    for _ in range(chunks):
        parts = int(numbers[at + 4])
        is_level = numbers[at + 1] <= bottom and numbers[at + 3] >= top
        near = (
            numbers[at] <= right + reach
            and numbers[at + 2] >= left - reach
            and numbers[at + 1] <= bottom + reach
            and numbers[at + 3] >= top - reach
        )
        crossed = filled and is_level and numbers[at + 2] >= left
        at += 5
        if near or crossed:
            for part in range(at, at + parts * size, size):
                if near and size == ACROSS:
                    _distance(numbers, rows, part, count)
                elif near:
                    _distance_along(numbers, rows, part, count)
                if crossed:
                    _cross(numbers, rows, part, count)
        at += parts * size
    for n in range(count):
        rows[ACROSS_ROW, n] = math.sqrt(rows[ACROSS_ROW, n])
    if size == ROUNDED:
        for n in range(count):
            part = int(rows[PART_ROW, n])
            place = _along(numbers, part, rows[FREE_ROW, n], rows[X_ROW, n], rows[Y_ROW, n])
            rows[PLACE_ROW, n] = place
            rows[ALONG_ROW, n] = _in_ridge(numbers, part, place, time)


@compiled
def _distance(numbers, rows, part, count):
    """Lower the squared distance to that of a segment."""
    x, y, length = numbers[part], numbers[part + START_Y], numbers[part + LENGTH]
    right, down = numbers[part + RIGHT], numbers[part + DOWN]
    for n in range(count):
        dx, dy = rows[X_ROW, n] - x, rows[Y_ROW, n] - y
        u = dx * right + dy * down
        u = u if u > 0.0 else 0.0
        u = u if u < length else length
        dx -= u * right
        dy -= u * down
        q = dx * dx + dy * dy
        rows[ACROSS_ROW, n] = q if q < rows[ACROSS_ROW, n] else rows[ACROSS_ROW, n]


@compiled
def _distance_along(numbers, rows, part, count):
    """Lower the squared distance to that of a segment, and keep the place along the nearest."""
    x, y, length = numbers[part], numbers[part + START_Y], numbers[part + LENGTH]
    right, down = numbers[part + RIGHT], numbers[part + DOWN]
    half_x, half_y = numbers[part + HALF_X], numbers[part + HALF_Y]
    end_half_x, end_half_y = numbers[part + END_HALF_X], numbers[part + END_HALF_Y]
    bias, begin = numbers[part + END_BIAS], numbers[part + BEGIN]
    end_x, end_y = x + length * right, y + length * down
    for n in range(count):
        px, py = rows[X_ROW, n], rows[Y_ROW, n]
        dx, dy = px - x, py - y
        u = dx * right + dy * down
        v = u if u > 0.0 else 0.0
        v = v if v < length else length
        # Beyond a corner two segments are equally near; its bisector decides.
        before = dx * half_x + dy * half_y < 0.0
        after = (px - end_x) * end_half_x + (py - end_y) * end_half_y + bias >= 0.0
        dx -= v * right
        dy -= v * down
        q = dx * dx + dy * dy
        other = ((u <= 0.0) & before) | ((u >= length) & after)
        nearer = (q < rows[ACROSS_ROW, n]) & (other == False)  # noqa: E712
        rows[ACROSS_ROW, n] = q if nearer else rows[ACROSS_ROW, n]
        rows[FREE_ROW, n] = u if nearer else rows[FREE_ROW, n]
        rows[PART_ROW, n] = float(part) if nearer else rows[PART_ROW, n]
        rows[ALONG_ROW, n] = begin + u if nearer else rows[ALONG_ROW, n]


@compiled
def _cross(numbers, rows, part, count):
    """Turn inside to outside where a line to the right meets a segment: the even-odd rule."""
    x, y, end = numbers[part], numbers[part + START_Y], numbers[part + END_Y]
    if y == end:
        return
    slope = numbers[part + RIGHT] / numbers[part + DOWN]
    for n in range(count):
        py = rows[Y_ROW, n]
        hit = ((y > py) != (end > py)) & (rows[X_ROW, n] < x + (py - y) * slope)
        was = rows[INSIDE_ROW, n]
        rows[INSIDE_ROW, n] = 1.0 - was if hit else was


@compiled
def _along(numbers, part, u, x, y):
    """Place along a path, from that along its nearest segment.

    Near a corner that is rounded it follows an arc: fig. 8.18.
    """
    first, last = part + CORNER, part + CORNER + CORNER_NUMBERS
    if u < numbers[first + REACH]:
        return _round(numbers, first, x, y)
    if u > numbers[part + LENGTH] - numbers[last + REACH]:
        return _round(numbers, last, x, y)
    return numbers[part + BEGIN] + u


@compiled
def _round(numbers, corner, x, y):
    dx, dy = x - numbers[corner + PIVOT_X], y - numbers[corner + PIVOT_Y]
    onward = dx * numbers[corner + ONWARD_X] + dy * numbers[corner + ONWARD_Y]
    outward = -(dx * numbers[corner + INWARD_X] + dy * numbers[corner + INWARD_Y])
    half = numbers[corner + ARC_HALF]
    turn = min(max(math.atan2(onward, outward), -half), half)
    return numbers[corner + MIDDLE] + numbers[corner + ARC_RADIUS] * turn


@compiled
def _in_ridge(numbers, part, place, time):
    """Place within the stroke's ridge, if it is in one, where contours have their own cycles."""
    ridge = numbers[part + RIDGE]
    if ridge == 0.0:
        return place
    cycle, velocity = numbers[part + CYCLE], numbers[part + VELOCITY]
    turns = (place - velocity * time) / cycle if time == time else place / cycle
    turns -= math.floor(turns)
    share = turns * cycle / ridge
    return share if share < 1.0 else 1.0


@compiled
def profile(numbers, rows, at, source, top, count):
    """Profile of a stroke or a dot, eq. 8.7, with a texture across it, eq. 8.10.

    Constants: w/2 - ε, 1/ε, w/2, weight and cycles a mm of the texture (0 for none), and 1 for an
    opacity mask, in which the texture counts only where it is higher. ``source`` is the row of
    distances.
    """
    flat, sharp, edge = numbers[at], numbers[at + 1], numbers[at + 2]
    weight, cycles, is_mask = numbers[at + 3], numbers[at + 4], numbers[at + 5] != 0.0
    for n in range(count):
        rows[top, n] = fall((rows[source, n] - flat) * sharp)
    if weight == 0.0:
        return
    for n in range(count):
        r = rows[source, n]
        texture = 0.5 + 0.5 * wave(r * cycles)
        more = weight * ((texture if r < edge else 0.0) - rows[top, n])
        keeps = is_mask and not (more > 0.0 and r < edge)
        rows[top, n] += 0.0 if keeps else more


@compiled
def groove(numbers, rows, at, top, count):
    """Multiply a row by what an outline leaves out, γ_o of eq. 8.9: constants of a profile."""
    flat, sharp = numbers[at], numbers[at + 1]
    for n in range(count):
        rows[top, n] *= fall((rows[ACROSS_ROW, n] - flat) * sharp + 1.0)


@compiled
def bands(numbers, rows, at, time, top, count):
    """Ridges along a path, eq. 8.11: constants row, cycle, ridge, height, velocity, clock."""
    place, cycle, ridge = int(numbers[at]), numbers[at + 1], numbers[at + 2]
    height, velocity = numbers[at + 3], numbers[at + 4]
    shift = 0.0
    passed = passed_s(rows, numbers[at + 5], time)
    if velocity != 0.0 and passed == passed:
        shift = velocity * passed / cycle
        shift = cycle * (shift - math.floor(shift))
    cycles, ridges = 1.0 / cycle, 1.0 / ridge
    for n in range(count):
        u = rows[place, n] - shift
        u -= cycle * math.floor(u * cycles)
        rows[top, n] = height * hump(u * ridges - 0.5)


@compiled
def beyond(numbers, rows, at, top, count):
    """Fade beyond the ends of an open path: constant 1 over the distance of the fade."""
    fades = numbers[at]
    for n in range(count):
        part = int(rows[PART_ROW, n])
        dx, dy = rows[X_ROW, n] - numbers[part], rows[Y_ROW, n] - numbers[part + START_Y]
        u = dx * numbers[part + RIGHT] + dy * numbers[part + DOWN]
        v = u - numbers[part + LENGTH]
        away = 0.0
        if u < 0.0 and numbers[part + HALF_X] == 0.0 and numbers[part + HALF_Y] == 0.0:
            away = -u
        elif v > 0.0 and numbers[part + END_BIAS] < 0.0:
            away = v
        share = 1.0 - fades * away
        rows[top, n] = share if share > 0.0 else 0.0


@compiled
def cue(numbers, rows, at, time, top, count):
    """Make a pair of bands: what they add, and what they hide, 9.3 and 9.3.2.

    Constants: factor of what is added; 0 to hide nothing, 1 to hide the band, 2 to hide as much of
    it as its vibration leaves; frequency and amplitude of the vibration.
    """
    shows, hides, amplitude = numbers[at], numbers[at + 1], numbers[at + 3]
    swing = 0.5 * amplitude * phase(numbers[at + 2], time)
    least = 1.0 - 0.5 * amplitude
    for n in range(count):
        band = rows[top, n]
        left = least + swing * rows[SIGN_ROW, n]
        rows[top, n] = shows * left * band
        rows[top + 1, n] = hides * band if hides < 2.0 else left * band


@compiled
def markers(numbers, rows, at, time, top, count):
    """Blend a stroke's texture into markers at the vertices of a polygon: figs. 8.19 and 8.20.

    Constants: half of the stroke's width, 1 over the distance of the blend, frequency and amplitude
    of their vibration, the number of corners, and for each of these its place and its marker's
    pivot, directions onward and inward, sine, cosine and how far it is pushed. A place is asked for
    the nearest corner alone, and only if one of its two segments is the nearest, too.
    """
    half, slope, amplitude = numbers[at], numbers[at + 1], numbers[at + 3]
    swing = 0.5 * amplitude * phase(numbers[at + 2], time)
    corners, first, size = int(numbers[at + 4]), at + 5, 11
    for n in range(count):
        x, y = rows[X_ROW, n], rows[Y_ROW, n]
        if not rows[ACROSS_ROW, n] < half:
            continue
        nearest, least = 0, _FAR
        for number in range(corners):
            corner = first + number * size
            dx, dy = x - numbers[corner], y - numbers[corner + 1]
            q = dx * dx + dy * dy
            if q < least:
                nearest, least = number, q
        own = int(numbers[int(rows[PART_ROW, n]) + INDEX])
        if own not in (nearest, (nearest + corners - 1) % corners):
            continue
        corner = first + nearest * size
        dx, dy = x - numbers[corner + 2], y - numbers[corner + 3]
        onward = dx * numbers[corner + 4] + dy * numbers[corner + 5]
        outward = -(dx * numbers[corner + 6] + dy * numbers[corner + 7])
        within = numbers[corner + 8] * outward - numbers[corner + 9] * abs(onward)
        share = min(max((within + numbers[corner + 10]) * slope, 0.0), 1.0)
        left = 1.0 - 0.5 * amplitude + swing * rows[SIGN_ROW, n]
        rows[top, n] += share * (left - rows[top, n])


@compiled
def dots(numbers, rows, at, time, top, count, left, above, right, below):
    """Dots, of which the highest counts: 8.4.4, 9.3.3 and eq. 6.1.

    Constants: those of the profile, amplitude, 1 if they move, velocity, clock, frequency and
    amplitude of their vibration, the same of dots on vertices (an amplitude below 0 for none of
    their own). Then the number of chunks, each with its box, how many dots it has, and place and 1
    for a vertex of each dot; or of rows that move, of which each is a chunk.
    """
    is_mask = numbers[at + 5] != 0.0
    reach, amplitude, moves = numbers[at + 2], numbers[at + 6], numbers[at + 7] != 0.0
    passed = passed_s(rows, numbers[at + 9], time)
    moved = numbers[at + 8] * passed if passed == passed else 0.0
    parts, part = int(numbers[at + 14]), at + 15
    for n in range(count):
        rows[top, n] = 0.0
        rows[SPARE_ROW, n] = 1.0
    for _ in range(parts):
        if moves:
            _nearest_dot(numbers, rows, part, moved, reach, count)
            vertex = numbers[part + ROW_VERTEX] != 0.0
            _raise_to_dot(numbers, rows, at, amplitude, vertex, is_mask, time, top, count)
            part += ROW_NUMBERS
            continue
        size = int(numbers[part + 4])
        far = numbers[part] - reach > right or numbers[part + 2] + reach < left
        far = far or numbers[part + 1] - reach > below or numbers[part + 3] + reach < above
        part += 5
        if not far:
            for dot in range(part, part + 3 * size, 3):
                x, y = numbers[dot], numbers[dot + 1]
                if x - reach > right or x + reach < left or y - reach > below or y + reach < above:
                    continue
                for n in range(count):
                    dx, dy = rows[X_ROW, n] - x, rows[Y_ROW, n] - y
                    rows[FREE_ROW, n] = math.sqrt(dx * dx + dy * dy)
                vertex = numbers[dot + 2] != 0.0
                _raise_to_dot(numbers, rows, at, amplitude, vertex, is_mask, time, top, count)
        part += 3 * size


@compiled
def _raise_to_dot(numbers, rows, at, amplitude, vertex, is_mask, time, top, count):
    """Raise a row to a dot whose distances are in the row FREE, and its share in SPARE."""
    profile(numbers, rows, at, FREE_ROW, DOT_ROW, count)
    swings = at + (12 if vertex and numbers[at + 13] >= 0.0 else 10)
    share = 0.0 if is_mask else numbers[swings + 1]
    swing = 0.5 * share * phase(numbers[swings], time)
    for n in range(count):
        value = rows[DOT_ROW, n] * rows[SPARE_ROW, n]
        if not is_mask:
            value *= amplitude * (1.0 - 0.5 * share + swing * rows[SIGN_ROW, n])
        rows[top, n] = value if value > rows[top, n] else rows[top, n]


@compiled
def _nearest_dot(numbers, rows, part, moved, edge, count):
    """Find the distance of the nearest dot of a row, and what its window leaves of it: 9.3.3.

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
        rest = (end - dot - along * end_along - across * end_across) * _FADES_PER_MM
        away = (-u if open_begin and u < 0.0 else 0.0) + (
            u - length if open_end and u > length else 0.0
        )
        is_cut = away != 0.0 and away * away + across * across > edge * edge
        seen = low <= dot < high and not is_cut
        share = min(max(share, 0.0), 1.0) * min(max(rest, 0.0), 1.0)
        rows[FREE_ROW, n] = math.sqrt(along * along + across * across)
        rows[SPARE_ROW, n] = share if seen else 0.0


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
