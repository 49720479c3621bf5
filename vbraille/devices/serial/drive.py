"""Deflections into FRAMEs: gain, polarity, broken actuators, and the fastest that they may move."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from vbraille.devices.wire import packing
from vbraille.devices.wire.codec import Levels, enframe, frame_head

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.devices.wire.messages import Info

_NS_PER_S = 1e9


class Drive:
    """What the actuators are told; the formula of the protocol's page, section Levels.

    Parameters
    ----------
    info
        The INFO that began the conversation.
    now_ns
        When: the actuators are at rest.
    rate_hz
        FRAMEs a second that the host is to send.

    Attributes
    ----------
    last, wanted : float64[rows, columns]
        Deflections of the FRAME that was sent last, and of the one made last.
    last_ns : int
        When the last one was sent, or the actuators were at rest.
    limited : bool
        Whether the device limits how fast its actuators may be moved.
    slew_per_ns, period_ns : float
        The most swings a nanosecond that they may be moved by, and the time between FRAMEs.
    swing, rest_level : float64[rows, columns], int64[rows, columns]
        Levels from rest to full swing, and at rest.
    top_level, bits : int
        The highest level, and how many bits a level takes.
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
        self.swing = gain * enabled / 255 * info.top_level
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
        """Make a FRAME on the way to deflections; whether there is anything to feel in it.

        Parameters
        ----------
        deflections : float64[rows, columns]
            Where the actuators are to be, in [0, 1].
        now_ns
            When; the slew limit is by the time since the frame before. After a longer time than
            a period it is by a period: an actuator that stood still must not make up for it.
        """
        step = math.inf
        if self.limited:
            step = self.slew_per_ns * min(now_ns - self.last_ns, self.period_ns)
        return packing.fill(
            deflections,
            self.last,
            self.wanted,
            step,
            self.swing,
            self.rest_level,
            self.top_level,
            self.bits,
            self.packed,
        )

    def frame(self, sequence: int) -> bytes:
        """FRAME made last, as it goes over the line, with its sequence."""
        return enframe(frame_head(sequence) + self.packed.tobytes())

    def sent(self, now_ns: int) -> None:
        """The FRAME made last has gone out: the actuators go there."""
        self.last, self.wanted = self.wanted, self.last
        self.last_ns = now_ns

    def rested(self, now_ns: int) -> None:
        """Take it that the actuators go to rest by themselves."""
        self.last.fill(0.0)
        self.last_ns = now_ns
