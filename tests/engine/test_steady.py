"""The compiled tick beside the one in Python, and all that it leaves to Python."""

import random

import numpy as np
import pytest

from tests.engine.lendable import Rig, Twin, assert_same_tick, known
from tests.engine.test_loop import picture
from vbraille.devices.conversation import IDLE_MS
from vbraille.devices.messages import SILENCE_MS, STALL_MS, Error, Frame, Watchdog
from vbraille.devices.wire import Levels, encode

NS_PER_MS = 1_000_000
TOP = 1023
PICTURES = [picture((line + 1, 63, 21) * 8, mapping="sheared") for line in range(4)]
LEVELS = Levels(60, TOP)


@pytest.fixture
def rig():
    rig = Rig()
    rig.loop.show(PICTURES[0], 0)
    rig.settle()
    yield rig
    rig.close()


def levels_of(messages):
    """Levels of each FRAME."""
    return [LEVELS.unpack(message.packed) for message in messages if isinstance(message, Frame)]


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
            (self.garbled, self.split, self.doubled, self.dropped, self.delayed, self.other)
            + (self.button, self.deafness, self.warp, self.reader)
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


@pytest.mark.parametrize("seed", range(8))
def test_over_traffic_with_faults_it_comes_to_what_python_alone_comes_to(seed):
    print(f"seed {seed}")
    rig = Rig()
    twin = Twin(rig)
    wrong = Wrong(rig, twin, seed)
    for loop in (rig.loop, twin.loop):
        loop.show(PICTURES[0], 0)
    compiled = left = 0
    for tick in range(600):
        rig.way_mm = 60.0 + 40.0 * np.sin(tick / 100)
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
    rig.close()
