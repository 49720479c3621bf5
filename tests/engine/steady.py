"""A serial device whose steady ticks are compiled, over a pair of descriptors, tick by tick.

The compiled tick goes by the machine's clock, so that no test can turn it. But it is due at once
here, and does one tick at a time, between which the simulated controller goes on by a millisecond
of its own.
"""

from __future__ import annotations

import array
import fcntl
import io
import os
import socket
import termios
import time
import tty
from collections import deque
from contextlib import suppress
from dataclasses import replace

import numpy as np

from tests.engine.test_loop import info, picture
from vbraille.devices.serial.conversation import Conversation
from vbraille.devices.serial.device import SerialDevice, greet
from vbraille.devices.serial.port import Address, SerialLine
from vbraille.devices.serial.wire import Decoder, Encoder, Frame, Levels, State, encode
from vbraille.engine.loop import Loop
from vbraille.engine.record import Ring
from vbraille.simulation.firmware import Controller, describe

# A run does as many ticks as there are in 20 ms: one.
ONE_AT_A_TIME_HZ = 60.0
FADE_S = 0.01
NS_PER_S = 1_000_000_000
TOP = 1023
PICTURES = [picture((line + 1, 63, 21) * 8, mapping="sheared") for line in range(4)]
_LEVELS = Levels(60, TOP)


def levels_of(messages):
    """Levels of each FRAME, 0 to `TOP`."""
    return [_LEVELS.unpack(message.packed) for message in messages if isinstance(message, Frame)]


def sockets():
    """The host's descriptor and the controller's, of a pair of sockets."""
    ours, theirs = socket.socketpair()
    return ours.detach(), theirs.detach()


def terminal():
    """The host's descriptor and the controller's, of a pseudo-terminal."""
    theirs, ours = os.openpty()
    tty.setraw(ours)
    return ours, theirs


class Clock:
    """The machine's clock, or a time that stands still as long as it is set."""

    def __init__(self, at_ns=None):
        self.at_ns = at_ns
        self.slept = []

    def now_ns(self):
        return time.monotonic_ns() if self.at_ns is None else self.at_ns

    def busy_ns(self):
        return time.thread_time_ns() if self.at_ns is None else self.at_ns

    def sleep_until_ns(self, deadline_ns):
        self.slept.append(deadline_ns)


class Port:
    """What `SerialPort` is, on a descriptor; it keeps what was read by Python."""

    address = Address("pair")

    def __init__(self, descriptor):
        self.gone = False
        self.losses = 0
        self.chunks = []
        self._line = SerialLine(io.FileIO(descriptor, "r+"))

    def read(self):
        chunk = self._try(self._line.read) or b""
        self.chunks.append(chunk)
        return chunk

    def write(self, frame):
        return bool(self._try(self._line.write, frame))

    def _try(self, do, *given):
        """What it gives; None if the line is gone."""
        if self.gone:
            return None
        try:
            return do(*given)
        except OSError:
            self.gone = True
            self.losses += 1
            return None

    @property
    def bare_descriptor(self):
        return None if self.gone else self._line.bare_descriptor

    def keep(self, rest):
        self._line.keep(rest)

    def drop_unsent(self):
        self._line.drop_unsent()

    def close(self, _pause):
        self._line.close()


class Rig:
    """A controller, a line, and a loop whose ticks are compiled as long as all is steady.

    Attributes
    ----------
    asked : list[int]
        Times that the device asked for: none in a tick that was compiled.
    records : list of arrays
        Of all ticks.
    sent : bytes
        What the host sent in the last step.
    state : State
        What the controller said last.
    """

    def __init__(self, ends=None, rate_hz=ONE_AT_A_TIME_HZ, device_hz=1000.0, **axes):
        self.ours, self.theirs = ends or sockets()
        for end in (self.ours, self.theirs):
            os.set_blocking(end, False)
        self.us, self.way_mm, self.y_mm, self.theta_rad = 0, 20.0, 0.0, 0.0
        self.asked, self.records, self.sent = [], [], b""
        display = info(rate_hz=device_hz, **axes)
        self.controller = Controller(describe(display, Encoder.ABSOLUTE))
        self.port = Port(self.ours)
        conversation = Conversation(self.now_ns())
        greet(self.port, conversation, self.now_ns, self.pause)
        self.device = SerialDevice(self.port, conversation, self.now_ns)
        self.greeting = self.asked, self.port.chunks
        ring = Ring.alone(self.device.display.shape, 2000)
        self.reader = ring.reader()
        self.clock = Clock(time.monotonic_ns())
        self.loop = Loop(self.device, self.clock, rate_hz=rate_hz, fade_s=FADE_S, ring=ring)
        self.begun_ns, self.clock.at_ns = self.clock.at_ns, None

    def now_ns(self):
        self.asked.append(time.monotonic_ns())
        return self.asked[-1]

    def pause(self, _seconds):
        self.hear()
        self.put(self.say())

    def say(self):
        """What the controller says in its next millisecond."""
        self.us += 1000
        said = self.controller.tick(self.us, self.way_mm, self.y_mm, self.theta_rad)
        for message in Decoder().feed(said):
            if isinstance(message, State):
                self.state = message
        return said

    def again(self):
        """A STATE of a millisecond after the last, without the controller's doing."""
        self.state = replace(
            self.state, sequence=self.state.sequence + 1, time_us=self.state.time_us + 1000
        )
        return encode(self.state)

    def receive(self):
        """Bytes that the host has sent."""
        chunks = []
        with suppress(BlockingIOError):
            while True:
                chunks.append(os.read(self.theirs, 65_536))
        return b"".join(chunks)

    def hear(self):
        """Give the controller what the host has sent; its answers go back."""
        self.sent = self.receive()
        self.put(self.controller.receive(self.sent, self.us))

    def put(self, chunk):
        """Put bytes on the line to the host, and see that they have arrived."""
        there = self.waiting() + len(chunk)
        while chunk:
            chunk = chunk[os.write(self.theirs, chunk) :]
        while self.waiting() < there:  # a terminal carries them over in its own time
            os.sched_yield()

    def waiting(self):
        """Number of bytes on the line to the host."""
        there = array.array("i", [0])
        fcntl.ioctl(self.ours, termios.FIONREAD, there)
        return there[0]

    def tick(self, mailbox=None):
        """Run for a tick that is due now; its record."""
        self.asked.clear()
        self.loop.restart_clock()
        self.loop.run(mailbox)
        return self.drain()[-1]

    def drain(self):
        self.loop.ring.publish()
        self.records.append(self.reader.drain())
        times_ns = np.concatenate(self.records[-2:])["time_ns"]
        assert (np.diff(times_ns) > 0).all()  # no tick is done twice
        return self.records[-1]

    def step(self):
        """A millisecond of the controller's, a tick, and what is sent then; its record."""
        self.put(self.say())
        record = self.tick()
        self.hear()
        return record

    @property
    def compiled(self):
        """Whether the last tick was done without the device."""
        return not self.asked

    def settle(self):
        """Tick until ticks are compiled."""
        for _ in range(200):
            self.step()
            if self.compiled:
                return
        raise AssertionError("no tick was compiled")

    def hang_up(self):
        os.close(self.theirs)
        self.theirs = None

    def close(self):
        self.device.close()
        if self.theirs is not None:
            self.hang_up()


