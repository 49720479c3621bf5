from itertools import pairwise

import pytest

from vbraille.reading.advancing import Scroll


def time_of(scroll, cells, turn=lambda _s: None, steps_s=0.02):
    """How long a line of so many cells takes, looked at fifty times a second."""
    scroll.begin(100.0)
    for step in range(100_000):
        now_s = 100.0 + step * steps_s
        turn(now_s - 100.0)
        if scroll.due(cells, now_s):
            return now_s - 100.0
    raise AssertionError("the line never ends")


@pytest.fixture
def scroll():
    scroll = Scroll()
    scroll.on = True
    return scroll


@pytest.mark.parametrize(("cells", "seconds"), [(40, 5.0), (8, 1.0), (1, 0.125), (0, 0.125)])
def test_a_line_has_the_time_of_its_cells(scroll, cells, seconds):
    assert time_of(scroll, cells) == pytest.approx(seconds, abs=0.021)
    assert time_of(scroll, cells) == pytest.approx(seconds, abs=0.021)  # the next line, as long


def test_another_speed_counts_at_once_for_the_present_line(scroll):
    def turn(since_s):
        if since_s == pytest.approx(2.5):
            assert scroll.turn(1)
            assert scroll.words == "9.6 cells a second"

    # Half of 40 cells at 8 a second, the other half at 9.6.
    assert time_of(scroll, 40, turn) == pytest.approx(20 / 8 + 20 / 9.6, abs=0.05)


def test_speeds_go_in_steps_to_their_bounds_and_back_to_where_they_were(scroll):
    up = [scroll.speed_cells_s]
    while scroll.turn(1):
        up.append(scroll.speed_cells_s)
    assert up == [8.0, 9.6, 11.5, 13.8, 16.6, 19.9, 23.9, 28.7, 30.0]
    assert scroll.words == "30 cells a second"
    down = [scroll.speed_cells_s]
    while scroll.turn(-1):
        down.append(scroll.speed_cells_s)
    assert down[:9] == up[::-1]
    assert down[-1] == 1.0
    assert scroll.words == "1 cell a second"
    assert all(1.02 <= faster / slower <= 1.25 for faster, slower in pairwise(down))


def test_time_in_which_nobody_looks_does_not_count(scroll):
    scroll.begin(100.0)
    looks = [n / 50 for n in range(25)]  # half a second
    assert not any(scroll.due(8, 100.0 + look) for look in looks)
    assert not any(scroll.due(8, 160.0 + look) for look in looks)
    assert scroll.due(8, 160.55)


def test_the_line_at_which_it_is_turned_on_has_all_its_time(scroll):
    assert time_of(scroll, 40) > 4.9
    scroll.due(40, 200.0)
    scroll.on = False
    assert not scroll.due(1, 300.0)
    scroll.on = True
    assert not scroll.due(1, 300.0)
    assert not scroll.due(1, 300.1)
    assert scroll.due(1, 300.2)
