"""What a device has to tell: at once, but each kind at most once a second."""

import numpy as np
import pytest

from vbraille.devices.events import (
    EVERY_NS,
    PLACE_EVERY_NS,
    Back,
    Button,
    Knob,
    Notice,
    Notices,
    Silent,
)

MS = 1_000_000


def test_the_first_is_told_at_once_and_the_others_are_counted():
    notices = Notices()
    told = []
    for ms in range(3001):
        if ms < 2500:
            notices.add(Notice(1, f"hot at {ms}"), ms * MS)
        told += [(ms, event) for event in notices.take(ms * MS)]
    assert told == [
        (0, Notice(1, "hot at 0")),
        (1000, Notice(1, "hot at 1000", times=1000)),
        (2000, Notice(1, "hot at 2000", times=1000)),
        (3000, Notice(1, "hot at 2499", times=499)),
    ]


def test_what_is_rare_is_told_as_it_is():
    notices = Notices()
    told = []
    for ms in range(0, 10_000, 500):
        if ms % 1000 == 0:
            notices.add(Back(), ms * MS)
        told += notices.take(ms * MS)
    assert told == [Back()] * 10


def test_of_two_that_take_turns_the_later_is_told_later():
    notices = Notices()
    for ms in range(100):
        notices.add((Silent(ms), Back())[ms % 2], ms * MS)
        if ms == 1:
            assert notices.take(ms * MS) == [Silent(0), Back()]
    assert notices.take(EVERY_NS - 1) == []
    assert notices.take(2 * EVERY_NS) == [Silent(98, times=49), Back(times=49)]
    assert notices.take(9 * EVERY_NS) == []


def test_who_never_tells_the_same_is_not_heard_without_an_end():
    notices = Notices()
    told = []
    for ms in range(10_000):
        notices.add(Notice(ms, "again"), ms * MS)
        told += notices.take(ms * MS)
    assert len(told) < 200


def test_each_press_of_a_button_is_told_but_not_without_an_end():
    notices = Notices()
    presses = [Button(1, pressed=bool(number % 2)) for number in range(1000)]
    for press in presses[:100]:
        notices.add(press, 0)
    assert notices.take(0) == presses[:100]
    for press in presses:
        notices.add(press, 0)
    assert notices.take(0) == presses[:256]


def test_a_knob_that_is_turned_is_followed_and_ends_where_it_was_left():
    notices = Notices()
    told = []
    for ms in range(2000):
        if ms < 990:
            notices.add(Knob(1, abs(500 - ms) / 500), ms * MS)
        told += [(ms, event) for event in notices.take(ms * MS)]
    times_ms = [ms for ms, _ in told]
    assert max(np.diff(times_ms)) * MS <= PLACE_EVERY_NS + MS
    assert len(told) <= 990 * MS / PLACE_EVERY_NS + 2
    assert told[-1] == (1000, Knob(1, 489 / 500))
    assert {event.times for _, event in told} == {1}


def test_a_count_that_was_made_before_is_kept():
    notices = Notices()
    notices.add(Back(), 0)
    notices.add(Back(times=7), MS)
    notices.take(0)
    assert notices.take(EVERY_NS) == [Back(times=7)]


@pytest.mark.parametrize("own", [False, True])
def test_what_stands_for_one_another_may_be_said_otherwise(own):
    notices = Notices()
    hot, cold = Notice(255, "hot"), Notice(255, "cold")
    for event in (hot, cold):
        notices.add(event, 0, event if own else None)
    assert notices.take(0) == ([hot, cold] if own else [hot])
