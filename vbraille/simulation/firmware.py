"""A simulated controller: what a device does with bytes and time, without I/O.

It is the minimal firmware of `docs/wire-protocol.md`. Its timer is hardware: what was
due between two ticks happened when it was due, even if the call of `tick` is late.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from vbraille.devices.serial.wire import (
    FAULTY,
    FIRST_STEP,
    KNOB_TOP,
    MOST_BUTTONS,
    MOST_KNOBS,
    NOTICES,
    OUT_OF_REST,
    PACE,
    PLACED,
    RAMP_MS,
    RESTING,
    TRIPPED,
    VERSION,
    WATCHDOG_MS,
    CountSign,
    Decoder,
    Encoder,
    Error,
    Frame,
    Hello,
    Info,
    Levels,
    Rest,
    RestSide,
    State,
    TurnSign,
    Watchdog,
    YCountSign,
    encode,
)
from vbraille.version import __version__

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.devices.serial.wire import Heard
    from vbraille.display import Display

WATCHDOG_US: Final = WATCHDOG_MS * 1000
RAMP_US: Final = RAMP_MS * 1000
# Place of an index encoder's mark; on a carriage that hardly goes so far it is halfway.
MARK_MM: Final = 10.0
# Error of an encoder that does not know its place: a count that is not 0 in any number of bits.
ASTRAY: Final = 12_345
_U16, _U32 = 0xFFFF, 0xFFFF_FFFF


class Controller:
    """A device's controller, from the moment it starts.

    Its clock is given by the caller: plain microseconds, which never wrap or go back.

    Parameters
    ----------
    info
        What the device says of itself.

    Attributes
    ----------
    buttons : int
        Bit 0 is the first button; 1 while it is pressed.
    knobs : list[float]
        Position of each knob, 0 to 1.
    force_mn : int | None
        How hard the finger presses on the array, in mN; None if that is not measured.
    levels : uint16[rows · columns]
        Level at which each actuator stands.
    at_rest : bool
        Whether the actuators have come to rest, and no FRAME has been taken since.
    greeted, faulty, placed : bool
        Whether a host of the same version has said HELLO, whether an ERROR stands, and whether
        counts tell the true place.
    greetings, trips, frames : int
        Numbers of HELLOs of the same version, of trips of the watchdog, and of FRAMEs taken.
    last_frame_us : int
        When the last FRAME was taken; 0 before the first.
    watchdog_us : int or None
        Time without a FRAME until the watchdog trips; None is never, which no device may do.
    acknowledges : bool
        Whether STATE tells which FRAME was taken last, as it must.
    rest_after_us : int | None
        How long after that FRAME the actuators were at rest, the last time that they went there.
    """

    def __init__(self, info: Info) -> None:
        self.info = info
        self.buttons = 0
        self.knobs = [0.0] * info.knobs
        self.force_mn: int | None = None
        self.greeted = self.faulty = False
        self.placed = info.encoder is Encoder.ABSOLUTE
        self.greetings = self.trips = self.frames = 0
        self.last_frame_us = 0
        self.watchdog_us: int | None = WATCHDOG_US
        self.acknowledges = True
        self.rest_after_us: int | None = None
        self._packing = Levels(info.rows * info.columns, info.top_level)
        self._rest = np.frombuffer(info.inverted, np.uint8).astype(np.uint16) * info.top_level
        self.levels: NDArray[np.uint16] = self._rest
        self._wanted = self._rest  # levels of the FRAME taken last
        self._behind = 0  # by how many FRAMEs the actuators are behind that one
        self._gone = 0  # how many FRAMEs have moved them at once since the last tick: 1 at most
        self._recently = 0  # how many have in the period before that tick, and at it
        self._waiting: Frame | None = None  # the last FRAME that came at rest since the last tick
        self.at_rest = True
        self._ramp_us: int | None = None  # when the ramp began
        self._ramp_from = self.levels
        self._decoder = Decoder()
        self._misfits = 0
        self._armed = self._tripped = False
        self._now_us = 0
        self._sequence = self._frame_sequence = 0
        self._timer_us: int | None = None  # when the timer ticked first
        self._way_mm: float | None = None
        self._astray = 0 if self.placed else ASTRAY

    @property
    def dropped(self) -> int:
        """Number of frames that were received and could not be used."""
        return sum(self._decoder.dropped.values()) + self._misfits

    @property
    def resting(self) -> bool:
        """Tell whether no FRAME holds the actuators: they are at rest, or on the ramp to it."""
        return self.at_rest or self._ramp_us is not None

    @property
    def mark_mm(self) -> float:
        """Distance from the left stop to the mark of an index encoder."""
        return min(MARK_MM, self.info.travel_um / 2000)

    def receive(self, chunk: bytes, now_us: int) -> bytes:
        """Take bytes from the host; give the bytes that go back."""
        self._now_us = now_us
        answers = [self._take(event) for event in self._decoder.feed(chunk)]
        return b"".join(answers)

    def tick(self, now_us: int, way_mm: float, y_mm: float = 0.0, theta_rad: float = 0.0) -> bytes:
        """Do what a controller does `rate_hz` times a second; give the bytes that go to the host.

        Parameters
        ----------
        now_us
            Time by the controller's clock.
        way_mm
            Distance of the carriage from the left stop.
        y_mm
            Distance of the carriage from the far stop; of no matter without that axis.
        theta_rad
            Angle of the array, against the clock; of no matter where none is measured.
        """
        self._now_us = now_us
        if self._timer_us is None:
            self._timer_us = now_us
        said = self._watch() if self._armed else b""
        if self._ramp_us is not None:
            self._step_ramp(self._ramp_us)
        said += self._leave_rest()
        self._step()
        self._sequence = (self._sequence + 1) & _U16
        count = self._count(way_mm)
        return said + self._state(count, y_mm, theta_rad) if self.greeted else b""

    def skip(self, ticks: int) -> None:
        """Skip ticks as if they had been missed, and drop their STATEs."""
        self._sequence = (self._sequence + ticks) & _U16

    def fault(self, code: int, text: str) -> bytes:
        """Report that something is wrong; give the bytes that go to the host.

        A code from 128 on makes a notice, any other an ERROR.

        Raises
        ------
        ValueError
            If the wire allows no such code or text.
        """
        said = encode(Error(code, text))
        if code < NOTICES:
            self.faulty = True
            self._go_to_rest()
        return said if self.greeted else b""

    def hang_up(self) -> None:
        """Lose the line, not the power: be silent until the next HELLO, while all else goes on."""
        self.greeted = False
        dropped = self._decoder.dropped
        self._decoder = Decoder()  # what has come of a message is gone
        self._decoder.dropped = dropped

    def _take(self, event: Heard) -> bytes:
        match event:
            case Frame():
                return self._take_frame(event)
            case Hello():
                self.faulty = False
                self._go_to_rest()
                self.greeted = event.version == self.info.version
                self.greetings += self.greeted
                return encode(self.info) + self._watchdog()
            case Rest():
                self._go_to_rest()
            case _:  # a message of a device's
                self._misfits += 1
        return b""

    def _take_frame(self, frame: Frame) -> bytes:
        if not self.greeted or self.faulty:
            return b""
        try:
            levels = self._packing.unpack(frame.packed)
        except ValueError:
            self._misfits += 1
            return b""
        return self._follow(frame, levels)

    def _follow(self, frame: Frame, levels: NDArray[np.uint16]) -> bytes:
        """Have the actuators follow a FRAME, unless it is an old one that came late.

        The host may not know that they went to rest. If nothing was lost or held up, they go at
        once; otherwise FRAMEs would move them all together.
        """
        if self._ramp_us is not None:
            return b""
        if self.at_rest:
            self._waiting = frame
            return b""
        steps = (frame.sequence - self._frame_sequence) & _U16
        if not 0 < steps <= _U16 // 2:
            self._misfits += 1
            return b""
        self._behind += steps
        said = self._hold(frame.sequence, levels)
        if self._behind == 1 and not self._gone and self._recently < PACE:
            self.levels, self._behind, self._gone = levels, 0, 1
        return said

    def _hold(self, sequence: int, levels: NDArray[np.uint16]) -> bytes:
        """Take a FRAME: it is what the actuators go to, and it feeds the watchdog."""
        self._wanted = levels
        self._ramp_us = None
        self.at_rest = False
        self.frames += 1
        self._frame_sequence = sequence
        self.last_frame_us = self._now_us
        self._armed = True
        if not self._tripped:
            return b""
        self._tripped = False
        return self._watchdog()

    def _leave_rest(self) -> bytes:
        """Take the last FRAME that waits at rest, if it is near rest."""
        frame, self._waiting = self._waiting, None
        if frame is None:
            return b""
        levels = self._packing.unpack(frame.packed)
        if np.abs(levels.astype(np.int64) - self._rest).max() * FIRST_STEP > self.info.top_level:
            return b""
        self._behind = OUT_OF_REST
        return self._hold(frame.sequence, levels)

    def _step(self) -> None:
        """Go on towards the last FRAME, as far as `PACE` FRAMEs go in a period."""
        if np.array_equal(self.levels, self._wanted):
            self._behind = 0
        steps = min(self._behind, PACE - self._gone)
        self._recently, self._gone = self._gone + steps, 0
        if 0 < steps < self._behind:
            way = self._wanted - self.levels.astype(np.float64)
            self.levels = np.rint(self.levels + way * steps / self._behind).astype(np.uint16)
        elif steps:
            self.levels = self._wanted
        self._behind -= steps

    def _go_to_rest(self) -> None:
        self._armed = self._tripped = False
        self._start_ramp(self._now_us)

    def _watch(self) -> bytes:
        """Trip the watchdog if its time is up."""
        watchdog_us = self.watchdog_us
        if watchdog_us is None or self._now_us - self.last_frame_us < watchdog_us:
            return b""
        self._armed, self._tripped = False, True
        self.trips += 1
        self._start_ramp(self._due(self.last_frame_us + watchdog_us))
        return self._watchdog()

    def _start_ramp(self, begun_us: int) -> None:
        self._behind, self._waiting = 0, None
        # A ramp on its way goes on: begun anew it would take longer than the watchdog promises.
        if not self.at_rest and self._ramp_us is None:
            self._ramp_us = begun_us
            self._ramp_from = self.levels

    def _step_ramp(self, begun_us: int) -> None:
        done = (self._now_us - begun_us) / RAMP_US
        if done < 1:
            way = self._rest - self._ramp_from.astype(np.float64)
            self.levels = np.rint(self._ramp_from + done * way).astype(np.uint16)
            return
        self.levels = self._rest
        self.at_rest = True
        self._ramp_us = None
        self.rest_after_us = self._due(begun_us + RAMP_US) - self.last_frame_us

    def _due(self, due_us: int) -> int:
        """Time at which the timer saw to what was due: its first tick from then on."""
        first_us, rate_hz = self._timer_us or 0, self.info.rate_hz
        ticks = -(-(due_us - first_us) * rate_hz // 1_000_000)
        return min(first_us + round(ticks * 1_000_000 / rate_hz), self._now_us)

    def _count(self, way_mm: float) -> int:
        """Count of the encoder at a place; on the way there it may have passed its index."""
        info = self.info
        if info.encoder is Encoder.INDEX and not self.placed and self._way_mm is not None:
            low_mm, high_mm = sorted((self._way_mm, way_mm))
            if low_mm <= self.mark_mm <= high_mm:
                self.placed, self._astray = True, 0
        self._way_mm = way_mm
        counts = info.count_sign * round(way_mm * info.counts_per_m / 1000)
        return (info.left_stop_count + self._astray + counts) & ((1 << info.count_bits) - 1)

    def _flags(self) -> int:
        return (
            PLACED * self.placed
            | RESTING * self.resting
            | FAULTY * self.faulty
            | TRIPPED * self._tripped
        )

    def _state(self, count: int, y_mm: float, theta_rad: float) -> bytes:
        info = self.info
        y_counts = info.y_count_sign * round(y_mm * info.y_counts_per_m / 1000)
        y_count = (info.far_stop_count + self._astray + y_counts) & ((1 << info.count_bits) - 1)
        turn = info.counts_per_turn
        turned = info.turn_sign * round(theta_rad / (2 * math.pi) * turn)
        return encode(
            State(
                self._sequence,
                self._now_us & _U32,
                count,
                self._frame_sequence if self.acknowledges else 0,
                self._flags(),
                self.buttons,
                self.force_mn,
                y_count=y_count if info.height_um else 0,
                theta_count=(info.straight_count + self._astray + turned) % turn if turn else 0,
                knobs=sum(
                    round(position * KNOB_TOP) << (8 * knob)
                    for knob, position in enumerate(self.knobs)
                ),
            )
        )

    def _watchdog(self) -> bytes:
        return encode(Watchdog(self.trips & _U32, self.dropped & _U32))


# Counts before a described encoder wraps, few so that it wraps on the way: 100 mm of 5 µm.
BEFORE_WRAP: Final = 20_000
# Counts of a simulated angle: 0.0055 degrees each.
COUNTS_PER_TURN: Final = 65_536


def describe(display: Display, encoder: Encoder) -> Info:
    """INFO of a device whose actuators are all alike, and whose encoders wrap on the way.

    It has all the buttons and knobs that there is room for.

    Raises
    ------
    ValueError
        If a number does not fit into its field on the wire.
    """
    actuators = display.rows * display.columns
    counts = round(max(display.travel_mm, display.height_mm) * display.counts_per_mm)
    count_bits = min(max(24, counts.bit_length() + 1), 32)  # the travel is below half the range
    counts_per_m = round(display.counts_per_mm * 1e3)
    stop_count = 0 if encoder is Encoder.INCREMENTAL else (1 << count_bits) - BEFORE_WRAP
    width_mm, height_mm = display.contactor_mm or (0.0, 0.0)
    return Info(
        version=VERSION,
        rows=display.rows,
        columns=display.columns,
        column_pitch_nm=round(display.column_pitch_mm * 1e6),
        row_pitch_nm=round(display.row_pitch_mm * 1e6),
        rest_side=RestSide[display.rest_side.upper()],
        top_level=display.levels - 1,
        rate_hz=round(display.rate_hz),
        largest_slew_per_s=0,
        travel_um=round(display.travel_mm * 1e3),
        encoder=encoder,
        counts_per_m=counts_per_m,
        count_sign=CountSign.RIGHTWARD,
        count_bits=count_bits,
        left_stop_count=stop_count,
        name=display.name,
        firmware=__version__,
        inverted=bytes(actuators),
        gain=b"\xff" * actuators,
        enabled=b"\1" * actuators,
        buttons=MOST_BUTTONS,
        knobs=MOST_KNOBS,
        contactor_width_nm=round(width_mm * 1e6),
        contactor_height_nm=round(height_mm * 1e6),
        height_um=round(display.height_mm * 1e3),
        y_counts_per_m=counts_per_m if display.height_mm else 0,
        y_count_sign=YCountSign.TOWARDS,
        far_stop_count=stop_count,
        counts_per_turn=COUNTS_PER_TURN if display.turns else 0,
        turn_sign=TurnSign.ANTICLOCKWISE,
        straight_count=0,
    )
