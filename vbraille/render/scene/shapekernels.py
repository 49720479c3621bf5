"""Shapes of scenes and their strokes: Lévesque 2009, 8.4.3 and 8.4.4.

A shape gives every place how far it is across its path, how far along it, and whether it is
inside; a stroke makes a deflection of these. ``at`` is the first of a kernel's constants, whose
order is that of `vbraille.render.scene.shapecode`.
"""

import math

from vbraille.render.scene.curvekernels import angle, compiled, fall, hump, wave
from vbraille.render.scene.texturekernels import phase
from vbraille.render.scene.words import (
    ACROSS_ROW,
    ALONG_ROW,
    FREE_ROW,
    INSIDE_ROW,
    SIGN_ROW,
    SPARE_ROW,
    X_ROW,
    Y_ROW,
)

_FAR = 1e12  # mm²
# Constants of a segment.
SEGMENT = 8
_ALONG = 1  # flags of `segments`
_INSIDE = 2
_OPEN_ENDS = 4


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
            along = radius * angle(rows[X_ROW, n] - x, rows[Y_ROW, n] - y)
            rows[ALONG_ROW, n] = along


@compiled
def segments(numbers, rows, at, block, first, parts, count):
    """Coordinates of lines through places, eqs. 8.15-8.17, from those parts that are in reach.

    ``numbers`` has at ``first`` the places of ``parts`` parts, counted from ``block``. Constants
    of a part: start, direction, length, and how far along the path it begins.
    """
    flags = int(numbers[at])
    for n in range(count):
        rows[ACROSS_ROW, n] = _FAR
    for number in range(parts):
        part = block + int(numbers[first + number])
        x, y, right, down = numbers[part], numbers[part + 1], numbers[part + 2], numbers[part + 3]
        length, begin = numbers[part + 4], numbers[part + 5]
        if flags & _ALONG:
            for n in range(count):
                dx, dy = rows[X_ROW, n] - x, rows[Y_ROW, n] - y
                u = dx * right + dy * down
                v = u if u > 0.0 else 0.0
                v = v if v < length else length
                dx -= v * right
                dy -= v * down
                q = dx * dx + dy * dy
                nearer = q < rows[ACROSS_ROW, n]
                rows[ACROSS_ROW, n] = q if nearer else rows[ACROSS_ROW, n]
                rows[ALONG_ROW, n] = begin + u if nearer else rows[ALONG_ROW, n]
        else:
            for n in range(count):
                dx, dy = rows[X_ROW, n] - x, rows[Y_ROW, n] - y
                v = dx * right + dy * down
                v = v if v > 0.0 else 0.0
                v = v if v < length else length
                dx -= v * right
                dy -= v * down
                q = dx * dx + dy * dy
                rows[ACROSS_ROW, n] = q if q < rows[ACROSS_ROW, n] else rows[ACROSS_ROW, n]
    for n in range(count):
        rows[ACROSS_ROW, n] = math.sqrt(rows[ACROSS_ROW, n])


@compiled
def profile(numbers, rows, at, top, count):
    """Profile of a stroke at full amplitude, eq. 8.7: constants w/2 - ε and 1/ε."""
    flat, sharp = numbers[at], numbers[at + 1]
    for n in range(count):
        rows[top, n] = fall((rows[ACROSS_ROW, n] - flat) * sharp)


