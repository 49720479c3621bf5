"""Patterns of scenes, as kernels for one place: Lévesque 2009, 8.4 and 9.3.

``own`` are the constants of an instruction; `vbraille.render.compiling` writes them in the order in
which each kernel names them. ``given`` are the values of the signals.
"""

import math

from vbraille.render.waves import compiled, fall, inlined, phase, ridge, swung

_FAR = 1e6  # mm
_DEG = 180.0 / math.pi
_WHOLE = 1.0 / 65_535.0

CORNER = 15  # numbers of a segment before those of the corners at its two ends
CORNER_NUMBERS = 10


@compiled
def moved(own, given, time):
    """Compute how far something has moved: constants velocity, and a clock.

    The clock is the number of the signal whose integral is the time of the motion; below 0 it is
    time itself. Without a time, which is NaN then, all stands where it does at first.
    """
    if time != time:
        return 0.0
    clock = int(own[1])
    return own[0] * (given[clock] if clock >= 0 else time)


@compiled
def grating(own, abscissa, count, given, time):
    """Exchange an abscissa for the waveform g there, eq. 8.4, after a distortion, eqs. 8.5 and 8.6.

    Constants: velocity, clock, cycle, ridge, then of the distortion its change of frequency K - 1,
    where it begins, its length, and 1 if it is a peak.
    """
    cycle, length, shift = own[2], own[3], moved(own, given, time)
    change, begin, reach, is_peak = own[4], own[5], own[6], own[7] != 0.0
    if change != 0.0:
        for n in range(count):
            # Area of the rise up to here, and of what comes after it: 1 for ever, or a fall.
            u = abscissa[n] - begin
            rise, after = min(max(u, 0.0), reach), max(u - reach, 0.0)
            if is_peak:
                after = min(after, reach)
                after -= 0.5 * after * after / reach
            abscissa[n] += change * (0.5 * rise * rise / reach + after)
    for n in range(count):
        abscissa[n] = ridge(abscissa[n] - shift, cycle, length)


@compiled
def axial(own, x, y, out, count, given, time):
    """Axial grating: constants those of `grating`, centre, start, middle, and its fade in mm."""
    for n in range(count):
        turn = math.atan2(y[n] - own[9], x[n] - own[8]) * _DEG - own[10]
        out[n] = turn - 360.0 * math.floor(turn / 360.0)
    grating(own, out, count, given, time)
    for n in range(count):
        radius = math.sqrt((x[n] - own[8]) ** 2 + (y[n] - own[9]) ** 2)
        share = min(max((radius - own[12]) * own[13], 0.0), 1.0)
        out[n] = own[11] + share * (out[n] - own[11])


@compiled
def image(own, table, x, y):
    """Bilinear image: constants middle of the first pixel, pixels a mm, size, place in ``table``.

    In the table there is a ring of pixels around it, of the intensity beyond its edges. The last
    constant is 1 if the nearest pixel counts.
    """
    u, v = (x - own[0]) * own[2], (y - own[1]) * own[3]
    if own[7] != 0.0:
        u, v = math.floor(u + 0.5), math.floor(v + 0.5)
    # Written so that whatever comes, the four pixels are in the table.
    u, v = min(max(u, 0.0), own[4] - 1.0), min(max(v, 0.0), own[5] - 1.0)
    left, above = min(math.floor(u), own[4] - 2.0), min(math.floor(v), own[5] - 2.0)
    width = int(own[4])
    pixel = int(own[6]) + int(above) * width + int(left)
    u, v = u - left, v - above
    upper = table[pixel] * (1.0 - u) + table[pixel + 1] * u
    lower = table[pixel + width] * (1.0 - u) + table[pixel + width + 1] * u
    return _WHOLE * (upper + v * (lower - upper))


# Shapes: every place has a distance across the path and a place along it, and is inside or not.


@compiled
def circle(own, x, y, across, along, inside, count):
    """Coordinates of a circle, eqs. 8.18 and 8.19: constants centre, radius, 1 if along counts."""
    x0, y0, radius = own[0], own[1], own[2]
    for n in range(count):
        distance = math.sqrt((x[n] - x0) ** 2 + (y[n] - y0) ** 2)
        across[n] = abs(distance - radius)
        inside[n] = 1.0 if distance < radius else 0.0
    if own[3] != 0.0:
        for n in range(count):
            turn = math.atan2(y[n] - y0, x[n] - x0)
            along[n] = radius * (turn if turn >= 0.0 else turn + 2.0 * math.pi)


