import numpy as np
import pytest

from tests.engine.test_loop import info, straight
from vbraille.engine.clock import ManualClock
from vbraille.simulation.hand import Sweep
from vbraille.simulation.motion import APPROACH_MM_S, TURN_RAD_S, Motion
from vbraille.simulation.recorded import Recorded
from vbraille.simulation.simulated import HELD_MM_S, SimulatedDevice
from vbraille.simulation.specs import parse_hand
from vbraille.simulation.steering import BeAt, ReadLine, ReadPage, Steering

SPAN_MM = 10.8
HOME_MM = -SPAN_MM / 2  # of the array's centre at the left stop


@pytest.fixture
def clock():
    return ManualClock()


@pytest.fixture
def device(clock):
    return SimulatedDevice(info(), clock.now_ns)


def test_it_begins_at_the_left_stop(device):
    assert device.read().x_mm == pytest.approx(HOME_MM)
    assert not device.moving


def test_the_hand_moves_in_the_clock_s_time_to_the_encoder_s_count(clock, device):
    device.move(straight((0, -SPAN_MM), (1, -SPAN_MM + 0.1)))
    seen = set()
    for _ in range(1000):
        clock.advance_ns(1_000_000)
        sample = device.read()
        assert sample.time_ns == clock.now_ns()
        seen.add(round((sample.x_mm - HOME_MM) * 200, 6))
    assert seen == set(range(21))  # 0.1 mm at 200 counts a mm
    assert not device.moving


def test_a_hand_elsewhere_goes_to_where_its_motion_begins(clock, device):
    device.move(straight((0, 50.0), (1, 60.0)))
    places = []
    for _ in range(2000):
        places.append(device.read().x_mm)
        clock.advance_ns(1_000_000)
    assert np.abs(np.diff(places)).max() <= APPROACH_MM_S / 1000 + 1 / 200
    # A motion is of the left column.
    assert max(places) == pytest.approx(60 + SPAN_MM / 2, abs=1 / 200)


def test_the_carriage_stops_at_its_ends(clock, device):
    device.move(straight((0, -SPAN_MM), (1, 1000.0), (2, -1000.0)))
    places = []
    for _ in range(3000):
        places.append(device.read().x_mm)
        clock.advance_ns(1_000_000)
    assert max(places) == pytest.approx(HOME_MM + 300)
    assert min(places) == pytest.approx(HOME_MM)


@pytest.mark.parametrize(
    ("columns", "counts_per_mm"), [(10, 200.0), (1, 1.0)], ids=["fine", "coarse"]
)
def test_many_places_at_once_are_those_read_one_by_one(clock, columns, counts_per_mm):
    simulated = info(columns=columns, counts_per_mm=counts_per_mm)
    device = SimulatedDevice(simulated, clock.now_ns, Sweep(32.0), Steering())
    clock.advance_ns(123_456)
    device.steering.give(ReadLine(320.0))
    device.read()
    # By halves of a coarse count, and beyond both ends of the travel.
    home = -simulated.span_mm
    device.move(straight((0, home), (10, home + 320), (12, -30), (13, 20)))
    times_ns = clock.now_ns() + np.arange(1000) * 15_625_000
    places, count = device.poses_at(times_ns)[0], device.until_done(times_ns)
    assert 0 < count < 1000
    for n in range(1000):
        assert device.read().x_mm == places[n]
        assert device.steering.done_at(clock.now_ns()) == (n >= count - 1)
        clock.advance_ns(15_625_000)
    assert device.until_done(times_ns) == 1000  # done already


def test_nothing_ends_before_anything_was_ordered(device):
    assert device.until_done(np.arange(3)) == 3


def test_a_hand_that_nothing_steers_reads_as_far_as_the_carriage_goes(clock):
    device = SimulatedDevice(info(), clock.now_ns, Sweep(1000.0))
    clock.advance_ns(1_000_000_000)
    assert device.read().x_mm == pytest.approx(HOME_MM)  # till it is sent the first frame
    device.write(np.zeros((6, 10)))
    places = []
    for _ in range(4000):
        places.append(device.read().x_mm)
        clock.advance_ns(1_000_000)
    places = np.array(places)
    assert places.max() == pytest.approx(300 + HOME_MM, abs=1)
    home = np.flatnonzero(np.diff((places < HOME_MM + 1).astype(int)) == -1)
    np.testing.assert_allclose(np.diff(home), 1500, atol=2)  # 300 mm and back at 250 mm/s


def test_a_recorded_hand_sets_out_with_the_first_order_and_goes_on(clock):
    hand = Recorded(np.arange(0, 2.1, 0.1), np.arange(0, 21.0))
    device = SimulatedDevice(info(), clock.now_ns, hand, Steering())
    for seconds, done in ((1.0, False), (0.9, False), (0.2, True)):
        device.steering.give(ReadLine(100.0))
        device.read()
        clock.advance_ns(round(seconds * 1e9))
        device.read()
        assert device.steering.done_at(clock.now_ns()) == done
    assert device.read().x_mm == pytest.approx(20 + SPAN_MM / 2)


PLANE = info(columns=1, height_mm=60.0, turns=True)  # one column is the array's centre


def planar(clock, hand=None, display=PLANE):
    return SimulatedDevice(display, clock.now_ns, hand, Steering())


def watched(clock, device, seconds, step_ms=1):
    """Poses, one after the other; float64[n, 3]."""
    poses = []
    for _ in range(round(seconds * 1000 / step_ms)):
        clock.advance_ns(step_ms * 1_000_000)
        poses.append(device.read()[1:])
    return np.array(poses)


