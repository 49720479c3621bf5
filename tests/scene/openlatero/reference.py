"""What OpenLatero shows, in plain float64: its files read and its equations restated by themselves.

It shares nothing with what it tests. Pictures and reactive patterns are not in it.
"""

import math
from xml.etree import ElementTree

SURFACE = (289.9, 230.1875)


def deflections(text, places, sign=1.0, time_s=0.0):
    """Deflections of a scene or texture at places."""
    root = ElementTree.fromstring(text)
    generator = root.find("Generator")
    top = (root if generator is None else generator).find("Pattern")
    return [min(1.0, pattern(top, place, Now(sign, time_s))) for place in places]


class Now:
    """Which actuator it is, as the sign of its vibration, and when."""

    def __init__(self, sign, time_s):
        self.sign = sign
        self.time_s = time_s

    def swing(self, hertz):
        """q: what an actuator shows of a vibration."""
        return 0.5 + 0.5 * self.sign * math.sin(2 * math.pi * hertz * self.time_s)


def number(above, name, default):
    found = None if above is None else above.find(name)
    return default if found is None else float(found.text)


def switch(above, name, default):
    found = None if above is None else above.find(name)
    return default if found is None else found.text.strip() in ("yes", "true")


def word(above, name, default):
    found = None if above is None else above.find(name)
    return default if found is None else found.text.strip()


def point(above, name, default):
    found = None if above is None else above.find(name)
    return default if found is None else read_point(found.text)


def read_point(text):
    x, y = text.split(",")
    return float(x), float(y)


def pattern(node, place, now):
    kind = node.get("type")
    if kind == "Group":
        parts = node.findall("Pattern")
        values = [pattern(part, place, now) for part in parts]
        return group(node, values, lambda: [mask(part, place) for part in parts[1:]])
    if kind == "Toggle":
        return pattern(node.find("Pattern"), place, now)
    if kind == "Audio":
        return 0.0
    if kind == "Texture":
        return texture(node, place, now)
    if kind == "Line":
        return line(node, place, now)
    if kind == "Circle":
        return circle(node, place, now)
    if kind == "Polygon":
        return polygon(node, place, now)
    if kind in ("Dot", "Dots"):
        return dots(node, place, now)
    raise AssertionError(kind)


# Operators, section 5


def operation(node, default="max"):
    found = node.find("operation")
    if found is None:
        return default
    return found.get("type") or found.text.strip()


def group(node, values, masks):
    name = operation(node)
    if not values:
        return 0.0
    if name == "multiply":
        made = math.prod(values)
    elif name == "add":
        made = sum(values)
    elif name == "max":
        made = max(values)
    elif name == "blend":
        first, second, weight = values[:3]
        made = weight * first + (1 - weight) * second
    elif name == "overwrite":
        made = values[0]
        for value, hiding in zip(values[1:], masks(), strict=True):
            made = value + (1 - hiding) * made
    return min(1.0, made)


def mask(node, place):
    """Opacity of shapes, which is all that the files here overwrite with."""
    kind = node.get("type")
    stroke = node.find("stroke")
    width = number(stroke, "width", 10.0)
    edge = number(None if stroke is None else stroke.find("ridge"), "edge_width", 1.0)
    if kind == "Line":
        return shape(distance_to_line(node, place)[0], width, edge)
    if kind == "Circle":
        away, inside = distance_to_circle(node, place)[::2]
        if inside and switch(node.find("fill_texture"), "enable", False):
            return 1.0
        return shape(away, width, edge)
    raise AssertionError(kind)


# Waves and textures, sections 3 and 4


def wave(node, x, now, usual):
    grating = node.find("Grating")
    inverted = switch(grating, "invert", False)
    if not switch(grating, "enable", True):
        return float(inverted)
    ridge, gap = number(grating, "ridge_size", usual), number(grating, "gap_size", 0.0)
    cycle = ridge + gap
    speed = number(grating, "velocity", 0.0)
    if grating is not None and grating.find("velocity") is not None:
        hertz = grating.find("velocity").get("units") == "Hz"
        speed *= cycle if hertz else 1.0
    modulator = None if grating is None else grating.find("PitchModulator")
    if switch(modulator, "enable", False):
        x = warped(modulator, x)
    else:
        x -= speed * now.time_s
    u = (x / cycle) % 1.0
    value = (1 - math.cos(2 * math.pi * u / (ridge / cycle))) / 2 if u <= ridge / cycle else 0.0
    return 1 - value if inverted else value


