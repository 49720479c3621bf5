"""How the hand moved over a line: ways that are drawn here, and what is said of them."""

from itertools import pairwise

import numpy as np
import pytest

from vbraille.sessions.record.movement import describe, duration, pauses, turning_points
from vbraille.sessions.record.ticks import TICK

FIRST_MM, LAST_MM = 10.0, 50.0


def way(*places, speed_mm_s=20.0, tremor_mm=0.0):
    """Places at 1 kHz along a way through some places, and their times."""
    parts = [
        np.linspace(one, other, int(abs(other - one) / speed_mm_s * 1000) + 1)[1:]
        for one, other in pairwise(places)
    ]
    x_mm = np.concatenate([places[:1], *parts]).astype(float)
    x_mm += tremor_mm * np.sin(np.arange(x_mm.size) / 3)
    return x_mm, np.arange(x_mm.size) * 1_000_000


@pytest.mark.parametrize("tremor_mm", [0.0, 0.3])
@pytest.mark.parametrize(
    ("places", "pattern", "passes", "rescans"),
    [
        ((0, 60), "one pass", 1, 0),
        ((0, 60, 0), "one pass", 1, 0),
        ((0, 60, 0, 60, 5), "two passes", 2, 0),
        ((0, 55, 0, 55, 0, 55), "more passes", 3, 0),
        ((0, 40, 20, 60, 5), "re-scan", 0, 2),
        ((0, 60, 30, 45, 0), "re-scan", 1, 1),
        ((0, 30, 0), "in part", 0, 1),
    ],
)
def test_patterns(places, pattern, passes, rescans, tremor_mm):
    told = describe(*way(*places, tremor_mm=tremor_mm), FIRST_MM, LAST_MM)
    assert (told["pattern"], told["passes"], told["rescans"]) == (pattern, passes, rescans)


def test_speeds_of_both_ways():
    x_mm, time_ns = way(0, 60, speed_mm_s=30)
    back_mm, back_ns = way(60, 0, speed_mm_s=60)
    told = describe(
        np.concatenate([x_mm, back_mm]), np.concatenate([time_ns, time_ns[-1] + back_ns]),
        FIRST_MM, LAST_MM,
    )  # fmt: skip
    assert told["speed_right_mm_s"] == pytest.approx(30, rel=0.01)
    assert told["speed_left_mm_s"] == pytest.approx(60, rel=0.01)


@pytest.mark.parametrize("places", [(5, 5), (5, 6, 5, 6)])
def test_a_hand_that_hardly_moves_makes_no_stroke(places):
    assert turning_points(way(*places)[0]) == []
    assert describe(*way(*places), FIRST_MM, LAST_MM)["pattern"] == "in part"


def moved(*places_mm, speed_mm_s=50.0):
    """Ticks of a hand that goes from place to place, 1,000 a second."""
    ways = [np.arange(0)]
    for one, other in pairwise(places_mm):
        count = max(int(abs(other - one) / speed_mm_s * 1000), 500 if one == other else 1)
        ways.append(np.linspace(one, other, count, endpoint=False))
    x_mm = np.concatenate([*ways, [places_mm[-1]]])
    ticks = np.zeros(x_mm.size, TICK)
    ticks["x_mm"], ticks["time_ns"] = x_mm, np.arange(x_mm.size) * 10**6
    ticks["vx_mm_s"] = np.gradient(x_mm) * 1000
    return ticks


def test_reading_lasts_from_the_first_touch_to_the_last():
    found = duration(moved(0, 60, 0), edge_mm=20.0, span_mm=10.0)
    assert found.seconds == pytest.approx(2 * (60 - 15) / 50, abs=0.002)
    assert found.returned
    assert not duration(moved(0, 60), 20.0, 10.0).returned
    assert duration(moved(0, 10), 20.0, 10.0) is None


def test_pauses_and_regressions_are_counted_up_to_the_furthest_place():
    ticks = moved(0, 30, 30, 40, 30, 70, 0)
    count, seconds, back = pauses(ticks, FIRST_MM, 10.0, back_mm=4.0)
    assert (count, back) == (1, 1)
    assert seconds == pytest.approx(0.5, abs=0.01)
