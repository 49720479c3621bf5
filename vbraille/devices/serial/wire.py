"""The serial protocol without I/O: fields, the one table of messages, and their bytes.

A message is a frozen dataclass whose annotations, `Annotated[type, field]`, say what each field may
be and how it goes over the wire. Its checks, its encoding and its decoding all follow from them;
`docs/wire-protocol.md` is the same table for people who write firmware. A body is a message's type
and fields; a frame on the line is body and CRC-32, byte-stuffed by COBS, and a zero byte.

    decoder = Decoder()
    for message in decoder.feed(port.read()):
        ...
    port.write(encode(Hello()))
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from enum import IntEnum, StrEnum
from functools import cache
from struct import Struct
from typing import TYPE_CHECKING, Annotated, Any, Final, Protocol, get_args, get_type_hints
from zlib import crc32

import numpy as np
from cobs import cobs

from vbraille.devices.events import SERIAL_VERSION

if TYPE_CHECKING:
    from numpy.typing import NDArray


class WrongLengthError(ValueError):
    """Error of bytes that are fewer than they must be, or more than they may be."""


class Field(Protocol):
    """Form of one field of a message on the wire."""

    def check(self, name: str, value: Any, message: Any) -> None:
        """Raise ValueError if the value is out of range, WrongLengthError if its length is."""
        ...

    def pack(self, value: Any) -> bytes:
        """Give the bytes of a checked value."""
        ...

    def unpack(self, body: bytes, at: int, earlier: dict[str, Any]) -> tuple[Any, int]:
        """Give the value that begins at a place of a body, unchecked, and the place after it.

        WrongLengthError if the body ends within the value. `earlier` are the fields before it.
        """
        ...


class Fixed:
    """A field that is packed by one `struct` code, the least significant byte first.

    Attributes
    ----------
    code
        Code that `struct` has for the field.
    """

    __slots__ = ()
    code: str

    @property
    def meanings(self) -> dict[int, Any]:
        """Meanings of those numbers on the wire that mean something else in the message."""
        return {}

    @property
    def layout(self) -> Struct:
        """Layout of the field by itself."""
        return Struct("<" + self.code)

    def pack(self, value: Any) -> bytes:
        """Give the bytes of a checked value."""
        return self.layout.pack(to_wire(self.meanings).get(value, value))

    def unpack(self, body: bytes, at: int, _earlier: dict[str, Any]) -> tuple[Any, int]:
        """Give the value, and the place after it."""
        end = at + self.layout.size
        if end > len(body):
            raise WrongLengthError
        (raw,) = self.layout.unpack_from(body, at)
        return self.meanings.get(raw, raw), end


def to_wire(meanings: dict[int, Any]) -> dict[Any, int]:
    """Inverse of `Fixed.meanings`: numbers on the wire by what the message has."""
    return {value: raw for raw, value in meanings.items()}


@dataclass(frozen=True, slots=True)
class Number(Fixed):
    """An integer from `low` to `high`; it may be None if `none` stands for that on the wire."""

    code: str
    low: int
    high: int
    unit: str = ""
    none: int | None = None  # a number out of the range

    @property
    def meanings(self) -> dict[int, Any]:
        """Meaning of the number `none`, which is None."""
        return {} if self.none is None else {self.none: None}

    def check(self, name: str, value: int | None, _message: Any) -> None:
        """Check that the value is from `low` to `high`, or None where that can be told."""
        if value is None and self.none is not None:
            return
        if value is None or not self.low <= value <= self.high:
            unit = f" {self.unit}" if self.unit else ""
            raise ValueError(f"{name} is {value}; it must be {self.low} to {self.high}{unit}")


@dataclass(frozen=True, slots=True)
class OneOf(Fixed):
    """One of the numbers of an enumeration."""

    code: str
    of: type[IntEnum]

    @property
    def meanings(self) -> dict[int, Any]:
        """Each number means its member; an unknown one stays a number, so that `check` names it."""
        return {int(choice): choice for choice in self.of}

    def check(self, name: str, value: int, _message: Any) -> None:
        """Check that the value is one of the numbers."""
        if value not in list(self.of):
            names = ", ".join(f"{choice.value} ({choice.name})" for choice in self.of)
            raise ValueError(f"{name} is {value}; it must be one of {names}")


@dataclass(frozen=True, slots=True)
class ShortText:
    """A byte with a length in bytes, then so many bytes of printable UTF-8.

    Bytes that are no UTF-8 and characters that are not printable are read as U+FFFD, so that
    the rest of what a device says is not lost.
    """

    fewest: int
    most: int = 0xFF

    def check(self, name: str, value: str, _message: Any) -> None:
        """Check that the text is printable, and of a length that is allowed."""
        if not value.isprintable() or (self.fewest and not value.strip()):
            raise ValueError(f"{name} is {value!r}; it must be printable, and not blank")
        if not self.fewest <= len(value.encode()) <= self.most:
            raise ValueError(f"{name} is {value!r}; it must be {self.fewest} to {self.most} bytes")

    def pack(self, value: str) -> bytes:
        """Give the length of the text, then the text."""
        text = value.encode()
        return bytes((len(text),)) + text

    def unpack(self, body: bytes, at: int, _earlier: dict[str, Any]) -> tuple[str, int]:
        """Give the text, and the place after it."""
        if at >= len(body) or len(body) - at - 1 < body[at]:
            raise WrongLengthError
        end = at + 1 + body[at]
        text = body[at + 1 : end].decode(errors="replace")
        return "".join(sign if sign.isprintable() else "\ufffd" for sign in text), end


@dataclass(frozen=True, slots=True)
class PerActuator:
    """A byte from 0 to `high` for each actuator, row by row."""

    high: int
    pack = bytes

    def check(self, name: str, value: bytes, message: Any) -> None:
        """Check that there is a byte for each actuator, from 0 to `high`."""
        actuators = message.rows * message.columns
        if len(value) != actuators:
            raise WrongLengthError(
                f"{name} are {len(value)} bytes; there are {actuators} actuators"
            )
        if max(value) > self.high:
            raise ValueError(f"{name} are up to {max(value)}; they must be 0 to {self.high}")

    def unpack(self, body: bytes, at: int, earlier: dict[str, Any]) -> tuple[bytes, int]:
        """Give as many bytes as the earlier rows and columns tell, or as many as are left."""
        end = at + earlier["rows"] * earlier["columns"]
        return body[at:end], end


@dataclass(frozen=True, slots=True)
class Packed:
    """All bytes up to the message's end, 1 to `most`; no field can come after them."""

    most: int
    pack = bytes

    def check(self, name: str, value: bytes, _message: Any) -> None:
        """Check that there are 1 to `most` bytes."""
        if not 1 <= len(value) <= self.most:
            raise WrongLengthError(f"{name} are {len(value)} bytes; they must be 1 to {self.most}")

    def unpack(self, body: bytes, at: int, _earlier: dict[str, Any]) -> tuple[bytes, int]:
        """Give all bytes that are left."""
        return body[at:], len(body)


