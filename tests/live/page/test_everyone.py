"""The page for everybody: axe, keys alone, narrow and enlarged, less motion, lost connections."""

import numpy as np
import pytest
from axe_playwright_python.sync_playwright import Axe

from tests.live.page.showing import Served, settled, until
from tests.live.scenes import Scene
from tests.tiers import heavy


def faults(page):
    """What axe finds, a line each."""
    found = Axe().run(page).response["violations"]
    return [f"{rule['id']}: {node['html'][:120]}" for rule in found for node in rule["nodes"]]


def open_all(page):
    """Open what is not open at first."""
    page.locator("summary").click()
    page.get_by_role("button", name="Say where the finger is").click()
    if page.locator("#draw-map").is_visible():
        page.locator("#draw-map").click()
        until(page, "document.querySelector('#map-figure img')?.naturalWidth > 0")


@pytest.mark.parametrize(
    ("kind", "scheme", "steers"),
    [
        ("still", "light", True),
        ("playback", "dark", True),
        pytest.param("still", "dark", True, marks=heavy),
        pytest.param("still", "light", False, marks=heavy),
        pytest.param("playback", "light", False, marks=heavy),
        pytest.param("blind", "light", False, marks=heavy),
        pytest.param("blind", "dark", True, marks=heavy),
        pytest.param("page", "dark", True, marks=heavy),
        pytest.param("vbd", "light", True, marks=heavy),
    ],
)
def test_axe_finds_nothing(opens, kind, scheme, steers):
    page, _ = opens(Scene(kind), steers=steers, color_scheme=scheme)
    open_all(page)
    settled(page) if kind != "playback" else None
    assert faults(page) == []


STANDING_CLOCK = "performance.now = () => 5;"


def test_the_first_picture_is_told_at_once_however_quickly_the_page_loads(opens):
    page, _ = opens(Scene("still"), script=STANDING_CLOCK)
    until(page, "vbraille.told > 0")
    assert page.locator("#readout").inner_text().split("\n")[:2] == ["x", "117.3 mm"]
    assert page.locator("#finger").get_attribute("aria-valuenow") == "117.3"
    assert "line 2" in page.locator("#finger").get_attribute("aria-valuetext")


class Lost(Scene):
    """A hand whose place is not known."""

    def x_mm(self, t):
        return np.full(np.shape(t), np.nan)


def test_the_place_of_a_hand_that_is_not_known_is_said_not_to_be(opens):
    page, _ = opens(Lost("still"))
    settled(page)
    finger = page.locator("#finger")
    assert finger.get_attribute("aria-valuetext") == "The place of the array is not known."
    assert faults(page) == []


def test_a_lost_connection_is_said_once_and_begun_again(opens):
    page, served = opens(Scene("still"), steers=False)
    page.evaluate(
        """window.told = []; new MutationObserver(() => told.push(document.getElementById(
        "notice").textContent)).observe(document.getElementById("notice"), { childList: true })"""
    )
    served.__exit__()
    until(page, "told.length > 0")
    page.wait_for_timeout(700)  # another attempt fails meanwhile
    assert page.evaluate("told") == [
        "The connection to vbraille is lost. It is tried again every few seconds."
    ]
    assert faults(page) == []
    assert page.get_by_role("button", name="Next line").count() == 0
    with Served(Scene("still"), port=served.port):
        until(page, "told.at(-1) !== told[0]")
        assert page.evaluate("told.at(-1)") == "Connected again."
        settled(page)


@heavy
def test_who_is_not_let_in_reads_why_and_may_try_again(opens):
    scene = Scene("still")
    page, served = opens(scene, steers=False)
    page.goto("about:blank")
    page.goto(served.watching + "#nobodys-token")
    until(page, "document.getElementById('notice').textContent.includes('token')")
    until(page, "document.getElementById('again').hidden === false")
    assert page.locator("#notice").inner_text().endswith("open the address that vbraille said.")
    assert faults(page) == []


