"""The talk with a Latero, in memory: what is shown, what is dropped, and what silence leads to."""

import numpy as np
import pytest

from tests.devices.latero.network import LateroFaults
from tests.devices.latero.talking import FELT, MS, OFFSETS, Talk
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
from vbraille.devices.latero.conversation import (
    ENCODERS,
    KEPT,
    NO_SWITCH,
    OTHER_VERSION,
    POWER,
    LateroStage,
)

SHOWN = np.rint(150 * (1 - FELT)).astype(np.uint8).ravel()


def test_frames_are_shown_once_the_latero_has_answered_at_rest():
    talk = Talk().run(5)
    conversation = talk.conversation
    assert (talk.levels[0] == 150).all()
    assert conversation.stage is LateroStage.LIVE
    assert conversation.taking
    assert conversation.rested == 1
    talk.run(1)
    assert (talk.board.levels == SHOWN).all()
    assert talk.board.beyond == talk.board.foreign == 0
    assert talk.conversation.acknowledged_ns is None
    assert talk.of(Notice) == []


def test_a_place_is_that_of_the_last_tick_with_its_angle():
    talk = Talk(half_span_mm=4.2).run(100)
    for tick, pose in enumerate(talk.poses[10:], start=10):
        sent_ns = tick * MS
        assert pose.time_ns == sent_ns
        assert pose.x_mm == pytest.approx(talk.x_mm(sent_ns) - 4.2, abs=0.08)
        assert pose.y_mm == pytest.approx(100, abs=0.08)
        assert pose.theta_rad == pytest.approx(0.1, abs=3e-4)


def test_lost_late_doubled_and_foreign_datagrams():
    """No frame of an old place, no stall, all counted."""
    faults = LateroFaults(drop=0.01, late=0.01, double=0.01, foreign=0.01, late_s=0.007, seed=3)
    ticks = by_tier(2_000, 60_000, 600_000)
    talk = Talk(faults, speed_mm_s=200).run(ticks)
    conversation, tally = talk.conversation, talk.network.tally
    numbering = conversation.numbering
    ages = [
        tick * MS + MS - pose.time_ns for tick, pose in enumerate(talk.poses) if pose is not None
    ]
    assert max(ages) <= 5 * MS
    places = [abs(pose.x_mm - talk.x_mm(pose.time_ns)) for pose in talk.poses if pose is not None]
    assert max(places) <= 0.08
    assert conversation.stage is LateroStage.LIVE
    assert conversation.rested == 1
    assert len(ages) > 0.95 * ticks
    gaps = np.diff(np.flatnonzero([pose is not None for pose in talk.poses]))
    assert gaps.max() <= 8
    assert min(tally.requests_lost, tally.answers_lost, tally.answers_late, tally.foreign) > 5
    came = talk.answers  # ages of the answers to each request, the first that came first
    long_ago = len(came) - KEPT  # answers to the last few may still come
    assert numbering.lost == sum(not ages for ages in came[:long_ago])
    assert numbering.doubled == sum(len(ages) - 1 for ages in came if ages)
    assert numbering.late == sum(ages[0] > 5 * MS for ages in came if ages)
    assert conversation.foreign + numbering.unasked == tally.foreign
    assert conversation.other_version > 0
    assert talk.of(Silent) == talk.of(WatchdogTripped) == []


def test_a_late_answer_is_dropped_and_a_lost_one_not_waited_for():
    talk = Talk(LateroFaults(late=0.5, late_s=0.003)).run(500)
    times = [pose.time_ns for pose in talk.poses if pose is not None]
    assert times == sorted(times)
    assert talk.conversation.numbering.late > 100
    assert talk.board.fulls >= 500  # a request in each tick, whatever became of the last


def test_silence_brings_the_blades_to_rest_and_then_all_comes_back():
    talk = Talk().run(50)
    talk.cut = True
    talk.run(150)
    conversation = talk.conversation
    assert conversation.stage is LateroStage.SILENT
    assert talk.of(Silent) == [Silent()]
    assert conversation.blades.rests
    talk.cut = False
    talk.run(1)
    assert (talk.board.levels == 150).all()
    talk.run(60)
    assert len(talk.of(Back)) == 1
    assert conversation.stage is LateroStage.LIVE
    assert conversation.rested == 2
    assert (talk.board.levels == SHOWN).all()
    assert talk.of(Notice) == []


