"""``vbraille map``: its files, what it says, and what it refuses."""

import base64
import csv
import io
import os
import re
import subprocess
import sys
from xml.etree import ElementTree

import numpy as np
import pytest
from PIL import Image

from tests.tiers import heavy

SCENE = """
title = "A ring"
description = "A ring that vibrates, and ridges."
canvas = { width_mm = 40, height_mm = 30 }

[[elements]]
kind = "linear-grating"
ridge_mm = 4
amplitude = 0.5

[[elements]]
kind = "circle"
id = "ring"
center_mm = [20, 15]
radius_mm = 8
stroke = { width_mm = 4, vibration = { frequency_hz = 25 } }
"""
STILL = 'canvas = { width_mm = 40, height_mm = 30 }\nelements = [{ kind = "uniform", level = 0.5 }]'


@pytest.fixture
def scene(tmp_path):
    """A file of a picture of which one element vibrates."""
    path = tmp_path / "ring.scene"
    path.write_text(SCENE)
    return path


def pixels_of(path):
    with Image.open(path) as image:
        return np.array(image.convert("L"), float)


def test_a_map_has_a_gray_for_each_place_and_words(scene, call, tmp_path):
    out = tmp_path / "ring.png"
    done = call("map", scene, "--out", out)
    assert (done.code, done.err) == (0, "")
    pixels = pixels_of(out)
    assert pixels.shape == (120, 160)
    # eq. 8.4: a ridge of 4 mm begins at the left edge, and is half as high as it could be.
    x_mm = (np.arange(160) + 0.5) / 4
    ridges = 255 * (1 - 0.5 * (0.5 - 0.5 * np.cos(2 * np.pi * x_mm / 4)))
    assert np.abs(pixels[0] - ridges).max() <= 1
    ring = pixels[60, 44:52]  # 7 to 9 mm left of the middle: noise
    assert ring.std() > 20
    with Image.open(out) as image:
        assert image.text["Title"] == "A ring"
        assert "A ring that vibrates" in image.text["Description"]
        assert image.info["dpi"][0] == pytest.approx(4 * 25.4, rel=1e-3)
    lines = done.out.splitlines()
    assert lines[:4] == [
        f"drawn: {out}",
        "shown: a deflection map, rest white, full swing black",
        "pixels: 160 × 120, 4 a mm",
        "vibration: as noise, seed 1",
    ]
    assert "size: 40 × 30 mm" in lines
    assert lines[-1] == "vibrates: element ring, 25 Hz"
    assert "elements: 2, one on top of the other" in lines


def test_a_seed_is_a_picture(scene, call, tmp_path):
    for name, seed in (("a", 1), ("b", 1), ("c", 2)):
        assert call("map", scene, "--out", tmp_path / f"{name}.png", "--seed", seed).code == 0
    a, b, c = ((tmp_path / f"{name}.png").read_bytes() for name in "abc")
    assert a == b
    assert a != c


def test_csv_has_a_row_for_each_pixel(scene, call, tmp_path):
    out = tmp_path / "ring.csv"
    assert call("map", scene, "--out", out, "--resolution", "0.5").code == 0
    rows = list(csv.reader(out.read_text().splitlines()))
    assert rows[0] == ["x_mm", "y_mm", "deflection"]
    assert len(rows) == 1 + 20 * 15
    x, y, deflection = map(float, rows[1])
    assert (x, y) == (1, 1)
    assert deflection == pytest.approx(0.5 * (0.5 - 0.5 * np.cos(2 * np.pi / 4)), abs=1e-6)


SEQUENCE = ("--frames", 4)
# sin 2πft at the quarters of a swing, through δ¹ of an amplitude of 1 (eq. 8.1).
QUARTERS = [127.5, 0, 127.5, 255]


