"""The numbers of a serial conversation, lent to compiled code for as long as it is steady.

What `vbraille.devices.serial.kernels` works on is filled from a `Conversation` and given back
to it, some ticks later, as if the conversation had heard and said all of that itself.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from vbraille.devices.serial.conversation import IDLE_MS
from vbraille.devices.serial.kernels import CONVERSATION, NEVER, WORK_BYTES
from vbraille.devices.serial.wire import CRC_BYTES, frame_head, line_bytes

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.devices.serial.actuators import Drive
    from vbraille.devices.serial.conversation import Conversation
    from vbraille.devices.serial.sensors import CarriagePlace
    from vbraille.display import Display


class Actuators(NamedTuple):
    """How FRAMEs are made, and the last of them.

    Parameters
    ----------
    last, wanted : float64[rows, columns]
        Deflections of the FRAME that went out last, and of the FRAME that was made last.
    swing : float64[rows, columns]
        Number of levels in a full swing, before it is inverted.
    rest : int64[rows, columns]
        Level at rest: 0, or the highest.
    body : uint8[bytes]
        Type, sequence and levels of a FRAME, and room for its CRC.
    packed : uint8[bytes]
        View of the levels in ``body``.
    """

    last: NDArray[np.float64]
    wanted: NDArray[np.float64]
    swing: NDArray[np.float64]
    rest: NDArray[np.int64]
    body: NDArray[np.uint8]
    packed: NDArray[np.uint8]


class Lent(NamedTuple):
    """What a device lends to the engine, which then does its steady ticks in compiled code.

    Parameters
    ----------
    descriptor
        Descriptor of the device's open line, which does not block.
    begun
        Number of bytes at the beginning of `received`: a part of a message.
    received, work, out : uint8[bytes]
        Bytes that have come, room to work in, and room for a message that goes out.
    talk, actuators
        Numbers of the conversation, `vbraille.devices.serial.kernels.CONVERSATION`[1], and how its
        FRAMEs are made.
    """

    descriptor: int
    begun: int
    received: NDArray[np.uint8]
    work: NDArray[np.uint8]
    out: NDArray[np.uint8]
    talk: NDArray[np.void]
    actuators: Actuators


# Some ticks bring some hundred bytes; this leaves room for a stall.
RECEIVED_BYTES: Final = 8192


_NS_PER_MS: Final = 1_000_000


class Lending:
    """What a conversation lends, in memory that is the same each time.

    Attributes
    ----------
    talk : `vbraille.devices.serial.kernels.CONVERSATION`[1]
        Numbers of the conversation.
    received : uint8[RECEIVED_BYTES]
        Bytes that were received and not consumed, at the beginning of the array.
    work, out : uint8[bytes]
        Room to work in, and room for a FRAME as it goes over the line.
    actuators : Actuators
        How FRAMEs are made; set once something was lent.
    """

    actuators: Actuators

    def __init__(self) -> None:
        self.talk = np.zeros(1, CONVERSATION)
        self.received = np.zeros(RECEIVED_BYTES, np.uint8)
        self.work = np.zeros(WORK_BYTES, np.uint8)
        self.out = np.zeros(0, np.uint8)
        self._drive: Drive | None = None
        self._body = self._packed = self.out

    def lend(self, conversation: Conversation) -> int | None:
        """Take over the numbers of a conversation.

        Returns
        -------
        int or None
            Number of bytes that `received` begins with, if a part of a frame has come; None if the
            conversation is in a state that compiled code does not handle.
        """
        states, frames, place, time = (
            conversation.states,
            conversation.frames,
            conversation.place,
            conversation.time,
        )
        ready = conversation.steady and place.known and not conversation.trips.tripped
        if not ready or states.sequence is None or time.us is None:
            return None
        begun = conversation.decoder.take_begun()
        if begun is None or len(begun) > WORK_BYTES:
            conversation.decoder.feed(begun or b"")
            return None
        drive = conversation.drive
        if drive is not self._drive:
            self._fit(drive)
        self.actuators = Actuators(
            drive.last, drive.wanted, drive.swing, drive.rest_level, self._body, self._packed
        )
        talk = self.talk[0]
        talk["heard_ns"], talk["state_sequence"] = states.heard_ns, states.sequence
        talk["missed"] = states.missed
        _lend_panel(talk, conversation)
        _lend_place(talk, place)
        talk["device_us"], talk["offset_ns"] = time.us, time.offset_ns
        talk["device_ns"] = time.last_ns
        talk["sequence"], talk["felt_ns"] = frames.sequence, frames.felt_ns
        talk["sent_ns"] = _or_never(frames.sent_ns)
        talk["acknowledged_ns"] = _or_never(frames.acknowledged_ns)
        talk["owed_ns"] = _or_never(conversation.delivery.sent_ns)
        talk["idle_ns"] = IDLE_MS * _NS_PER_MS
        talk["moved_ns"], talk["period_ns"] = drive.last_ns, drive.period_ns
        talk["slew_per_ns"] = drive.slew_per_ns if drive.limited else math.inf
        talk["bits"] = drive.bits
        self.received[: len(begun)] = np.frombuffer(begun, np.uint8)
        return len(begun)

    def give_back(self, conversation: Conversation) -> None:
        """Let the conversation know what was heard and said meanwhile, except bytes left over."""
        talk, drive = self.talk[0], conversation.drive
        states, frames, time = conversation.states, conversation.frames, conversation.time
        states.heard_ns, states.sequence = int(talk["heard_ns"]), int(talk["state_sequence"])
        states.missed = int(talk["missed"])
        place = conversation.place
        place.x.count = int(talk["count"])
        if place.y is not None:
            place.y.count = int(talk["y_count"])
        if place.turn is not None:
            place.turn.count = int(talk["theta_count"])
        time.us, time.last_ns = int(talk["device_us"]), int(talk["device_ns"])
        time.host_ns = states.heard_ns
        frames.sequence, frames.felt_ns = int(talk["sequence"]), int(talk["felt_ns"])
        frames.sent_ns = _or_none(talk["sent_ns"])
        frames.acknowledged_ns = _or_none(talk["acknowledged_ns"])
        owed_ns = _or_none(talk["owed_ns"])
        if owed_ns is not None:
            conversation.delivery.sent(frames.sequence, owed_ns, holding=True)
        drive.last_ns = int(talk["moved_ns"])

    def _fit(self, drive: Drive) -> None:
        """Make room for the FRAMEs of a conversation."""
        head = np.frombuffer(frame_head(0), np.uint8)
        body_bytes = head.size + drive.packed.size
        self._body = np.zeros(body_bytes + CRC_BYTES, np.uint8)
        self._body[: head.size] = head
        self._packed = self._body[head.size : body_bytes]
        self.out = np.zeros(line_bytes(body_bytes), np.uint8)
        self._drive = drive


def _lend_panel(talk: np.void, conversation: Conversation) -> None:
    """Fill in the buttons and knobs."""
    panel = conversation.panel
    talk["buttons"], talk["button_mask"] = panel.buttons or 0, (1 << panel.buttons_fitted) - 1
    talk["knobs"], talk["knobs_fitted"] = panel.knobs or 0, panel.knobs_fitted


def _lend_place(talk: np.void, place: CarriagePlace) -> None:
    """Fill in the numbers of the carriage, whose place is known."""
    x, y, turn = place.x, place.y, place.turn
    # A place that is known has all of its counts.
    assert x.count is not None
    assert x.zero is not None
    talk["count"], talk["count_bits"], talk["zero"] = x.count, x.bits, x.zero
    talk["home_mm"], talk["mm_per_count"] = x.home_mm, x.mm_per_count
    talk["must_be_placed"] = place.needs_mark
    talk["y_mm"] = talk["theta_rad"] = 0.0
    talk["has_y"] = y is not None
    if y is not None and y.count is not None and y.zero is not None:
        talk["y_count"], talk["y_zero"], talk["y_mm_per_count"] = y.count, y.zero, y.mm_per_count
        talk["y_mm"] = y.place_mm or 0.0
    talk["counts_per_turn"] = 0 if turn is None else turn.counts_per_turn
    if turn is not None:
        talk["straight"], talk["rad_per_count"] = turn.straight or 0, turn.rad_per_count
        talk["theta_count"], talk["theta_rad"] = turn.count, turn.theta_rad


def example(display: Display) -> Lent:
    """Example of what a device lends, to load compiled code with before a real device is open.

    Nothing can be done with it, since its descriptor is that of no line.
    """
    shape = display.shape
    zeros = np.zeros(shape)
    body = np.zeros(CRC_BYTES, np.uint8)
    actuators = Actuators(zeros, zeros, zeros, np.zeros(shape, np.int64), body, body)
    room = np.zeros(WORK_BYTES, np.uint8)
    return Lent(-1, 0, room, room, room, np.zeros(1, CONVERSATION), actuators)


def _or_never(time_ns: int | None) -> int:
    return NEVER if time_ns is None else time_ns


def _or_none(time_ns: NDArray[np.int64]) -> int | None:
    return None if time_ns == NEVER else int(time_ns)
