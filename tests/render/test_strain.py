"""Strain between neighbouring actuators, Lévesque 2009, fig. 3.10."""

from dataclasses import replace

import numpy as np
import pytest

from tests.render.scenes import JIT, cell, frame_at, line
from tests.shown import array_of, from_left
from vbraille.render import VBD, Tuning

PITCH_MM = 0.7
PAIR = array_of(rows=1, columns=2, column_pitch_mm=PITCH_MM, row_pitch_mm=1.0)
STEP_MM = 0.001 if JIT else 0.005


def neighbours_over_a_dot(width_mm):
    """Deflections of two neighbours, and the strain between them, as the hand goes over a dot."""
    style = replace(VBD.style.replace(dot_width_mm=width_mm), tuning=Tuning())
    renderer = from_left(line(cell(1)), style, PAIR)
    x_mm = np.arange(-PITCH_MM - 0.1, width_mm + 0.1, STEP_MM)
    left, right = np.array([frame_at(renderer, x)[0] for x in x_mm]).T
    return left, right, (right - left) / PITCH_MM


@pytest.mark.parametrize("width_mm", [0.3, 0.5, 0.65])
def test_dots_narrower_than_the_pitch_move_one_neighbour_at_a_time(width_mm):
    left, right, strain = neighbours_over_a_dot(width_mm)
    assert not np.any((left > 0) & (right > 0))
    # One way, then nothing at all while the dot is between the two, then the other way.
    between = slice(np.flatnonzero(strain > 0)[-1] + 1, np.flatnonzero(strain < 0)[0])
    assert not np.any(left[between])
    assert not np.any(right[between])
    stretch_mm = STEP_MM * (between.stop - between.start)
    assert stretch_mm == pytest.approx(PITCH_MM - width_mm, abs=2 * STEP_MM)
    assert strain.max() == pytest.approx(1 / PITCH_MM, rel=1e-3)
    assert strain.min() == pytest.approx(-1 / PITCH_MM, rel=1e-3)


@pytest.mark.parametrize("width_mm", [0.75, 1.0, 1.3, 1.5, 2.0, 3.0])
def test_dots_wider_than_the_pitch_turn_expansion_into_compression(width_mm):
    left, right, strain = neighbours_over_a_dot(width_mm)
    both = (left > 0) & (right > 0)
    assert STEP_MM * both.sum() == pytest.approx(width_mm - PITCH_MM, abs=2 * STEP_MM)
    # While both are off rest strain falls all the time, from one sign to the other.
    falling = strain[both]
    assert np.all(np.diff(falling) < 0)
    assert falling[0] > 0 > falling[-1]
    assert not np.any(strain[: np.argmax(both)] < 0)
    assert not np.any(strain[both.size - np.argmax(both[::-1]) :] > 0)


@pytest.mark.parametrize("width_mm", [0.3, 0.75, 1.0, 1.35, 1.5, 2.0, 2.5, 3.0])
def test_beyond_twice_the_pitch_strain_stays_below_its_maximum(width_mm):
    _, _, strain = neighbours_over_a_dot(width_mm)
    peak = 1.0 if width_mm <= 2 * PITCH_MM else np.sin(np.pi * PITCH_MM / width_mm)
    assert (peak < 0.999) == (width_mm > 2 * PITCH_MM)
    assert strain.max() == pytest.approx(peak / PITCH_MM, rel=1e-3)
    assert strain.min() == pytest.approx(-peak / PITCH_MM, rel=1e-3)
