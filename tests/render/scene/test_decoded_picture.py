"""A picture that was drawn is told again from frames and poses alone, as a finger felt them."""

import math
from dataclasses import dataclass

import numpy as np
import pytest

from tests.engine.planar import Bench
from tests.render.scene.decoding import Spacing, decode, felt
from tests.render.scenes import JIT
from tests.tiers import by_tier
from vbraille.engine.record import Flag
from vbraille.labelling import write_labels
from vbraille.render import LATERO, STRESS2_8X8
from vbraille.render.compiling import compile_scene
from vbraille.render.labels import Assets
from vbraille.scene.patterns import Circle, Fill, Label, Polygon, StraightLine
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.strokes import Stroke
from vbraille.scene.textures import LinearGrating, Uniform, UniformVibration

SPEED_MM_S = 200.0
ROOM_MM = 48.0  # for each shape
STROKE = Stroke(width_mm=3.0, edge_mm=1.0)
WORDS = ("cafe", "bridge", "pond", "lake", "path", "moon", "house")
# Uncontracted English, from a reader's primer.
LETTERS = dict(zip("abcdefghijklmnop", "⠁⠃⠉⠙⠑⠋⠛⠓⠊⠚⠅⠇⠍⠝⠕⠏", strict=True)) | {
    "r": "⠗",
    "s": "⠎",
    "t": "⠞",
    "u": "⠥",
}


@dataclass(frozen=True)
class Drawn:
    """What a shape was drawn as, in the words of what is found."""

    shape: str
    center_mm: tuple[float, float]
    size_mm: float
    direction_deg: float
    kind: str
    wave_mm: float
    wave_deg: float
    frequency_hz: float


def drawn(rng, center_mm):
    """A random shape around a place, and the pattern that is to be felt as it."""
    x, y = center_mm = tuple((np.asarray(center_mm) + rng.uniform(-1, 1, 2)).tolist())
    shape = rng.choice(["circle", "square", "triangle", "line"])
    kind = "empty" if shape == "line" else rng.choice(["empty", "plain", "grating", "vibration"])
    wave_mm, wave_deg = rng.uniform(2.5, 5.0), rng.uniform(0, 180)
    frequency_hz, turned_deg = rng.uniform(8, 50), rng.uniform(0, 180)
    texture = {
        "empty": None,
        "plain": Uniform(level=0.8),
        "grating": LinearGrating(ridge_mm=wave_mm, wave_angle_deg=wave_deg),
        "vibration": UniformVibration(frequency_hz=frequency_hz),
    }[kind]
    look = {"stroke": STROKE}
    if texture is not None:
        look["fill"] = Fill(texture=texture, gap_mm=1.0)

    def corners(count, radius_mm):
        angles = [math.radians(turned_deg) + 2 * math.pi * n / count for n in range(count)]
        return tuple((x + radius_mm * math.cos(a), y + radius_mm * math.sin(a)) for a in angles)

    if shape == "circle":
        size_mm = rng.uniform(12, 17)
        pattern = Circle(center_mm=center_mm, radius_mm=size_mm, **look)
    elif shape == "square":
        size_mm = rng.uniform(22, 25)
        pattern = Polygon(vertices_mm=corners(4, size_mm / math.sqrt(2)), **look)
    elif shape == "triangle":
        size_mm = rng.uniform(31, 33)
        pattern = Polygon(vertices_mm=corners(3, size_mm / math.sqrt(3)), **look)
    else:
        size_mm = rng.uniform(20, 32)
        start, end = corners(2, size_mm / 2)
        pattern = StraightLine(start_mm=start, end_mm=end, **look)
    about = Drawn(shape, center_mm, size_mm, turned_deg, kind, wave_mm, wave_deg, frequency_hz)
    return about, pattern


