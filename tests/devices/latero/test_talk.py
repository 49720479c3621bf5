"""The talk with a Latero, in memory: what is shown, what is dropped, and what silence leads to."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.devices.latero.bench import FELT, MS, OFFSETS, Bench
from tests.devices.latero.network import LateroFaults
from tests.tiers import by_tier
from vbraille.devices.events import (
    Back,
    Button,
    Notice,
    Placed,
    Placing,
    Silent,
    Unplugged,
    WatchdogTripped,
)
from vbraille.devices.latero.device import ENCODERS, NO_SWITCH, POWER_OFF, Requests

SHOWN = np.rint(150 * (1 - FELT)).astype(np.uint8).ravel()


def test_frames_are_shown_once_the_latero_has_answered_at_rest():
    bench = Bench()
    assert (np.array(bench.levels) == 150).all()
    assert bench.device.taking
    assert bench.device.rested == 1
    bench.run(2)
    assert (bench.board.levels == SHOWN).all()
    assert bench.board.beyond == bench.board.foreign == 0
    assert bench.of(Notice) == []


def test_a_place_is_that_of_the_last_tick_with_its_angle():
    bench = Bench()
    begun_ns = bench.now_ns
    bench.run(100)
    for tick, pose in enumerate(bench.poses[10:], start=10):
        assert pose.time_ns == begun_ns + tick * MS
        assert pose.x_mm == pytest.approx(bench.x_mm(pose.time_ns) - 4.2, abs=0.08)
        assert pose.y_mm == pytest.approx(100, abs=0.08)
        assert pose.theta_rad == pytest.approx(0.1, abs=3e-4)


def test_lost_late_doubled_and_foreign_datagrams():
    """No frame of an old place, no stall, all counted."""
    faults = LateroFaults(drop=0.01, late=0.01, double=0.01, foreign=0.01, late_s=0.007, seed=3)
    ticks = by_tier(2_000, 60_000, 600_000)
    bench = Bench(faults, speed_mm_s=200)
    begun_ns = bench.now_ns
    bench.run(ticks)
    device, tally = bench.device, bench.network.tally
    poses = [(n, pose) for n, pose in enumerate(bench.poses, start=1) if pose is not None]
    assert max(begun_ns + n * MS - pose.time_ns for n, pose in poses) <= 5 * MS
    assert max(abs(pose.x_mm + 4.2 - bench.x_mm(pose.time_ns)) for _, pose in poses) <= 0.08
    assert len(poses) > 0.95 * ticks
    assert np.diff([n for n, _ in poses]).max() <= 8
    assert device.taking
    assert device.rested == 1
    counts = device.counts()
    assert min(tally.requests_lost, tally.answers_lost, tally.answers_late, tally.foreign) > 5
    assert counts["foreign datagrams"] == tally.foreign
    lost = tally.requests_lost + tally.answers_lost
    assert abs(counts["requests not answered"] - lost) <= 0.1 * lost + 5
    came_again = tally.answers_late + tally.answers_doubled + tally.requests_doubled
    assert abs(counts["late or doubled answers"] - came_again) <= 0.1 * came_again + 5
    assert bench.of(Silent) == bench.of(WatchdogTripped) == []


def test_numbers_wrap_and_nothing_grows():
    requests = Requests()
    for n in range(200_000):
        requests.sent(n * MS)
        if n % 2:
            assert requests.answered((requests.next - 1) & 0xFFFF, n * MS) == n * MS
    assert len(requests._open) < 300
    assert requests.late == requests.unasked == 0
    assert abs(requests.lost - 100_000) < 300


def test_silence_brings_the_blades_to_rest_and_then_all_comes_back():
    bench = Bench().run(50)
    bench.cut = True
    bench.run(150)
    assert bench.of(Silent) == [Silent()]
    assert not bench.device.taking
    bench.cut = False
    bench.run(6)
    assert (bench.board.levels == 150).all()
    bench.run(60)
    assert len(bench.of(Back)) == 1
    assert bench.device.taking
    assert bench.device.rested == 2
    assert (bench.board.levels == SHOWN).all()
    assert bench.of(Notice) == []


def test_a_client_that_hears_nothing_takes_the_blades_to_rest_that_it_may_still_reach():
    bench = Bench().run(50)
    bench.spoil = lambda _: b""
    begun = len(bench.levels)
    bench.run(150)
    assert (bench.board.levels == 150).all()
    assert not bench.board.powered
    steps = bench.steps[begun:]
    assert steps.min() >= 0
    assert steps.max() <= 9
    bench.spoil = lambda datagram: datagram
    bench.run(1100)
    assert bench.board.powered
    assert bench.device.rested == 2
    assert (bench.board.levels == SHOWN).all()


def test_rest_is_a_ramp_and_frames_after_it_come_from_rest():
    bench = Bench().run(50)
    begun = len(bench.levels)
    bench.device.rest()
    assert not bench.device.taking
    bench.run(20)
    assert bench.steps[begun:].max() <= 9
    bench.run(30)
    assert bench.device.taking
    assert bench.device.rested == 2


@pytest.mark.parametrize("drop", [0.0, 0.5])
def test_a_client_takes_leave_with_rest_and_power_off(drop):
    bench = Bench(LateroFaults(drop=drop)).run(100)
    begun, begun_ns = len(bench.levels), bench.now_ns
    bench.device.close()
    assert (bench.board.levels == 150).all()
    assert not bench.board.powered
    if not drop:
        assert bench.steps[begun:].max() <= 16
        assert bench.now_ns - begun_ns < 60 * MS


def test_power_that_is_off_at_the_start_is_switched_on():
    bench = Bench(powered=False).run(40)
    assert bench.board.powered
    assert bench.device.taking
    assert not bench.of(Notice)


def test_power_that_is_switched_off_elsewhere_is_left_off():
    bench = Bench().run(50)
    bench.board.powered = False
    bench.run(300)
    assert not bench.board.powered
    assert not bench.device.taking
    assert (bench.board.levels == 150).all()
    assert [notice.code for notice in bench.of(Notice)] == [POWER_OFF]
    bench.board.powered = True
    bench.run(10)
    assert bench.device.taking
    assert bench.device.rested == 2


def test_a_register_that_is_not_the_status_word_is_never_written():
    bench = Bench(register=None).run(60)
    assert bench.device.power is None
    assert [notice.text for notice in bench.of(Notice)] == [NO_SWITCH]
    assert bench.device.taking
    raws = bench.board.raws
    bench.device.close()
    assert (bench.board.levels == 150).all()
    assert bench.board.raws == raws


@pytest.mark.parametrize("stopped_ms", [45, 60, 900])
def test_a_client_that_was_stopped_goes_on_from_rest(stopped_ms):
    bench = Bench().run(50)
    begun = len(bench.levels)
    for _ in range(stopped_ms):
        bench.pause(0.001)
    bench.run(60)
    steps = bench.steps[begun - 1 :]
    at_rest = next(n for n, levels in enumerate(bench.levels[begun:]) if (levels == 150).all())
    assert 0 <= steps[: at_rest + 1].min() <= steps[: at_rest + 1].max() <= 16
    tripped = stopped_ms > 50
    assert bench.of(WatchdogTripped) == [WatchdogTripped(1)] * tripped
    assert bench.device.watchdog_trips == tripped
    if tripped:
        assert 49 <= bench.device.tripped_ms <= 61
    assert bench.device.taking
    assert bench.device.rested == 2
    assert bench.of(Silent) == []


def test_what_is_felt_is_not_held_by_reading_alone():
    bench = Bench().run(50)
    bench.frame = None
    begun = bench.board.fulls
    bench.run(30)
    assert bench.board.fulls == begun  # so that the watchdog hears no beat
    assert (bench.board.levels == SHOWN).all()
    bench.run(60)
    assert (bench.board.levels == 150).all()


def test_a_client_without_frames_asks_where_the_array_is():
    bench = Bench()
    bench.frame = None
    bench.run(100)
    assert sum(pose is not None for pose in bench.poses) >= 15
    bench.now_ns += 400 * MS  # and that it did not ask is no silence
    bench.run(50)
    assert bench.events == []
    assert bench.device.taking
    assert (np.array(bench.levels) == 150).all()


def test_a_client_asks_ahead_by_the_frame_that_is_shown():
    bench = Bench().run(50)
    fulls = bench.board.fulls
    bench.device.ask()
    assert bench.board.fulls == fulls + 1
    assert (bench.board.levels == SHOWN).all()


def test_blades_wait_for_an_answer_after_two_frames_and_then_catch_up():
    bench = Bench()
    bench.frame = np.zeros((8, 8))
    bench.run(20)
    begun, spoil = len(bench.levels), bench.spoil
    bench.spoil = lambda _: b""
    for n in range(1, 11):
        bench.frame = np.full((8, 8), n / 30)
        bench.run(1)
    lows = [int(levels.min()) for levels in bench.levels[begun:]]
    assert lows[-1] >= 150 - 150 * 5 / 30
    bench.spoil = spoil
    bench.run(8)
    assert bench.board.levels.min() == 100
    assert np.abs(bench.steps[begun:]).max() <= 3 * 50 / 10 + 1


@given(st.lists(st.floats(0, 1), min_size=64, max_size=64))
def test_levels_are_those_of_the_source(deflections):
    bench = Bench()
    bench.frame = np.array(deflections).reshape(8, 8)
    bench.run(3)
    assert np.abs(bench.board.levels.reshape(8, 8) - 150 * (1 - bench.frame)).max() <= 0.5 + 1e-9


def test_the_buttons():
    bench = Bench().run(50)
    bench.board.buttons = 0b10
    bench.run(4)
    assert bench.of(Button) == []
    bench.run(5)
    bench.board.buttons = 0b01
    bench.run(10)
    bench.board.buttons = 0b00
    bench.run(2)
    bench.board.buttons = 0b01  # it bounces
    bench.run(20)
    pressed = [(event.number, event.pressed) for event in bench.of(Button)]
    assert sorted(pressed) == [(1, True), (2, False), (2, True)]
    bench.cut = True
    bench.run(150)
    assert (bench.of(Button)[-1].number, bench.of(Button)[-1].pressed) == (1, False)


def test_an_interface_that_is_unplugged_and_back_is_shown_its_place_again():
    bench = Bench().run(50)
    bench.board.interface = False
    bench.run(60)
    assert len(bench.of(Unplugged)) == 1
    assert bench.poses[-1] is None
    assert (bench.board.levels == 150).all()
    bench.board.interface = True
    bench.run(60)
    assert len(bench.of(Back)) == 1
    assert bench.device.taking
    assert bench.device.placing is Placing.STOP
    assert bench.poses[-1] is None
    bench.device.set_zero()
    bench.run(2)
    assert bench.poses[-1] is not None
    assert bench.of(Placed) == [Placed(Placing.STOP), Placed(Placing.DONE)]


def test_the_reader_is_told_what_the_left_stop_is():
    bench = Bench(offsets=None).run(50)
    assert ["lower left" in notice.text for notice in bench.of(Notice)] == [True]
    assert bench.poses[-1] is None
    bench.device.set_zero()
    assert str(OFFSETS[0]) not in bench.device.particulars.protocol  # the array was elsewhere
    bench.run(2)
    assert bench.poses[-1].y_mm == pytest.approx(217.5, abs=0.1)


def test_arms_that_cannot_be_there_are_to_be_shown_their_place_again():
    bench = Bench(offsets=(20_000, 20_000, 20_000)).run(5)
    assert bench.device.placing is Placing.STOP
    assert bench.poses[-1] is None


def test_lost_steps_are_told_once():
    bench = Bench().run(50)
    bench.board.encoder_errors = 0b010
    bench.run(50)
    assert [notice.code for notice in bench.of(Notice)] == [ENCODERS]
