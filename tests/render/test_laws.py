"""What holds for every line, every way to show it, and every place."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.render.scenes import (
    JIT,
    cell,
    examples,
    frame_at,
    line,
    many_places,
    models,
    scenes,
    scenes_with_places,
)
from vbraille.braille.geometry import Geometry
from vbraille.render import (
    MAPPINGS,
    MODELS,
    Profile,
    Tuning,
)

FLOAT32 = 1e-7  # deflections of at most 1, rounded once


def frames_at(scene, x_mm):
    renderer = scene.renderer()
    return np.array([frame_at(renderer, x) for x in x_mm])


# Kernel equals twin


@examples(200)
@given(scenes_with_places())
def test_the_frame_kernel_equals_its_twin(drawn):
    scene, x_mm = drawn
    frames = frames_at(scene, x_mm)
    np.testing.assert_allclose(frames, scene.twin(x_mm), rtol=0, atol=1e-12 + scene.rounding(x_mm))


@examples(120)
@given(scenes_with_places())
def test_the_path_kernel_equals_its_twin(drawn):
    scene, x_mm = drawn
    frames = scene.renderer().path(x_mm)
    assert frames.dtype == np.float32
    np.testing.assert_allclose(frames, scene.twin(x_mm), rtol=0, atol=1e-6)


@pytest.mark.parametrize("profile", Profile)
@pytest.mark.parametrize(
    "crowded",
    [
        pytest.param(Geometry(3.0, 2.0, 4.0, 3.6, 14.0), id="within the cell"),
        pytest.param(Geometry(3.0, 4.0, 2.0, 3.6, 14.0), id="between cells"),
        pytest.param(Geometry(4.0, 2.0, 2.0, 3.6, 14.0), id="three at one place"),
    ],
)
def test_kernels_equal_their_twin_where_dots_overlap(profile, crowded, rng):
    masks = np.full(4, 63, np.uint8)
    scene = models(
        masks,
        profile=profile,
        geometry=crowded,
        mapping=MAPPINGS["sheared"],
        tuning=Tuning(texture=0.5, contrast=0.9),
    )["stress2"]
    x_mm = rng.uniform(-12, 26, 1000 if JIT else 50)
    twin = scene.twin(x_mm)
    np.testing.assert_allclose(frames_at(scene, x_mm), twin, rtol=0, atol=1e-12)
    np.testing.assert_allclose(scene.renderer().path(x_mm), twin, rtol=0, atol=1e-6)


# The same place, the same deflections


@examples(60)
@given(scenes_with_places(many_places), st.randoms(use_true_random=False))
def test_a_place_gives_the_same_whichever_way_the_hand_came(drawn, random):
    scene, x_mm = drawn
    renderer = scene.renderer()
    frames = renderer.path(x_mm)
    order = list(range(x_mm.size))
    random.shuffle(order)
    for way in (slice(None, None, -1), slice(None, None, 3), order):
        np.testing.assert_allclose(renderer.path(x_mm[way]), frames[way], rtol=0, atol=FLOAT32)


@examples(60)
@given(scenes_with_places(), scenes_with_places())
def test_nothing_stays_from_earlier_calls(drawn, other):
    scene, x_mm = drawn
    renderer = scene.renderer()
    first = [frame_at(renderer, x) for x in x_mm]
    renderer.path(x_mm[::-1])
    frames_at(*other)
    with np.errstate(over="ignore"):
        frame_at(renderer, 1e308)
    frame_at(renderer, np.nan)
    for x, frame in zip(x_mm[::-1], first[::-1], strict=True):
        np.testing.assert_array_equal(frame_at(renderer, x), frame)
        np.testing.assert_array_equal(frame_at(scene.renderer(), x), frame)


@examples(120)
@given(scenes_with_places())
def test_one_pitch_shifts_the_frame_by_one_column(drawn):
    scene, x_mm = drawn
    frames = frames_at(scene, x_mm)
    shifted = frames_at(scene, x_mm + scene.array.column_pitch_mm)
    atol = 1e-12 + scene.rounding(x_mm)
    np.testing.assert_allclose(shifted[:, :, :-1], frames[:, :, 1:], rtol=0, atol=atol)


# Where it is at rest, and how far it goes


@examples(120)
@given(scenes_with_places())
def test_rest_exactly_outside_every_dot(drawn):
    scene, x_mm = drawn
    width = scene.style.geometry.dot_width_mm
    idle = scene.idle()
    surface = x_mm[:, None] + scene.array.column_offsets_mm()
    outside = np.ones((x_mm.size, *scene.array.shape), bool)
    well_inside = ~outside
    for row, left_edge in scene.dots():
        aside = np.abs(surface - left_edge - width / 2)
        outside[:, row] &= aside > width / 2 + 1e-9
        well_inside[:, row] |= aside < width / 4
    frames = frames_at(scene, x_mm)
    idles = np.broadcast_to(idle, frames.shape)
    np.testing.assert_array_equal(frames[outside], idles[outside])
    np.testing.assert_array_equal(scene.renderer().path(x_mm)[outside], idles[outside])
    nominal = replace(scene, style=scene.style.replace(texture=0.0))
    swings = np.abs(frames_at(nominal, x_mm) - idle)
    # Half a swing or more in the middle half of a dot, or this law would hold of nothing at all.
    assert np.all(swings[well_inside] >= scene.style.tuning.contrast / 2 - 1e-9)


@examples(200)
@given(scenes(), st.floats())
def test_all_deflections_are_finite_and_from_0_to_1(scene, x_mm):
    renderer = scene.renderer()
    # Not compiled, the kernels are python, and numpy warns of what is too large to square.
    with np.errstate(over="ignore"):
        frames = (frame_at(renderer, x_mm), renderer.path(np.array([x_mm]))[0])
    for frame in frames:
        assert np.all((frame >= 0) & (frame <= 1))
        if not abs(x_mm) < 1e6:
            np.testing.assert_array_equal(frame, np.broadcast_to(scene.idle(), frame.shape))


@pytest.mark.parametrize("texture", [0.25, 0.5, 1.0])
def test_rounding_never_goes_beyond_the_ends_of_the_swing(texture):
    # Where a dot just reaches them: the peak of the VBD's, and every half wave of the texture.
    theta = np.linspace(0, np.pi, 1_000_001)
    peak = theta[np.argmax(np.sin(theta) + texture / 8 * np.sin(8 * theta))] / np.pi
    for name, reached in (
        ("vbd", {7: [peak]}),
        ("stress2", {k: [(1 + j / k) / 2 for j in range(-k, k + 1)] for k in (5, 7, 9, 11)}),
    ):
        for cycles, widths in reached.items():
            tuning = Tuning(texture=texture, cycles=cycles)
            renderer = models(line(cell(1)), tuning=tuning)[name].renderer()
            width_mm = MODELS[name].style.geometry.dot_width_mm
            for u_mm in np.outer(widths, [width_mm]) + np.linspace(-2e-9, 2e-9, 21):
                for x_mm in u_mm:
                    on_the_dot = frame_at(renderer, x_mm)[0, 0]
                    assert 0 <= on_the_dot <= 1


@examples(200)
@given(scenes_with_places(), st.floats(-9, -1))
def test_no_slope_is_steeper_than_the_equations_allow(drawn, exponent):
    scene, x_mm = drawn
    half_step_mm = 10**exponent
    change = frames_at(scene, x_mm + half_step_mm) - frames_at(scene, x_mm - half_step_mm)
    most = scene.steepest_per_mm() * 2 * half_step_mm
    assert np.abs(change).max() <= most + 1e-12 + 2 * scene.rounding(x_mm)


# Contrast


@examples(120)
@given(scenes_with_places())
def test_contrast_scales_the_swing_about_the_idle_end(drawn):
    scene, x_mm = drawn
    full = replace(scene, style=scene.style.replace(contrast=1.0))
    swings = frames_at(full, x_mm) - scene.idle()
    expected = scene.idle() + scene.style.tuning.contrast * swings
    np.testing.assert_allclose(frames_at(scene, x_mm), expected, rtol=0, atol=1e-12)
