"""The page in a real browser: what it draws and says, for everybody, and what it asks for."""

import math
from pathlib import Path

import numpy as np
import pytest
from axe_playwright_python.sync_playwright import Axe
from msgspec.structs import replace

import vbraille.live
from tests.live.showing import LINES, Reading, comes, settled, until
from tests.tiers import heavy
from vbraille.live.messages import (
    CardShown,
    LetGo,
    PagePress,
    PlayedEvent,
    Point,
    SceneShown,
    SignalShown,
    Turn,
    ViewState,
)
from vbraille.live.server import Server
from vbraille.live.states import array_shown
from vbraille.playback.recorded import PLAYED, Piece, Playback
from vbraille.render import STRESS2
from vbraille.render.braille.models import SWING_MM

MOMENTS = [
    PlayedEvent(0.0, "line", "line 1"),
    PlayedEvent(2.4, "trial", "trial 12"),
    PlayedEvent(7.85, "answer", "answer: n", True),
    PlayedEvent(16.4, "answer", "answer: m", False),
    PlayedEvent(28.3, "fault", "the device was silent"),
]
LENGTH_S = 42.0


class Recorded(Playback):
    """A recording whose hand goes along by a millimetre a second."""

    length_s, pieces, moments = LENGTH_S, 1, MOMENTS

    def first_s(self, number):  # noqa: ARG002
        return 0.0

    def read(self, number):  # noqa: ARG002
        ticks = np.zeros(42_001, PLAYED)
        ticks["time_s"] = ticks["x_mm"] = np.arange(ticks.size) / 1000
        ticks["tick"] = np.arange(ticks.size)
        frames = np.zeros((ticks.size, *STRESS2.display.shape), np.float32)
        frames[:, 0, 0] = ticks["time_s"] / LENGTH_S
        return Piece(ticks, frames)

    def describe(self, scene):  # noqa: ARG002
        return ViewState(title="A recording", array=array_shown(STRESS2.display), lines=LINES)


@pytest.fixture
def reading():
    with Reading() as reading:
        yield reading


def axe(page):
    """Violations of accessibility rules that axe finds on the page, a line each."""
    found = Axe().run(page).response["violations"]
    return [f"{rule['id']}: {node['html'][:120]}" for rule in found for node in rule["nodes"]]


def text(page, where):
    return page.locator(where).inner_text()


def test_what_is_drawn_is_the_engines_frame_and_words_follow(opens, reading):
    page = opens(reading.address)
    settled(page)
    frame = reading.frame()
    assert frame.max() > 0.5
    last = page.evaluate("vbraille.last")
    np.testing.assert_allclose(last["deflections"], frame.ravel(), atol=1e-6)
    strain = page.evaluate(
        """import("/skin.js").then(({ strains }) =>
        strains(vbraille.state.array, vbraille.last.deflections))"""
    )
    display = reading.display
    wanted = -np.diff(frame, axis=1) * SWING_MM / display.column_pitch_mm
    np.testing.assert_allclose(strain, wanted.ravel(), atol=1e-6)

    # x = 40 mm is in the fourth cell of the second line, a blank.
    assert text(page, "#readout").split("\n")[:2] == ["x", "40.0 mm"]
    page.get_by_role("button", name="Say where the finger is").click()
    until(page, "document.getElementById('where').textContent !== ''")
    assert text(page, "#where").startswith("x 40.0 mm, line 2, cell 4, no dots")
    # The array stands on the page where the finger is.
    still = page.locator("#sheet .still").bounding_box()
    box = page.locator(".still").get_attribute("viewBox").split()
    left_mm, wide_mm = float(box[0]), float(box[2])
    for drawn in ("#finger .frame", "#finger canvas", ".hairline"):
        at = page.locator(drawn).bounding_box()
        middle = (at["x"] + at["width"] / 2 - still["x"]) * wide_mm / still["width"]
        assert left_mm + middle == pytest.approx(40, abs=wide_mm / still["width"]), drawn
    assert page.locator(".line.under").get_attribute("data-line") == "2"
    page.locator("summary").click()
    until(page, "document.querySelector('#tables td') !== null")
    cells = page.locator("#tables table").first.locator("td").all_inner_texts()
    assert cells == [f"{value:.2f}" for value in frame.ravel()]


@pytest.mark.parametrize("scheme", ["light", pytest.param("dark", marks=heavy)])
def test_axe_finds_nothing_in_a_reading(opens, reading, scheme):
    png = "data:image/gif;base64,R0lGODlhAQABAAAAACwAAAAAAQABAAACADs="
    page = opens(reading.address, color_scheme=scheme)
    page.locator("summary").click()
    page.get_by_role("button", name="Say where the finger is").click()
    settled(page)
    assert axe(page) == []
    reading.state = replace(
        reading.state,
        lines=[],
        scene=SceneShown("A house", "A house with a door.", 90, 60, png),
        signals=[SignalShown("door", "1 open, 0 shut")],
        cards=[[CardShown("row 1, card 1", "face down"), CardShown("row 1, card 2", "turned up")]],
    )
    page.locator(".card").first.wait_for()
    settled(page)
    assert axe(page) == []
    page.locator(".card").first.press("ArrowRight")
    page.keyboard.press("Enter")
    comes(page, lambda: PagePress("point", 1) in reading.asked)
    assert "0.00" in text(page, "#signal-rows")


