"""Deflections into FRAMEs: gain, polarity, broken actuators, and the fastest that they may move."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vbraille.devices.messages import Frame
from vbraille.devices.wire import Levels, encode

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.devices.messages import Info

_NS_PER_S = 1e9


class Drive:
    """What the actuators are told; the formula of the protocol's page, section Levels.

    Parameters
    ----------
    info
        The INFO that began the conversation.
    now_ns
        When: the actuators are at rest.
    """

    def __init__(self, info: Info, now_ns: int) -> None:
        shape = info.rows, info.columns
        gain, enabled, inverted = (
            np.frombuffer(given, np.uint8).reshape(shape).astype(np.float64)
            for given in (info.gain, info.enabled, info.inverted)
        )
        self._swing = gain * info.top_level / 255 * enabled
        self._sign = 1 - 2 * inverted
        self._rest_level = inverted * info.top_level
        self._straight = not inverted.any()
        self._slew_per_ns = info.largest_slew_per_s / _NS_PER_S
        self._packing = Levels(info.rows * info.columns, info.top_level)
        self._wanted = np.zeros(shape)
        self._last = np.zeros(shape)
        self._work = np.zeros(shape)
        self._levels = np.zeros(shape, np.uint16)
        self._last_ns = now_ns

    def frame(self, sequence: int, deflections: NDArray[np.float64], now_ns: int) -> bytes:
        """FRAME on the way to deflections, as it goes over the line.

        Parameters
        ----------
        sequence
            Of the FRAME.
        deflections : float64[rows, columns]
            In [0, 1].
        now_ns
            When; the slew limit is by the time since the frame before.
        """
        work = self._work
        if self._slew_per_ns:
            deflections = self._slow(deflections, now_ns)
        np.multiply(deflections, self._swing, out=work)
        np.rint(work, out=work)
        if not self._straight:
            np.multiply(work, self._sign, out=work)
            np.add(work, self._rest_level, out=work)
        np.copyto(self._levels, work, casting="unsafe")
        return encode(Frame(sequence, self._packing.pack(self._levels)))

    def _slow(self, deflections: NDArray[np.float64], now_ns: int) -> NDArray[np.float64]:
        """As far towards deflections as the actuators may move in the time."""
        wanted, work = self._wanted, self._work
        step = self._slew_per_ns * (now_ns - self._last_ns)
        np.add(self._last, step, out=work)
        np.minimum(deflections, work, out=wanted)
        np.subtract(self._last, step, out=work)
        return np.maximum(wanted, work, out=wanted)

    def sent(self, now_ns: int) -> None:
        """The FRAME made last has gone out: the actuators go there."""
        self._last, self._wanted = self._wanted, self._last
        self._last_ns = now_ns

    @property
    def behind(self) -> bool:
        """Whether the slew limit still keeps an actuator off its rest."""
        return bool(self._last.any())

    def rested(self, now_ns: int) -> None:
        """The actuators go to rest by themselves."""
        self._last.fill(0.0)
        self._last_ns = now_ns
