import numpy as np
import pytest

from tests.engine.test_loop import info, straight
from vbraille.devices.hand import Sweep
from vbraille.devices.simulated import APPROACH_MM_S, SimulatedDevice
from vbraille.engine.clock import ManualClock

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
    device = SimulatedDevice(simulated, clock.now_ns, Sweep(32.0))
    clock.advance_ns(123_456)
    device.follow(320.0)
    # By halves of a coarse count, and beyond both ends of the travel.
    home = -simulated.span_mm
    device.move(straight((0, home), (10, home + 320), (12, -30), (13, 20)))
    times_ns = clock.now_ns() + np.arange(1000) * 15_625_000
    places, followed = device.places_mm(times_ns), device.followed_at(times_ns)
    assert 0 < followed.sum() < 1000
    for n in range(1000):
        assert device.read().x_mm == places[n]
        assert device.followed == followed[n]
        clock.advance_ns(15_625_000)


def test_a_hand_that_follows_nothing_has_not_come_to_its_end(device):
    assert not device.followed_at(np.arange(3)).any()


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