def warped(modulator, x):
    """Eqs. 8.5 and 8.6."""
    k = number(modulator, "factor", 5.0)
    length = number(modulator, "length", 113.0)
    a = number(modulator, "position", 0.0)
    if modulator.get("type") == "slope":
        if x <= a:
            return x
        if x <= a + length:
            return x + (k - 1) * (x - a) ** 2 / (2 * length)
        return k * x - (k - 1) * (a + length / 2)
    if x <= a - length:
        return x
    if x <= a:
        return x + (k - 1) * (x - a + length) ** 2 / (2 * length)
    if x <= a + length:
        return k * x + (k - 1) * (length**2 - 2 * length * a - (x - a) ** 2) / (2 * length)
    return x + (k - 1) * length


def texture(node, place, now):
    kind = node.get("subtype")
    motion = node.find("motion")
    if switch(motion, "enable", False) and kind not in ("DoubleLinearGrating", "Pattern"):
        speed, way = number(motion, "velocity", 50.0), number(motion, "direction", 0.0)
        carried = speed * now.time_s
        place = (
            place[0] - carried * math.cos(math.radians(way)),
            place[1] - carried * math.sin(math.radians(way)),
        )
    value = plain_texture(node, kind, place, now)
    if kind in ("Null", "Motion", "Pattern", "DoubleLinearGrating"):
        return value
    value *= number(node, "amplitude", 1.0)
    if switch(node, "invert", False):
        value = 1 - value
    return vibrated(node, value, now)


def plain_texture(node, kind, place, now):
    seed = point(node, "seed", (0.0, 0.0))
    x, y = place[0] - seed[0], place[1] - seed[1]
    angle = math.radians(number(node, "angle", 0.0))
    if kind == "Null":
        return 0.0
    if kind == "Plain":
        return 1.0
    if kind == "Vibration":
        return now.swing(number(node, "freq", 50.0))
    if kind == "LinearGrating":
        return wave(node, x * math.cos(angle) + y * math.sin(angle), now, 8.0)
    if kind == "RadialGrating":
        return wave(node, math.hypot(x, y), now, 8.0)
    if kind == "AxialGrating":
        return axial(node, x, y, now)
    if kind == "DoubleLinearGrating":
        return double(node, x, y, now)
    if kind == "Combo":
        return group(node, [pattern(part, place, now) for part in node.findall("Pattern")], list)
    if kind == "Motion":
        return pattern(node.find("Pattern"), place, now)
    assert kind == "Pattern"
    wide, high = number(node, "grid_width", 20.0), number(node, "grid_height", 20.0)
    return pattern(node.find("Pattern"), (place[0] % wide, place[1] % high), now)


def axial(node, x, y, now):
    grating = node.find("Grating")
    cycle = number(grating, "ridge_size", 36.0) + number(grating, "gap_size", 0.0)
    modulator = None if grating is None else grating.find("PitchModulator")
    if switch(modulator, "enable", False):
        cycle = min(cycle, cycle / number(modulator, "factor", 5.0))
    arc = math.hypot(x, y) * math.radians(cycle)
    shown = min(max((arc - 0.5) / 0.5, 0.0), 1.0)
    turn = (math.degrees(math.atan2(y, x)) - number(node, "seed_angle", 0.0)) % 360.0
    return (1 - shown) + shown * wave(node, turn, now, 36.0)


def double(node, x, y, now):
    ridge, gap = number(node, "primary_ridge_size", 8.0), number(node, "primary_gap_size", 0.0)
    scale = number(node, "secondary_scale", 1.0)
    angle = number(node, "angle", 0.0)
    across = 90.0 if word(node, "constraint", "orthogonal") == "orthogonal" else 0.0
    motion = node.find("motion")
    values = []
    for times, way, name in ((1.0, angle, "primary"), (scale, angle + across, "secondary")):
        turn = math.radians(way)
        along = x * math.cos(turn) + y * math.sin(turn)
        if switch(motion, "enable", False):
            speed = number(motion, "velocity", 50.0)
            off = math.radians(number(motion, "direction", 0.0) - way)
            along -= speed * math.cos(off) * now.time_s
        cycle = (ridge + gap) * times
        u = (along % cycle) / (ridge * times)
        value = (1 - math.cos(2 * math.pi * u)) / 2 if u <= 1 else 0.0
        values.append(value * number(node, f"{name}_amplitude", 1.0))
    return group(node, values, list)


# Vibration, profiles and strokes, section 3


def gain(vibration, now):
    """δ¹ of eq. 8.3."""
    amplitude = number(vibration, "amplitude", 1.0)
    return (1 - amplitude) + amplitude * now.swing(number(vibration, "frequency", 50.0))


