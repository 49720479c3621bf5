"""How hands go about a page: line by line within their bounds, or about it without reading."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from vbraille.errors import InputError
from vbraille.simulation.hand import (
    CLEAR_MM,
    DRIFT_PITCHES,
    FOOT_S,
    RETURN_MM_S,
    TILT_RAD,
    Area,
    Drift,
)
from vbraille.simulation.specs import parse_hand
from vbraille.simulation.wander import ARM_MM, TURN_RAD, Wander

PAGE = Area(lines=25, pitch_mm=14.0, start_mm=-10.8, end_mm=270.0)
SHORT = replace(PAGE, lines=3)
RATE_HZ = 200.0

seeds = st.integers(0, 2**32)
areas = st.builds(
    lambda lines, pitch_mm, start_mm, way_mm: Area(lines, pitch_mm, start_mm, start_mm + way_mm),
    st.integers(1, 4),
    st.floats(1, 50),
    st.floats(-20, 20),
    st.floats(0, 80),
)


def sampled(motion):
    """x, y and θ at ticks, from the first knot to the last."""
    t_s = np.arange(0, motion.duration_s, 1 / RATE_HZ)
    return tuple(
        np.interp(t_s, motion.t_s, way) for way in (motion.x_mm, motion.y_mm, motion.theta_rad)
    )


def line_under(y_mm, area):
    return np.floor(y_mm / area.pitch_mm).astype(int)


def test_a_sweep_keeps_to_the_middle_of_each_line():
    motion = parse_hand("sweep:60").read_page(SHORT)
    assert motion.theta_rad is None
    for line in range(3):
        on_it = motion.y_mm == SHORT.middle_mm(line)
        assert list(motion.x_mm[on_it]) == [-10.8, 270.0, -10.8]
    assert np.all(np.diff(motion.y_mm) >= 0)
    one = parse_hand("sweep:60").read_line(-10.8, 270.0)
    assert motion.duration_s == pytest.approx(3 * one.duration_s + 2 * 14.0 / RETURN_MM_S)


@pytest.mark.parametrize("spec", ["slow", "fluent"])
def test_people_read_every_line_to_its_end_within_their_bounds(spec):
    motion = parse_hand(spec, 5).read_page(PAGE)
    line = line_under(motion.y_mm, PAGE)
    at_end = motion.x_mm == PAGE.end_mm
    assert set(line[at_end]) == set(range(25))
    assert list(np.unique(line)) == list(range(25))
    away = motion.x_mm > PAGE.start_mm
    off_mm = (motion.y_mm - PAGE.middle_mm(line))[away]
    assert DRIFT_PITCHES * 14 / 2 < np.abs(off_mm).max() <= DRIFT_PITCHES * 14
    assert TILT_RAD / 2 < np.abs(motion.theta_rad).max() <= TILT_RAD
    assert np.all(np.diff(line[away]) >= 0)


@pytest.mark.parametrize("spec", ["slow", "fluent"])
def test_people_drift_slowly(spec):
    x_mm, y_mm, theta_rad = sampled(parse_hand(spec, 2).read_page(SHORT))
    reading = x_mm > SHORT.start_mm + 1
    steps = np.flatnonzero(reading[1:] & reading[:-1])
    assert np.abs(np.diff(y_mm)[steps]).max() * RATE_HZ < 5  # mm a second
    assert np.abs(np.diff(theta_rad)).max() * RATE_HZ < math.radians(12)


def test_lines_are_read_as_on_a_slider():
    page, line = parse_hand("fluent", 3), parse_hand("fluent", 3)
    whole = page.read_page(SHORT)
    begun_s = 0.0
    for _ in range(3):
        one = line.read_line(SHORT.start_mm, SHORT.end_mm)
        at = np.searchsorted(whole.t_s, begun_s + one.t_s - 1e-9)
        np.testing.assert_allclose(whole.x_mm[at], one.x_mm, atol=1e-6)
        begun_s += one.duration_s + SHORT.pitch_mm / RETURN_MM_S


@pytest.mark.parametrize("spec", ["fluent", "wander:60"])
def test_the_same_seed_goes_the_same_way_and_another_another(spec):
    first, same, other = (parse_hand(spec, seed) for seed in (1, 1, 2))
    one, two = first.read_page(SHORT), same.read_page(SHORT)
    for name in ("t_s", "x_mm", "y_mm", "theta_rad"):
        np.testing.assert_array_equal(getattr(one, name), getattr(two, name))
    for page in (first.read_page(SHORT), other.read_page(SHORT)):
        got, want = (sampled(motion)[1][:400] for motion in (page, one))
        assert np.abs(got - want).max() > 0.1


@given(area=areas, seed=seeds)
@example(area=Area(3, 1.0, 0.0, 11.0), seed=510509)  # a turn beyond the most by rounding
def test_nobody_who_wanders_leaves_the_page(area, seed):
    motion = Wander(40.0, seed).read_page(area)
    assert np.all((motion.x_mm >= area.start_mm - 1e-9) & (motion.x_mm <= area.end_mm + 1e-9))
    assert np.all((motion.y_mm >= -1e-9) & (motion.y_mm <= area.height_mm + 1e-9))
    assert np.abs(motion.theta_rad).max() <= TURN_RAD
    for last in (0, -1):
        assert motion.x_mm[last] == pytest.approx(area.start_mm)
        assert motion.y_mm[last] == pytest.approx(area.middle_mm(0))
        assert motion.theta_rad[last] == pytest.approx(0)


@pytest.mark.parametrize("seed", range(5))
def test_who_wanders_goes_smoothly_everywhere_and_turns(seed):
    motion = Wander(60.0, seed).read_page(PAGE)
    assert motion.duration_s == pytest.approx((25 * 280.8 + 350) / 60, rel=0.03)
    x_mm, y_mm, theta_rad = (way[:-400] for way in sampled(motion))  # the way back left out
    steps = np.diff(np.array([x_mm, y_mm]))
    speed_mm_s = np.hypot(*steps) * RATE_HZ
    assert speed_mm_s.max() < 60 + 1e-6
    assert 50 < np.mean(speed_mm_s) < 60
    assert np.abs(np.diff(theta_rad)).max() * RATE_HZ <= 60 / ARM_MM + 1e-6
    turned = np.abs(np.diff(np.unwrap(np.arctan2(steps[1], steps[0]))))
    assert np.median(turned) < math.radians(1)
    x_edges, y_edges = np.linspace(-10.8, 270, 6), np.linspace(0, 350, 6)
    seen = np.histogram2d(x_mm, y_mm, (x_edges, y_edges))[0] > 0
    assert np.count_nonzero(seen) >= 20  # of 25 parts of the page
    assert theta_rad.min() < -TURN_RAD / 2
    assert theta_rad.max() > TURN_RAD / 2


@pytest.mark.parametrize("end_mm", [0.0, 2.0, 100.0])
def test_who_wanders_on_a_line_is_done_with_it_once(end_mm):
    x_mm = parse_hand("wander:60", 3).read_line(0.0, end_mm).x_mm
    assert (x_mm[0], x_mm[-1], x_mm.max()) == (0, 0, end_mm)
    if end_mm > 2 * CLEAR_MM:
        assert np.flatnonzero(x_mm == end_mm).tolist() == [x_mm.size - 2]
        assert x_mm[1:-1].min() >= CLEAR_MM
        assert np.count_nonzero(np.diff(x_mm) < 0) > 1


@pytest.mark.parametrize(
    ("spec", "said"),
    [
        ("wander:0", r"wander speed is 0 mm/s; it must be 0\.1 to 1000 mm/s"),
        ("wander:fast", r"wander speed is 'fast'; it must be a number, 0\.1 to 1000 mm/s"),
        ("wander", "wander speed is ''"),
    ],
)
def test_a_wander_spec_out_of_range_names_the_range(spec, said):
    with pytest.raises(InputError, match=said):
        parse_hand(spec)


def test_bounds():
    with pytest.raises(InputError, match="seed is -1"):
        parse_hand("wander:60", -1)
    with pytest.raises(ValueError, match="0 lines; it must have 1 or more"):
        replace(PAGE, lines=0)
    for pitch_mm in (0.0, -1.0, math.inf, math.nan):
        with pytest.raises(ValueError, match="line pitch is"):
            replace(PAGE, pitch_mm=pitch_mm)
    for spec in ("sweep:60", "fluent", "wander:60"):
        with pytest.raises(ValueError, match="a line is from"):
            parse_hand(spec).read_page(replace(PAGE, end_mm=1e6))


@pytest.mark.parametrize("spec", ["sweep:60", "slow", "fluent"])
def test_a_hand_that_is_to_go_on_ends_below_the_last_line_and_stays_there(spec):
    area = replace(SHORT, foot_mm=5.0)
    motion, usual = (parse_hand(spec, 5).read_page(each) for each in (area, SHORT))
    shared = usual.t_s.size - 1
    np.testing.assert_array_equal(motion.x_mm[:shared], usual.x_mm[:shared])
    below = motion.y_mm > area.height_mm
    stays_s = motion.t_s[-1] - motion.t_s[motion.y_mm == area.height_mm + 5.0][0]
    assert stays_s == pytest.approx(FOOT_S)
    assert FOOT_S > 0.5  # which is what the program waits for
    assert below[-1]
    assert not below[:shared].any()


def test_a_drift_goes_as_far_as_it_is_told():
    t_s = np.arange(0, 600, 0.05)
    drift = Drift(np.random.default_rng(1), pitches=0.5, tilt_rad=0.2)
    assert 0.4 < np.abs(drift.y_pitches(t_s)).max() <= 0.5
    assert 0.15 < np.abs(drift.theta_rad(t_s)).max() <= 0.2
