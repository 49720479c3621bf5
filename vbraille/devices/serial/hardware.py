"""The hardware at the other end of a serial line, as its messages tell it.

INFO says what the device is, and what has changed since it was lost. STATEs say where its carriage
is, its time, and its buttons and knobs. FRAMEs have levels for its actuators.
"""

from __future__ import annotations

import math
from enum import IntEnum
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from vbraille.devices import framekernels
from vbraille.devices.base import Particulars
from vbraille.devices.calibration import correction_for
from vbraille.devices.events import Button, Changed, Difference, Knob, Placing
from vbraille.devices.serial.wire import (
    KNOB_STEP,
    KNOB_TOP,
    Encoder,
    Levels,
    enframe,
    frame_head,
    unwrap,
)
from vbraille.display import Display

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from numpy.typing import NDArray

    from vbraille.devices.calibration import Calibration, Correction
    from vbraille.devices.serial.wire import Info, State

# How far the carriage goes, and how finely that is counted, by the fields of INFO.
_AXES: Final = (("travel_um", "counts_per_m"), ("height_um", "y_counts_per_m"))


def misfit(info: Info) -> str:
    """Reason why a device cannot be read on, with fields and values; empty if it can."""
    # One count alone tells where the carriage is when the conversation begins.
    told = 1 << (info.count_bits - 1)
    for way, per_m in _AXES:
        way_um, counts_per_m = getattr(info, way), getattr(info, per_m)
        if way_um and not counts_per_m:
            return f"{way} is {way_um}, and {per_m} is 0; a carriage that goes there counts it"
        counts = way_um * counts_per_m // 1_000_000
        if counts >= told and info.encoder is not Encoder.INCREMENTAL:
            return (
                f"{way} is {way_um}, which takes {counts} counts with a {per_m} of "
                f"{counts_per_m}; it must take less than {told}, half the range of count_bits "
                f"{info.count_bits}"
            )
    return ""


def info_of(info: Info) -> Display:
    """Display of a device, in mm, from what it says of itself."""
    contactor_mm = None
    if info.contactor_width_nm and info.contactor_height_nm:
        contactor_mm = info.contactor_width_nm / 1e6, info.contactor_height_nm / 1e6
    return Display(
        name=info.name,
        rows=info.rows,
        columns=info.columns,
        column_pitch_mm=info.column_pitch_nm / 1e6,
        row_pitch_mm=info.row_pitch_nm / 1e6,
        levels=info.top_level + 1,
        rest_side=info.rest_side.name.lower(),
        travel_mm=info.travel_um / 1e3,
        counts_per_mm=info.counts_per_m / 1e3,
        rate_hz=float(info.rate_hz),
        height_mm=info.height_um / 1e3,
        turns=info.counts_per_turn > 0,
        contactor_mm=contactor_mm,
    )


_ENCODERS: Final = {
    Encoder.ABSOLUTE: "absolute",
    Encoder.INDEX: "relative, with an index mark that must be passed",
    Encoder.INCREMENTAL: "relative, and must be shown the left stop",
}


def particulars_of(info: Info) -> Particulars:
    """Particulars of a device, which reading does not ask for, from what it says of itself."""

    def where(chosen: Iterable[bool]) -> tuple[tuple[int, int], ...]:
        return tuple(divmod(at, info.columns) for at, is_one in enumerate(chosen) if is_one)

    return Particulars(
        firmware=info.firmware,
        encoder=_ENCODERS[info.encoder],
        largest_slew_per_s=info.largest_slew_per_s,
        disabled=where(not (on and gain) for on, gain in zip(info.enabled, info.gain, strict=True)),
        inverted=where(map(bool, info.inverted)),
        protocol=f"serial, version {info.version}",
        buttons=info.buttons,
        knobs=info.knobs,
    )


_OF_DISPLAY: Final = (
    "rows",
    "columns",
    "column_pitch_mm",
    "row_pitch_mm",
    "levels",
    "rest_side",
    "travel_mm",
    "height_mm",
    "turns",
    "rate_hz",
)
# Fields of INFO that may change, and those of them that are the reader's to show where encoders are
# incremental.
_OF_INFO: Final = (
    "name",
    "counts_per_m",
    "count_sign",
    "encoder",
    "y_counts_per_m",
    "y_count_sign",
    "counts_per_turn",
    "turn_sign",
    "left_stop_count",
    "far_stop_count",
    "straight_count",
    "largest_slew_per_s",
)
_SHOWN: Final = ("left_stop_count", "far_stop_count", "straight_count")
_PLACING: Final = {
    Encoder.ABSOLUTE: Placing.DONE,
    Encoder.INDEX: Placing.MARK,
    Encoder.INCREMENTAL: Placing.STOP,
}


def differences(was: Display, now: Display) -> tuple[Difference, ...]:
    """Fields of a device in which it differs from what a page and a loop were made for.

    The name does not count, and neither does the resolution: places are in millimetres.
    """
    both = ((name, getattr(was, name), getattr(now, name)) for name in _OF_DISPLAY)
    return tuple(Difference(name, old, new) for name, old, new in both if old != new)


def changes(was: Info, now: Info) -> Changed | None:
    """Tell what has changed in a device that can be read on, since the conversation before."""
    shown = _SHOWN if now.encoder is Encoder.INCREMENTAL else ()
    both = (
        (name, _said(getattr(was, name)), _said(getattr(now, name)))
        for name in _OF_INFO
        if name not in shown
    )
    changed = Changed(
        tuple(Difference(name, old, new) for name, old, new in both if old != new),
        _others(was.gain, now.gain),
        _others(was.inverted, now.inverted),
        _others(was.enabled, now.enabled),
        _PLACING[now.encoder],
    )
    none = Changed(placing=changed.placing)
    return None if changed == none else changed


def _said(value: int | str) -> int | str:
    """Name of a member of an enumeration; any other value as it is."""
    return value.name.lower() if isinstance(value, IntEnum) else value


def _others(was: bytes, now: bytes) -> int:
    """Number of actuators that have another value."""
    return sum(old != new for old, new in zip(was, now, strict=True))


class CountedPlace(NamedTuple):
    """Place of the array by the encoders of a carriage: its centre, in mm, and its angle."""

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
    """Angle of an array, by counts that begin anew with each turn.

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
        self.placing = _PLACING[self._encoder]

    @property
    def needs_mark(self) -> bool:
        """Tell whether a STATE may say that the place is lost until the mark is passed."""
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


class ButtonsAndKnobs:
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
        """Tell the buttons that were pressed: no hand holds those of an absent device."""
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
    """Tell whether a knob was turned between two of its positions, and does not just jitter.

    Its ends are told however little is left to them: a knob can be turned as far as it goes.
    """
    return abs(now - before) >= KNOB_STEP or (now != before and now in (0, KNOB_TOP))


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
        """Tell whether swings and levels at rest stay as they are from FRAME to FRAME."""
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
