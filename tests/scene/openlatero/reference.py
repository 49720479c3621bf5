"""What OpenLatero shows, in plain float64: its files read and its equations restated by themselves.

It shares nothing with what it tests. Pictures are not in it.
"""

import math
from xml.etree import ElementTree

from tests.scene.openlatero.referencepolygons import (
    Joint,
    along_polygon,
    is_inside,
    marked,
    to_segment,
)
from tests.scene.openlatero.referencevalues import (
    Now,
    gain,
    number,
    point,
    profile,
    read_point,
    ridged,
    shape,
    switch,
    vibrated,
    word,
)

SURFACE = (289.9, 230.1875)


def deflections(text, places, sign=1.0, time_s=0.0, velocity=(0.0, 0.0), center=(0.0, 0.0)):
    """Deflections of a scene or texture at places, under a hand that has moved so for long."""
    root = ElementTree.fromstring(text)
    generator = root.find("Generator")
    top = (root if generator is None else generator).find("Pattern")
    now = Now(sign, time_s, velocity, center)
    return [min(1.0, pattern(top, place, now)) for place in places]


def pattern(node, place, now):
    kind = node.get("type")
    if kind == "Group":
        parts = node.findall("Pattern")
        values = [pattern(part, place, now) for part in parts]
        if operation(node) == "reactive":
            return blended(node.find("operation/Modulator"), values, now)
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


# Operators and reaction, section 5


def blended(modulator, values, now):
    k = modulation(modulator, now)
    return k * values[0] + (1 - k) * values[1]


def modulation(node, now):
    """Eqs. 9.6 and 9.8-9.10; a toggle is high at first, until its value reaches 0."""
    speed = math.hypot(*now.velocity)
    if node.get("type") == "Velocity":
        return fallen(speed, number(node, "limit", 5.0), number(node, "transition", 5.0))
    slow = fallen(
        speed, number(node, "velocity_tolerance", 0.0), number(node, "velocity_transition", 5.0)
    )
    way = math.degrees(math.atan2(now.velocity[1], now.velocity[0]))
    away = abs((way - number(node, "direction", 0.0) + 180) % 360 - 180)
    if switch(node, "symmetric", False) and away > 90:
        away = 180 - away
    tolerance = number(node, "direction_tolerance", 30.0)
    alpha = fallen(away, tolerance, number(node, "direction_transition", 20.0))
    mode = word(node, "low_velocity_mode", "toggle")
    return min(alpha, 1 - slow) if mode == "low" else max(alpha, slow)


def fallen(value, limit, transition):
    if value < limit:
        return 1.0
    return max(0.0, (limit + transition - value) / transition)


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


def covered(node):
    """Width of what a stroke hides, which is that of its cue if it has one."""
    width = number(node.find("stroke"), "width", 10.0)
    motion = node.find("stroke/motion")
    if word(motion, "cue", "none") in ("none", "inherent"):
        return width
    return max(width, number(motion, "min_width", 10.0))


def mask(node, place):
    """Opacity of shapes and groups, which is all that the files here overwrite with."""
    kind = node.get("type")
    if kind == "Group":
        masks = [mask(part, place) for part in node.findall("Pattern")]
        name = operation(node)
        together = {"multiply": math.prod, "add": sum}.get(name, max)
        return min(1.0, together(masks))
    stroke = node.find("stroke")
    width = covered(node)
    edge = number(None if stroke is None else stroke.find("ridge"), "edge_width", 1.0)
    if kind == "Line":
        return shape(to_segment(place, *ends_of(node))[0], width, edge)
    if kind == "Circle":
        away, inside = distance_to_circle(node, place)[::2]
        if inside and switch(node.find("fill_texture"), "enable", False):
            return 1.0
        return shape(away, width, edge)
    if kind == "Polygon":
        vertices = [read_point(vertex.text) for vertex in node.find("vertices")]
        if is_inside(vertices, place) and switch(node.find("fill_texture"), "enable", False):
            return 1.0
        joints = [Joint(vertices, i, width / 2) for i in range(len(vertices))]
        return shape(along_polygon(vertices, joints, place, False)[0], width, edge)
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
        x -= speed * (now.travelled(speed, cycle))
    value = ridged(x, ridge, gap)
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
    if node.find("td_centric") is not None:
        at = point(node, "td_centric", (0.0, 0.0))
        place = tuple(place[n] - now.center[n] + at[n] for n in (0, 1))
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
    if kind == "Blend":
        values = [pattern(part, place, now) for part in node.findall("Pattern")]
        return blended(node.find("Modulator"), values, now)
    if kind == "Motion":
        return under_bands(node, pattern(node.find("Pattern"), place, now), place, now)
    assert kind == "Pattern"
    wide, high = number(node, "grid_width", 20.0), number(node, "grid_height", 20.0)
    return pattern(node.find("Pattern"), (place[0] % wide, place[1] % high), now)


