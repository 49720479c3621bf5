"""Values of OpenLatero's files, and what strokes and vibrations are made of, restated."""

import math


class Now:
    """Which actuator it is, as the sign of its vibration, and when."""

    def __init__(self, sign, time_s, velocity=(0.0, 0.0), center=(0.0, 0.0)):
        self.sign = sign
        self.time_s = time_s
        self.velocity = velocity
        self.center = center

    def travelled(self, speed, cycle):
        """Time within a period of ridges, which has whole microseconds."""
        if not speed:
            return 0.0
        return math.fmod(self.time_s, math.floor(1e6 * cycle / abs(speed)) / 1e6)

    def swing(self, hertz):
        """q: what an actuator shows of a vibration."""
        return 0.5 + 0.5 * self.sign * math.sin(2 * math.pi * hertz * self.time_s)


def ridged(x, ridge, gap):
    """A grating, eq. 8.4, that begins with a ridge."""
    u = x % (ridge + gap) / ridge
    return (1 - math.cos(2 * math.pi * u)) / 2 if u <= 1 else 0.0


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
