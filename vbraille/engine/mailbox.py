"""Programs for the loop to show, in memory that another process writes.

One side posts, the other looks each tick; neither waits for the other. Programs
go into two slots in turn, each with a checksum: one that is in the writing, or
seen in the wrong order, is left for the next tick. A picture may take some MB, of
which a tick has time for a part only: so the loop takes it piece by piece.

A host process and its parent share one piece of memory: a mailbox, and behind it the ring of
records. It is not `multiprocessing.shared_memory`: a process that attaches to that by name destroys
it when it exits. This has no name; a descriptor is inherited.
"""

from __future__ import annotations

import mmap
import os
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vbraille.engine.record import Ring, RingReader
from vbraille.render.program import Program

if TYPE_CHECKING:
    from numpy.typing import NDArray
_PUBLISHED, _PAUSED, _ZEROED, _STOPPED, _SWITCHES = range(5)
_HEADER_BYTES = 64
# The words of 8 bytes that a slot begins with; the program's numbers and its table follow.
_CHECKSUM, _NUMBER, _LINE, _NUMBERS, _WORDS = range(5)
_SLOT_WORDS = 5
# A piece of 512 kB is copied and summed up in some 0.1 ms.
_PIECE_WORDS = 1 << 16
_MODULUS = 1 << 64
# Odd factors, so that the sum of a piece tells of any word that changed, and of words that changed
# places; and a factor by which a sum goes into that of the next piece.
_FACTORS = np.arange(1, 2 * _PIECE_WORDS, 2, dtype=np.uint64) * np.uint64(0x9E3779B97F4A7C15)
_NEXT = 0xD1342543DE82EF95


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


