"""What a host and a device say to each other: the one table of messages.

A message is a class whose annotations say what each field may be and how it goes over the wire.
`codec` encodes, decodes and checks by these annotations; `docs/wire-protocol.md`
is the same table for people who write firmware.
"""

from dataclasses import dataclass
from enum import IntEnum
from typing import Annotated, Final

from vbraille.devices.wire.fields import (
    Message,
    Number,
    OneOf,
    Packed,
    PerActuator,
    ShortText,
)

VERSION: Final = 2

# A device without a valid FRAME for so long begins a ramp to rest, which takes so long.
WATCHDOG_MS: Final = 50
RAMP_MS: Final = 20
# A host that has sent no FRAME for so long takes it that the watchdog trips meanwhile: the device
# counts from when a FRAME arrives, and FRAMEs may be late by some milliseconds.
STALL_MS: Final = 40
# A host asks HELLO so often, and gives a device so long to answer (boards restart when opened).
HELLO_PERIOD_MS: Final = 250
ANSWER_MS: Final = 3000
# A host without a STATE for so long sends REST; for so long, begins again with HELLO.
SILENCE_MS: Final = 100
LOST_MS: Final = 500

# Error.code from here on is a notice.
NOTICES: Final = 0x80
# Bits of State.flags.
PLACED: Final = 0x01
RESTING: Final = 0x02
FAULTY: Final = 0x04
TRIPPED: Final = 0x08
# A device that is at rest leaves it by no more than this part of the swing at once.
FIRST_STEP: Final = 20
# It goes so many FRAMEs far in a period, and is so many behind with the one that ends a rest.
PACE: Final = 2
OUT_OF_REST: Final = 5

U8: Final = Number("B", 0, 0xFF)
U16: Final = Number("H", 0, 0xFFFF)
U32: Final = Number("I", 0, 0xFFFF_FFFF)
MICROSECONDS: Final = Number("I", 0, 0xFFFF_FFFF, "µs")
FORCE: Final = Number("h", -0x7FFF, 0x7FFF, "mN", none=-0x8000)
PITCH: Final = Number("I", 50_000, 50_000_000, "nm")
CONTACTOR: Final = Number("I", 0, 50_000_000, "nm")
# Room for buttons and knobs in STATE; the position of a knob is a byte.
MOST_BUTTONS: Final = 8
MOST_KNOBS: Final = 4
KNOB_TOP: Final = 0xFF
# A knob that stands still may jitter by less than this, and is not told to have been turned.
KNOB_STEP: Final = 3


class RestSide(IntEnum):
    """Where an actuator at deflection 0 stands."""

    LEFT = 0
    RIGHT = 1


class Encoder(IntEnum):
    """What an encoder knows of its place when it is switched on."""

    ABSOLUTE = 0  # all
    INDEX = 1  # nothing until it has passed its index mark
    INCREMENTAL = 2  # nothing until the reader has shown it the left stop


class CountSign(IntEnum):
    """Which way counts grow."""

    RIGHTWARD = 1
    LEFTWARD = -1


class TurnSign(IntEnum):
    """Which way the array turns when its counts grow, as the reader sees it."""

    ANTICLOCKWISE = 1
    CLOCKWISE = -1


class YCountSign(IntEnum):
    """Which way the carriage goes when the counts of y grow: towards the reader, or away."""

    TOWARDS = 1
    AWAY = -1


class ErrorCode(IntEnum):
    """What a device may complain of; it rests, but with a code from `NOTICES` on it goes on."""

    ENCODER = 1
    ACTUATORS = 2
    TEMPERATURE = 3
    OTHER = 127
    NOTICE = 255


@dataclass(frozen=True, slots=True)
class Hello(Message):
    """Host: who are you? The device rests, and answers INFO and WATCHDOG."""

    version: Annotated[int, Number("B", 1, 0xFF)] = VERSION


@dataclass(frozen=True, slots=True)
class Frame(Message):
    """Host: a level for every actuator, as `wire.Levels` packs them."""

    sequence: Annotated[int, U16]
    packed: Annotated[bytes, Packed(most=2048)]


@dataclass(frozen=True, slots=True)
class Rest(Message):
    """Host: all actuators to rest, until the next FRAME."""


