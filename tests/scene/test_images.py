"""Images of scenes: what their pixels become, and that no file costs much or says little."""

import os
import re
import struct
import zlib
from math import erf

import numpy as np
import pytest
from PIL import Image as Pillow

from tests.tiers import heavy
from vbraille.errors import InputError
from vbraille.scene.images import load_bitmaps
from vbraille.scene.patterns import Circle, Fill, Group, Image, Tile, Uniform
from vbraille.scene.scene import Canvas, Scene

CANVAS = Canvas(width_mm=100, height_mm=100)


def loaded(folder, *images):
    bitmaps = load_bitmaps(Scene(canvas=CANVAS, elements=images), folder)
    return [bitmaps[image] for image in images]


def saved(path, values, mode=None, **options):
    Pillow.fromarray(np.array(values, np.uint8), mode).save(path, **options)
    return path


def chunk(kind, content):
    return (
        struct.pack(">I", len(content))
        + kind
        + content
        + struct.pack(">I", zlib.crc32(kind + content))
    )


def png(columns, rows, *chunks, depth=8, color=0):
    """A PNG by its specification, not by Pillow."""
    header = struct.pack(">IIBBBBB", columns, rows, depth, color, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + b"".join((chunk(b"IHDR", header), *chunks, chunk(b"IEND", b"")))


@pytest.mark.parametrize("name", ["a.png", "a.gif", "a.bmp"])
def test_white_is_up_in_each_kind_of_file(tmp_path, name):
    saved(tmp_path / name, [[0, 51, 255]])
    (bitmap,) = loaded(tmp_path, Image(file=name, place_mm=(5, 6), width_mm=3))
    assert bitmap.intensities.tolist() == [[0, 51 * 257, 65535]]
    assert (bitmap.place_mm, bitmap.width_mm, bitmap.height_mm) == ((5, 6), 3, 1)


def test_a_jpeg_is_about_the_same_and_turned_as_its_exif_says(tmp_path):
    values = np.zeros((16, 32), np.uint8)
    values[:, :16] = 255
    exif = Pillow.Exif()
    exif[0x0112] = 6  # to be turned a quarter to the right: what is left becomes the top
    saved(tmp_path / "a.jpg", values, exif=exif)
    (bitmap,) = loaded(tmp_path, Image(file="a.jpg", width_mm=16))
    assert bitmap.intensities.shape == (32, 16)
    assert bitmap.height_mm == 32
    assert bitmap.intensities[:14].min() > 60_000
    assert bitmap.intensities[18:].max() < 5_000


def test_colours_count_by_luminance_over_black(tmp_path):
    colours = [(255, 0, 0, 255), (0, 255, 0, 255), (0, 0, 255, 255), (255, 255, 255, 51)]
    saved(tmp_path / "a.png", [colours])
    gray, alpha = loaded(
        tmp_path,
        Image(file="a.png", width_mm=4),
        Image(file="a.png", width_mm=4, channel="alpha"),
    )
    wanted = np.array([[0.299, 0.587, 0.114, 0.2]])
    np.testing.assert_allclose(gray.intensities / 65535, wanted, atol=1 / 255)
    np.testing.assert_allclose(alpha.intensities / 65535, [[1, 1, 1, 0.2]], atol=1e-6)


def test_sixteen_bits_are_kept(tmp_path):
    row = b"\x00" + struct.pack(">HHH", 0, 12_345, 65_535)
    (tmp_path / "a.png").write_bytes(png(3, 1, chunk(b"IDAT", zlib.compress(row)), depth=16))
    (bitmap,) = loaded(tmp_path, Image(file="a.png", width_mm=3))
    assert bitmap.intensities.tolist() == [[0, 12_345, 65_535]]


def test_a_moving_gif_counts_by_its_first_picture(tmp_path):
    first, second = (Pillow.new("L", (2, 2), value) for value in (255, 0))
    first.save(tmp_path / "a.gif", save_all=True, append_images=[second])
    (bitmap,) = loaded(tmp_path, Image(file="a.gif", width_mm=2))
    assert bitmap.intensities.min() == 65_535


def test_palettes_with_a_clear_colour_are_clear_there(tmp_path):
    image = Pillow.new("P", (2, 1))
    image.putpalette([255, 255, 255, 255, 255, 255])
    image.putdata([0, 1])
    image.save(tmp_path / "a.png", transparency=1)
    (bitmap,) = loaded(tmp_path, Image(file="a.png", width_mm=2))
    assert bitmap.intensities.tolist() == [[65_535, 0]]


def test_what_is_finer_than_ten_pixels_a_millimetre_is_averaged(tmp_path):
    values = np.tile(np.array([[0, 200]], np.uint8), (100, 50))
    saved(tmp_path / "a.png", values)
    fine, coarse = loaded(
        tmp_path, Image(file="a.png", width_mm=5), Image(file="a.png", width_mm=50)
    )
    assert fine.intensities.shape == (50, 50)
    assert set(np.unique(fine.intensities)) == {100 * 257}
    assert coarse.intensities.shape == (100, 100)


def test_equal_sources_share_their_pixels_and_nested_images_are_found(tmp_path):
    saved(tmp_path / "a.png", [[0, 255]])
    one, two, three = (
        Image(file="a.png", width_mm=2, place_mm=(x, 0), texture=texture)
        for x, texture in ((0, None), (5, Uniform()), (0, Image(file="a.png", width_mm=7)))
    )
    fill = Fill(texture=Tile(width_mm=9, height_mm=9, part=two))
    nested = Group(parts=(Circle(center_mm=(0, 0), radius_mm=5, fill=fill),))
    scene = Scene(canvas=CANVAS, elements=(one, nested, three))
    bitmaps = load_bitmaps(scene, tmp_path)
    assert set(bitmaps) == {one, two, three, three.texture}
    assert bitmaps[one].intensities is bitmaps[two].intensities
    assert bitmaps[two].place_mm == (5, 0)
    assert bitmaps[three.texture].intensities is not bitmaps[one].intensities


def test_inverted_source(tmp_path):
    saved(tmp_path / "a.png", [[0, 255]])
    (bitmap,) = loaded(tmp_path, Image(file="a.png", width_mm=2, inverted_source=True))
    assert bitmap.intensities.tolist() == [[65_535, 0]]


@pytest.mark.parametrize("outside", [0.0, 1.0])
def test_a_blur_is_a_gauss_in_millimetres_that_reaches_beyond_the_edges(tmp_path, outside):
    saved(tmp_path / "a.png", np.full((60, 90), 255 if outside == 0 else 0))
    image = Image(file="a.png", place_mm=(10, 10), width_mm=30, blur_mm=2, outside=outside)
    (bitmap,) = loaded(tmp_path, image)
    rows, columns = bitmap.intensities.shape
    x = bitmap.place_mm[0] + (np.arange(columns) + 0.5) * bitmap.width_mm / columns
    middle = bitmap.intensities[rows // 2] / 65_535
    wanted = [(erf((at - 10) / 8**0.5) - erf((at - 40) / 8**0.5)) / 2 for at in x]
    np.testing.assert_allclose(np.abs(middle - outside), wanted, atol=0.003)
    assert abs(middle[0] - outside) < 0.001
    assert columns < 300


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"width_mm": None}, "has no size; give width_mm or height_mm"),
        ({"width_mm": 10_000.0}, None),
        ({"channel": "alpha"}, "no alpha channel"),
        ({"file": "none.png"}, "there is no file"),
        ({"file": "."}, "is a directory"),
        ({"width_mm": 2.0, "height_mm": 0.1, "blur_mm": 0.5}, "a blur of 0.5 mm"),
    ],
)
def test_what_cannot_be_used_is_said_with_the_elements_name(tmp_path, changes, said):
    saved(tmp_path / "a.png", np.zeros((8, 8)))
    image = Image(**{"id": "harbour", "file": "a.png", "width_mm": 8.0} | changes)
    if said is None:
        assert loaded(tmp_path, image)[0].intensities.shape == (8, 8)
        return
    with pytest.raises(InputError, match=rf"^element harbour.*{re.escape(said)}[^\n]*$"):
        loaded(tmp_path, image)


