"""The compiled tick beside the one in Python, and all that it leaves to Python."""

import os
import random
import select
import signal
import socket
import threading
import time
from contextlib import suppress
from types import SimpleNamespace

import numpy as np
import pytest

from tests.engine.lendable import (
    PICTURES,
    TOP,
    Twin,
    assert_same_tick,
    known,
    levels_of,
    sockets,
    terminal,
)
from tests.tiers import by_tier
from vbraille.devices.events import Knob, Notice, Silent, Unplugged
from vbraille.devices.serial.conversation import IDLE_MS
from vbraille.devices.wire.codec import Decoder, encode
from vbraille.devices.wire.messages import SILENCE_MS, STALL_MS, Error, Frame, Watchdog
from vbraille.engine.record import Flag
from vbraille.errors import DeviceError
from vbraille.sessions.record.replay import Replay

NS_PER_MS = 1_000_000
PATIENCE_S = 60.0


class Wrong:
    """What goes wrong on the way to the host and from it, at random; and what a reader does."""

    def __init__(self, rig, twin, seed):
        self._rig, self._twin = rig, twin
        self._chance = random.Random(seed)
        self.late = b""  # comes with the next tick
        self.deaf = 0  # ticks in which the controller hears nothing

    def next(self):
        """The bytes that come before the next tick."""
        chance, message, late = self._chance, self._rig.say(), self.late
        self.late = b""
        if chance.random() < 0.6:
            return late + message
        kind = chance.choice(
            (
                *(self.garbled, self.split, self.doubled, self.dropped, self.delayed),
                *(self.other, self.button, self.knob, self.deafness, self.warp, self.reader),
            )
        )
        return late + kind(message)

    def garbled(self, message):
        if not message:
            return b""
        at = self._chance.randrange(len(message))
        return message[:at] + bytes((message[at] ^ 0x10,)) + message[at + 1 :]

    def split(self, message):
        cut = self._chance.randrange(len(message) + 1)
        self.late = message[cut:]
        return message[:cut]

    def doubled(self, message):
        return message * 2

    def dropped(self, _message):
        return b""

    def delayed(self, message):
        self.late = message
        return b""

    def other(self, message):
        trips = self._rig.controller.trips
        said = Error(200, "warm"), Watchdog(trips, 0), Watchdog(trips + 1, 0)
        return encode(self._chance.choice(said)) + message

    def button(self, message):
        self._rig.controller.buttons ^= 1 << self._chance.randrange(8)
        return message

    def knob(self, message):
        """Have a knob turned, or jitter."""
        knobs = self._rig.controller.knobs
        if knobs:
            which = self._chance.randrange(len(knobs))
            step = self._chance.choice((1, 2, 3, 40)) / 255
            knobs[which] = knobs[which] + step if knobs[which] + step <= 1 else 0.0
        return message

    def deafness(self, message):
        self.deaf = self._chance.choice((1, 5, 70))
        return message

    def warp(self, message):
        """Have something been so long ago that the conversation must mind it."""
        which = self._chance.randrange(3)
        for device in (self._rig.device, self._twin.device):
            talk = device.conversation
            if which == 0:
                talk.states.heard_ns -= SILENCE_MS * NS_PER_MS
                if talk.time.host_ns is not None:  # when the last STATE came, too
                    talk.time.host_ns -= SILENCE_MS * NS_PER_MS
            elif which == 1:
                talk.frames.felt_ns -= IDLE_MS * NS_PER_MS
            elif talk.delivery.sent_ns is not None:
                talk.delivery.sent_ns -= STALL_MS * NS_PER_MS
        return self._chance.choice((message, b""))

    def reader(self, message):
        rig, twin = self._rig, self._twin
        rig.clock.at_ns = twin.clock.at_ns  # what is wanted, is wanted at one time
        line = self._chance.randrange(len(PICTURES))
        pause = self._chance.random() < 0.3
        for loop in (rig.loop, twin.loop):
            loop.show(PICTURES[line], line)
            loop.paused = pause
        rig.clock.at_ns = None
        return message


DEVICES = (
    {"height_mm": 200.0, "turns": True},
    {"version": 1},
    {"version": 2},
)


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


def test_a_pose_that_came_before_what_python_is_left_with_keeps_y_and_the_angle(rigs):
    rig = rigs(None, 50.0, 50.0, height_mm=200.0, turns=True)
    rig.loop.show(PICTURES[0], 0)
    rig.y_mm, rig.theta_rad = 30.0, 0.1
    rig.settle()
    rig.y_mm, rig.theta_rad = 31.0, 0.11
    rig.put(rig.say())

    def follow_it():
        while rig.waiting():  # until that has been taken, long before the tick is due
            os.sched_yield()
        rig.put(b"\x02 damaged\0")

    line = threading.Thread(target=follow_it)
    line.start()
    rig.asked.clear()
    rig.loop.run()
    line.join()
    record = rig.drain()[-1]
    assert not record["flags"] & Flag.CHANGED
    assert record["y_mm"] == pytest.approx(31.0)
    assert record["theta_rad"] == pytest.approx(0.11, abs=1e-4)
    assert not rig.compiled


def knobs_of(rig):
    return [event for event in rig.device.take_events() if isinstance(event, Knob)]