def under_bands(node, value, place, now):
    """A texture under bands that move as though the array stood at 0, 0."""
    cue = word(node, "cue_type", "none")
    if cue == "none":
        return value
    ridge = 5.0 if "vibration" in cue else 2.0
    way, speed = math.radians(number(node, "direction", 0.0)), number(node, "velocity", 50.0)
    x, y = (place[n] - now.center[n] for n in (0, 1))
    along = x * math.cos(way) + y * math.sin(way) - speed * now.travelled(speed, ridge + 30.0)
    band = ridged(along, ridge, 30.0)
    if cue == "vibration bands":
        return (1 - band) * value + band * now.swing(50.0)
    if cue == "blending bands":
        return (1 - band) * value + band * 0.5
    if cue == "disabling bands":
        return value * (1 - band)
    return min(1.0, value + 0.2 * band)


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
        value = ridged(along, ridge * times, gap * times)
        values.append(value * number(node, f"{name}_amplitude", 1.0))
    return group(node, values, list)


# Strokes, section 3


def superposed(node, value, away, along, now, length=None, profiled=True):
    """A value under the moving bands of a stroke, as wide as it is or as the least width says."""
    stroke = node.find("stroke")
    motion = stroke.find("motion")
    cue = word(motion, "cue", "none")
    if cue in ("none", "inherent"):
        return value
    width = number(stroke, "width", 10.0)
    wide = max(width, number(motion, "min_width", 10.0))
    share = number(motion, "superposed_ratio", 0.2) if cue == "superposed" else 0.0
    up = 1.0
    if away > wide / 2:
        return (1 - share) * value
    if profiled:
        up = shape(away, wide, number(stroke.find("ridge"), "edge_width", 1.0))
        if width < wide and length is not None and not 0 <= along <= length:
            past = abs(along - length / 2) - length / 2
            up *= max(0.0, 1 - past / (width / 2))
        if up <= 0:
            return value
    grating = motion.find("Grating")
    ridge, gap = number(grating, "ridge_size", 2.0), number(grating, "gap_size", 30.0)
    speed = number(grating, "velocity", number(motion, "velocity", 50.0))
    band = up * ridged(along - speed * now.travelled(speed, ridge + gap), ridge, gap)
    vibration = motion.find("vibration")
    swings = vibration is not None and switch(vibration, "enable", True)
    left = gain(vibration, now) if swings else 1.0
    if cue == "superposed":
        return (1 - share) * value + share * left * band
    if cue == "suppressed":
        return value * (1 - left * band)
    to = left if cue == "vibration" else number(motion, "blend_value", 0.5)
    return (1 - band) * value + band * to


def is_cue_wider(node):
    stroke = node.find("stroke")
    least = number(None if stroke is None else stroke.find("motion"), "min_width", 10.0)
    return number(stroke, "width", 10.0) < least


def stroked(node, away, along, background, now, marker=None, length=None):
    """A shape: eqs. 8.7 to 8.14, over a background by eq. 8.20, and its cue."""
    stroke = node.find("stroke")
    if stroke is None or stroke.find("motion") is None:
        return plainly_stroked(node, away, along, background, now, marker)
    intensity, width = number(stroke, "intensity", 1.0), number(stroke, "width", 10.0)
    if away > width / 2:
        return intensity * superposed(
            node, background, away, along, now, length, is_cue_wider(node)
        )
    if is_cue_wider(node):
        value = plainly_stroked(node, away, along, background, now, marker)
        return intensity * superposed(node, value / intensity, away, along, now, length)

    def under(texture):
        return superposed(node, texture, away, along, now, length, profiled=False)

    return plainly_stroked(node, away, along, background, now, marker, under)


def plainly_stroked(node, away, along, background, now, marker=None, under=None):
    """A shape: eqs. 8.7 to 8.14, over a background by eq. 8.20; its texture may be under a cue."""
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
    if under is not None:
        felt = under(felt)
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


def ends_of(node):
    return point(node, "start_point", (0.0, 0.0)), point(node, "end_point", SURFACE)


def line(node, place, now):
    start, end = ends_of(node)
    away, along = to_segment(place, start, end)
    if has_dots(node):
        places = segment_dots(node, start, end)
        seen = sliding(places, place, node, now)
        value = dotted(node, 0.0, away, places, now, seen)
        return superposed(node, value, away, along, now, math.dist(places[0], places[-1]))
    return stroked(node, away, along, 0.0, now, length=math.dist(start, end))


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
        seen = turning(center, radius, place, node, now)
        value = dotted(node, background, away, places, now, (seen, 1.0))
        return superposed(node, value, away, along, now)
    return stroked(node, away, along, background, now)


