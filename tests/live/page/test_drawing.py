"""What the page draws is what the renderer made, and stands where the braille is."""

import csv
from pathlib import Path

import numpy as np
import pytest

from tests.live.page.showing import settled, until
from tests.live.page.test_colours import STEPS, palette, paper, ramp
from tests.live.scenes import SWING_MM, Scene
from tests.tiers import heavy
from vbraille.live.server import page_files

SHOWN = """[...document.querySelectorAll("#deflection [data-deflection]")].map((actuator) => ({
  deflection: Number(actuator.dataset.deflection), row: Number(actuator.dataset.row),
  column: Number(actuator.dataset.column) }))"""

# Colours of a canvas, at places in mm of the drawing that it lies upon.
COLOURS = """([figure, places]) => {
  const canvas = document.querySelector(`#${figure} canvas`);
  const drawing = document.querySelector(`#${figure} svg.skin`);
  const box = canvas.getBoundingClientRect(), turned = drawing.getScreenCTM();
  const sharp = canvas.width / box.width, pen = canvas.getContext("2d");
  return places.map(([x, y]) => {
    const at = new DOMPoint(x, y).matrixTransform(turned);
    const pixel = pen.getImageData(Math.floor((at.x - box.x) * sharp),
      Math.floor((at.y - box.y) * sharp), 1, 1).data;
    return "#" + [...pixel.slice(0, 3)].map((v) => v.toString(16).padStart(2, "0")).join("");
  });
}"""


def seats(display):
    """Places of the actuators' middles from that of the array, in mm, row by row."""
    rows, columns = np.indices((display.rows, display.columns)).reshape(2, -1)
    return np.column_stack([
        (columns - (display.columns - 1) / 2) * display.column_pitch_mm,
        (rows - (display.rows - 1) / 2) * display.row_pitch_mm,
    ])  # fmt: skip


def test_the_pixels_drawn_are_the_frame(opens):
    scene = Scene("still")
    page, _ = opens(scene, steers=False)
    settled(page)
    frame = scene.frames(np.array([117.3]))[0]
    look = lambda figure, places: page.evaluate(COLOURS, [figure, places.tolist()])  # noqa: E731
    stops, named = palette("LIGHT")
    drawn = ramp(stops)
    times = int(page.locator("#deflection").inner_text().split("× ")[1].split()[0])
    # At rest they stand at the right, and go to the left.
    middles = seats(scene.display)
    middles[:, 0] += (0.5 - frame.ravel()) * SWING_MM * times
    wanted = [drawn[round(min(max(value, 0), 1) * STEPS)] for value in frame.ravel().tolist()]
    assert look("deflection", middles) == wanted
    assert len(set(wanted)) > 3
    # Each ends where it should: 0.18 of the pitch to either side, and there is a stroke.
    for side in (-1, 1):
        beside = middles + np.array([side * 0.24 * scene.display.column_pitch_mm, 0.2])
        assert not any(a == b for a, b in zip(look("deflection", beside), wanted, strict=True))

    # What is stretched stands up and is filled, what is pressed hangs down and is hollow: the sign
    # is seen without colour.
    strain = -np.diff(frame, axis=1).ravel() * SWING_MM / scene.display.column_pitch_mm
    tall = strain * 0.44 * scene.display.row_pitch_mm * scene.display.column_pitch_mm / SWING_MM
    left = seats(scene.display).reshape(*frame.shape, 2)[:, :-1].reshape(-1, 2)
    left[:, 0] += 0.5 * scene.display.column_pitch_mm
    within, other = left - [0, 1] * (tall / 2)[:, None], left + [0, 1] * (tall / 2)[:, None]
    is_up, is_down = tall > 0.2, tall < -0.2
    assert is_up.any()
    assert is_down.any()
    colours, empty = np.array(look("strain", within)), np.array(look("strain", other))
    assert set(colours[is_up]) == {named["stretch"]}
    assert set(colours[is_down]) | set(empty[is_up | is_down]) == {paper("LIGHT")}
    ends = left - [0, 1] * tall[:, None]
    for colour in np.array(look("strain", ends))[is_down]:
        assert colour != paper("LIGHT")


def test_what_elements_say_of_the_frame_is_so_whenever_the_picture_stands(opens):
    page, _ = opens(Scene("live"), steers=False)
    until(page, "Math.max(...vbraille.last.deflections) > 0.5")
    differs = """[...document.querySelectorAll("#deflection .actuator")].map((actuator, n) =>
      Math.abs(Number(actuator.dataset.deflection) - vbraille.last.deflections[n]))"""
    for _ in range(3):
        at_once = f"() => {{ document.getElementById('freeze').click(); return {differs}; }}"
        assert max(page.evaluate(at_once)) < 1 / 255
        page.wait_for_timeout(120)
        assert max(page.evaluate(differs)) < 1 / 255
        page.locator("#freeze").click()
        settled(page)


def test_canvases_are_as_sharp_as_the_screen_and_sharper_on_paper(opens):
    page, _ = opens(Scene("still"), device_scale_factor=2)
    wide = """[...document.querySelectorAll("#sheet canvas, #touch canvas")].map((canvas) =>
      canvas.width / canvas.getBoundingClientRect().width)"""
    assert page.evaluate(wide) == pytest.approx([2, 2, 2])
    page.evaluate(f"addEventListener('beforeprint', () => {{ window.printed = {wide}; }})")
    page.pdf()
    assert page.evaluate("printed") == pytest.approx([4, 4, 4])
    assert page.evaluate(wide) == pytest.approx([2, 2, 2])


