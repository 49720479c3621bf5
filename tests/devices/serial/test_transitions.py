"""The table of transitions: every row is taken, and nothing else ever happens."""

import numpy as np
import pytest

from tests.devices.bench import DOWN_BYTES, HALF, REST, Bench
from vbraille.devices.serial.conversation import TALKING, TRANSITIONS, Cause, Conversation, Stage
from vbraille.devices.serial.device import SerialDevice, greet
from vbraille.devices.serial.wire import (
    PLACED,
    RESTING,
    Decoder,
    Encoder,
    Error,
    Frame,
    State,
    encode,
    enframe,
)
from vbraille.errors import DeviceError

ROWS = [(stage, cause) for stage, row in TRANSITIONS.items() for cause in row]


class Watched(Conversation):
    """A conversation that keeps each transition, and raises if a stage is entered without one."""

    def __init__(self, now_ns):
        self.taken = []
        self.said = []  # each message that went out, and the stage that it went out in
        self._at = self._cause = None
        self._sent = Decoder()
        super().__init__(now_ns)

    @property
    def stage(self):
        return self._at

    @stage.setter
    def stage(self, stage):
        assert self._at is None or TRANSITIONS[self._at][self._cause] is stage
        self._at = stage

    def _go(self, cause):
        before, self._cause = self._at, cause
        went = super()._go(cause)
        if went:
            self.taken.append((before, cause, self._at))
        self._cause = None
        return went

    def due(self):
        message = super().due()
        if message is not None:
            self.said += [(self._at, said) for said in self._sent.feed(message)]
        return message


def watched(made):
    """Open what is at a bench; the device, whose conversation is watched."""
    conversation = Watched(made.now_ns())
    port = made.fresh_port()
    greet(port, conversation, made.now_ns, made.pause)
    return SerialDevice(port, conversation, made.now_ns, made.pause)


def say_state(made, *, flags, frame_sequence):
    """Have this STATE come, and none of the controller's."""
    sequence = made.controller._sequence + 1
    made.put(encode(State(sequence, made.us, 0, frame_sequence, flags, 0, None, 0, 0, 0)))


def in_silence(made, device, frame=HALF):
    """Read, write, and have nothing come but what is on the line."""
    made.mute = True
    made.run(device, 1, frame)
    made.mute = False


class Reached:
    """Ways to bring a device to a stage."""

    @staticmethod
    def greeting(made, device):
        made.unplug()
        made.run(device, 1)
        made.room = 0
        made.plug()
        made.run(device, 1)

    @staticmethod
    def asked(made, device):
        made.unplug()
        made.run(device, 1)
        made.deaf = True
        made.plug()
        made.run(device, 1)

    @staticmethod
    def ramping(made, device):
        """With a FRAME of rest on its way, of which the device says nothing yet."""
        Reached.at_rest(made, device)
        say_state(made, flags=PLACED | RESTING, frame_sequence=77)
        in_silence(made, device)

    @staticmethod
    def at_rest(made, device):
        made.deaf = True
        while device.conversation.stage is not Stage.AT_REST:
            made.run(device, 1)

    @staticmethod
    def live(made, device):
        made.settle(device)

    @staticmethod
    def idle_ramping(made, device):
        made.settle(device)
        device.conversation.frames.felt_ns -= 5_000_000_000  # as if it had been so long
        made.run(device, 1, REST)

    @staticmethod
    def idle(made, device):
        Reached.idle_ramping(made, device)
        made.run(device, 60, REST)

    @staticmethod
    def silent(made, device):
        made.settle(device)
        made.mute = True
        made.run(device, 110)

    @staticmethod
    def stranger(made, device):
        Reached.asked(made, device)
        Done.turned_away(made, device)

    @staticmethod
    def gone(made, device):
        made.unplug()
        made.run(device, 1)

    @staticmethod
    def failed(made, device):
        Done.fault(made, device)


