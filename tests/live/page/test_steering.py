"""The hand, the knobs and the commands, by mouse and by keys."""

import re

import numpy as np
import pytest

from tests.live.page.showing import comes, settled, until
from tests.live.scenes import Scene
from vbraille.live.messages import LetGo, PagePress, Point, Turn

PX_MM = """(() => { const drawing = document.querySelector("#sheet .still");
return drawing.getBoundingClientRect().width / drawing.viewBox.baseVal.width; })()"""


def points(scene):
    return [request for request in scene.asked if isinstance(request, Point)]


def test_the_array_is_dragged_goes_by_keys_and_is_let_go(opens):
    scene = Scene("still")
    page, _ = opens(scene)
    settled(page)
    px_mm = page.evaluate(PX_MM)
    box = page.locator("#finger .frame").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 20 * px_mm, y, steps=5)
    page.mouse.up()
    comes(page, lambda: bool(points(scene)) and abs(points(scene)[-1].x_mm - 137.3) < 0.3)
    at = points(scene)[-1].x_mm
    until(page, f"Math.abs(vbraille.last.x_mm - {at}) < 1e-4")
    frame = scene.frames(np.array([at]))[0]
    np.testing.assert_allclose(
        page.evaluate("vbraille.last.deflections"), frame.ravel(), atol=1 / 255
    )

    page.keyboard.press("ArrowRight")  # the array is focused: it was dragged
    page.keyboard.press("Shift+ArrowLeft")
    comes(page, lambda: points(scene)[-1].x_mm == pytest.approx(at + 0.5 - 5, abs=1e-6))
    until(page, "document.getElementById('let-go').hidden === false")
    finger = page.locator("#finger")
    assert "line 2" in finger.get_attribute("aria-valuetext")
    page.keyboard.press("Home")
    comes(page, lambda: points(scene)[-1].x_mm == pytest.approx(-scene.display.span_mm / 2))
    page.keyboard.press("Escape")
    comes(page, lambda: isinstance(scene.asked[-1], LetGo))
    until(page, "document.getElementById('let-go').hidden")


def test_a_place_is_sent_at_its_event_and_the_newest_with_the_next_picture(opens):
    scene = Scene("still")
    page, _ = opens(scene)
    settled(page)
    page.locator("#finger").focus()
    # Thirty keys within one task of the browser: the first place goes out at once, then the newest.
    page.evaluate(
        """for (let n = 0; n < 30; n++) document.getElementById("finger").dispatchEvent(
        new KeyboardEvent("keydown", { key: "ArrowRight", bubbles: true }))"""
    )
    comes(page, lambda: len(points(scene)) > 1)
    sent = [point.x_mm for point in points(scene)]
    assert sent == pytest.approx([117.3 + 0.5, 117.3 + 15], abs=1e-3)


def test_knobs_and_commands(opens):
    scene = Scene("still")
    page, _ = opens(scene)
    turned = lambda: [r for r in scene.asked if isinstance(r, Turn)]  # noqa: E731
    page.get_by_role("button", name="dot width: more by 0.2 mm").click()
    comes(page, lambda: turned() == [Turn("dot_width_mm", 2.8)])
    slider = page.get_by_role("slider", name="dot width", exact=True)
    until(page, "vbraille.state.geometry.dot_width_mm === 2.8")
    assert slider.get_attribute("aria-valuetext") == "2.8 mm"
    slider.press("ArrowLeft")
    comes(page, lambda: turned()[-1] == Turn("dot_width_mm", 2.6))
    number = page.get_by_role("spinbutton", name="contrast, as a number")
    number.fill("0.7")
    number.press("Enter")
    comes(page, lambda: turned()[-1] == Turn("contrast", 0.7))
    slider.evaluate("s => { s.value = 0.7; s.dispatchEvent(new Event('input')); }")
    comes(page, lambda: turned()[-1].knob == "dot_width_mm")
    steps = (turned()[-1].value - 2.6) / 0.2
    assert steps == pytest.approx(round(steps))

    # The reader turns it by keys: the page follows.
    scene.ask(Turn("texture", 0.3))
    until(page, "document.getElementById('knob-texture-number').value === '0.3'")
    # What cannot be is refused by a sentence.
    number = page.get_by_role("spinbutton", name="dot width in mm, as a number")
    number.fill("20")
    number.press("Enter")
    until(page, "document.getElementById('notice').textContent !== ''")
    assert re.search("dot width|dot must", page.locator("#notice").inner_text(), re.IGNORECASE)

    page.get_by_role("button", name="Next line").click()
    comes(page, lambda: PagePress("LNDN") in scene.asked)
    until(page, "document.querySelector('.line.under').dataset.line === '3'")
    until(page, "[...document.querySelectorAll('#said p')].pop().textContent === 'line 3'")
    page.get_by_role("button", name="Rest the array").click()
    page.get_by_role("button", name="Go on", exact=True).wait_for()


def test_who_watches_is_told_why_nothing_turns(opens):
    scene = Scene("still")
    page, _ = opens(scene, steers=False)
    assert page.get_by_role("slider", name="dot width", exact=True).count() == 0
    assert page.get_by_role("button", name="Next line").count() == 0
    assert page.locator(":disabled").count() == 0
    assert "2.6 mm" in page.locator("#knobs").inner_text()
    assert "open the address" in page.locator("#knobs-note").inner_text()
    assert page.locator("#finger").get_attribute("role") == "img"
    page.locator("#finger .frame").click(force=True)
    settled(page)
    assert scene.asked == []


def test_the_token_leaves_the_address_and_stays_for_a_reload(opens):
    page, _ = opens(Scene("still"))
    assert page.evaluate("location.hash") == ""
    page.reload()
    until(page, "Boolean(window.vbraille && vbraille.drawn)")
    assert page.locator("#finger").get_attribute("role") == "slider"
