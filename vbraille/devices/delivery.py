"""Whether FRAMEs reach a device: it says so, and its watchdog says when they do not."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.devices.messages import RAMP_MS, WATCHDOG_MS

if TYPE_CHECKING:
    from vbraille.devices.messages import State, Watchdog

REFUSED_MS = 2 * WATCHDOG_MS  # without a FRAME taken: more than one that is lost now and then
_NS_PER_MS = 1_000_000
_U32 = 0xFFFF_FFFF


class Delivery:
    """What becomes of FRAMEs in one conversation.

    Attributes
    ----------
    held : bool
        Whether the device went to rest for want of FRAMEs and has taken none since.
        It is sent FRAMEs of rest as long: the first that arrives must not be a jump.
    trips : int
        Of its watchdog, since its first WATCHDOG.
    disbelieved : int
        Reports that tell of more trips than there was time for.
    """

    def __init__(self) -> None:
        self.held = False
        self.trips = self.disbelieved = 0
        self._held_ns = self._reported_ns = 0
        self._trips_before: int | None = None
        self._sent = 0  # the last FRAME sent, and the last that the device says it took
        self._taken: int | None = None
        self._owed_ns: int | None = None  # since when FRAMEs are sent and none was taken

    def sent(self, sequence: int, now_ns: int) -> None:
        """A FRAME was sent."""
        self._sent = sequence
        if self._owed_ns is None:
            self._owed_ns = now_ns

    def idle(self) -> None:
        """No FRAME is owed any more."""
        self._owed_ns = None
        self.held = False

    def refused(self, now_ns: int) -> bool:
        """Whether FRAMEs have been owed for a while, and none was taken."""
        return self._owed_ns is not None and now_ns - self._owed_ns >= REFUSED_MS * _NS_PER_MS

    def take_watchdog(self, watchdog: Watchdog, now_ns: int) -> bool:
        """Take a report; whether the device went to rest, which was not known."""
        tripped = 0 if self._trips_before is None else (watchdog.trips - self._trips_before) & _U32
        # A trip takes a frame, and then its time without one; a device's clock may go a bit fast.
        elapsed_ms = (now_ns - self._reported_ns) // _NS_PER_MS
        believable = 1 + elapsed_ms * 5 // (WATCHDOG_MS * 4)
        self._trips_before, self._reported_ns = watchdog.trips, now_ns
        if tripped > believable:
            self.disbelieved += 1
            return False
        if not tripped:
            return False
        self.trips += tripped
        return self._hold(now_ns)

    def take_state(self, state: State, now_ns: int) -> bool:
        """See what was taken; whether FRAMEs must fade in from rest from now on."""
        moved = state.frame_sequence != self._taken
        self._taken = state.frame_sequence
        if self._owed_ns is None:
            return False
        if moved:
            self._owed_ns = now_ns
            late = self.held and now_ns - self._held_ns > RAMP_MS * _NS_PER_MS
            self.held = False
            # What has faded in meanwhile was not felt.
            return late
        overdue = now_ns - self._owed_ns >= WATCHDOG_MS * _NS_PER_MS
        # Its WATCHDOG was lost.
        return overdue and state.resting and self._taken != self._sent and self._hold(now_ns)

    def _hold(self, now_ns: int) -> bool:
        known, self.held = self.held, True
        if not known:
            self._held_ns = now_ns
        return not known
