"""The equations of textures: their values where they are known, and that nothing in them jumps."""

import math

import numpy as np
import pytest

from tests.render.scene.showing import felt
from vbraille.scene.patterns import (
    AxialGrating,
    Gradual,
    LinearGrating,
    RadialGrating,
    Tile,
)

X = np.linspace(-60, 180, 24_001)  # steps of 0.01 mm


# Vibration: 8.1-8.3


# Gratings: 8.4, 9.2


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


# Nothing jumps


# Images: 8.4.2


# Tiles


def test_a_tile_comes_back_in_both_directions_from_its_origin():
    part = LinearGrating(ridge_mm=3, distortion=Gradual(start_mm=0, length_mm=7))
    tile = Tile(width_mm=7, height_mm=5, origin_mm=(1, 2), part=part)
    x = np.array([1.5, 4.0, 7.9])
    for n in (-3, -1, 0, 2):
        np.testing.assert_allclose(felt(tile, x + 7 * n, 3.0 - 5 * n), felt(part, x - 1), atol=1e-9)
