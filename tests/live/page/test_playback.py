"""A recording that is played, stepped through, and gone through by its events."""

import numpy as np

from tests.live.page.showing import until
from tests.live.scenes import Scene
from tests.tiers import heavy

# Whether nothing is drawn for a tenth of a second.
STANDS = """(async () => { const drawn = vbraille.drawn;
await new Promise((done) => setTimeout(done, 100)); return vbraille.drawn === drawn; })()"""


def test_the_frame_of_each_time_is_shown(opens):
    scene = Scene("playback")
    page, _ = opens(scene)
    assert page.evaluate("vbraille.last.time_s") == 0.0

    def shows(at_s):
        until(page, f"Math.abs(vbraille.last.time_s - {at_s}) < 5e-4")
        frame = scene.frames(np.array([float(scene.x_mm(at_s))]))[0]
        np.testing.assert_allclose(
            page.evaluate("vbraille.last.deflections"), frame.ravel(), atol=1 / 255
        )

    press = lambda name: page.get_by_role("button", name=name, exact=True).click()  # noqa: E731
    press("on by 0.1 s")
    shows(0.1)
    press("on by one tick")
    shows(0.101)
    press("back by one tick")
    shows(0.1)
    press("Next event")
    shows(2.4)
    page.locator("#kinds").select_option("fault")
    press("Next event")
    shows(28.316)
    assert page.locator(".moment[aria-current]").inner_text().split("\n")[-1].startswith("the dev")
    page.locator("#kinds").select_option("wrong")
    assert page.locator(".moment").count() == 1
    press("Previous event")
    shows(16.4)
    page.locator("#kinds").select_option("")
    page.get_by_role("button", name="answer: m").press("Enter")
    shows(16.4)
    slider = page.get_by_role("slider", name="Time in the recording")
    assert slider.get_attribute("aria-valuetext") == "0:16.400 of 0:42.000"
    slider.press("ArrowRight")
    shows(16.5)
    slider.press("End")
    shows(42.0)
    slider.press("Home")
    shows(0.0)

    page.locator("#speed").select_option("2")
    press("Play")
    until(page, "vbraille.last.time_s > 0.2")
    press("Pause")
    until(page, STANDS)
    assert page.evaluate("vbraille.last.time_s") < 40
    until(page, "document.querySelector('.play').textContent === 'Play'")
    assert page.evaluate(STANDS)
    assert "nothing can be turned" in page.locator("#knobs-note").inner_text()
    assert page.locator(".timeline path").count() == 9  # a shape for each kind, and wrong answers
    page.locator("#paint").select_option("condition")
    assert "2.2 mm" in page.locator("#transport .legend").inner_text()
    assert page.locator(".timeline path[fill]").count() == 4
    page.locator("#paint").select_option("")
    press("Zoom in")
    assert page.locator(".timeline path").count() < 9
    assert float(page.locator("#scrubber").get_attribute("max")) == 21
    press("Zoom out")
    assert page.locator(".timeline path").count() == 9
    shapes = page.locator(".moment path").evaluate_all("all => all.map((p) => p.getAttribute('d'))")
    assert len(set(shapes)) == 8


def test_a_map_is_shown_and_saved(opens):
    page, _ = opens(Scene("still"), steers=False)
    page.get_by_role("button", name="Draw the map").click()
    until(page, "document.querySelector('#map-figure img')?.naturalWidth > 0")
    assert "to scale" in page.locator("#map-figure img").get_attribute("alt")
    for form in ("PNG", "SVG"):
        with page.expect_download() as saved:
            page.get_by_role("button", name=f"Save as {form}").click()
        assert saved.value.suggested_filename == f"deflection-map.{form.lower()}"
    with open(saved.value.path(), "rb") as file:  # noqa: PTH123 - Playwright gives a path of its own
        assert file.read().startswith(b"<svg")


@heavy
def test_an_empty_recording_stands_still(opens):
    scene = Scene("playback")
    scene.length_s, scene.moments = 0.0, []
    page, _ = opens(scene)
    page.get_by_role("button", name="Play", exact=True).click()
    until(page, "document.querySelector('.play').textContent === 'Play'")
    assert page.evaluate(STANDS)
