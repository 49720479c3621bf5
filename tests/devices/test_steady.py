"""The compiled conversation beside the one in Python, over traffic of every kind.

Each read and each frame of a `SerialDevice` is done by the compiled functions, too, from the same
numbers. Where these answer, the device must have done the same, in every number and every byte;
where they leave it to Python, they must have changed nothing.
"""

import math
import random

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.controllers import ControllerOf20261121
from tests.troubles import Troubles
from tests.wired import Wired, reading
from vbraille.devices import steady
from vbraille.devices.messages import (
    FAULTY,
    PLACED,
    RESTING,
    SILENCE_MS,
    STALL_MS,
    TRIPPED,
    Encoder,
    Error,
    State,
    Watchdog,
)
from vbraille.devices.serialdevice import IDLE_MS, SerialDevice, _Link
from vbraille.devices.wire import CRC_BYTES, encode, frame_head, line_bytes
from vbraille.simulation.firmware import Controller

NS_PER_MS = 1_000_000


def never_if_none(time_ns):
    return steady.NEVER if time_ns is None else time_ns


def is_steady(device):
    delivery, place = device._delivery, device._place
    return (
        device._link is _Link.LIVE
        and delivery.taking
        and not (delivery.rest_due or delivery.stuck or delivery._counted)
        and not device._away
        and place.known
        and place._count is not None
        and device._time._us is not None
        and device._state_sequence is not None
        and not device._decoder._skipping
    )


def numbers_of(device):
    """Record of what a device's conversation has come to."""
    talk = np.zeros(1, steady.CONVERSATION).view(np.recarray)[0]
    place, clock, drive = device._place, device._time, device._drive
    talk.heard_ns = device._heard_ns
    talk.state_sequence, talk.missed = device._state_sequence, device._missed
    talk.count, talk.count_bits, talk.zero = place._count, place._bits, place._zero
    talk.home_mm, talk.mm_per_count = place._home_mm, place._mm_per_count
    talk.must_be_placed = place._encoder is Encoder.INDEX
    talk.device_us, talk.offset_ns = clock._us, clock._offset_ns
    talk.device_ns = clock._last_ns
    talk.x_mm = place._home_mm + place._mm_per_count * (place._count - place._zero)
    talk.sequence = device._sequence
    talk.sent_ns = never_if_none(device._sent_ns)
    talk.acknowledged_ns = never_if_none(device.acknowledged_ns)
    talk.owed_ns = never_if_none(device._delivery._sent_ns)
    talk.felt_ns, talk.idle_ns = device._felt_ns, IDLE_MS * NS_PER_MS
    talk.moved_ns = drive._last_ns
    talk.slew_per_ns = drive._slew_per_ns if drive._limited else math.inf
    talk.period_ns = drive._period_ns
    talk.top_level, talk.bits = drive._top_level, drive._bits
    return talk


def actuators_of(device):
    drive = device._drive
    body = np.zeros(len(frame_head(0)) + drive._packed.size + CRC_BYTES, np.uint8)
    body[: len(frame_head(0))] = np.frombuffer(frame_head(0), np.uint8)
    return steady.Actuators(
        drive._last.copy(),
        np.zeros_like(drive._wanted),
        drive._swing,
        drive._rest_level,
        body,
        body[len(frame_head(0)) : -CRC_BYTES],
    )


class Beside(SerialDevice):
    """A device whose every read and frame is done by the compiled functions, too."""

    def __init__(self, port, greeted, now_ns, pause, rate_hz=None):
        self.steady_reads = self.other_reads = self.steady_frames = self.other_frames = 0
        self._line = port
        self._clock_ns = now_ns
        self._work = np.zeros(steady.WORK_BYTES, np.uint8)
        super().__init__(port, greeted, now_ns, pause, rate_hz)

    def read(self):
        begun = numbers_of(self) if is_steady(self) else None
        held = bytes(self._decoder._held)
        times, chunks = self._listen()
        sample = super().read()
        self._listen_no_more()
        if begun is None:
            return sample
        received = np.frombuffer(held + b"".join(chunks), np.uint8).copy()
        talk = begun.copy()
        consumed, states = steady.take(received, received.size, times[0], talk, self._work)
        if consumed == steady.SOMETHING_ELSE:
            self.other_reads += 1
            assert talk == begun
            return sample
        self.steady_reads += 1
        assert is_steady(self)
        assert talk == numbers_of(self)
        assert received[consumed:].tobytes() == bytes(self._decoder._held)
        assert (sample is None) == (states == 0)
        assert sample is None or sample == (talk.device_ns, talk.x_mm)
        return sample

    def _send(self, frame):
        steadily = is_steady(self)
        begun, actuators = (numbers_of(self), actuators_of(self)) if steadily else (None, None)
        written = []
        times, _ = self._listen(written)
        super()._send(frame)
        self._listen_no_more()
        if begun is None:
            return
        talk = begun.copy()
        out = np.zeros(line_bytes(actuators.body.size), np.uint8)
        size = steady.make(frame, times[0], talk, actuators, out)
        if size == steady.SOMETHING_ELSE:
            self.other_frames += 1
            assert talk == begun
            return
        self.steady_frames += 1
        assert written == [out[:size].tobytes()]
        steady.sent(times[0], talk, actuators)
        assert is_steady(self)
        assert talk == numbers_of(self)
        np.testing.assert_array_equal(actuators.last, self._drive._last)

    def _listen(self, written=None):
        """Keep what the clock and the line say during the next call."""
        times, chunks = [], []

        def now_ns():
            times.append(self._clock_ns())
            return times[-1]

        self._now_ns = now_ns
        self._port = Tapped(self._line, chunks, [] if written is None else written)
        return times, chunks

    def _listen_no_more(self):
        self._now_ns, self._port = self._clock_ns, self._line


