"""The Latero's datagrams: big-endian, without gaps; each request of 100 bytes has one answer.

docs/latero.md has the table. Both ends are here: the client packs requests and unpacks answers,
and the simulated Latero the other way round.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from enum import Enum
from typing import Final, NamedTuple

PORT: Final = 8900
MAGIC: Final = 0xCA
VERSION: Final = 0x11  # version 1, revision 1
FULL, IO, RAW = 0x01, 0x02, 0x03
FULLR0, FULLR1, RAWR = 0x81, 0x82, 0x83
REQUEST_BYTES: Final = 100
BLADES: Final = 64
BLADES_AT: Final = 15  # index of blade 0 in a FULL; blade 8 · row + column follows
REST: Final = 150  # a blade at the right; 0 is at the left, in full deflection
DIO_OUT: Final = 0x1000  # one light is on, as the author's client has it
# Buttons in dio_in, whose bits are 0 while they are pressed: the left one, and the right one.
BUTTONS: Final = (0x0040, 0x0020)
NO_BUTTON: Final = 0x0060
# Bits of the controller's word, and of that of its I/O interface, which is 0 if that is away.
PAGE, POWERED_OFF, POWERED_ON = 0x0001, 0x0002, 0x0004
ENCODER_ERRORS: Final = 0x000F
NO_IO: Final = 0x0000
# Commands of RAW.
READ, WRITE = 0x01, 0x02
CONTROLLER = 0x10  # which of the two boards

_HEAD: Final = struct.Struct(">BBBH")
_FULL: Final = struct.Struct(">H4H")
_RAW: Final = struct.Struct(">BHH")
_FULLR: Final = struct.Struct(">BBBHHHHIIIIHHHH")
FULLR_BYTES: Final = _FULLR.size
RAWR_BYTES: Final = _HEAD.size + _RAW.size
SEQUENCE_AT: Final = 3


class Foreign(Enum):
    """Kind of a datagram that is no answer of a Latero of this version."""

    OTHER = "no Latero's"
    VERSION = "of another version of the protocol"


class Answer(NamedTuple):
    """An answer to FULL or to IO.

    Parameters
    ----------
    sequence
        Number of the request that is answered.
    dio_in
        Digital inputs; `BUTTONS` are among them.
    controller, interface
        Status words of the controller and of its I/O interface.
    encoders
        Counts of the four encoders, each of 32 bits. Those of the arms, from the root, are
        encoders 2, 1 and 0.
    adc
        Analogue inputs, in steps of 4.096 V / 65536.
    """

    sequence: int
    dio_in: int
    controller: int
    interface: int
    encoders: tuple[int, int, int, int]
    adc: tuple[int, int, int, int] = (0, 0, 0, 0)


class RawAnswer(NamedTuple):
    """An answer to RAW.

    Parameters
    ----------
    sequence
        Number of the request that is answered.
    command, address, data
        Command and register that the request named, and the register's content.
    """

    sequence: int
    command: int
    address: int
    data: int


@dataclass(frozen=True, slots=True)
class LateroRequest:
    """A request, as the device gets it.

    Parameters
    ----------
    kind
        FULL, IO or RAW.
    sequence
        Number of the request; the author's client never sets it.
    blades
        Levels of the 64 blades, of FULL.
    command, address, data
        What a RAW does, to which register, and what it writes.
    """

    kind: int
    sequence: int
    blades: bytes = b""
    command: int = 0
    address: int = 0
    data: int = 0


def blank(kind: int) -> bytearray:
    """Request of a kind without contents: its head with the number 0, and padding."""
    request = bytearray(b"\xff" * REQUEST_BYTES)
    _HEAD.pack_into(request, 0, MAGIC, VERSION, kind, 0)
    return request


def full_request() -> bytearray:
    """FULL with all blades at rest; number and blades are changed in place from then on."""
    request = blank(FULL)
    _FULL.pack_into(request, _HEAD.size, DIO_OUT, 0, 0, 0, 0)
    request[BLADES_AT : BLADES_AT + BLADES] = bytes((REST,)) * BLADES
    return request


def number(request: bytearray, sequence: int) -> None:
    """Give a request its number."""
    request[SEQUENCE_AT : SEQUENCE_AT + 2] = sequence.to_bytes(2, "big")


def raw_request(command: int, address: int, data: int = 0) -> bytearray:
    """RAW that reads or writes a register."""
    request = blank(RAW)
    _RAW.pack_into(request, _HEAD.size, command, address, data)
    return request


def parse_answer(datagram: bytes | bytearray | memoryview) -> Answer | RawAnswer | Foreign:
    """Answer that a datagram is, or what it is instead."""
    size = len(datagram)
    if size < _HEAD.size or datagram[0] != MAGIC:
        return Foreign.OTHER
    _, version, kind, sequence = _HEAD.unpack_from(datagram)
    if version != VERSION:
        return Foreign.VERSION
    if size == FULLR_BYTES and kind in (FULLR0, FULLR1):
        words = _FULLR.unpack(datagram)[4:]
        return Answer(sequence, *words[:3], words[3:7], words[7:])  # pyright: ignore
    if size == RAWR_BYTES and kind == RAWR:
        return RawAnswer(sequence, *_RAW.unpack_from(datagram, _HEAD.size))
    return Foreign.OTHER


def parse_request(datagram: bytes) -> LateroRequest | None:
    """Request that a datagram is; None if it is none."""
    if len(datagram) != REQUEST_BYTES:
        return None
    magic, version, kind, sequence = _HEAD.unpack_from(datagram)
    if magic != MAGIC or version != VERSION:
        return None
    if kind == RAW:
        command, address, content = _RAW.unpack_from(datagram, _HEAD.size)
        return LateroRequest(kind, sequence, command=command, address=address, data=content)
    if kind not in (FULL, IO):
        return None
    blades = datagram[BLADES_AT : BLADES_AT + BLADES] if kind == FULL else b""
    return LateroRequest(kind, sequence, blades)


def pack_answer(answer: Answer, kind: int) -> bytes:
    """Datagram of an answer, FULLR0 or FULLR1."""
    return _FULLR.pack(MAGIC, VERSION, kind, *answer[:4], *answer.encoders, *answer.adc)


def pack_raw_answer(answer: RawAnswer) -> bytes:
    """Datagram of an answer to RAW."""
    return _HEAD.pack(MAGIC, VERSION, RAWR, answer.sequence) + _RAW.pack(*answer[1:])
