"""The compiled conversation beside the one in Python, over traffic of every kind.

Each read and each frame of a `Conversation` is done by the compiled functions, too, from the same
numbers. Where these answer, the conversation must have done the same, in every number and every
byte; where they leave it to Python, they must have changed nothing.
"""

import math
import random

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.controllers import HastyController
from tests.tiers import by_tier
from tests.troubles import Troubles
from tests.wired import Wired, reading
from vbraille.devices.serial import kernels
from vbraille.devices.serial.conversation import IDLE_MS, Conversation
from vbraille.devices.serial.kernels import Actuators, SteadyConversation
from vbraille.devices.serial.wire import (
    CRC_BYTES,
    FAULTY,
    PLACED,
    RESTING,
    SILENCE_MS,
    STALL_MS,
    TRIPPED,
    Error,
    State,
    Watchdog,
    encode,
    frame_head,
)
from vbraille.simulation.firmware import Controller

NS_PER_MS = 1_000_000


def steady(conversation):
    """Numbers of a conversation, copied, and the part of a message that has come; None if none are.

    The conversation is as it was before.
    """
    numbers = SteadyConversation()
    if not numbers.take_from(conversation):
        return None
    part = numbers.received[: numbers.begun].tobytes()
    conversation.decoder.feed(part)
    actuators = numbers.actuators
    numbers.actuators = actuators._replace(
        last=actuators.last.copy(), wanted=actuators.wanted.copy()
    )
    return numbers, part


def numbers_of(numbers):
    """All numbers of a conversation but the last place, which is there once a STATE was taken."""
    return {name: numbers.talk[name][0] for name in kernels.CONVERSATION.names if name != "x_mm"}


def record_of(numbers):
    """The same numbers, as compiled code takes and changes them."""
    return numbers.talk.view(np.recarray)[0]


class Beside(Conversation):
    """A conversation whose every read and frame is done by the compiled functions, too."""

    def __init__(self, now_ns, rate_hz=None):
        self.steady_reads = self.other_reads = self.steady_frames = self.other_frames = 0
        self._before = self._made = None
        super().__init__(now_ns, rate_hz)

    def mind_stall(self, now_ns):
        self._before = steady(self)
        return super().mind_stall(now_ns)

    def hear(self, chunk, now_ns):
        pose = super().hear(chunk, now_ns)
        if self._before is None:
            return pose
        (numbers, part), self._before = self._before, None
        begun, talk = numbers_of(numbers), record_of(numbers)
        received = np.frombuffer(part + chunk, np.uint8).copy()
        consumed, states = kernels.take(received, received.size, now_ns, talk, numbers.work)
        if consumed == kernels.SOMETHING_ELSE:
            self.other_reads += 1
            assert numbers_of(numbers) == begun
            return pose
        self.steady_reads += 1
        assert self.is_as(numbers) == received[consumed:].tobytes()
        assert (pose is None) == (states == 0)
        assert pose is None or pose == (talk.device_ns, talk.x_mm, talk.y_mm, talk.theta_rad)
        return pose

    def show(self, frame, now_ns):
        before = steady(self)
        super().show(frame, now_ns)
        if before is None:
            return
        numbers, _ = before
        begun, talk = numbers_of(numbers), record_of(numbers)
        size = kernels.make(frame, now_ns, talk, numbers.actuators, numbers.out)
        if size == kernels.SOMETHING_ELSE:
            self.other_frames += 1
            assert numbers_of(numbers) == begun
            return
        self.steady_frames += 1
        assert self.due() == numbers.out[:size].tobytes()
        kernels.sent(now_ns, talk, numbers.actuators)
        self._made = numbers

    def sent(self):
        super().sent()
        if self._made is not None:
            self.is_as(self._made)
            np.testing.assert_array_equal(self._made.actuators.last, self.drive.last)
            self._made = None

    def is_as(self, numbers):
        """Assert that it is what the compiled functions came to; the part of a message."""
        python, left = steady(self)
        assert numbers_of(python) == numbers_of(numbers)
        numbers.give_to(self)
        assert numbers_of(steady(self)[0]) == numbers_of(numbers)
        return left


def test_undisturbed_nothing_is_left_to_python_once_frames_are_taken():
    wired = Wired(random.Random(1), Troubles(), conversation=Beside, swing=0.5)
    wired.run(0.1)
    talk = wired.device.conversation
    before = talk.other_reads, talk.other_frames, talk.steady_reads, talk.steady_frames
    wired.run(0.5)
    after = talk.other_reads, talk.other_frames, talk.steady_reads, talk.steady_frames
    assert after[:2] == before[:2]
    assert after[2] - before[2] >= 499
    assert after[3] - before[3] >= 499


