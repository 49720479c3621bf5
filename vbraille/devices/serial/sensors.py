"""STATEs of a device: where its carriage is, its clock, and its buttons and knobs."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, NamedTuple

from vbraille.devices.events import Button, Knob, Placing
from vbraille.devices.serial.wire import KNOB_STEP, KNOB_TOP, Encoder, unwrap

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.devices.serial.wire import Info, State


class CountedPlace(NamedTuple):
    """What the encoders of a carriage say of the array: its centre, in mm, and its angle."""

    x_mm: float
    y_mm: float = 0.0
    theta_rad: float = 0.0


class CountedAxis:
    """One axis of a carriage, along which counts wrap.

    Parameters
    ----------
    bits
        Number of bits in the counter that is sent.
    stop
        Count at the stop where the way begins; None if the reader has to show it.
    home_mm
        Place of the array's centre there.
    mm_per_count
        Length of a count; negative where counts fall on the way from the stop.

    Attributes
    ----------
    count, zero : int or None
        Count without wraps, and the count at the stop; None before they are known.
    """

    def __init__(self, bits: int, stop: int | None, home_mm: float, mm_per_count: float) -> None:
        self.bits = bits
        self.home_mm, self.mm_per_count = home_mm, mm_per_count
        self.count: int | None = None
        self.zero = self._stop = stop

    def take(self, count: int) -> None:
        """Take a count that was sent, newer than those before."""
        if self.count is None:
            self.count = count if self._stop is None else self._stop
        self.count = unwrap(count, self.count, self.bits)

    def set_zero(self) -> None:
        """Take the present count for that at the stop."""
        self.zero = self.count

    @property
    def place_mm(self) -> float | None:
        """Place of the array's centre; None if it is not known."""
        if self.count is None or self.zero is None:
            return None
        return self.home_mm + self.mm_per_count * (self.count - self.zero)


class CountedTurn:
    """How far an array is turned, by counts that begin anew with each turn.

    Parameters
    ----------
    counts_per_turn
        Number of counts in a turn, above 0.
    straight
        Count where the array is not turned; None if the reader has to show it.
    sign
        1 if counts grow as the array turns against the clock, -1 if they fall.

    Attributes
    ----------
    rad_per_count : float
        Angle of a count.
    """

    def __init__(self, counts_per_turn: int, straight: int | None, sign: int) -> None:
        self.counts_per_turn, self.straight = counts_per_turn, straight
        self.rad_per_count = sign * 2 * math.pi / counts_per_turn
        self.count = 0

    @property
    def theta_rad(self) -> float:
        """Angle of the array, at most half a turn either way."""
        half = self.counts_per_turn // 2
        away = (self.count - (self.straight or 0) + half) % self.counts_per_turn - half
        return self.rad_per_count * away


class CarriagePlace:
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
    x : CountedAxis
        Axis along the lines.
    y : CountedAxis or None
        Axis across the lines; None if the carriage has none.
    turn : CountedTurn or None
        Angle of the array; None if it is not measured.
    """

    def __init__(self, info: Info) -> None:
        self._encoder = info.encoder

        def shown(count: int) -> int | None:
            return None if self._encoder is Encoder.INCREMENTAL else count

        # At the left stop the whole array stands before the line, and at the far one its middle is
        # at the top of the page.
        home_mm = -(info.columns - 1) * info.column_pitch_nm / 2e6
        bits, stop = info.count_bits, shown(info.left_stop_count)
        self.x = CountedAxis(bits, stop, home_mm, info.count_sign * 1000 / info.counts_per_m)
        self.y: CountedAxis | None = None
        self.turn: CountedTurn | None = None
        if info.height_um:
            mm_per_count = info.y_count_sign * 1000 / info.y_counts_per_m
            self.y = CountedAxis(bits, shown(info.far_stop_count), 0.0, mm_per_count)
        if info.counts_per_turn:
            straight = shown(info.straight_count)
            self.turn = CountedTurn(info.counts_per_turn, straight, info.turn_sign)
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

    def take(self, state: State) -> CountedPlace | None:
        """Place of the array's centre by a STATE newer than those before; None if unknown."""
        x, y, turn = self.x, self.y, self.turn
        if self._encoder is Encoder.INDEX and not state.placed:
            x.count, self.known, self.placing = None, False, Placing.MARK
            if y is not None:
                y.count = None
            return None
        x.take(state.count)
        if y is not None:
            y.take(state.y_count)
        if turn is not None:
            turn.count = state.theta_count
        x_mm, y_mm = x.place_mm, 0.0 if y is None else y.place_mm
        if x_mm is None or y_mm is None:
            return None
        self.known, self.placing = True, Placing.DONE
        return CountedPlace(x_mm, y_mm, 0.0 if turn is None else turn.theta_rad)

    def set_zero(self) -> None:
        """Take the carriage to be at its stops and straight, where only the reader can tell."""
        if self._encoder is not Encoder.INCREMENTAL or self.x.count is None:
            return
        self.x.set_zero()
        if self.y is not None:
            self.y.set_zero()
        if self.turn is not None:
            self.turn.straight = self.turn.count
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


_BITS: Final = 8  # of a knob's position


class Panel:
    """Buttons and knobs as they were when they were last told.

    Attributes
    ----------
    buttons_fitted, knobs_fitted : int
        Number of buttons and of knobs that the device says it has; bits and bytes of others are not
        read.
    buttons : int or None
        Bits of the buttons that are pressed; None before the first STATE of all, and of a device
        that was unplugged.
    knobs : int or None
        Positions of the knobs when they were last told, a byte each; None before the first STATE
        of all.
    """

    def __init__(self) -> None:
        self.buttons_fitted = self.knobs_fitted = 0
        self.buttons: int | None = None
        self.knobs: int | None = None

    def fit(self, buttons: int, knobs: int) -> None:
        """Take so many buttons and knobs to be there."""
        self.buttons_fitted, self.knobs_fitted = buttons, knobs

    def take(self, state: State, now_ns: int) -> Iterator[Button | Knob]:
        """Tell what has changed by a new STATE; the first of all changes nothing."""
        yield from self._press(state.buttons, now_ns)
        yield from self._turn(state.knobs)

    def let_go(self, now_ns: int) -> Iterator[Button]:
        """Tell the buttons that were pressed: nobody holds those of a device that is not there."""
        if self.buttons:
            yield from self._press(0, now_ns)
        self.buttons = None

    def _press(self, told: int, now_ns: int) -> Iterator[Button]:
        before, self.buttons = self.buttons, told & ((1 << self.buttons_fitted) - 1)
        changed = 0 if before is None else before ^ self.buttons
        for bit in range(self.buttons_fitted if changed else 0):
            if changed >> bit & 1:
                yield Button(bit + 1, pressed=bool(self.buttons >> bit & 1), at_ns=now_ns)

    def _turn(self, told: int) -> Iterator[Knob]:
        if self.knobs is None:
            self.knobs = told
        if told == self.knobs:
            return
        for knob in range(self.knobs_fitted):
            shift = knob * _BITS
            before, now = self.knobs >> shift & KNOB_TOP, told >> shift & KNOB_TOP
            if turned(before, now):
                self.knobs += (now - before) << shift
                yield Knob(knob + 1, now / KNOB_TOP)


def turned(before: int, now: int) -> bool:
    """Whether a knob was turned between two of its positions, and does not just jitter.

    Its ends are told however little is left to them: a knob can be turned as far as it goes.
    """
    return abs(now - before) >= KNOB_STEP or (now != before and now in (0, KNOB_TOP))
