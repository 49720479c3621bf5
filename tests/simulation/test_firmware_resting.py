"""How the simulated controller goes to rest and leaves it, rule by rule of the protocol's page."""

from dataclasses import replace

import numpy as np
import pytest

from tests.controllers import HastyController
from tests.packing import packed as packed_levels
from tests.simulation.controlled import (
    INFO,
    REST,
    SWING,
    TOP,
    Bench,
    packed,
    without_states,
)
from vbraille.devices.serial.wire import (
    DELIMITER,
    PLACED,
    RESTING,
    TRIPPED,
    Frame,
    Hello,
    Rest,
    Watchdog,
    encode,
)


def ramp(begun, milliseconds):
    done = min(milliseconds / 20, 1)
    return np.rint(np.array(begun) + done * (np.array(REST) - begun)).tolist()


def test_the_watchdog_trips_after_50_ms_and_ramps_for_20(greeted):
    greeted.show()
    heard = greeted.tick(49)
    assert without_states(heard) == []
    assert not any(state.resting for state in heard)
    assert greeted.levels == SWING
    watchdog, state = greeted.tick()
    assert watchdog == Watchdog(trips=1, dropped=0)
    assert state.resting
    for milliseconds in range(1, 20):
        greeted.tick()
        assert greeted.levels == ramp(SWING, milliseconds)
        assert not greeted.controller.at_rest
    greeted.tick()
    assert (greeted.levels, greeted.controller.at_rest) == (REST, True)
    assert greeted.controller.rest_after_us == 70_000
    assert without_states(greeted.tick(200)) == []  # its own trip disarms it
    assert greeted.controller.trips == 1


@pytest.mark.parametrize("after_us", [0, 1, 499, 500, 999])
def test_it_rests_within_71_ms_wherever_between_ticks_the_last_frame_came(greeted, after_us):
    greeted.show(REST)
    greeted.tick()
    greeted.now_us += after_us
    greeted.show()
    greeted.now_us -= after_us
    greeted.tick(71)
    assert greeted.controller.at_rest
    assert 70_000 <= greeted.controller.rest_after_us < 71_000


def test_a_late_tick_changes_nothing_about_when_the_timer_saw_to_it(greeted):
    greeted.show()
    greeted.now_us += 40_000
    greeted.tick()
    greeted.now_us += 14_300  # 55.3 ms after the frame, where it was due after 50
    greeted.tick()
    assert (
        greeted.levels == np.rint(np.array(SWING) + (np.array(REST) - SWING) * (6.3 / 20)).tolist()
    )
    greeted.now_us += 500_000
    greeted.tick()
    assert greeted.controller.rest_after_us == 70_000


def test_all_that_was_due_is_done_in_one_late_tick(greeted):
    greeted.show()
    greeted.now_us += 500_000
    assert without_states(greeted.tick()) == [Watchdog(1, 0)]
    assert greeted.controller.at_rest
    assert greeted.controller.rest_after_us == 70_000


def test_frames_feed_it(greeted):
    for _ in range(10):
        greeted.show()
        assert without_states(greeted.tick(49)) == []
    assert greeted.controller.trips == 0


@pytest.mark.parametrize(
    "line",
    [
        encode(Frame(1, packed(SWING)))[:-2] + b"\x55\0",
        encode(Frame(1, packed(SWING) + b"\0")),
        b"\x55",
        DELIMITER,
    ],
)
def test_nothing_else_does(greeted, line):
    greeted.show()
    for _ in range(49):
        greeted.tick()
        greeted.send_bytes(line)
    assert without_states(greeted.tick())[0].trips == 1


@pytest.mark.parametrize("message", [Rest(), Hello()])
def test_rest_and_hello_bring_it_to_rest_by_the_ramp_and_disarm_it(greeted, message):
    greeted.show()
    greeted.tick(10)
    greeted.send(message)
    greeted.tick(5)
    assert greeted.levels == ramp(SWING, 5)
    assert greeted.state().resting
    greeted.tick(14)
    assert (greeted.levels, greeted.controller.at_rest) == (REST, True)
    assert greeted.controller.rest_after_us == 30_000
    greeted.tick(100)
    assert greeted.controller.trips == 0