class Message:
    """A message, which checks itself: ValueError names the field and its range."""

    __slots__ = ()

    def __post_init__(self) -> None:
        for name, field in fields_of(type(self)):
            field.check(name, getattr(self, name), self)


@cache
def fields_of(message: type[Message]) -> tuple[tuple[str, Field], ...]:
    """Fields of a message in the wire's order, by their names."""
    hints = get_type_hints(message, include_extras=True)
    return tuple((name, get_args(hint)[1]) for name, hint in hints.items())


def head_of(message: type[Message]) -> list[Fixed]:
    """The fixed fields that a message begins with, up to the first of another kind."""
    head: list[Fixed] = []
    for _, field in fields_of(message):
        if not isinstance(field, Fixed):
            break
        head.append(field)
    return head


def places_of(message: type[Message]) -> tuple[tuple[int, int, bool], ...]:
    """Places of the numbers that a message begins with: first byte, width, whether it is signed.

    The list ends at the first field whose width is not fixed, since later places may vary.
    """
    places = []
    at = 1  # the first byte is the type
    for field in head_of(message):
        width = field.layout.size
        places.append((at, width, field.code.islower()))
        at += width
    return tuple(places)


VERSION: Final = SERIAL_VERSION

# A device without a valid FRAME for so long begins a ramp to rest, which takes so long.
WATCHDOG_MS: Final = 50
RAMP_MS: Final = 20
# A host that has sent no FRAME for so long takes it that the watchdog trips meanwhile: the device
# counts from when a FRAME arrives, and FRAMEs may be late by some milliseconds.
STALL_MS: Final = 40
# A host asks HELLO so often, and gives a device so long to answer (boards restart when opened).
HELLO_PERIOD_MS: Final = 250
ANSWER_MS: Final = 3000
# A host without a STATE for so long sends REST; for so long, begins again with HELLO.
SILENCE_MS: Final = 100
LOST_MS: Final = 500