def test_an_animation_swings(scene, call, tmp_path):
    out = tmp_path / "ring.gif"
    done = call("map", scene, "--out", out, *SEQUENCE, "--resolution", 1)
    assert done.code == 0
    assert "maps: 4, 10 ms apart, of one slowest swing of 40 ms" in done.out
    with Image.open(out) as image:
        assert image.n_frames == 4
        grays = []
        for frame in range(4):
            image.seek(frame)
            grays.append(image.convert("L").getpixel((12, 15)))
    assert np.abs(np.array(grays) - QUARTERS).max() <= 3


def gray_at_the_ring(path):
    """Gray 8 mm left of the middle, where the ring swings most, from any file of a map."""
    content = path.read_bytes()
    if path.suffix == ".csv":
        rows = csv.DictReader(content.decode().splitlines())
        at = {(float(row["x_mm"]), float(row["y_mm"])): float(row["deflection"]) for row in rows}
        return 255 * (1 - at[12.5, 15.5])
    if path.suffix == ".svg":
        encoded = re.search(rb"data:image/png;base64,([^\"]*)", content)[1]
        content = base64.b64decode(encoded)
    with Image.open(io.BytesIO(content)) as image:
        return image.convert("L").getpixel((12, 15))


@pytest.mark.parametrize("suffix", ["png", "svg", "csv"])
def test_a_sequence_is_numbered_files_over_one_period(scene, call, tmp_path, suffix):
    done = call("map", scene, "--out", tmp_path / f"r.{suffix}", *SEQUENCE, "--resolution", 1)
    assert (done.code, done.err) == (0, "")
    paths = [tmp_path / f"r-00{number}.{suffix}" for number in (1, 2, 3, 4)]
    assert sorted(tmp_path.iterdir()) == [*paths, scene]
    assert f"drawn: {paths[0]} to {paths[3]}\n" in done.out
    assert np.abs(np.array([gray_at_the_ring(path) for path in paths]) - QUARTERS).max() <= 3


def test_a_sequence_is_refused_as_a_whole_before_anything_is_written(scene, call, tmp_path):
    out = tmp_path / "none" / "r.png"
    done = call("map", scene, "--out", out, *SEQUENCE, "--resolution", 1)
    assert done.code == 2
    assert "no directory" in done.err
    done = call("map", scene, "--out", tmp_path / "r.csv", *SEQUENCE, "--resolution", 50)
    assert done.code == 2
    assert "4 maps would each be 2000 × 1500 pixels, and there is room for 10 million" in done.err
    assert list(tmp_path.iterdir()) == [scene]


def test_the_array_is_drawn_where_it_is(scene, call, tmp_path):
    plain, out = tmp_path / "plain.png", tmp_path / "array.png"
    assert call("map", scene, "--out", plain).code == 0
    done = call("map", scene, "--out", out, "--array", "20,15,30", "--model", "latero")
    assert done.code == 0
    assert "array: Latero, centre at 20, 15 mm, turned by 30°" in done.out
    different = np.abs(pixels_of(plain) - pixels_of(out)) > 3
    rows, columns = np.nonzero(different)
    assert 8 < (rows.max() - rows.min()) / 4 < 20
    assert abs((rows.max() + rows.min()) / 8 - 15) < 0.5
    assert abs((columns.max() + columns.min()) / 8 - 20) < 0.5


def test_a_drawing_in_svg_says_what_it_shows(scene, call, tmp_path):
    for name, options in {
        "map": ("--rulers", "--array", "20,15"),
        "outline": ("--outline",),
    }.items():
        out = tmp_path / f"{name}.svg"
        done = call("map", scene, "--out", out, *options)
        assert (done.code, done.err) == (0, "")
        root = ElementTree.parse(out).getroot()
        space = "{http://www.w3.org/2000/svg}"
        assert root.find(f"{space}title").text == "A ring"
        words = root.find(f"{space}desc").text
        assert "vibrates: element ring, 25 Hz" in words
        assert root.get("role") == "img"
    assert root.get("width") == f"{40 / 25.4 * 72:.6f}".rstrip("0") + "pt"
    assert "true to scale" in done.out


