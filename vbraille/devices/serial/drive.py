"""Deflections into FRAMEs: gain, polarity, broken actuators, and the fastest that they may move."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from vbraille.devices import framekernels
from vbraille.devices.calibration import correction_for
from vbraille.devices.wire.codec import Levels, enframe, frame_head

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.devices.calibration import Calibration, Correction
    from vbraille.devices.wire.messages import Info

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
