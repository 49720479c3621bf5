"""Deflection maps: what they say is what actuators do, and their files are well-formed."""

import base64
import io

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree
from PIL import Image

from tests.shown import LATERO
from tests.tiers import examples
from vbraille.live import maps
from vbraille.render import STRESS2, VBD, work
from vbraille.render.program import vibration

MASKS = [np.array(cells, np.uint8) for cells in ([0x3F, 0x01, 0, 0x1A], [0x07], [0, 0x38])]
LINES = {
    "vbd": VBD.style.render(MASKS[0], VBD.display),
    "stress2": STRESS2.style.render(MASKS[0], STRESS2.display),
    "latero": STRESS2.style.render(MASKS[0], LATERO),
}
PAGE = STRESS2.style.render_page(MASKS, STRESS2.display)
DISPLAYS = {"vbd": VBD.display, "stress2": STRESS2.display, "latero": LATERO}
SVG = "{http://www.w3.org/2000/svg}"


def places_of(display, x_mm, theta_rad=0.0):
    """Where each actuator is along the line; float64[rows, columns]."""
    along = (np.arange(display.columns) - (display.columns - 1) / 2) * display.column_pitch_mm
    down = (np.arange(display.rows) - (display.rows - 1) / 2) * display.row_pitch_mm
    return x_mm + along * np.cos(theta_rad) + down[:, None] * np.sin(theta_rad)


def at_places(program, places_mm, line=0):
    """What a map says at places of actuators."""
    return np.array(
        [maps.deflections_at(program, at)[line, row] for row, at in enumerate(places_mm)]
    )


@pytest.mark.parametrize("name", LINES)
@examples(12)
@given(x_mm=st.floats(-10, 60), theta_rad=st.sampled_from([0.0, 0.3, -1.2]))
def test_an_actuator_does_what_the_map_says_at_its_place(name, x_mm, theta_rad):
    program, display = LINES[name], DISPLAYS[name]
    frame = np.zeros(display.shape)
    program.frame(x_mm, frame, theta_rad=theta_rad)
    some = [0, display.columns // 2, display.columns - 1]
    said = at_places(program, places_of(display, x_mm, theta_rad)[:, some])
    np.testing.assert_allclose(said, frame[:, some], atol=1 / 255 / 100)


@pytest.mark.parametrize("line", range(len(MASKS)))
def test_a_page_has_the_rows_of_each_line(line):
    y_mm = np.full(3, (line + 0.5) * STRESS2.style.geometry.line_pitch_mm)
    x_mm = np.array([1.0, 7.7, 30.0])
    _, frames = PAGE.poses(x_mm, y_mm)
    for x, frame in zip(x_mm, frames, strict=True):
        said = at_places(PAGE, places_of(STRESS2.display, x), line)
        np.testing.assert_allclose(said, frame, atol=1 / 255 / 100)


def test_each_place_is_for_itself():
    places = np.linspace(-3.0, 9.0, 49)
    found = maps.deflections_at(LINES["stress2"], places)
    assert found.shape == (1, 6, 49)
    assert found.dtype == np.float32
    for column in (0, 13, 48):
        alone = maps.deflections_at(LINES["stress2"], places[column : column + 1])
        assert (found[:, :, column] == alone[:, :, 0]).all()
    assert found.max() > 0.9
    assert (found[:, :, 0] == 0).all()


@pytest.mark.parametrize(
    ("program", "lines"), [(LINES["vbd"], 1), (LINES["stress2"], 1), (PAGE, 3)]
)
def test_a_png_is_to_scale_and_rest_is_white(program, lines):
    image = Image.open(io.BytesIO(maps.picture(program, "png", "Äpfel ⠓", "A note.")))
    image.load()
    geometry = STRESS2.style.geometry if program.shape[0] == 6 else VBD.style.geometry
    assert image.mode == "L"
    assert image.size[1] == lines * round(geometry.line_pitch_mm * 10)
    assert image.size[0] == pytest.approx(6 * geometry.cell_pitch_mm * 10, abs=2)
    assert image.info["dpi"] == pytest.approx((254, 254))
    assert image.info["Title"] == "Äpfel ⠓"
    assert image.info["Description"].startswith("A note. Deflection of the actuators from -")
    pixels = np.asarray(image)
    assert (pixels[:, 0] == 255).all()
    assert pixels.min() < 3


def test_a_pixel_is_the_deflection_of_its_row_and_place():
    program, geometry = LINES["stress2"], STRESS2.style.geometry
    pixels = np.asarray(Image.open(io.BytesIO(maps.picture(program, "png", "t"))))
    places = maps.STEP_MM * np.arange(pixels.shape[1]) - geometry.cell_pitch_mm
    (found,) = maps.deflections_at(program, places)
    middle = geometry.line_pitch_mm / 2 + (np.arange(6) - 2.5) * STRESS2.display.row_pitch_mm
    drawn = 1 - pixels[(middle / maps.STEP_MM).astype(int)] / 255
    np.testing.assert_allclose(drawn, found, atol=0.51 / 255)


def test_what_is_not_known_is_white():
    program = LINES["vbd"].with_anchor(0.0)
    program.numbers[work.IDLE : work.IDLE + 1] = np.nan
    image = Image.open(io.BytesIO(maps.picture(program, "png", "t")))
    assert not np.isfinite(maps.deflections_at(program, np.arange(-5.0, 0.0))).all()
    assert (np.asarray(image)[:, 0] == 255).all()


@pytest.mark.parametrize("title", ["plain", "a <b> & 'c'", "bell \x07 and \ud800", ""])
def test_an_svg_is_well_formed_and_in_millimetres(title):
    made = maps.picture(PAGE, "svg", title, "A note.")
    root = etree.fromstring(made)
    assert root.tag == f"{SVG}svg"
    wide, high = (float(root.get(name).removesuffix("mm")) for name in ("width", "height"))
    assert [float(n) for n in root.get("viewBox").split()][2:] == [wide, high]
    assert root.find(f"{SVG}title").text == (
        title.replace("\x07", "\ufffd").replace("\ud800", "\ufffd") or None
    )
    assert "white is rest" in root.find(f"{SVG}desc").text.lower()
    assert "10 mm" in "".join(root.itertext())
    drawn = root.find(f"{SVG}image")
    kind, _, packed = drawn.get("href").partition(",")
    assert kind == "data:image/png;base64"
    image = Image.open(io.BytesIO(base64.b64decode(packed)))
    assert image.size == (
        round(float(drawn.get("width")) * 10),
        round(float(drawn.get("height")) * 10),
    )


def test_what_has_no_map_is_refused():
    with pytest.raises(ValueError, match="vibration has no map"):
        maps.picture(vibration(STRESS2.display), "png", "t")
    with pytest.raises(ValueError, match="a png or an svg"):
        maps.picture(PAGE, "gif", "t")
    with pytest.raises(ValueError, match="too large"):
        maps.deflections_at(PAGE, np.zeros(maps.MOST_PIXELS // 18 + 1))