# Error.code from here on is a notice.
NOTICES: Final = 0x80
# Bits of State.flags.
PLACED: Final = 0x01
RESTING: Final = 0x02
FAULTY: Final = 0x04
TRIPPED: Final = 0x08
# A device that is at rest leaves it by no more than this part of the swing at once.
FIRST_STEP: Final = 20
# It goes so many FRAMEs far in a period, and is so many behind with the one that ends a rest.
PACE: Final = 2
OUT_OF_REST: Final = 5

U8: Final = Number("B", 0, 0xFF)
U16: Final = Number("H", 0, 0xFFFF)
U32: Final = Number("I", 0, 0xFFFF_FFFF)
MICROSECONDS: Final = Number("I", 0, 0xFFFF_FFFF, "µs")
FORCE: Final = Number("h", -0x7FFF, 0x7FFF, "mN", none=-0x8000)
PITCH: Final = Number("I", 50_000, 50_000_000, "nm")
CONTACTOR: Final = Number("I", 0, 50_000_000, "nm")
# Room for buttons and knobs in STATE; the position of a knob is a byte.
MOST_BUTTONS: Final = 8
MOST_KNOBS: Final = 4
KNOB_TOP: Final = 0xFF
# A knob that stands still may jitter by less than this, and is not told to have been turned.
KNOB_STEP: Final = 3


class RestSide(IntEnum):
    """Side at which an actuator at deflection 0 stands."""

    LEFT = 0
    RIGHT = 1


class Encoder(IntEnum):
    """Knowledge that an encoder has of its place when it is switched on."""

    ABSOLUTE = 0  # all
    INDEX = 1  # nothing until it has passed its index mark
    INCREMENTAL = 2  # nothing until the reader has shown it the left stop


class CountSign(IntEnum):
    """Direction in which counts grow."""

    RIGHTWARD = 1
    LEFTWARD = -1


class TurnSign(IntEnum):
    """Direction in which the array turns when its counts grow, as the reader sees it."""

    ANTICLOCKWISE = 1
    CLOCKWISE = -1


class YCountSign(IntEnum):
    """Direction of the carriage when the counts of y grow: towards the reader, or away."""

    TOWARDS = 1
    AWAY = -1


class ErrorCode(IntEnum):
    """Complaints of a device; it rests, but with a code from `NOTICES` on it goes on."""

    ENCODER = 1
    ACTUATORS = 2
    TEMPERATURE = 3
    OTHER = 127
    NOTICE = 255


@dataclass(frozen=True, slots=True)
class Hello(Message):
    """Host: who are you? The device rests, and answers INFO and WATCHDOG."""

    version: Annotated[int, Number("B", 1, 0xFF)] = VERSION


@dataclass(frozen=True, slots=True)
class Frame(Message):
    """Host: a level for every actuator, as `wire.Levels` packs them."""

    sequence: Annotated[int, U16]
    packed: Annotated[bytes, Packed(most=2048)]


@dataclass(frozen=True, slots=True)
class Rest(Message):
    """Host: all actuators to rest, until the next FRAME."""