@compiled
def stroke(numbers, rows, at, time, top, count):
    """Deflection of a stroke, eqs. 8.7-8.14, at the coordinates of its shape.

    Constants: those of `profile`; amplitude; 1 if outlined; k_t and n/w of the texture across;
    then of the texture along 0 for none, 1 for cut and 2 for whole edges, cycle, ridge, its
    amplitude and velocity; then of the vibration 0 for none, 1 for high and 2 for low, its
    frequency and amplitude.
    """
    flat, sharp, amplitude = numbers[at], numbers[at + 1], numbers[at + 2]
    for n in range(count):
        rows[top, n] = amplitude * fall((rows[ACROSS_ROW, n] - flat) * sharp)
    if numbers[at + 3] != 0.0:
        for n in range(count):
            rows[top, n] *= 1.0 - fall((rows[ACROSS_ROW, n] - flat) * sharp + 1.0)
    if numbers[at + 4] != 0.0:
        weight, cycles = numbers[at + 4], numbers[at + 5]
        half = 0.5 * amplitude
        edge = flat + 1.0 / sharp
        for n in range(count):
            r = rows[ACROSS_ROW, n]
            texture = half + half * wave(r * cycles)
            texture = texture if r < edge else 0.0
            rows[top, n] += weight * (texture - rows[top, n])
    along, vibration = numbers[at + 6], numbers[at + 11]
    if along != 0.0:
        cycle, ridge, depth, velocity = (
            numbers[at + 7],
            numbers[at + 8],
            numbers[at + 9],
            numbers[at + 10],
        )
        shift = 0.0
        if velocity != 0.0 and time == time:
            shift = velocity * time / cycle
            shift = cycle * (shift - math.floor(shift))
        cycles, ridges = 1.0 / cycle, 1.0 / ridge
        for n in range(count):
            u = rows[ALONG_ROW, n] - shift
            u -= cycle * math.floor(u * cycles)
            rows[FREE_ROW, n] = depth * hump(u * ridges - 0.5)
        if along == 2.0:
            for n in range(count):
                rows[FREE_ROW, n] *= fall((rows[ACROSS_ROW, n] - flat) * sharp + 1.0)
        if vibration == 2.0:
            share = numbers[at + 13]
            swing = 0.5 * share * phase(numbers[at + 12], time)
            least = 1.0 - 0.5 * share
            for n in range(count):
                rows[FREE_ROW, n] *= least + swing * rows[SIGN_ROW, n]
        for n in range(count):
            rows[top, n] *= 1.0 - rows[FREE_ROW, n]
    if vibration == 1.0:
        share = numbers[at + 13]
        swing = 0.5 * share * phase(numbers[at + 12], time)
        least = 1.0 - 0.5 * share
        for n in range(count):
            rows[top, n] *= least + swing * rows[SIGN_ROW, n]


@compiled
def dots(numbers, rows, at, time, block, first, parts, top, count):
    """Dots, 8.4.4 and eq. 6.1: the constants of `stroke`, of which some do not count.

    Constants of a part: its middle, and a factor of its amplitude.
    """
    for n in range(count):
        rows[top, n] = 0.0
    flat, sharp, amplitude = numbers[at], numbers[at + 1], numbers[at + 2]
    weight, cycles = numbers[at + 4], numbers[at + 5]
    edge = flat + 1.0 / sharp
    for number in range(parts):
        part = block + int(numbers[first + number])
        x, y = numbers[part], numbers[part + 1]
        height = amplitude * numbers[part + 2]
        for n in range(count):
            dx, dy = rows[X_ROW, n] - x, rows[Y_ROW, n] - y
            rows[SPARE_ROW, n] = math.sqrt(dx * dx + dy * dy)
            rows[FREE_ROW, n] = height * fall((rows[SPARE_ROW, n] - flat) * sharp)
        if weight != 0.0:
            half = 0.5 * height
            for n in range(count):
                r = rows[SPARE_ROW, n]
                texture = half + half * wave(r * cycles)
                texture = texture if r < edge else 0.0
                rows[FREE_ROW, n] += weight * (texture - rows[FREE_ROW, n])
        for n in range(count):
            larger = rows[FREE_ROW, n]
            rows[top, n] = larger if larger > rows[top, n] else rows[top, n]


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
def fill_blended(numbers, rows, at, top, count):
    """Blend a stroke in ``top`` into a fill in ``top - 1``: eq. 8.20, constants of `profile`."""
    flat, sharp = numbers[at], numbers[at + 1]
    for n in range(count):
        share = 1.0 - fall((rows[ACROSS_ROW, n] - flat) * sharp)
        value = rows[top, n] + share * rows[INSIDE_ROW, n] * rows[top - 1, n]
        rows[top - 1, n] = value if value < 1.0 else 1.0


@compiled
def fill_mask(rows, top, count):
    """Raise the mask in ``top`` to 1 inside."""
    for n in range(count):
        inside = rows[INSIDE_ROW, n]
        rows[top, n] = inside if inside > rows[top, n] else rows[top, n]


@compiled
def inside(numbers, rows, block, first, parts, count):
    """Tell what is inside of closed lines by the even-odd rule, from all of their segments."""
    for n in range(count):
        rows[INSIDE_ROW, n] = 0.0
    for number in range(parts):
        part = block + int(numbers[first + number])
        x, y = numbers[part], numbers[part + 1]
        right, down, length = numbers[part + 2], numbers[part + 3], numbers[part + 4]
        end = numbers[part + 6]
        slope = right / down if down != 0.0 else 0.0
        for n in range(count):
            py = rows[Y_ROW, n]
            crossed = (y > py) != (end > py)
            left = x + (py - y) * slope < rows[X_ROW, n]
            was = rows[INSIDE_ROW, n]
            rows[INSIDE_ROW, n] = 1.0 - was if crossed and left else was
