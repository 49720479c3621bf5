"""Pictures of OpenLatero's scenes: where they stand, how large, and what of them counts."""

import math

import numpy as np
import pytest
from PIL import Image as Pillow

from tests.render.scene.twin import deflections
from tests.scene.openlatero.files import scene, texture
from vbraille.render.labels import Assets
from vbraille.scene.images import load_bitmaps
from vbraille.scene.openlatero import read_gen
from vbraille.scene.patterns import Image, UniformVibration

WIDE, HIGH = 289.9, 230.1875


@pytest.fixture
def folder(tmp_path):
    Pillow.new("L", (400, 100), 255).save(tmp_path / "wide.png")
    Pillow.new("L", (100, 200), 255).save(tmp_path / "high.png")
    Pillow.new("RGB", (10, 10), (200, 10, 10)).save(tmp_path / "red.png")
    clear = Pillow.new("RGBA", (10, 10), (255, 255, 255, 255))
    clear.putpixel((3, 3), (255, 255, 255, 0))
    clear.save(tmp_path / "clear.png")
    (tmp_path / "drawing.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="4cm" height="20mm"><rect width="9"/></svg>'
    )
    return tmp_path


def image(mask, part=None):
    vibration = texture("Vibration") if part is None else part
    return f'<Pattern type="Image">{vibration}<mask>{mask}</mask></Pattern>'


def read(folder, mask, part=None, **settings):
    (folder / "old.gen").write_text(scene(image(mask, part)))
    found = read_gen(folder / "old.gen", **settings)
    return (found.scene.elements or (None,))[0], "\n".join(found.warnings)


# What stands in the mask beside the name, and place and size that follow.
PLACED = {
    "all as usual": ("wide", "", (0, (HIGH - WIDE / 4) / 2), (WIDE, WIDE / 4)),
    "a high one": ("high", "", ((WIDE - HIGH / 2) / 2, 0), (HIGH / 2, HIGH)),
    "shares of the largest": (
        "wide",
        '<position>centered</position><width units="%">0.5</width><height units="%">0.5</height>',
        (WIDE / 4, (HIGH - WIDE / 8) / 2),
        (WIDE / 2, WIDE / 8),
    ),
    "shares of the surface": (
        "wide",
        "<reference_maximized>no</reference_maximized>"
        '<width units="%">0.5</width><height units="%">0.25</height>',
        (WIDE / 4, HIGH * 3 / 8),
        (WIDE / 2, HIGH / 4),
    ),
    "mm": (
        "wide",
        '<position units="mm">10,20.5</position><width units="mm">80</width>'
        '<height units="mm">20</height><lock_aspect_ratio>yes</lock_aspect_ratio>',
        (10, 20.5),
        (80, 20),
    ),
    "a width alone": (
        "wide", '<width units="mm">80</width>', ((WIDE - 80) / 2, (HIGH - WIDE / 4) / 2),
        (80, WIDE / 4),
    ),
    "a drawing": ("drawing", "", (0, (HIGH - WIDE / 2) / 2), (WIDE, WIDE / 2)),
}  # fmt: skip


@pytest.mark.parametrize("name", PLACED)
def test_pictures_stand_where_they_stood(folder, name):
    file, mask, place, size = PLACED[name]
    ending = "svg" if file == "drawing" else "png"
    made, _ = read(folder, f"<imgfile>{file}.{ending}</imgfile>{mask}")
    assert isinstance(made, Image)
    assert made.place_mm == pytest.approx(place, abs=1e-6)
    assert (made.width_mm, made.height_mm) == pytest.approx(size, abs=1e-6)
    assert made.texture == UniformVibration()


def test_a_blur_of_two_pixels_is_of_so_many_mm(folder):
    made, said = read(folder, "<imgfile>wide.png</imgfile><blur>yes</blur>")
    assert made.blur_mm == pytest.approx(2 * WIDE / 400, abs=1e-6)
    assert "its blur is of 2 pixels of the picture" in said


def test_a_plain_texture_makes_it_a_plain_map(folder):
    made, _ = read(folder, "<imgfile>wide.png</imgfile>", texture("Plain"))
    assert made.texture is None
    weak = texture("Plain", "<amplitude>0.5</amplitude>")
    made, _ = read(folder, "<imgfile>wide.png</imgfile>", weak)
    assert made.texture.amplitude == 0.5


def test_alpha_is_the_mask_where_the_file_says_so(folder):
    made, said = read(folder, '<imgfile type="alpha">clear.png</imgfile>')
    assert made.channel == "alpha"
    assert "red" not in said
    made, said = read(folder, '<imgfile type="alpha">wide.png</imgfile>')
    assert made is None
    assert "its picture is left out: wide.png has no alpha" in said


def test_pixels_are_said_to_count_otherwise_unless_as_shown(folder):
    _, said = read(folder, '<imgfile type="gray">wide.png</imgfile>')
    assert "bilinear" in said
    _, said = read(folder, '<imgfile type="gray">wide.png</imgfile>', as_shown=True)
    assert said == ""


def test_a_picture_that_openlatero_lost_is_found_beside_the_scene(folder):
    made, said = read(folder, "<imgfile>/wide.png</imgfile>")
    assert made.file == "wide.png"
    assert "/wide.png is not there, and wide.png beside this file is taken" in said