def test_a_client_that_hears_nothing_ramps_the_blades_it_may_still_reach():
    talk = Talk().run(50)
    hear, talk.hear = talk.hear, lambda _answer: None
    begun = len(talk.levels)
    talk.run(150)
    assert (talk.board.levels == 150).all()
    assert not talk.board.powered
    steps = talk.steps[begun:]
    assert steps.min() >= 0
    assert steps.max() <= 9
    talk.hear = hear
    talk.run(60)
    assert talk.board.powered
    assert talk.conversation.rested == 2
    assert (talk.board.levels == SHOWN).all()


def test_rest_is_a_ramp_and_frames_after_it_come_from_rest():
    talk = Talk().run(50)
    begun = len(talk.levels)
    talk.conversation.rest(talk.now_ns)
    assert not talk.conversation.taking
    talk.run(22)
    assert talk.steps[begun:].max() <= 9
    assert (talk.levels[-1] == 150).all() or talk.conversation.taking
    talk.run(5)
    assert talk.conversation.taking
    assert talk.conversation.rested == 2


def test_a_client_takes_leave_with_rest_and_power_off():
    talk = Talk().run(50)
    begun = len(talk.levels)
    talk.frame = None
    talk.conversation.leave(talk.now_ns)
    for _ in range(100):
        talk.run(1)
        if talk.conversation.left:
            break
    assert talk.conversation.left
    assert (talk.board.levels == 150).all()
    assert not talk.board.powered
    assert talk.steps[begun:].max() <= 16  # two steps of 1 ms, since it is asked every 2 ms


def test_a_client_takes_leave_of_a_network_that_loses_half_of_all():
    talk = Talk(LateroFaults(drop=0.5)).run(100)
    talk.frame = None
    talk.conversation.leave(talk.now_ns)
    while not talk.conversation.left:
        talk.run(1)
        assert talk.now_ns < 2000 * MS
    assert (talk.board.levels == 150).all()
    assert not talk.board.powered


def test_power_that_is_off_at_the_start_is_switched_on():
    talk = Talk()
    talk.board.powered = False
    talk.run(40)
    assert talk.board.powered
    assert talk.conversation.stage is LateroStage.LIVE


def test_power_that_is_not_switched_on_yet_is_not_told_after_a_time_without_ticks():
    talk = Talk()
    talk.board.powered = False
    while talk.conversation.stage is not LateroStage.POWERING:
        talk.run(1)
    talk.now_ns += 1000 * MS  # the host begins
    talk.run(40)
    assert talk.conversation.stage is LateroStage.LIVE
    assert not talk.of(Notice)


def test_power_that_somebody_else_switches_off_is_left_off():
    talk = Talk().run(50)
    talk.board.powered = False
    talk.run(300)
    assert not talk.board.powered
    assert not talk.conversation.taking
    assert (talk.board.levels == 150).all()
    assert [notice.code for notice in talk.of(Notice)] == [POWER]
    talk.board.powered = True
    talk.run(10)
    assert talk.conversation.taking
    assert talk.conversation.rested == 2


def test_a_register_that_is_not_the_status_word_is_never_written():
    talk = Talk(register=None).run(60)
    assert talk.conversation.power is None
    assert [notice.text for notice in talk.of(Notice)] == [NO_SWITCH]
    assert talk.conversation.stage is LateroStage.LIVE
    raws = talk.board.raws
    talk.frame = None
    talk.conversation.leave(talk.now_ns)
    talk.run(40)
    assert talk.conversation.left
    assert talk.board.raws == raws


def test_a_stall_goes_to_rest_from_where_the_watchdog_left_the_blades():
    talk = Talk().run(50)
    talk.now_ns += 60 * MS
    halfway = np.full(64, 100, np.uint8)
    talk.board.levels[:] = halfway
    talk.board.powered = False
    begun = len(talk.levels)
    talk.conversation.stall(bytes(halfway), 1, talk.now_ns)
    assert not talk.conversation.taking
    talk.run(40)
    ramp = np.array(talk.levels[begun : begun + 8]).astype(int)
    assert ramp[0].min() >= 100
    assert np.diff(ramp, axis=0).max() <= 9
    assert talk.of(WatchdogTripped) == [WatchdogTripped(1)]
    assert talk.board.powered
    assert talk.conversation.taking
    assert talk.conversation.rested == 2


