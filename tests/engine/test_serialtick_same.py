"""A compiled tick comes to what Python comes to, and to what is recorded and replayed."""

import os
import random
import select
import threading
import time
from contextlib import suppress

import numpy as np
import pytest

from tests.engine.steady import (
    PICTURES,
    TOP,
    Twin,
    assert_same_tick,
    known,
    levels_of,
    terminal,
)
from tests.tiers import by_tier
from vbraille.devices.serial.conversation import IDLE_MS
from vbraille.devices.serial.wire import (
    SILENCE_MS,
    STALL_MS,
    Decoder,
    Error,
    Frame,
    Watchdog,
    encode,
)
from vbraille.engine.record import Flag
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
    {},
)


@pytest.mark.parametrize("seed", range(by_tier(3, 8, 80)))
def test_over_traffic_with_faults_it_comes_to_what_python_alone_comes_to(rigs, seed):
    print(f"seed {seed}")
    rig = rigs(**DEVICES[seed % len(DEVICES)])
    twin = Twin(rig)
    wrong = Wrong(rig, twin, seed)
    for loop in (rig.loop, twin.loop):
        loop.show(PICTURES[0], 0)
    compiled = left = 0
    # On a machine that stalls more ticks are left to Python: then it goes on.
    for tick in range(6000):
        if tick >= 600 and compiled > 100:
            break
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


@pytest.mark.real_time
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
        with suppress(BlockingIOError):  # a line that is not read for long loses what is said
            os.write(rig.theirs, chunk)

    def answer():
        while not ended.is_set():
            rig.way_mm = 60.0 + 40.0 * np.sin(rig.us / 60_000)
            say(rig.say())
            if select.select([rig.theirs], [], [], 0.001)[0]:
                say(rig.controller.receive(hear(), rig.us))

    def kept():
        """Ticks of runs in which each sent one FRAME that was heard; each with its FRAME."""
        heard = {said.sequence: said for said in [*sent]}
        pairs = [
            (first + n, heard[sequence + n & 0xFFFF])
            for first, sequence, ticks, frames in runs
            if frames == ticks
            for n in range(ticks)
            if sequence + n & 0xFFFF in heard
        ]
        return [pair for pair in pairs if not records["flags"][pair[0]] & Flag.HELD]

    controller = threading.Thread(target=answer)
    frames = rig.device.conversation.frames
    records = np.concatenate(rig.records)
    runs = []  # first tick and first sequence, and how many of each there were
    ticks = []
    end_s = time.monotonic() + PATIENCE_S
    controller.start()
    try:
        # On a machine that stalls too few ticks may have kept pace, or the line may be full.
        while len(ticks) <= 50 or not np.ptp(records["x_mm"][ticks]) > 0:
            assert time.monotonic() < end_s, "too few ticks have kept pace"
            till = rig.loop.tally.ticks + 400
            while (first := rig.loop.tally.ticks) < till:
                rig.asked.clear()
                before = frames.sequence
                rig.loop.run()
                gone = frames.sequence - before & 0xFFFF
                runs.append((first, before + 1, rig.loop.tally.ticks - first, gone))
            rig.drain()
            records = np.concatenate(rig.records)
            ticks = [tick for tick, _ in kept()]
    finally:
        ended.set()
        controller.join()
    np.testing.assert_array_equal(records["tick"], np.arange(records.size))
    ticks, said = zip(*kept(), strict=True)
    shown = Replay(dict(enumerate(PICTURES)).__getitem__, rig.device.display).frames(records)
    levels = np.rint(shown * TOP).reshape(records.size, -1)
    np.testing.assert_array_equal(levels_of(said), levels[[*ticks]])