@dataclass(frozen=True, slots=True)
class Info(Message):
    """Device: a description of itself. Row 0 is far from the reader, column 0 is the left one.

    A level of 0 is rest and `top_level` is full swing, or the other way round
    where `inverted` is 1. `left_stop_count` has no meaning where the encoder is
    incremental; a `largest_slew_per_s` of 0 is no limit. A contactor of 0 × 0 is one whose size is
    not known, a `height_um` of 0 a carriage of one axis, and `counts_per_turn` is 0 where no angle
    is measured. Fields of an axis that is not there have no meaning.
    """

    version: Annotated[int, Number("B", VERSION, VERSION)]
    rows: Annotated[int, Number("B", 1, 16)]
    columns: Annotated[int, Number("B", 1, 64)]
    column_pitch_nm: Annotated[int, PITCH]
    row_pitch_nm: Annotated[int, PITCH]
    rest_side: Annotated[RestSide, OneOf("B", RestSide)]
    top_level: Annotated[int, Number("H", 1, 0xFFFF)]
    rate_hz: Annotated[int, Number("H", 50, 10_000, "Hz")]
    largest_slew_per_s: Annotated[int, Number("H", 0, 0xFFFF, "swings/s")]
    travel_um: Annotated[int, Number("I", 1, 10_000_000, "µm")]
    encoder: Annotated[Encoder, OneOf("B", Encoder)]
    counts_per_m: Annotated[int, Number("I", 1, 0xFFFF_FFFF, "1/m")]
    count_sign: Annotated[CountSign, OneOf("b", CountSign)]
    count_bits: Annotated[int, Number("B", 8, 32, "bits")]
    left_stop_count: Annotated[int, U32]
    name: Annotated[str, ShortText(fewest=1)]
    firmware: Annotated[str, ShortText(fewest=0)]
    inverted: Annotated[bytes, PerActuator(high=1)]
    gain: Annotated[bytes, PerActuator(high=0xFF)]
    enabled: Annotated[bytes, PerActuator(high=1)]
    buttons: Annotated[int, Number("B", 0, MOST_BUTTONS)]
    knobs: Annotated[int, Number("B", 0, MOST_KNOBS)]
    contactor_width_nm: Annotated[int, CONTACTOR]
    contactor_height_nm: Annotated[int, CONTACTOR]
    height_um: Annotated[int, Number("I", 0, 10_000_000, "µm")]
    y_counts_per_m: Annotated[int, Number("I", 0, 0xFFFF_FFFF, "1/m")]
    y_count_sign: Annotated[YCountSign, OneOf("b", YCountSign)]
    far_stop_count: Annotated[int, U32]
    counts_per_turn: Annotated[int, U32]
    turn_sign: Annotated[TurnSign, OneOf("b", TurnSign)]
    straight_count: Annotated[int, U32]


@dataclass(frozen=True, slots=True)
class State(Message):
    """Device: where its carriage is, and what else it feels; `rate_hz` a second.

    The knobs are a byte each, that of knob 1 the lowest.
    """

    sequence: Annotated[int, U16]
    time_us: Annotated[int, MICROSECONDS]
    count: Annotated[int, U32]
    frame_sequence: Annotated[int, U16]
    flags: Annotated[int, U8]
    buttons: Annotated[int, U8]
    force_mn: Annotated[int | None, FORCE]
    y_count: Annotated[int, U32]
    theta_count: Annotated[int, U32]
    knobs: Annotated[int, U32]

    @property
    def placed(self) -> bool:
        """Tell whether counts say where the carriage is without the reader's help."""
        return bool(self.flags & PLACED)

    @property
    def resting(self) -> bool:
        """Tell whether the actuators are at rest, or on their way to it."""
        return bool(self.flags & RESTING)

    @property
    def faulty(self) -> bool:
        """Tell whether the device takes no FRAME until the next HELLO."""
        return bool(self.flags & FAULTY)

    @property
    def tripped(self) -> bool:
        """Tell whether the watchdog has tripped and no FRAME was taken since."""
        return bool(self.flags & TRIPPED)


@dataclass(frozen=True, slots=True)
class Watchdog(Message):
    """Device: how often its watchdog tripped, and how many frames it dropped, since it started."""

    trips: Annotated[int, U32]
    dropped: Annotated[int, U32]


@dataclass(frozen=True, slots=True)
class Error(Message):
    """Device: what is wrong with it; `ErrorCode`, or a code of its maker's own."""

    code: Annotated[int, U8]
    text: Annotated[str, ShortText(fewest=0)]


# Types from 0x80 on are a device's. INFO has one type in all versions.
MESSAGES: Final[dict[int, type[Message]]] = {
    0x01: Hello,
    0x02: Frame,
    0x03: Rest,
    0x81: Info,
    0x83: Watchdog,
    0x84: Error,
    0x85: State,
}


DELIMITER: Final = b"\0"
# On the line, without the delimiter. The largest INFO, of 16 × 64 actuators, fits.
MOST_FRAME_BYTES: Final = 4096
CRC_BYTES: Final = 4
# What the CRC-32 of anything followed by its own CRC-32, least significant byte first, always is.
CRC_RESIDUE: Final = 0x2144DF1C


class Drop(StrEnum):
    """Reasons why bytes could not be used."""

    BAD_COBS = "bad COBS"
    BAD_CRC = "bad CRC"
    TOO_LONG = "too long"
    UNKNOWN_TYPE = "unknown type"
    WRONG_LENGTH = "wrong length"
    OUT_OF_RANGE = "out of range"