def test_a_pdf_has_the_size_of_the_paper(scene, call, tmp_path):
    out = tmp_path / "ring.pdf"
    assert call("map", scene, "--out", out, "--outline").code == 0
    content = out.read_bytes()
    assert content.startswith(b"%PDF")
    box = re.search(rb"/MediaBox \[ ?([0-9. ]+)\]", content)
    width, height = map(float, box[1].split()[2:])
    assert (width, height) == pytest.approx((40 / 25.4 * 72, 30 / 25.4 * 72), rel=1e-4)
    assert b"A ring" in content or b"\\000A\\000 \\000r" in content


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--out", "a.bmp"), "end it in one of .png, .svg"),
        (("--out", "a.png", "--resolution", "400"), "million; give --resol"),
        (("--out", "a.csv", "--resolution", "100"), "million; give --resol"),
        (("--out", "a.png", "--array", "2,15"), "the array is not on the canvas at 2,15"),
        (("--out", "a.png", "--array", "nan,15"), "--array"),
        (("--out", "a.png", "--array", "5"), "--array"),
        (("--out", "a.png", "--outline", "--rulers"), "an outline is drawn alone"),
        (("--out", "a.csv", "--outline"), ".svg"),
        (("--out", "a.gif", "--frames", "2", "--rulers"), ".gif file has the map alone"),
        (("--out", "a.gif"), "--frames"),
        (("--out", "a.png", "--frames", "1"), "--frames"),
        (("--out", "a.csv", "--rulers"), ".csv file has the map alone"),
        (("--out", "a.png", "--signal", "slow"), "no signal 'slow'; its signals are: none"),
    ],
)
def test_what_cannot_be_drawn_is_refused_in_a_sentence(
    options, words, scene, call, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    done = call("map", scene, *options)
    assert done.code == 2
    assert words in done.err
    assert done.err.count("\n") == 1
    assert sorted(tmp_path.iterdir()) == [scene]


def test_a_sequence_of_what_stands_still_is_refused(call, tmp_path):
    still = tmp_path / "still.scene"
    still.write_text(STILL)
    done = call("map", still, "--out", tmp_path / "a.png", "--frames", "2")
    assert done.code == 2
    assert "vibrates or moves" in done.err


def test_a_file_is_replaced_only_if_asked(scene, call, tmp_path):
    out = tmp_path / "ring.png"
    out.write_text("mine")
    done = call("map", scene, "--out", out)
    assert done.code == 2
    assert "already exists" in done.err
    assert out.read_text() == "mine"
    assert call("map", scene, "--out", out, "--force").code == 0
    assert pixels_of(out).shape == (120, 160)


ANSWERS = """
canvas = { width_mm = 40, height_mm = 30 }
[signals.slow]
kind = "speed"
[signals.view]
kind = "switch"
levels = [1, 0.5]
[[elements]]
kind = "uniform"
factor = "view"
[[elements]]
kind = "uniform"
level = 0.25
factor = "slow"
"""


@pytest.mark.parametrize(
    ("options", "level"),
    [
        ((), 0.25),
        (("--velocity", "30,-4"), 1.0),
        (("--velocity", "30,0", "--switch", "1=2"), 0.5),
        (("--velocity", "4.5,6"), 0.625),
    ],
)
def test_a_map_is_what_a_hand_feels_that_goes_so_with_switches_so(options, level, call, tmp_path):
    """Lévesque 2009, 9.6: a reactive picture as the map for a velocity."""
    path, out = tmp_path / "answers.scene", tmp_path / "a.png"
    path.write_text(ANSWERS)
    assert call("map", path, "--out", out, *options).code == 0
    np.testing.assert_allclose(pixels_of(out), 255 * (1 - level), atol=1)


MOVES = """
canvas = { width_mm = 40, height_mm = 30 }
[signals.onward]
kind = "direction"
[[elements]]
kind = "moving"
title = "Rain"
part = { kind = "linear-grating", ridge_mm = 4 }
velocity_mm_s = [20, 0]
[[elements]]
kind = "uniform"
factor = "onward"
"""


@pytest.mark.parametrize("suffix", ["png", "svg", "pdf", "csv"])
def test_a_signal_is_drawn_against_the_velocity_and_told(suffix, call, tmp_path):
    """Lévesque 2009, figs. 9.9-9.11."""
    path, out = tmp_path / "moves.scene", tmp_path / f"signal.{suffix}"
    path.write_text(MOVES)
    done = call("map", path, "--signal", "onward", "--out", out)
    assert (done.code, done.err) == (0, "")
    assert "at 6.25 mm/s: right 1.00, right and down 0.25, down 0.00" in done.out
    content = out.read_bytes()
    if suffix == "png":
        with Image.open(out) as image:
            assert "right 1.00" in image.text["Description"]
    if suffix == "svg":
        assert b"right 1.00" in content
        assert ElementTree.fromstring(content) is not None
    if suffix == "csv":
        assert content.startswith(b"x_mm_s,y_mm_s,value\n-6.25,-6.25,")
    assert "million" in call("map", path, "--signal", "onward", "--out", tmp_path / "b.png",
                             "--resolution", "500").err  # fmt: skip


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--switch", "1=3"), "key 1 has 2 states"),
        (("--switch", "2=1"), "key 2 is not a switch of this picture"),
        (("--switch", "one"), "--switch"),
        (("--velocity", "3"), "--velocity"),
    ],
)
def test_a_hand_or_a_switch_that_cannot_be_is_refused(options, words, call, tmp_path):
    path = tmp_path / "answers.scene"
    path.write_text(ANSWERS)
    done = call("map", path, "--out", tmp_path / "a.png", *options)
    assert done.code == 2
    assert words in done.err


