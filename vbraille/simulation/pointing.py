"""A simulated hand held at a place from outside, in memory that several processes share.

Whoever watches a simulated device may be its hand: the device asks at each read whether somebody
holds the hand, and where. That goes ahead of the orders of `vbraille.simulation.steering`, which
wait until the hand is let go. As there, neither side waits. A hold ends with the process that
holds, so that nobody who is gone keeps a hand from reading.
"""

from __future__ import annotations

import os
import select
from typing import Final

from vbraille.simulation.steering import BeAt
from vbraille.simulation.twoslots import TwoSlots

_COUNT: Final = 0  # word of the memory: how often the hand was moved or let go
# Not as large as the memory of a `Steering`, for which it cannot be taken by mistake.
_SPARE_BYTES: Final = 8
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
        # What is told is whether the hand is held, by which process, and where: x, y and θ.
        self._slots = TwoSlots("holds a hand", "2q3d", descriptor, spare_bytes=_SPARE_BYTES)
        self.descriptor = self._slots.descriptor
        self._words = self._slots.words
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
        place = (0.0, 0.0, 0.0) if at is None else (at.x_mm, at.y_mm, at.theta_rad)
        self._slots.tell(at is not None, os.getpid(), *place)

    def _read(self, number: int) -> None:
        """Take what was written last; nothing, if that is being written."""
        told = self._slots.take(number)
        if told is None:
            return
        held, holder, *place = told
        self._seen, self._holder, self._looks = number, holder, 0
        self._at = BeAt(*place) if held else None


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
