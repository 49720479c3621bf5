"""The memory that a host process and its parent share: a mailbox and a ring.

Not `multiprocessing.shared_memory`: whoever attaches to that by name destroys
it when it exits. This has no name; a descriptor is inherited.
"""

from __future__ import annotations

import mmap
import os
from dataclasses import dataclass

from vbraille.engine.mailbox import Mailbox
from vbraille.engine.ring import Ring, RingReader

RING_S = 8.0


@dataclass(frozen=True, slots=True)
class Extent:
    """What decides how much memory is shared.

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
    """Mailbox and a reader of the ring, for whoever gives orders; others may watch, too."""
    mailbox = Mailbox(memory[: extent.mailbox_bytes], extent.room)
    return mailbox, RingReader(memory[extent.mailbox_bytes :], extent.shape, extent.ticks)