@pytest.mark.parametrize("controller", [Controller, HastyController])
@pytest.mark.parametrize("kind", ["host", "line"])
@pytest.mark.parametrize("seed", range(by_tier(2, 8, 400)))
def test_beside_python_over_traffic_with_troubles(seed, kind, controller):
    talk = reading(seed, kind, controller, Beside).device.conversation
    assert talk.steady_reads > 20
    assert talk.steady_frames > 20


def conversation(**changes):
    """A conversation in which a STATE and a FRAME have come and gone, at 1 s of the host's."""
    talk = np.zeros(1, kernels.CONVERSATION).view(np.recarray)[0]
    talk.heard_ns = talk.felt_ns = talk.owed_ns = talk.moved_ns = 1_000_000_000
    talk.sent_ns = talk.acknowledged_ns = kernels.NEVER
    talk.state_sequence, talk.sequence, talk.device_us = 10, 7, 5_000
    talk.count_bits, talk.mm_per_count = 24, 0.005
    talk.slew_per_ns, talk.period_ns = math.inf, 1e6
    talk.bits, talk.idle_ns = 10, IDLE_MS * NS_PER_MS
    talk.button_mask, talk.knobs_fitted, talk.knobs = 0xFF, 3, 0x80_8080
    for name, value in changes.items():
        setattr(talk, name, value)
    return talk


def state(sequence=11, flags=PLACED, **changes):
    numbers = {"time_us": 6_000, "count": 200, "frame_sequence": 7, "buttons": 0, "force_mn": None}
    numbers |= {"y_count": 40, "theta_count": 4000, "knobs": 0x80_8080}
    return encode(State(sequence=sequence, flags=flags, **(numbers | changes)))


def taken(received, talk, now_ns=1_001_000_000):
    source = np.frombuffer(received, np.uint8).copy()
    work = np.zeros(kernels.WORK_BYTES, np.uint8)
    return kernels.take(source, source.size, now_ns, talk, work)


@pytest.mark.parametrize(
    "received",
    [
        state(flags=PLACED | RESTING),
        state(flags=PLACED | FAULTY),
        state(flags=PLACED | TRIPPED),
        state(buttons=1),
        state(knobs=0x80_8083),
        state(knobs=0x7D_8080),
        encode(Watchdog(0, 0)),
        encode(Error(200, "warm")),
        b"\x05garbage\0",
        state()[:-3] + b"\0",
    ],
)
def test_what_is_no_good_state_leaves_all_of_it_to_python(received):
    for stream in (received, state() + received, received + state(), state() * 3 + received):
        talk = conversation()
        assert taken(stream, talk) == (kernels.SOMETHING_ELSE, 0)
        assert talk == conversation()


def test_both_axes_and_the_angle():
    talk = conversation(
        has_y=1, y_count=38, y_zero=-60, y_mm_per_count=-0.01,
        counts_per_turn=4096, straight=90, rad_per_count=-2 * math.pi / 4096,
    )  # fmt: skip
    assert taken(state(), talk) == (len(state()), 1)
    assert talk.y_mm == pytest.approx(-1.0)
    assert talk.theta_rad == pytest.approx(186 * 2 * math.pi / 4096)
    assert taken(state(12, y_count=(1 << 24) - 60), talk)[1] == 1  # it has wrapped
    assert talk.y_mm == pytest.approx(0.0)


def test_an_axis_that_is_not_there_is_not_counted():
    talk = conversation()
    assert taken(state(), talk)[1] == 1
    assert (talk.y_mm, talk.theta_rad) == (0.0, 0.0)


@pytest.mark.parametrize("knobs", [0x82_7E81, 0xFF80_8080, 0x0180_8080])
def test_knobs_that_jitter_and_one_that_is_not_there_end_nothing(knobs):
    talk = conversation()
    assert taken(state(knobs=knobs), talk)[1] == 1
    assert talk.knobs == 0x80_8080  # as it was told


def test_an_encoder_that_has_lost_its_mark_is_left_to_python():
    assert taken(state(flags=0), conversation()) == (len(state()), 1)
    assert taken(state(flags=0), conversation(must_be_placed=1)) == (kernels.SOMETHING_ELSE, 0)