def test_keys_alone_reach_everything_and_focus_is_seen(opens, reading):
    page = opens(reading.address)
    settled(page)
    page.evaluate("document.body.tabIndex = -1; document.body.focus()")
    stops = []
    for _ in range(12):
        page.keyboard.press("Tab")
        stops.append(
            page.evaluate(
                """(() => { const e = document.activeElement;
                const ring = e.querySelector(".ring");
                const frame = e.closest(".skin")?.parentElement.querySelector(".chosen");
                const outlined = (one) => getComputedStyle(one).outlineStyle !== "none";
                return [e.id || e.textContent.trim().slice(0, 30) || e.className.baseVal,
                  frame ? outlined(frame) : outlined(e) ||
                    Boolean(ring && getComputedStyle(ring).stroke !== "none")];
                })()"""
            )
        )
    names = [name for name, _ in stops]
    assert names[:5] == ["Skip to the page", "say", "freeze", "finger", "said"]
    assert {"actuator", "Next line", "knob-texture"} <= set(names)
    assert [name for name, seen in stops if not seen] == []

    # The actuators are one stop, with arrow keys inside.
    page.locator("#deflection [aria-selected=true]").focus()
    for key in ("ArrowDown", "ArrowRight", "End", "Home"):
        page.keyboard.press(key)
    label = page.evaluate("document.activeElement.getAttribute('aria-label')")
    assert label.startswith("row 2, column 1: deflection 0")
    page.get_by_role("button", name="Hold the picture").press("Enter")
    page.wait_for_timeout(50)
    drawn = page.evaluate("vbraille.drawn")
    page.wait_for_timeout(150)
    assert page.evaluate("vbraille.drawn") == drawn


def test_the_hand_goes_by_mouse_and_keys_and_is_let_go(opens, reading):
    page = opens(reading.address)
    settled(page)
    box = page.locator("#finger .frame").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    px_mm = page.evaluate(
        """(() => { const drawing = document.querySelector("#sheet .still");
        return drawing.getBoundingClientRect().width / drawing.viewBox.baseVal.width; })()"""
    )
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 20 * px_mm, y, steps=5)
    page.mouse.up()
    comes(page, lambda: abs(reading.x_mm - 60) < 0.5)
    at = reading.x_mm
    page.keyboard.press("ArrowRight")  # the array is focused: it was dragged
    page.keyboard.press("Shift+ArrowLeft")
    comes(page, lambda: reading.x_mm == pytest.approx(at + 0.5 - 5, abs=1e-3))
    until(page, "document.getElementById('let-go').hidden === false")
    page.keyboard.press("Home")
    comes(page, lambda: reading.x_mm == pytest.approx(-reading.display.span_mm / 2, abs=1e-3))
    page.keyboard.press("Escape")
    comes(page, lambda: reading.asked[-1] == LetGo())
    until(page, "document.getElementById('let-go').hidden")


def test_knobs_and_commands(opens, reading):
    page = opens(reading.address)
    slider = page.get_by_role("slider", name="texture", exact=True)
    for act, value in (
        (lambda: page.get_by_role("button", name="texture: more by 0.1").click(), 0.6),
        (lambda: slider.press("ArrowLeft"), 0.5),
        (lambda: page.get_by_role("spinbutton").fill("0.7"), None),
        (lambda: page.get_by_role("spinbutton").press("Enter"), 0.7),
    ):
        act()
        if value is not None:
            comes(page, lambda value=value: Turn("texture", value) in reading.asked)
            until(page, f"vbraille.state.knobs[0].value === {value}")
    page.get_by_role("button", name="Next line").click()
    comes(page, lambda: PagePress("LNDN") in reading.asked)
    until(page, "document.querySelector('.line.under').dataset.line === '3'")
    until(page, "[...document.querySelectorAll('#said p')].pop().textContent === 'line: 3'")


def test_a_page_that_may_only_watch_is_told_why_and_a_token_stays_for_a_reload(opens, reading):
    page = opens(reading.address.partition("#")[0])
    assert page.get_by_role("button", name="Next line").count() == 0
    assert "open the address" in text(page, "#knobs-note")
    assert page.locator("#finger").get_attribute("role") == "img"
    page.locator("#finger .frame").click(force=True)
    settled(page)
    assert not any(isinstance(asked, Point) for asked in reading.asked)
    page = opens(reading.address)
    assert page.evaluate("location.hash") == ""
    page.reload()
    until(page, "Boolean(window.vbraille && vbraille.drawn)")
    assert page.locator("#finger").get_attribute("role") == "slider"


