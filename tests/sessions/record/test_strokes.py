"""Reading patterns from the way of the hand: fig. 3.15 of the thesis."""

import itertools

import numpy as np
import pytest

from vbraille.sessions.record.strokes import describe, turning_points

FIRST_MM, LAST_MM = 10.0, 50.0


def way(*places, speed_mm_s=20.0, tremor_mm=0.0):
    """Places at 1 kHz along a way through some places, and their times."""
    parts = [
        np.linspace(one, other, int(abs(other - one) / speed_mm_s * 1000) + 1)[1:]
        for one, other in itertools.pairwise(places)
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