def vibrated(node, value, now):
    """What is shown once it vibrates, as the file says: of what is up, or of what is down."""
    vibration = None if node is None else node.find("vibration")
    if vibration is None or not switch(vibration, "enable", True):
        return value
    if word(vibration, "blend_mode", "high") == "low":
        return 1 - gain(vibration, now) * (1 - value)
    return value * gain(vibration, now)


def shape(away, width, edge):
    """Profile of a stroke, eq. 8.7."""
    half = width / 2
    edge = min(edge, half)
    if away < half - edge:
        return 1.0
    if away > half:
        return 0.0
    return 0.5 + 0.5 * math.cos(math.pi * (away - half + edge) / edge)


def profile(ridge, away, width, usual):
    edge = number(ridge, "edge_width", usual)
    value = shape(away, width, edge)
    across = None if ridge is None else ridge.find("texture")
    if away > width / 2 or not switch(across, "enable", False):
        return value
    share, cycles = number(across, "amplitude", 0.0), number(across, "nb_cycles", 3)
    ripples = 0.5 + 0.5 * math.cos(2 * math.pi * (cycles + 0.5) * away / (width / 2))
    return (1 - share) * value + share * ripples


def stroked(node, away, along, background, now, marker=None):
    """A shape: eqs. 8.7 to 8.14, over a background by eq. 8.20."""
    stroke = node.find("stroke")
    width = number(stroke, "width", 10.0)
    intensity = number(stroke, "intensity", 1.0)
    ridge = None if stroke is None else stroke.find("ridge")
    fill = None if stroke is None else stroke.find("fill")
    if away > width / 2:
        return intensity * background
    grating = None if fill is None else fill.find("Grating")
    has_grating = switch(grating, "enable", False)
    cut = 1.0 if has_grating else 0.0
    edge = number(ridge, "edge_width", 1.0)
    if switch(fill, "gutter", False):
        cut = shape(away, width - 2 * edge, edge) if width >= 4 * edge else 1.0
    motion = None if stroke is None else stroke.find("motion")
    value = 1.0
    if has_grating:
        if word(motion, "cue", "none") == "inherent":
            along -= number(motion, "velocity", 50.0) * now.time_s
        elif motion is None and grating.find("velocity") is not None:
            along -= number(grating, "velocity", 0.0) * now.time_s
        still = Now(now.sign, 0.0)
        value = wave(fill, along, still, 2.0)
    felt = vibrated(fill, 1 - value * cut, now)
    if marker is not None:
        share, marked = marker
        felt = (1 - share) * felt + share * marked
    up = profile(ridge, away, width, 1.0)
    return intensity * ((1 - up) * background + up * felt)


def filling(node, from_edge, place, now, inside):
    """What is inside a closed shape, beyond its stroke's inner edge."""
    fill = node.find("fill_texture")
    if not inside or not switch(fill, "enable", False):
        return 0.0
    value = pattern(fill.find("Pattern"), place, now)
    gap = number(fill, "gap", 0.0)
    if gap < 0:
        return value
    fade = number(fill, "edge_size", 1.0)
    return max(0.0, min(1.0, (from_edge - gap) / fade)) * value


# Shapes


def distance_to_line(node, place):
    start, end = point(node, "start_point", (0.0, 0.0)), point(node, "end_point", SURFACE)
    return to_segment(place, start, end)


