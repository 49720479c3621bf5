"""How the hand moved over a line: ways that are drawn here, and what is said of them."""

from itertools import pairwise

import numpy as np
import pytest

from vbraille.sessions.record.movement import duration, pauses
from vbraille.sessions.record.ticks import TICK

FIRST_MM = 10.0


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