@dataclass(slots=True)
class _Taking:
    """A picture of which some pieces were taken."""

    number: int
    into: NDArray[np.uint64]
    words: int
    taken: int
    checksum: int = field(default=0)


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
        self._slots = [np.frombuffer(buffer, np.uint64, slot_bytes // 8, at) for at in starts]
        self._room = slot_bytes - _SLOT_WORDS * 8
        self._own: list[NDArray[np.uint64]] = []
        self._taking: _Taking | None = None

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
        words = slot[:_SLOT_WORDS].view(np.int64)
        words[_NUMBER], words[_LINE] = number, line
        words[_NUMBERS], words[_WORDS] = program.numbers.size, program.table.size
        size = _words_of(program.numbers.size, program.table.size)
        slot[size - 1] = 0  # the table may fill a part of the last word only
        numbers, table = _parts(slot, program.numbers.size, program.table.size)
        numbers[:], table[:] = program.numbers, program.table
        slot[_CHECKSUM] = _checksum(slot[1:size])
        self._words[_PUBLISHED] = number

    def take(self) -> Posted | None:
        """Copy the last picture posted; None if it is not whole, in which case try again later.

        The picture has memory of its own. This takes as long as the picture is large.
        """
        number = self.published
        slot = self._slots[number % 2]
        size = self._size_of(slot, number)
        if size is None:
            return None
        own = slot[:size].copy()
        return self._whole(own, _checksum(own[1:])) if own[_NUMBER] == number else None

    def keep_room(self) -> None:
        """Have the memory that `take_piece` needs at hand, and that of the slots, too."""
        if not self._own:
            # Memory that is looked at for the first time costs a tick more than what is copied.
            self._own = [slot.copy() for slot in self._slots]

    def take_piece(self) -> Posted | None:
        """Copy a piece of the last picture posted; the picture, if that was the last piece.

        However large the picture is, this takes the time of one piece: call it tick after tick.
        The picture stays whole until the picture after the next is taken.

        Returns
        -------
        Posted or None
            None if more is to come, or the picture is not whole: then try again later.
        """
        self.keep_room()
        taking, published = self._taking, self.published
        # While a slot is read, only the picture after the next one is written into it.
        if taking is None or published > taking.number + 1:
            slot = self._slots[published % 2]
            size = self._size_of(slot, published)
            if size is None:
                return None
            self._taking = taking = _Taking(published, self._own[0], size, 0)
        slot = self._slots[taking.number % 2]
        end = min(taking.taken + _PIECE_WORDS, taking.words)
        piece = taking.into[taking.taken : end]
        piece[:] = slot[taking.taken : end]
        summed = piece if taking.taken else piece[1:]
        taking.checksum = _added(taking.checksum, summed)
        taking.taken = end
        if end < taking.words:
            return None
        self._taking = None
        posted = self._whole(taking.into[: taking.words], taking.checksum)
        if posted is not None:
            self._own.reverse()  # what is shown stays as it is while the next one is taken
        return posted

    def _size_of(self, slot: NDArray[np.uint64], number: int) -> int | None:
        """Number of words that a slot has in use; None if it does not hold that picture."""
        words = slot[:_SLOT_WORDS].view(np.int64)
        numbers, table = int(words[_NUMBERS]), int(words[_WORDS])
        if words[_NUMBER] != number or numbers < 0 or table < 0:
            return None
        return _words_of(numbers, table) if numbers * 8 + table * 2 <= self._room else None

    def _whole(self, own: NDArray[np.uint64], checksum: int) -> Posted | None:
        """Picture that was copied, if it is what its checksum says."""
        if int(own[_CHECKSUM]) != checksum:
            return None
        words = own[:_SLOT_WORDS].view(np.int64)
        numbers, table = int(words[_NUMBERS]), int(words[_WORDS])
        if _words_of(numbers, table) != own.size:
            return None
        program = Program(*_parts(own, numbers, table))
        return Posted(int(words[_NUMBER]), int(words[_LINE]), program)

    @property
    def paused(self) -> bool:
        """Tell whether the array is to rest."""
        return bool(self._words[_PAUSED])

    @paused.setter
    def paused(self, paused: bool) -> None:
        self._words[_PAUSED] = paused

    @property
    def switches(self) -> int:
        """States of a scene's switches, as `vbraille.scene.signals.packed` has them."""
        return self._words[_SWITCHES]

    @switches.setter
    def switches(self, switches: int) -> None:
        self._words[_SWITCHES] = switches

    @property
    def zeroed(self) -> int:
        """Tell how often the reader has said that the carriage is at the left stop."""
        return self._words[_ZEROED]

    def zero(self) -> None:
        """Say that the carriage is at the left stop."""
        self._words[_ZEROED] += 1

    @property
    def stopped(self) -> bool:
        """Tell whether the loop is to end."""
        return bool(self._words[_STOPPED])

    def stop(self) -> None:
        """Have the loop end."""
        self._words[_STOPPED] = 1


def _slot_bytes(room: int) -> int:
    return _SLOT_WORDS * 8 + -(-room // 8) * 8


def _words_of(numbers: int, table: int) -> int:
    """Words of a slot that a program takes with what stands before it."""
    return _SLOT_WORDS + numbers + -(-table // 4)


def _parts(
    slot: NDArray[np.uint64], numbers: int, table: int
) -> tuple[NDArray[np.float64], NDArray[np.uint16]]:
    """Views of a slot that hold the numbers and the table of its program."""
    middle = _SLOT_WORDS + numbers
    end = middle + -(-table // 4)
    return slot[_SLOT_WORDS:middle].view(np.float64), slot[middle:end].view(np.uint16)[:table]


def _checksum(words: NDArray[np.uint64]) -> int:
    """Checksum of all that a slot has in use but the checksum."""
    checksum, start = 0, _PIECE_WORDS - 1  # pieces begin where those of the whole slot do
    checksum = _added(checksum, words[:start])
    while start < words.size:
        checksum = _added(checksum, words[start : start + _PIECE_WORDS])
        start += _PIECE_WORDS
    return checksum


def _added(checksum: int, piece: NDArray[np.uint64]) -> int:
    """Checksum of words and one piece more."""
    return (checksum * _NEXT + int(np.dot(piece, _FACTORS[: piece.size]))) % _MODULUS


RING_S = 8.0


@dataclass(frozen=True, slots=True)
class Extent:
    """Sizes that decide how much memory is shared.

    Parameters
    ----------
    rows, columns
        Shape of the array.
    room
        Bytes of the largest picture.
    ticks
        How many ticks the ring holds.
    """

    rows: int
    columns: int
    room: int
    ticks: int

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of the array."""
        return self.rows, self.columns

    @property
    def mailbox_bytes(self) -> int:
        """Size of the mailbox, behind which the ring begins."""
        return Mailbox.bytes_needed(self.room)

    @property
    def total_bytes(self) -> int:
        """Size of the memory."""
        return self.mailbox_bytes + Ring.bytes_needed(self.shape, self.ticks)


def attach(descriptor: int, extent: Extent) -> memoryview:
    """Map the memory of a descriptor, which may be closed then; the first to attach makes room."""
    if os.fstat(descriptor).st_size < extent.total_bytes:
        os.ftruncate(descriptor, extent.total_bytes)
    return memoryview(mmap.mmap(descriptor, extent.total_bytes))


def divide(memory: memoryview, extent: Extent) -> tuple[Mailbox, Ring]:
    """Mailbox and ring of the memory, for the process whose loop takes orders and records ticks."""
    mailbox = Mailbox(memory[: extent.mailbox_bytes], extent.room)
    return mailbox, Ring(memory[extent.mailbox_bytes :], extent.shape, extent.ticks)


def watch(memory: memoryview, extent: Extent) -> tuple[Mailbox, RingReader]:
    """Mailbox and a reader of the ring, for the process that gives orders; others may watch."""
    mailbox = Mailbox(memory[: extent.mailbox_bytes], extent.room)
    return mailbox, RingReader(memory[extent.mailbox_bytes :], extent.shape, extent.ticks)
