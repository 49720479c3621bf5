"""The Latero's arms agree with what its author's client says of them."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tiers import by_tier, examples
from vbraille.carriers import latero
from vbraille.devices.latero.device import WHERE
from vbraille.errors import InputError

COUNTS = st.integers(0, 2**32 - 1)


def test_reset_pose_has_the_joints_that_the_client_finds():
    assert [math.degrees(joint) for joint in latero.RESET_JOINTS] == pytest.approx(
        [11.006, 54.535, 24.459], abs=5e-4
    )
    assert (latero.WIDTH_MM, latero.HEIGHT_MM) == (281.0, 217.5)
    assert pytest.approx((319.9, -111.2)) == (latero.ROOT_X_MM, latero.ROOT_Y_MM)


def test_reset_is_at_the_lower_left_with_the_third_arm_straight_up_from_the_array():
    elbow = latero.ROOT_X_MM, latero.ROOT_Y_MM
    for arm_mm, angle in zip(latero.ARMS_MM[:2], np.cumsum(latero.RESET_JOINTS)[:2], strict=True):
        # On the tray x grows to the right and y towards the reader: see `pose_at`.
        elbow = elbow[0] - arm_mm * math.cos(angle), elbow[1] + arm_mm * math.sin(angle)
    assert latero.RESET == (0.0, latero.HEIGHT_MM, 0.0)
    assert elbow == pytest.approx((0.0, latero.HEIGHT_MM - 62.7), abs=1e-9)
    said = "lower left one, with its third arm straight up: from the array it goes straight away"
    assert said in WHERE


def test_forward_is_the_clients_sum():
    first, second, third = 0.4, 1.1, -0.3
    x_mm = 222.3 * math.cos(0.4) + 245.6 * math.cos(1.5) + 62.7 * math.cos(1.2)
    y_mm = 222.3 * math.sin(0.4) + 245.6 * math.sin(1.5) + 62.7 * math.sin(1.2)
    assert latero.pose_at(first, second, third) == pytest.approx(
        (-x_mm + 319.9, y_mm - 111.2, 1.2 - math.pi / 2), abs=1e-12
    )


def test_every_place_of_the_tray_is_found_again():
    steps = by_tier(40, 200, 1000)
    worst_mm = 0.0
    for x_mm in np.linspace(0, latero.WIDTH_MM, steps):
        for y_mm in np.linspace(0, latero.HEIGHT_MM, steps):
            found = latero.pose_at(*latero.joints_at(float(x_mm), float(y_mm)))
            worst_mm = max(worst_mm, math.hypot(found[0] - x_mm, found[1] - y_mm))
            assert abs(found[2]) < 1e-12
    assert worst_mm <= 1e-9


@examples(100)
@given(st.floats(0, 281), st.floats(0, 217.5), st.floats(-math.pi, math.pi))
def test_a_turned_array_is_found_again_or_out_of_reach(x_mm, y_mm, theta):
    try:
        joints = latero.joints_at(x_mm, y_mm, theta)
    except InputError:
        assert abs(theta) > 0.5
        return
    found = latero.pose_at(*joints)
    assert math.hypot(found[0] - x_mm, found[1] - y_mm) <= 1e-9
    assert found[2] == pytest.approx(theta, abs=1e-12)


def test_a_turn_against_the_clock_is_positive():
    # A positive turn of the third joint alone carries the array about its end: the third arm
    # points at the reader (down) and goes to the reader's right.
    joints = latero.joints_at(140.0, 100.0)
    turned = latero.pose_at(joints[0], joints[1], joints[2] + 0.1)
    assert turned[2] == pytest.approx(0.1)
    assert turned[0] > 140.0
    assert turned[1] < 100.0


@examples(100)
@given(st.tuples(COUNTS, COUNTS, COUNTS), st.floats(0, 281), st.floats(0, 217.5))
def test_encoders_tell_the_place_since_the_reset(at_reset, x_mm, y_mm):
    offsets = latero.offsets_at(at_reset)
    assert latero.pose_at(*latero.joints_of(at_reset, offsets)) == pytest.approx(
        latero.RESET, abs=0.1
    )
    joints = latero.joints_at(x_mm, y_mm)
    counts = latero.encoders_of(joints, offsets)
    assert all(0 <= count < 2**32 for count in counts)
    # Half a count of each joint, at the reach of the arms: some 40 µm.
    assert latero.joints_of(counts, offsets) == pytest.approx(joints, abs=math.pi / 65_536 * 1.001)


def test_encoders_stand_in_the_devices_order_and_count_against_the_angle():
    offsets = latero.offsets_at((0, 0, 0, 99))
    assert offsets == tuple(
        int(math.radians(angle) * 65_536 / (2 * math.pi))
        for angle in map(math.degrees, reversed(latero.RESET_JOINTS))
    )
    quarter = 65_536 // 4
    assert latero.joints_of((-quarter + 3, 2, 1), (3, 2, 1)) == pytest.approx((0, 0, math.pi / 2))
