"""When FRAMEs may hold a device's actuators again; nothing may jump between them and rest.

A device rests when it is told to, and by its watchdog, perhaps while the host was itself
stopped and could not hear of it. On its ramp to rest a FRAME would jump, and one from after
it too. So a host that has stopped, for whatever reason, sends none until the device has said
for the ramp's time that it rests. It then sends FRAMEs of rest, until the device says that it
has taken one: what that STATE and those after it tell is no older, and the array may fade in.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.devices.serial.transitions import Cause
from vbraille.devices.wire.messages import LOST_MS, RAMP_MS, STALL_MS, WATCHDOG_MS

if TYPE_CHECKING:
    from vbraille.devices.wire.messages import State, Watchdog

_NS_PER_MS = 1_000_000
_US_PER_S = 1_000_000
_STALL_NS = STALL_MS * _NS_PER_MS
_U16, _U32 = 0xFFFF, 0xFFFF_FFFF


class Delivery:
    """Knowledge of FRAMEs and rest in one conversation, which begins at rest.

    Parameters
    ----------
    rate_hz
        STATEs a second that the device sends; its ramp ends with a period.

    Attributes
    ----------
    rest_due : bool
        Whether the device must be told to rest: it may not know yet, or not have heard.
    sent_ns : int or None
        Time at which the last FRAME was sent; None if none was since the device was to rest.
    """

    def __init__(self, rate_hz: int) -> None:
        self.rest_due = False
        self.sent_ns: int | None = None
        self._sent = 0  # sequence of the FRAME sent last
        self._ramp_us = RAMP_MS * 1000 + -(-_US_PER_S // rate_hz)
        self._resting_us: int | None = None  # since when it says so, by its own clock
        self._resting_sequence = 0
        self._held_us: int | None = None  # since when a FRAME wrongly holds it, likewise
        self._told_ns: int | None = None
        self._offered: int | None = None  # sequence of the first FRAME of rest sent since

    def sent(self, sequence: int, now_ns: int, *, holding: bool) -> None:
        """Note that a FRAME was sent: one of rest, if FRAMEs are not holding the actuators."""
        if not holding and self._offered is None:
            self._offered = sequence
        self._sent, self.sent_ns = sequence, now_ns

    def told(self, now_ns: int) -> None:
        """Note that REST was sent."""
        self.rest_due, self._told_ns = False, now_ns

    def stop(self, *, tell: bool) -> None:
        """Begin to wait until the device is at rest; with `tell`, have it told to rest."""
        self.rest_due = tell
        self._resting_us = self._held_us = self._told_ns = self._offered = self.sent_ns = None

    def give_time(self, now_ns: int) -> None:
        """Leave going to rest to the device's watchdog for a while, before telling the device."""
        self._told_ns = now_ns + WATCHDOG_MS * _NS_PER_MS

    def stalled(self, now_ns: int) -> bool:
        """Whether FRAMEs are owed, and the last is so old that the device may rest by now."""
        return self.sent_ns is not None and now_ns - self.sent_ns >= _STALL_NS

    def judge(self, state: State, now_ns: int) -> Cause:
        """Cause that a STATE gives if the device is not known to be held by FRAMEs."""
        if state.resting:
            return self._rest_on(state)
        if self._has_taken(state.frame_sequence):
            self.rest_due = False
            return Cause.TOOK
        return self._mind_held(state.time_us, now_ns)

    def _rest_on(self, state: State) -> Cause:
        self.rest_due = False
        self._held_us = None
        if self._resting_us is None or state.frame_sequence != self._resting_sequence:
            self._resting_us, self._resting_sequence = state.time_us, state.frame_sequence
        rested_us = (state.time_us - self._resting_us) & _U32
        return Cause.RESTED if rested_us >= self._ramp_us else Cause.RAMPS

    def _has_taken(self, sequence: int) -> bool:
        """Whether the FRAME that holds the device is one of rest, sent since it went to rest."""
        if self._offered is None:
            return False
        return (sequence - self._offered) & _U16 <= (self._sent - self._offered) & _U16

    def _mind_held(self, time_us: int, now_ns: int) -> Cause:
        """Cause if a FRAME holds it: REST is under way or lost, or an old FRAME came after it."""
        self._resting_us = None
        if self._held_us is None:
            self._held_us = time_us
        if self._told_ns is None or now_ns - self._told_ns >= RAMP_MS * _NS_PER_MS:
            self.rest_due = True
        stuck = (time_us - self._held_us) & _U32 >= LOST_MS * 1000
        return Cause.FAULT if stuck else Cause.HELD


class Trips:
    """Count of a watchdog's trips, by its reports and by STATEs, each trip once.

    Attributes
    ----------
    count : int
        Number of trips since the first WATCHDOG.
    disbelieved : int
        Number of reports that tell of more trips than there was time for.
    """

    def __init__(self) -> None:
        self.count = self.disbelieved = 0
        self._reported_ns = 0
        self._reported: int | None = None
        self._counted = False  # whether the trip that STATEs tell of was counted
        self._unreported = 0  # trips that only STATEs have told of

    @property
    def tripped(self) -> bool:
        """Whether the last STATE told of a trip."""
        return self._counted

    def restart(self) -> None:
        """Take the next report for the first one, since a conversation begins."""
        self._reported_ns, self._reported = 0, None
        self._counted, self._unreported = False, 0

    def take_report(self, watchdog: Watchdog, now_ns: int) -> bool:
        """Take a report; tell whether it has new trips that can be believed."""
        tripped = 0 if self._reported is None else (watchdog.trips - self._reported) & _U32
        # A trip takes a frame, and then its time without one; a device's clock may go a bit fast.
        elapsed_ms = (now_ns - self._reported_ns) // _NS_PER_MS
        believable = 1 + elapsed_ms * 5 // (WATCHDOG_MS * 4)
        self._reported, self._reported_ns = watchdog.trips, now_ns
        if tripped > believable:
            self.disbelieved += 1
            return False
        if not tripped:
            return False
        self.count += max(tripped - self._unreported, 0)
        self._unreported = 0
        self._counted = True
        return True

    def take_state(self, *, tripped: bool) -> None:
        """Note whether a STATE tells of a trip; count the trip if its report was lost."""
        if tripped and not self._counted:
            self.count += 1
            self._unreported += 1
        self._counted = tripped
