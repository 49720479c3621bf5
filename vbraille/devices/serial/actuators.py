"""FRAMEs and rest: levels for the actuators, and when FRAMEs may hold them again, without a jump.

A device rests when it is told to, and by its watchdog, perhaps while the host was itself
stopped and could not hear of it. On its ramp to rest a FRAME would jump, and one from after
it too. So a host that has stopped, for whatever reason, sends none until the device has said
for the ramp's time that it rests. It then sends FRAMEs of rest, until the device says that it
has taken one: what that STATE and those after it tell is no older, and the array may fade in.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from vbraille.devices import framekernels
from vbraille.devices.calibration import correction_for
from vbraille.devices.serial.transitions import Cause
from vbraille.devices.serial.wire import (
    LOST_MS,
    RAMP_MS,
    STALL_MS,
    WATCHDOG_MS,
    Levels,
    enframe,
    frame_head,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.devices.calibration import Calibration, Correction
    from vbraille.devices.serial.wire import Info, State, Watchdog

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


_NS_PER_S = 1e9
_FULL_GAIN = 255


class Drive:
    """Levels for the actuators, by the formula in section Levels of the protocol's page.

    Parameters
    ----------
    info
        INFO that began the conversation.
    now_ns
        Present time, at which the actuators are at rest.
    rate_hz
        FRAMEs a second that the host will send.

    Attributes
    ----------
    last, wanted : float64[rows, columns]
        Deflections of the FRAME that was sent last, and of the FRAME made last.
    last_ns : int
        Time when a FRAME was sent last, or when the actuators were last at rest.
    limited : bool
        Whether the device limits how fast its actuators may be moved.
    slew_per_ns, period_ns : float
        Largest number of swings a nanosecond that actuators may make, and the time between FRAMEs.
    swing, rest_level : float64[rows, columns], int64[rows, columns]
        Number of levels from rest to full swing, and the level at rest.
    has_own_gains : bool
        Whether INFO says that actuators differ, so that the device makes up for that.
    top_level, bits : int
        Highest level, and the number of bits in a level.
    packed : uint8[bytes]
        Levels of the FRAME made last, as they go over the line.
    """

    def __init__(self, info: Info, now_ns: int, rate_hz: float) -> None:
        shape = info.rows, info.columns
        gain, enabled, inverted = (
            np.frombuffer(given, np.uint8).reshape(shape).astype(np.float64)
            for given in (info.gain, info.enabled, info.inverted)
        )
        packing = Levels(info.rows * info.columns, info.top_level)
        self.swing = gain * enabled / _FULL_GAIN * info.top_level
        self.has_own_gains = bool((gain != _FULL_GAIN).any() or not enabled.all() or inverted.any())
        self._own_swing = self.swing.copy()
        self._correction: Correction | None = None
        self.rest_level = inverted.astype(np.int64) * info.top_level
        self.top_level = info.top_level
        self.bits = packing.bits
        self.slew_per_ns = info.largest_slew_per_s / _NS_PER_S
        self.limited = info.largest_slew_per_s > 0
        self.period_ns = _NS_PER_S / rate_hz
        self.wanted = np.zeros(shape)
        self.last = np.zeros(shape)
        self.last_ns = now_ns
        self.packed = np.zeros(packing.packed_bytes, np.uint8)
        # Compiled here, before a hand is on the device.
        self.fill(np.zeros(shape), now_ns)

    def fill(self, deflections: NDArray[np.float64], now_ns: int) -> bool:
        """Make a FRAME on the way to deflections; tell whether there is anything to feel in it.

        Parameters
        ----------
        deflections : float64[rows, columns]
            Deflections that the actuators are to have, in [0, 1].
        now_ns
            Present time. The slew limit is by the time since the frame before, but by one period at
            most: an actuator that stood still must not make up for it.
        """
        if self._correction is not None and self._correction.advance():
            self._correct(self._correction)
        step = math.inf
        if self.limited:
            step = self.slew_per_ns * min(now_ns - self.last_ns, self.period_ns)
        return framekernels.fill(
            deflections,
            self.last,
            self.wanted,
            step,
            self.swing,
            self.rest_level,
            self.bits,
            self.packed,
        )

    @property
    def settled(self) -> bool:
        """Whether swings and levels at rest stay as they are from FRAME to FRAME."""
        return self._correction is None or not self._correction.moving

    def correct(self, calibration: Calibration | None) -> None:
        """Make up for what was found of actuators of which INFO says nothing.

        The FRAMEs that follow go over to it without a jump. An inverted actuator, whose rest is
        the highest level, sets out from where the device rests, which is level 0. What a device
        says of itself goes before what a host has found.
        """
        if self._correction is None:
            if calibration is None or self.has_own_gains:
                return
            self._correction = correction_for(
                self.swing.shape, _NS_PER_S / self.period_ns, self.slew_per_ns * _NS_PER_S
            )
            self._correction.aim(calibration)
            self._correction.from_rest()
        else:
            self._correction.aim(calibration)
        self._correct(self._correction)

    def _correct(self, correction: Correction) -> None:
        """Have swings and levels at rest be what a correction has come to."""
        scale, offset = correction.scale, correction.offset
        np.rint(offset * self.top_level, out=self.rest_level, casting="unsafe")
        # A swing never goes past level 0: while an actuator is turned, it is less.
        down = np.minimum(-scale, offset)
        self.swing[:] = np.where(self.rest_level > 0, np.maximum(down, 0.0), np.maximum(scale, 0.0))
        self.swing *= self._own_swing

    def frame(self, sequence: int) -> bytes:
        """FRAME made last, with a sequence, as it goes over the line."""
        return enframe(frame_head(sequence) + self.packed.tobytes())

    def sent(self, now_ns: int) -> None:
        """Note that the FRAME made last has gone out, so that the actuators go there."""
        self.last, self.wanted = self.wanted, self.last
        self.last_ns = now_ns

    def rested(self, now_ns: int) -> None:
        """Note that the actuators go to rest by themselves."""
        self.last.fill(0.0)
        self.last_ns = now_ns
        if self._correction is not None:
            self._correction.from_rest()
            self._correct(self._correction)
