"""A page of which each actuator shows what lies under it, and how far an array may be turned."""

import math

import numpy as np
import pytest

from tests.render.braille.reference import SWINGS
from tests.render.test_page import frame_of
from vbraille.braille.cells import PLACES
from vbraille.render import LATERO, STRESS2, STRESS2_8X8, VBD, Straying
from vbraille.render.braille.style import BAND_BOUNDS, MOST_TILT_RAD

MODELS = {model.name: model for model in (STRESS2, STRESS2_8X8, LATERO, VBD)}
BOTH = pytest.mark.parametrize("model", MODELS.values(), ids=MODELS)


def free(model, **changes):
    return model.style.replace(straying=Straying("free"), **changes)


def lying_under(style, display, lines, x_mm, y_mm, theta):
    """The frame of a page by the place of each actuator and of each dot, all in plain loops."""
    geometry, out = style.geometry, np.zeros(display.shape)
    radius = geometry.dot_width_mm / 2
    for row, column in np.ndindex(display.shape):
        right = (column - (display.columns - 1) / 2) * display.column_pitch_mm
        down = (row - (display.rows - 1) / 2) * display.row_pitch_mm
        x = x_mm + right * math.cos(theta) + down * math.sin(theta)
        y = y_mm + down * math.cos(theta) - right * math.sin(theta)
        for number, masks in enumerate(lines):
            middle_mm = (number + 0.5) * geometry.line_pitch_mm
            for cell, mask in enumerate(masks):
                for dot, (side, dot_row) in PLACES.items():
                    if not mask >> (dot - 1) & 1:
                        continue
                    dot_x = cell * geometry.cell_pitch_mm + side * geometry.dot_spacing_mm + radius
                    dot_y = middle_mm + (dot_row - 1) * geometry.row_spacing_mm
                    far = math.hypot(x - dot_x, y - dot_y)
                    if far < radius:
                        felt = style.tuning.contrast * SWINGS[style.profile](
                            radius + math.copysign(far, x - dot_x), 2 * radius, style.tuning
                        )
                        out[row, column] = max(out[row, column], felt)
    return out


@BOTH
def test_each_actuator_shows_what_lies_under_it(model, rng):
    lines = [rng.integers(1, 256, 3 + n).astype(np.uint8) for n in range(4)]
    lines[1] = np.zeros(0, np.uint8)
    style = free(model)
    page = style.render_page(lines, model.display)
    pitch_mm = style.geometry.line_pitch_mm
    swung = 0.0
    for x_mm, y_mm, theta in rng.uniform((-10, -5, -0.6), (60, 4.5 * pitch_mm, 0.6), (60, 3)):
        want = lying_under(style, model.display, lines, x_mm, y_mm, theta)
        got = frame_of(page, x_mm, y_mm=y_mm, theta_rad=theta)
        np.testing.assert_allclose(got, want, rtol=0, atol=1e-10)
        swung = max(swung, want.max())
    assert swung > 0.5


def test_dots_that_overlap_are_felt_by_the_larger_swing(rng):
    lines = list(rng.integers(0, 256, (3, 5)).astype(np.uint8))
    style = free(STRESS2_8X8, dot_width_mm=6.0, cell_gap_mm=4.0, texture=0.0, contrast=0.7)
    page = style.render_page(lines, STRESS2_8X8.display)
    for x_mm, y_mm in rng.uniform((-10, 0), (40, 3 * style.geometry.line_pitch_mm), (30, 2)):
        want = lying_under(style, STRESS2_8X8.display, lines, x_mm, y_mm, 0.0)
        got = frame_of(page, x_mm, y_mm=y_mm)
        np.testing.assert_allclose(got, want, rtol=0, atol=1e-10)


def test_a_free_page_stands_still_while_the_line_under_the_finger_changes():
    page = free(STRESS2).render_page([np.full(4, 63, np.uint8)] * 3, STRESS2.display)
    y_mm = STRESS2.style.geometry.line_pitch_mm
    frames = [frame_of(page, 20.0, y_mm=y_mm, part=part) for part in (-1, 0, 1, 2)]
    for frame in frames[1:]:
        np.testing.assert_array_equal(frame, frames[0])


def test_a_line_alone_is_what_it_is_however_pages_are():
    masks = np.array([63, 5, 40], np.uint8)
    for model in MODELS.values():
        lines = [style.render(masks, model.display) for style in (model.style, free(model))]
        np.testing.assert_array_equal(lines[0].table, lines[1].table)
        np.testing.assert_array_equal(lines[0].numbers, lines[1].numbers)


def test_beyond_the_most_that_it_may_be_turned_an_array_is_at_rest_until_it_is_upright_again():
    page = STRESS2.style.render_page([np.full(4, 63, np.uint8)], STRESS2.display)
    most = MOST_TILT_RAD
    theta = np.array([0.0, 0.99, 1.01, 0.99, 0.86, 0.84, 0.99, -1.01, -0.86, -0.84]) * most
    x_mm, y_mm = np.full(theta.size, 20.0), np.full(theta.size, 7.0)
    _, frames = page.poses(x_mm, y_mm, theta)
    shown = frames.any(axis=(1, 2)).tolist()
    assert shown == [True, True, False, False, False, True, True, False, False, True]


@pytest.mark.parametrize(("manner", "band"), [("wild", 0.2), ("line", -0.1), ("line", 1.0)])
def test_what_no_straying_can_be(manner, band):
    with pytest.raises(ValueError, match="it must be"):
        Straying(manner, band)
    assert BAND_BOUNDS == (0.0, 0.9)
