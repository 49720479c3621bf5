"""What answers: signals, layers that are off, figures of a text, and the cards of a game."""

import base64
from pathlib import Path

import msgspec
import numpy as np
import pytest

from tests.live.canned import ARRAY, SIGNALS, CannedSource, canned_state
from tests.live.page.showing import comes, settled, until
from tests.live.page.test_everyone import faults
from vbraille.live.messages import (
    BesideShown,
    CardShown,
    CommandShown,
    PagePress,
    SceneShown,
    SignalShown,
)

PNG = base64.b64encode((Path(__file__).parents[3] / "docs/wave.png").read_bytes()).decode()
IMAGE = f"data:image/png;base64,{PNG}"
PICTURE = SceneShown(
    "A map", "Two streets.", 120, 80, IMAGE, off=["Mill Street (signal streets)"], off_image=IMAGE
)
ZOOM = [CommandShown("ZOOM_IN", "nearer, about the finger"), CommandShown("SWITCH_1", "Streets")]


def felt(number=1, **changes):
    """State of a picture that is felt."""
    signals = [SignalShown("slow", "1 under a slow hand"), SignalShown("streets", "key 1: on 1")]
    parts = {
        "lines": [], "knobs": [], "mapping": "", "geometry": {}, "rows_shown": [],
        "scene": PICTURE, "signals": signals, "commands": ZOOM,
    }  # fmt: skip
    return canned_state(number, **(parts | changes))


def played(number=1, turned=()):
    """State of a game with two rows of three cards."""
    rows = [
        [
            CardShown(
                f"row {row + 1}, card {column + 1}",
                "turned up" if 3 * row + column in turned else "face down",
                3 * row + column in turned,
            )
            for column in range(3)
        ]
        for row in range(2)
    ]
    commands = [CommandShown("TURN", "turn the card up"), CommandShown("OTHER", "feel the other")]
    parts = {"lines": [], "knobs": [], "blind": True, "cards": rows, "commands": commands}
    return canned_state(number, **parts)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_signals_have_their_values_and_layers_that_are_off_are_told_and_drawn(opens, scheme):
    source = CannedSource(state=felt())
    page, _ = opens(source, color_scheme=scheme)
    settled(page)
    rows = page.locator("#signal-rows tbody tr")
    assert rows.count() == 2
    until(page, "document.querySelector('#signal-rows td').textContent.trim() === '0.25'")
    assert page.locator("#signal-rows meter").nth(1).evaluate("e => e.value") == SIGNALS[1]
    assert rows.nth(0).inner_text().split("\t")[0] == "slow"
    assert "1 under a slow hand" in rows.nth(0).inner_text()
    assert "Mill Street (signal streets)" in page.locator("#off-words").inner_text()
    off = page.locator(".scene .off")
    assert off.evaluate("e => getComputedStyle(e).visibility") == "visible"
    toggle = page.get_by_role("button", name="Draw the layers that are off")
    toggle.press("Enter")
    assert toggle.get_attribute("aria-pressed") == "false"
    assert off.evaluate("e => getComputedStyle(e).visibility") == "hidden"
    assert faults(page) == []
    # A switch is pressed: nothing is off any more.
    source.show(felt(2, scene=SceneShown("A map", "Two streets.", 120, 80, IMAGE)))
    until(page, "document.getElementById('off').hidden")
    assert page.locator(".scene .off").count() == 0
    # A text comes after the picture.
    source.show(canned_state(3))
    until(page, "document.getElementById('signals').hidden")


def test_a_picture_is_zoomed_and_switched_by_buttons_of_the_same_table(opens):
    source = CannedSource(state=felt())
    page, _ = opens(source)
    page.get_by_role("button", name="Nearer, about the finger").click()
    page.get_by_role("button", name="Streets", exact=True).press("Enter")
    comes(page, lambda: source.asked == [PagePress("ZOOM_IN"), PagePress("SWITCH_1")])
    assert page.get_by_role("button", name="Next line").count() == 0
    assert page.locator("#knobs-note").is_hidden()


def test_figures_of_a_text_are_drawn_where_they_stand(opens):
    figure = SceneShown("A leaf", "", 40, 25, IMAGE, top_mm=-10.0)
    two = {"height_mm": 60.0, "travel_mm": 213.0}
    state = canned_state(figures=[figure], array=msgspec.structs.replace(ARRAY, **two))
    page, _ = opens(CannedSource(state=state))
    settled(page)
    box = page.locator("#sheet .scene image").evaluate(
        "e => ['x', 'y', 'width', 'height'].map((name) => Number(e.getAttribute(name)))"
    )
    assert box == [0, 10, 40, 25]
    assert page.locator("#sheet .line").count() == 3
    assert faults(page) == []


def test_cards_are_turned_by_a_press_and_by_keys(opens):
    source = CannedSource(state=played())
    page, _ = opens(source)
    cards = page.locator("#cards button")
    assert cards.count() == 6
    assert cards.nth(4).inner_text() == "row 2, card 2, face down"
    cards.nth(4).click()
    comes(page, lambda: source.asked == [PagePress("POINT", 4)])
    source.show(played(2, turned=(4,)))
    until(page, "document.querySelectorAll('.card')[4].classList.contains('felt')")
    assert cards.nth(4).inner_text() == "row 2, card 2, turned up, under the hand"
    for key in ("ArrowUp", "ArrowLeft", "Enter"):
        page.keyboard.press(key)
    comes(page, lambda: source.asked[1:] == [PagePress("POINT", 0)])
    page.get_by_role("button", name="Turn the card up").click()
    comes(page, lambda: source.asked[2:] == [PagePress("TURN")])
    assert page.locator("#touch").is_hidden()  # what a card is, the finger finds out
    assert faults(page) == []


def test_who_watches_a_game_sees_how_cards_lie_and_turns_none(opens):
    page, _ = opens(CannedSource(state=played(turned=(1,))), steers=False)
    assert page.locator("#cards button").count() == 0
    assert page.locator("#cards .card").nth(1).inner_text().endswith("turned up, under the hand")
    assert faults(page) == []


def test_a_game_fits_a_narrow_page(opens):
    page, _ = opens(CannedSource(state=played()), viewport={"width": 320, "height": 640})
    assert page.evaluate("document.documentElement.scrollWidth") <= 320


def test_another_mapping_is_drawn_beside_the_array_under_the_same_finger(opens):
    # Row r of the other mapping deflects by r tenths of a share that rises with the place.
    places = np.arange(0, 220, 0.1)
    rows = [np.rint(places / 220 * (row + 1) / 6 * 255).astype(np.uint8) for row in range(6)]
    beside = BesideShown(
        "mapping: compact",
        [(row % 3, row % 3) for row in range(6)],
        0.0,
        0.1,
        [base64.b64encode(row).decode() for row in rows],
    )
    source = CannedSource(state=canned_state(beside=beside))
    page, _ = opens(source)
    page.get_by_role("heading", name="Beside it: mapping: compact").wait_for()
    until(page, "Boolean(vbraille.beside)")
    x_mm, found = page.evaluate("[vbraille.beside.x_mm, vbraille.beside.deflections]")
    for n, value in enumerate(found):
        at = x_mm + (n % 10 - 4.5) * ARRAY.column_pitch_mm
        assert value == pytest.approx(at / 220 * (n // 10 + 1) / 6, abs=1 / 255)
    assert page.locator("#beside-deflection [role=gridcell]").count() == 60
    assert "dots 1 4" in page.locator("#beside-deflection").inner_text()
    assert faults(page) == []
    source.show(canned_state(2))
    until(page, "document.getElementById('beside').hidden")