def test_a_picture_that_is_none_is_left_out(folder):
    (folder / "bad.png").write_bytes(b"no picture")
    made, said = read(folder, "<imgfile>bad.png</imgfile>")
    assert made is None
    assert "line 8, Image: its picture is left out: bad.png is no PNG" in said


def test_a_shape_through_a_mask_is_as_the_file_says(folder):
    made, said = read(folder, "<imgfile>wide.png</imgfile>", '<Pattern type="Circle"/>')
    assert made.texture is not None
    assert "it is the mask of a Circle, as the file says" in said


def shown(folder, text, x, y):
    """What is felt of a scene as OpenLatero shows it, with the deflections of its picture."""
    (folder / "old.gen").write_text(text)
    found = read_gen(folder / "old.gen", as_shown=True).scene
    return deflections(found, Assets(bitmaps=load_bitmaps(found, folder)), x, y)


PIXELS = image(
    "<imgfile>spots.png</imgfile><position>12.5,30.25</position>"
    '<width units="mm">3.2</width><height units="mm">4</height>{}',
    texture("Plain"),
)


@pytest.mark.parametrize("outside", [0.0, 0.4])
def test_the_nearest_pixel_counts_as_shown_and_hides_five_pixels_around_it(folder, outside):
    rng = np.random.default_rng(8)
    shades = rng.integers(1, 256, (40, 64)) * (rng.random((40, 64)) < 0.02)
    Pillow.fromarray(shades.astype(np.uint8)).save(folder / "spots.png")
    spots = PIXELS.format(f"<default_alpha>{outside}</default_alpha>")
    # More pixels than are felt, and places beyond them.
    x, y = rng.uniform(12, 16.5, 900), rng.uniform(29.5, 35, 900)
    row, column = (np.floor((y - 30.25) * 10).astype(int), np.floor((x - 12.5) * 20).astype(int))
    within = (row >= 0) & (row < 40) & (column >= 0) & (column < 64)
    row, column = np.clip(row, 0, 39), np.clip(column, 0, 63)
    up = np.where(within, shades[row, column] / 255, outside)
    np.testing.assert_allclose(shown(folder, scene(spots), x, y), up, atol=2e-4)
    hiding = np.zeros(shades.shape)
    for above, left in np.argwhere(shades > 0):
        for i in range(max(above - 5, 0), min(above + 5, 40)):
            for j in range(max(left - 5, 0), min(left + 5, 64)):
                share = max(0.0, 1 - np.hypot(i - above, j - left) / 5)
                hiding[i, j] = max(hiding[i, j], int(255 * share) / 255)
    mask = np.where(within, hiding[row, column], outside)
    whole = texture("Plain", "<amplitude>0.5</amplitude>")
    over = shown(folder, scene(whole, spots, operation="<operation>overwrite</operation>"), x, y)
    np.testing.assert_allclose(over, np.minimum(up + (1 - mask) * 0.5, 1), atol=2e-4)


def blurred(shades, *, up):
    """What ImageMagick 6.9 makes of `-blur 4x2`, pixel by pixel: measured from its own pictures."""
    weights = [
        sum(math.exp(-((3 * n + third) ** 2) / 72) for third in (-1, 0, 1)) for n in range(-4, 5)
    ]
    made = shades * 257.0
    for _ in range(2):  # along, and then down
        columns = made.shape[1]
        made = np.rint(
            sum(
                weight * made[:, np.clip(np.arange(columns) + n, 0, columns - 1)]
                for n, weight in zip(range(-4, 5), weights, strict=True)
            )
            / sum(weights)
        ).T
    return (np.ceil if up else np.floor)(made / 257)


@pytest.mark.parametrize("channel", ["gray", "alpha"])
def test_a_blur_as_shown_is_of_pixels(folder, channel):
    rng = np.random.default_rng(9)
    shades = rng.integers(0, 256, (30, 50)).astype(np.uint8)
    whole = np.full_like(shades, 255)
    picture = shades if channel == "gray" else np.stack([whole, whole, whole, shades], axis=-1)
    Pillow.fromarray(picture).save(folder / "spots.png")
    text = scene(
        image(
            f'<imgfile type="{channel}">spots.png</imgfile><blur>yes</blur>'
            '<position>12.5,30.25</position><width units="mm">25</width>'
            '<height units="mm">20</height>',
            texture("Plain"),
        )
    )
    row, column = np.indices(shades.shape)
    x, y = 12.5 + (column.ravel() + 0.3) / 2, 30.25 + (row.ravel() + 0.6) / 1.5
    felt = shown(folder, text, x, y).reshape(shades.shape)
    np.testing.assert_allclose(felt, blurred(shades, up=channel == "alpha") / 255, atol=2e-4)


def test_blurred_pixels_are_those_of_imagemagick():
    """A row of the picture that its version 6.9.11 makes of a single white pixel."""
    spot = np.zeros((31, 31))
    spot[15, 15] = 255
    assert blurred(spot, up=False)[15, 10:21].tolist() == [0, 1, 3, 6, 9, 10, 9, 6, 3, 1, 0]
