"""Drawings in SVG as images: shape, place and channel, and that none can keep the machine busy."""

import numpy as np
import pytest

from tests.tiers import heavy
from vbraille.errors import InputError
from vbraille.scene.images import dots_of, load_bitmaps
from vbraille.scene.patterns import Image, ImageDots
from vbraille.scene.scene import Canvas, Scene

NS = 'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"'


@pytest.fixture
def load(tmp_path):
    """Load a drawing as the bitmap of an image."""

    def loading(inside, head='width="20mm" height="10mm" viewBox="0 0 20 10"', **image):
        (tmp_path / "plan.svg").write_text(f"<svg {NS} {head}>{inside}</svg>")
        one = Image(file="plan.svg", **image)
        scene = Scene(canvas=Canvas(width_mm=99, height_mm=99), elements=(one,))
        return load_bitmaps(scene, tmp_path)[one]

    return loading


def test_a_drawing_has_ten_pixels_a_millimetre_and_its_own_size(load):
    bitmap = load('<rect x="5" y="2" width="0.104166667in" height="4"/>', channel="alpha")
    assert (bitmap.width_mm, bitmap.height_mm) == pytest.approx((20, 10))
    assert bitmap.intensities.shape == (100, 200)
    wanted = np.zeros((100, 200), np.uint16)
    wanted[20:60, 50:150] = 65_535
    np.testing.assert_array_equal(bitmap.intensities, wanted)


def test_a_drawing_is_scaled_and_stretched_as_the_image_says(load):
    circle = '<circle cx="10" cy="5" r="5" fill="white"/>'
    wide = load(circle, width_mm=8)
    assert (wide.height_mm, wide.intensities.shape) == (4, (40, 80))
    tall = load(circle, "width='20' height='10'", width_mm=5, height_mm=10)
    assert tall.intensities.shape == (100, 50)
    lit = tall.intensities > 32_000
    assert lit[50].sum() == pytest.approx(25, abs=2)
    assert lit[:, 25].sum() == pytest.approx(100, abs=2)


def test_what_svg_scenes_ignore_is_drawn_here(load):
    gradient = '<linearGradient id="g"><stop/><stop offset="1" stop-color="#fff"/></linearGradient>'
    row = load(f'{gradient}<rect width="20" height="10" fill="url(#g)"/>').intensities[50]
    np.testing.assert_allclose(row / 65_535, (np.arange(200) + 0.5) / 200, atol=0.01)


@pytest.mark.parametrize(
    "inside",
    [
        '<image width="20" height="10" href="file:///pictures/a.png"/>',
        '<image width="20" height="10" xlink:href="data:image/png;base64,iVBORw0KGgo="/>',
        '<text y="9" font-size="9">wide</text>',
        '<use href="http://localhost/a.svg#b"/>',
        "<script>1</script>",
    ],
)
def test_texts_and_images_and_what_stands_elsewhere_are_left_out(load, inside):
    bitmap = load(inside + '<rect width="1" height="1"/>', channel="alpha")
    assert np.count_nonzero(bitmap.intensities) == 100


def test_blobs_of_a_drawing(tmp_path):
    (tmp_path / "a.svg").write_text(
        f'<svg {NS} width="20mm" height="10mm" viewBox="0 0 20 10">'
        '<circle cx="4" cy="5" r="2" fill="#fff"/><circle cx="14" cy="5" r="2" fill="#fff"/></svg>'
    )
    found = dots_of(ImageDots(file="a.svg", threshold=0.5), tmp_path)
    np.testing.assert_allclose(found.centers_mm, [(4, 5), (14, 5)], atol=0.01)
    assert found.dot.radius_mm == pytest.approx(2, abs=0.02)


@pytest.mark.parametrize(
    ("inside", "head", "said"),
    [
        ("", "", "has no size"),
        ("<g>", 'width="5" height="5"', "not well-formed"),
        ("", 'width="5" height="5" viewBox="0 0 1e308 1e308"', ""),
    ],
)
def test_bad_drawings_are_said_with_the_elements_name(load, inside, head, said):
    if not said:
        assert not load(inside, head).intensities.any()
        return
    with pytest.raises(InputError, match=rf"^element a: .*plan.svg.*{said}"):
        load(inside, head, id="a")


@heavy  # it takes the ten seconds that a drawing may take
def test_a_drawing_that_takes_for_ever_is_given_up(load):
    masks = '<mask id="m0"><rect width="20" height="10" fill="#fff"/></mask>' + "".join(
        f'<mask id="m{n + 1}">'
        + f'<rect width="20" height="10" fill="#fff" mask="url(#m{n})"/>' * 30
        + "</mask>"
        for n in range(8)
    )
    with pytest.raises(InputError, match=r"takes longer than 10 s|more memory"):
        load(f'{masks}<rect width="20" height="10" mask="url(#m8)"/>')
