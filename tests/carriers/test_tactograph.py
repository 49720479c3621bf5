"""The Tactograph's arms and canvas against the numbers of Lévesque 2009, ch. 7."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tiers import by_tier, examples
from vbraille.carriers import tactograph
from vbraille.carriers.tactograph import ARMS, HEIGHT_MM, WIDTH_MM


@pytest.mark.parametrize(
    ("place_mm", "joints_deg"),
    [
        ((0.0, 120.0), (35.966, 145.158)),
        ((139.7, 335.9), (52.358, 33.782)),
        ((0.0, 230.0), (44.827, 106.351)),
    ],
)
def test_joints_at_places_that_were_computed_elsewhere(place_mm, joints_deg):
    joints = ARMS.inverse(*place_mm)
    assert [math.degrees(joint) for joint in joints] == pytest.approx(joints_deg, abs=5e-4)
    assert ARMS.forward(*joints) == pytest.approx(place_mm, abs=1e-9)


def test_the_canvas_is_in_the_middle_of_the_page():
    assert tactograph.arms_at(WIDTH_MM / 2, 0.0) == pytest.approx((0.0, 152.95))
    assert tactograph.arms_at(0.0, HEIGHT_MM) == pytest.approx((-110.0, 302.95))
    assert tactograph.canvas_at(-110.0, 302.95) == pytest.approx((0.0, HEIGHT_MM))


def test_every_place_of_the_page_is_found_again():
    steps = by_tier(40, 200, 1000)
    worst_mm = 0.0
    for x_mm in np.linspace(-tactograph.PAGE_MM[0] / 2, tactograph.PAGE_MM[0] / 2, steps):
        for y_mm in np.linspace(120.0, 335.9, steps):
            found = ARMS.forward(*ARMS.inverse(float(x_mm), float(y_mm)))
            worst_mm = max(worst_mm, math.hypot(found[0] - x_mm, found[1] - y_mm))
    assert worst_mm <= 1e-9


@examples(100)
@given(st.floats(0, WIDTH_MM), st.floats(0, HEIGHT_MM), st.floats(-math.pi, math.pi))
def test_poses_are_found_again_exactly_and_measured_to_their_counts(x_mm, y_mm, theta):
    found = tactograph.pose_at(*tactograph.joints_at(x_mm, y_mm, theta))
    assert math.hypot(found[0] - x_mm, found[1] - y_mm) <= 1e-9
    assert math.remainder(found[2] - theta, 2 * math.pi) == pytest.approx(0, abs=1e-12)
    told = tactograph.measured(x_mm, y_mm, theta)
    # Half a count in both joints moves the end by half of the resolution, 45.2 µm at worst.
    assert math.hypot(told[0] - x_mm, told[1] - y_mm) <= 0.0452 / 2
    # Half a count of each of the three encoders.
    bound_rad = math.pi / 5000 + 2 * math.pi / 65_536
    assert abs(math.remainder(told[2] - theta, 2 * math.pi)) <= bound_rad


def test_a_turn_against_the_clock_is_positive():
    alpha, beta, gamma = tactograph.joints_at(110.0, 75.0)
    # Angles of the arms grow from x, to the right, towards y, which is down: with the clock.
    assert tactograph.pose_at(alpha, beta, gamma + 0.1)[2] == pytest.approx(-0.1)


def test_the_array_is_turned_by_steps_of_the_printed_size():
    assert pytest.approx(0.072) == 360 / tactograph.TURN_COUNTS
    assert pytest.approx(4.32) == 360 / tactograph.TURN_COUNTS * 60  # minutes of arc