@compiled
def nearest(numbers, first, end, size, x, y, square, along, part, count):
    """Lower the squared distance to those of segments, and keep the place along the nearest.

    Numbers of each: start, direction, length, y of its end; then how a corner is halved between the
    two segments that meet there: side of the bisector at the start, and at the end with a bias by
    which an open end has no other side; then how far along the path it begins, its number, and the
    ridge and cycle of the texture along its contour. Eqs. 8.15-8.17.
    """
    for number in range(first, end, size):
        own = numbers[number:]
        x0, y0, right, down, length = own[0], own[1], own[2], own[3], own[4]
        half_x, half_y, end_half_x, end_half_y = own[6], own[7], own[8], own[9]
        bias, begin = own[10], own[11]
        for n in range(count):
            dx, dy = x[n] - x0, y[n] - y0
            u = dx * right + dy * down
            v = u if u > 0.0 else 0.0
            v = v if v < length else length
            q = (dx - v * right) ** 2 + (dy - v * down) ** 2
            # Beyond a corner two segments are equally near; its bisector decides.
            before = (u <= 0.0) & (dx * half_x + dy * half_y < 0.0)
            beyond_x, beyond_y = dx - length * right, dy - length * down
            after = (u >= length) & (beyond_x * end_half_x + beyond_y * end_half_y + bias >= 0.0)
            nearer = (q < square[n]) & ((before | after) == False)  # noqa: E712
            square[n] = q if nearer else square[n]
            along[n] = begin + u if nearer else along[n]
            part[n] = float(number) if nearer else part[n]


@compiled
def crossed(numbers, first, end, size, x, y, inside, count):
    """Turn inside to outside where a line to the right meets a segment: the even-odd rule."""
    for number in range(first, end, size):
        x0, upper, lower = numbers[number], numbers[number + 1], numbers[number + 5]
        if upper == lower:
            continue
        slope = numbers[number + 2] / numbers[number + 3]
        for n in range(count):
            within = (upper > y[n]) != (lower > y[n])
            hit = within & (x[n] < x0 + (y[n] - upper) * slope)
            inside[n] = 1.0 - inside[n] if hit else inside[n]


@compiled
def rounded(segment, x, y, along):
    """Place along a path, which near a corner that is rounded follows an arc: fig. 8.18."""
    u = along - segment[11]
    corner = segment[CORNER:]
    if u >= corner[0]:
        corner = segment[CORNER + CORNER_NUMBERS :]
        if u <= segment[4] - corner[0]:
            return along
    # Reach, pivot, directions onward and inward, radius, half of the angle, middle of the arc.
    dx, dy = x - corner[1], y - corner[2]
    onward, outward = dx * corner[3] + dy * corner[4], -(dx * corner[5] + dy * corner[6])
    turn = min(max(math.atan2(onward, outward), -corner[8]), corner[8])
    return corner[9] + corner[7] * turn


@compiled
def beyond(segment, x, y, fades_per_mm):
    """Compute what is left beyond the ends of an open path."""
    u = (x - segment[0]) * segment[2] + (y - segment[1]) * segment[3]
    away = 0.0
    if u < 0.0 and segment[6] == 0.0 and segment[7] == 0.0:
        away = -u
    elif u > segment[4] and segment[10] < 0.0:
        away = u - segment[4]
    return max(1.0 - fades_per_mm * away, 0.0)


@inlined
def _profile_at(distance, flat, sharp, half, weight, cycles, is_mask):
    value = fall((distance - flat) * sharp)
    if weight != 0.0:
        texture = math.cos(math.pi * distance * cycles) ** 2 if distance < half else 0.0
        more = weight * (texture - value)
        value += max(more, 0.0) if is_mask else more
    return value


@compiled
def profile(own, distance, out, count):
    """Profile of a stroke or a dot, eq. 8.7, with a texture across it, eq. 8.10.

    Constants: w/2 - ε, 1/ε, w/2, weight and cycles a mm of the texture (0 for none), and 1 for an
    opacity mask, in which the texture counts only where it is higher.
    """
    flat, sharp, half, weight, cycles, is_mask = own[0], own[1], own[2], own[3], own[4], own[5]
    for n in range(count):
        out[n] = _profile_at(distance[n], flat, sharp, half, weight, cycles, is_mask != 0.0)


