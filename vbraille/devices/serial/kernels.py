"""The serial protocol, compiled: bytes, and a conversation as long as nothing happens in it.

`vbraille.devices.serial.wire` says what the bytes are. `take`, `make` and `sent` are for a
conversation that is live and whose FRAMEs are taken; `CONVERSATION` has its numbers. Whatever is
anything but the next STATE or the next FRAME of such a conversation - bytes that were damaged,
another message, silence, a rest, a fault, a stall, a deflection that is none - is answered with
`SOMETHING_ELSE`. Then nothing of the conversation was changed, and `SerialDevice` does with the
same bytes, or the same frame, what there is to do.

`SteadyConversation` takes these numbers from a `Conversation` and gives them back to it, some ticks
later, as if the conversation had heard and said all of that itself.

Nothing that is compiled here allocates, waits or raises. Places in an array are given as its first
index and the one after its last. What is asked of bytes that cannot be true, or of an array that is
too small, is answered with a negative number, and never read or written past an array's end.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
from numba import njit

from vbraille.caching import keep_compiled
from vbraille.devices import framekernels
from vbraille.devices.serial.conversation import IDLE_MS
from vbraille.devices.serial.wire import (
    CRC_BYTES,
    FAULTY,
    KNOB_STEP,
    KNOB_TOP,
    MESSAGES,
    PLACED,
    RESTING,
    SILENCE_MS,
    STALL_MS,
    TRIPPED,
    Frame,
    State,
    fields_of,
    frame_head,
    line_bytes,
    places_of,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.devices.serial.conversation import Conversation
    from vbraille.devices.serial.hardware import CarriagePlace, Drive
    from vbraille.display import Display

BAD_COBS = -1
BAD_CRC = -2
TOO_SMALL = -3

_POLYNOMIAL = 0xEDB88320
_LONGEST_RUN = 0xFE  # bytes that are not zero, in one block of COBS


def _slices():
    """CRC-32 of a byte with 0 to 3 zeros after it: four bytes are then looked up at once."""
    table = np.zeros((4, 256), np.int64)
    for byte in range(256):
        rest = byte
        for _ in range(8):
            rest = (rest >> 1) ^ (_POLYNOMIAL if rest & 1 else 0)
        table[0, byte] = rest
    for zeros in range(1, 4):
        before = table[zeros - 1]
        table[zeros] = (before >> 8) ^ table[0, before & 0xFF]
    return table.astype(np.uint32)  # 4 kB, for the nearest cache is the renderer's, too


_SLICES = _slices()


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def crc32(source, start, end):
    """CRC-32 of ``source[start:end]``, the same as zlib's.

    Parameters
    ----------
    source : uint8[bytes]
        Bytes, with others around them.
    start, end : int64
        First index, and one past the last; both are in the array.

    Returns
    -------
    int64
        CRC from 0 to 2³² - 1.
    """
    rest = 0xFFFFFFFF
    at = start
    while at + 4 <= end:
        rest ^= (
            np.int64(source[at])
            | np.int64(source[at + 1]) << 8
            | np.int64(source[at + 2]) << 16
            | np.int64(source[at + 3]) << 24
        )
        rest = (
            np.int64(_SLICES[3, rest & 0xFF])
            ^ np.int64(_SLICES[2, (rest >> 8) & 0xFF])
            ^ np.int64(_SLICES[1, (rest >> 16) & 0xFF])
            ^ np.int64(_SLICES[0, rest >> 24])
        )
        at += 4
    while at < end:
        rest = (rest >> 8) ^ np.int64(_SLICES[0, (rest ^ np.int64(source[at])) & 0xFF])
        at += 1
    return rest ^ 0xFFFFFFFF


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def cobs_encode(source, start, end, out, at):
    """Write COBS of ``source[start:end]``, beginning at ``out[at]``.

    Returns
    -------
    int64
        Index in ``out`` after the last byte written; TOO_SMALL, with nothing written, if the
        longest COBS of so many bytes would not fit.
    """
    size = end - start
    blocks = max(1, (size + _LONGEST_RUN - 1) // _LONGEST_RUN)
    if size < 0 or at < 0 or at + size + blocks > out.size:
        return TOO_SMALL
    head = at  # place of the block's length
    at += 1
    for place in range(start, end):
        byte = source[place]
        if byte != 0:
            out[at] = byte
            at += 1
            if at - head <= _LONGEST_RUN or place + 1 == end:
                continue
        out[head] = at - head
        head = at
        at += 1
    out[head] = at - head
    return at


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def cobs_decode(source, start, end, out):
    """Decode the COBS in ``source[start:end]``, and write the result to the beginning of ``out``.

    Returns
    -------
    int64
        Number of bytes decoded; BAD_COBS if the source is no COBS, TOO_SMALL if ``out`` is smaller
        than the source. In both cases ``out`` is undefined.
    """
    if end - start > out.size:
        return TOO_SMALL
    written = 0
    at = start
    while at < end:
        length = np.int64(source[at])
        block_end = at + length
        if length == 0 or block_end > end:
            return BAD_COBS
        for place in range(at + 1, block_end):
            byte = source[place]
            if byte == 0:
                return BAD_COBS
            out[written] = byte
            written += 1
        at = block_end
        if at < end and length <= _LONGEST_RUN:
            out[written] = 0
            written += 1
    return written


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def delimiter(source, start, end):
    """Index of the first zero in ``source[start:end]``; ``end`` if there is none."""
    at = start
    while at < end and source[at] != 0:
        at += 1
    return at


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def unframe(source, start, end, body):
    """Write the body of the frame ``source[start:end]``, and its CRC, to the beginning of ``body``.

    Parameters
    ----------
    source : uint8[bytes]
        Bytes that were received.
    start, end : int64
        First index of a frame, and one past its last without the delimiter.
    body : uint8[bytes]
        Room for the body, at least as long as the frame.

    Returns
    -------
    int64
        Number of bytes in the body without its CRC, 1 or more; or BAD_COBS, BAD_CRC, TOO_SMALL.
    """
    size = cobs_decode(source, start, end, body)
    if size < 0:
        return size
    size -= CRC_BYTES
    if size < 1:
        return BAD_CRC
    if crc32(body, 0, size) != number(body, size, CRC_BYTES, 0):
        return BAD_CRC
    return size


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def enframe(body, size, out, at):
    """Write the frame of a body, with its delimiter, from ``out[at]`` on.

    Parameters
    ----------
    body : uint8[bytes]
        The body, and room for the four bytes of its CRC, which are written.
    size : int64
        Number of bytes in the body without its CRC.
    out : uint8[bytes]
        Room for `vbraille.devices.serial.wire.line_bytes` of the body, from ``at`` on.
    at : int64
        Index in ``out`` at which the frame begins.

    Returns
    -------
    int64
        Index in ``out`` after the delimiter; TOO_SMALL, with no frame written, if the body or
        ``out`` has no room.
    """
    if size < 0 or size + CRC_BYTES > body.size:
        return TOO_SMALL
    put_number(body, size, CRC_BYTES, crc32(body, 0, size))
    # The last byte of `out` is kept for the delimiter.
    at = cobs_encode(body, 0, size + CRC_BYTES, out[: out.size - 1], at)
    if at < 0:
        return TOO_SMALL
    out[at] = 0
    return at + 1


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def number(source, at, width, signed):
    """Integer of ``width`` bytes from ``source[at]`` on, least significant first, as int64.

    `vbraille.devices.serial.wire.places_of` gives the arguments for a message's numbers.
    """
    value = 0
    for place in range(width):
        value |= np.int64(source[at + place]) << (8 * place)
    if signed and value >= 1 << (8 * width - 1):
        value -= 1 << (8 * width)
    return value


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def put_number(out, at, width, value):
    """Write an integer's ``width`` bytes from ``out[at]`` on, least significant first."""
    for place in range(width):
        out[at + place] = (value >> (8 * place)) & 0xFF