class Twin:
    """The same conversation in Python alone, at the same times and with the same bytes."""

    def __init__(self, rig):
        self._rig = rig
        times, chunks = rig.greeting
        self.times, self.chunks = deque(times), deque(chunks)
        self.sent = b""
        self.port = _Script(self)
        conversation = Conversation(self.now_ns())
        greet(self.port, conversation, self.now_ns, lambda _seconds: None)
        self.device = SerialDevice(self.port, conversation, self.now_ns)
        ring = Ring.alone(self.device.display.shape, 2)
        self.reader = ring.reader()
        self.clock = Clock(rig.begun_ns)
        self.loop = Loop(
            self.device, self.clock, rate_hz=ONE_AT_A_TIME_HZ, fade_s=FADE_S, ring=ring
        )
        self.sent = b""

    def now_ns(self):
        return self.times.popleft()

    def tick(self, time_ns, asked, chunk):
        """Do in Python the tick that woke at a time; its record.

        Parameters
        ----------
        time_ns
            When it woke.
        asked
            Times that were asked for: to read and to write. Compiled code asks for neither: it
            does at the time of its waking what is not left to Python.
        chunk
            Bytes that had come.
        """
        self.clock.at_ns = time_ns
        self.times = deque([time_ns] * (2 - len(asked)) + asked)
        self.chunks = deque([chunk])
        self.sent = b""
        self.loop.tick()
        # When a frame had gone out is the machine's doing, and says how far the next one may go.
        self.loop.state.done_ns[0] = self._rig.loop.state.done_ns[0]
        assert not self.times
        self.loop.ring.publish()
        return self.reader.drain()[-1]


class _Script:
    """A port that gives what there is for it to give, and keeps what is sent."""

    address = Address("script")
    gone = False
    losses = lost = 0

    def __init__(self, twin):
        self._twin = twin

    def read(self):
        return self._twin.chunks.popleft() if self._twin.chunks else b""

    def write(self, frame):
        self._twin.sent += frame
        return True

    def drop_unsent(self):
        """All has gone out."""


def known(device):
    """All numbers that a conversation has come to."""
    talk = device.conversation
    fields = {
        "stage": talk.stage,
        "taking": talk.taking,
        "rested": talk.rested,
        "reconnections": talk.reconnections,
        "counts": device.counts(),
        "copied": (device.rested, device.taking, device.acknowledged_ns, device.placing),
        "dropped": talk.decoder.dropped,
        "begun": talk.decoder.take_begun(),
    }
    talk.decoder.feed(fields["begun"] or b"")
    for part in (talk.states, talk.frames):
        fields |= {(type(part), name): getattr(part, name) for name in type(part).__slots__}
    place = talk.place
    axes = [axis for axis in (place.x, place.y, place.turn) if axis is not None]
    for part in (talk.trips, talk.controls, talk.delivery, place, talk.time, *axes):
        numbers = {name: value for name, value in vars(part).items() if value not in axes}
        fields |= {(type(part), part is place.y, name): value for name, value in numbers.items()}
    fields["moved"] = talk.drive.last_ns, talk.drive.last.tolist()
    return fields


def assert_same_tick(got, want):
    """Records are the same in all but what tells of the machine's own pace."""
    for name in got.dtype.names:
        if name not in ("lateness_ns", "work_ns", "late", "overruns"):
            np.testing.assert_array_equal(got[name], want[name], err_msg=name)
