"""Distances: the presets are the source's, and a line is as wide as the travel lets it be."""

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from vbraille.braille.geometry import BOUNDS_MM, PRESETS, STANDARD, STRESS2, VBD, Geometry
from vbraille.errors import InputError

STRESS2_SPAN_MM = 9 * 1.2
VBD_SPAN_MM = 11 * 0.7

lengths = st.floats(0.5, 20.0, allow_nan=False)
geometries = st.builds(
    Geometry,
    dot_width_mm=st.floats(0.1, 1.0),
    dot_spacing_mm=lengths,
    cell_gap_mm=lengths,
    row_spacing_mm=lengths,
    line_pitch_mm=st.floats(1.0, 50.0),
    travel_mm=st.floats(100.0, 1_000.0),
)


class TestPresets:
    def test_vbd(self):
        assert (VBD.dot_width_mm, VBD.dot_spacing_mm) == (2.0, 4.0)
        assert VBD.cell_pitch_mm == pytest.approx(10.48)

    def test_stress2(self):
        assert (STRESS2.dot_width_mm, STRESS2.dot_spacing_mm) == (2.6, 3.7)
        assert (STRESS2.cell_gap_mm, STRESS2.row_spacing_mm) == (7.4, 3.6)
        assert STRESS2.cell_pitch_mm == pytest.approx(11.1)

    def test_standard_is_embossed_braille(self):
        assert STANDARD.cell_pitch_mm == pytest.approx(6.0)
        assert (STANDARD.dot_spacing_mm, STANDARD.line_pitch_mm) == (2.29, 10.0)

    def test_by_name(self):
        named = {"vbd": VBD, "stress2": STRESS2, "standard": STANDARD}
        assert named.items() <= PRESETS.items()
        assert {preset.travel_mm for preset in named.values()} == {300.0}
        assert PRESETS.keys() - named.keys() == {"stress2-8x8", "pantograph", "latero"}


class TestChecks:
    @pytest.mark.parametrize("name", BOUNDS_MM)
    def test_every_length_has_bounds(self, name):
        low, high = BOUNDS_MM[name]
        said = name.removesuffix("_mm").replace("_", " ")
        for length in (low / 2, 0.0, -1.0, high * 1.01, math.inf, -math.inf, math.nan):
            with pytest.raises(ValueError, match=rf"^{said} is .* mm; it must be .* to .* mm$"):
                replace(STRESS2, **{name: length})

    @pytest.mark.parametrize("name", BOUNDS_MM)
    def test_bounds_are_allowed(self, name):
        wide = replace(STRESS2, cell_gap_mm=50.0)
        for length in BOUNDS_MM[name]:
            assert getattr(replace(wide, **{name: length}), name) == length

    def test_a_dot_no_wider_than_a_cell(self):
        with pytest.raises(ValueError, match=r"dot width is 12 mm; .* here 11\.1 mm"):
            replace(STRESS2, dot_width_mm=12.0)
        assert replace(STRESS2, dot_width_mm=11.1).dot_width_mm == 11.1


class TestWidth:
    def test_the_devices(self):
        assert STRESS2.cells_per_line(STRESS2_SPAN_MM) == 26
        assert VBD.cells_per_line(VBD_SPAN_MM) == 28

    @given(geometries, st.floats(0.0, 20.0))
    def test_the_array_crosses_all_cells_and_there_is_no_room_for_one_more(self, geometry, span_mm):
        cells = geometry.cells_per_line(span_mm)
        assert geometry.extent_mm(cells) + span_mm <= geometry.travel_mm + 1e-6
        assert geometry.extent_mm(cells + 1) + span_mm > geometry.travel_mm - 1e-6

    @given(geometries, st.floats(0.0, 20.0), st.integers(1, 9))
    def test_a_travel_for_just_so_many_cells_loses_none(self, geometry, span_mm, cells):
        travel_mm = geometry.extent_mm(cells) + span_mm
        if travel_mm >= 1.0:
            assert replace(geometry, travel_mm=travel_mm).cells_per_line(span_mm) == cells

    def test_no_room_for_one(self):
        short = replace(STRESS2, travel_mm=17.0)
        with pytest.raises(InputError, match=r"travel of 17 mm .* it must be at least 17\.1 mm"):
            short.cells_per_line(STRESS2_SPAN_MM)
        least = replace(STRESS2, travel_mm=10.8 + 2.6 + 3.7)
        assert least.cells_per_line(STRESS2_SPAN_MM) == 1

    def test_extent(self):
        assert STRESS2.extent_mm(0) == 0
        assert STRESS2.extent_mm(1) == pytest.approx(6.3)
        assert STRESS2.extent_mm(26) == pytest.approx(25 * 11.1 + 6.3)