def test_what_is_felt_is_not_held_by_reading_alone():
    talk = Talk().run(50)
    talk.frame = None
    begun = talk.board.fulls
    talk.run(30)
    assert talk.board.fulls == begun  # so that the watchdog hears no beat
    assert (talk.board.levels == SHOWN).all()


def test_a_client_without_frames_asks_where_the_array_is():
    talk = Talk()
    talk.frame = None
    talk.run(100)
    assert talk.conversation.stage is LateroStage.LIVE
    assert sum(pose is not None for pose in talk.poses) >= 15
    assert (np.array(talk.levels) == 150).all()


def test_a_client_that_did_not_ask_takes_nobody_for_silent():
    talk = Talk()
    talk.frame = None
    talk.run(50)
    talk.now_ns += 400 * MS
    talk.run(50)
    assert talk.events == []
    assert talk.conversation.stage is LateroStage.LIVE


def test_a_client_asks_ahead_by_the_frame_that_is_shown():
    talk = Talk().run(50)
    fulls = talk.board.fulls
    talk.conversation.ask(talk.now_ns + MS // 2)
    talk.exchange()
    assert talk.board.fulls == fulls + 1
    assert (talk.board.levels == SHOWN).all()


def test_the_buttons():
    talk = Talk().run(50)
    talk.board.buttons = 0b10
    talk.run(4)
    assert talk.of(Button) == []
    talk.run(5)
    talk.board.buttons = 0b01
    talk.run(10)
    talk.board.buttons = 0b00
    talk.run(2)
    talk.board.buttons = 0b01  # it bounces
    talk.run(20)
    pressed = [(event.number, event.pressed) for event in talk.of(Button)]
    assert pressed == [(2, True), (1, True), (2, False)]
    talk.cut = True
    talk.run(150)
    assert (talk.of(Button)[-1].number, talk.of(Button)[-1].pressed) == (1, False)


def test_an_interface_that_is_unplugged_and_back_is_shown_its_place_again():
    talk = Talk().run(50)
    talk.board.interface = False
    talk.run(60)
    assert len(talk.of(Unplugged)) == 1
    assert talk.poses[-1] is None
    assert (talk.board.levels == 150).all()
    talk.board.interface = True
    talk.run(60)
    assert len(talk.of(Back)) == 1
    assert talk.conversation.stage is LateroStage.LIVE
    assert talk.conversation.place.placing is Placing.STOP
    assert talk.poses[-1] is None
    talk.conversation.set_zero(talk.now_ns)
    talk.run(2)
    assert talk.poses[-1] is not None
    assert talk.of(Placed) == [Placed(Placing.STOP), Placed(Placing.DONE)]


def test_the_reader_is_told_what_the_left_stop_is():
    talk = Talk(offsets=None).run(50)
    assert ["lower left" in notice.text for notice in talk.of(Notice)] == [True]
    assert talk.poses[-1] is None
    talk.conversation.set_zero(talk.now_ns)
    assert talk.conversation.place.offsets != OFFSETS  # the array was elsewhere
    talk.run(2)
    assert talk.poses[-1].y_mm == pytest.approx(217.5, abs=0.1)


def test_lost_steps_are_told_once():
    talk = Talk().run(50)
    talk.board.encoder_errors = 0b010
    talk.run(50)
    assert [notice.code for notice in talk.of(Notice)] == [ENCODERS]


def test_another_version_in_place_of_the_latero_is_said():
    talk = Talk().run(50)
    hear = talk.hear
    talk.hear = lambda answer: hear(answer[:1] + b"\x21" + answer[2:])
    talk.run(300)
    assert [notice.text for notice in talk.of(Notice)] == [OTHER_VERSION]
    talk.hear = hear
    talk.run(50)
    assert talk.conversation.stage is LateroStage.LIVE
