"""Whole cycles on closed paths, and which of ridge and gap gives way."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from vbraille.scene.geometry import Cycle, axial_cycle, fitted, path_lengths_mm, stroke_cycles
from vbraille.scene.patterns import (
    Along,
    AxialGrating,
    Circle,
    PathShape,
    Polygon,
    StraightLine,
    Stroke,
    TurnPeak,
)

ALONG = Stroke(width_mm=4, along=Along(ridge_mm=2, gap_mm=1))
SQUARE = ((0, 0), (30, 0), (30, 30), (0, 30))


@given(st.floats(0.05, 400), st.just(0.0) | st.floats(0.05, 400), st.floats(0.05, 1e4))
def test_a_fitted_cycle_fills_its_length_a_whole_number_of_times(ridge, gap, length):
    cycle = fitted(Cycle(ridge, gap), length)
    times = length / cycle.length
    assert round(times) >= 1
    assert times == pytest.approx(round(times), rel=1e-9)
    assert cycle.ridge > 0
    assert cycle.gap >= 0
    assert (cycle.gap == 0) == (gap == 0)
    # The number is the nearest whole one.
    assert abs(length / (ridge + gap) - round(times)) <= 0.5 + 1e-9 or round(times) == 1


@pytest.mark.parametrize(
    ("ridge", "gap", "length", "want"),
    [
        pytest.param(2, 0, 9, (9 / 5, 0), id="without a gap the ridge changes, up where halfway"),
        pytest.param(2, 1, 10, (2, 4 / 3), id="the gap grows"),
        pytest.param(2, 1, 8, (2, 2 / 3), id="the gap shrinks"),
        pytest.param(2, 0.1, 3.5, (2 * 1.75 / 2.1, 0.1 * 1.75 / 2.1), id="no room: both scale"),
        pytest.param(5, 3, 1, (5 / 8, 3 / 8), id="one cycle at least"),
    ],
)
def test_what_gives_way(ridge, gap, length, want):
    assert fitted(Cycle(ridge, gap), length) == pytest.approx(want)


def test_paths_are_as_long_as_what_a_texture_goes_along():
    assert path_lengths_mm(StraightLine(start_mm=(1, 2), end_mm=(4, 6), stroke=ALONG)) == (5,)
    assert path_lengths_mm(Circle(center_mm=(0, 0), radius_mm=3, stroke=ALONG)) == (6 * math.pi,)
    straight = Polygon(vertices_mm=SQUARE, join="straight", stroke=ALONG)
    assert path_lengths_mm(straight) == (120,)
    # Four edges without the stroke's half width at both ends, and a whole turn about its pivots.
    rounded = Polygon(vertices_mm=SQUARE, stroke=ALONG)
    assert path_lengths_mm(rounded) == pytest.approx((4 * 26 + 4 * math.pi,))
    offset = Polygon(vertices_mm=SQUARE, rounding_offset_mm=3, stroke=ALONG)
    assert path_lengths_mm(offset) == pytest.approx((4 * 20 + 10 * math.pi,))
    two = (((0, 0), (3, 0), (3, 4)), ((10, 0), (16, 0), (16, 8)))
    assert path_lengths_mm(PathShape(contours_mm=two, stroke=ALONG)) == (7, 14)
    assert path_lengths_mm(PathShape(contours_mm=two, closed=True, stroke=ALONG)) == (12, 24)


def test_only_closed_paths_have_their_cycles_changed():
    written = Cycle(2, 1)
    two = (((0, 0), (10, 0)), ((0, 5), (11, 5)))
    assert stroke_cycles(StraightLine(start_mm=(0, 0), end_mm=(10, 0), stroke=ALONG)) == (written,)
    assert stroke_cycles(PathShape(contours_mm=two, stroke=ALONG)) == (written, written)
    circle = Circle(center_mm=(0, 0), radius_mm=5, stroke=ALONG)
    assert stroke_cycles(circle) == (fitted(written, 10 * math.pi),) != (written,)
    free = Stroke(along=Along(ridge_mm=2, gap_mm=1, whole_cycles=False))
    assert stroke_cycles(Circle(center_mm=(0, 0), radius_mm=5, stroke=free)) == (written,)
    assert stroke_cycles(Circle(center_mm=(0, 0), radius_mm=5, stroke=Stroke())) == ()
    three = (((0, 0), (9, 0), (9, 9)), ((0, 0), (20, 0), (20, 20)))
    path = PathShape(contours_mm=three, closed=True, stroke=ALONG)
    assert stroke_cycles(path) == tuple(fitted(written, n) for n in path_lengths_mm(path))


def test_spokes_go_a_whole_number_of_times_round():
    spokes = AxialGrating(center_mm=(0, 0), ridge_deg=36)
    assert axial_cycle(spokes) == (36, 0)
    assert axial_cycle(AxialGrating(center_mm=(0, 0), ridge_deg=35)) == (36, 0)
    assert axial_cycle(AxialGrating(center_mm=(0, 0), ridge_deg=20, gap_deg=17)) == (20, 16)
    odd = AxialGrating(center_mm=(0, 0), ridge_deg=35, whole_cycles=False)
    assert axial_cycle(odd) == (35, 0)


def test_spokes_that_stand_closer_somewhere_go_a_whole_number_of_times_round_too():
    # A peak within the turn adds (K - 1) L to it: eq. 8.6.
    peak = TurnPeak(factor=10, center_deg=180, length_deg=40)
    cycle = axial_cycle(AxialGrating(center_mm=(0, 0), ridge_deg=20, distortion=peak))
    assert cycle == pytest.approx((720 / 36, 0))
    # Of one whose middle is where the turn begins, or ends, half is in it.
    for center_deg in (0, 360):
        peak = TurnPeak(factor=3, center_deg=center_deg, length_deg=40)
        cycle = axial_cycle(AxialGrating(center_mm=(0, 0), ridge_deg=40, distortion=peak))
        assert cycle == pytest.approx((400 / 10, 0))