SOMETHING_ELSE = -1
# Value that stands for a time that is unknown.
NEVER = -1
# Room for the longest frame that is looked at here: a STATE to which a later version has appended.
WORK_BYTES = 256

CONVERSATION = np.dtype(
    [
        # Of the STATEs.
        ("heard_ns", "<i8"),  # when the last came, by the host's clock
        ("state_sequence", "<i8"),  # of the last
        ("missed", "<i8"),  # how many are missing so far
        ("count", "<i8"),  # of the encoder, without its wraps
        ("count_bits", "<i8"),
        ("zero", "<i8"),  # count at the left stop
        ("home_mm", "<f8"),  # where the array's centre is then
        ("mm_per_count", "<f8"),
        ("buttons", "<i8"),  # that are pressed, a bit each
        ("button_mask", "<i8"),  # bits of those that are there
        ("knobs", "<i8"),  # where they were last told to stand, a byte each
        ("knobs_fitted", "<i8"),  # how many are there
        ("has_y", "<i8"),  # 1 if the carriage has a second axis
        ("y_count", "<i8"),  # as of x
        ("y_zero", "<i8"),
        ("y_mm_per_count", "<f8"),
        ("y_mm", "<f8"),
        ("counts_per_turn", "<i8"),  # 0 if no angle is measured
        ("theta_count", "<i8"),  # of the angle, in the last STATE
        ("straight", "<i8"),  # count where the array is not turned
        ("rad_per_count", "<f8"),
        ("theta_rad", "<f8"),
        ("must_be_placed", "<i8"),  # 1 if the encoder may lose its place and say so
        ("device_us", "<i8"),  # the device's clock, without its wraps
        ("offset_ns", "<i8"),  # what is added to it, for it goes on over a restart
        ("device_ns", "<i8"),  # when the last sample was taken, by that clock
        ("x_mm", "<f8"),  # where the array's centre was then
        # Of the FRAMEs.
        ("sequence", "<i8"),  # of the last
        ("sent_ns", "<i8"),  # when it went out; NEVER if none has since or it is acknowledged
        ("acknowledged_ns", "<i8"),  # how long it took until it was; NEVER as long as it is not
        ("owed_ns", "<i8"),  # when the last went out, for the watchdog; NEVER if none has
        ("felt_ns", "<i8"),  # when there was last anything to feel
        ("idle_ns", "<i8"),  # how long without that until FRAMEs are no use
        ("moved_ns", "<i8"),  # since when the actuators are on their way to the last
        ("slew_per_ns", "<f8"),  # fastest of an actuator, in swings; infinite for no limit
        ("period_ns", "<f8"),  # of the host's FRAMEs
        ("bits", "<i8"),  # of a level
    ],
    align=True,
)


