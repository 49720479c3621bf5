"""Rectangles outside which patterns and their masks are 0."""

import numpy as np
import pytest
from hypothesis import given

from tests.render.scene import twin as reference
from tests.render.scene.scenes import examples, patterns, seeds
from tests.render.scene.showing import assets_of, bitmap_of, known_boxes
from vbraille.scene.bitmap import WHOLE, Bitmap, bitmap_box, opaque
from vbraille.scene.geometry import EMPTY, Box, bounds
from vbraille.scene.patterns import (
    Circle,
    Dots,
    DotStyle,
    Dotting,
    Fill,
    Group,
    Image,
    ImageDots,
    PathShape,
    StraightLine,
    Stroke,
    Tile,
    Uniform,
    Use,
)

STROKE = Stroke(width_mm=4)
LINE = StraightLine(start_mm=(10, 20), end_mm=(30, 25), stroke=STROKE)
CIRCLE = Circle(center_mm=(40, 20), radius_mm=5, fill=Fill(texture=Uniform()))


@pytest.mark.parametrize(
    ("pattern", "want"),
    [
        (LINE, Box(8, 18, 32, 27)),
        (CIRCLE, Box(35, 15, 45, 25)),
        (Circle(center_mm=(0, 0), radius_mm=5, dots=Dotting()), Box(-6, -6, 6, 6)),
        (
            PathShape(contours_mm=(((0, 0), (1, 1)), ((9, 3), (4, 4))), stroke=STROKE),
            Box(-2, -2, 11, 6),
        ),
        (Dots(centers_mm=((1, 2), (5, 0)), dot=DotStyle(radius_mm=0.5)), Box(0.5, -0.5, 5.5, 2.5)),
        (Tile(width_mm=4, height_mm=4, part=LINE), None),
        (Group(operation="maximum", parts=(LINE, CIRCLE)), Box(8, 15, 45, 27)),
        (Group(operation="multiply", parts=(LINE, Uniform())), Box(8, 18, 32, 27)),
        (Group(operation="multiply", parts=(LINE, CIRCLE)), EMPTY),
        (Group(operation="add", parts=(LINE, Uniform())), None),
        (Group(operation="blend", parts=(LINE, CIRCLE), by=Uniform()), Box(8, 15, 45, 27)),
    ],
)
def test_a_pattern_is_bounded_by_what_it_is(pattern, want):
    assert bounds(pattern) == want


@pytest.mark.parametrize("pattern", [Use(name="x"), ImageDots(file="x.png")])
def test_what_is_not_resolved_has_no_place(pattern):
    with pytest.raises(TypeError, match="resolved"):
        bounds(pattern)


@examples(90)
@given(patterns, seeds)
def test_outside_its_bounds_a_pattern_and_its_mask_are_nothing(pattern, seed):
    assets = assets_of(pattern)
    box = bounds(pattern, known_boxes(assets))
    if box is None:
        return
    rng = np.random.default_rng(seed)
    x, y = rng.uniform(-40, 100, (2, 600))
    if not box.is_empty:
        # Most places are just beside the box.
        x[:500] = rng.uniform(box.left - 1, box.right + 1, 500)
        y[:500] = rng.uniform(box.top - 1, box.bottom + 1, 500)
    inside = [box.holds(*place) for place in zip(x, y, strict=True)]
    outside = ~np.array(inside)
    x, y = x[outside], y[outside]
    at = reference.places(x, y, 0, 0.3)
    assert not reference.deflection(pattern, assets, at).any()
    assert not reference.mask(pattern, assets, at).any()


def mask_of(gray, width_mm, height_mm, outside=0.0):
    pixels = np.round(np.array(gray, float) * WHOLE).astype(np.uint16)
    return opaque(Bitmap(pixels, (10, 20), width_mm, height_mm, outside))


def test_a_mask_falls_over_five_pixels_around_what_is_up():
    mask = mask_of([[0, 0, 0.01, 0]], 0.4, 0.1)
    assert mask.intensities.shape == (11, 14)
    np.testing.assert_allclose(mask.intensities[5] / WHOLE, [0, 0, *_tent(12)], atol=1e-4)
    np.testing.assert_allclose(mask.intensities[:, 7] / WHOLE, _tent(11), atol=1e-4)
    assert mask.place_mm == pytest.approx((9.5, 19.5))
    assert (mask.width_mm, mask.height_mm) == pytest.approx((1.4, 1.1))


def _tent(count):
    return [max(0.0, 1 - abs(n - 5) / 5) for n in range(count)]


def test_a_mask_of_large_pixels_falls_over_a_millimetre():
    mask = mask_of([[0, 1, 0, 0]], 1.6, 0.4)
    assert mask.intensities.shape == (5, 8)  # two pixels of 0.4 mm
    np.testing.assert_allclose(mask.intensities[2] / WHOLE, [0, 0, 0.5, 1, 0.5, 0, 0, 0], atol=1e-4)
    assert mask_of([[1]], 30, 30).intensities.shape == (3, 3)


def test_an_image_that_is_up_outside_is_everywhere():
    pixels = np.zeros((2, 2), np.uint16)
    assert bitmap_box(Bitmap(pixels, (0, 0), 2, 2, 0.1)) is None
    assert opaque(Bitmap(pixels, (0, 0), 2, 2, 0.1)).outside == 1


def test_an_images_box_is_no_larger_than_its_mask():
    image = Image(file="whole.png", place_mm=(10, 20), width_mm=11, height_mm=7)
    # One pixel of 1 mm for the edge, of which half a pixel is still bilinear beyond its middle.
    assert bitmap_box(bitmap_of(image)) == pytest.approx((9.5, 19.5, 21.5, 27.5))