@dataclass(frozen=True, slots=True)
class Info(Message):
    """Device: a description of itself. Row 0 is far from the reader, column 0 is the left one.

    A level of 0 is rest and `top_level` is full swing, or the other way round
    where `inverted` is 1. `left_stop_count` has no meaning where the encoder is
    incremental; a `largest_slew_per_s` of 0 is no limit. A contactor of 0 × 0 is one whose size is
    not known, a `height_um` of 0 a carriage of one axis, and `counts_per_turn` is 0 where no angle
    is measured. Fields of an axis that is not there have no meaning.
    """

    version: Annotated[int, Number("B", VERSION, VERSION)]
    rows: Annotated[int, Number("B", 1, 16)]
    columns: Annotated[int, Number("B", 1, 64)]
    column_pitch_nm: Annotated[int, PITCH]
    row_pitch_nm: Annotated[int, PITCH]
    rest_side: Annotated[RestSide, OneOf("B", RestSide)]
    top_level: Annotated[int, Number("H", 1, 0xFFFF)]
    rate_hz: Annotated[int, Number("H", 50, 10_000, "Hz")]
    largest_slew_per_s: Annotated[int, Number("H", 0, 0xFFFF, "swings/s")]
    travel_um: Annotated[int, Number("I", 1, 10_000_000, "µm")]
    encoder: Annotated[Encoder, OneOf("B", Encoder)]
    counts_per_m: Annotated[int, Number("I", 1, 0xFFFF_FFFF, "1/m")]
    count_sign: Annotated[CountSign, OneOf("b", CountSign)]
    count_bits: Annotated[int, Number("B", 8, 32, "bits")]
    left_stop_count: Annotated[int, U32]
    name: Annotated[str, ShortText(fewest=1)]
    firmware: Annotated[str, ShortText(fewest=0)]
    inverted: Annotated[bytes, PerActuator(high=1)]
    gain: Annotated[bytes, PerActuator(high=0xFF)]
    enabled: Annotated[bytes, PerActuator(high=1)]
    buttons: Annotated[int, Number("B", 0, MOST_BUTTONS)]
    knobs: Annotated[int, Number("B", 0, MOST_KNOBS)]
    contactor_width_nm: Annotated[int, CONTACTOR]
    contactor_height_nm: Annotated[int, CONTACTOR]
    height_um: Annotated[int, Number("I", 0, 10_000_000, "µm")]
    y_counts_per_m: Annotated[int, Number("I", 0, 0xFFFF_FFFF, "1/m")]
    y_count_sign: Annotated[YCountSign, OneOf("b", YCountSign)]
    far_stop_count: Annotated[int, U32]
    counts_per_turn: Annotated[int, U32]
    turn_sign: Annotated[TurnSign, OneOf("b", TurnSign)]
    straight_count: Annotated[int, U32]


@dataclass(frozen=True, slots=True)
class State(Message):
    """Device: where its carriage is, and what else it feels; `rate_hz` a second.

    The knobs are a byte each, that of knob 1 the lowest.
    """

    sequence: Annotated[int, U16]
    time_us: Annotated[int, MICROSECONDS]
    count: Annotated[int, U32]
    frame_sequence: Annotated[int, U16]
    flags: Annotated[int, U8]
    buttons: Annotated[int, U8]
    force_mn: Annotated[int | None, FORCE]
    y_count: Annotated[int, U32]
    theta_count: Annotated[int, U32]
    knobs: Annotated[int, U32]

    @property
    def placed(self) -> bool:
        """Whether counts say where the carriage is without the reader's help."""
        return bool(self.flags & PLACED)

    @property
    def resting(self) -> bool:
        """Whether the actuators are at rest, or on their way to it."""
        return bool(self.flags & RESTING)

    @property
    def faulty(self) -> bool:
        """Whether the device takes no FRAME until the next HELLO."""
        return bool(self.flags & FAULTY)

    @property
    def tripped(self) -> bool:
        """Whether the watchdog has tripped and no FRAME was taken since."""
        return bool(self.flags & TRIPPED)


@dataclass(frozen=True, slots=True)
class Watchdog(Message):
    """Device: how often its watchdog tripped, and how many frames it dropped, since it started."""

    trips: Annotated[int, U32]
    dropped: Annotated[int, U32]


@dataclass(frozen=True, slots=True)
class Error(Message):
    """Device: what is wrong with it; `ErrorCode`, or a code of its maker's own."""

    code: Annotated[int, U8]
    text: Annotated[str, ShortText(fewest=0)]


# Types from 0x80 on are a device's. INFO has one type in all versions.
MESSAGES: Final[dict[int, type[Message]]] = {
    0x01: Hello,
    0x02: Frame,
    0x03: Rest,
    0x81: Info,
    0x83: Watchdog,
    0x84: Error,
    0x85: State,
}