def as_jpeg(path, format="JPEG", **options):  # noqa: A002 - Pillow's word
    Pillow.effect_noise((64, 64), 50).save(path, format=format, **options)
    return path.read_bytes()


ZEROS = zlib.compress(bytes(3 << 20))
BAD = {
    "declared size": (lambda _: png(100_000, 100_000), "pixels"),
    "larger than a camera's": (lambda _: png(10_000, 10_000), "10000 × 10000 pixels"),
    "text of 3 MB in a few kB": (
        lambda _: png(1, 1, chunk(b"zTXt", b"a\0\0" + ZEROS), chunk(b"IDAT", ZEROS)),
        "damaged",
    ),
    "declared chunk of 2 GB": (
        lambda _: png(1, 1)[:33] + struct.pack(">I", 2**31 - 1) + b"zTXta\0\0",
        "damaged",
    ),
    "no image": (lambda _: b"Once upon a time", "is no PNG"),
    "truncated JPEG": (lambda path: as_jpeg(path)[:-300], "damaged"),
    "another kind": (lambda path: as_jpeg(path, "TIFF"), "is no PNG"),
    "PostScript": (lambda path: as_jpeg(path, "EPS"), "is no PNG"),
    "empty": (lambda _: b"", "is no PNG"),
    "scans": (lambda path: as_jpeg(path)[:-2] + b"\xff\xda\0\x08\1\1\0\0\x3f\0" * 200, "scans"),
}


@pytest.mark.parametrize("kind", BAD)
def test_bad_files_are_one_sentence(tmp_path, kind):
    content, said = BAD[kind]
    path = tmp_path / "bad.png"
    path.write_bytes(content(path))
    with pytest.raises(InputError) as refused:
        loaded(tmp_path, Image(file="bad.png", width_mm=5))
    message = str(refused.value)
    assert message.startswith("image bad.png: ")
    assert said in message
    assert "\n" not in message


def test_files_and_pipes_that_are_no_ordinary_files_are_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "pipe.png")
    with pytest.raises(InputError, match="no ordinary file"):
        loaded(tmp_path, Image(file="pipe.png", width_mm=5))


def test_the_place_of_the_element_is_said_where_it_is_known(tmp_path):
    saved(tmp_path / "a.png", [[0, 255]])
    good, bad = Image(file="a.png", width_mm=5), Image(file="none.png", width_mm=5)
    scene = Scene(canvas=CANVAS, elements=(good, Group(parts=(good, bad))))
    with pytest.raises(InputError, match=r"^my\.scene line 9: image none.png: there is no file "):
        load_bitmaps(scene, tmp_path, ["my.scene line 5", "my.scene line 9"])


@heavy  # it takes reading 72 million pixels
def test_many_large_images_are_refused_together(tmp_path):
    saved(tmp_path / "a.png", np.zeros((3000, 3000)))
    images = [Image(file="a.png", width_mm=300 + n) for n in range(8)]
    with pytest.raises(InputError, match="64 million pixels together"):
        loaded(tmp_path, *images)