@dataclass(frozen=True, slots=True)
class OtherVersion:
    """Answer of a device that speaks another version; the rest of its INFO cannot be read."""

    version: int


Heard = Message | OtherVersion


class BodyCodec:
    """Encoder and decoder of one message's body, both made from its fields."""

    def __init__(self, code: int, message: type[Message]) -> None:
        head = head_of(message)
        names = [name for name, _ in fields_of(message)]
        self.code = code
        self.message = message
        # The fixed fields at the beginning are packed in one call.
        self._head = names[: len(head)]
        self._struct = struct.Struct("<B" + "".join(field.code for field in head))
        self._meanings = [(i, field.meanings) for i, field in enumerate(head) if field.meanings]
        self._to_wire = [(i, to_wire(meanings)) for i, meanings in self._meanings]
        self._rest = fields_of(message)[len(head) :]

    def encode(self, message: Message) -> bytes:
        """Give the body of a message: its type and its fields.

        Raises
        ------
        ValueError
            If a value is not an integer; the message has checked its range.
        """
        values = [getattr(message, name) for name in self._head]
        for i, raw in self._to_wire:
            values[i] = raw.get(values[i], values[i])
        try:
            body = self.pack_head(*values)
        except struct.error as fault:
            raise ValueError(f"{message} cannot be encoded: {fault}") from fault
        for name, field in self._rest:
            body += field.pack(getattr(message, name))
        return body

    def pack_head(self, *values: int) -> bytes:
        """Give the type and the fixed fields, as they are on the wire."""
        return self._struct.pack(self.code, *values)

    def decode(self, body: bytes) -> Message:
        """Give the message of a body; bytes that a later version appended are ignored.

        Raises
        ------
        WrongLengthError
            If the body ends too soon.
        ValueError
            If a field is out of range.
        """
        at = self._struct.size
        if len(body) < at:
            raise WrongLengthError
        _, *values = self._struct.unpack_from(body)
        for i, meaning in self._meanings:
            values[i] = meaning.get(values[i], values[i])
        known = dict(zip(self._head, values, strict=True))
        try:
            for name, field in self._rest:
                known[name], at = field.unpack(body, at, known)
        except WrongLengthError:
            # A number that cannot be, such as 200 rows, explains a length that cannot be.
            for name, field in fields_of(self.message)[: len(self._head)]:
                field.check(name, known[name], None)
            raise
        return self.message(**known)


_CODECS = {code: BodyCodec(code, message) for code, message in MESSAGES.items()}
_CODEC_OF = {codec.message: codec for codec in _CODECS.values()}
_INFO, _FRAME = _CODEC_OF[Info], _CODEC_OF[Frame]


def encode(message: Message) -> bytes:
    """Frame of a message, as it goes over the line, with its delimiter."""
    return enframe(_CODEC_OF[type(message)].encode(message))


def frame_head(sequence: int) -> bytes:
    """Body of a FRAME without its levels, for those who send a thousand a second."""
    return _FRAME.pack_head(sequence)


def enframe(body: bytes) -> bytes:
    """Frame of a body: COBS of body and CRC-32, and the delimiter."""
    return cobs.encode(body + crc32(body).to_bytes(CRC_BYTES, "little")) + DELIMITER


def line_bytes(body_bytes: int) -> int:
    """Largest number of bytes that a body of so many bytes takes on the line."""
    stuffed = cobs.max_encoded_length(body_bytes + CRC_BYTES)
    return stuffed + len(DELIMITER)


