"""Deflection maps as pages and recordings have them."""

import io

import numpy as np
import pytest
from PIL import Image

from vbraille.pictures.scenes import small_png
from vbraille.render.labels import Assets
from vbraille.scene.patterns import (
    Circle,
    Fill,
    Group,
    LinearGrating,
    RadialGrating,
    Uniform,
)
from vbraille.scene.scene import Canvas, Scene


def drawn(canvas, *elements):
    content = small_png(Scene(canvas=canvas, elements=elements), Assets())
    assert len(content) <= 120_000
    with Image.open(io.BytesIO(content)) as image:
        return np.asarray(image)


def test_a_small_map_has_four_pixels_a_mm_and_black_for_full_swing():
    disc = Circle(center_mm=(20, 15), radius_mm=8, fill=Fill(texture=Uniform(), fade_mm=0))
    pixels = drawn(Canvas(width_mm=40, height_mm=30), disc)
    assert pixels.shape == (120, 160)
    assert (pixels[60, 80], pixels[0, 0]) == (0, 255)


@pytest.mark.parametrize("side_mm", [200, 10_000])
def test_a_map_that_says_little_in_many_bytes_is_coarser(side_mm):
    waves = tuple(RadialGrating(ridge_mm=2.1 + n, center_mm=(37 * n, 11 * n)) for n in range(5))
    fine = Group(operation="blend", parts=waves[:2], by=LinearGrating(ridge_mm=2.3))
    pixels = drawn(Canvas(width_mm=side_mm, height_mm=side_mm), Group(parts=(*waves, fine)))
    assert max(pixels.shape) < 0.9 * 300_000**0.5
