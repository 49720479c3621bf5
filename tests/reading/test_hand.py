"""A hand that does not finish its line is told so, and one that never will ends a reading."""

import numpy as np
import pytest

from vbraille.engine.record import Flag
from vbraille.reading.hand import HandWatch

TICK = np.dtype([("x_mm", "f8"), ("time_ns", "i8"), ("flags", "i8")])


def told(path_mm, *, seconds=0.02, reached=False, flags=0, patient=False):
    watch = HandWatch(10.8, 100.0, "line 3", by_hand=True, otherwise="n brings the next line")
    said = []
    for number, x_mm in enumerate(path_mm):
        ticks = np.array([(x_mm, round((1 + number * seconds) * 1e9), flags)], TICK)
        said += watch.watch(ticks, reached=reached, patient=patient)
    return said, watch.hopeless


def sweeps(low, high, times):
    return [x for _ in range(times) for x in (*range(low, high, 5), *range(high, low, -5))]


def test_a_hand_that_reads_well_or_that_a_person_holds_is_told_nothing():
    assert told(sweeps(-5, 110, 5)) == ([], None)
    assert told([50.0] * 60, seconds=0.5, patient=True) == ([], None)


def test_a_still_hand_is_told_once():
    said, hopeless = told([50.0] * 50, seconds=0.5)
    assert len(said) == 1
    assert "still at 50 mm" in said[0]
    assert hopeless is None


@pytest.mark.parametrize(
    ("reached", "path"), [(False, sweeps(-5, 60, 4)), (True, sweeps(20, 90, 4))]
)
def test_a_hand_that_turns_at_one_place_again_and_again_is_hopeless(reached, path):
    said, hopeless = told(path, reached=reached)
    assert len(said) == 1
    assert "line 3" in hopeless


def test_a_person_who_goes_here_and_there_is_not_hopeless():
    path = [
        x for turn in (60, 40, 75, 50, 66, 30) for x in (*range(0, turn, 5), *range(turn, 0, -5))
    ]
    assert told(path)[1] is None


def test_a_device_that_takes_no_frames_is_said_and_is_hopeless_in_the_end():
    said, hopeless = told([50.0] * 30, seconds=0.5, flags=int(Flag.HELD))
    assert len(said) == 1
    assert "takes no frames" in said[0]
    assert hopeless is not None