class Decoder:
    """Messages out of a stream of bytes in chunks of any size.

    No bytes make it raise or wait; it holds at most `MOST_FRAME_BYTES`
    between calls, and is in step again with the first whole frame after a
    delimiter. Both ends use it.

    Attributes
    ----------
    dropped : dict[Drop, int]
        Number of frames that could not be used, by reason.
    bad_info : str
        Why the last INFO that came whole was dropped, with field and value; empty if none was.
    """

    def __init__(self) -> None:
        self.dropped = dict.fromkeys(Drop, 0)
        self.bad_info = ""
        self._held = bytearray()
        self._skipping = False

    def feed(self, chunk: bytes | bytearray | memoryview) -> list[Heard]:
        """Messages that this chunk completes, oldest first."""
        *ended, begun = bytes(chunk).split(DELIMITER)
        events = []
        for piece in ended:
            whole = not (self._held or self._skipping) and len(piece) <= MOST_FRAME_BYTES
            frame = piece if whole else self._end(piece)
            if not frame:
                continue
            event = self._read(frame)
            if isinstance(event, Drop):
                self.dropped[event] += 1
            else:
                events.append(event)
        if begun:
            self._hold(begun)
        return events

    def take_begun(self) -> bytes | None:
        """Part of a frame that has come, which is forgotten; None while a frame is skipped.

        The caller feeds it again, or feeds what has become of it.
        """
        if self._skipping:
            return None
        begun = bytes(self._held)
        self._held.clear()
        return begun

    def _end(self, piece: bytes) -> bytes:
        """Whole frame that ends with a piece; empty if the frame was too long."""
        self._hold(piece)
        frame = b"" if self._skipping else bytes(self._held)
        self._held.clear()
        self._skipping = False
        return frame

    def _hold(self, piece: bytes) -> None:
        if self._skipping:
            return
        if len(self._held) + len(piece) > MOST_FRAME_BYTES:
            self.dropped[Drop.TOO_LONG] += 1
            self._skipping = True
        else:
            self._held += piece

    def _read(self, frame: bytes) -> Heard | Drop:
        try:
            body = cobs.decode(frame)
        except cobs.DecodeError:
            return Drop.BAD_COBS
        if len(body) <= CRC_BYTES or crc32(body) != CRC_RESIDUE:
            return Drop.BAD_CRC
        codec = _CODECS.get(body[0])
        if codec is None:
            return Drop.UNKNOWN_TYPE
        body = body[:-CRC_BYTES]
        if codec is _INFO and len(body) > 1 and body[1] != VERSION:
            return OtherVersion(body[1])
        try:
            return codec.decode(body)
        except WrongLengthError:
            self._mind_info(codec, "it ends before its last field")
            return Drop.WRONG_LENGTH
        except ValueError as fault:
            self._mind_info(codec, str(fault))
            return Drop.OUT_OF_RANGE

    def _mind_info(self, codec: BodyCodec, fault: str) -> None:
        if codec is _INFO:
            self.bad_info = fault


class Levels:
    """Levels of a device's actuators, in as few bits as they need, most significant bit first.

    Parameters
    ----------
    actuators
        Number of actuators, rows · columns.
    top_level
        Highest level, 1 to 65535: 1023 for 10 bits.

    Attributes
    ----------
    bits : int
        Number of bits in a level.
    packed_bytes : int
        Number of bytes that all levels take; bits left over in the last byte are 0.
    """

    def __init__(self, actuators: int, top_level: int) -> None:
        if actuators < 1:
            raise ValueError(f"{actuators} actuators are not possible; there must be 1 or more")
        if not 1 <= top_level <= 0xFFFF:
            raise ValueError(f"top level is {top_level}; it must be 1 to 65535")
        self.actuators = actuators
        self.top_level = top_level
        self.bits = top_level.bit_length()
        self.packed_bytes = -(-actuators * self.bits // 8)

    def unpack(self, packed: bytes) -> NDArray[np.uint16]:
        """Levels that were packed; uint16[actuators].

        Raises
        ------
        WrongLengthError
            If there are too many or too few bytes.
        ValueError
            If a level is above `top_level`.
        """
        if len(packed) != self.packed_bytes:
            raise WrongLengthError(f"levels are {len(packed)} bytes, not {self.packed_bytes}")
        bits = np.unpackbits(np.frombuffer(packed, np.uint8), count=self.actuators * self.bits)
        words = np.zeros((self.actuators, 16), np.uint8)
        words[:, 16 - self.bits :] = bits.reshape(self.actuators, self.bits)
        levels = np.packbits(words.reshape(-1)).view(">u2").astype(np.uint16)
        if levels.max() > self.top_level:
            raise ValueError(f"a level is {levels.max()}; it must be 0 to {self.top_level}")
        return levels


def unwrap(count: int, last: int, bits: int) -> int:
    """Continuous count of a counter that wraps.

    The result is, among all numbers that the counter would show as `count`, the one nearest to
    `last`; if two are equally near, the lower. This serves encoder counts, the device's
    time (32 bits) and sequences (16 bits) alike.

    Parameters
    ----------
    count
        Value that the counter shows; bits above its width are ignored.
    last
        Continuous count at the reading before, any integer. Since then the counter must have
        moved by less than half its range.
    bits
        Width of the counter, at least 1.
    """
    half = 1 << (bits - 1)
    return last + ((count - last + half) & (2 * half - 1)) - half