def test_a_lost_connection_is_said_once_and_begun_again(opens):
    with Reading() as reading:
        page = opens(reading.address.partition("#")[0])
        port = int(reading.address.partition("#")[0].rstrip("/").rpartition(":")[2])
        page.evaluate(
            """window.told = []; new MutationObserver(() => told.push(document.getElementById(
            "notice").textContent)).observe(document.getElementById("notice"), {childList: true})"""
        )
    until(page, "told.length > 0")
    page.wait_for_timeout(700)  # another attempt fails meanwhile
    assert page.evaluate("told.length") == 1
    assert axe(page) == []
    with Reading(port=port):
        until(page, "told.at(-1) === 'Connected again.'")
        settled(page)


def test_a_blind_page_shows_where_the_hand_is_and_nothing_else(opens):
    with Reading(blind=True) as reading:
        page = opens(reading.address)
        settled(page)
        assert page.locator("#touch").is_hidden()
        assert page.evaluate("vbraille.last.deflections") == []
        assert page.locator(".raised").count() == 0
        assert "40.0 mm" in text(page, "#readout")
        assert axe(page) == []


def test_a_narrow_page_needs_no_scrolling_sideways(opens, reading):
    """320 pixels are a small phone, and a screen of 1280 at 400 %."""
    page = opens(reading.address, viewport={"width": 320, "height": 640})
    page.locator("summary").click()
    settled(page)
    assert page.evaluate("document.documentElement.scrollWidth") <= 320
    outside = page.evaluate(
        """[...document.querySelectorAll("button, input, select, h2, dd, p")].filter((e) =>
        e.offsetParent && !e.closest(".scroll") && e.getBoundingClientRect().right > 321)
        .map((e) => e.outerHTML.slice(0, 100))"""
    )
    assert outside == []
    array = page.locator("#finger .frame").bounding_box()
    assert -5 < array["x"] < array["x"] + array["width"] < 325  # the view follows the finger


def test_less_motion_draws_once_a_second_and_with_the_hand(opens, reading):
    page = opens(reading.address, reduced_motion="reduce")
    until(page, "vbraille.drawn >= 2")
    drawn = page.evaluate("vbraille.drawn")
    page.wait_for_timeout(400)
    assert page.evaluate("vbraille.drawn") <= drawn + 2
    page.locator("#finger").press("Shift+ArrowRight")
    until(page, "vbraille.last.x_mm > 44.9")


def test_a_recording_is_played_stepped_through_and_gone_through_by_its_events(opens):
    with Server(Recorded(), steers=False) as server:
        page = opens(server.admission.addresses[0], color_scheme="dark")

        def press(name):
            page.get_by_role("button", name=name, exact=True).click()

        def shows(at_s):
            until(page, f"Math.abs(vbraille.last.time_s - {at_s}) < 5e-4")
            felt = page.evaluate("vbraille.last.deflections[0]")
            assert felt == pytest.approx(at_s / LENGTH_S, abs=1e-4)

        shows(0)
        press("on by 0.1 s")
        shows(0.1)
        press("on by one tick")
        shows(0.101)
        press("back by one tick")
        shows(0.1)
        press("Next event")
        shows(2.4)
        page.locator("#kinds").select_option("wrong")
        assert page.locator(".moment").count() == 1
        press("Next event")
        shows(16.4)
        page.locator("#kinds").select_option("")
        page.get_by_role("button", name="the device was silent").press("Enter")
        shows(28.3)
        slider = page.get_by_role("slider", name="Time in the recording")
        assert slider.get_attribute("aria-valuetext") == "0:28.300 of 0:42.000"
        slider.press("ArrowRight")
        shows(28.4)
        slider.press("Home")
        shows(0)
        page.locator("#speed").select_option("2")
        press("Play")
        until(page, "vbraille.last.time_s > 0.2")
        press("Pause")
        assert "nothing can be turned" in text(page, "#knobs-note")
        shapes = page.locator(".moment path").evaluate_all(
            "all => all.map((one) => one.getAttribute('d'))"
        )
        assert len(set(shapes)) == 4  # a shape for each kind
        assert page.locator(".timeline .wrong").count() == 1
        assert axe(page) == []


def test_a_place_that_is_not_known_is_said_not_to_be(opens, reading):
    reading.x_mm = math.nan
    page = opens(reading.address)
    settled(page)
    assert page.locator("#finger").get_attribute("aria-valuetext").endswith("is not known.")


def test_nothing_is_loaded_from_elsewhere_and_the_page_is_small():
    folder = Path(vbraille.live.__file__).parent / "page"
    texts = {path.name: path.read_text() for path in folder.iterdir()}
    assert sum(map(len, texts.values())) <= 150_000
    for name, content in texts.items():
        assert "http" not in content.replace("http://www.w3.org/", ""), name
        assert " style=" not in content, name
