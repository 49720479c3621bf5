"""How OpenLatero goes round polygons, restated: nearest edges, joints and markers."""

import math

from tests.scene.openlatero.referencevalues import gain, number, switch, word


def to_segment(place, start, end):
    """Distance to a segment, and how far along it, beyond its ends too: eqs. 8.15 to 8.17."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    length = math.hypot(dx, dy)
    u = ((place[0] - start[0]) * dx + (place[1] - start[1]) * dy) / length**2
    held = min(max(u, 0.0), 1.0)
    near = (start[0] + held * dx, start[1] + held * dy)
    return math.dist(place, near), u * length


class Joint:
    """Where two edges of a polygon meet."""

    def __init__(self, vertices, number, reach):
        count = len(vertices)
        self.at = vertices[number]
        self.back = unit(self.at, vertices[number - 1])
        self.on = unit(self.at, vertices[(number + 1) % count])
        self.angle = between(self.back, self.on)
        self.cut = reach / math.tan(self.angle / 2)
        middle = (self.back[0] + self.on[0], self.back[1] + self.on[1])
        size = math.hypot(*middle)
        far = math.hypot(self.cut, reach)
        self.pivot = (self.at[0] + middle[0] / size * far, self.at[1] + middle[1] / size * far)
        self.arc = (math.pi - self.angle) * reach


def unit(start, end):
    size = math.dist(start, end)
    return (end[0] - start[0]) / size, (end[1] - start[1]) / size


def between(one, two):
    """Angle between two directions, without a sign."""
    cosine = (one[0] * two[0] + one[1] * two[1]) / (math.hypot(*one) * math.hypot(*two))
    return math.acos(min(max(cosine, -1.0), 1.0))


def along_polygon(vertices, joints, place, rounded):
    """Distance to a polygon, how far along it, and its nearest edge."""
    count = len(vertices)
    found = []
    for i in range(count):
        away, along = to_segment(place, vertices[i], vertices[(i + 1) % count])
        length = math.dist(vertices[i], vertices[(i + 1) % count])
        beyond = max(-along, along - length)
        found.append((round(away, 9), beyond, i, along, length))
    # Of two edges that are as near, that on whose side of the bisector the place is.
    away, _, i, along, length = min(found)
    start, end = joints[i], joints[(i + 1) % count]
    lengths = [one[4] for one in found]
    if not rounded:
        return away, along + sum(lengths[:i]), i
    if along < start.cut:
        share = turn(start, start.on, place) / (math.pi - start.angle)
        along = start.arc / 2 - share * start.arc
    elif along > length - end.cut:
        share = turn(end, end.back, place) / (math.pi - end.angle)
        along = length - start.cut - end.cut + start.arc / 2 + share * end.arc
    else:
        along = along - start.cut + start.arc / 2
    for j in range(i):
        one, two = joints[j], joints[(j + 1) % count]
        along += lengths[j] - one.cut - two.cut + (one.arc + two.arc) / 2
    return away, along, i


def turn(joint, way, place):
    """Angle at a joint's pivot from where its arc begins to a place."""
    begin = (joint.at[0] + way[0] * joint.cut, joint.at[1] + way[1] * joint.cut)
    return between(
        (begin[0] - joint.pivot[0], begin[1] - joint.pivot[1]),
        (place[0] - joint.pivot[0], place[1] - joint.pivot[1]),
    )


def is_inside(vertices, place):
    """Even-odd rule."""
    inside = False
    for (ax, ay), (bx, by) in zip(vertices, vertices[1:] + vertices[:1], strict=True):
        if (ay > place[1]) != (by > place[1]):
            inside ^= place[0] < ax + (place[1] - ay) / (by - ay) * (bx - ax)
    return inside


def marked(corner, vertices, half, place, away, edge, now):
    """Share of a marker at a place, and what it shows."""
    if away > half:
        return None
    joints = [Joint(vertices, i, half) for i in range(len(vertices))]
    nearest = min(range(len(vertices)), key=lambda i: math.dist(vertices[i], place))
    if nearest not in (edge, (edge + 1) % len(vertices)):
        return None
    joint = joints[nearest]
    size = {
        "circle intercept": joint.angle,
        "right-angled": math.pi - joint.angle,
        "user specified": math.radians(number(corner, "user_angle", 30.0)),
        "arc": arc_span(joint, half),
    }[word(corner, "span", "circle intercept")]
    # Two half-planes, whose limits lie so far beyond the pivot along the edges.
    blend = number(corner, "blend_size", 1.0)
    ax, ay = unit(joint.pivot, joint.at)
    limits = []
    for way in (joint.back, joint.on):
        side = 1.0 if ax * way[1] - ay * way[0] > 0 else -1.0
        turned = size / 2 * side
        v = (
            ax * math.cos(turned) - ay * math.sin(turned),
            ax * math.sin(turned) + ay * math.cos(turned),
        )
        through = (joint.pivot[0] + way[0] * blend, joint.pivot[1] + way[1] * blend)
        dx, dy = place[0] - through[0], place[1] - through[1]
        # Distance into the cone: towards the axis from this limit.
        limits.append(-side * (v[0] * dy - v[1] * dx))
    share = min(1.0, min(limits) / blend)
    if share <= 0:
        return None
    vibration = corner.find("vibration")
    swings = vibration is not None and switch(vibration, "enable", True)
    return share, gain(vibration, now) if swings else 1.0


def arc_span(joint, half):
    """Angle under which a pivot sees the ends of the round joint's outer arc."""
    ends = []
    for way in (joint.back, joint.on):
        foot = (joint.at[0] + way[0] * joint.cut, joint.at[1] + way[1] * joint.cut)
        out = unit(joint.pivot, foot)
        end = (joint.at[0] + out[0] * half, joint.at[1] + out[1] * half)
        ends.append((end[0] - joint.pivot[0], end[1] - joint.pivot[1]))
    return between(*ends)
