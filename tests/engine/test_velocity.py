"""The velocity estimate against its equations."""

import numpy as np
import pytest

from vbraille.engine.velocity import Velocity

MS = 1_000_000


def vectors(times_ns, x_mm, y_mm):
    """Velocity after each sample; float64[n, 2]."""
    velocity = Velocity()
    seen = []
    for time_ns, x, y in zip(times_ns, x_mm, y_mm, strict=True):
        velocity.add(int(time_ns), float(x), float(y))
        seen.append((velocity.x_mm_s, velocity.y_mm_s))
    return np.array(seen)


def estimates(times_ns, x_mm):
    """Velocity to the right after each sample, of a hand that stays on its line; float64[n]."""
    seen = vectors(times_ns, x_mm, np.zeros(len(times_ns)))
    assert not seen[:, 1].any()
    return seen[:, 0]


def test_each_component_is_the_mean_of_fifty_differences_over_ten_samples(rng):
    times_ns = np.cumsum(rng.integers(1, 3 * MS, 400))
    places_mm = np.cumsum(rng.normal(0.05, 0.1, (400, 2)), axis=0)
    taken_ns = (times_ns[10:] - times_ns[:-10])[:, None]
    differences = np.zeros((400, 2))
    differences[10:] = (places_mm[10:] - places_mm[:-10]) / taken_ns * 1e9
    # Before its first sample the hand stood still.
    padded = np.concatenate((np.zeros((49, 2)), differences))
    want = np.lib.stride_tricks.sliding_window_view(padded, 50, axis=0).mean(axis=-1)
    np.testing.assert_allclose(vectors(times_ns, *places_mm.T), want, atol=1e-9)


def test_a_hand_that_goes_round_has_no_velocity_on_the_whole():
    # 50 ms a turn: the components average out, as a mean of angles would not.
    n = np.arange(200)
    angle = 2 * np.pi * n / 50
    seen = vectors(n * MS, np.cos(angle), np.sin(angle))
    assert np.abs(seen[60:]).max() < 1e-9
    assert np.abs(seen[:60]).max() > 1


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
