"""Every cell of a line can be told again from frames and positions alone."""

from dataclasses import replace

import numpy as np
import pytest

from tests.render.reader import read_back
from tests.render.scenes import JIT, cell
from tests.shown import LATERO
from vbraille.braille import geometry
from vbraille.render import MAPPINGS, STRESS2, VBD, BrailleStyle, Profile, Tuning, single_row

TEXTURES = [0.0, 0.25, 1.0] if JIT else [0.25]
STEP_MM = 0.7 if JIT else 1.5


def every_cell(rng):
    """A line of all 64 cells, each at least once, in a random order."""
    cells = np.concatenate([np.arange(64), rng.integers(0, 64, 4)])
    return rng.permutation(cells).astype(np.uint8)


def hand(rng, array, geometry, cells):
    """Positions of a hand that goes over the line and back, at no even speed."""
    beyond_mm = array.span_mm / 2
    start, end = -beyond_mm - 3, geometry.extent_mm(cells) + beyond_mm + 1
    even = np.arange(start, end, STEP_MM)
    there, back = even + rng.uniform(0, STEP_MM, (2, even.size))
    return np.concatenate([there, back[::-1]])


def told(rng, masks, style, array):
    x_mm = hand(rng, array, style.geometry, len(masks))
    frames = style.render(masks, array).path(x_mm)
    read = read_back(frames, x_mm, array=array, mapping=style.mapping, geometry=style.geometry)
    assert read.size >= len(masks)
    assert not read[len(masks) :].any()
    return read[: len(masks)]


@pytest.mark.no_cover
@pytest.mark.parametrize("texture", TEXTURES)
@pytest.mark.parametrize("name", [name for name, each in MAPPINGS.items() if each.rows <= 6])
def test_every_cell_of_a_line_on_the_stress2(name, texture, rng):
    masks = every_cell(rng)
    style = replace(STRESS2.style, mapping=MAPPINGS[name], tuning=Tuning(texture=texture))
    read = told(rng, masks, style, STRESS2.display)
    np.testing.assert_array_equal(read, masks)


@pytest.mark.parametrize("texture", TEXTURES)
@pytest.mark.parametrize("dot_row", [1, 2, 3])
def test_none_left_right_or_both_on_the_vbd(dot_row, texture, rng):
    masks = every_cell(rng)
    style = replace(VBD.style, mapping=single_row(dot_row), tuning=Tuning(texture=texture))
    read = told(rng, masks, style, VBD.display)
    left, right = cell(dot_row), cell(dot_row + 3)
    names = {0: "none", left: "left", right: "right", left | right: "both"}
    shown = [names[mask & (left | right)] for mask in masks]
    assert {*shown} == {*names.values()}
    assert [names[mask] for mask in read] == shown


@pytest.mark.parametrize("profile", Profile)
@pytest.mark.parametrize("name", [name for name, each in MAPPINGS.items() if each.rows <= 6])
def test_another_array_other_distances_and_little_contrast(name, profile, rng):
    masks = every_cell(rng)
    tuning = Tuning(texture=0.5, contrast=0.2, cycles=3)
    style = BrailleStyle(profile, MAPPINGS[name], geometry.STANDARD, tuning)
    read = told(rng, masks, style, LATERO)
    np.testing.assert_array_equal(read, masks)