def test_a_carriage_of_two_axes_counts_on_both_and_stops_at_its_ends(clock):
    device = planar(clock)
    t_s = np.array([0.0, 1.0, 2.0, 3.0])
    device.move(Motion(t_s, np.array([0, 500.0, -50, 7]), np.array([0, 100.0, -20, 8])))
    poses = watched(clock, device, 3)
    for axis, most in ((0, 300), (1, 60)):
        assert (poses[:, axis].min(), poses[:, axis].max()) == (0, most)
        counts = poses[:, axis] * 200
        np.testing.assert_allclose(counts, np.rint(counts), atol=1e-6)
    np.testing.assert_allclose(poses[-1], (7, 8, 0), atol=1e-9)


@pytest.mark.parametrize(
    ("height_mm", "turns"), [(0.0, False), (60.0, False), (0.0, True), (60.0, True)]
)
def test_a_device_has_the_axes_that_it_says(clock, height_mm, turns):
    display = info(height_mm=height_mm, turns=turns)
    device = planar(clock, Sweep(200.0), display)
    ends = np.array([0.0, 1.0])
    device.move(Motion(ends, np.array([0.0, 100]), np.array([5.0, 20]), np.array([0.1, 0.5])))
    times_ns = clock.now_ns() + np.arange(100) * 11_234_567
    many = device.poses_at(times_ns)
    for n in range(100):
        assert device.read() == (times_ns[n], *many[:, n])
        clock.advance_ns(11_234_567)
    assert many[1].max() == (20 if height_mm else 0)
    assert many[2].max() == (0.5 if turns else 0)


def test_a_page_is_read_to_its_end_and_that_is_told(clock):
    device = planar(clock, parse_hand("fluent", 3))
    device.steering.give(ReadPage(4, 14.0, 120.0))
    poses = []
    while not device.steering.done_at(clock.now_ns()):
        poses.append(watched(clock, device, 0.1, step_ms=10))
        assert len(poses) < 1000
    x_mm, y_mm, theta_rad = np.concatenate(poses).T
    assert set((y_mm[x_mm > 119] // 14).astype(int)) == {0, 1, 2, 3}
    assert (x_mm[-1], y_mm[-1] // 14) == (0, 3)
    assert np.unique(np.round(y_mm, 1)).size > 20
    assert np.abs(theta_rad).max() > 0.01
    steps_mm = np.hypot(np.diff(x_mm), np.diff(y_mm))
    assert steps_mm.max() <= (APPROACH_MM_S + 10) / 100 + 2 / 200


def test_a_line_is_read_at_the_height_where_the_hand_is(clock):
    device = planar(clock, Sweep(100.0))
    device.steering.give(BeAt(0.0, 30.0, 0.5))
    watched(clock, device, 0.2)
    device.steering.give(ReadLine(50.0))
    poses = watched(clock, device, 0.5)
    assert poses[-1, 0] == pytest.approx(50, abs=0.2)
    assert set(poses[:, 1]) == {30.0}
    assert set(poses[:, 2]) == {0.5}


def test_a_hand_in_another_s_goes_straight_there_and_stays(clock):
    device = planar(clock)
    device.steering.give(BeAt(30.0, 40.0, -1.0))
    poses = watched(clock, device, 1)
    halfway = round(500 / TURN_RAD_S)  # turning takes longer than the way
    np.testing.assert_allclose(poses[halfway], (15, 20, -0.5), atol=0.3)
    np.testing.assert_allclose(poses[-1], (30, 40, -1.0), atol=1 / 200)
    assert np.hypot(*np.diff(poses[:, :2], axis=0).T).max() <= HELD_MM_S / 1000 + 2 / 200
    assert device.steering.done_at(clock.now_ns())
    device.steering.give(BeAt(30.0, 40.0, -1.0))  # where it is
    np.testing.assert_allclose(watched(clock, device, 0.002)[-1], (30, 40, -1.0), atol=1 / 200)
    assert device.steering.done_at(clock.now_ns())


def test_a_recorded_hand_of_two_axes_is_followed_on_both(clock):
    ramp = np.linspace(0, 1, 11)
    hand = Recorded(ramp, 50 * ramp, 10 + 20 * ramp, -ramp)
    device = planar(clock, hand)
    device.steering.give(ReadPage(4, 14.0, 120.0))
    watched(clock, device, 0.04 + 0.5)  # 10 mm down to where it begins, and half of it
    np.testing.assert_allclose(device.read()[1:], (25, 20, -0.5), atol=0.1)
    watched(clock, device, 0.6)
    np.testing.assert_allclose(device.read()[1:], (50, 30, -1), atol=0.01)
    assert device.steering.done_at(clock.now_ns())


def test_a_motion_goes_on_by_another_clock(clock, device):
    device.move(straight((0, -SPAN_MM), (1, -SPAN_MM + 10)))
    clock.advance_ns(500_000_000)
    other = ManualClock()
    device.go_by(other.now_ns)
    clock.advance_ns(500_000_000)
    assert device.read()[:2] == (0, pytest.approx(HOME_MM + 5))
    other.advance_ns(250_000_000)
    assert device.read()[:2] == (250_000_000, pytest.approx(HOME_MM + 7.5))


def test_levels_are_as_coarse_as_it_says():
    device = SimulatedDevice(info(levels=5))
    device.write(np.linspace(0, 1, 60).reshape(6, 10))
    assert sorted(set(device.levels.ravel().tolist())) == [0, 1, 2, 3, 4]
    assert device.levels[-1, -1] == 4
    assert device.frames == 1


def test_it_rests_on_close(device):
    device.write(np.ones((6, 10)))
    assert device.levels.all()
    device.close()
    assert not device.levels.any()
