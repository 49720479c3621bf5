"""The velocity estimate against its equations."""

import numpy as np
import pytest

from vbraille.engine.velocity import Velocity

MS = 1_000_000


def estimates(times_ns, places_mm):
    velocity = Velocity()
    seen = []
    for time_ns, x_mm in zip(times_ns, places_mm, strict=True):
        velocity.add(int(time_ns), float(x_mm))
        seen.append(velocity.mm_s)
    return np.array(seen)


def test_it_is_the_mean_of_fifty_differences_over_ten_samples(rng):
    times_ns = np.cumsum(rng.integers(1, 3 * MS, 400))
    places_mm = np.cumsum(rng.normal(0.05, 0.1, 400))
    differences = np.zeros(400)
    differences[10:] = (places_mm[10:] - places_mm[:-10]) / (times_ns[10:] - times_ns[:-10]) * 1e9
    # Before its first sample the hand stood still.
    padded = np.concatenate((np.zeros(49), differences))
    want = np.lib.stride_tricks.sliding_window_view(padded, 50).mean(axis=1)
    np.testing.assert_allclose(estimates(times_ns, places_mm), want, atol=1e-9)


def test_it_settles_in_sixty_samples_on_a_steady_hand():
    n = np.arange(80)
    seen = estimates(n * MS, n * 0.04)
    assert seen[58] < 40 - 1e-6
    assert seen[60:] == pytest.approx(40)


def test_a_sample_seen_twice_counts_once():
    n = np.arange(200)
    assert estimates(n // 2 * MS, n // 2 * 0.04)[-1] == pytest.approx(40)


@pytest.mark.parametrize("step_ns", [600 * MS, -500 * MS])
def test_a_gap_and_a_clock_set_back_begin_anew(step_ns):
    n = np.arange(100)
    times_ns = n * MS + np.where(n < 70, 0, step_ns)
    places_mm = n * 0.04 + np.where(n < 70, 0, 200.0)
    seen = estimates(times_ns, places_mm)
    assert seen[69] == pytest.approx(40)
    assert seen[70] == 0
    assert seen[70:].max() < 40
