"""Where a carriage is, from what its device counts."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.devices.base import Placing
from vbraille.devices.messages import Encoder
from vbraille.devices.wire import unwrap

if TYPE_CHECKING:
    from vbraille.devices.messages import Info, State


class Place:
    """Place of a carriage in one conversation; the equations of the protocol's page.

    Parameters
    ----------
    info
        The INFO that began the conversation.

    Attributes
    ----------
    placing : Placing
        What is waited for before the place is known.
    known : bool
        Whether a STATE has told it.
    """

    def __init__(self, info: Info) -> None:
        self._bits = info.count_bits
        self._encoder = info.encoder
        self._stop = info.left_stop_count
        # At the left stop the whole array stands before the line.
        self._home_mm = -(info.columns - 1) * info.column_pitch_nm / 2e6
        self._mm_per_count = info.count_sign * 1000 / info.counts_per_m
        self._count: int | None = None  # the one that does not wrap
        self._zero: int | None = None if self._encoder is Encoder.INCREMENTAL else self._stop
        self.known = False
        self.placing = {
            Encoder.ABSOLUTE: Placing.DONE,
            Encoder.INDEX: Placing.MARK,
            Encoder.INCREMENTAL: Placing.STOP,
        }[self._encoder]

    def x_mm(self, state: State) -> float | None:
        """Place of the array's centre by a STATE newer than those before; None if unknown."""
        if self._encoder is Encoder.INDEX and not state.placed:
            self._count, self.known, self.placing = None, False, Placing.MARK
            return None
        if self._count is None:
            incremental = self._encoder is Encoder.INCREMENTAL
            self._count = state.count if incremental else self._stop
        self._count = unwrap(state.count, self._count, self._bits)
        if self._zero is None:
            return None
        self.known, self.placing = True, Placing.DONE
        return self._home_mm + self._mm_per_count * (self._count - self._zero)

    def set_zero(self) -> None:
        """Take it that the carriage is at the left stop, where only the reader can tell."""
        if self._encoder is Encoder.INCREMENTAL and self._count is not None:
            self._zero = self._count
            self.known, self.placing = True, Placing.DONE


class DeviceTime:
    """A device's clock without its wraps; it goes on over a restart of the device."""

    def __init__(self) -> None:
        self._us: int | None = None
        self._offset_ns = 0
        self._last_ns = 0
        self._host_ns: int | None = None

    def restart(self) -> None:
        """Take the device's next time for a fresh one: a conversation begins."""
        self._us = None

    def ns(self, time_us: int, now_ns: int) -> int:
        """Time of a STATE that came now; never before the one before."""
        if self._us is None:
            self._us = time_us
            if self._host_ns is not None:
                self._offset_ns = self._last_ns + now_ns - self._host_ns - time_us * 1000
        self._us = unwrap(time_us, self._us, 32)
        self._host_ns = now_ns
        self._last_ns = max(self._us * 1000 + self._offset_ns, self._last_ns)
        return self._last_ns
