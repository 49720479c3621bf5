import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vbraille.engine.engine import EndOfLine
from vbraille.simulation.hand import DEVICE, FLUENT, HumanHand, Sweep

SPAN_MM, END_MM = 10.8, 100.0


def test_a_line_is_done_when_the_hand_was_at_the_end_and_is_back():
    end = EndOfLine(SPAN_MM, END_MM)
    home_mm = -SPAN_MM / 2
    places = [home_mm, 90, home_mm]  # back, but never at the end
    assert end.find(np.array(places)) is None
    assert not end.reached
    assert end.find(np.array([np.nan, END_MM, home_mm + 1.1])) is None
    assert end.reached
    assert end.find(np.array([np.nan, home_mm + 1.1, home_mm + 0.9, 0])) == 2


@given(st.lists(st.floats(-SPAN_MM / 2, END_MM + SPAN_MM / 2), max_size=60), st.integers(1, 9))
def test_places_in_parts_are_as_places_one_by_one(places, part):
    one, many = EndOfLine(SPAN_MM, END_MM), EndOfLine(SPAN_MM, END_MM)
    at = (n for n, x_mm in enumerate(places) if one.find(np.array([x_mm])) is not None)
    stepped = next(at, None)
    found = None
    for start in range(0, len(places), part):
        at = many.find(np.array(places[start : start + part]))
        if at is not None:
            found = start + at
            break
    assert found == stepped


@pytest.mark.parametrize("hand", [Sweep(60), HumanHand(DEVICE, 3), HumanHand(FLUENT, 4)])
@pytest.mark.parametrize("end_mm", [6.3, 17.4, 285.0])
def test_made_up_hands_are_done_once_and_at_the_last(hand, end_mm):
    for _ in range(5):
        places = hand.read_line(-SPAN_MM, end_mm).sample(1000) + SPAN_MM / 2
        done = EndOfLine(SPAN_MM, end_mm).find(places)
        assert done is not None
        assert done >= places.size - 10  # nothing but the last millimetre is left
