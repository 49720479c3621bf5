"""Bytes of a Dot Pad: packets, what its board says of itself, and its keys. No port, no time.

A packet is AA 55, the length of all that follows (two bytes, the high one first), a destination
(0 for the device, otherwise a line of pins), a command (two bytes, the high one first), a
sequence number, what the command carries, and the checksum: A5 and every byte since the
destination, combined by exclusive or.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from enum import IntEnum
from functools import reduce
from operator import xor
from typing import TYPE_CHECKING, Final

from vbraille.conventional.messages import KeyPressed

if TYPE_CHECKING:
    from collections.abc import Iterator

BAUD: Final = 115_200
_SYNC: Final = b"\xaa\x55"
_HEAD: Final = struct.Struct(">BHB")  # destination, command, sequence number
_LENGTH: Final = struct.Struct(">H")
_BEFORE: Final = len(_SYNC) + _LENGTH.size
_SHORTEST: Final = _HEAD.size + 1
_LONGEST: Final = _SHORTEST + 256  # no packet that is known carries more
_CHECKSUM: Final = 0xA5
_BOARD: Final = struct.Struct("4B4B4B")
_GRAPHIC, _TEXT = 0x80, 0x40  # features
_EIGHT_DOTS: Final = 1


class DotPadCommand(IntEnum):
    """Command of a packet that is sent or understood."""

    ASK_NAME = 0x0100
    TELL_NAME = 0x0101
    ASK_BOARD = 0x0110
    TELL_BOARD = 0x0111
    SHOW_LINE = 0x0200
    LINE_TAKEN = 0x0201  # carries 0, or why it was not taken
    LINE_STANDS = 0x0202
    SCROLL_KEYS = 0x0302
    PERKINS_KEYS = 0x0312
    ROUTING_KEYS = 0x0322
    FUNCTION_KEYS = 0x0332
    REFUSED = 0x9902


# Names of keys as BRLTTY has them, by their numbers.
_PERKINS: Final = {
    13: "FWINLT",
    14: "FWINRT",
    16: "HOME",
    17: "LNUP",
    18: "FWINRT",
    19: "LNDN",
    20: "FWINLT",
}
_SCROLL: Final = {28: "FWINRT", 29: "FWINLT", 30: "FWINRT", 31: "FWINLT"}
_FUNCTION: Final = {0: "LNUP", 1: "F2", 2: "F3", 3: "LNDN"}
_NAMES: Final = {
    DotPadCommand.SCROLL_KEYS: _SCROLL,
    DotPadCommand.PERKINS_KEYS: _PERKINS,
    DotPadCommand.FUNCTION_KEYS: _FUNCTION,
}


@dataclass(frozen=True, slots=True)
class DotPadPacket:
    """A packet.

    Parameters
    ----------
    command
        What it asks or tells: one of `DotPadCommand`, or a number that is not known.
    content
        What it carries.
    destination
        Line of pins that it is for, or comes from; 0 where there is none.
    """

    command: int
    content: bytes = b""
    destination: int = 0


@dataclass(frozen=True, slots=True)
class DotPadArea:
    """An area of pins.

    Parameters
    ----------
    first
        Destination of its first line; the others follow.
    rows, columns
        Number of its lines, and of cells of two columns of pins in each.
    refresh_s
        Time in which it brings a line up, in s.
    """

    first: int
    rows: int
    columns: int
    refresh_s: float


@dataclass(frozen=True, slots=True)
class DotPadBoard:
    """What a Dot Pad says of itself.

    Parameters
    ----------
    text, graphic
        The area of text and that of pins; None where it has none.
    cell_height
        Rows of pins in a line: 3 or 4.
    """

    text: DotPadArea | None
    graphic: DotPadArea | None
    cell_height: int


def encode_packet(packet: DotPadPacket) -> bytes:
    """Bytes of a packet.

    >>> encode_packet(DotPadPacket(DotPadCommand.ASK_BOARD)).hex(" ")
    'aa 55 00 05 00 01 10 00 b4'
    """
    body = _HEAD.pack(packet.destination, packet.command, 0) + packet.content
    return _SYNC + _LENGTH.pack(len(body) + 1) + body + bytes([_checksum(body)])


def decode_packets(received: bytes) -> tuple[list[DotPadPacket], bytes]:
    """Packets of what was received, and what of it may be the beginning of another.

    What is no packet, or has another checksum than it says, is passed over.
    """
    packets: list[DotPadPacket] = []
    while True:
        start = received.find(_SYNC)
        if start < 0:
            # The last byte may be the first of the next packet.
            return packets, received[-1:] if received.endswith(_SYNC[:1]) else b""
        received = received[start:]
        if len(received) < _BEFORE:
            return packets, received
        (length,) = _LENGTH.unpack_from(received, len(_SYNC))
        if not _SHORTEST <= length <= _LONGEST:
            received = received[1:]
            continue
        if len(received) < _BEFORE + length:
            return packets, received
        body = received[_BEFORE : _BEFORE + length]
        if _checksum(body[:-1]) != body[-1]:
            received = received[1:]
            continue
        destination, command, _ = _HEAD.unpack_from(body)
        packets.append(DotPadPacket(command, body[_HEAD.size : -1], destination))
        received = received[_BEFORE + length :]


def board_of(content: bytes) -> DotPadBoard | None:
    """Board of what `TELL_BOARD` carries; None if it says of no pins, or is too short."""
    if len(content) < _BOARD.size:
        return None
    features, dots, _, _, *areas = _BOARD.unpack_from(content)
    text = graphic = None
    rows, columns, _, refresh = areas[:4]
    if features & _TEXT and rows * columns:
        text = DotPadArea(0, rows, columns, refresh / 10)
    rows, columns, _, refresh = areas[4:]
    if features & _GRAPHIC and rows * columns:
        # Lines of pins follow those of text; without text they begin with 1.
        graphic = DotPadArea(text.rows if text else 1, rows, columns, refresh / 10)
    if text is None and graphic is None:
        return None
    return DotPadBoard(text, graphic, 4 if dots == _EIGHT_DOTS else 3)


def keys_down(content: bytes) -> frozenset[int]:
    """Numbers of the keys that a packet of keys says are down; the highest bit is the first key.

    >>> sorted(keys_down(bytes([0x80, 0x05])))
    [0, 13, 15]
    """
    return frozenset(
        8 * place + bit
        for place, byte in enumerate(content)
        for bit in range(8)
        if byte & 0x80 >> bit
    )


def keys_named(command: int, numbers: frozenset[int]) -> Iterator[KeyPressed]:
    """Keys as the reader knows them; those of the braille keyboard, which has none, are left out.

    Parameters
    ----------
    command
        Command of the packet, which says of which keys it tells.
    numbers
        Numbers of the keys.
    """
    if command == DotPadCommand.ROUTING_KEYS:
        yield from (KeyPressed("ROUTE", number) for number in sorted(numbers))
        return
    names = _NAMES.get(DotPadCommand(command), {})
    yield from (KeyPressed(names[number]) for number in sorted(numbers) if number in names)


def is_keys(command: int) -> bool:
    """Whether a packet with the command tells which keys are down."""
    return command == DotPadCommand.ROUTING_KEYS or command in _NAMES


def _checksum(body: bytes) -> int:
    return reduce(xor, body, _CHECKSUM)
