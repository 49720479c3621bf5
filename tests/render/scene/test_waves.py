"""The equations of textures: their values where they are known, and that nothing in them jumps."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.render.scene.scenes import distortions, examples, numbers, turn_peaks, vibrations
from tests.render.scene.showing import bitmap_of
from tests.render.scene.twin import deflection, places
from tests.render.scene.twinwaves import (
    distorted,
    gradual,
    intensity,
    linear_grating,
    moved_on,
    peak,
    ridges,
    share_left,
    vibrated,
    vibration,
)
from vbraille.scene.joints import Cycle
from vbraille.scene.patterns import Image, Tile
from vbraille.scene.strokes import Vibration
from vbraille.scene.textures import (
    AxialGrating,
    Gradual,
    LinearGrating,
    Peak,
    RadialGrating,
    Uniform,
    UniformVibration,
)

X = np.linspace(-60, 180, 24_001)  # steps of 0.01 mm


def at(x_mm, y_mm=0.0, parity=0, time_s=0.0):
    return places(x_mm, y_mm, parity, time_s)


def felt(pattern, x_mm, y_mm=0.0, parity=0, time_s=0.0):
    return deflection(pattern, None, at(x_mm, y_mm, parity, time_s))


# Vibration: 8.1-8.3


def test_neighbours_swing_against_each_other_from_the_middle():
    for time_s, high in ((0, 0.5), (0.005, 1), (0.01, 0.5), (0.015, 0), (1000.005, 1)):
        np.testing.assert_allclose(
            vibration(at([0, 0], 0, [0, 1], time_s), 50), [high, 1 - high], atol=1e-9
        )


def test_a_vibration_leaves_a_share():
    swing = Vibration(frequency_hz=50, amplitude=0.3)
    assert share_left(at(0, time_s=0.005), swing) == pytest.approx(1)
    assert share_left(at(0, time_s=0.015), swing) == pytest.approx(0.7)
    assert felt(UniformVibration(amplitude=0.3), 0, time_s=0.005) == pytest.approx(0.3)  # 8.2


@given(vibrations, st.floats(0, 1), st.floats(0, 10), st.booleans())
def test_what_does_not_vibrate_stays(swing, up, time_s, odd):
    values = vibrated(np.array([0.0, up, 1.0]), at(np.zeros(3), 0, int(odd), time_s), swing)
    assert values[0] == 0 if swing.of == "high" else values[2] == 1
    assert (values >= 0).all()
    assert (values <= 1 + 1e-15).all()


# Gratings: 8.4, 9.2


def test_a_ridge_begins_at_0_and_is_highest_in_its_middle():
    got = ridges(np.array([-3, -2.5, 0, 0.5, 1, 1.5, 2, 2.5, 3, 4]), Cycle(2, 1))
    np.testing.assert_allclose(got, [0, 0.5, 0, 0.5, 1, 0.5, 0, 0, 0, 1], atol=1e-12)


def test_the_angle_is_the_direction_of_travel():
    down = LinearGrating(ridge_mm=4, wave_angle_deg=90)
    assert felt(down, [5, 7], [2, 2]) == pytest.approx(1)
    assert felt(down, [2, 2], [0, 4]) == pytest.approx(0)
    same = LinearGrating(ridge_mm=4, ridge_angle_deg=0)
    np.testing.assert_allclose(felt(same, X, X / 3), felt(down, X, X / 3), atol=1e-9)
    slant = LinearGrating(ridge_mm=4, wave_angle_deg=30, start_mm=(1, 1))
    along = 2 * np.array([math.cos(math.pi / 6), math.sin(math.pi / 6)])
    assert felt(slant, 1 + along[0], 1 + along[1]) == pytest.approx(1)


def test_ridges_move_to_larger_places():
    right = LinearGrating(ridge_mm=4, velocity_mm_s=10)
    np.testing.assert_allclose(
        felt(right, X, time_s=0.1), felt(right, X - 1), atol=1e-9
    )  # 1 mm in 0.1 s
    out = RadialGrating(center_mm=(0, 0), ridge_mm=4, velocity_mm_s=10)
    assert felt(out, 2 + 1, time_s=0.1) == pytest.approx(1)
    assert felt(out, 0, 2 + 1, time_s=0.1) == pytest.approx(1)
    turning = AxialGrating(center_mm=(0, 0), ridge_deg=90, velocity_deg_s=90)
    assert felt(turning, 0, 5, time_s=0.5) == pytest.approx(1)  # 45° and 45° more
    back = LinearGrating(ridge_mm=4, velocity_mm_s=-10)
    np.testing.assert_allclose(felt(back, X, time_s=0.1), felt(back, X + 1), atol=1e-9)


@given(numbers(0.5, 12), numbers(0, 10), numbers(-500, 500), st.floats(0, 1e4))
def test_a_moving_grating_is_the_same_a_period_later(ridge, gap, velocity, time_s):
    cycle = Cycle(ridge, gap)
    if velocity == 0:
        return
    period = cycle.length / abs(velocity)
    before, after = (
        ridges(moved_on(X[::97], cycle, velocity, time), cycle)
        for time in (time_s, time_s + period)
    )
    np.testing.assert_allclose(before, after, atol=1e-6)


def test_spokes_fade_into_the_middle():
    spokes = AxialGrating(center_mm=(0, 0), ridge_deg=36)
    assert felt(spokes, 0) == 1
    cycle = math.radians(36)
    # At the start of a ridge there is nothing of the grating: only its middle is up.
    assert felt(spokes, 0.5 / cycle) == pytest.approx(1)
    assert felt(spokes, 0.75 / cycle) == pytest.approx(0.5)
    assert felt(spokes, 1.0 / cycle + 1e-9) == pytest.approx(0)
    rest = AxialGrating(center_mm=(0, 0), ridge_deg=36, middle=0)
    assert felt(rest, 0) == 0


# Distortions: 8.5, 8.6


def test_the_peak_has_the_values_that_its_mended_equation_gives():
    # With the sign as printed it would jump by 2 (K - 1) x_c at x_c.
    got = peak(np.array([80.0, 100, 120, 130]), 4, 100, 20)
    np.testing.assert_allclose(got, [80, 130, 180, 190])


def test_the_gradual_change_goes_on_with_the_last_frequency():
    # K x - (K - 1)(x0 + L/2): at x1 = 60 it is 4 · 60 - 3 · 40, and 4 more for each mm.
    np.testing.assert_allclose(gradual(np.array([20.0, 60, 61]), 4, 20, 40), [20, 120, 124])


@examples(60)
@given(distortions)
def test_a_distorted_place_has_no_jump_and_the_frequency_that_it_says(distortion):
    x = distorted(X, distortion)
    step = X[1] - X[0]
    rate = np.diff(x) / step
    middle = (X[1:] + X[:-1]) / 2
    if isinstance(distortion, Gradual):
        share = (middle - distortion.start_mm) / distortion.length_mm
        share = np.clip(share, 0, 1)
    else:
        share = np.clip(1 - np.abs(middle - distortion.center_mm) / distortion.length_mm, 0, 1)
    want = 1 + (distortion.factor - 1) * share  # k(x)
    slack = abs(distortion.factor - 1) * step / distortion.length_mm
    np.testing.assert_allclose(rate, want, rtol=0, atol=slack + 1e-9)


# Nothing jumps


def steepest(pattern, steps, time_s=0.0):
    """The steepest slope of a pattern along ways of short steps."""
    x, y = steps
    far = np.hypot(np.diff(x), np.diff(y))
    return np.max(np.abs(np.diff(felt(pattern, x, y, time_s=time_s))) / far)


def ways(rng):
    """A straight way of steps of 1 µm or so, all over a canvas, and not through its middle."""
    start, end = rng.uniform(0, 60, (2, 2))
    share = np.linspace(0, 1, 20_001)
    return start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1])


@pytest.mark.parametrize("gap_mm", [0.0, 3.0])
@pytest.mark.parametrize(
    "distortion", [None, Gradual(factor=6, start_mm=5, length_mm=30), Peak(factor=0.2)]
)
def test_gratings_are_no_steeper_than_their_ridges(rng, gap_mm, distortion):
    most = 6 if isinstance(distortion, Gradual) else 1
    for kind in (
        LinearGrating(ridge_mm=4, gap_mm=gap_mm, wave_angle_deg=25, distortion=distortion),
        RadialGrating(center_mm=(30, 30), ridge_mm=4, gap_mm=gap_mm, distortion=distortion),
    ):
        for _ in range(4):
            assert steepest(kind, ways(rng)) <= math.pi / 4 * most * (1 + 1e-6)


@examples(30)
@given(turn_peaks, st.booleans(), numbers(10, 90), st.integers(0, 2**32 - 1))
def test_spokes_do_not_jump_where_the_turn_ends_nor_in_the_middle(peak, has_peak, ridge, seed):
    spokes = AxialGrating(
        center_mm=(30, 30), ridge_deg=ridge, distortion=peak if has_peak else None, fade_mm=(0, 1)
    )
    rng = np.random.default_rng(seed)
    x, y = ways(rng)
    across = (x - x.mean() + 30.001, y - y.mean() + 30)  # passes 1 µm beside the middle
    beyond = (np.linspace(40, 60, 20_001), np.linspace(29, 31, 20_001))  # over the first spoke
    # Where an arc of a cycle is 0.05 mm, ridges are as steep as that, but hardly there.
    assert steepest(spokes, across) < 20
    assert steepest(spokes, beyond) < 3


@pytest.mark.parametrize("outside", [0.0, 0.4])
def test_images_are_no_steeper_than_their_pixels(rng, outside):
    image = Image(file="gray.png", place_mm=(15, 20), width_mm=22, height_mm=21, outside=outside)
    bitmap = bitmap_of(image)
    steepest_of_all = 0.0
    for _ in range(4):
        x, y = ways(rng)
        values = intensity(bitmap, at(x, y))
        slopes = np.abs(np.diff(values)) / np.hypot(np.diff(x), np.diff(y))
        steepest_of_all = max(steepest_of_all, slopes.max())
    assert 0 < steepest_of_all <= math.hypot(1 / 2, 1 / 3) + 1e-6


# Images: 8.4.2


def test_a_pixel_has_its_value_in_its_middle():
    image = Image(file="gray.png", place_mm=(10, 20), width_mm=22, height_mm=14)
    bitmap = bitmap_of(image)
    columns, rows = np.meshgrid(np.arange(11), np.arange(7))
    got = intensity(bitmap, at(11 + 2 * columns.ravel(), 21 + 2 * rows.ravel()))
    np.testing.assert_allclose(got, bitmap.intensities.ravel() / 65_535, atol=1e-12)
    # Half a pixel beyond the last middle it is half outside, and a whole one beyond all.
    edge = intensity(bitmap, at([32, 33, 40], 21))
    np.testing.assert_allclose(edge, [bitmap.intensities[0, -1] / 65_535 / 2, 0, 0], atol=1e-12)


def test_between_middles_an_image_is_bilinear():
    image = Image(file="gray.png", place_mm=(10, 20), width_mm=22, height_mm=14)
    bitmap = bitmap_of(image)
    gray = bitmap.intensities / 65_535
    want = 0.75 * (0.5 * gray[2, 3] + 0.5 * gray[3, 3]) + 0.25 * (
        0.5 * gray[2, 4] + 0.5 * gray[3, 4]
    )
    assert intensity(bitmap, at(10 + 7.5, 20 + 6)) == pytest.approx(want)


# Tiles


def test_a_tile_comes_back_in_both_directions_from_its_origin():
    part = LinearGrating(ridge_mm=3, distortion=Gradual(start_mm=0, length_mm=7))
    tile = Tile(width_mm=7, height_mm=5, origin_mm=(1, 2), part=part)
    x = np.array([1.5, 4.0, 7.9])
    for n in (-3, -1, 0, 2):
        np.testing.assert_allclose(felt(tile, x + 7 * n, 3.0 - 5 * n), felt(part, x - 1), atol=1e-9)


def test_a_uniform_texture_is_the_same_everywhere():
    assert set(felt(Uniform(level=0.5), X)) == {0.5}
    assert set(felt(Uniform(level=0.5, amplitude=0.5, inverted=True), X)) == {0.75}


def test_linear_gratings_have_an_abscissa_of_any_sign():
    grating = LinearGrating(ridge_mm=4, gap_mm=1, start_mm=(30, 0))
    np.testing.assert_allclose(
        linear_grating(grating, at(X)), ridges(X - 30, Cycle(4, 1)), atol=1e-9
    )