_STATE = next(code for code, message in MESSAGES.items() if message is State)
_NAMES = [name for name, _ in fields_of(State)]
_PLACES = places_of(State)
_STATE_BYTES = _PLACES[-1][0] + _PLACES[-1][1]
# Place of each field, as `number` takes it.
_SEQUENCE, _TIME_US, _COUNT, _FRAME_SEQUENCE, _FLAGS, _BUTTONS = (
    _PLACES[_NAMES.index(name)]
    for name in ("sequence", "time_us", "count", "frame_sequence", "flags", "buttons")
)
_Y_COUNT, _THETA_COUNT, _KNOBS = (
    _PLACES[_NAMES.index(name)] for name in ("y_count", "theta_count", "knobs")
)
_KNOB_BITS = 8
_UNSTEADY = RESTING | FAULTY | TRIPPED
_SEQUENCE_BITS, _TIME_BITS = 8 * _SEQUENCE[1], 8 * _TIME_US[1]
_FRAME_AT, _FRAME_WIDTH, _ = places_of(Frame)[0]
_FRAME_MASK = (1 << (8 * _FRAME_WIDTH)) - 1
_NS_PER_MS = 1_000_000
_STALL_NS = STALL_MS * _NS_PER_MS
_SILENCE_NS = SILENCE_MS * _NS_PER_MS


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def _unwrap(count, last, bits):
    """Continuous count of a counter that wraps: `unwrap` of the codec, compiled."""
    half = 1 << (bits - 1)
    return last + ((count - last + half) & (2 * half - 1)) - half


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def stalled(talk, now_ns):
    """Tell whether the last FRAME is so old that the device may have gone to rest."""
    return talk.owed_ns != NEVER and now_ns - talk.owed_ns >= _STALL_NS


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def silent(talk, now_ns):
    """Tell whether the last STATE is so old that the device must be told to rest."""
    return now_ns - talk.heard_ns >= _SILENCE_NS


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def _turned(before, now, knobs):
    """Tell whether any of so many knobs was turned, as `hardware.turned` says."""
    if before == now:
        return False
    for knob in range(knobs):
        old, new = (
            (before >> (knob * _KNOB_BITS)) & KNOB_TOP,
            (now >> (knob * _KNOB_BITS)) & KNOB_TOP,
        )
        if old != new and (abs(new - old) >= KNOB_STEP or new == 0 or new == KNOB_TOP):
            return True
    return False


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def take(received, size, now_ns, talk, work):
    """Take all STATEs that have come.

    Parameters
    ----------
    received : uint8[bytes]
        Bytes that were received and not consumed so far, at the beginning of the array.
    size : int64
        Number of these bytes.
    now_ns : int64
        Time, by the host's clock.
    talk : record of CONVERSATION
        The conversation's numbers; they are changed, unless the answer is SOMETHING_ELSE.
    work : uint8[WORK_BYTES]
        Room to work in.

    Returns
    -------
    consumed : int64
        Number of bytes that were consumed: all up to the last delimiter. The rest is kept and given
        again with what comes after it. SOMETHING_ELSE if these bytes, or their absence, are not
        for compiled code.
    states : int64
        Number of STATEs in these bytes. Unless it is 0, ``device_ns``, ``x_mm``, ``y_mm`` and
        ``theta_rad`` are a new pose.
    """
    if stalled(talk, now_ns):
        return SOMETHING_ELSE, 0
    state_sequence, missed = talk.state_sequence, talk.missed
    count, device_us = talk.count, talk.device_us
    y_count, theta_count = talk.y_count, talk.theta_count
    device_ns = talk.device_ns
    acknowledged = False
    states = 0
    begun = np.int64(0)  # a plain 0 would have what it is given to compiled twice
    while True:
        end = delimiter(received, begun, size)
        if end == size:
            break
        if end == begun:  # an empty frame, which means nothing
            begun += 1
            continue
        body_bytes = unframe(received, begun, end, work)
        if body_bytes < _STATE_BYTES or work[0] != _STATE:
            return SOMETHING_ELSE, 0
        flags = number(work, *_FLAGS)
        if flags & _UNSTEADY != 0 or (talk.must_be_placed != 0 and flags & PLACED == 0):
            return SOMETHING_ELSE, 0
        if number(work, *_BUTTONS) & talk.button_mask != talk.buttons:
            return SOMETHING_ELSE, 0
        if _turned(talk.knobs, number(work, *_KNOBS), talk.knobs_fitted):
            return SOMETHING_ELSE, 0
        y_count = _unwrap(number(work, *_Y_COUNT), y_count, talk.count_bits)
        theta_count = number(work, *_THETA_COUNT)
        sequence = _unwrap(number(work, *_SEQUENCE), state_sequence, _SEQUENCE_BITS)
        if sequence <= state_sequence:  # an old one, or one that came twice
            return SOMETHING_ELSE, 0
        missed += max(sequence - state_sequence - 1, 0)
        state_sequence = number(work, *_SEQUENCE)
        if number(work, *_FRAME_SEQUENCE) == talk.sequence:
            acknowledged = True
        count = _unwrap(number(work, *_COUNT), count, talk.count_bits)
        device_us = _unwrap(number(work, *_TIME_US), device_us, _TIME_BITS)
        device_ns = max(device_us * 1000 + talk.offset_ns, device_ns)
        states += 1
        begun = end + 1
    if size - begun > WORK_BYTES:
        return SOMETHING_ELSE, 0
    if states == 0:
        if silent(talk, now_ns):
            return SOMETHING_ELSE, 0
        return begun, 0
    talk.heard_ns = now_ns
    talk.state_sequence, talk.missed = state_sequence, missed
    talk.count, talk.device_us, talk.device_ns = count, device_us, device_ns
    talk.x_mm = talk.home_mm + talk.mm_per_count * (count - talk.zero)
    if talk.has_y != 0:
        talk.y_count = y_count
        talk.y_mm = talk.y_mm_per_count * (y_count - talk.y_zero)
    if talk.counts_per_turn != 0:
        talk.theta_count = theta_count
        half = talk.counts_per_turn // 2
        away = (theta_count - talk.straight + half) % talk.counts_per_turn - half
        talk.theta_rad = talk.rad_per_count * away
    if acknowledged and talk.sent_ns != NEVER:
        talk.acknowledged_ns = now_ns - talk.sent_ns
        talk.sent_ns = NEVER
    return begun, states


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def make(deflections, now_ns, talk, actuators, out):
    """Make the next FRAME; call `sent` when it has gone out.

    Parameters
    ----------
    deflections : float64[rows, columns]
        Deflections that the actuators are to have, in [0, 1].
    now_ns : int64
        Time, by the host's clock.
    talk : record of CONVERSATION
        The conversation's numbers; they are changed, unless the answer is SOMETHING_ELSE.
    actuators : Actuators
        How FRAMEs are made; ``wanted`` and ``body`` are changed.
    out : uint8[bytes]
        Room for the frame, as it goes over the line.

    Returns
    -------
    int64
        Number of bytes in the frame; SOMETHING_ELSE if none is to be sent.
    """
    if stalled(talk, now_ns):
        return SOMETHING_ELSE
    rows, columns = deflections.shape
    for row in range(rows):
        for column in range(columns):
            # A value that is not a number is refused, too.
            if not 0.0 <= deflections[row, column] <= 1.0:
                return SOMETHING_ELSE
    step = math.inf
    if talk.slew_per_ns < math.inf:
        step = talk.slew_per_ns * min(now_ns - talk.moved_ns, talk.period_ns)
    felt = framekernels.fill(
        deflections,
        actuators.last,
        actuators.wanted,
        step,
        actuators.swing,
        actuators.rest,
        talk.bits,
        actuators.packed,
    )
    if not felt and now_ns - talk.felt_ns >= talk.idle_ns:
        return SOMETHING_ELSE
    put_number(actuators.body, _FRAME_AT, _FRAME_WIDTH, talk.sequence + 1)
    size = enframe(actuators.body, actuators.body.size - CRC_BYTES, out, 0)
    if size < 0:
        return SOMETHING_ELSE
    if felt:
        talk.felt_ns = now_ns
    talk.sent_ns = talk.acknowledged_ns = NEVER
    return size


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def unsent(talk):
    """Note that there was no room for the FRAME made last: its sequence counts all the same."""
    talk.sequence = (talk.sequence + 1) & _FRAME_MASK


