"""Strokes, passes, speeds and patterns of hand-made ways."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vbraille.analysis.input.sessions import (
    IN_PART,
    MORE_PASSES,
    ONE_PASS,
    PATTERN_RULE,
    PATTERNS,
    RESCAN,
    REVERSAL_MM,
    TURN_MM,
    TWO_PASSES,
    read,
    strokes,
    turning_points,
)
from vbraille.sessions.record.trajectory import Trajectory, duration

SPAN_MM = 7.7
EDGES_MM, DOT_MM = (10.0, 14.0, 24.0, 48.0), 2.0  # a string from 10 to 50 mm
HOME_MM = -SPAN_MM
FIRST_MM, LAST_MM = 10.0 - SPAN_MM / 2, 50.0 - SPAN_MM / 2  # its middle at the string's ends

legs = st.lists(st.floats(4.0, 60.0), min_size=1, max_size=8)


def way(*places_mm, speed_mm_s=50.0, back_mm_s=None):
    """Places at 1 kHz of a hand that goes from place to place; a second of rest for each `None`."""
    parts, at = [np.array([float(places_mm[0])])], float(places_mm[0])
    for place in places_mm[1:]:
        if place is None:
            parts.append(np.full(1000, at))
            continue
        pace = speed_mm_s if place > at or back_mm_s is None else back_mm_s
        ticks = max(round(abs(place - at) / pace * 1000), 1)
        parts.append(at + (place - at) * np.arange(1, ticks + 1) / ticks)
        at = float(place)
    return np.concatenate(parts)


def zigzag(lengths_mm, first=1):
    """A way of legs of these lengths, in turns to and fro."""
    return way(0.0, *np.cumsum([first * (-1) ** n * leg for n, leg in enumerate(lengths_mm)]))


def times_ns(x_mm):
    return 5_000_000_000 + np.arange(x_mm.size, dtype=np.int64) * 1_000_000


def seen(x_mm, moved=None, edges_mm=EDGES_MM):
    time_ns = times_ns(x_mm)
    moved = np.ones(x_mm.size, bool) if moved is None else moved
    found = duration(x_mm, time_ns, lambda: moved, edge_mm=edges_mm[0], span_mm=SPAN_MM)
    assert found is not None
    return read(Trajectory(x_mm, time_ns, edges_mm, DOT_MM, SPAN_MM, found))


def ends(made):
    return [(stroke.from_mm, stroke.to_mm) for stroke in made]


def reference_turns(x_mm, least_mm):
    """By a walk along the way: a place is where it turns once it has gone back far enough."""
    low = high = 0
    turns, rising = [], None
    for n, x in enumerate(x_mm):
        if x < x_mm[low]:
            low = n
        if x > x_mm[high]:
            high = n
        if rising is not False and x_mm[high] - x >= least_mm and low <= n:
            turns += [low, high] if rising is None and low < high else [high]
            rising, low = False, n
        elif rising is not True and x - x_mm[low] >= least_mm:
            turns += [high, low] if rising is None and high < low else [low]
            rising, high = True, n
        if rising is True:
            low = n
        elif rising is False:
            high = n
    return [] if rising is None else [*turns, high if rising else low]


@pytest.mark.parametrize(
    ("places", "pattern", "passes", "rescans"),
    [
        ((60,), ONE_PASS, 1, 0),
        ((60, HOME_MM, 60), TWO_PASSES, 2, 0),
        ((60, 4, 60), TWO_PASSES, 2, 0),
        ((60, 4, 55, 4, 60), MORE_PASSES, 3, 0),
        ((30, 20, 60), RESCAN, 0, 2),
        ((60, 20, 35), RESCAN, 1, 1),
        ((LAST_MM - 3.9,), ONE_PASS, 1, 0),
        ((LAST_MM - 4.1,), IN_PART, 0, 1),
        ((30,), IN_PART, 0, 1),
        ((60, 57, 60), ONE_PASS, 1, 0),  # no more of the string in that
        ((60, 20, 23.9), ONE_PASS, 1, 0),  # less than a tenth of it
        ((60, 20, 24.1), RESCAN, 1, 1),
        ((5, HOME_MM, 60), ONE_PASS, 1, 0),  # the hand had hardly come to it
        ((60, FIRST_MM + 4.1, 60), RESCAN, 1, 1),
        ((60, FIRST_MM + 3.9, 60), TWO_PASSES, 2, 0),
    ],
)
def test_patterns(places, pattern, passes, rescans):
    reading = seen(way(HOME_MM, *places, HOME_MM))
    assert (reading.pattern, reading.passes, reading.rescans) == (pattern, passes, rescans)
    assert reading.pattern in PATTERNS
    assert reading.returned


def test_many_steps_without_a_rescan_are_no_pass():
    places = [place for n in range(20) for place in (5.0 + 3.5 * n, 2.9 + 3.5 * n)]
    reading = seen(way(HOME_MM, *places, 70, HOME_MM))
    assert (reading.pattern, reading.passes) == (RESCAN, 0)


def test_the_rule_tells_its_numbers():
    for number in ("2 mm", "90 %", "10 %"):
        assert number in PATTERN_RULE
    assert PATTERN_RULE.count(".") == 1


def test_speeds_are_those_of_each_way():
    reading = seen(way(HOME_MM, 60, HOME_MM, 60, HOME_MM, speed_mm_s=8.0, back_mm_s=250.0))
    assert reading.speed_right_mm_s == pytest.approx(8.0, rel=1e-3)
    assert reading.speed_left_mm_s == pytest.approx(250.0, rel=1e-2)


def test_a_stop_within_a_stroke_takes_its_time_and_one_at_a_turn_does_not():
    plain = seen(way(HOME_MM, 60, HOME_MM, speed_mm_s=10.0))
    at_turn = seen(way(HOME_MM, 60, None, HOME_MM, speed_mm_s=10.0))
    within = seen(way(HOME_MM, 30, None, 60, HOME_MM, speed_mm_s=10.0))
    assert at_turn.speed_right_mm_s == pytest.approx(plain.speed_right_mm_s)
    assert at_turn.speed_left_mm_s == pytest.approx(plain.speed_left_mm_s)
    assert at_turn.duration_s == pytest.approx(plain.duration_s + 1.0)
    # From where the right column meets the first dot, less the turns.
    length_mm = 60 - (10 - SPAN_MM) - 2 * TURN_MM
    assert within.speed_right_mm_s == pytest.approx(length_mm / (length_mm / 10 + 1), rel=1e-3)
    assert within.speed_left_mm_s == pytest.approx(plain.speed_left_mm_s)


def test_what_comes_before_and_after_the_time_that_counts_is_in_no_speed():
    slow = way(HOME_MM, -1.0, HOME_MM, -1.0, HOME_MM, speed_mm_s=5.0)
    quick = way(HOME_MM, 60, HOME_MM, speed_mm_s=40.0)
    assert seen(np.concatenate([slow, quick, slow])) == seen(quick)


def test_a_hand_that_stays_has_no_speed_to_the_left():
    x_mm = way(HOME_MM, 60)
    reading = seen(x_mm, moved=x_mm < 55)
    assert (reading.pattern, reading.returned) == (ONE_PASS, False)
    assert reading.speed_left_mm_s is None
    still = seen(np.concatenate([way(HOME_MM, 3.0), np.full(10, 3.0)]))
    assert (still.pattern, still.speed_right_mm_s) == (IN_PART, None)


def test_places_that_are_not_known_are_left_out():
    x_mm = way(HOME_MM, 60, HOME_MM)
    unknown = np.concatenate([np.full(700, np.nan), x_mm])
    assert seen(unknown) == seen(x_mm)
    holed = x_mm.copy()
    holed[[500, 501, 1900]] = np.nan
    time_ns = times_ns(x_mm)
    found = duration(
        x_mm, time_ns, lambda: np.ones(x_mm.size, bool), edge_mm=EDGES_MM[0], span_mm=SPAN_MM
    )
    assert read(Trajectory(holed, time_ns, EDGES_MM, DOT_MM, SPAN_MM, found)) == seen(x_mm)


def test_a_string_of_one_dot_can_be_read():
    reading = seen(way(HOME_MM, 30, HOME_MM), edges_mm=(10.0,))
    assert (reading.pattern, reading.passes) == (ONE_PASS, 1)


def test_a_way_that_does_not_turn_or_move_has_no_stroke_or_one():
    assert strokes(np.zeros(0), np.zeros(0, np.int64)) == []
    for x_mm in (np.zeros(1), np.full(50, 3.0), way(0.0, REVERSAL_MM - 0.01)):
        assert strokes(x_mm, times_ns(x_mm)) == []
    x_mm = way(0.0, REVERSAL_MM)
    assert ends(strokes(x_mm, times_ns(x_mm))) == [(0.0, REVERSAL_MM)]


def test_a_short_stroke_to_and_fro_within_its_turns_is_timed_whole():
    x_mm = way(0.0, 1.9, 0.2, 2.05)
    (stroke,) = strokes(x_mm, times_ns(x_mm))
    assert (stroke.start, stroke.end, stroke.length_mm) == (0, x_mm.size - 1, 2.05)
    assert stroke.seconds == pytest.approx((x_mm.size - 1) / 1000)


@given(legs, st.sampled_from([1, -1]))
def test_strokes_are_the_legs_of_a_way(lengths_mm, first):
    made = strokes(*(lambda x: (x, times_ns(x)))(zigzag(lengths_mm, first)))
    assert [abs(s.to_mm - s.from_mm) for s in made] == pytest.approx(lengths_mm)
    assert [s.right for s in made] == [(n % 2 == 0) == (first == 1) for n in range(len(made))]
    for stroke in made:  # of way's ticks, each leg has a speed of nearly 50 mm/s
        assert stroke.length_mm / stroke.seconds == pytest.approx(50, rel=0.02)


@given(legs, st.integers(0, 2**32 - 1), st.floats(0.0, 0.99))
def test_tremor_below_the_threshold_changes_nothing(lengths_mm, seed, tremor):
    x_mm = zigzag(lengths_mm)
    shaken = x_mm + np.random.default_rng(seed).uniform(-0.5, 0.5, x_mm.size) * tremor * REVERSAL_MM
    plain, made = (strokes(x, times_ns(x)) for x in (x_mm, shaken))
    assert [s.right for s in made] == [s.right for s in plain]
    for stroke, still in zip(made, plain, strict=True):
        assert (stroke.from_mm, stroke.to_mm) == pytest.approx(
            (still.from_mm, still.to_mm), abs=REVERSAL_MM / 2
        )


@given(st.lists(st.integers(-40, 40), min_size=1, max_size=60), st.integers(1, 30))
def test_turning_points_are_those_of_a_walk_along_the_way(tenths_mm, least):
    x_mm = np.cumsum(np.array(tenths_mm, float))
    turns = turning_points(x_mm, least)
    assert x_mm[turns].tolist() == [x_mm[n] for n in reference_turns(x_mm, least)]
    assert (np.abs(np.diff(x_mm[turns])) >= least).all()


@given(st.lists(st.integers(-40, 40), min_size=1, max_size=60), st.floats(-100, 100))
def test_mirrored_moved_or_backwards_the_strokes_are_the_same(steps, shift_mm):
    x_mm = np.cumsum(np.array(steps, float)) / 8
    time_ns = times_ns(x_mm)
    made = strokes(x_mm, time_ns)
    mirrored = strokes(-x_mm, time_ns)
    assert ends(mirrored) == [(-s.from_mm, -s.to_mm) for s in made]
    assert [(s.length_mm, s.seconds) for s in mirrored] == [(s.length_mm, s.seconds) for s in made]
    # By a whole number of eighths, so that nothing is rounded.
    moved = strokes(x_mm + round(shift_mm), time_ns)
    assert [(s.start, s.end, s.seconds) for s in moved] == [
        (s.start, s.end, s.seconds) for s in made
    ]
    backwards = strokes(x_mm[::-1], time_ns)
    assert ends(backwards) == [(s.to_mm, s.from_mm) for s in made[::-1]]


@given(st.lists(st.floats(-7.0, 80.0), min_size=1, max_size=8), st.integers(-300, 300))
def test_a_string_that_stands_elsewhere_is_read_in_the_same_way(places, shift_mm):
    x_mm = np.round(way(HOME_MM, *places, 20.0, HOME_MM, speed_mm_s=200.0) * 256) / 256
    there = seen(x_mm + shift_mm, edges_mm=tuple(edge + shift_mm for edge in EDGES_MM))
    here = seen(x_mm)
    assert (there.pattern, there.passes, there.rescans) == (
        here.pattern,
        here.passes,
        here.rescans,
    )
    assert there.duration_s == pytest.approx(here.duration_s, abs=0.002)
