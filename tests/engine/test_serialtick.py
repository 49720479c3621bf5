"""The compiled tick by itself, and all that it leaves to Python."""

import os
import select
import signal
import socket
import threading
from contextlib import suppress
from types import SimpleNamespace

import numpy as np
import pytest

from tests.engine.steady import PICTURES, levels_of, sockets, terminal
from vbraille.devices.events import Knob, Notice, Silent, Unplugged
from vbraille.devices.serial.wire import SILENCE_MS, Decoder, Error, Frame, encode
from vbraille.engine.record import Flag
from vbraille.errors import DeviceError

NS_PER_MS = 1_000_000


def test_y_and_the_angle_of_a_compiled_tick_are_the_carriage_s(rigs):
    rig = rigs(height_mm=200.0, turns=True)
    rig.loop.show(PICTURES[0], 0)
    rig.settle()
    compiled = 0  # a machine that stalls leaves some ticks to Python
    for step in range(40):
        rig.y_mm, rig.theta_rad = 5.0 * step, 0.01 * step
        rig.controller.knobs[0] = (step % 2) / 255  # which jitters
        record = rig.step()
        compiled += rig.compiled
        assert record["y_mm"] == pytest.approx(5.0 * step)
        assert record["theta_rad"] == pytest.approx(0.01 * step, abs=1e-4)
    assert compiled > 10
    assert not knobs_of(rig)
    rig.controller.knobs[0] = 0.5
    rig.step()
    assert not rig.compiled
    assert knobs_of(rig) == [Knob(1, 128 / 255)]


def left_after_a_pose(rigs):
    """Record of a tick that Python was left with after compiled code had taken a pose.

    A machine that stops this process for 15 ms has what follows the pose come too late for that
    tick, and one that stops it for 40 ms has the device at rest; another rig is tried then.
    """
    for _ in range(50):
        rig = rigs(None, 50.0, 50.0, height_mm=200.0, turns=True)
        rig.loop.show(PICTURES[0], 0)
        rig.y_mm, rig.theta_rad = 30.0, 0.1
        rig.settle()
        rig.y_mm, rig.theta_rad = 31.0, 0.11
        rig.put(rig.say())
        ended = threading.Event()
        line = threading.Thread(target=follow_with_damage, args=(rig, ended))
        line.start()
        rig.asked.clear()
        rig.loop.run()
        ended.set()
        line.join()
        record = rig.drain()[-1]
        if not rig.compiled and not rig.waiting() and not record["flags"] & Flag.HELD:
            return record
    raise AssertionError("no tick is left to Python")


def follow_with_damage(rig, ended):
    # Until the pose has been taken, long before the tick is due, or the tick went by without it.
    while rig.waiting() and not ended.is_set():
        os.sched_yield()
    rig.put(b"\x02 damaged\0")


def test_a_pose_that_came_before_what_python_is_left_with_keeps_y_and_the_angle(rigs):
    record = left_after_a_pose(rigs)
    assert not record["flags"] & Flag.CHANGED
    assert record["y_mm"] == pytest.approx(31.0)
    assert record["theta_rad"] == pytest.approx(0.11, abs=1e-4)


def knobs_of(rig):
    return [event for event in rig.device.take_events() if isinstance(event, Knob)]


def test_the_ticks_asked_for_are_done_and_no_more(rigs):
    rig = rigs(rate_hz=1000.0)
    rig.settle()
    for _ in range(20):
        before = rig.loop.tally.ticks
        rig.put(rig.say())
        rig.tick()
        rig.hear()
        if rig.compiled:
            break
    assert rig.compiled  # one in which the machine was not stopped
    assert rig.loop.tally.ticks == before + 20
    assert len(levels_of(Decoder().feed(rig.sent))) == 20


def test_words_of_the_mailbox_are_looked_at_before_each_tick(rigs):
    rig = rigs(rate_hz=1000.0)
    rig.settle()
    # A word that is the number of records published changes with the second tick.
    word = rig.loop.ring.published
    before = rig.loop.tally.ticks
    rig.put(rig.say())
    rig.tick(SimpleNamespace(orders=word, obeyed=word.copy()))
    assert rig.compiled
    assert rig.loop.tally.ticks == before + 2
    rig.tick(SimpleNamespace(orders=word, obeyed=word - 1))
    assert not rig.compiled
    assert rig.loop.tally.ticks == before + 3


@pytest.mark.parametrize(("rate_hz", "device_hz"), [(2.0, 1000.0), (50.0, 50.0)])
def test_a_signal_ends_the_wait(rigs, rate_hz, device_hz):
    """For a deadline; and for a STATE, where the device tells as many as there are ticks."""
    rig = rigs(None, rate_hz, device_hz)
    rig.settle()
    if rate_hz == device_hz:
        rig.loop.restart_clock()
    heard = []
    before = signal.signal(signal.SIGALRM, lambda number, _frame: heard.append(number))
    signal.setitimer(signal.ITIMER_REAL, 0.001, 0.001)
    try:
        rig.clock.slept.clear()
        rig.loop.run()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert heard
    assert len(rig.clock.slept) == 1  # the tick was left to Python