def picture(rng, across, down):
    """A random scene of shapes in rows, with a word below them; and what was drawn."""
    middles = [
        (ROOM_MM * (column + 0.5) + 2, ROOM_MM * (row + 0.5))
        for row in range(down)
        for column in range(across)
    ]
    shapes = [drawn(rng, middle) for middle in middles]
    word = str(rng.choice(WORDS))
    place_mm = (rng.uniform(5, 30), ROOM_MM * down + rng.uniform(2, 4))
    label = Label(text=word, place_mm=place_mm, table="en-ueb-g1.ctb")
    canvas = Canvas(width_mm=ROOM_MM * across + 4, height_mm=ROOM_MM * down + 16)
    elements = (*(pattern for _, pattern in shapes), label)
    return Scene(canvas=canvas, elements=elements), [about for about, _ in shapes], label


def over(canvas):
    """A way over all of a canvas, to and fro, by a hand that trembles and turns a little."""
    rows = math.ceil(canvas.height_mm / 3.5)
    x_mm, y_mm = np.empty(0), np.empty(0)
    for row in range(rows):
        to_mm = np.arange(-6, canvas.width_mm + 6, SPEED_MM_S / 1000)
        x_mm = np.concatenate((x_mm, to_mm[:: -1 if row % 2 else 1]))
        y_mm = np.append(y_mm, np.full(to_mm.size, row * canvas.height_mm / (rows - 1)))
    t_s = np.arange(x_mm.size) / 1000

    def place(seconds):
        at = min(int(seconds * 1000), x_mm.size - 1)
        trembling_mm = 1.1 * math.sin(2 * math.pi * 1.7 * seconds)
        return x_mm[at], y_mm[at] + trembling_mm, 0.15 * math.sin(2 * math.pi * 0.6 * seconds)

    return place, t_s[-1]


def feel(model, scene, assets):
    """Have the engine show a scene under a hand that goes over it; what the finger was given."""
    display = model.display
    place, seconds = over(scene.canvas)
    bench = Bench(place, display)
    bench.engine.show(compile_scene(scene, display, assets), 1)
    bench.run(seconds)
    ticks = bench.records
    shown = ticks[(ticks["share"] == 1) & (ticks["flags"] & Flag.RESTING == 0)]
    return felt(
        shown["time_ns"] / 1e9,
        shown["x_mm"],
        shown["y_mm"],
        shown["theta_rad"],
        shown["frame"],
        display.column_pitch_mm,
        display.row_pitch_mm,
    )


def apart_deg(one, other, turn):
    """Difference of two directions that are the same after such a turn."""
    return abs((one - other + turn / 2) % turn - turn / 2)


@pytest.mark.no_cover
@pytest.mark.parametrize("seed", range(by_tier(1, 8, 40) if JIT else 1))
def test_a_picture_is_told_from_frames_and_poses_alone(seed):
    rng = np.random.default_rng(seed)
    model = (STRESS2_8X8, LATERO)[seed % 2]
    scene, shapes, label = picture(rng, *by_tier((3, 1), (3, 2), (4, 3)))
    written = write_labels(scene, model.style)
    samples = feel(model, scene, Assets({}, written))
    geometry = model.style.geometry
    spacing = Spacing(
        geometry.dot_width_mm,
        geometry.dot_spacing_mm,
        geometry.row_spacing_mm,
        geometry.cell_pitch_mm,
    )
    found, texts = decode(samples, spacing)

    (text,) = texts
    assert text.cells == "".join(LETTERS[letter] for letter in label.text)
    corner_mm = np.asarray(text.place_mm) - geometry.dot_width_mm / 2
    assert np.hypot(*(corner_mm - label.place_mm)) < 1.0

    assert len(found) == len(shapes)
    for about in shapes:
        one = min(found, key=lambda each: math.dist(each.center_mm, about.center_mm))
        assert math.dist(one.center_mm, about.center_mm) < 1.0
        assert one.shape == about.shape
        assert one.size_mm == pytest.approx(about.size_mm, abs=1.0)
        if about.shape == "line":
            assert apart_deg(one.direction_deg, about.direction_deg, 180) < 5
        assert one.texture.kind == about.kind
        if about.kind == "grating":
            assert one.texture.wavelength_mm == pytest.approx(about.wave_mm, rel=0.05)
            assert apart_deg(one.texture.direction_deg, about.wave_deg, 180) < 5
        if about.kind == "vibration":
            assert one.texture.frequency_hz == pytest.approx(about.frequency_hz, abs=0.3)
