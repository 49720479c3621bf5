"""The serial protocol without I/O: messages into bytes, bytes into messages and counted faults.

A body is a message's type and fields; a frame on the line is body and CRC-32,
byte-stuffed by COBS, and a zero byte. `docs/wire-protocol.md` has it all.

    decoder = Decoder()
    for message in decoder.feed(port.read()):
        ...
    port.write(encode(Hello()))
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, Final
from zlib import crc32

import numpy as np
from cobs import cobs

from vbraille.devices.wire.fields import (
    Message,
    WrongLengthError,
    fields_of,
    head_of,
    to_wire,
)
from vbraille.devices.wire.messages import MESSAGES, VERSION, Frame, Info

if TYPE_CHECKING:
    from numpy.typing import NDArray

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
        # A message whose numbers may be all that their bytes can hold is made without a check of
        # their ranges: STATE comes a thousand times a second.
        if not self._rest and all(field.takes_all for field in head):
            self._setters = [getattr(message, name).__set__ for name in names]
        else:
            self._setters = None

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
        if self._setters:
            message = object.__new__(self.message)
            for set_field, value in zip(self._setters, values, strict=True):
                set_field(message, value)
            return message
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

    Parameters
    ----------
    levels
        Levels that a device expects in a FRAME: a FRAME with other levels is dropped. None takes
        FRAMEs of any length.

    Attributes
    ----------
    dropped : dict[Drop, int]
        Number of frames that could not be used, by reason.
    bad_info : str
        Why the last INFO that came whole was dropped, with field and value; empty if none was.
    """

    def __init__(self, levels: Levels | None = None) -> None:
        self.dropped = dict.fromkeys(Drop, 0)
        self.bad_info = ""
        self._levels = levels
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

        Whoever takes it feeds it again, or feeds what has become of it.
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
            message = codec.decode(body)
            if self._levels is not None and isinstance(message, Frame):
                self._levels.check(message.packed)
        except WrongLengthError:
            self._mind_info(codec, "it ends before its last field")
            return Drop.WRONG_LENGTH
        except ValueError as fault:
            self._mind_info(codec, str(fault))
            return Drop.OUT_OF_RANGE
        return message

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

    def pack(self, levels: NDArray[np.integer]) -> bytes:
        """Pack levels for `Frame.packed`.

        Parameters
        ----------
        levels : integer[actuators] or integer[rows, columns]
            Row 0 (far from the reader) comes first, and in each row column 0 (the left one).

        Raises
        ------
        ValueError
            If there are too many or too few levels, or if they are no integers from 0 to
            `top_level`.
        """
        if levels.size != self.actuators or levels.dtype.kind not in "iu":
            raise ValueError(
                f"levels are {levels.size} of {levels.dtype}; "
                f"they must be {self.actuators} integers"
            )
        if _highest(levels) > self.top_level or (levels.dtype.kind == "i" and levels.min() < 0):
            raise ValueError(
                f"levels are {levels.min()} to {levels.max()}; they must be 0 to {self.top_level}"
            )
        words = levels.astype(">u2").reshape(-1).view(np.uint8)
        bits = np.unpackbits(words).reshape(-1, 16)[:, 16 - self.bits :]
        # packbits takes twice as long over an array with gaps as a copy and packbits without.
        return np.packbits(bits.reshape(-1)).tobytes()

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
        if _highest(levels) > self.top_level:
            raise ValueError(f"a level is {levels.max()}; it must be 0 to {self.top_level}")
        return levels

    def check(self, packed: bytes) -> None:
        """Raise what `unpack` raises; nothing is unpacked if every level is a possible one."""
        if len(packed) != self.packed_bytes or self.top_level != (1 << self.bits) - 1:
            self.unpack(packed)


def _highest(levels: NDArray[np.integer]) -> int:
    # The same as levels.max(), in half its time.
    return np.maximum.reduce(levels, axis=None)


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
