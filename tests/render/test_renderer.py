"""The kernels, through the renderer, against the equations written out."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.render.scenes import cell, examples, frame_at, line, models
from tests.shown import array_of, from_left
from tests.tiers import by_tier
from vbraille.render import (
    MAPPINGS,
    STRESS2,
    VBD,
    Tuning,
    single_row,
)
from vbraille.render.frames import blend

ONE = array_of(rows=1, columns=1, column_pitch_mm=1.0, row_pitch_mm=1.0)
PEAK = {0.0: 1.0, 1.0: 1.107908722138734}  # M(a) by texture level, a = T / 8


def half_sine(u_mm, width_mm, level):
    if not 0 < u_mm < width_mm:
        return 0.0
    theta = math.pi * u_mm / width_mm
    return (math.sin(theta) + level / 8 * math.sin(8 * theta)) / PEAK[level]


def raised_cosine(u_mm, width_mm, level, cycles=7):
    p = u_mm / (width_mm / 2) - 1
    if not -1 <= p <= 1:
        return 0.0
    delta = (1 - level) * math.cos(math.pi * p) + level * math.cos(cycles * math.pi * p)
    return (delta + 1) / 2


@pytest.mark.parametrize("level", [0.0, 1.0])
def test_the_vbd_samples_one_function_at_twelve_places(level):
    scene = models(line(cell(1), 0, cell(1, 4)), tuning=Tuning(texture=level))["vbd"]
    renderer = scene.renderer()
    for x_mm in np.linspace(-9, 30, 200):
        frame = frame_at(renderer, x_mm)
        assert frame.shape == (1, 12)
        expected = [
            sum(half_sine(x_mm + i * 0.7 - edge, 2.0, level) for edge in (0, 20.96, 24.96))
            for i in range(12)
        ]
        np.testing.assert_allclose(frame[0], expected, rtol=0, atol=1e-12)


@pytest.mark.parametrize("level", [0.0, 0.25, 1.0])
def test_the_stress2_samples_its_dots_at_ten_places_of_each_row(level):
    scene = models(line(0, cell(1, 5)), tuning=Tuning(texture=level))["stress2"]
    renderer = scene.renderer()
    for x_mm in np.linspace(-2, 20, 200):
        expected = np.zeros((6, 10))
        for i in range(10):
            expected[0, i] = raised_cosine(x_mm + i * 1.2 - 11.1, 2.6, level)
            expected[2, i] = raised_cosine(x_mm + i * 1.2 - 14.8, 2.6, level)
        np.testing.assert_allclose(frame_at(renderer, x_mm), expected, rtol=0, atol=1e-12)


@pytest.mark.parametrize("level", [0.3, 1.0])
@pytest.mark.parametrize("cycles", [1, 3, 5, 7, 9, 11])
def test_the_polynomial_of_every_k_is_the_cosine(cycles, level):
    style = STRESS2.style.replace(mapping=single_row(1), texture=level, cycles=cycles)
    renderer = from_left(line(cell(1)), style, ONE)
    u_mm = np.linspace(-0.2, 2.8, 601)
    frames = [frame_at(renderer, u)[0, 0] for u in u_mm]
    expected = [raised_cosine(u, 2.6, level, cycles) for u in u_mm]
    np.testing.assert_allclose(frames, expected, rtol=0, atol=1e-12)


@pytest.mark.parametrize("mapping", MAPPINGS.values(), ids=MAPPINGS)
def test_a_mapping_that_needs_more_rows_than_there_are(mapping):
    needs = f"^mapping {mapping.name} needs {mapping.rows} actuator rows from row 0 on"
    says = f"{needs}; the array has 1$"
    with pytest.raises(ValueError, match=says):
        VBD.style.replace(mapping=mapping).render(line(1), VBD.display)


# Where frames are put


@pytest.mark.parametrize("shape", [(1, 10), (5, 10), (7, 10), (6, 9), (6, 11), (10, 6)])
def test_a_frame_of_another_shape_is_refused(shape):
    renderer = models(line(63))["stress2"].renderer()
    for dtype in by_tier((np.float64,), *[(np.float32, np.float64)] * 2):
        out = np.zeros(shape, dtype)
        with pytest.raises(ValueError, match=r"^the frame has not the shape of the array$"):
            renderer.frame(1.3, out)
        assert not out.any()


# From one frame to another

levels = st.floats(0, 1)
frames = st.tuples(levels, levels).map(lambda held: np.array([held]))


def blended(before, after, share):
    out = np.full_like(before, np.nan)
    blend(before, after, share, out)
    return out


@examples(200)
@given(frames, frames, levels)
def test_a_blend_is_linear_and_between_the_two(before, after, share):
    out = blended(before, after, share)
    np.testing.assert_allclose(out, (1 - share) * before + share * after, rtol=0, atol=1e-15)
    assert np.all(out >= np.minimum(before, after))
    assert np.all(out <= np.maximum(before, after))
    np.testing.assert_array_equal(blended(before, after, 0.0), before)
    np.testing.assert_array_equal(blended(before, after, 1.0), after)


def test_a_blend_from_rest_to_a_frame():
    renderer = models(line(63))["stress2"].renderer()
    frame = frame_at(renderer, STRESS2.style.geometry.dot_width_mm / 3)
    rest = np.zeros_like(frame)
    np.testing.assert_allclose(blended(rest, frame, 0.25), frame / 4, rtol=0, atol=1e-15)
    np.testing.assert_allclose(blended(frame, rest, 0.25), frame * 0.75, rtol=0, atol=1e-15)
