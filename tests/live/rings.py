"""A host's memory without a host: ticks that a test appends, as the loop does."""

from __future__ import annotations

import os
import weakref

import numpy as np

from vbraille.engine.mailbox import Extent, attach, divide
from vbraille.engine.record import SIGNAL
from vbraille.live.devicesource import TickViews

EXTENT = Extent(2, 3, 200_000, 500)
PERIOD_NS = 1_000_000


class TestRing:
    """Memory that a host would share; each tick has numbers of its own.

    Attributes
    ----------
    descriptor : int
        Descriptor of the memory.
    mailbox : Mailbox
        Mailbox in which pictures are posted.
    """

    __test__ = False

    def __init__(self, extent: Extent = EXTENT) -> None:
        self.descriptor = os.memfd_create("ring of a test")
        weakref.finalize(self, os.close, self.descriptor)
        self.extent = extent
        self.mailbox, self._ring = divide(attach(self.descriptor, extent), extent)
        self.ticks = 0

    def append(self, count: int = 1) -> None:
        """Append ticks, all of which may be read."""
        ints, floats, frames = self._ring.columns
        for _ in range(count):
            n, slot = self.ticks, self._ring.begin()
            ints[slot] = (
                n,
                n * PERIOD_NS,
                0,
                2000 + n,
                3000 + n,
                n // 7,
                0,
                n // 5,
                n // 9,
                n % 1024,
            )
            floats[slot] = 0
            floats[slot, :9] = n / 8, n / 16, n / 32, -n / 4, 0, 0, 0, 0, 0.5
            floats[slot, SIGNAL : SIGNAL + 2] = n / 128, n / 256
            frames[slot] = frame_of(n, self.extent.shape)
            self._ring.end()
            self.ticks += 1
        self._ring.publish()

    def views(self) -> TickViews:
        """The memory as the server of the live view maps it."""
        return TickViews(self.descriptor, self.extent)


def frame_of(n: int, shape: tuple[int, int]) -> np.ndarray:
    """The frame of a tick."""
    rows, columns = shape
    return (np.arange(rows * columns, dtype=np.float32).reshape(shape) + n % 97) / 256