def test_a_ramp_on_its_way_is_not_begun_anew(greeted):
    greeted.show()
    greeted.tick(60)
    greeted.send(Rest())
    greeted.tick(5)
    greeted.send(Hello())
    greeted.tick(5)
    assert greeted.controller.at_rest
    assert greeted.controller.rest_after_us == 70_000


def test_a_frame_does_not_cut_the_ramp_after_a_trip_and_the_first_taken_has_it_reported(greeted):
    greeted.show()
    greeted.tick(50)
    for milliseconds in range(1, 20):
        assert greeted.frame() == []  # full, as from a host that has not heard
        assert greeted.frame(REST) == []
        state = greeted.state()
        assert greeted.levels == ramp(SWING, milliseconds)
        assert (state.resting, state.tripped, state.frame_sequence) == (True, True, 2)
    greeted.tick()
    assert (greeted.levels, greeted.controller.at_rest) == (REST, True)
    assert greeted.controller.rest_after_us == 70_000
    assert greeted.frame(REST) == []
    watchdog, state = greeted.tick()
    assert watchdog == Watchdog(trips=1, dropped=0)
    assert (state.resting, state.tripped) == (False, False)
    assert greeted.controller.dropped == 0  # none was, for all were valid


@pytest.mark.parametrize("message", [Rest(), Hello()])
def test_a_frame_does_not_cut_the_ramp_after_rest_and_hello(greeted, message):
    greeted.show()
    greeted.tick(10)
    greeted.send(message)
    greeted.frame()
    for milliseconds in range(1, 20):
        greeted.tick()
        greeted.frame()
        assert greeted.levels == ramp(SWING, milliseconds)
    greeted.tick()
    greeted.frame()
    assert (greeted.levels, greeted.controller.at_rest) == (REST, True)
    assert greeted.controller.rest_after_us == 30_000


def next_to_rest(step):
    return [rest + (step if rest == 0 else -step) for rest in REST]


