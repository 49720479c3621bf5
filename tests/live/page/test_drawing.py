"""What the page draws is what the renderer made, and stands where the braille is."""

import numpy as np
import pytest

from tests.live.page.showing import settled, until
from tests.live.scenes import SWING_MM, Scene
from tests.tiers import heavy
from vbraille.live.pagefiles import page_files

SHOWN = """[...document.querySelectorAll("#deflection [data-deflection]")].map((actuator) => ({
  deflection: Number(actuator.dataset.deflection), row: Number(actuator.dataset.row),
  column: Number(actuator.dataset.column) }))"""


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

    # Bars of what is pressed go down, and are hollow: the sign is seen without colour.
    bars = page.locator("#strain .bar").evaluate_all(
        """all => all.filter((b) => b.getAttribute("d")).map((b) =>
        [b.getAttribute("d").includes("v-"), b.getAttribute("fill") !== "none"])"""
    )
    assert all(up == filled for up, filled in bars)
    assert {up for up, _ in bars} == {True, False}

    # The array stands on the page where the finger is.
    assert "translate(117.30" in page.locator("#finger").get_attribute("transform")
    assert page.locator(".line.under").get_attribute("data-line") == "2"
    page.locator("summary").click()
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


def test_a_blind_session_shows_where_the_hand_is_and_nothing_else(opens):
    page, _ = opens(Scene("blind"), steers=False)
    until(page, "vbraille.last.x_mm > -1000")
    assert page.locator("#touch").is_hidden()
    assert page.locator("#map").is_hidden()
    assert page.evaluate("vbraille.last.deflections") == []
    assert page.locator(".raised").count() == 0
    assert "blind session" in page.locator("#device").inner_text()
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
