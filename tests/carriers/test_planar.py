"""Arms go forward and back to the same place, as closely as the project asks."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tiers import examples
from vbraille.carriers.planar import Arms, ThreeArms
from vbraille.errors import InputError

BAR_MM = 1e-9


@examples(100)
@given(
    st.floats(50, 400),
    st.floats(50, 400),
    st.floats(0, 1),
    st.floats(-math.pi, math.pi),
)
def test_every_place_that_arms_reach_is_found_again(a_mm, b_mm, share, direction):
    arms = Arms(a_mm, b_mm)
    near_mm, far_mm = abs(a_mm - b_mm), a_mm + b_mm
    r_mm = near_mm + share * (far_mm - near_mm)
    x_mm, y_mm = r_mm * math.cos(direction), r_mm * math.sin(direction)
    alpha, beta = arms.inverse(x_mm, y_mm)
    assert 0 <= beta <= math.pi
    found_x, found_y = arms.forward(alpha, beta)
    assert math.hypot(found_x - x_mm, found_y - y_mm) <= BAR_MM


@examples(100)
@given(st.floats(-3, 3), st.floats(0.1, 3.0), st.floats(-3, 3), st.floats(0, 100))
def test_angles_are_found_again_where_arms_are_bent(first, second, third, third_mm):
    arms = ThreeArms(Arms(222.3, 245.6), third_mm)
    x_mm, y_mm, whole = arms.forward(first, second, third)
    back = arms.inverse(x_mm, y_mm, whole)
    for angle, found in zip((first, second, third), back, strict=True):
        assert math.remainder(angle - found, 2 * math.pi) == pytest.approx(0, abs=1e-10)


@examples(60)
@given(st.floats(-3, 3), st.floats(0.3, 2.8))
def test_inverse_is_the_sources_equation(alpha, beta):
    a_mm, b_mm = 210.0, 170.0
    x_mm, y_mm = Arms(a_mm, b_mm).forward(alpha, beta)
    r_mm = math.hypot(x_mm, y_mm)
    printed = (
        math.atan2(y_mm, x_mm) - math.acos((a_mm**2 - b_mm**2 + r_mm**2) / (2 * a_mm * r_mm)),
        math.acos((r_mm**2 - a_mm**2 - b_mm**2) / (2 * a_mm * b_mm)),
    )
    assert Arms(a_mm, b_mm).inverse(x_mm, y_mm) == pytest.approx(printed, abs=1e-9)


@examples(60)
@given(st.floats(-3, 3), st.floats(-3, 3))
def test_jacobian_is_the_slope_of_the_forward_equation(alpha, beta):
    arms, step = Arms(210.0, 170.0), 1e-6
    rows = arms.jacobian(alpha, beta)
    for column, (d_alpha, d_beta) in enumerate(((step, 0.0), (0.0, step))):
        ahead = arms.forward(alpha + d_alpha, beta + d_beta)
        behind = arms.forward(alpha - d_alpha, beta - d_beta)
        for row in (0, 1):
            slope = (ahead[row] - behind[row]) / (2 * step)
            assert rows[row][column] == pytest.approx(slope, abs=1e-5)


@pytest.mark.parametrize("r_mm", [39.9, 380.1, 1e6])
def test_a_place_out_of_reach_is_said_with_what_is_in_reach(r_mm):
    with pytest.raises(InputError, match=r"they reach 40\.0 to 380\.0 mm"):
        Arms(210.0, 170.0).inverse(r_mm, 0.0)


@pytest.mark.parametrize("x_mm", [math.nan, math.inf])
def test_no_angles_for_what_is_no_place(x_mm):
    with pytest.raises(InputError):
        Arms(210.0, 170.0).inverse(x_mm, 0.0)


@pytest.mark.parametrize("lengths", [(0.0, 1.0), (1.0, -1.0), (math.nan, 1.0)])
def test_arms_have_lengths(lengths):
    with pytest.raises(ValueError, match="must be above 0"):
        Arms(*lengths)
