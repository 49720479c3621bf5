"""The equations of textures: their values where they are known, and that nothing in them jumps."""

import math

import numpy as np
import pytest

from tests.render.scene.showing import felt
from vbraille.scene.patterns import (
    LinearGrating,
)

X = np.linspace(-60, 180, 24_001)  # steps of 0.01 mm


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
