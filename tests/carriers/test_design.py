"""The equations of Lévesque 2009, A.20-A.74, against the numbers that are printed there."""

import math
from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tiers import examples
from vbraille.carriers import design, tactograph
from vbraille.carriers.design import LETTER, PRINTED_COUNT_RAD, Demands
from vbraille.carriers.planar import Arms
from vbraille.errors import InputError

LENGTHS = st.floats(50, 400)
UM = 1000.0


def worst_of_counts(arms, bend_rad, count_rad):
    """The largest of the errors of all 8 combinations of counts, by the Jacobian (A.22-A.31)."""
    rows = arms.jacobian(0.0, bend_rad)
    return max(
        math.hypot(*(count_rad * (row[0] * first + row[1] * second) for row in rows))
        for first, second in product((-1, 0, 1), repeat=2)
    )


@examples(200)
@given(LENGTHS, LENGTHS, st.floats(0.01, math.pi - 0.01))
def test_the_closed_error_is_the_worst_of_all_combinations(a_mm, b_mm, bend_rad):
    arms = Arms(a_mm, b_mm)
    worst_mm = worst_of_counts(arms, bend_rad, design.COUNT_RAD)
    assert design.bend_error_mm(arms, bend_rad) == pytest.approx(worst_mm, rel=1e-9)
    r_mm = math.hypot(*arms.forward(0.7, bend_rad))
    assert design.error_mm(arms, np.array(r_mm)) == pytest.approx(worst_mm, rel=1e-9)


@examples(60)
@given(LENGTHS, LENGTHS)
def test_the_error_has_no_jump_and_grows_with_the_distance(a_mm, b_mm):
    arms = Arms(a_mm, b_mm)
    r_mm = np.linspace(abs(a_mm - b_mm), a_mm + b_mm, 4001)
    error_mm = design.error_mm(arms, r_mm)
    assert np.all(np.diff(error_mm) >= -1e-15)
    k = arms.ratio
    if k <= 1:
        border_mm = a_mm * math.sqrt(1 - k * k)
        around = design.error_mm(arms, np.array([border_mm * (1 - 1e-9), border_mm * (1 + 1e-9)]))
        assert around[0] == pytest.approx(around[1], rel=1e-8)
        assert around[0] == pytest.approx(a_mm * design.COUNT_RAD, rel=1e-8)


def test_the_error_is_least_within_a_circle_that_is_known():
    arms = tactograph.ARMS
    assert arms.first_mm * math.sqrt(1 - arms.ratio**2) == pytest.approx(123.3, abs=0.05)
    assert design.error_mm(arms, np.array([60.0, 123.0])) == pytest.approx(
        arms.first_mm * design.COUNT_RAD
    )


def test_a_count_is_as_large_as_the_source_says():
    assert math.degrees(design.COUNT_RAD) * 3600 == pytest.approx(19.775, abs=5e-4)
    assert pytest.approx(95.87, abs=5e-3) == design.COUNT_RAD * 1e6


def test_the_arms_that_were_built_reach_the_page():
    assert tactograph.ARMS.ratio == pytest.approx(0.81, abs=5e-4)
    least_mm, most_mm = design.annulus_mm(tactograph.ARMS)
    assert least_mm == 120.0
    assert most_mm == pytest.approx(374.3, abs=0.05)
    assert math.hypot(139.7, 335.9) == pytest.approx(363.8, abs=0.05)
    assert design.page_height_mm(tactograph.ARMS) > LETTER.height_mm


@pytest.mark.parametrize(
    ("count_rad", "span_um"),
    [(PRINTED_COUNT_RAD, (20.16, 50.65)), (design.COUNT_RAD, (20.13, 50.59))],
)
def test_resolution_over_the_page(count_rad, span_um):
    span = design.span(tactograph.ARMS, count_rad=count_rad)
    assert (span.best_mm * UM, span.worst_mm * UM) == pytest.approx(span_um, abs=0.005)


def test_resolution_over_the_canvas_is_as_printed():
    places = [(x, y) for x in (0.0, 110.0, 220.0) for y in (0.0, 150.0)]
    r_mm = np.array([math.hypot(*tactograph.arms_at(*place)) for place in places])
    error_um = design.error_mm(tactograph.ARMS, r_mm, PRINTED_COUNT_RAD) * UM
    assert (round(error_um.min(), 1), round(error_um.max(), 1)) == (23.6, 45.2)


def test_the_best_ratios_are_those_of_the_source():
    far = design.best_ratio(lambda span: span.worst_mm)
    assert far.arms.ratio == pytest.approx(0.5753, abs=5e-4)
    assert far.arms.first_mm == pytest.approx(234.23, abs=0.005)
    assert far.worst_mm * UM == pytest.approx(47.6, abs=0.05)  # printed as 47.8
    near = design.best_ratio(lambda span: span.best_mm)
    assert near.arms.ratio == pytest.approx(0.809, abs=5e-4)
    assert near.arms.first_mm == pytest.approx(204.16, abs=0.01)
    assert near.best_mm * UM == pytest.approx(19.6, abs=0.05)


@pytest.mark.parametrize("ratio", [0.4, 0.5753, 0.81, 1.1])
def test_shortest_arms_just_reach_the_page_and_longer_ones_only_measure_worse(ratio):
    arms = design.shortest(ratio)
    least_mm, most_mm = design.annulus_mm(arms)
    assert most_mm**2 == pytest.approx(
        (LETTER.width_mm / 2) ** 2 + (LETTER.height_mm + least_mm) ** 2
    )
    shorter = Arms(arms.first_mm * 0.999, arms.second_mm * 0.999)
    assert design.page_height_mm(shorter) < LETTER.height_mm
    span = design.span(arms)
    for scale in (1.05, 1.2, 1.5):
        longer = design.span(Arms(arms.first_mm * scale, arms.second_mm * scale))
        assert longer.worst_mm > span.worst_mm
        assert longer.best_mm >= span.best_mm


@examples(60)
@given(LENGTHS, LENGTHS)
def test_the_least_distance_keeps_every_bound(a_mm, b_mm):
    arms = Arms(a_mm, b_mm)
    least_mm, most_mm = design.annulus_mm(arms)
    if math.isinf(least_mm):
        assert b_mm < LETTER.clearance_mm
        return
    assert least_mm >= LETTER.least_mm
    bent = [math.hypot(*arms.forward(0.0, bend)) for bend in (math.radians(160), math.radians(20))]
    assert least_mm >= bent[0] - 1e-9
    assert most_mm == pytest.approx(bent[1])
    if least_mm < a_mm + b_mm - 1e-6 and least_mm > abs(a_mm - b_mm) + 1e-6:
        # Distance of the array from the line of the first arm.
        _, beta = arms.inverse(least_mm, 0.0)
        aside_mm = b_mm * math.sin(beta)
        if beta > math.pi / 2:
            assert aside_mm >= LETTER.clearance_mm - 1e-6


def test_a_page_that_no_arms_reach_is_said():
    with pytest.raises(InputError, match="no arms of the ratio"):
        design.shortest(0.81, Demands(width_mm=20_000.0))
