"""Reads a tactile picture back from what the fingertip was given: frames, and poses.

It knows the device, as a hand knows its own skin: how far apart the actuators are, and in which of
two phases each vibrates; and, as a reader does, at which distances braille has its dots. Of scenes,
patterns and programs it knows nothing. Shapes are taken to be outlined, to be larger than a cell,
and what fills them not to touch their outlines; shapes stand apart by more than the ridges of a
grating do.
"""

from dataclasses import dataclass, field

import numpy as np
from scipy import ndimage
from scipy.optimize import minimize
from scipy.spatial import ConvexHull

STEP_MM = 0.25  # of the map that is made of what was felt
_UP = 0.5  # what is felt as up
_STRIPES_MM = 2.6  # half of the largest gap in what belongs together
_BESIDE_MM = 16.0  # between what is felt of two cells of one text
_CORE = 0.6  # share of a dot's radius within which it is looked for
_DOT_UP = 0.2  # share of that which is up where there is a dot, which may have a texture
_NARROW_MM = 6.0  # nothing wider is a line
_MARGIN_MM = 3.2  # from the inner edge of an outline to where a fill is whole
_SLIGHT = 0.05
_LONGEST_MM, _SHORTEST_MM = 16.0, 1.5
_MOST_HZ = 60.0
_MOST_SAMPLES = 3000
_HALF = 0.5


@dataclass(frozen=True)
class Felt:
    """Samples of all actuators, one after the other: float64[n] each."""

    x_mm: np.ndarray
    y_mm: np.ndarray
    time_s: np.ndarray
    phase: np.ndarray  # +1 or -1
    value: np.ndarray

    def some(self, which):
        return Felt(*(each[which] for each in vars(self).values()))


@dataclass(frozen=True)
class FoundTexture:
    """What is inside a shape: "empty", "plain", "grating" or "vibration"."""

    kind: str
    wavelength_mm: float = 0.0
    direction_deg: float = 0.0  # of the wave, 0 to 180, from +x towards +y
    frequency_hz: float = 0.0


@dataclass(frozen=True)
class FoundShape:
    """A shape by the middle of its outline.

    ``size_mm`` is the radius of a circle, the side of a square, and the length of a line.
    """

    shape: str  # "circle", "square", "triangle" or "line"
    center_mm: tuple[float, float]
    size_mm: float
    direction_deg: float = 0.0  # of a line, 0 to 180
    vertices_mm: np.ndarray = field(default_factory=lambda: np.empty((0, 2)))
    texture: FoundTexture = FoundTexture("empty")


@dataclass(frozen=True)
class FoundText:
    """Cells of braille, as Unicode has them, and the middle of the first one's upper left dot."""

    cells: str
    place_mm: tuple[float, float]


def felt(time_s, x_mm, y_mm, theta_rad, frames, column_pitch_mm, row_pitch_mm):
    """Samples of a path: where each actuator was, and how far it was pushed."""
    count, rows, columns = frames.shape
    right = (np.arange(columns) - (columns - 1) / 2) * column_pitch_mm
    down = ((np.arange(rows) - (rows - 1) / 2) * row_pitch_mm)[:, None]
    cosine, sine = np.cos(theta_rad)[:, None, None], np.sin(theta_rad)[:, None, None]
    x = x_mm[:, None, None] + right * cosine + down * sine
    y = y_mm[:, None, None] + down * cosine - right * sine
    phase = np.where(np.add.outer(np.arange(rows), np.arange(columns)) % 2, -1.0, 1.0)
    shape = (count, rows, columns)
    return Felt(
        x.ravel(),
        y.ravel(),
        np.broadcast_to(time_s[:, None, None], shape).ravel(),
        np.broadcast_to(phase, shape).ravel(),
        frames.reshape(-1).astype(np.float64),
    )


@dataclass(frozen=True)
class Spacing:
    """Distances at which a reader reads braille."""

    dot_width_mm: float
    dot_spacing_mm: float
    row_spacing_mm: float
    cell_pitch_mm: float

    def has_room_for(self, region):
        """Whether all of a region can be within one cell."""
        width, height = (STEP_MM * (1 + np.ptp(at)) for at in np.nonzero(region)[::-1])
        wide_mm = self.dot_spacing_mm + self.dot_width_mm
        high_mm = 2 * self.row_spacing_mm + self.dot_width_mm
        return width < wide_mm + 1 and height < high_mm + 1


def decode(samples, spacing):
    """Shapes and texts that were felt."""
    surface = _Surface(samples)
    shapes, cells = [], []
    numbered, count = ndimage.label(_closed(surface.up, _STRIPES_MM))
    for number in range(1, count + 1):
        region = numbered == number
        if spacing.has_room_for(region):
            cells.append(np.column_stack(surface.place(*np.nonzero(region & surface.up))))
        else:
            pieces, _ = ndimage.label(surface.up & region)
            around = [np.ptp(rows) * np.ptp(columns) for rows, columns in _spans(pieces)]
            outline = pieces == 1 + int(np.argmax(around))
            shapes.append(_shape(surface, ndimage.binary_fill_holes(region), outline, samples))
    return shapes, [_read(np.concatenate(text), surface, spacing) for text in _texts(cells)]