@njit(cache=keep_compiled(), error_model="numpy", nogil=True)
def sent(now_ns, talk, actuators):
    """Note that the FRAME made last has gone out, or a part of it whose rest will follow.

    Parameters
    ----------
    now_ns : int64
        Time at which the FRAME was made, by the host's clock.
    talk : record of CONVERSATION
        The conversation's numbers.
    actuators : Actuators
        How FRAMEs are made; the actuators go where the FRAME says.
    """
    talk.sequence = (talk.sequence + 1) & _FRAME_MASK
    talk.sent_ns = talk.owed_ns = talk.moved_ns = now_ns
    rows, columns = actuators.wanted.shape
    for row in range(rows):
        for column in range(columns):
            actuators.last[row, column] = actuators.wanted[row, column]


class Actuators(NamedTuple):
    """State from which FRAMEs are made, and the last of them.

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


# Some ticks bring some hundred bytes; this leaves room for a stall.
RECEIVED_BYTES: Final = 8192


class SteadyConversation:
    """The numbers of a conversation for compiled code, in memory that is the same each time.

    Attributes
    ----------
    descriptor : int
        Descriptor of the device's open line, which does not block.
    begun : int
        Number of bytes at the beginning of `received`: a part of a message.
    talk : CONVERSATION[1]
        Numbers of the conversation.
    received : uint8[RECEIVED_BYTES]
        Bytes that were received and not consumed, at the beginning of the array.
    work, out : uint8[bytes]
        Room to work in, and room for a FRAME as it goes over the line.
    actuators : Actuators
        How FRAMEs are made; set once numbers were taken.
    """

    actuators: Actuators

    def __init__(self) -> None:
        self.descriptor, self.begun = -1, 0
        self.talk = np.zeros(1, CONVERSATION)
        self.received = np.zeros(RECEIVED_BYTES, np.uint8)
        self.work = np.zeros(WORK_BYTES, np.uint8)
        self.out = np.zeros(0, np.uint8)
        self._drive: Drive | None = None
        self._body = self._packed = self.out

    def take_from(self, conversation: Conversation) -> bool:
        """Take over the numbers of a conversation, and the part of a message that has come.

        Returns
        -------
        bool
            False, with nothing taken, if the conversation is in a state that compiled code does
            not handle.
        """
        states, frames, place, time = (
            conversation.states,
            conversation.frames,
            conversation.place,
            conversation.time,
        )
        ready = conversation.steady and place.known and not conversation.trips.tripped
        if not ready or states.sequence is None or time.us is None:
            return False
        begun = conversation.decoder.take_begun()
        if begun is None or len(begun) > WORK_BYTES:
            conversation.decoder.feed(begun or b"")
            return False
        drive = conversation.drive
        if drive is not self._drive:
            self._fit(drive)
        self.actuators = Actuators(
            drive.last, drive.wanted, drive.swing, drive.rest_level, self._body, self._packed
        )
        talk = self.talk[0]
        talk["heard_ns"], talk["state_sequence"] = states.heard_ns, states.sequence
        talk["missed"] = states.missed
        _fill_controls(talk, conversation)
        _fill_place(talk, place)
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
        self.begun = len(begun)
        return True

    def give_to(self, conversation: Conversation) -> None:
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


def _fill_controls(talk: np.void, conversation: Conversation) -> None:
    """Fill in the buttons and knobs."""
    controls = conversation.controls
    talk["buttons"], talk["button_mask"] = controls.buttons or 0, (1 << controls.buttons_fitted) - 1
    talk["knobs"], talk["knobs_fitted"] = controls.knobs or 0, controls.knobs_fitted


def _fill_place(talk: np.void, place: CarriagePlace) -> None:
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


def example(display: Display) -> SteadyConversation:
    """Example of a steady conversation, to load compiled code with before a device is open.

    Nothing can be done with it, since its descriptor is that of no line.
    """
    shape = display.shape
    zeros = np.zeros(shape)
    body = np.zeros(CRC_BYTES, np.uint8)
    made = SteadyConversation()
    made.actuators = Actuators(zeros, zeros, zeros, np.zeros(shape, np.int64), body, body)
    return made


def _or_never(time_ns: int | None) -> int:
    return NEVER if time_ns is None else time_ns


def _or_none(time_ns: NDArray[np.int64]) -> int | None:
    return None if time_ns == NEVER else int(time_ns)
