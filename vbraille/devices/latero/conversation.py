"""The client's end of the talk with a Latero: no socket, no clock, no thread.

It is given the time, datagrams that came and what is wanted; it gives places, events, and the
requests that are due, one after the other:

    conversation = LateroConversation(now_ns)
    conversation.hear(socket.recv(256), now_ns)
    conversation.tend(now_ns)
    while (request := conversation.due()) is not None:
        socket.send(request)
        conversation.sent()
    pose = conversation.take_pose()

Every request has a number, and only the newest answer counts: a late one is dropped, and a lost
one is counted and not waited for.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.devices.events import Placed, WatchdogTripped
from vbraille.devices.latero.datagrams import (
    CONTROLLER,
    POWERED_OFF,
    POWERED_ON,
    READ,
    WRITE,
    number,
    raw_request,
)
from vbraille.devices.latero.hearing import (
    ASK_NS,
    OPENING,
    PROBE_NS,
    RAMP_ASK_NS,
    RAW_NS,
    SILENCE_NS,
    STALL_NS,
    LateroHearing,
    LateroStage,
    unpowered,
)
from vbraille.devices.latero.numbering import not_before

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_AWAY = frozenset({LateroStage.SILENT, LateroStage.BLIND, LateroStage.LEAVING})


class LateroConversation(LateroHearing):
    """The talk with a Latero; see `LateroHearing` for its parameters and attributes."""

    def show(self, frame: NDArray[np.float64], now_ns: int) -> None:
        """Have deflections shown, float64[8, 8] in [0, 1], if the blades are ready for them."""
        self._now_ns = self._shown_ns = now_ns
        # An answer to what was asked since says that the last frame is there, but perhaps only now.
        heard = self.acknowledged_ns is not None or self._heard_before
        self._heard_before, self._heard = self._heard, False
        self.acknowledged_ns = None
        self._frame = -1
        if self.stage is LateroStage.LIVE:
            self.blades.show(frame, heard=heard)
        else:
            self.blades.ramp(now_ns)
        self._full_due = True

    def ask(self, now_ns: int) -> None:
        """Ask where the array is, by the frame that is shown, for the next one to be made."""
        self._now_ns = now_ns
        self._full_due = self.stage is LateroStage.LIVE

    def rest(self, now_ns: int) -> None:
        """Take the blades to rest along the ramp; frames after that fade in."""
        self._now_ns = now_ns
        if self.stage is LateroStage.LIVE:
            self._stop()

    def leave(self, now_ns: int) -> None:
        """Take leave: blades to rest, then motor power off, until both are answered."""
        self._now_ns = now_ns
        self._stop()
        self._go(LateroStage.LEAVING)

    @property
    def left(self) -> bool:
        """Whether the Latero has answered that its blades rest and its motor power is off."""
        answer = self.answer
        if answer is None or self._resting is None:
            return False
        unpowered_now = self.power is None or unpowered(answer)
        return unpowered_now and not_before(answer.sequence, self._resting)

    def stall(self, levels: bytes | memoryview, trips: int, now_ns: int) -> None:
        """Note that the client was stopped, so that the guardian may have acted.

        Parameters
        ----------
        levels
            Levels at which the blades stand now.
        trips
            How often the guardian has acted.
        now_ns
            Present time.
        """
        self._now_ns = now_ns
        self._begun_ns = self._heard_ns = now_ns  # what came meanwhile is judged by its own time
        if self.stage is LateroStage.LIVE:
            self._stop()
            self._tell(WatchdogTripped(trips, "host"))
        self._may_power = True  # the guardian may have switched it off
        self._resting = None
        self.blades.stand_at(levels, now_ns)

    def set_zero(self, now_ns: int) -> None:
        """Take the place for that of the reset: the reader says that the array is there."""
        self._now_ns = now_ns
        before = self.place.placing
        self.place.set_zero()
        if self.place.placing is not before:
            self._tell(Placed(self.place.placing))

    def tend(self, now_ns: int) -> None:
        """Mind what time brings: silence, the ramp, and what must be asked again."""
        self._now_ns = now_ns
        if now_ns - self._tended_ns >= STALL_NS:
            self._heard_ns = self._begun_ns = now_ns  # nobody has asked meanwhile
        self._tended_ns = now_ns
        stage = self.stage
        if stage is LateroStage.PROBING and now_ns - self._begun_ns > PROBE_NS:
            self._do_without_power()
            self._go(LateroStage.RAMPING)
        elif stage not in OPENING and stage is not LateroStage.LEAVING:
            silent_ns = now_ns - self._heard_ns
            if silent_ns >= SILENCE_NS:
                self._fall_silent(silent_ns)
        if stage is LateroStage.POWERING and now_ns - self._begun_ns > PROBE_NS:
            self._tell_power()
        stage = self.stage
        if stage is LateroStage.LIVE:
            # What is felt is not held by asking for places: the guardian takes it to rest.
            if now_ns - self._asked_ns >= ASK_NS and self.blades.rests:
                self._full_due = True
        elif now_ns - self._asked_ns >= (ASK_NS if self.blades.at_rest else RAMP_ASK_NS):
            self.blades.ramp(now_ns)
            self._full_due = True

    # What goes out.

    def due(self) -> bytearray | None:
        """Next request that is to go out; call `sent` or `refused` before the next call."""
        if self._full_due:
            self._offer = self.blades.request
        else:
            self._offer = self._raw = self._raw_due()
        if self._offer is not None:
            number(self._offer, self.numbering.next)
        return self._offer

    def sent(self) -> None:
        """Note that the request given last has gone out."""
        sequence = self.numbering.sent(self._now_ns)
        if self._offer is self._raw:
            self._raw_ns = self._now_ns
            return
        self._full_due = False
        self._asked_ns = self._now_ns
        if self._shown_ns == self._now_ns:
            self._frame = sequence
        if self.blades.at_rest and self._resting is None:
            self._resting = sequence

    def refused(self) -> None:
        """Note that the request given last could not be sent: it is dropped, not kept."""
        self._full_due = False
        self._raw_ns = self._now_ns

    def _raw_due(self) -> bytearray | None:
        """RAW that is due, as far as one is: what switches power is said until it is answered."""
        power, stage = self.power, self.stage
        if power is None or self._now_ns - self._raw_ns < RAW_NS:
            return None
        if stage is LateroStage.PROBING:
            return raw_request(READ | CONTROLLER, power)
        if stage is LateroStage.POWERING:
            on = raw_request(WRITE | CONTROLLER, power, POWERED_ON)
            return on if self._may_power else None
        if stage in _AWAY and self.blades.at_rest:
            self._may_power = True
            return power_off(power)
        return None


def power_off(register: int) -> bytearray:
    """Request that switches motor power off."""
    return raw_request(WRITE | CONTROLLER, register, POWERED_OFF)