@compiled
def markers(own, x, y, sign, time, own_segment, value):
    """Blend a stroke's texture into markers at the vertices of a polygon: figs. 8.19 and 8.20.

    Constants: 1 over the distance of the blend, frequency and amplitude of their vibration, the
    number of corners, and for each of these its place and its marker's pivot, directions onward and
    inward, sine, cosine and how far it is pushed. A place is asked for the nearest corner alone,
    and only if one of its two segments is the nearest, too.
    """
    corners, nearest_corner, least = int(own[3]), 0, _FAR * _FAR
    for number in range(corners):
        dx, dy = x - own[4 + 11 * number], y - own[5 + 11 * number]
        if dx * dx + dy * dy < least:
            nearest_corner, least = number, dx * dx + dy * dy
    if own_segment not in (nearest_corner, (nearest_corner + corners - 1) % corners):
        return value
    corner = own[4 + 11 * nearest_corner :]
    dx, dy = x - corner[2], y - corner[3]
    onward = dx * corner[4] + dy * corner[5]
    outward = -(dx * corner[6] + dy * corner[7])
    within = corner[8] * outward - corner[9] * abs(onward) + corner[10]
    share = min(max(within * own[0], 0.0), 1.0)
    return value + share * (swung(own[2], sign * phase(own[1], time)) - value)


# Dots, of which the highest counts: 8.4.4, 9.3.3 and eq. 6.1. Constants of their look: those of the
# profile, amplitude, frequency and amplitude of their vibration, the same of dots on vertices (an
# amplitude below 0 for none of their own), then velocity and clock.


@compiled
def _dot(look, distance, is_vertex, sign, time):
    """Deflection of a dot, or its opacity."""
    value = _profile_at(distance, look[0], look[1], look[2], look[3], look[4], look[5] != 0.0)
    if value > 0.0 and look[5] == 0.0:
        swing = look[9:] if is_vertex and look[10] >= 0.0 else look[7:]
        value *= look[6] * swung(swing[1], sign * phase(swing[0], time))
    return value


@compiled
def dots(look, numbers, first, end, x, y, sign, time, value):
    """Raise a value to that of dots that stay: place of each, and 1 for a vertex."""
    for number in range(first, end, 3):
        dx, dy = x - numbers[number], y - numbers[number + 1]
        q = dx * dx + dy * dy
        if q < look[2] * look[2]:
            is_vertex = numbers[number + 2] != 0.0
            value = max(value, _dot(look, math.sqrt(q), is_vertex, sign, time))
    return value


@compiled
def dot_row(look, own, x, y, sign, given, time, value):
    """Raise a value to that of the nearest dot of a row that moves, as far as its window shows it.

    Constants: start of a segment, or middle of a circle; direction, length, radius of a circle (0
    for a segment), place along the row where the segment begins, pitch; the dots of the row that
    are on this segment; place along the row where its window begins, and the row's direction there
    as seen from the segment; the same of its end; 1 if dots are cut off beyond a round end there.
    """
    dx, dy, radius, pitch = x - own[0], y - own[1], own[5], own[7]
    shift = moved(look[11:], given, time)
    if radius > 0.0:
        along = radius * math.atan2(dy, dx) - shift
        along -= pitch * math.floor(along / pitch + 0.5)
        away, half = math.sqrt(dx * dx + dy * dy), math.sin(0.5 * along / radius)
        distance = math.sqrt((away - radius) ** 2 + 4.0 * away * radius * half * half)
        return max(value, _dot(look, distance, False, sign, time))
    u, across = dx * own[2] + dy * own[3], dy * own[2] - dx * own[3]
    along = own[6] + u - shift
    along -= pitch * math.floor(along / pitch + 0.5)
    dot = own[6] + u - along
    if not own[8] <= dot < own[9]:
        return value
    away = 0.0
    if own[16] != 0.0 and u < 0.0:
        away = u
    elif own[17] != 0.0 and u > own[4]:
        away = u - own[4]
    if away != 0.0 and away * away + across * across > look[2] * look[2]:
        return value
    begun = dot + along * own[11] + across * own[12] - own[10]
    rest = own[13] - dot - along * own[14] - across * own[15]
    share = min(max(begun, 0.0), 1.0) * min(max(rest, 0.0), 1.0)  # they come and go over 1 mm
    distance = math.sqrt(along * along + across * across)
    return max(value, share * _dot(look, distance, False, sign, time))