@pytest.mark.parametrize("seed", range(by_tier(3, 8, 80)))
def test_over_traffic_with_faults_it_comes_to_what_python_alone_comes_to(rigs, seed):
    print(f"seed {seed}")
    rig = rigs(**DEVICES[seed % len(DEVICES)])
    twin = Twin(rig)
    wrong = Wrong(rig, twin, seed)
    for loop in (rig.loop, twin.loop):
        loop.show(PICTURES[0], 0)
    compiled = left = 0
    for tick in range(600):
        rig.way_mm = 60.0 + 40.0 * np.sin(tick / 100)
        rig.y_mm, rig.theta_rad = 50.0 + 40.0 * np.sin(tick / 70), 0.3 * np.sin(tick / 90)
        chunk = wrong.next()
        rig.put(chunk)
        record = rig.tick()
        compiled += rig.compiled
        left += not rig.compiled
        assert_same_tick(record, twin.tick(int(record["time_ns"]), list(rig.asked), chunk))
        heard = rig.receive()
        assert heard == twin.sent
        assert known(rig.device) == known(twin.device)
        rig.asked.clear()
        events = rig.device.take_events()
        twin.times.extend(rig.asked)
        assert events == twin.device.take_events()
        wrong.deaf = max(wrong.deaf - 1, 0)
        if not wrong.deaf:
            wrong.late += rig.controller.receive(heard, rig.us)
    assert compiled > 100
    assert left > 50


def test_what_goes_out_is_what_is_recorded_and_what_a_replay_makes(rig):
    """For a compiled tick and for one of Python's."""
    rig.hear()
    messages, sent = Decoder(), {}
    pauses = 0
    # A machine that stalls has frames held back: then it goes on till enough have been sent.
    for tick in range(4000):
        if tick % 400 == 0 and tick and len(sent) > 300 and pauses > 20:
            break
        rig.way_mm = 60.0 + 40.0 * np.sin(tick / 60)
        if tick % 80 == 79:
            rig.loop.show(PICTURES[tick // 80 % 4], tick // 80 % 4)
        if tick % 400 in (200, 230):
            rig.loop.paused = tick % 400 == 200
        record = rig.step()
        pauses += rig.compiled and bool(record["flags"] & Flag.PAUSED)
        frames = levels_of(messages.feed(rig.sent))
        if not record["flags"] & Flag.HELD:  # as a host is that was stopped
            (sent[int(record["tick"])],) = frames
    assert pauses > 20
    records = np.concatenate(rig.records)
    np.testing.assert_array_equal(records["tick"], np.arange(records.size))
    display = rig.device.display
    frames = Replay(dict(enumerate(PICTURES)).__getitem__, display).frames(records)
    levels = np.rint(frames * TOP).reshape(records.size, -1)
    assert levels.max() > 0.9 * TOP
    assert len(sent) > 300
    for tick, shown in sent.items():
        np.testing.assert_array_equal(records["frame"][tick], frames[tick].astype(np.float32))
        np.testing.assert_array_equal(shown, levels[tick])


@pytest.mark.no_cover
def test_beside_a_controller_of_its_own_pace_frames_are_those_of_the_records(rigs):
    """Over a pseudo-terminal, where a STATE has each tick begin."""
    rig = rigs(terminal(), rate_hz=1000.0)
    rig.loop.show(PICTURES[0], 0)
    rig.settle()
    messages, ended = Decoder(), threading.Event()
    messages.feed(rig.sent)
    sent = []  # FRAMEs

    def hear():
        chunk = rig.receive()
        sent.extend(said for said in messages.feed(chunk) if isinstance(said, Frame))
        return chunk

    def say(chunk):
        with suppress(BlockingIOError):  # a line that nobody reads for long loses what is said
            os.write(rig.theirs, chunk)

    def answer():
        while not ended.is_set():
            rig.way_mm = 60.0 + 40.0 * np.sin(rig.us / 60_000)
            say(rig.say())
            if select.select([rig.theirs], [], [], 0.001)[0]:
                say(rig.controller.receive(hear(), rig.us))

    def unsent():
        return rig.device.counts()["frames not sent"]

    controller = threading.Thread(target=answer)
    began, count = rig.loop.tally.ticks, 0
    end_s = time.monotonic() + PATIENCE_S
    controller.start()
    try:
        # On a machine that stalls too few ticks may have kept pace, or the line may be full.
        while count <= 50 or rig.port.bare_descriptor is None:
            assert time.monotonic() < end_s, "too few ticks have kept pace"
            before, till = unsent(), rig.loop.tally.ticks + 400
            while rig.loop.tally.ticks < till:
                rig.asked.clear()
                rig.loop.run()
            rig.drain()
            records = np.concatenate(rig.records)
            if unsent() > before:
                began = records.size
            held = np.flatnonzero(records["flags"] & Flag.HELD)
            count = records.size - max(held[-1] + 1, began)  # since the host was last stopped
            if not np.ptp(records["x_mm"][-count:]) > 0:  # the controller was stopped all the while
                count = 0
    finally:
        ended.set()
        controller.join()
    # A terminal carries over in its own time.
    while sent[-1].sequence != rig.device.conversation.frames.sequence:
        assert select.select([rig.theirs], [], [], 1.0)[0]
        hear()
    frames = Replay(dict(enumerate(PICTURES)).__getitem__, rig.device.display).frames(records)
    levels = np.rint(frames * TOP).reshape(records.size, -1)
    np.testing.assert_array_equal(levels_of(sent[-count:]), levels[-count:])


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
    assert frame.sequence == sequence + 1


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
    assert rig.device.lend() is None


def test_a_line_that_takes_nothing_more_is_gone(rig):
    """Nothing is wrong with it to whoever reads."""
    with socket.socket(fileno=os.dup(rig.theirs)) as theirs:
        theirs.shutdown(socket.SHUT_RD)
    before = rig.loop.tally.ticks
    rig.put(rig.say())
    rig.tick()
    assert rig.port.gone
    assert rig.loop.tally.ticks == before + 1
    assert rig.device.lend() is None


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