class Tapped:
    """A line that keeps what goes over it."""

    def __init__(self, line, read, written):
        self._line, self._read, self._written = line, read, written

    def __getattr__(self, name):
        return getattr(self._line, name)

    def read(self):
        self._read.append(self._line.read())
        return self._read[-1]

    def write(self, frame):
        self._written.append(frame)
        return self._line.write(frame)


def test_undisturbed_nothing_is_left_to_python_once_frames_are_taken():
    wired = Wired(random.Random(1), Troubles(), device=Beside, swing=0.5)
    wired.run(0.1)
    device = wired.device
    before = device.other_reads, device.other_frames, device.steady_reads, device.steady_frames
    wired.run(0.5)
    after = device.other_reads, device.other_frames, device.steady_reads, device.steady_frames
    assert after[:2] == before[:2]
    assert after[2] - before[2] >= 499
    assert after[3] - before[3] >= 499


@pytest.mark.parametrize("controller", [Controller, ControllerOf20261121])
@pytest.mark.parametrize("kind", ["host", "line"])
@pytest.mark.parametrize("seed", range(8))
def test_beside_python_over_traffic_with_troubles(seed, kind, controller):
    device = reading(seed, kind, controller, Beside).device
    assert device.steady_reads > 20
    assert device.steady_frames > 20


def conversation(**changes):
    """A conversation in which a STATE and a FRAME have come and gone, at 1 s of the host's."""
    talk = np.zeros(1, steady.CONVERSATION).view(np.recarray)[0]
    talk.heard_ns = talk.felt_ns = talk.owed_ns = talk.moved_ns = 1_000_000_000
    talk.sent_ns = talk.acknowledged_ns = steady.NEVER
    talk.state_sequence, talk.sequence, talk.device_us = 10, 7, 5_000
    talk.count_bits, talk.mm_per_count = 24, 0.005
    talk.slew_per_ns, talk.period_ns = math.inf, 1e6
    talk.top_level, talk.bits, talk.idle_ns = 1023, 10, IDLE_MS * NS_PER_MS
    for name, value in changes.items():
        setattr(talk, name, value)
    return talk


def state(sequence=11, flags=PLACED, **changes):
    numbers = {"time_us": 6_000, "count": 200, "frame_sequence": 7, "buttons": 0, "force_mn": None}
    return encode(State(sequence=sequence, flags=flags, **(numbers | changes)))


def taken(received, talk, now_ns=1_001_000_000):
    source = np.frombuffer(received, np.uint8).copy()
    work = np.zeros(steady.WORK_BYTES, np.uint8)
    return steady.take(source, source.size, now_ns, talk, work)


@pytest.mark.parametrize(
    "received",
    [
        state(flags=PLACED | RESTING),
        state(flags=PLACED | FAULTY),
        state(flags=PLACED | TRIPPED),
        encode(Watchdog(0, 0)),
        encode(Error(200, "warm")),
        b"\x05garbage\0",
        state()[:-3] + b"\0",
    ],
)
def test_what_is_no_good_state_leaves_all_of_it_to_python(received):
    for stream in (received, state() + received, received + state(), state() * 3 + received):
        talk = conversation()
        assert taken(stream, talk) == (steady.SOMETHING_ELSE, 0)
        assert talk == conversation()


def test_an_encoder_that_has_lost_its_mark_is_left_to_python():
    assert taken(state(flags=0), conversation()) == (len(state()), 1)
    assert taken(state(flags=0), conversation(must_be_placed=1)) == (steady.SOMETHING_ELSE, 0)