def keys_of(page, count):
    """What the tabulator key comes to, one after the other, with whether that can be seen."""
    page.evaluate("document.body.tabIndex = -1; document.body.focus()")
    found = []
    for _ in range(count):
        page.keyboard.press("Tab")
        found.append(
            page.evaluate(
                """(() => { const e = document.activeElement;
                const ring = e.querySelector(".ring");
                const frame = e.closest(".skin")?.parentElement.querySelector(".chosen");
                const outlined = (shown) => getComputedStyle(shown).outlineStyle !== "none";
                return [e.id || e.textContent.trim().slice(0, 30) || e.className.baseVal,
                  frame ? outlined(frame) : outlined(e) ||
                    Boolean(ring && getComputedStyle(ring).stroke !== "none")];
                })()"""
            )
        )
    return found


def test_keys_alone_reach_everything_and_focus_is_seen(opens):
    page, _ = opens(Scene("still"))
    stops = keys_of(page, 14)
    names = [name for name, _ in stops]
    assert names[:5] == ["Skip to the page", "say", "freeze", "finger", "said"]
    assert "actuator" in names
    assert all(seen for _, seen in stops), stops
    assert len(set(names)) == len(names)

    # The actuators are one stop, with arrow keys inside.
    chosen = page.locator("#deflection [aria-selected=true]")
    assert page.locator("#deflection [tabindex='0']").count() == 1
    chosen.focus()
    for key in ("ArrowDown", "ArrowRight", "End", "Home"):
        page.keyboard.press(key)
    assert page.evaluate("document.activeElement.dataset.row") == "1"
    assert page.evaluate("document.activeElement.dataset.column") == "0"
    frame, cell = (
        page.locator(f"#deflection {one}").bounding_box() for one in (".chosen", ":focus")
    )
    assert list(frame.values()) == pytest.approx(list(cell.values()), abs=3)
    label = page.evaluate("document.activeElement.getAttribute('aria-label')")
    assert label.startswith("row 2, column 1: deflection 0")
    until(page, "document.querySelectorAll('.trace')[1].textContent.includes('row 2, column 1')")

    # The picture can be held.
    page.get_by_role("button", name="Hold the picture").press("Enter")
    page.wait_for_timeout(50)
    drawn = page.evaluate("vbraille.drawn")
    page.wait_for_timeout(150)
    assert page.evaluate("vbraille.drawn") == drawn
    page.get_by_role("button", name="Hold the picture").press("Enter")
    settled(page)


@pytest.mark.parametrize(
    ("width", "kind"),
    [
        (320, "playback"),
        pytest.param(640, "live", marks=heavy),
        pytest.param(320, "live", marks=heavy),
    ],
)
def test_a_narrow_page_needs_no_scrolling_sideways(opens, width, kind):
    """320 pixels are a small phone, and a screen of 1280 at 400 %; 640 are it at 200 %."""
    page, _ = opens(Scene(kind), viewport={"width": width, "height": 640})
    open_all(page)
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    outside = page.evaluate(
        f"""[...document.querySelectorAll("button, input, select, h2, dd, p")].filter((e) =>
        e.offsetParent && !e.closest(".scroll") && e.getBoundingClientRect().right > {width} + 1)
        .map((e) => e.outerHTML.slice(0, 100))"""
    )
    assert outside == []
    until(page, "Boolean(document.querySelector('#finger[style]'))")
    array = page.locator("#finger .frame").bounding_box()
    assert array["x"] > -5
    assert array["x"] + array["width"] < width + 5  # the view follows the finger


def test_less_motion_draws_once_a_second_and_with_the_hand(opens):
    page, _ = opens(Scene("still"), reduced_motion="reduce")
    until(page, "vbraille.drawn >= 2")
    drawn, taken_ms = page.evaluate(
        """(async () => { const drawn = vbraille.drawn, began = performance.now();
        await new Promise((done) => setTimeout(done, 400));
        return [vbraille.drawn - drawn, performance.now() - began]; })()"""
    )
    assert drawn <= 1 + taken_ms / 900
    assert "Motion is reduced" in page.locator("#manual").inner_text()
    page.locator("#finger").press("Shift+ArrowRight")
    until(page, "Math.abs(vbraille.last.x_mm - 122.3) < 1e-3")
