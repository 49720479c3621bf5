"""A simulated hand held at a place from outside, in memory that several processes share.

Whoever watches a simulated device may be its hand: the device asks at each read whether somebody
holds the hand, and where. That goes ahead of the orders of `vbraille.simulation.steering`, which
wait until the hand is let go. As there, the memory has no name, and neither side waits: places go
into two slots in turn, each with a checksum, so that one that is being written is taken later. A
hold ends with the process that holds, so that nobody who is gone keeps a hand from reading.
"""

from __future__ import annotations

import mmap
import os
import select
import struct
import weakref
from typing import Final
from zlib import crc32

from vbraille.simulation.steering import BeAt

_COUNT: Final = 0  # word of 8 bytes: how often the hand was moved or let go
_HEADER_BYTES: Final = 64
# Checksum, number, whether the hand is held, process that holds it, x, y and θ.
_SLOT: Final = struct.Struct("<4q3d")
# Not as large as the memory of a `Steering`, for which it cannot be taken by mistake.
_MEMORY_BYTES: Final = _HEADER_BYTES + 2 * _SLOT.size + 8
# So many times the holder is taken to be alive before it is looked at again: a look takes longer.
_LOOKS: Final = 64


class Pointer:
    """Both ends of the channel by which somebody holds a simulated hand.

    Parameters
    ----------
    descriptor
        Descriptor of memory that another `Pointer` has made; None makes new memory.

    Attributes
    ----------
    descriptor : int
        Descriptor of the memory; the `Pointer` that made it closes it.

    Raises
    ------
    ValueError
        If the descriptor is that of something else.
    """

    def __init__(self, descriptor: int | None = None) -> None:
        if descriptor is None:
            descriptor = os.memfd_create("vbraille pointer")
            weakref.finalize(self, os.close, descriptor)
            os.ftruncate(descriptor, _MEMORY_BYTES)
        self.descriptor = descriptor
        try:
            if os.fstat(descriptor).st_size != _MEMORY_BYTES:
                raise ValueError(f"descriptor {descriptor} is not of memory that holds a hand")
            self._memory = memoryview(mmap.mmap(descriptor, _MEMORY_BYTES))
        except OSError as error:
            raise ValueError(
                f"descriptor {descriptor} is not of memory that holds a hand: {error.strerror}"
            ) from None
        self._words = self._memory[:_HEADER_BYTES].cast("q")
        self._seen = 0
        self._at: BeAt | None = None
        self._holder = 0
        self._looks = 0

    def hold(self, at: BeAt) -> None:
        """Hold the hand at a pose from now on; the hand goes there as fast as a hand is led."""
        self._write(at)

    def let_go(self) -> None:
        """Let the hand go, so that it does what it was told to."""
        self._write(None)

    def at(self) -> BeAt | None:
        """Pose at which the hand is held, the same object until it changes; None if it is not."""
        number = self._words[_COUNT]
        if number != self._seen:
            self._read(number)
        elif self._at is not None:
            self._looks += 1
            if self._looks >= _LOOKS:
                self._looks = 0
                self._at = self._at if _lives(self._holder) else None
        return self._at

    @property
    def held(self) -> bool:
        """Whether somebody holds the hand."""
        return self.at() is not None

    def _write(self, at: BeAt | None) -> None:
        number = self._words[_COUNT] + 1
        place = (0.0, 0.0, 0.0) if at is None else (at.x_mm, at.y_mm, at.theta_rad)
        slot = _SLOT.pack(0, number, at is not None, os.getpid(), *place)
        begin = _place(number)
        self._memory[begin : begin + _SLOT.size] = crc32(slot).to_bytes(8, "little") + slot[8:]
        self._words[_COUNT] = number

    def _read(self, number: int) -> None:
        """Take what was written last; nothing, if that is being written."""
        begin = _place(number)
        slot = bytes(self._memory[begin : begin + _SLOT.size])
        checksum, there, held, holder, *place = _SLOT.unpack(slot)
        if there != number or checksum != crc32(bytes(8) + slot[8:]):
            return
        self._seen, self._holder, self._looks = number, holder, 0
        self._at = BeAt(*place) if held else None


def _place(number: int) -> int:
    """Place in the memory of the slot that is written by this number."""
    return _HEADER_BYTES + number % 2 * _SLOT.size


def _lives(process: int) -> bool:
    """Whether a process has not ended; one that nobody has waited for yet has."""
    try:
        descriptor = os.pidfd_open(process)
    except OSError:
        return False
    try:
        ending = select.poll()
        ending.register(descriptor, select.POLLIN)
        return not ending.poll(0)
    finally:
        os.close(descriptor)