def test_the_newest_of_some_states_is_the_sample():
    talk = conversation(sent_ns=1_000_500_000)
    stream = state(11) + b"\0\0" + state(13, count=400, time_us=8_000) + state(14)[:9]
    assert taken(stream, talk) == (len(stream) - 9, 2)
    assert (talk.x_mm, talk.device_ns, talk.missed) == (2.0, 8_000_000, 1)
    assert (talk.acknowledged_ns, talk.sent_ns) == (500_000, steady.NEVER)


def test_a_state_that_comes_again_misses_none_and_turns_no_clock_back():
    talk = conversation(device_ns=5_000_000)
    assert taken(state(10, time_us=4_000), talk) == (len(state()), 1)
    assert (talk.missed, talk.device_us, talk.device_ns) == (0, 4_000, 5_000_000)


def test_silence_and_a_stall_are_left_to_python():
    late_ns = 1_000_000_000 + SILENCE_MS * NS_PER_MS
    for received in (b"", state()[:5]):
        assert taken(received, conversation(owed_ns=late_ns), late_ns - 1) == (0, 0)
        assert taken(received, conversation(owed_ns=late_ns), late_ns)[0] == steady.SOMETHING_ELSE
    stalled_ns = 1_000_000_000 + STALL_MS * NS_PER_MS
    assert taken(state(), conversation(), stalled_ns - 1)[1] == 1
    assert taken(state(), conversation(), stalled_ns)[0] == steady.SOMETHING_ELSE


def test_what_is_begun_and_never_ends_is_left_to_python():
    assert taken(b"\x01" * steady.WORK_BYTES, conversation()) == (0, 0)
    more = b"\x01" * (steady.WORK_BYTES + 1)
    assert taken(more, conversation())[0] == steady.SOMETHING_ELSE
    assert taken(more + b"\0", conversation())[0] == steady.SOMETHING_ELSE


@given(st.lists(st.one_of(st.binary(max_size=30), st.just(state()), st.just(b"\0"))).map(b"".join))
def test_no_bytes_read_or_write_out_of_bounds(received):
    source = np.concatenate([np.frombuffer(received, np.uint8), np.zeros(8, np.uint8)])
    work = np.full(steady.WORK_BYTES + 8, 0xA5, np.uint8)
    room = work[: steady.WORK_BYTES]
    consumed, _ = steady.take(source, len(received), 1_001_000_000, conversation(), room)
    assert consumed <= len(received)
    assert (work[steady.WORK_BYTES :] == 0xA5).all()


def one_actuator():
    body = np.zeros(3 + 2 + CRC_BYTES, np.uint8)
    body[:3] = np.frombuffer(frame_head(0), np.uint8)
    zeros = np.zeros((1, 1))
    return steady.Actuators(
        zeros, zeros.copy(), np.full((1, 1), 1023.0), np.zeros((1, 1), int), body, body[3:5]
    )


def made(frame, talk, now_ns=1_001_000_000, actuators=None):
    out = np.zeros(20, np.uint8)
    return steady.make(np.array([[frame]]), now_ns, talk, actuators or one_actuator(), out)


@pytest.mark.parametrize(
    ("after_ns", "step"), [(500_000, 0.05), (1_000_000, 0.1), (9_000_000, 0.1)]
)
def test_the_slew_limit_goes_by_the_time_passed_but_by_no_more_than_a_period(after_ns, step):
    actuators = one_actuator()
    assert made(1.0, conversation(slew_per_ns=1e-7), 1_000_000_000 + after_ns, actuators) > 0
    assert actuators.wanted[0, 0] == pytest.approx(step)


@pytest.mark.parametrize("deflection", [math.nan, math.inf, -math.inf, -1e-9, 1.0000001])
def test_a_deflection_that_is_none_is_not_sent(deflection):
    talk = conversation()
    assert made(deflection, talk) == steady.SOMETHING_ELSE
    assert talk == conversation()


def test_frames_that_nobody_feels_end_after_a_while():
    idle_ns = 1_000_000_000 + IDLE_MS * NS_PER_MS
    for after_ns, sends in ((idle_ns - 1, True), (idle_ns, False)):
        assert (made(0.0, conversation(owed_ns=after_ns), after_ns) > 0) == sends
        assert made(0.5, conversation(owed_ns=after_ns), after_ns) > 0


def test_no_frame_is_made_after_a_stall():
    stalled_ns = 1_000_000_000 + STALL_MS * NS_PER_MS
    assert made(0.5, conversation(), stalled_ns - 1) > 0
    assert made(0.5, conversation(), stalled_ns) == steady.SOMETHING_ELSE
