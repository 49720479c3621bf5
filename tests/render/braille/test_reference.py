"""The twin against numbers worked out from the equations by hand."""

import math

import numpy as np
import pytest

from tests.render.braille.reference import (
    bump,
    half_sine,
    half_sine_peak,
    raised_cosine,
    texture,
)
from tests.render.scenes import cell, line, models
from vbraille.render import MAPPINGS, Tuning, single_row

ODD = [1, 3, 5, 7, 9, 11]


def test_equation_4_1():
    p = [-3, -1.01, -1, -0.5, 0, 1 / 3, 0.5, 1, 1.01, 3]
    np.testing.assert_allclose(bump(p), [-1, -1, -1, 0, 1, 0.5, 0, -1, -1, -1], atol=1e-15)


def test_equation_4_2():
    p = [-2, -1, -2 / 7, 0, 1 / 14, 1 / 7, 2 / 7, 3 / 7, 4 / 7, 1, 1.5]
    expected = [-1, -1, 1, 1, 0, -1, 1, -1, 1, -1, -1]
    np.testing.assert_allclose(texture(p, 7), expected, atol=1e-14)


@pytest.mark.parametrize("cycles", ODD)
def test_a_texture_with_odd_k_meets_rest_at_both_edges(cycles):
    np.testing.assert_allclose(texture([-1, 1], cycles), -1, atol=1e-15)
    assert texture(0, cycles) == 1


@pytest.mark.parametrize("level", [0.0, 0.25, 0.6, 1.0])
def test_equation_4_3(level):
    # A dot of 2.6 mm; p = 1/7 is 1.3 + 1.3/7 mm from its left edge.
    u_mm = [-0.1, 0.0, 0.65, 1.3, 1.3 + 1.3 / 7, 2.6, 2.7]
    delta = [
        -1,
        -1,
        level * math.cos(3.5 * math.pi),
        1,
        (1 - level) * math.cos(math.pi / 7) - level,
        -1,
        -1,
    ]
    swing = raised_cosine(u_mm, 2.6, Tuning(texture=level))
    np.testing.assert_allclose(swing, (np.array(delta) + 1) / 2, atol=1e-14)


def test_a_nominal_dot_is_half_a_sinusoid():
    u_mm = [-1, 0, 1 / 3, 0.5, 1, 1.5, 2, 2.5]
    half, root = 0.5, math.sqrt(0.5)
    swing = half_sine(u_mm, 2.0, Tuning())
    np.testing.assert_allclose(swing, [0, 0, half, root, 1, root, 0, 0], atol=1e-15)


@pytest.mark.parametrize("level", [0.25, 1.0])
def test_its_texture_has_an_eighth_of_amplitude_and_wavelength(level):
    u = np.linspace(0, 2, 513)
    textured = half_sine(u, 2.0, Tuning(texture=level)) * half_sine_peak(level)
    added = textured - half_sine(u, 2.0, Tuning())
    # Of the dot's own 4 mm: 0.5 mm, four waves a dot, the first of them upwards.
    np.testing.assert_allclose(added, level / 8 * np.sin(2 * np.pi * u / 0.5), atol=1e-14)


def test_peak_of_the_textured_dot():
    assert half_sine_peak(0.0) == 1.0
    assert half_sine_peak(1.0) == pytest.approx(1.108, abs=5e-4)


def test_the_textured_dot_fills_the_swing_at_every_level():
    theta = np.linspace(0, math.pi, 200_001)
    for level in np.linspace(0, 1, 21):
        swing = np.sin(theta) + level / 8 * np.sin(8 * theta)
        assert half_sine_peak(level) == pytest.approx(swing.max(), abs=1e-8)
        assert half_sine_peak(level) >= swing.max() - 1e-15


def test_an_eighth_is_the_most_that_never_goes_below_rest():
    theta = np.linspace(0, math.pi, 100_001)
    least = {a: np.min(np.sin(theta) + a * np.sin(8 * theta)) for a in (1 / 8, 0.127)}
    assert least[1 / 8] >= -1e-15
    assert least[0.127] < -1e-6
    assert half_sine(np.linspace(0, 2, 10_001), 2.0, Tuning(texture=1.0)).min() >= 0


def test_equation_3_1():
    # Dot 4 of the second cell, nominal: its left edge is at 10.48 + 4 mm.
    scene = models(line(0, cell(4)))["vbd"]
    x_mm = 9.0
    expected = np.zeros(12)
    for i in range(12):
        u_mm = x_mm + i * 0.7 - 14.48
        if 0 < u_mm < 2:
            expected[i] = math.sin(math.pi * u_mm / 2)
    assert np.count_nonzero(expected) == 3
    frames = scene.twin(x_mm)
    assert frames.shape == (1, 1, 12)
    np.testing.assert_allclose(frames[0, 0], expected, atol=1e-14)


@pytest.mark.parametrize("dot_row", [1, 2, 3])
def test_the_twin_shows_the_chosen_dot_row(dot_row):
    for dot in range(1, 9):
        scene = models(line(cell(dot)), mapping=single_row(dot_row))["vbd"]
        shown = scene.twin(np.linspace(-8, 7, 100)).max() > 0.5
        assert shown == (dot in (dot_row, dot_row + 3))


def test_the_twin_inverts_and_scales():
    tuning = Tuning(texture=0.0, contrast=0.3)
    scene = models(line(cell(2)), mapping=MAPPINGS["sheared"], tuning=tuning)["stress2"]
    on_the_dot = scene.twin(1.3)[0, :, 0]
    np.testing.assert_allclose(on_the_dot, [1, 0, 0.7, 0.3, 1, 0], atol=1e-15)