def moves(node):
    """Speed of the dots of a stroke, which move by an inherent cue."""
    motion = node.find("stroke/motion")
    return number(motion, "velocity", 50.0) if word(motion, "cue", "none") == "inherent" else 0.0


def turning(center, radius, place, node, now):
    """Where the dots of a circle are looked at: they turn once in whole microseconds."""
    speed = moves(node)
    if not speed:
        return place
    length = 2 * math.pi * radius
    turn = -now.travelled(speed, length) * math.copysign(1e6 * length, speed)
    turn *= 2 * math.pi / length / (math.floor(1e6 * length / abs(speed)))
    x, y = place[0] - center[0], place[1] - center[1]
    cosine, sine = math.cos(turn), math.sin(turn)
    return center[0] + x * cosine - y * sine, center[1] + y * cosine + x * sine


def sliding(places, place, node, now):
    """Where the dots of a line are looked at, and the share of it that is shown.

    The line is wrapped half a spacing before its first and after its last dot.
    """
    speed = moves(node)
    if not speed:
        return place, 1.0
    spacing = math.dist(places[0], places[1])
    radius = number(node.find("stroke"), "width", 10.0) / 2
    ends, free = (places[0], places[-1]), spacing / 2 - radius
    return slid(ends, spacing / 2, (free, free), radius, speed, place, now) or (place, 0.0)


def slid(ends, more, free, radius, speed, place, now):
    """Where dots are looked at that slide along a line, and their share; None beyond them.

    The line is longer by ``more`` at both ends, and of that nothing is shown as far as ``free``.
    """
    (ax, ay), (bx, by) = ends
    length = math.dist(*ends)
    ux, uy = (bx - ax) / length, (by - ay) / length
    across = abs((place[1] - ay) * ux - (place[0] - ax) * uy)
    at, whole = to_segment(place, *ends)[1] + more, length + 2 * more
    if not 0 <= at <= whole or across > radius:
        return None
    share = min(at - free[0], whole - free[1] - at)
    at = (whole + at - speed * now.travelled(speed, whole)) % whole - more
    return (ax + ux * at + uy * across, ay + uy * at - ux * across), min(max(share, 0.0), 1.0)


def sliding_edge(start, end, spaces, cuts, radius, speed, place, now):
    """The same on an edge of a polygon, whose corners' dots stay; None beyond its own dots."""
    if spaces < 2:
        return None
    half = math.dist(start, end) / spaces / 2
    free = [max(0.0, cut - half) for cut in cuts]
    return slid((start, end), -half, free, radius, speed, place, now)


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


def dotted(node, background, away, places, now, seen):
    stroke = node.find("stroke")
    width = number(stroke, "width", 10.0)
    if away > width / 2:
        return number(stroke, "intensity", 1.0) * background
    row = stroke.find("dots")
    total = 0.0
    looked_at, share = seen
    for at in places:
        far = math.dist(looked_at, at)
        if far < width / 2:
            total += profile(stroke.find("ridge"), far, width, 1.0)
    total = share * min(1.0, total * number(row, "height", 1.0))
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
    motion = node.find("stroke/motion")
    wide = width
    if word(motion, "cue", "none") not in ("none", "inherent"):
        wide = max(width, number(motion, "min_width", 10.0))
    reach = wide / 2 + number(join, "rounding_offset", 0.0)
    joints = [Joint(vertices, i, reach) for i in range(len(vertices))]
    away, along, edge = along_polygon(vertices, joints, place, rounded)
    background = filling(node, away - width / 2, place, now, is_inside(vertices, place))
    marker = None
    corner = node.find("corner")
    if has_dots(node):
        swaps = switch(corner, "enable", False)
        value = dotted_polygon(node, vertices, place, background, away, now, swaps)
        return superposed(node, value, away, along, now)
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
    total, seen = 0.0, (place, 1.0)
    for i, start in enumerate(vertices):
        if not moves(node):
            break
        end = vertices[(i + 1) % len(vertices)]
        both = angles[i], angles[(i + 1) % len(vertices)]
        least = apart(node) / min([1.0, *(math.sin(a) for a in both if a < math.pi / 2)])
        spaces = math.floor(math.dist(start, end) / least)
        cuts = [width / 2 / math.tan(a / 2) for a in both]
        found = sliding_edge(start, end, spaces, cuts, width / 2, moves(node), place, now)
        if found is not None:
            seen = found
            break
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
            far = math.dist(seen[0], at)
            if far < width / 2:
                shown = swings != (swaps and j == 0)
                up = profile(stroke.find("ridge"), far, width, 1.0)
                total += up * (gain(vibration, now) if shown else 1.0)
    total = seen[1] * min(1.0, total * number(stroke.find("dots"), "height", 1.0))
    return intensity * (background if away > width / 2 else total or background)
