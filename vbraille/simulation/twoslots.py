"""Memory without a name by which two processes tell each other the newest of something.

What is told goes into two slots in turn, each with its number and a checksum, and then the number
of the last one is published. Neither side waits for the other: a slot that is in the writing, or
seen in the wrong order, is taken later.
"""

from __future__ import annotations

import mmap
import os
import struct
import weakref
from typing import Any, Final
from zlib import crc32

_HEADER_BYTES: Final = 64
_NUMBERS: Final = struct.Struct("<2q")  # checksum, and the number of what is told


class TwoSlots:
    """Both ends of the memory.

    Parameters
    ----------
    purpose
        What the memory does, such as "steers a hand".
    form
        Form of what is told, as `struct.Struct` takes it, without the order of its bytes.
    spare_bytes
        Bytes that nobody uses, by which the memory differs in size from that of another purpose.
    descriptor
        Descriptor of memory that another `TwoSlots` has made; None makes new memory.

    Attributes
    ----------
    descriptor : int
        Descriptor of the memory; the `TwoSlots` that made it closes it.
    memory : memoryview
        The memory.
    words : memoryview of int64[8]
        Words at its start: the first is the number of what was told last, 0 before anything was,
        and the others are free.

    Raises
    ------
    ValueError
        If the descriptor is that of something else.
    """

    def __init__(
        self, purpose: str, form: str, descriptor: int | None, *, spare_bytes: int = 0
    ) -> None:
        self._slot = struct.Struct(f"{_NUMBERS.format}{form}")
        size = _HEADER_BYTES + 2 * self._slot.size + spare_bytes
        if descriptor is None:
            descriptor = os.memfd_create(f"vbraille {purpose}")
            weakref.finalize(self, os.close, descriptor)
            os.ftruncate(descriptor, size)
        self.descriptor = descriptor
        try:
            if os.fstat(descriptor).st_size != size:
                raise ValueError(f"descriptor {descriptor} is not of memory that {purpose}")
            self.memory = memoryview(mmap.mmap(descriptor, size))
        except OSError as error:
            raise ValueError(
                f"descriptor {descriptor} is not of memory that {purpose}: {error.strerror}"
            ) from None
        self.words = self.memory[:_HEADER_BYTES].cast("q")

    def tell(self, *values: float) -> None:
        """Tell the other end something new."""
        number = self.words[0] + 1
        slot = self._slot.pack(0, number, *values)
        at = self._place(number)
        self.memory[at : at + self._slot.size] = crc32(slot).to_bytes(8, "little") + slot[8:]
        self.words[0] = number

    def take(self, number: int) -> tuple[Any, ...] | None:
        """Take what was told under a number; None if that is being written."""
        at = self._place(number)
        slot = bytes(self.memory[at : at + self._slot.size])
        checksum, there, *values = self._slot.unpack(slot)
        if there != number or checksum != crc32(bytes(8) + slot[8:]):
            return None
        return tuple(values)

    def _place(self, number: int) -> int:
        return _HEADER_BYTES + number % 2 * self._slot.size