def test_frames_drawn_are_the_renderers_and_strain_and_text_follow(opens):
    scene = Scene("still")
    page, _ = opens(scene, steers=False)
    settled(page)
    frame = scene.frames(np.array([117.3]))[0]
    assert frame.max() > 0.5
    last = page.evaluate("vbraille.last")
    assert (last["rows"], last["columns"]) == frame.shape
    np.testing.assert_allclose(last["deflections"], frame.ravel(), atol=1e-6)
    shown = page.evaluate(SHOWN)
    assert len(shown) == frame.size
    for actuator in shown:
        drawn = frame[actuator["row"], actuator["column"]]
        assert actuator["deflection"] == pytest.approx(drawn, abs=1 / 255)

    # x = 117.3 mm is in cell 10, whose left edge is at 111 mm, of the second line.
    assert page.locator("#readout").inner_text().split("\n")[:2] == ["x", "117.3 mm"]
    here = page.evaluate(
        """import("/braille.js").then(({ sayWhere }) =>
        sayWhere(vbraille.state, { x_mm: 117.3, y_mm: 0, line: 2 }))"""
    )
    assert here.startswith("x 117.3 mm, line 2, cell 11,")
    page.get_by_role("button", name="Say where the finger is").click()
    until(page, "document.getElementById('where').textContent !== ''")
    assert page.locator("#where").inner_text() == here

    # At rest on the right, an actuator goes left: its right neighbour is then stretched away.
    strain = page.evaluate(
        """import("/skin.js").then(({ strains }) =>
        strains(vbraille.state.array, vbraille.last.deflections))"""
    )
    wanted = -np.diff(frame, axis=1) * SWING_MM / scene.display.column_pitch_mm
    np.testing.assert_allclose(strain, wanted.ravel(), atol=1e-6)

    # The array stands on the page where the finger is.
    still = page.locator("#sheet .still").bounding_box()
    left_mm, _, wide_mm, _ = (
        float(number) for number in page.locator(".still").get_attribute("viewBox").split()
    )
    px_mm = still["width"] / wide_mm
    for drawn in ("#finger .frame", "#finger canvas", ".hairline"):
        box = page.locator(drawn).bounding_box()
        at_mm = left_mm + (box["x"] + box["width"] / 2 - still["x"]) / px_mm
        assert at_mm == pytest.approx(117.3, abs=1 / px_mm), drawn
    assert page.locator(".line.under").get_attribute("data-line") == "2"
    page.locator("summary").click()
    until(page, "document.querySelector('#tables td') !== null")
    cells = page.locator("#tables table").first.locator("td").all_inner_texts()
    assert cells == [f"{value:.2f}" for value in frame.ravel()]


@heavy
@pytest.mark.parametrize("kind", ["vbd", "page"])
def test_other_displays_are_drawn_too(opens, kind):
    scene = Scene(kind)
    page, _ = opens(scene)
    settled(page)
    last = page.evaluate("vbraille.last")
    assert last["rows"] * last["columns"] == len(page.evaluate(SHOWN))
    assert page.locator("#finger").get_attribute("role") == "slider"


def test_picture_and_finger_are_side_by_side_and_the_moment_is_saved(opens):
    scene = Scene("page")
    page, _ = opens(scene)
    settled(page)
    sheet, touch = (page.locator(one).bounding_box() for one in ("#sheet", "#touch"))
    assert touch["x"] >= sheet["x"] + sheet["width"]
    assert abs(touch["y"] - page.locator("#page").bounding_box()["y"]) < 2
    strain = page.locator("#strain canvas").bounding_box()
    assert strain["y"] + strain["height"] <= 900
    assert "up: stretched" in page.locator("#strain").inner_text()
    assert {"speed along", "speed down"} <= set(page.locator("#readout").inner_text().split("\n"))

    with page.expect_download(lambda one: one.suggested_filename.endswith(".csv")) as saved:
        page.get_by_role("button", name="Save the moment").click()
    head, *rows = csv.reader(Path(saved.value.path()).read_text().splitlines())
    assert head[5:8] == ["row", "column", "deflection"]
    assert len(rows) == len(page.evaluate("vbraille.last.deflections"))
    page.get_by_role("button", name="Record").click()
    settled(page)
    with page.expect_download() as recorded:
        page.get_by_role("button", name="Record").click()
    head, *rows = csv.reader(Path(recorded.value.path()).read_text().splitlines())
    assert len(rows) > 2
    assert {len(row) for row in rows} == {len(head)}


def test_a_blind_session_shows_where_the_hand_is_and_nothing_else(opens):
    page, _ = opens(Scene("blind"), steers=False)
    until(page, "vbraille.last.x_mm > -1000")
    assert page.locator("#touch").is_hidden()
    assert page.locator("#map").is_hidden()
    assert page.evaluate("vbraille.last.deflections") == []
    assert page.locator(".raised").count() == 0
    assert "stays hidden" in page.locator("#device").inner_text()
    assert "12 of 78" in page.locator("#facts").inner_text()
    assert "mm" in page.locator("#readout").inner_text()


def test_the_page_is_small():
    sizes = {path: len(body) for path, (_, body) in page_files().items() if path != "/"}
    assert "/index.html" in sizes
    assert sum(sizes.values()) <= 150_000


def test_nothing_is_loaded_from_elsewhere():
    for path, (_, body) in page_files().items():
        text = body.decode().replace("http://www.w3.org/", "")
        assert "http" not in text.replace('location.protocol === "https:"', ""), path
        assert " style=" not in text, path
