"""Where a carriage is, from what its device counts."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.devices.events import Placing
from vbraille.devices.wire.codec import unwrap
from vbraille.devices.wire.messages import Encoder

if TYPE_CHECKING:
    from vbraille.devices.wire.messages import Info, State


class Place:
    """Place of a carriage in one conversation, by the equations of the protocol's page.

    Parameters
    ----------
    info
        INFO that began the conversation.

    Attributes
    ----------
    placing : Placing
        What is waited for before the place is known.
    known : bool
        Whether a STATE has told the place.
    count, zero : int or None
        Count without wraps, and the count at the left stop; None before they are known.
    bits : int
        Number of bits in the counter that is sent.
    home_mm, mm_per_count : float
        Place at the left stop, and length of a count.
    """

    def __init__(self, info: Info) -> None:
        self.bits = info.count_bits
        self._encoder = info.encoder
        self._stop = info.left_stop_count
        # At the left stop the whole array stands before the line.
        self.home_mm = -(info.columns - 1) * info.column_pitch_nm / 2e6
        self.mm_per_count = info.count_sign * 1000 / info.counts_per_m
        self.count: int | None = None  # the count without wraps
        self.zero: int | None = None if self._encoder is Encoder.INCREMENTAL else self._stop
        self.known = False
        self.placing = {
            Encoder.ABSOLUTE: Placing.DONE,
            Encoder.INDEX: Placing.MARK,
            Encoder.INCREMENTAL: Placing.STOP,
        }[self._encoder]

    @property
    def needs_mark(self) -> bool:
        """Whether a STATE may say that the place is lost until the carriage passes the mark."""
        return self._encoder is Encoder.INDEX

    def x_mm(self, state: State) -> float | None:
        """Place of the array's centre by a STATE newer than those before; None if unknown."""
        if self._encoder is Encoder.INDEX and not state.placed:
            self.count, self.known, self.placing = None, False, Placing.MARK
            return None
        if self.count is None:
            incremental = self._encoder is Encoder.INCREMENTAL
            self.count = state.count if incremental else self._stop
        self.count = unwrap(state.count, self.count, self.bits)
        if self.zero is None:
            return None
        self.known, self.placing = True, Placing.DONE
        return self.home_mm + self.mm_per_count * (self.count - self.zero)

    def set_zero(self) -> None:
        """Take the carriage's place for the left stop, where only the reader can tell."""
        if self._encoder is Encoder.INCREMENTAL and self.count is not None:
            self.zero = self.count
            self.known, self.placing = True, Placing.DONE


class DeviceTime:
    """A device's clock without its wraps; it goes on when the device restarts.

    Attributes
    ----------
    us : int or None
        Time by the device's clock without wraps; None before the first time of a conversation.
    offset_ns : int
        Time that is added, so that the clock goes on.
    last_ns : int
        Last time that was given.
    host_ns : int or None
        When that was, by the host's clock; None before the first time.
    """

    def __init__(self) -> None:
        self.us: int | None = None
        self.offset_ns = 0
        self.last_ns = 0
        self.host_ns: int | None = None

    def restart(self) -> None:
        """Take the device's next time for a fresh one, since a conversation begins."""
        self.us = None

    def ns(self, time_us: int, now_ns: int) -> int:
        """Time of a STATE that came now; never earlier than the time before."""
        if self.us is None:
            self.us = time_us
            if self.host_ns is not None:
                self.offset_ns = self.last_ns + now_ns - self.host_ns - time_us * 1000
        self.us = unwrap(time_us, self.us, 32)
        self.host_ns = now_ns
        self.last_ns = max(self.us * 1000 + self.offset_ns, self.last_ns)
        return self.last_ns