def test_a_button_that_is_held_is_steady_and_one_that_is_let_go_is_not():
    assert taken(state(buttons=4), conversation(buttons=4)) == (len(state()), 1)
    assert taken(state(buttons=0), conversation(buttons=4)) == (kernels.SOMETHING_ELSE, 0)


def test_the_newest_of_some_states_is_the_sample():
    talk = conversation(sent_ns=1_000_500_000)
    stream = state(11) + b"\0\0" + state(13, count=400, time_us=8_000) + state(14)[:9]
    assert taken(stream, talk) == (len(stream) - 9, 2)
    assert (talk.x_mm, talk.device_ns, talk.missed) == (2.0, 8_000_000, 1)
    assert (talk.acknowledged_ns, talk.sent_ns) == (500_000, kernels.NEVER)


def test_a_clock_is_not_turned_back():
    talk = conversation(device_ns=5_000_000)
    assert taken(state(11, time_us=4_000), talk) == (len(state()), 1)
    assert (talk.missed, talk.device_us, talk.device_ns) == (0, 4_000, 5_000_000)


@pytest.mark.parametrize("sequence", [10, 9, 10 - 32_768])
def test_a_state_that_is_old_or_comes_twice_is_left_to_python(sequence):
    talk = conversation()
    assert taken(state(sequence % 2**16), talk)[0] == kernels.SOMETHING_ELSE


def test_silence_and_a_stall_are_left_to_python():
    late_ns = 1_000_000_000 + SILENCE_MS * NS_PER_MS
    for received in (b"", state()[:5]):
        assert taken(received, conversation(owed_ns=late_ns), late_ns - 1) == (0, 0)
        assert taken(received, conversation(owed_ns=late_ns), late_ns)[0] == kernels.SOMETHING_ELSE
    stalled_ns = 1_000_000_000 + STALL_MS * NS_PER_MS
    assert taken(state(), conversation(), stalled_ns - 1)[1] == 1
    assert taken(state(), conversation(), stalled_ns)[0] == kernels.SOMETHING_ELSE


def test_what_is_begun_and_never_ends_is_left_to_python():
    assert taken(b"\x01" * kernels.WORK_BYTES, conversation()) == (0, 0)
    more = b"\x01" * (kernels.WORK_BYTES + 1)
    assert taken(more, conversation())[0] == kernels.SOMETHING_ELSE
    assert taken(more + b"\0", conversation())[0] == kernels.SOMETHING_ELSE


@given(st.lists(st.one_of(st.binary(max_size=30), st.just(state()), st.just(b"\0"))).map(b"".join))
def test_no_bytes_read_or_write_out_of_bounds(received):
    source = np.concatenate([np.frombuffer(received, np.uint8), np.zeros(8, np.uint8)])
    work = np.full(kernels.WORK_BYTES + 8, 0xA5, np.uint8)
    room = work[: kernels.WORK_BYTES]
    consumed, _ = kernels.take(source, len(received), 1_001_000_000, conversation(), room)
    assert consumed <= len(received)
    assert (work[kernels.WORK_BYTES :] == 0xA5).all()


def one_actuator():
    body = np.zeros(3 + 2 + CRC_BYTES, np.uint8)
    body[:3] = np.frombuffer(frame_head(0), np.uint8)
    zeros = np.zeros((1, 1))
    return Actuators(
        zeros, zeros.copy(), np.full((1, 1), 1023.0), np.zeros((1, 1), int), body, body[3:5]
    )


def made(frame, talk, now_ns=1_001_000_000, actuators=None):
    out = np.zeros(20, np.uint8)
    return kernels.make(np.array([[frame]]), now_ns, talk, actuators or one_actuator(), out)


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
    assert made(deflection, talk) == kernels.SOMETHING_ELSE
    assert talk == conversation()


def test_frames_that_nobody_feels_end_after_a_while():
    idle_ns = 1_000_000_000 + IDLE_MS * NS_PER_MS
    for after_ns, sends in ((idle_ns - 1, True), (idle_ns, False)):
        assert (made(0.0, conversation(owed_ns=after_ns), after_ns) > 0) == sends
        assert made(0.5, conversation(owed_ns=after_ns), after_ns) > 0


def test_no_frame_is_made_after_a_stall():
    stalled_ns = 1_000_000_000 + STALL_MS * NS_PER_MS
    assert made(0.5, conversation(), stalled_ns - 1) > 0
    assert made(0.5, conversation(), stalled_ns) == kernels.SOMETHING_ELSE
