"""The hand's velocity, as the tick estimates it, against its equations."""

import numpy as np
import pytest

from vbraille.display import Display
from vbraille.engine.record import VX, VY, columns_of, tick_dtype
from vbraille.engine.state import LoopState
from vbraille.engine.ticks import POSE_X, POSE_Y, POSED

MS = 1_000_000
N, M = 10, 50  # of eqs. 9.4 and 9.5


def estimates(times_ns, places_mm):
    """Velocity after each pose, float64[n, 2]; the host's ticks are a millisecond apart."""
    display = Display("table", 1, 1, 1.0, 1.0, height_mm=300.0)
    state = LoopState(display, 1000.0, 0)
    n = len(times_ns)
    times = np.stack((np.arange(1, n + 1) * MS, times_ns), axis=1)
    poses = np.zeros((n, 4))
    poses[:, POSED] = 1.0
    poses[:, POSE_X : POSE_Y + 1] = places_mm
    columns = columns_of(np.zeros(n, tick_dtype(display.shape)))
    assert state.advance(times, poses, 0, True, columns) == n
    return columns[1][:, VX : VY + 1]


def twin(times_ns, places_mm):
    """Lévesque 2009, eqs. 9.4 and 9.5, of each component; the hand stood still before."""
    differences = np.zeros((len(times_ns), 2))
    elapsed_s = (times_ns[N:] - times_ns[:-N]) / 1e9
    differences[N:] = (places_mm[N:] - places_mm[:-N]) / elapsed_s[:, None]
    padded = np.concatenate((np.zeros((M - 1, 2)), differences))
    return np.lib.stride_tricks.sliding_window_view(padded, M, axis=0).mean(axis=-1)


def along(x_mm):
    """Places of a hand that goes along x, and half as far along y."""
    return np.stack((x_mm, -x_mm / 2), axis=1)


def test_each_component_is_the_mean_of_fifty_differences_over_ten_poses(rng):
    times_ns = np.cumsum(rng.integers(1, 3 * MS, 400))
    places_mm = np.cumsum(rng.normal((0.05, -0.02), 0.1, (400, 2)), axis=0)
    want = twin(times_ns, places_mm)
    assert np.abs(want).max() > 10
    np.testing.assert_allclose(estimates(times_ns, places_mm), want, rtol=1e-12, atol=1e-9)


def test_it_settles_in_sixty_poses_on_a_steady_hand():
    n = np.arange(80)
    seen = estimates(n * MS, along(n * 0.04))
    assert seen[58, 0] < 40 - 1e-6
    assert seen[60:] == pytest.approx(np.tile((40.0, -20.0), (20, 1)))


def test_no_more_than_fifty_nine_poses_are_remembered(rng):
    n = np.arange(200)
    places_mm = along(n * 0.04)
    before = places_mm + (n < 200 - M - N)[:, None] * rng.normal(0, 0.01, (200, 2))
    assert estimates(n * MS, before)[-1] == pytest.approx(estimates(n * MS, places_mm)[-1])
    assert estimates(n * MS, before)[100] != pytest.approx(estimates(n * MS, places_mm)[100])


def test_a_pose_seen_twice_counts_once():
    n = np.arange(200)
    assert estimates(n // 2 * MS, along(n // 2 * 0.04))[-1] == pytest.approx((40, -20))


@pytest.mark.parametrize("step_ns", [600 * MS, -500 * MS])
def test_a_gap_and_a_clock_set_back_begin_anew(step_ns):
    n = np.arange(100)
    times_ns = n * MS + np.where(n < 70, 0, step_ns)
    seen = estimates(times_ns, along(n * 0.04))
    assert seen[69] == pytest.approx((40, -20))
    assert (seen[70:80] == 0).all()
    # Of the poses from then on alone.
    np.testing.assert_allclose(seen[70:], twin(n[:30] * MS, along(n[70:] * 0.04)), atol=1e-9)


def test_a_carriage_that_was_lost_and_found_again_has_no_speed():
    n = np.arange(100)
    seen = estimates(n * MS, along(n * 0.04 + np.where(n < 70, 0, 200.0)))
    assert seen[69] == pytest.approx((40, -20))
    assert (seen[70:80] == 0).all()
    assert np.abs(seen[70:]).max() < 40


def test_a_slider_has_no_velocity_along_y():
    display = Display("slider", 1, 1, 1.0, 1.0)
    state = LoopState(display, 1000.0, 0)
    poses = np.ones((80, 4))
    poses[:, POSE_X] = poses[:, POSE_Y] = np.arange(80) * 0.04
    columns = columns_of(np.zeros(80, tick_dtype(display.shape)))
    times_ns = np.repeat(np.arange(80)[:, None] * MS, 2, axis=1)
    state.advance(times_ns, poses, 0, True, columns)
    assert columns[1][-1, [VX, VY]] == pytest.approx((40, 0))
