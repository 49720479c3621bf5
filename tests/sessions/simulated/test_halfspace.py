"""Strain below an elastic half-space: its equations, held against a numerical solution."""

import numpy as np
import pytest

from vbraille.sessions.simulated.halfspace import DEPTH_MM, reference_strain, strains_below


@pytest.mark.parametrize("wavelength_mm", [1.5, 3.0, 6.0])
def test_a_wave_is_weakened_and_turned_as_equation_4_says(wavelength_mm):
    pairs, pitch_mm = 2001, 0.05
    along, shear = strains_below(pairs, pitch_mm)
    k = 2 * np.pi / wavelength_mm
    x_mm = (np.arange(pairs) - pairs // 2) * pitch_mm
    wave = np.cos(k * x_mm) * np.exp(-((x_mm / 15) ** 2))  # its ends are of an array with one
    middle = slice(pairs // 2 - 20, pairs // 2 + 20)
    gain = (1 - k * DEPTH_MM) * np.exp(-k * DEPTH_MM)
    assert (wave @ along)[middle] == pytest.approx(gain * np.cos(k * x_mm[middle]), abs=0.01)
    assert (wave @ shear)[middle] == pytest.approx(gain * np.sin(k * x_mm[middle]), abs=0.01)


def test_displacement_of_equation_4_is_in_equilibrium_and_leaves_the_surface_flat():
    k, step = 2.0, 1e-4
    z = np.arange(0.0, 2.0, step)
    along, down = (1 - k * z) * np.exp(-k * z), -1j * k * z * np.exp(-k * z)
    pressure = -2j * k * np.exp(-k * z)  # with μ = 1
    inside = slice(2, -2)

    def slope(of):
        return np.gradient(of, step)

    assert np.abs(1j * k * along + slope(down))[inside].max() < 1e-6  # no divergence
    bent = slope(slope(along)) - k**2 * along
    assert np.abs(bent - 1j * k * pressure)[inside].max() < 1e-3
    bent = slope(slope(down)) - k**2 * down
    assert np.abs(bent - slope(pressure))[inside].max() < 1e-3
    assert abs(-pressure[0] + 2 * slope(down)[0]) < 1e-3  # no normal stress at the surface


def test_an_even_stretch_of_all_the_surface_is_the_same_below():
    along, shear = strains_below(4001, 0.5)
    assert along.sum(axis=0)[2000] == pytest.approx(1, abs=1e-3)
    assert shear.sum(axis=0)[2000] == pytest.approx(0, abs=1e-9)


def test_the_unit_of_evidence_does_not_depend_on_pairs_that_are_fine():
    assert reference_strain(2.0, 0.1) == pytest.approx(reference_strain(2.0, 0.2), rel=0.05)
