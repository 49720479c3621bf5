"""The places of shapes' paths, as kernels: Lévesque 2009, 8.4.3.

A shape gives every place how far it is across its path, how far along it, and whether it is
inside; `strokekernels` makes deflections of these. ``at`` is the first of a kernel's constants.
Shapes of many parts are given only those in reach: ``numbers`` has at ``first`` the places of
``parts`` parts, which count from ``block``.
"""

import math

from vbraille.render.machine.texturekernels import passed_s
from vbraille.render.machine.words import (
    ACROSS_ROW,
    ALONG_ROW,
    FREE_ROW,
    INSIDE_ROW,
    MARKED_ROW,
    PART_ROW,
    PLACE_ROW,
    X_ROW,
    Y_ROW,
)
from vbraille.render.waves import angle, compiled

_FAR = 1e12  # mm²
_TURN = 2 * math.pi
# What is asked of `segments`: only how far across, how far along, or along round corners and
# within cycles that differ.
ACROSS, ALONG, ROUNDED = range(3)
# Numbers of a segment: its start and direction, its length, and y of its end.
(
    START_X,
    START_Y,
    RIGHT,
    DOWN,
    LENGTH,
    END_Y,
    # How a corner is halved between the two segments that meet there: side of the bisector at the
    # start, and at the end with what is added to it, by which an open end has no other side.
    HALF_X,
    HALF_Y,
    END_HALF_X,
    END_HALF_Y,
    END_BIAS,
    BEGIN,  # how far along the path its straight part begins, minus the place of that on it
    RIDGE,  # of the texture along it; 0 for that of the stroke
    CYCLE,
    VELOCITY,
    CORNER,  # the corner at its start, and then the one at its end
) = range(16)
# Numbers of a corner.
REACH, PIVOT_X, PIVOT_Y, ONWARD_X, ONWARD_Y, INWARD_X, INWARD_Y, ARC_RADIUS, ARC_HALF, MIDDLE = (
    range(10)
)
CORNER_NUMBERS = 10
SEGMENT_NUMBERS = CORNER + 2 * CORNER_NUMBERS
# Numbers of a marker, which follow those of its polygon's segment that begins there.
(
    MARK_X,
    MARK_Y,
    MARK_SINE,
    MARK_COSINE,
    MARK_PUSHED,
    MARK_BEFORE,  # by how much the numbers of the segment that ends there are before these
    MARKED_NUMBERS,
) = range(SEGMENT_NUMBERS, SEGMENT_NUMBERS + 7)


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
def segments(numbers, rows, at, time, block, first, parts, count):
    """Coordinates of lines through places, eqs. 8.15-8.17: constants what is asked for, clock."""
    time = passed_s(rows, numbers[at + 1], time)
    for n in range(count):
        rows[ACROSS_ROW, n] = _FAR
    along = numbers[at] != ACROSS
    if along:
        for n in range(count):
            rows[FREE_ROW, n] = rows[ALONG_ROW, n] = 0.0
            rows[PART_ROW, n] = block + numbers[first]
    for number in range(parts):
        part = block + int(numbers[first + number])
        x, y, length = numbers[part], numbers[part + START_Y], numbers[part + LENGTH]
        right, down = numbers[part + RIGHT], numbers[part + DOWN]
        if not along:
            for n in range(count):
                dx, dy = rows[X_ROW, n] - x, rows[Y_ROW, n] - y
                u = dx * right + dy * down
                u = u if u > 0.0 else 0.0
                u = u if u < length else length
                dx -= u * right
                dy -= u * down
                q = dx * dx + dy * dy
                rows[ACROSS_ROW, n] = q if q < rows[ACROSS_ROW, n] else rows[ACROSS_ROW, n]
            continue
        half_x, half_y = numbers[part + HALF_X], numbers[part + HALF_Y]
        end_half_x, end_half_y = numbers[part + END_HALF_X], numbers[part + END_HALF_Y]
        bias = numbers[part + END_BIAS]
        end_x, end_y = x + length * right, y + length * down
        place, begin = float(part), numbers[part + BEGIN]
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
            rows[PART_ROW, n] = place if nearer else rows[PART_ROW, n]
            rows[ALONG_ROW, n] = begin + u if nearer else rows[ALONG_ROW, n]
    for n in range(count):
        rows[ACROSS_ROW, n] = math.sqrt(rows[ACROSS_ROW, n])
    if numbers[at] == ROUNDED:
        for n in range(count):
            part = int(rows[PART_ROW, n])
            place = _along(numbers, part, rows[FREE_ROW, n], rows[X_ROW, n], rows[Y_ROW, n])
            rows[PLACE_ROW, n] = place
            rows[ALONG_ROW, n] = _in_ridge(numbers, part, place, time)


