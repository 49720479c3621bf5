"""What pictures of tests need beside themselves, where the array is, and what is shown there."""

import math
import zlib
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from tests.render.scene import twin as reference
from tests.render.scene.twinsignals import SIGNALS
from vbraille.display import Display
from vbraille.render import STRESS2_8X8
from vbraille.render.compiling import compile_scene
from vbraille.render.labels import Assets, Written
from vbraille.scene.bitmap import WHOLE, Bitmap
from vbraille.scene.patterns import Image, Label
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.traversal import each, moved

SIDE_MM = 60
STRESS2_8X8_ARRAY = STRESS2_8X8.display
DISPLAYS = (STRESS2_8X8_ARRAY, Display("wide", 6, 10, 1.2, 1.8))


def scene_of(*elements, operation="overwrite", side_mm=SIDE_MM):
    """A scene of these elements, with the signals that they may use."""
    canvas = Canvas(width_mm=side_mm, height_mm=side_mm)
    return Scene(canvas=canvas, operation=operation, elements=elements, signals=SIGNALS)


# What needs something beside itself


def bitmap_of(image):
    """The picture that stands for a file in these tests: pixels by its name alone."""
    rng = np.random.default_rng(zlib.crc32(image.file.encode()))
    rows, columns = (1, 1) if image.file == "one.png" else (7, 11)
    gray = {
        "blank.png": np.zeros((rows, columns)),
        "whole.png": np.ones((rows, columns)),
        "sparse.png": rng.uniform(size=(rows, columns)) * (rng.uniform(size=(rows, columns)) > 0.8),
    }.get(image.file, rng.uniform(size=(rows, columns)))
    pixels = np.round(gray * WHOLE).astype(np.uint16)
    size = image.width_mm, image.height_mm
    return Bitmap(pixels, image.place_mm, *size, image.outside, image.nearest)


def written_of(label):
    """Cells that stand for a label in these tests: a line for each of its words."""
    words = (np.frombuffer(word.encode(), np.uint8) & 63 for word in label.text.split())
    return Written(tuple(words), STRESS2_8X8.style)


def assets_of(*parts):
    """What patterns need beside themselves."""
    found = list(each(*parts))
    return Assets(
        {part: bitmap_of(part) for part in found if isinstance(part, Image)},
        {part: written_of(part) for part in found if isinstance(part, Label)},
    )


def known_boxes(assets):
    """Boxes of the images and labels in assets."""
    return assets.boxes()


# Poses


@dataclass(frozen=True)
class At:
    """Where the array is, when."""

    x_mm: float
    y_mm: float
    theta_rad: float
    time_s: float


def poses(rng, count):
    """Places all over the canvas and beside it, at any angle and any time up to hours."""
    x, y = rng.uniform(-12, SIDE_MM + 12, (2, count))
    theta = rng.uniform(-math.pi, math.pi, count) * (rng.uniform(size=count) > 0.3)
    time = rng.uniform(0, 1, count) * rng.choice([0.0, 1.0, 1e4], count)
    return [At(*map(float, pose)) for pose in zip(x, y, theta, time, strict=True)]


def actuators(display, pose):
    """Places of the actuators, and their parities, as `vbraille.display` says; row by row."""
    right, down = np.meshgrid(display.column_offsets_mm(), display.row_offsets_mm())
    right, down = right - right.mean(), down - down.mean()
    cosine, sine = math.cos(pose.theta_rad), math.sin(pose.theta_rad)
    x = pose.x_mm + right * cosine + down * sine
    y = pose.y_mm + down * cosine - right * sine
    row, column = np.indices(display.shape)
    return x.ravel(), y.ravel(), ((row + column) % 2).ravel()


def twin(scene, display, pose, assets=None):
    """The frame of a scene in plain numpy."""
    x, y, parity = actuators(display, pose)
    assets = assets_of(*scene.elements) if assets is None else assets
    return reference.deflections(scene, assets, x, y, parity, pose.time_s).reshape(display.shape)


@lru_cache(maxsize=8)
def _compiled(elements, operation, side_mm, display):
    scene = scene_of(*elements, operation=operation, side_mm=side_mm)
    return compile_scene(scene, display, assets_of(*elements))


def shown(scene, display, pose):
    """The frame of a scene by the kernels, which has to be the twin's, too."""
    program = _compiled(scene.elements, scene.operation, scene.canvas.width_mm, display)
    frame = np.full(display.shape, np.nan)
    at = {"y_mm": pose.y_mm, "theta_rad": pose.theta_rad, "time_s": pose.time_s}
    program.frame(pose.x_mm, frame, **at)
    np.testing.assert_allclose(frame, twin(scene, display, pose), rtol=0, atol=1e-6)
    return frame


_ONE = Display("one", 1, 1, 1.0, 1.0)
_ASIDE_MM = 100.0  # patterns are moved by, so that all that they are asked for is on the canvas


def felt(pattern, x_mm, y_mm=0.0, time_s=0.0):
    """Deflections that the kernels give one actuator at places."""
    scene = scene_of(moved(pattern, (_ASIDE_MM, _ASIDE_MM)), side_mm=2000)
    program, out = compile_scene(scene, _ONE), np.empty((1, 1))
    found = []
    for x, y in np.broadcast(x_mm, y_mm):
        program.frame(x + _ASIDE_MM, out, y_mm=y + _ASIDE_MM, time_s=time_s)
        found.append(out[0, 0])
    return np.array(found)
