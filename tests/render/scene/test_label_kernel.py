"""Braille in a picture: the kernel against its twin, and where its dots stand."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.render.scene.twinbraille import label_deflections, label_opacity
from tests.tiers import examples
from vbraille.braille.geometry import PRESETS
from vbraille.render import STRESS2_8X8, VBD, Tuning
from vbraille.render.braille.mappings import DOT_BITS
from vbraille.render.braille.style import Profile, cells_size_mm, pack_cells
from vbraille.render.cellkernels import highest_dot, opacity
from vbraille.render.labels import Written, corners_mm
from vbraille.render.work import FADE_MM, TABLE
from vbraille.scene.patterns import Label

_WORDS = 11  # a label's words stand anywhere in those of a program

styles = st.builds(
    replace,
    st.sampled_from([STRESS2_8X8.style, VBD.style]),
    profile=st.sampled_from(Profile),
    tuning=st.builds(
        Tuning, st.floats(0, 1), st.floats(0, 1), st.sampled_from([1, 3, 5, 7, 9, 11])
    ),
    # Dots that overlap within a cell, those of the next cell, and those of the next line.
    geometry=st.builds(
        replace,
        st.sampled_from(list(PRESETS.values())),
        dot_width_mm=st.sampled_from([1.0, 2.6, 5.0]),
        line_pitch_mm=st.sampled_from([3.0, 11.0, 14.0]),
    ),
)
cells = st.lists(st.integers(0, 255), max_size=6).map(lambda row: np.array(row, np.uint8))
writings = st.builds(Written, st.lists(cells, min_size=1, max_size=4).map(tuple), styles)
labels = st.builds(
    Label,
    text=st.just("x"),
    place_mm=st.tuples(st.floats(-50, 50), st.floats(-50, 50)),
    angle_deg=st.one_of(st.just(0.0), st.floats(-360, 360)),
)


def by_kernel(label, written, x_mm, y_mm):
    place = (*label.place_mm, math.radians(label.angle_deg))
    cells, words = pack_cells(written.lines, written.style, DOT_BITS, place)
    cells[TABLE] = _WORDS
    table = np.concatenate((np.full(_WORDS, 0xFFFF, np.uint16), words))
    places = list(zip(x_mm, y_mm, strict=True))
    found = [highest_dot(cells, table, x, y) for x, y in places]
    return np.array(found), np.array([opacity(cells, x, y) for x, y in places])


def places_on(label, written, count, seed):
    """Places on a label and around it."""
    rng = np.random.default_rng(seed)
    corners = np.array(corners_mm(label, written, 3.0))
    share = rng.uniform(0, 1, (2, count))
    along, down = corners[1] - corners[0], corners[3] - corners[0]
    return corners[0][:, None] + along[:, None] * share[0] + down[:, None] * share[1]


@given(label=labels, written=writings, seed=st.integers(0, 1000))
@examples(60)
def test_the_kernel_is_its_twin(label, written, seed):
    x_mm, y_mm = places_on(label, written, 200, seed)
    found, hides = by_kernel(label, written, x_mm, y_mm)
    want = label_deflections(label, written, x_mm, y_mm)
    np.testing.assert_allclose(found, want, rtol=0, atol=1e-9)
    mask = label_opacity(label, written, x_mm, y_mm)
    np.testing.assert_allclose(hides, mask, rtol=0, atol=1e-9)
    assert found.min() >= 0
    assert (found <= mask).all()


def test_the_first_dot_stands_at_the_place_of_the_label_whichever_way_it_is_turned():
    style = STRESS2_8X8.style
    written = Written((np.array([0b1], np.uint8),), style)
    half_mm = style.geometry.dot_width_mm / 2
    for angle_deg in (0.0, 30.0, 90.0, -135.0):
        angle = math.radians(angle_deg)
        label = Label(text="a", place_mm=(20.0, 30.0), angle_deg=angle_deg)
        x_mm = 20.0 + half_mm * (math.cos(angle) - math.sin(angle))
        y_mm = 30.0 + half_mm * (math.cos(angle) + math.sin(angle))
        found, _ = by_kernel(label, written, np.array([x_mm]), np.array([y_mm]))
        assert found[0] == pytest.approx(style.tuning.contrast)


def test_a_label_hides_what_it_stands_on_as_far_as_its_cells_go():
    style = STRESS2_8X8.style
    written = Written((np.array([0b111, 0], np.uint8),), style)
    label = Label(text="l", place_mm=(0.0, 0.0))
    geometry = style.geometry
    width_mm, height_mm = cells_size_mm(written.lines, geometry)
    assert width_mm == pytest.approx(geometry.extent_mm(2))
    assert height_mm == pytest.approx(2 * geometry.row_spacing_mm + geometry.dot_width_mm)
    half_mm = geometry.dot_width_mm / 2
    x_mm = np.array([1.0, width_mm, width_mm + half_mm + FADE_MM / 2, width_mm + half_mm + 1.01])
    _, hides = by_kernel(label, written, x_mm, np.full(4, height_mm / 2))
    np.testing.assert_allclose(hides, (1.0, 1.0, 0.5, 0.0), atol=1e-12)


def test_nothing_is_felt_at_no_place_nor_of_no_cells():
    nowhere = np.array([np.nan, np.inf, 1.0])
    label = Label(text="l", place_mm=(0.0, 0.0))
    for masks in ([0xFF], []):
        written = Written((np.array(masks, np.uint8),), STRESS2_8X8.style)
        # Not compiled, the kernels are python, and numpy warns of what has no number.
        with np.errstate(invalid="ignore"):
            found, hides = by_kernel(label, written, nowhere, np.array([1.0, 1.0, np.nan]))
        assert not found.any()
        assert not hides.any()