def to_segment(place, start, end):
    """Distance to a segment, and how far along it, beyond its ends too: eqs. 8.15 to 8.17."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    length = math.hypot(dx, dy)
    u = ((place[0] - start[0]) * dx + (place[1] - start[1]) * dy) / length**2
    held = min(max(u, 0.0), 1.0)
    near = (start[0] + held * dx, start[1] + held * dy)
    return math.dist(place, near), u * length


def line(node, place, now):
    away, along = distance_to_line(node, place)
    if has_dots(node):
        start, end = point(node, "start_point", (0.0, 0.0)), point(node, "end_point", SURFACE)
        return dotted(node, place, 0.0, away, segment_dots(node, start, end), now)
    return stroked(node, away, along, 0.0, now)


def distance_to_circle(node, place):
    center, radius = point(node, "center", (0.0, 0.0)), number(node, "radius", 100.0)
    x, y = place[0] - center[0], place[1] - center[1]
    away = math.hypot(x, y)
    return abs(away - radius), radius * (math.atan2(y, x) % (2 * math.pi)), away <= radius


def circle(node, place, now):
    away, along, inside = distance_to_circle(node, place)
    width = number(node.find("stroke"), "width", 10.0)
    background = filling(node, away - width / 2, place, now, inside)
    if has_dots(node):
        center, radius = point(node, "center", (0.0, 0.0)), number(node, "radius", 100.0)
        count = math.floor(math.pi / math.asin(apart(node) / (2 * radius)))
        turns = [2 * math.pi * i / count for i in range(count)]
        places = [
            (center[0] + radius * math.cos(a), center[1] + radius * math.sin(a)) for a in turns
        ]
        return dotted(node, place, background, away, places, now)
    return stroked(node, away, along, background, now)


def apart(node):
    """Least distance between two dots of a row."""
    stroke = node.find("stroke")
    return number(stroke, "width", 10.0) + number(stroke.find("dots"), "min_spacing", 1.0)


def segment_dots(node, start, end):
    length = math.dist(start, end)
    count = math.floor(length / apart(node)) + 1
    return [
        (start[0] + (end[0] - start[0]) * i / (count - 1),
         start[1] + (end[1] - start[1]) * i / (count - 1))
        for i in range(count)
    ]  # fmt: skip


def has_dots(node):
    stroke = node.find("stroke")
    return switch(None if stroke is None else stroke.find("dots"), "enable", False)


def dotted(node, place, background, away, places, now):
    stroke = node.find("stroke")
    width = number(stroke, "width", 10.0)
    if away > width / 2:
        return number(stroke, "intensity", 1.0) * background
    row = stroke.find("dots")
    total = 0.0
    for at in places:
        far = math.dist(place, at)
        if far < width / 2:
            total += profile(stroke.find("ridge"), far, width, 1.0)
    total = min(1.0, total * number(row, "height", 1.0))
    total = vibrated(stroke.find("fill"), total, now)
    return number(stroke, "intensity", 1.0) * (total or background)


def dots(node, place, now):
    radius = number(node, "dot_radius", 100.0)
    total = 0.0
    for at in node.findall("dot"):
        far = math.dist(place, read_point(at.text))
        if far < radius:
            total += profile(node.find("ridge"), far, 2 * radius, 0.2)
        if node.get("type") == "Dot":
            break
    return vibrated(node, min(1.0, total * number(node, "height", 1.0)), now)


# Polygons


def polygon(node, place, now):
    vertices = [read_point(vertex.text) for vertex in node.find("vertices")]
    join = node.find("join")
    rounded = word(join, "type", "round") == "round"
    width = number(node.find("stroke"), "width", 10.0)
    reach = width / 2 + number(join, "rounding_offset", 0.0)
    joints = [Joint(vertices, i, reach) for i in range(len(vertices))]
    away, along, edge = along_polygon(vertices, joints, place, rounded)
    background = filling(node, away - width / 2, place, now, is_inside(vertices, place))
    marker = None
    corner = node.find("corner")
    if has_dots(node):
        swaps = switch(corner, "enable", False)
        return dotted_polygon(node, vertices, place, background, away, now, swaps)
    if switch(corner, "enable", False):
        marker = marked(corner, vertices, width / 2, place, away, edge, now)
    return stroked(node, away, along, background, now, marker)


def dotted_polygon(node, vertices, place, background, away, now, swaps):
    """Dots along each edge, farther apart beside a sharp corner; first those on the corners."""
    stroke = node.find("stroke")
    width = number(stroke, "width", 10.0)
    intensity = number(stroke, "intensity", 1.0)
    vibration = stroke.find("fill").find("vibration")
    swings = vibration is not None and switch(vibration, "enable", True)
    angles = [Joint(vertices, i, width).angle for i in range(len(vertices))]
    total = 0.0
    for i, start in enumerate(vertices):
        end = vertices[(i + 1) % len(vertices)]
        sharp = [a for a in (angles[i], angles[(i + 1) % len(vertices)]) if a < math.pi / 2]
        least = apart(node) / min([1.0, *map(math.sin, sharp)])
        count = math.floor(math.dist(start, end) / least + 1)
        for j in range(count - 1):
            share = j / (count - 1)
            at = (
                start[0] + (end[0] - start[0]) * share,
                start[1] + (end[1] - start[1]) * share,
            )
            far = math.dist(place, at)
            if far < width / 2:
                shown = swings != (swaps and j == 0)
                up = profile(stroke.find("ridge"), far, width, 1.0)
                total += up * (gain(vibration, now) if shown else 1.0)
    total = min(1.0, total * number(stroke.find("dots"), "height", 1.0))
    return intensity * (background if away > width / 2 else total or background)


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