@pytest.mark.parametrize("to_rest", ["start", "trip", "rest", "hello"])
def test_rest_is_left_by_a_twentieth_of_the_swing_at_most(greeted, to_rest):
    if to_rest != "start":
        greeted.show()
    if to_rest == "rest":
        greeted.send(Rest())
    if to_rest == "hello":
        greeted.send(Hello())
    greeted.tick(100)
    frames = greeted.controller.frames
    for levels in (SWING, next_to_rest(TOP // 20 + 1)):
        greeted.frame(levels)
        greeted.tick()
        assert (greeted.levels, greeted.controller.frames) == (REST, frames)
    greeted.frame(next_to_rest(TOP // 20))
    greeted.tick()
    assert greeted.levels == next_to_rest(20)  # two fifths of 51
    greeted.tick(2)
    assert greeted.levels == next_to_rest(TOP // 20)
    greeted.tick()
    greeted.frame(SWING)  # from then on the host says how fast
    assert greeted.levels == SWING


def test_at_rest_only_the_last_frame_that_waits_is_looked_at(greeted):
    """A backlog of what the hand felt long ago, with a frame near rest in it."""
    near, far = next_to_rest(TOP // 20), SWING
    greeted.send(*(Frame(n, packed(levels)) for n, levels in enumerate((near, near, far, far))))
    assert greeted.state().resting
    assert (greeted.levels, greeted.controller.frames) == (REST, 0)
    greeted.frame(near)
    greeted.send(Rest())
    assert greeted.state().resting


def steps(greeted, ticks):
    """How far the first actuator goes in each tick."""
    levels = [greeted.levels[0]]
    for _ in range(ticks):
        greeted.tick()
        levels.append(greeted.levels[0])
    return np.diff(levels).tolist()


def test_frames_that_were_lost_are_caught_up_with_at_two_in_a_period(greeted):
    greeted.show(REST)
    greeted.tick()
    greeted.sequence += 29
    greeted.frame([300, 0, 0, TOP, TOP, TOP])
    assert greeted.levels[0] == 0
    assert steps(greeted, 16) == [20] * 15 + [0]
    assert greeted.state().frame_sequence == greeted.sequence


def test_frames_that_were_held_up_do_not_move_it_all_together(greeted):
    greeted.show(REST)
    greeted.tick()
    for level in range(10, 310, 10):
        greeted.frame([level, 0, 0, TOP, TOP, TOP])
    assert greeted.levels[0] == 10  # the first goes at once
    assert steps(greeted, 17) == [10, *[20] * 14, 0, 0]
    greeted.frame([310, 0, 0, TOP, TOP, TOP])
    assert greeted.levels[0] == 310


def test_a_device_of_two_levels_leaves_rest_by_a_frame_of_rest():
    bench = Bench(replace(INFO, top_level=1))
    bench.send(Hello())
    rest, swing = (packed_levels(levels, 1) for levels in ([0, 0, 0, 1, 1, 1], [1] * 6))
    bench.send(Frame(1, swing))
    assert bench.controller.frames == 0
    bench.send(Frame(2, rest))
    bench.tick()
    bench.send(Frame(3, swing))
    assert bench.levels == [1] * 6


def test_frames_that_come_twice_or_late_are_dropped_and_do_not_feed_the_watchdog(greeted):
    greeted.sequence = 65_530
    greeted.show([0, 0, 0, TOP, TOP, TOP])
    for level in range(10):  # over the wrap
        greeted.frame([level] * 6)
        greeted.tick(level < 9)
    assert greeted.levels == [9] * 6
    for late in (0, 1, 5, 30_000):
        greeted.send(Frame((greeted.sequence - late) & 0xFFFF, packed(SWING)))
    assert greeted.levels == [9] * 6
    assert greeted.controller.dropped == 4
    for _ in range(49):
        greeted.tick()
        greeted.send(Frame(greeted.sequence, packed(SWING)))
    assert without_states(greeted.tick())[0].trips == 1
    greeted.tick(30)
    greeted.send(Frame(7, packed(REST)))  # after a rest any number is the first
    assert greeted.state().frame_sequence == 7


def test_a_lost_report_of_a_trip_is_repeated_in_the_states_until_a_frame_is_taken(greeted):
    greeted.show()
    assert not any(state.tripped for state in greeted.tick(49))
    assert all(state.tripped for state in greeted.tick(300)[1:])
    greeted.frame()  # not taken: too far from rest
    assert greeted.state().flags == PLACED | RESTING | TRIPPED
    greeted.frame(REST)
    assert greeted.state().flags == PLACED


@pytest.mark.parametrize("message", [Rest(), Hello()])
def test_whoever_says_rest_or_hello_needs_no_report_of_a_trip_any_more(greeted, message):
    greeted.show()
    greeted.tick(100)
    greeted.send(message)
    assert greeted.state().flags == PLACED | RESTING


def test_a_hasty_controller_s_ramp_is_cut_short_and_it_does_not_repeat():
    old = Bench(made=HastyController)
    old.send(Hello())
    old.frame()  # from rest
    assert old.levels == SWING
    *_, tripped = old.tick(60)
    assert (old.levels, tripped.flags) == (ramp(SWING, 10), PLACED | RESTING)
    assert old.frame() == [Watchdog(trips=1, dropped=0)]
    assert old.levels == SWING
    old.send(Frame(old.sequence, packed(REST)))
    assert old.levels == REST


def test_what_frames_have_moved_in_a_period_counts_in_the_next():
    bench = Bench()
    bench.send(Hello())
    bench.show(SWING)
    bench.tick(10)
    near = [[TOP - step, 500, 0, 0, 500, TOP] for step in (10, 20, 30)]
    bench.frame(near[0])
    assert bench.levels == near[0]  # at once
    bench.frame(near[1])
    assert bench.levels == near[0]
    bench.tick()
    assert bench.levels == near[1]
    bench.frame(near[2])
    assert bench.levels == near[1]  # two have moved them since the tick before
    bench.tick()
    assert bench.levels == near[2]
