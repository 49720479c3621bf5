"""Duration of a trial, by the thesis's rule."""

import numpy as np
import pytest

from vbraille.braille.geometry import STRESS2, VBD
from vbraille.render import MAPPINGS, single_row
from vbraille.sessions.record.trajectory import duration, first_edge_mm

SPAN_MM = 7.7


def walk(*places_mm):
    """A way at 1 mm a tick of 10 ms."""
    x = [float(places_mm[0])]
    for place in places_mm[1:]:
        step = 1.0 if place > x[-1] else -1.0
        x += list(np.arange(x[-1] + step, place + step / 2, step))
    return np.array(x)


def measure(x, edge=0.0, moved=None):
    return duration(
        x,
        np.arange(x.size) * 10_000_000,
        (lambda: np.full(x.size, False)) if moved is None else (lambda: moved),
        edge_mm=edge,
        span_mm=SPAN_MM,
    )


def test_it_is_from_the_first_touch_to_the_last_way_back_over_the_leftmost_dot():
    x = walk(-12.0, 30.0, -10.0)
    found = measure(x)
    # x + S comes to 0 at -7 mm (0.7 mm past it), and is before it again at -8.
    assert (x[found.start - 1], x[found.start]) == (-8.0, -7.0)
    assert (x[found.end - 1], x[found.end]) == (-7.0, -8.0)
    assert found.returned
    assert found.seconds == pytest.approx(0.01 * (found.end - found.start))
    assert found.end - found.start == 75


def test_the_last_of_several_ways_back_counts_and_what_comes_after_is_cut_off():
    x = walk(-12.0, 10.0, -10.0, 20.0, -9.0)
    x = np.concatenate([x, np.full(500, -9.0)])
    found = measure(x)
    assert found.start == 5
    assert found.end == len(walk(-12.0, 10.0, -10.0, 20.0, -8.0)) - 1


def test_a_hand_that_stays_on_the_string_ends_with_the_last_actuator_off_its_idle_end():
    x = walk(-12.0, 30.0, 5.0)
    moved = np.zeros(x.size, bool)
    moved[8:50] = True
    found = measure(x, moved=moved)
    assert (found.start, found.end, found.returned) == (5, 49, False)


def test_the_dot_may_stand_further_right():
    x = walk(-12.0, 30.0, -10.0)
    found = measure(x, edge=10.48)
    assert x[found.start] == 3.0
    assert found.end - found.start == 55


def test_no_touch_no_duration():
    assert measure(walk(-12.0, -9.0)) is None
    assert measure(np.full(5, np.nan)) is None


def test_ticks_without_a_place_are_no_crossing_forth():
    x = np.concatenate([np.full(3, np.nan), walk(-12.0, 5.0, -12.0)])
    found = measure(x)
    assert found.start == 8
    assert found.returned


def test_the_leftmost_dot_is_one_that_is_shown():
    row = single_row(1)
    pitch = VBD.cell_pitch_mm
    assert first_edge_mm((0b1001,), row, VBD) == 0.0
    assert first_edge_mm((0b1000,), row, VBD) == VBD.dot_spacing_mm
    assert first_edge_mm((0, 0b10, 0b1), row, VBD) == 2 * pitch  # dot 2 is in another row
    assert first_edge_mm((0, 0b110110), row, VBD) is None
    alternate = MAPPINGS["alternate"]
    assert first_edge_mm((0, 0b10), alternate, STRESS2) == STRESS2.cell_pitch_mm
