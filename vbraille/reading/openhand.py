"""The hand on an open device: a person's, or a simulated one that is told what to read, or held."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.simulation.hand import Still
from vbraille.simulation.recorded import Recorded

if TYPE_CHECKING:
    from vbraille.simulation.hand import Hand
    from vbraille.simulation.pointing import Pointer
    from vbraille.simulation.steering import Steering

_AFTER_HOLD_NS = 500_000_000  # as long as speeds are smoothed, and longer


class OpenHand:
    """What is known of the hand on an open device.

    Parameters
    ----------
    moved
        Simulated hand that moves the device; None if a person does.
    steering
        Channel that tells a simulated hand what to read; None without one.
    pointer
        Where somebody may hold a simulated hand; None if nobody can.

    Attributes
    ----------
    steering, pointer
        As given.
    once : bool
        Whether the hand reads no more than it has recorded.
    """

    def __init__(
        self, moved: Hand | Recorded | None, steering: Steering | None, pointer: Pointer | None
    ) -> None:
        self.steering = steering
        self.pointer = pointer
        self.once = isinstance(moved, Recorded)
        self._still = isinstance(moved, Still)
        self._held_ns: int | None = None  # when somebody held the hand last

    @property
    def descriptors(self) -> list[int]:
        """Descriptors of memory that the process of the device inherits."""
        channels = (self.steering, self.pointer)
        return [channel.descriptor for channel in channels if channel is not None]

    @property
    def held(self) -> bool:
        """Whether somebody holds the simulated hand."""
        return self.pointer is not None and self.pointer.held

    def patient(self, now_ns: int) -> bool:
        """Whether what the hand does or does not do at a time is somebody's own doing.

        A still hand waits for somebody, and one that was let go just now has not moved by itself.
        """
        if self.held:
            self._held_ns = now_ns
        held_of_late = self._held_ns is not None and now_ns - self._held_ns < _AFTER_HOLD_NS
        return self._still or held_of_late
