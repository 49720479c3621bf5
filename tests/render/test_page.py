"""A page of lines: which line is under the array, and the array turned."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.render.braille.reference import deflections
from tests.render.scenes import JIT, examples
from tests.shown import LATERO, by_left_column, part_of
from vbraille.render import MAPPINGS, STRESS2, VBD, Straying
from vbraille.render.work import NO_PART, ProgramKind

LINES = 25
MODELS = {
    "stress2": (STRESS2.style, STRESS2.display),
    "vbd": (VBD.style, VBD.display),
    "8 x 8, inverted rows": (replace(STRESS2.style, mapping=MAPPINGS["sheared"]), LATERO),
}
BOTH = pytest.mark.parametrize(("style", "display"), MODELS.values(), ids=MODELS)


def page_of(style, display, rng, lines=LINES):
    """Lines of different lengths, one of them empty; and what they compile to."""
    masks = [rng.integers(1, 64, 3 + n % 5).astype(np.uint8) for n in range(lines)]
    masks[lines // 2] = np.zeros(0, np.uint8)
    return masks, style.render_page(masks, display)


def frame_of(program, x_mm, **where):
    out = np.full(program.shape, np.nan)
    program.frame(x_mm, out, **where)
    return out


def turned(style, display, masks, left_mm, theta_rad):
    """The frame of a line under a turned array, each actuator by its own place along x.

    ``left_mm`` is where the left column is when the array is not turned; what turns stays at
    the height of the array's centre.
    """
    right_mm, down_mm = np.meshgrid(
        display.column_offsets_mm(), display.row_offsets_mm() - display.depth_mm / 2
    )
    x_mm = left_mm + right_mm * math.cos(theta_rad) + down_mm * math.sin(theta_rad)
    rows = [
        deflections(along_mm, masks, style, display, 0.0)[:, row, 0]
        for row, along_mm in enumerate(x_mm)
    ]
    return np.array(rows)


@BOTH
def test_a_page_shows_everywhere_the_line_nearest_the_centre(style, display, rng):
    masks, page = page_of(style, display, rng)
    lines = [style.render(line, display) for line in masks]
    pitch = style.geometry.line_pitch_mm
    assert page.kind is ProgramKind.PAGE
    shown = set()
    for _ in range(4000 if JIT else 400):
        x_mm, y_mm = rng.uniform(-15, 90), rng.uniform(0, LINES * pitch)
        part = part_of(page, y_mm)
        centres = (np.arange(LINES) + 0.5) * pitch
        assert part == np.abs(centres - y_mm).argmin()
        shown.add(part)
        np.testing.assert_array_equal(frame_of(page, x_mm, part=part), frame_of(lines[part], x_mm))
    assert shown == set(range(LINES))


@BOTH
def test_above_and_below_a_page_there_is_nothing(style, display, rng):
    _, page = page_of(style, display, rng)
    pitch = style.geometry.line_pitch_mm
    blank = style.render(np.zeros(0, np.uint8), display)
    for y_mm, part in (
        (-0.001, -1), (-1e9, -1), (math.nan, -1), (-math.inf, -1),
        (0.0, 0), (LINES * pitch - 1e-9, LINES - 1),
        (LINES * pitch, LINES), (1e9, LINES), (math.inf, LINES),
    ):  # fmt: skip
        assert part_of(page, y_mm) == part
    for part in (-1, LINES, NO_PART, LINES + 1, 10**6, -(10**6)):
        for x_mm in (0.0, 3.0, 20.0):
            np.testing.assert_array_equal(frame_of(page, x_mm, part=part), frame_of(blank, x_mm))


@pytest.mark.parametrize("hysteresis", [0.0, 0.25, 0.9])
def test_a_line_stays_until_its_edge_is_left_behind(hysteresis):
    style = STRESS2.style
    pitch = style.geometry.line_pitch_mm
    masks = [np.full(3, 63, np.uint8)] * 4
    page = style.replace(straying=Straying(band=hysteresis)).render_page(masks, STRESS2.display)
    margin_mm = hysteresis / 2 * pitch

    def crossed(places_mm):
        part, at = NO_PART, {}
        for y_mm in places_mm:
            now = part_of(page, y_mm, part)
            if now != part and part != NO_PART:
                at[part, now] = y_mm
            part = now
        return at

    way_mm = np.arange(0.3, 4 * pitch + 2 * margin_mm + 1, 0.01)
    down, up = crossed(way_mm), crossed(way_mm[::-1])
    # The page's own edges have it, too.
    assert list(down) == [(n, n + 1) for n in range(4)]
    assert list(up) == [(n + 1, n) for n in (3, 2, 1, 0)]
    for n in range(4):
        assert down[n, n + 1] == pytest.approx((n + 1) * pitch + margin_mm, abs=0.011)
        assert up[n + 1, n] == pytest.approx((n + 1) * pitch - margin_mm, abs=0.011)


@examples(200)
@given(st.floats(-40, 400), st.floats(-40, 400))
def test_a_hand_that_trembles_at_a_boundary_stays_on_its_line(y_mm, other_mm):
    style = STRESS2.style
    page = style.render_page([np.full(3, 63, np.uint8)] * LINES, STRESS2.display)
    part = part_of(page, y_mm)
    assert part_of(page, y_mm, part) == part
    near = np.clip(other_mm, y_mm - style.geometry.line_pitch_mm / 8, y_mm)
    moved = part_of(page, near, part)
    assert moved == part
    assert part_of(page, other_mm, part) in (part, part_of(page, other_mm))


def test_a_line_alone_has_one_part_wherever_the_array_is():
    line = STRESS2.style.render(np.full(3, 63, np.uint8), STRESS2.display)
    for before in (NO_PART, 0, 3):
        assert [part_of(line, y_mm, before) for y_mm in (-1e9, 0, 50.0, math.nan)] == [0] * 4


@BOTH
@pytest.mark.parametrize("theta_rad", [0.2, -0.7, math.pi / 2, 3.0, 1e-9])
def test_of_a_turned_array_each_actuator_is_at_its_own_place(style, display, theta_rad, rng):
    masks = rng.integers(1, 64, 5).astype(np.uint8)
    line = by_left_column(style.render(masks, display))
    page = by_left_column(style.render_page([masks, masks[::-1]], display))
    for x_mm in rng.uniform(-10, 50, 60 if JIT else 10):
        want = turned(style, display, masks, x_mm, theta_rad)
        got = frame_of(line, x_mm, theta_rad=theta_rad)
        np.testing.assert_allclose(got, want, rtol=0, atol=1e-10)
        np.testing.assert_array_equal(frame_of(page, x_mm, theta_rad=theta_rad), got)


def test_what_makes_no_page():
    line = np.full(3, 63, np.uint8)
    with pytest.raises(ValueError, match="a page of no lines cannot be shown"):
        STRESS2.style.render_page([], STRESS2.display)
    with pytest.raises(ValueError, match="a page has no frames along a line"):
        STRESS2.style.render_page([line], STRESS2.display).path(np.arange(3.0))
