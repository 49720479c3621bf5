"""Whether FRAMEs hold a device's actuators, or these rest; nothing may jump between the two.

A device rests when it is told to, and by its watchdog, perhaps while the host was itself
stopped and could not hear of it. On its ramp to rest a FRAME would jump, and one from after
it too. So a host that has stopped, for whatever reason, sends none until the device has said
for the ramp's time that it rests. It then sends FRAMEs of rest, until the device says that it
has taken one: what that STATE and those after it tell is no older, and the array may fade in.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.devices.messages import LOST_MS, RAMP_MS, STALL_MS, WATCHDOG_MS

if TYPE_CHECKING:
    from vbraille.devices.messages import State, Watchdog

_NS_PER_MS = 1_000_000
_US_PER_S = 1_000_000
_U16, _U32 = 0xFFFF, 0xFFFF_FFFF


class Delivery:
    """What becomes of FRAMEs in one conversation, which begins at rest.

    Parameters
    ----------
    rate_hz
        Of the device's STATEs: its ramp ends with a period.

    Attributes
    ----------
    taking : bool
        Whether FRAMEs hold the actuators.
    at_rest : bool
        Whether, if not, the ramp is over, so that FRAMEs of rest may be sent.
    rest_due : bool
        Whether the device must be told to rest: it may not know yet, or not have heard.
    stuck : bool
        Whether it does not rest, though it is told to and is sent no FRAME: it is not safe.
    trips : int
        Of its watchdog, since its first WATCHDOG.
    disbelieved : int
        Reports that tell of more trips than there was time for.
    """

    def __init__(self, rate_hz: int) -> None:
        self.taking = self.at_rest = self.rest_due = self.stuck = False
        self.trips = self.disbelieved = 0
        self._ramp_us = RAMP_MS * 1000 + -(-_US_PER_S // rate_hz)
        self._resting_us: int | None = None  # since when it says so, by its own clock
        self._resting_sequence = 0
        self._held_us: int | None = None  # since when a FRAME holds it that should not, likewise
        self._told_ns: int | None = None
        self._offered: int | None = None  # first FRAME of rest sent since
        self._sent = 0
        self._sent_ns: int | None = None
        self._reported_ns = 0
        self._trips_before: int | None = None
        self._counted = False  # the trip that STATEs tell of
        self._unreported = 0  # trips that were counted by STATEs alone

    def sent(self, sequence: int, now_ns: int) -> None:
        """A FRAME was sent; one of rest, if none is taken."""
        if not self.taking and self._offered is None:
            self._offered = sequence
        self._sent, self._sent_ns = sequence, now_ns

    def told(self, now_ns: int) -> None:
        """REST was sent."""
        self.rest_due, self._told_ns = False, now_ns

    def stop(self, *, tell: bool = True) -> None:
        """Send no FRAME until the device is at rest; if it should not be, it is told so."""
        self.taking = self.at_rest = False
        self.rest_due = tell
        self._resting_us = self._held_us = self._told_ns = self._offered = self._sent_ns = None

    def stall(self, now_ns: int) -> None:
        """Send no FRAME either; the device's watchdog has time to see to the rest."""
        self.stop(tell=False)
        self._told_ns = now_ns + WATCHDOG_MS * _NS_PER_MS

    def stalled(self, now_ns: int) -> bool:
        """Whether FRAMEs are owed, and the last is so old that the device may rest by now."""
        return self._sent_ns is not None and now_ns - self._sent_ns >= STALL_MS * _NS_PER_MS

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
        self.trips += max(tripped - self._unreported, 0)
        self._unreported = 0
        self._counted = True
        if not self.taking:
            return False
        self.stop(tell=False)
        return True

    def take_state(self, state: State, now_ns: int) -> bool:
        """See whether it rests; whether it went there, which was not known."""
        if state.tripped and not self._counted:  # its WATCHDOG was lost
            self.trips += 1
            self._unreported += 1
        self._counted = state.tripped
        fell = self.taking and state.resting
        if fell:
            self.stop(tell=False)
        if self.taking:
            return False
        if state.resting:
            self._rest_on(state)
        elif self._has_taken(state.frame_sequence):
            self.taking, self.rest_due = True, False
        else:
            self._mind_held(state.time_us, now_ns)
        return fell

    def _rest_on(self, state: State) -> None:
        self.rest_due = False
        self._held_us = None
        if self._resting_us is None or state.frame_sequence != self._resting_sequence:
            self._resting_us, self._resting_sequence = state.time_us, state.frame_sequence
        self.at_rest = (state.time_us - self._resting_us) & _U32 >= self._ramp_us

    def _has_taken(self, sequence: int) -> bool:
        """Whether it is a FRAME of rest, sent since it is at rest, that holds it."""
        if self._offered is None:
            return False
        return (sequence - self._offered) & _U16 <= (self._sent - self._offered) & _U16

    def _mind_held(self, time_us: int, now_ns: int) -> None:
        """A FRAME holds it: REST is under way, or was lost, or an old FRAME came after it."""
        self.at_rest, self._resting_us = False, None
        if self._held_us is None:
            self._held_us = time_us
        self.stuck = (time_us - self._held_us) & _U32 >= LOST_MS * 1000
        if self._told_ns is None or now_ns - self._told_ns >= RAMP_MS * _NS_PER_MS:
            self.rest_due = True