def test_rulers_that_nobody_could_read_are_refused(scene, call, tmp_path):
    done = call("map", scene, "--rulers", "--resolution", "0.11", "--out", tmp_path / "ring.png")
    assert done.code == 2
    assert "--resolution is 0.11" in done.err
    assert (
        call("map", scene, "--rulers", "--resolution", "0.11", "--out", tmp_path / "x.svg").code
        == 0
    )


def test_a_key_is_a_second_file(call, tmp_path):
    path = tmp_path / "cell.scene"
    path.write_text("""
        canvas = { width_mm = 120, height_mm = 90 }
        [[elements]]
        kind = "label"
        text = "mitochondrion"
        place_mm = [80, 40]
    """)
    done = call("map", path, "--key", "--out", tmp_path / "cell.png")
    assert done.code == 0
    assert (tmp_path / "cell-key.png").is_file()
    assert "label, text 1 mitochondrion" in done.out


# The kernel's own word: `ru_maxrss` would begin with what the tests' process has.
MEASURED = """
import sys
from pathlib import Path
from vbraille.cli.app import main
assert main(sys.argv[1:]) == 0
print(Path("/proc/self/status").read_text().partition("VmHWM:")[2].split()[0])
"""


@heavy
@pytest.mark.parametrize(
    ("kind", "options"),
    [
        ("svg", ["--outline"]),
        ("pdf", ["--outline"]),
        ("png", ["--outline", "--resolution", "0.36"]),
        ("svg", ["--resolution", "0.19"]),
        ("pdf", ["--resolution", "0.14"]),
        ("png", ["--resolution", "0.36"]),
        ("png", ["--array", "5000,5000", "--resolution", "0.11"]),
        ("csv", ["--resolution", "0.31"]),
    ],
)
def test_ten_metres_are_drawn_within_300_mb(tmp_path, kind, options):
    scene = tmp_path / "hall.scene"
    scene.write_text("""
        canvas = { width_mm = 10_000, height_mm = 10_000 }
        [[elements]]
        kind = "linear-grating"
        ridge_mm = 50
        gap_mm = 30
        vibration = { frequency_hz = 50 }
    """)
    told = subprocess.run(
        [sys.executable, "-c", MEASURED, "map", scene, "--out", tmp_path / f"x.{kind}", *options],
        capture_output=True,
        text=True,
        check=True,
        env=os.environ,
    )
    assert int(told.stdout.split()[-1]) < 300_000  # kB