@compiled
def _along(numbers, part, u, x, y):
    """Tell how far along its path a place is, from how far it is along the part that is nearest.

    Near a corner that is rounded it follows an arc: fig. 8.18.
    """
    first, last = part + CORNER, part + CORNER + CORNER_NUMBERS
    if u < numbers[first + REACH]:
        return _round(numbers, first, x, y)
    if u > numbers[part + LENGTH] - numbers[last + REACH]:
        return _round(numbers, last, x, y)
    return numbers[part + BEGIN] + u


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
def _round(numbers, corner, x, y):
    dx, dy = x - numbers[corner + PIVOT_X], y - numbers[corner + PIVOT_Y]
    onward = dx * numbers[corner + ONWARD_X] + dy * numbers[corner + ONWARD_Y]
    outward = -(dx * numbers[corner + INWARD_X] + dy * numbers[corner + INWARD_Y])
    half = numbers[corner + ARC_HALF]
    turn = min(max(math.atan2(onward, outward), -half), half)
    return numbers[corner + MIDDLE] + numbers[corner + ARC_RADIUS] * turn


@compiled
def inside(numbers, rows, block, first, parts, count):
    """Tell what is inside of closed lines by the even-odd rule.

    What is to the right of all places is told by walls: `vbraille.render.scene.paths`.
    """
    for n in range(count):
        rows[INSIDE_ROW, n] = 0.0
    for number in range(parts):
        part = block + int(numbers[first + number])
        x, y, end = numbers[part], numbers[part + START_Y], numbers[part + END_Y]
        right, down = numbers[part + RIGHT], numbers[part + DOWN]
        if y == end:
            continue
        slope = right / down
        for n in range(count):
            py = rows[Y_ROW, n]
            crossed = (y > py) != (end > py)
            hit = crossed & (rows[X_ROW, n] < x + (py - y) * slope)
            was = rows[INSIDE_ROW, n]
            rows[INSIDE_ROW, n] = 1.0 - was if hit else was


@compiled
def markers(numbers, rows, at, block, first, parts, count):
    """Share of the markers in a polygon's stroke: figs. 8.19 and 8.20.

    Constants: half of the stroke's width, and 1 over the distance of the blend. A place is asked
    for the nearest corner alone, and only if one of its two segments is the nearest, too.
    """
    half, slope = numbers[at], numbers[at + 1]
    for n in range(count):
        x, y = rows[X_ROW, n], rows[Y_ROW, n]
        rows[MARKED_ROW, n] = 0.0
        if not rows[ACROSS_ROW, n] < half:
            continue
        own = int(rows[PART_ROW, n])
        part, least = own, _FAR
        for number in range(parts):
            other = block + int(numbers[first + number])
            dx, dy = x - numbers[other], y - numbers[other + START_Y]
            q = dx * dx + dy * dy
            if q < least:
                part, least = other, q
        if own != part and own != part - int(numbers[part + MARK_BEFORE]):
            continue
        corner = part + CORNER
        dx, dy = x - numbers[part + MARK_X], y - numbers[part + MARK_Y]
        onward = dx * numbers[corner + ONWARD_X] + dy * numbers[corner + ONWARD_Y]
        outward = -(dx * numbers[corner + INWARD_X] + dy * numbers[corner + INWARD_Y])
        within = numbers[part + MARK_SINE] * outward - numbers[part + MARK_COSINE] * abs(onward)
        share = (within + numbers[part + MARK_PUSHED]) * slope
        rows[MARKED_ROW, n] = min(max(share, 0.0), 1.0)
