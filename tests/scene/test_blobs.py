"""Dots of images: where they stand, and how large and high they are."""

import math

import numpy as np
import pytest
from PIL import Image as Pillow

from vbraille.errors import InputError
from vbraille.scene.images import dots_of
from vbraille.scene.patterns import Dots, DotStyle, Group, ImageDots, Vibration
from vbraille.scene.reading import resolve
from vbraille.scene.scene import Canvas, Scene


def saved(folder, values):
    Pillow.fromarray(np.asarray(values, np.uint8)).save(folder / "a.png")


def discs(*places, shape=(200, 400)):
    """Discs of (x, y, radius, gray) in pixels."""
    y, x = np.mgrid[: shape[0], : shape[1]] + 0.5
    values = np.zeros(shape)
    for cx, cy, radius, gray in places:
        values[np.hypot(x - cx, y - cy) <= radius] = gray
    return values


def test_a_blob_is_a_dot_at_its_middle_with_its_area_and_its_gray(tmp_path):
    saved(tmp_path, discs((100, 50, 30, 255), (300, 120, 20, 102)))
    found = dots_of(ImageDots(file="a.png", place_mm=(10, 20), width_mm=40), tmp_path)
    assert isinstance(found, Group)
    assert found.operation == "maximum"
    small, large = found.parts
    np.testing.assert_allclose(large.centers_mm, [(20, 25)], atol=1e-6)
    np.testing.assert_allclose(small.centers_mm, [(40, 32)], atol=1e-6)
    assert large.dot.radius_mm == pytest.approx(3, abs=0.02)
    assert small.dot.radius_mm == pytest.approx(2, abs=0.02)
    assert (large.dot.amplitude, small.dot.amplitude) == (1.0, pytest.approx(0.4))
    assert large.dot.plateau == 0.25


def test_the_middle_is_weighed_by_gray_and_corners_touch(tmp_path):
    values = np.zeros((10, 10))
    values[2, 2], values[3, 3] = 200, 100
    saved(tmp_path, values)
    found = dots_of(ImageDots(file="a.png", width_mm=10), tmp_path)
    assert isinstance(found, Dots)
    np.testing.assert_allclose(found.centers_mm, [(2.5 + 1 / 3, 2.5 + 1 / 3)], atol=1e-9)
    assert found.dot.radius_mm == pytest.approx(math.sqrt(2 / math.pi), abs=0.005)


def test_dots_of_a_given_radius_are_one_pattern_that_keeps_what_the_element_says(tmp_path):
    saved(tmp_path, discs((50, 50, 9, 255), (300, 120, 20, 255)))
    vibration = Vibration(frequency_hz=25)
    pattern = ImageDots(
        file="a.png",
        id="stars",
        title="Stars",
        width_mm=40,
        by_area=False,
        dot=DotStyle(radius_mm=1.5, edge_mm=0.5, amplitude=0.5),
        vibration=vibration,
    )
    found = dots_of(pattern, tmp_path)
    assert isinstance(found, Dots)
    assert (found.id, found.title, found.vibration) == ("stars", "Stars", vibration)
    assert found.dot == DotStyle(radius_mm=1.5, edge_mm=0.5, amplitude=0.5)
    assert len(found.centers_mm) == 2
    scene = Scene(canvas=Canvas(width_mm=50, height_mm=50), elements=(pattern,))
    assert resolve(scene, tmp_path).elements == (found,)


def test_the_threshold_parts_what_is_bright(tmp_path):
    saved(tmp_path, np.array([[0, 255, 100, 255, 0]]))
    pattern = ImageDots(file="a.png", width_mm=5)
    assert isinstance(dots_of(pattern, tmp_path), Dots)
    apart = dots_of(ImageDots(file="a.png", width_mm=5, threshold=0.5), tmp_path)
    assert len(apart.centers_mm) == 2


def test_the_early_grid_has_94_by_33_dots(tmp_path):
    values = np.full((120, 226), 255)
    values[:, :113] = 51
    saved(tmp_path, values)
    grid = ImageDots(file="a.png", width_mm=113, height_mm=60, cell_mm=(1.2, 1.8))
    left, right = dots_of(grid, tmp_path).parts
    assert len(left.centers_mm) == len(right.centers_mm) == 94 // 2 * 33
    assert left.dot.radius_mm == right.dot.radius_mm == 0.6
    assert (left.dot.amplitude, right.dot.amplitude) == (pytest.approx(0.2), 1)
    xs, ys = (sorted(set(np.round(of, 6))) for of in zip(*right.centers_mm, strict=True))
    np.testing.assert_allclose((xs[-1], ys[0], ys[-1]), (93.5 * 1.2, 0.9, 32.5 * 1.8))
    assert len(ys) == 33


BAD = {
    "nothing in its image is above": (np.zeros((5, 5)), {}),
    "smaller than a cell": (np.ones((5, 5)), {"cell_mm": (50.0, 50.0)}),
    "has 22500 blobs": (np.tile([[255, 0], [0, 0]], (150, 150)), {}),
    "has centers, number 1, x is 10020 mm": (
        np.full((9, 9), 255),
        {"place_mm": (10_000.0, 0.0)},
    ),
    "there is no file": (np.ones((9, 9)), {"file": "none.png"}),
}


@pytest.mark.parametrize("said", BAD)
def test_what_cannot_be_dots_is_said_in_one_sentence(tmp_path, said):
    values, changes = BAD[said]
    saved(tmp_path, values)
    pattern = ImageDots(**{"id": "stars", "file": "a.png", "width_mm": 40.0} | changes)
    with pytest.raises(InputError) as refused:
        dots_of(pattern, tmp_path)
    assert str(refused.value).startswith("element stars")
    assert said in str(refused.value)