def test_bytes_that_are_no_state_go_to_python_and_nothing_is_lost(rig):
    rig.put(rig.say() + encode(Error(200, "warm")))
    rig.way_mm = 30.0
    rig.put(rig.say())
    record = rig.tick()
    assert not rig.compiled
    assert Notice(200, "warm") in rig.device.take_events()
    assert record["x_mm"] == pytest.approx(30.0 - 5.4)
    rig.hear()
    rig.step()
    assert rig.compiled
    assert rig.device.counts()["states missed"] == 0


def test_a_part_of_a_state_is_kept_for_its_rest(rig):
    rig.hear()
    last = rig.step()
    message = rig.say()
    rig.put(message[:9])
    assert rig.tick()["device_ns"] == last["device_ns"]
    assert rig.compiled
    rig.put(message[9:])
    assert rig.tick()["device_ns"] == last["device_ns"] + NS_PER_MS
    assert rig.compiled
    assert rig.device.counts()["states missed"] == 0


def test_a_frame_that_finds_no_room_is_counted(rig):
    with suppress(BlockingIOError):
        while True:
            os.write(rig.ours, bytes(1000))
    unsent = rig.device.counts()["frames not sent"]
    sequence = rig.device.conversation.frames.sequence
    for n in range(1, 6):
        rig.put(rig.again())
        rig.tick()
        assert rig.compiled
        assert rig.device.counts()["frames not sent"] == unsent + n
    rig.receive()
    rig.put(rig.again())
    rig.tick()
    (frame,) = Decoder().feed(rig.receive())
    assert isinstance(frame, Frame)
    assert frame.sequence == sequence + 6  # the device sees that five are missing


def torn(rigs):
    """A rig whose compiled tick could send only a part of its frame.

    On a machine that stalls Python does that tick now and then; another rig is tried then.
    """
    for _ in range(10):
        rig = rigs(terminal())
        rig.loop.show(PICTURES[0], 0)
        rig.settle()
        for _ in range(5000):
            rig.put(rig.again())
            rig.tick()
            if rig.port.bare_descriptor is None:
                break
        if rig.compiled:
            return rig
    raise AssertionError("no compiled tick fills the line")


def test_the_rest_of_a_frame_of_which_a_part_went_out_goes_before_the_next(rigs):
    rig = torn(rigs)
    assert rig.port.bare_descriptor is None
    wire = Decoder()
    messages = wire.feed(rig.receive())
    for _ in range(1000):
        rig.put(rig.again())
        rig.tick()
        messages += wire.feed(rig.receive())
        if rig.compiled:
            break
    assert rig.compiled
    # A terminal carries over in its own time.
    while messages[-1].sequence != rig.device.conversation.frames.sequence:
        assert select.select([rig.theirs], [], [], 1.0)[0]
        messages += wire.feed(rig.receive())
    assert not any(wire.dropped.values())
    assert {type(message) for message in messages} == {Frame}
    np.testing.assert_array_equal(np.diff([message.sequence for message in messages]), 1)


@pytest.mark.parametrize("ends", [sockets, terminal])
def test_a_line_that_is_hung_up_is_gone(rigs, ends):
    rig = rigs(ends())
    rig.settle()
    rig.hang_up()
    before = rig.loop.tally.ticks
    rig.tick()
    assert rig.port.gone
    assert rig.loop.tally.ticks == before + 1
    assert Unplugged() in rig.device.take_events()
    assert rig.device.begin_steady() is None


def test_a_line_that_takes_nothing_more_is_gone(rig):
    """Nothing is wrong with it for the reader."""
    with socket.socket(fileno=os.dup(rig.theirs)) as theirs:
        theirs.shutdown(socket.SHUT_RD)
    before = rig.loop.tally.ticks
    rig.put(rig.say())
    rig.tick()
    assert rig.port.gone
    assert rig.loop.tally.ticks == before + 1
    assert rig.device.begin_steady() is None


@pytest.mark.parametrize("mm_per_count", [float("nan"), float("inf"), 1e6])
def test_a_place_where_none_can_be_is_a_fault(rig, mm_per_count):
    ticks = rig.loop.tally.ticks
    rig.device.conversation.place.x.mm_per_count = mm_per_count
    rig.put(rig.say())
    with pytest.raises(DeviceError, match="where it cannot be"):
        rig.tick()
    assert rig.compiled
    assert rig.loop.tally.ticks == ticks


def test_silence_ends_it_where_nothing_comes_at_all(rig):
    rig.device.conversation.states.heard_ns -= SILENCE_MS * NS_PER_MS
    rig.tick()
    assert not rig.compiled
    assert [type(event) for event in rig.device.take_events()] == [Silent]