class _Surface:
    """A map of what was felt: the largest deflection around each place of a grid."""

    def __init__(self, samples):
        self.left_mm, self.top_mm = samples.x_mm.min(), samples.y_mm.min()
        width = 1 + int((samples.x_mm.max() - self.left_mm) / STEP_MM)
        height = 1 + int((samples.y_mm.max() - self.top_mm) / STEP_MM)
        self.shape = (height, width)
        row, column = self.bins(samples)
        highest = np.full(self.shape, -1.0)
        np.maximum.at(highest, (row, column), samples.value)
        missed = highest < 0
        nearest = ndimage.distance_transform_edt(
            missed, return_distances=False, return_indices=True
        )
        self.up = highest[tuple(nearest)] > _UP

    def bins(self, samples):
        """Row and column of the grid for each sample."""
        row = ((samples.y_mm - self.top_mm) / STEP_MM).astype(int)
        return row, ((samples.x_mm - self.left_mm) / STEP_MM).astype(int)

    def share_up(self, x_mm, y_mm, radius_mm):
        """Share of a disc that is up."""
        rows, columns = np.indices(self.shape)
        x, y = self.place(rows, columns)
        return self.up[np.hypot(x - x_mm, y - y_mm) < radius_mm].mean()

    def place(self, row, column):
        """Where the middle of a square of the grid is: x, y."""
        x = self.left_mm + (column + _HALF) * STEP_MM
        return x, self.top_mm + (row + _HALF) * STEP_MM


def _spans(pieces):
    """First and last row and column of each piece."""
    for rows, columns in ndimage.find_objects(pieces):
        yield (rows.start, rows.stop), (columns.start, columns.stop)


def _closed(up, reach_mm):
    """Everything that is up, and what lies between within a reach."""
    border = int(reach_mm / STEP_MM) + 2
    padded = np.pad(up, border)
    grown = ndimage.distance_transform_edt(~padded) * STEP_MM <= reach_mm
    back = ndimage.distance_transform_edt(grown) * STEP_MM > reach_mm
    return (back | padded)[border:-border, border:-border]


def _shape(surface, solid, outline, samples):
    half_mm = _half_width(outline)
    area_mm2 = solid.sum() * STEP_MM**2
    rows, columns = np.nonzero(solid)
    center = surface.place(rows.mean(), columns.mean())
    points = np.column_stack(surface.place(rows, columns))
    hull = points[ConvexHull(points).vertices]
    middle, sides, direction_deg = _smallest_rectangle(hull)
    if min(sides) < _NARROW_MM:
        length_mm = max(sides) - 2 * half_mm
        return FoundShape("line", middle, length_mm, direction_deg)
    texture = _texture(_inside(surface, solid, samples, 2 * half_mm + _MARGIN_MM))
    share = area_mm2 / (sides[0] * sides[1])
    if share > 0.9:
        side_mm = sum(sides) / 2 - 2 * half_mm
        return FoundShape("square", center, side_mm, texture=texture)
    if share > 0.66:
        radius_mm = np.sqrt(area_mm2 / np.pi) - half_mm
        return FoundShape("circle", center, radius_mm, texture=texture)
    tips = _largest_triangle(hull)
    inward = np.array(tips.mean(axis=0)) - tips
    tips = tips + half_mm * inward / np.hypot(*inward.T)[:, None]
    side_mm = np.mean(np.hypot(*(tips - np.roll(tips, 1, axis=0)).T))
    return FoundShape("triangle", tuple(tips.mean(axis=0)), side_mm, 0.0, tips, texture)


def _half_width(outline):
    """Half of how wide an outline is felt to be: the middle of it is so far from its edges."""
    depth = ndimage.distance_transform_edt(np.pad(outline, 1))
    ridge = (depth > 0) & (depth == ndimage.maximum_filter(depth, 3))
    return (np.median(depth[ridge]) - _HALF) * STEP_MM + STEP_MM / 4


def _smallest_rectangle(hull):
    """Middle, sides and direction of the longer one: of the smallest rectangle round a hull."""
    best = None
    for edge in np.roll(hull, -1, axis=0) - hull:
        along = edge / np.hypot(*edge)
        turned = hull @ np.array([[along[0], -along[1]], [along[1], along[0]]])
        low, high = turned.min(axis=0), turned.max(axis=0)
        sides = high - low + STEP_MM
        if best is None or sides.prod() < best[0]:
            middle = (low + high) / 2
            back = np.array([[along[0], along[1]], [-along[1], along[0]]])
            angle = np.degrees(np.arctan2(along[1], along[0]))
            longer = angle if sides[0] >= sides[1] else angle + 90.0
            best = sides.prod(), tuple(middle @ back), tuple(sides), longer % 180.0
    return best[1:]


def _largest_triangle(hull):
    """The three points of a hull that make the largest triangle."""
    first, second, third = np.meshgrid(*[np.arange(len(hull))] * 3, indexing="ij", sparse=True)
    one, two = hull[second] - hull[first], hull[third] - hull[first]
    area = np.abs(one[..., 0] * two[..., 1] - one[..., 1] * two[..., 0])
    return hull[list(np.unravel_index(np.argmax(area), area.shape))]


