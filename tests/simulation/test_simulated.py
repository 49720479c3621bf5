import numpy as np
import pytest

from tests.engine.test_loop import info, straight
from vbraille.engine.clock import ManualClock
from vbraille.simulation.hand import Sweep
from vbraille.simulation.recorded import Recorded
from vbraille.simulation.simulated import APPROACH_MM_S, SimulatedDevice
from vbraille.simulation.steering import ReadLine, Steering

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
    places, count = device.places_mm(times_ns), device.until_done(times_ns)
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
    assert device.read().x_mm == pytest.approx(-SPAN_MM)  # till it is sent the first frame
    device.write(np.zeros((6, 10)))
    places = []
    for _ in range(4000):
        places.append(device.read().x_mm)
        clock.advance_ns(1_000_000)
    places = np.array(places)
    assert places.max() == pytest.approx(300 - SPAN_MM, abs=1)
    home = np.flatnonzero(np.diff((places < -SPAN_MM + 1).astype(int)) == -1)
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
    assert device.read().x_mm == pytest.approx(20)


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
