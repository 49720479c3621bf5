import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

from tests.shown import LATERO, STRESS2_ARRAY, VBD_ARRAY, array_of
from vbraille.braille import geometry
from vbraille.render import LATERO as LATERO_MODEL
from vbraille.render import (
    MAPPINGS,
    PANTOGRAPH,
    STRESS2,
    STRESS2_8X8,
    VBD,
    Profile,
    Tuning,
    model_of,
    single_row,
)
from vbraille.render.braille.models import same_array


def test_the_pantograph_has_the_same_array_on_a_smaller_surface_and_measures_no_angle():
    display, other = PANTOGRAPH.display, STRESS2_8X8.display
    assert (display.travel_mm, display.height_mm, display.axes) == (113.0, 60.0, "xy")
    assert display.counts_per_mm == pytest.approx(1 / 0.013)  # Lévesque 2009, 6.2
    assert same_array(display, other)
    assert PANTOGRAPH.style.geometry.travel_mm == 113.0
    assert PANTOGRAPH.style.mapping is STRESS2_8X8.style.mapping
    # What a reader has chosen for the array holds on either carrier.
    assert model_of(display).name == "stress2-8x8"
    assert model_of(display).display is display


def test_the_vbd_as_the_source_has_it():
    assert VBD.display is VBD_ARRAY
    assert VBD.style.profile is Profile.HALF_SINE
    assert VBD.style.mapping == single_row(1)
    assert VBD.style.geometry is geometry.VBD
    assert VBD.style.tuning == Tuning(texture=0.0, contrast=1.0)
    assert VBD.display.rest_side == "left"


def test_the_stress2_as_the_source_prefers_it():
    assert STRESS2.display is STRESS2_ARRAY
    assert STRESS2.style.profile is Profile.RAISED_COSINE
    assert STRESS2.style.mapping is MAPPINGS["alternate"]
    assert STRESS2.style.geometry is geometry.STRESS2
    assert STRESS2.style.tuning == Tuning(texture=1.0, contrast=1.0, cycles=7)
    assert STRESS2.display.rest_side == "right"


@pytest.mark.parametrize(
    ("model", "pitch_mm", "surface_mm", "levels", "size_mm"),
    [
        # Lévesque 2009, 6.2 and 7: 7 · 1.2 + 0.5 by 7 · 1.4 + 1.2 mm, on 22 × 15 cm, 10 bits.
        (STRESS2_8X8, 1.4, (220.0, 150.0), 1024, (8.9, 11.0)),
        # The author's later code: 281 × 217.5 mm, levels 0 … 150.
        (LATERO_MODEL, 1.6125, (281.0, 217.5), 151, (8.9, 12.6875)),
    ],
    ids=["stress2-8x8", "latero"],
)
def test_the_arrays_of_eight_rows_show_eight_dots(model, pitch_mm, surface_mm, levels, size_mm):
    display, geometry = model.display, model.style.geometry
    assert display.shape == (8, 8)
    assert (display.column_pitch_mm, display.row_pitch_mm) == (1.2, pitch_mm)
    assert (display.travel_mm, display.height_mm, display.turns) == (*surface_mm, True)
    assert (display.levels, display.rest_side) == (levels, "right")
    assert display.contactor_mm is not None
    outer = zip((display.span_mm, display.depth_mm), display.contactor_mm, strict=True)
    assert [centres + touching for centres, touching in outer] == pytest.approx(size_mm)
    assert model.style.mapping is MAPPINGS["eight-dots"]
    # Rows of dots stand upon the rows of actuators that show them.
    assert geometry.row_spacing_mm == pytest.approx(2 * pitch_mm)
    assert model_of(display) == model
    line = model.style.render(np.full(3, 255, np.uint8), display)
    frames = line.path(np.linspace(-12, 30, 200))
    assert np.flatnonzero(np.ptp(frames, axis=(0, 2)) > 0.9).tolist() == [0, 2, 4, 6]


def test_a_known_array_is_a_model_with_the_device_s_own_pitches():
    device = replace(STRESS2.display, name="a device", column_pitch_mm=1.205, row_pitch_mm=1.79)
    model = model_of(device)
    assert (model.name, model.style) == ("stress2", STRESS2.style)
    assert model.display is device
    assert model_of(STRESS2.display) == STRESS2
    assert model_of(replace(VBD.display, row_pitch_mm=9.0)).name == "vbd"  # one row has no pitch
    for changes in ({"column_pitch_mm": 1.213}, {"row_pitch_mm": 1.78}, {"columns": 9}):
        assert model_of(replace(STRESS2.display, **changes)).name == ""


@pytest.mark.parametrize(
    ("rows", "mapping", "shown"),
    [
        (16, "alternate", (5, 7, 9)),
        (8, "alternate", (1, 3, 5)),
        (7, "alternate", (0, 2, 4)),
        (6, "alternate", (0, 2, 4)),
        (5, "three-rows", (1, 2, 3)),
        (4, "three-rows", (0, 1, 2)),
        (3, "three-rows", (0, 1, 2)),
        (2, "dot-row-1", (0,)),
        (1, "dot-row-1", (0,)),
    ],
)
def test_an_array_that_nobody_named_reads_braille_in_its_middle(rows, mapping, shown):
    display = array_of(rows, 8, 1.2, 1.7)
    model = model_of(display)
    assert (model.name, model.title, model.display) == ("", display.name, display)
    assert model.style.mapping.name == mapping
    assert model.style.first_row is None
    # A line of full cells, over which the hand goes: only these rows move, each dot row has one.
    line = model.style.render(np.full(3, 63, np.uint8), display)
    frames = line.path(np.linspace(-12, 30, 200))
    moved = np.flatnonzero(np.ptp(frames, axis=(0, 2)) > 0.9)
    assert tuple(moved) == shown
    np.testing.assert_array_equal(np.delete(frames, moved, axis=1), 0.0)


@pytest.mark.parametrize("first_row", [0, 1, 2])
def test_the_first_row_of_a_mapping_may_be_said(first_row):
    style = replace(STRESS2.style, first_row=first_row)
    frames = style.render(np.full(3, 63, np.uint8), LATERO).path(np.linspace(-12, 30, 200))
    moved = np.flatnonzero(np.ptp(frames, axis=(0, 2)) > 0.9)
    assert moved.tolist() == [first_row, first_row + 2, first_row + 4]


@pytest.mark.parametrize("first_row", [-1, 3])
def test_a_mapping_must_stand_on_the_array(first_row):
    style = replace(STRESS2.style, first_row=first_row)
    says = f"needs 6 actuator rows from row {first_row} on; the array has 8"
    with pytest.raises(ValueError, match=says):
        style.render(np.full(3, 63, np.uint8), LATERO)


_POSTED_TO_A_HOST = """
import sys
import numpy as np
import vbraille.engine.host
from vbraille.render import STRESS2
STRESS2.style.render(np.zeros(3, np.uint8), STRESS2.display)
print("numba" in sys.modules)
"""


def test_who_only_has_lines_shown_by_a_host_loads_no_compiler():
    loaded = subprocess.run(
        [sys.executable, "-c", _POSTED_TO_A_HOST],
        capture_output=True,
        text=True,
        check=True,
    )
    assert loaded.stdout.strip() == "False"