def _inside(surface, solid, samples, margin_mm):
    deep = ndimage.distance_transform_edt(np.pad(solid, 1))[1:-1, 1:-1] * STEP_MM > margin_mm
    return samples.some(deep[surface.bins(samples)])


def _texture(inside):
    if inside.value.size == 0 or inside.value.max() < _SLIGHT:
        return FoundTexture("empty")
    if inside.value.std() < _SLIGHT:
        return FoundTexture("plain")
    frequency_hz, shaken = _vibration(inside)
    if shaken > _HALF:
        return FoundTexture("vibration", frequency_hz=frequency_hz)
    wavelength_mm, direction_deg, waved = _grating(inside)
    if waved > _HALF:
        return FoundTexture("grating", wavelength_mm, direction_deg)
    return FoundTexture("unknown")


def _vibration(inside):
    """Frequency of what neighbours do against each other, and its share of all that changes."""
    swing = (inside.value - inside.value.mean()) * inside.phase
    times, tick = np.unique(inside.time_s, return_inverse=True)
    sums = np.bincount(tick, swing)
    counts = np.bincount(tick)

    def share(frequencies):
        wave = np.exp(-2j * np.pi * np.outer(frequencies, times))
        return 2 * np.abs(wave @ sums) ** 2 / (counts.sum() * (swing**2).sum())

    step_hz = 1 / (4 * np.ptp(times))
    coarse = np.arange(0.5, _MOST_HZ, step_hz)
    roughly = share(coarse)
    # A hand that comes by at even times leaves several frequencies that fit nearly as well.
    near = coarse[roughly > 0.8 * roughly.max()]
    fine = np.unique(np.add.outer(near, step_hz * np.linspace(-0.5, 0.5, 21)))
    found = share(fine)
    return float(fine[np.argmax(found)]), float(found.max())


def _grating(inside):
    """Wavelength and direction of a wave, and its share of all that changes."""
    if inside.value.size > _MOST_SAMPLES:
        every = np.random.default_rng(1).permutation(inside.value.size)[:_MOST_SAMPLES]
        inside = inside.some(np.sort(every))
    x, y = inside.x_mm - inside.x_mm.mean(), inside.y_mm - inside.y_mm.mean()
    value = inside.value - inside.value.mean()
    step = 1 / (4 * max(np.ptp(x), np.ptp(y)))
    most = 1 / _SHORTEST_MM
    across, down = np.arange(-most, most, step), np.arange(0.0, most, step)
    east = np.exp(-2j * np.pi * np.outer(x, across))
    south = np.exp(-2j * np.pi * np.outer(down, y))
    size = np.hypot(across, down[:, None])
    fits = (size > 1 / _LONGEST_MM) & (size < most)
    strength = np.where(fits, np.abs((south * value) @ east), 0.0)
    at_down, at_across = np.unravel_index(np.argmax(strength), strength.shape)
    best = np.array((across[at_across], down[at_down]))

    def missed(wave):
        angle = 2 * np.pi * (wave[0] * x + wave[1] * y)
        basis = np.column_stack((np.ones_like(x), np.cos(angle), np.sin(angle)))
        left = value - basis @ np.linalg.lstsq(basis, value, rcond=None)[0]
        return (left**2).sum() / (value**2).sum()

    simplex = best + step / 2 * np.array([[0, 0], [1, 0], [0, 1]])
    found = minimize(missed, best, method="Nelder-Mead", options={"initial_simplex": simplex})
    direction_deg = np.degrees(np.arctan2(found.x[1], found.x[0])) % 180.0
    return float(1 / np.hypot(*found.x)), float(direction_deg), 1.0 - float(found.fun)


def _texts(cells):
    """Cells, or parts of them, that stand together, text by text."""
    middles = [cell.mean(axis=0) for cell in cells]
    left = list(range(len(cells)))
    while left:
        text, fringe = [], [left.pop(0)]
        while fringe:
            one = fringe.pop()
            text.append(one)
            near = [
                other for other in left if np.hypot(*(middles[other] - middles[one])) < _BESIDE_MM
            ]
            left = [other for other in left if other not in near]
            fringe += near
        yield [cells[one] for one in text]


def _read(points, surface, spacing):
    """Read a line of braille, whose first cell has a dot on the left, and one of whose is high."""
    radius_mm = spacing.dot_width_mm / 2
    start, top = points.min(axis=0) - STEP_MM / 2 + radius_mm
    text = ""
    while start + len(text) * spacing.cell_pitch_mm < points[:, 0].max():
        mask = 0
        for dot in range(6):
            x = start + len(text) * spacing.cell_pitch_mm + dot // 3 * spacing.dot_spacing_mm
            y = top + dot % 3 * spacing.row_spacing_mm
            if surface.share_up(x, y, _CORE * radius_mm) > _DOT_UP:
                mask |= 1 << dot
        text += chr(0x2800 + mask)
    return FoundText(text, (float(start), float(top)))
