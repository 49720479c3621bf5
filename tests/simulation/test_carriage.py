"""The simulated hand's carriage, in a time that no test waits for."""

from dataclasses import replace

import numpy as np
import pytest

from vbraille.render.braille.models import STRESS2
from vbraille.simulation.carriage import Carriage, area_of
from vbraille.simulation.hand import FLUENT, HumanHand, Sweep
from vbraille.simulation.motion import APPROACH_MM_S, Motion
from vbraille.simulation.recorded import Recorded

SPAN_MM = 10.8
TRAVEL_MM = 300.0
READS_S = TRAVEL_MM / 100 + TRAVEL_MM / 250


class Bench:
    """A carriage, looked at each millisecond."""

    def __init__(self, hand=None, travel_mm=TRAVEL_MM):
        display = replace(STRESS2.display, travel_mm=travel_mm)
        self.carriage = Carriage(display, hand or Sweep(100.0))
        self.now_ns = 5_000_000_000

    def ways(self, seconds):
        """Where it is in the next seconds."""
        found = []
        for _ in range(round(seconds * 1000)):
            self.now_ns += 1_000_000
            found.append(self.carriage.at(self.now_ns)[0])
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


def test_setting_out_again_changes_nothing_under_way(bench):
    bench.carriage.set_out()
    bench.ways(1.001)
    bench.carriage.set_out()
    assert bench.ways(1.0)[-1] == pytest.approx(200.0)


def test_a_recording_plays_once_from_where_it_begins(bench):
    bench = Bench(Recorded(Motion(np.array([0.0, 0.25, 0.5]), np.array([14.2, 39.2, 20.0]))))
    for _ in range(3):
        bench.carriage.set_out()
        ways = bench.ways(2.0)
        if not _:
            assert np.abs(np.diff(ways)).max() <= APPROACH_MM_S / 1000 + 1e-6
            assert ways[100] == pytest.approx(25.0)  # 25 mm at 250 mm/s
            assert ways[350] == pytest.approx(50.0)
        assert ways[-1] == pytest.approx(20.0 + SPAN_MM)


def test_it_goes_no_further_than_its_stops():
    bench = Bench(Recorded(Motion(np.array([0.0, 0.25, 0.5]), np.array([0.0, 50.0, -50.0]))), 40.0)
    bench.carriage.set_out()
    ways = bench.ways(1.0)
    assert (ways.min(), ways.max()) == (0.0, 40.0)


def test_going_back_it_waits_at_the_stop_to_be_told_again(bench):
    bench.carriage.set_out()
    bench.ways(1.001)
    bench.carriage.go_back(bench.now_ns)
    ways = bench.ways(1.0)
    assert ways[199] == pytest.approx(50.0)
    assert not ways[400:].any()
    bench.carriage.go_back(bench.now_ns)
    assert not bench.ways(0.1).any()
    bench.carriage.set_out()
    assert bench.ways(1.001)[-1] == pytest.approx(100.0)


def test_told_again_on_the_way_back_it_goes_to_the_stop_first(bench):
    bench.carriage.set_out()
    bench.ways(1.001)
    bench.carriage.go_back(bench.now_ns)
    bench.carriage.set_out()
    ways = bench.ways(1.4)
    assert ways[:410].min() == pytest.approx(0.0, abs=1e-6)
    assert ways[-1] == pytest.approx(100.0, abs=0.3)


# Two axes


DISPLAY = replace(STRESS2.display, travel_mm=TRAVEL_MM, height_mm=65.0, turns=True)


def places(carriage, seconds, begun_ms=0):
    """Where a carriage is in the next seconds, each millisecond; float64[n, 3]."""
    return np.array(
        [carriage.at(1_000_000 * (begun_ms + ms)) for ms in range(1, round(seconds * 1000) + 1)]
    )


def made(hand, **axes):
    display = replace(DISPLAY, **axes)
    return Carriage(display, hand, area_of(DISPLAY, 10.0))


def test_the_page_is_what_fits_on_the_surface():
    assert area_of(STRESS2.display, 10.0) is None
    area = area_of(DISPLAY, 10.0)
    assert (area.lines, area.pitch_mm) == (6, 10.0)
    assert (area.start_mm, area.end_mm) == pytest.approx((-SPAN_MM, TRAVEL_MM - SPAN_MM))
    assert area_of(DISPLAY, 100.0).lines == 1


def test_a_hand_reads_the_page_line_by_line_and_again_from_its_top():
    carriage = made(Sweep(1000.0))
    assert not places(carriage, 0.1).any()
    carriage.set_out()
    found = places(carriage, 12.0, 100)
    assert found[:, 0].max() == pytest.approx(TRAVEL_MM, abs=1.0)
    middles = np.unique(found[np.flatnonzero(np.diff(found[:, 0]) > 0.9), 1].round(3))
    assert middles.tolist() == [5.0, 15.0, 25.0, 35.0, 45.0, 55.0]
    back = np.flatnonzero(np.diff(found[:, 1]) < 0)  # up to the first line
    assert back.size > 100
    assert np.abs(np.diff(found[:, 1])).max() <= APPROACH_MM_S / 1000 + 1e-9


def test_a_hand_as_people_s_strays_and_turns_and_stays_on_the_surface():
    carriage = made(HumanHand(FLUENT))
    carriage.set_out()
    found = places(carriage, 20.0)
    assert np.ptp(found[:, 2]) > 0.01
    assert found[:, 1].min() >= 0
    assert found[:, 1].max() <= 65.0
    alone = made(HumanHand(FLUENT), height_mm=0.0, turns=False)
    alone.set_out()
    assert not places(alone, 20.0)[:, 1:].any()


def test_a_recorded_hand_moves_on_all_axes_once():
    t_s = np.arange(0, 1.001, 0.1)
    hand = Recorded(Motion(t_s, 100 * t_s - SPAN_MM, 30 + 20 * t_s, 0.1 * t_s))
    carriage = made(hand)
    carriage.set_out()
    found = places(carriage, 3.0)
    approach_s = 30 / APPROACH_MM_S
    at = found[round((approach_s + 0.5) * 1000)]
    assert at == pytest.approx((50.0, 40.0, 0.05), abs=0.3)
    assert found[-1] == pytest.approx((100.0, 50.0, 0.1))


def test_it_goes_back_to_both_stops_and_straightens():
    t_s = np.arange(0, 1.001, 0.1)
    carriage = made(Recorded(Motion(t_s, 100 * t_s - SPAN_MM, 20 * t_s, 0.1 * t_s)))
    carriage.set_out()
    places(carriage, 0.5)
    carriage.go_back(500_000_000)
    found = places(carriage, 1.0, 500)
    assert not found[-1].any()
    assert np.abs(np.diff(found[:, 0])).max() <= APPROACH_MM_S / 1000 + 1e-9
