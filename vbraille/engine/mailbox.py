"""What the loop is to show, in memory that another process writes.

One side posts, the other looks each tick; neither waits for the other. Programs
go into two slots in turn, each with a checksum: one that is in the writing, or
seen in the wrong order, is left for the next tick.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple
from zlib import crc32

import numpy as np

from vbraille.render.program import Program

if TYPE_CHECKING:
    from numpy.typing import NDArray

_PUBLISHED, _PAUSED, _ZEROED, _STOPPED = range(4)
_HEADER_BYTES = 64
# The words of 8 bytes that a slot begins with; the program's numbers and its table follow.
_CHECKSUM, _NUMBER, _LINE, _NUMBERS, _WORDS = range(5)
_SLOT_WORDS = 5


class Posted(NamedTuple):
    """A picture that was taken from the mailbox, in memory of its own.

    Parameters
    ----------
    number
        Number of pictures that had been posted, this one included.
    line
        Number by which records call the picture.
    program
        Compiled picture.
    """

    number: int
    line: int
    program: Program


class Mailbox:
    """Pictures and orders for a loop.

    Parameters
    ----------
    buffer
        Shared memory of `bytes_needed`, zeroed.
    room
        Bytes of the largest program; see `Program.nbytes`.
    """

    def __init__(self, buffer: memoryview, room: int) -> None:
        # A memoryview, since looking at a numpy array takes three times as long.
        self._words = buffer[:_HEADER_BYTES].cast("q")
        # The same words as an array: compiled code compares them with those last obeyed.
        self.orders = np.frombuffer(buffer, np.int64, _HEADER_BYTES // 8)
        self.obeyed = np.zeros(self.orders.size, np.int64)
        slot_bytes = _slot_bytes(room)
        starts = (_HEADER_BYTES, _HEADER_BYTES + slot_bytes)
        self._slots = [np.frombuffer(buffer, np.uint8, slot_bytes, start) for start in starts]
        self._room = slot_bytes - _SLOT_WORDS * 8

    @staticmethod
    def bytes_needed(room: int) -> int:
        """Size of the buffer, a multiple of 8."""
        return _HEADER_BYTES + 2 * _slot_bytes(room)

    @property
    def published(self) -> int:
        """Number of the last picture posted; 0 before the first."""
        return self._words[_PUBLISHED]

    def post(self, program: Program, line: int) -> None:
        """Post a picture, under the number that records call it by.

        Raises
        ------
        ValueError
            If the picture is larger than the mailbox was made for.
        """
        if program.nbytes > self._room:
            raise ValueError(
                f"a picture of {program.nbytes} bytes does not go into {self._room} bytes"
            )
        number = self.published + 1
        slot = self._slots[number % 2]
        words = slot[: _SLOT_WORDS * 8].view(np.int64)
        words[_NUMBER], words[_LINE] = number, line
        words[_NUMBERS], words[_WORDS] = program.numbers.size, program.table.size
        numbers, table = _parts(slot, program.numbers.size, program.table.size)
        numbers[:], table[:] = program.numbers, program.table
        words[_CHECKSUM] = _checksum(slot, program.nbytes)
        self._words[_PUBLISHED] = number

    def take(self) -> Posted | None:
        """Copy the last picture posted; None if it is not whole, in which case try again later."""
        number = self.published
        slot = self._slots[number % 2].copy()
        words = slot[: _SLOT_WORDS * 8].view(np.int64)
        numbers, table = int(words[_NUMBERS]), int(words[_WORDS])
        size = numbers * 8 + table * 2
        if words[_NUMBER] != number or numbers < 0 or table < 0 or size > self._room:
            return None
        if words[_CHECKSUM] != _checksum(slot, size):
            return None
        return Posted(number, int(words[_LINE]), Program(*_parts(slot, numbers, table)))

    @property
    def paused(self) -> bool:
        """Whether the array is to rest."""
        return bool(self._words[_PAUSED])

    @paused.setter
    def paused(self, paused: bool) -> None:
        self._words[_PAUSED] = paused

    @property
    def zeroed(self) -> int:
        """How often the reader has said that the carriage is at the left stop."""
        return self._words[_ZEROED]

    def zero(self) -> None:
        """Say that the carriage is at the left stop."""
        self._words[_ZEROED] += 1

    @property
    def stopped(self) -> bool:
        """Whether the loop is to end."""
        return bool(self._words[_STOPPED])

    def stop(self) -> None:
        """Have the loop end."""
        self._words[_STOPPED] = 1


def _slot_bytes(room: int) -> int:
    return _SLOT_WORDS * 8 + -(-room // 8) * 8


def _parts(
    slot: NDArray[np.uint8], numbers: int, table: int
) -> tuple[NDArray[np.float64], NDArray[np.uint16]]:
    """Views of a slot that hold the numbers and the table of its program."""
    start = _SLOT_WORDS * 8
    middle = start + numbers * 8
    return slot[start:middle].view(np.float64), slot[middle : middle + table * 2].view(np.uint16)


def _checksum(slot: NDArray[np.uint8], size: int) -> int:
    """Checksum of all that a slot holds but the checksum; the program has so many bytes."""
    return crc32(slot[8 : _SLOT_WORDS * 8 + size].data)