class Done:
    """Ways to have something happen."""

    @staticmethod
    def asked(made, device):
        made.room = DOWN_BYTES
        made.run(device, 1)

    @staticmethod
    def answered(made, device):
        made.deaf = False
        made.run(device, 2)

    @staticmethod
    def turned_away(made, device):
        made.put(enframe(b"\x81\x03"))
        made.run(device, 1)

    @staticmethod
    def heard(made, device):
        made.mute = False
        made.run(device, 1)

    @staticmethod
    def ramps(made, device):
        say_state(made, flags=PLACED | RESTING, frame_sequence=78)
        in_silence(made, device, REST)

    @staticmethod
    def rested(made, device):
        made.run(device, 60, REST)

    @staticmethod
    def held(made, device):
        say_state(made, flags=PLACED, frame_sequence=9999)
        in_silence(made, device, REST)

    @staticmethod
    def took(made, device):
        say_state(made, flags=PLACED, frame_sequence=device.conversation.frames.sequence)
        in_silence(made, device)

    @staticmethod
    def fell(made, device):
        say_state(made, flags=PLACED | RESTING, frame_sequence=1)
        in_silence(made, device)

    @staticmethod
    def stalled(made, device):
        made.us += 45_000
        made.run(device, 1)

    @staticmethod
    def place_lost(made, device):
        made.controller.placed = False
        made.run(device, 2)

    @staticmethod
    def nothing_to_feel(made, device):
        Reached.idle_ramping(made, device)

    @staticmethod
    def felt(made, device):
        made.run(device, 1)

    @staticmethod
    def rest_wanted(_made, device):
        device.rest()

    @staticmethod
    def silence(made, device):
        idle = device.conversation.stage in (Stage.IDLE, Stage.IDLE_RAMPING)
        made.mute = True
        made.run(device, 110, REST if idle else HALF)

    @staticmethod
    def lost(made, device):
        made.run(device, 500)

    @staticmethod
    def unplugged(made, device):
        made.unplug()
        made.run(device, 1)

    @staticmethod
    def plugged_in(made, device):
        made.plug()
        made.run(device, 1)

    @staticmethod
    def fault(made, device):
        made.put(encode(Error(3, "Too hot.")))
        with pytest.raises(DeviceError, match="Too hot"):
            in_silence(made, device)

    @staticmethod
    def closed(made, device):
        device.conversation.close(made.now_ns())


AFTER_THE_START = [row for row in ROWS if row[1] is not Cause.NO_ANSWER]


@pytest.mark.parametrize(("stage", "cause"), AFTER_THE_START)
def test_every_row_is_taken(stage, cause):
    made = Bench(encoder=Encoder.INDEX if cause is Cause.PLACE_LOST else Encoder.ABSOLUTE)
    device = watched(made)
    if cause is Cause.PLACE_LOST:
        made.run(device, 2)
        made.way_mm = 15.0  # over the mark
    getattr(Reached, stage.name.lower())(made, device)
    conversation = device.conversation
    assert conversation.stage is stage
    conversation.taken.clear()
    getattr(Done, cause.name.lower())(made, device)
    taken = [row for row in conversation.taken if row[1] is cause]
    assert taken[0] == (stage, cause, TRANSITIONS[stage][cause])


@pytest.mark.parametrize("asked", [False, True])
def test_a_device_that_does_not_answer_at_the_start(asked):
    conversation = Watched(0)
    assert conversation.due() is not None
    if asked:
        conversation.sent()
    before = conversation.stage
    assert before is (Stage.ASKED if asked else Stage.GREETING)
    conversation.hear(b"", 2_999_999_999)
    assert conversation.stage is before
    conversation.hear(b"", 3_000_000_000)
    assert conversation.taken[-1] == (before, Cause.NO_ANSWER, Stage.FAILED)


def test_a_device_is_steady_where_frames_hold_it_and_nothing_else_is_due():
    made = Bench()
    device = watched(made)
    assert not device.conversation.steady
    made.settle(device)
    for _ in range(50):
        made.run(device, 1)
        assert device.conversation.steady
    made.us += 45_000
    made.run(device, 1)
    assert not device.conversation.steady


def test_a_conversation_may_be_had_in_any_stage_without_a_frame_getting_out():
    """Frames that are wanted where none may go come to nothing."""
    for stage in set(Stage) - {Stage.LIVE, Stage.AT_REST, Stage.GREETING, Stage.CLOSED}:
        made = Bench()
        device = watched(made)
        getattr(Reached, stage.name.lower())(made, device)
        if stage is Stage.IDLE:
            continue  # it wakes, and the frame is one of rest
        device.conversation.show(np.ones((6, 10)), made.now_ns())
        message = device.conversation.due()
        assert message is None or not isinstance(Decoder().feed(message)[0], Frame)
        assert (device.conversation.stage in TALKING) == (stage in TALKING)
