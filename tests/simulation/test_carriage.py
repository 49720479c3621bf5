"""The simulated hand's carriage, in a time that nobody waits for."""

import numpy as np
import pytest

from vbraille.simulation.carriage import APPROACH_MM_S, Carriage
from vbraille.simulation.hand import Sweep
from vbraille.simulation.recorded import Recorded

SPAN_MM = 10.8
TRAVEL_MM = 300.0
READS_S = TRAVEL_MM / 100 + TRAVEL_MM / 250


class Bench:
    """A carriage, looked at each millisecond."""

    def __init__(self, hand=None, travel_mm=TRAVEL_MM):
        self.carriage = Carriage(hand or Sweep(100.0), SPAN_MM, travel_mm)
        self.now_us = 5_000_000

    def ways(self, seconds):
        """Where it is in the next seconds."""
        found = []
        for _ in range(round(seconds * 1000)):
            self.now_us += 1000
            found.append(self.carriage.at(self.now_us).way_mm)
        return np.array(found)


@pytest.fixture
def bench():
    return Bench()


def test_it_waits_at_the_left_stop(bench):
    assert not bench.ways(2.0).any()


def test_the_hand_reads_the_whole_travel_again_and_again(bench):
    bench.carriage.set_out()
    ways = bench.ways(3 * READS_S)
    assert ways.min() == 0
    assert ways.max() == pytest.approx(TRAVEL_MM, abs=0.3)
    turns = np.flatnonzero((ways[1:-1] > 299) & (ways[1:-1] >= ways[:-2]) & (ways[1:-1] > ways[2:]))
    assert len(turns) == 3
    assert np.diff(turns) == pytest.approx(READS_S * 1000, abs=3)


def test_places_are_of_their_time_however_often_one_looks(bench):
    bench.carriage.set_out()
    bench.ways(0.001)
    bench.now_us += 1_234_000
    assert bench.ways(0.001)[0] == pytest.approx(123.5)


def test_setting_out_again_changes_nothing_under_way(bench):
    bench.carriage.set_out()
    bench.ways(1.001)
    bench.carriage.set_out()
    assert bench.ways(1.0)[-1] == pytest.approx(200.0)


def test_a_recording_plays_once_from_where_it_begins(bench):
    bench = Bench(Recorded(np.array([7.0, 7.25, 7.5]), np.array([14.2, 39.2, 20.0])))
    for _ in range(3):
        bench.carriage.set_out()
        ways = bench.ways(2.0)
        if not _:
            assert np.abs(np.diff(ways)).max() <= APPROACH_MM_S / 1000 + 1e-6
            assert ways[100] == pytest.approx(25.0)  # 25 mm at 250 mm/s
            assert ways[350] == pytest.approx(50.0)
        assert ways[-1] == pytest.approx(20.0 + SPAN_MM)


def test_it_goes_no_further_than_its_stops():
    bench = Bench(Recorded(np.array([0.0, 0.25, 0.5]), np.array([0.0, 50.0, -50.0])), 40.0)
    bench.carriage.set_out()
    ways = bench.ways(1.0)
    assert (ways.min(), ways.max()) == (0.0, 40.0)


def test_it_crosses_the_mark_and_comes_back_before_it_sets_out(bench):
    bench.carriage.cross(10.0, bench.now_us)
    bench.carriage.set_out()
    ways = bench.ways(0.088)
    assert ways.max() == pytest.approx(11.0)
    assert ways[-1] == pytest.approx(0.0, abs=1e-6)
    assert bench.ways(1.002)[-1] == pytest.approx(100.0, abs=0.3)


def test_it_crosses_the_mark_once_however_often_it_is_told(bench):
    bench.carriage.cross(10.0, bench.now_us)
    bench.ways(0.04)
    bench.carriage.cross(10.0, bench.now_us)
    bench.ways(0.05)
    assert not bench.ways(0.1).any()


def test_going_back_it_waits_at_the_stop_to_be_told_again(bench):
    bench.carriage.set_out()
    bench.ways(1.001)
    bench.carriage.go_back(bench.now_us)
    ways = bench.ways(1.0)
    assert ways[199] == pytest.approx(50.0)
    assert not ways[400:].any()
    bench.carriage.go_back(bench.now_us)
    assert not bench.ways(0.1).any()
    bench.carriage.set_out()
    assert bench.ways(1.001)[-1] == pytest.approx(100.0)


def test_told_again_on_the_way_back_it_goes_to_the_stop_first(bench):
    bench.carriage.set_out()
    bench.ways(1.001)
    bench.carriage.go_back(bench.now_us)
    bench.carriage.set_out()
    ways = bench.ways(1.4)
    assert ways[:410].min() == pytest.approx(0.0, abs=1e-6)
    assert ways[-1] == pytest.approx(100.0, abs=0.3)
