"""The wire protocol, version 3, as the host speaks it: no port, no clock, no thread.

`Conversation` is given bytes and times, and gives bytes to send, poses and events.
`docs/wire-protocol.md` is the specification; `firmware/vbraille.h` is the other end.
"""

from __future__ import annotations

import json
import math
import random
import struct
import zlib
from enum import Enum
from typing import Annotated, Final, Literal, NamedTuple

import msgspec
from cobs import cobs

from vbraille.devices.events import (
    Back,
    Event,
    Knob,
    Notice,
    Silent,
    SlowActuators,
    WatchdogTripped,
    moved,
)
from vbraille.display import Display, Pose
from vbraille.errors import DeviceError
from vbraille.wording import printable

VERSION: Final = 3
HELLO, FRAME, ZERO, INFO, STATE, SAY = 0x01, 0x02, 0x03, 0x81, 0x82, 0x83
PLACED, WAITING, FAULT = 1, 2, 4  # flags of a STATE
MOST_ACTUATORS: Final = 255
PIECE_BYTES: Final = 48
MOST_PIECES: Final = 32
KNOB_TOP: Final = 255

_MS: Final = 1_000_000
HELLO_NS: Final = 250 * _MS  # HELLO is repeated
REST_NS: Final = 50 * _MS  # REST and ZERO are repeated
STALL_NS: Final = 40 * _MS  # no FRAME was sent: rest
SILENT_NS: Final = 100 * _MS  # no STATE came: rest
LOST_NS: Final = 500 * _MS  # no STATE came: HELLO
ZEROING_NS: Final = 1000 * _MS  # ZERO is repeated no longer
STRIKES, STRIKES_NS = 3, 10_000 * _MS
WATCHDOG_MS: Final = 48
RAMP_MS: Final = 20
REST_MS: Final = 71  # after the last FRAME

_MOST_LINE: Final = 600  # of any message from a device, and of rubbish that is kept
_NS_PER_US: Final = 1000
_ZERO_MM: Final = 1.0
_RESIDUE: Final = 0x2144DF1C  # the CRC-32 of any body with its own CRC-32 behind it
# The usual texture of the STReSS² asks for this share of the swing in a millisecond at this speed.
_USUAL_SHARE, _USUAL_MM_S = 0.567, 70.0
_STATE: Final = struct.Struct("<BHIiiiHBB4sBB")  # without the analog inputs
_OTHERS: Final = 7  # fields of a `State` that come before those that seldom change
_NUMBERED: Final = struct.Struct("<BH")

_Text = Annotated[str, msgspec.Meta(max_length=200)]
_Axes = msgspec.Meta(min_length=1, max_length=2)


class Info(msgspec.Struct, frozen=True):
    """Description of a device by itself: the keys of INFO, which the protocol's page describes."""

    name: Annotated[str, msgspec.Meta(min_length=1, max_length=200)]
    rows: int
    columns: int
    pitch_mm: tuple[float, float]
    rest: Literal["left", "right"]
    top: Annotated[int, msgspec.Meta(ge=1, le=1023)]
    fast: int
    rate: Annotated[int, msgspec.Meta(ge=50, le=1000)]
    counts_per_mm: Annotated[list[float], _Axes]
    travel_mm: Annotated[list[Annotated[float, msgspec.Meta(le=10_000)]], _Axes]
    serial: _Text = ""
    counts_per_turn: float = 0
    buttons: Annotated[int, msgspec.Meta(ge=0, le=8)] = 0
    knobs: Annotated[int, msgspec.Meta(ge=0, le=4)] = 0
    analog: Annotated[list[_Text], msgspec.Meta(max_length=8)] = []

    def __post_init__(self) -> None:
        if self.rows * self.columns > MOST_ACTUATORS:
            raise ValueError(f"`rows` · `columns` is more than {MOST_ACTUATORS}")
        if not -(-self.top // 20) <= self.fast <= self.top:
            raise ValueError("`fast` is less than a twentieth of `top`, or more than `top`")
        if 1000 % self.rate:
            raise ValueError(f"`rate` is {self.rate}, which does not divide 1000")
        if len(self.counts_per_mm) != len(self.travel_mm) or 0 in self.counts_per_mm:
            raise ValueError("`counts_per_mm` needs a number other than 0 for each of `travel_mm`")

    @property
    def display(self) -> Display:
        """The device as a display.

        Raises
        ------
        ValueError
            If no display can be so.
        """
        height_mm = self.travel_mm[1] if len(self.travel_mm) > 1 else 0.0
        return Display(
            self.name,
            self.rows,
            self.columns,
            *self.pitch_mm,
            levels=self.top + 1,
            rest_side=self.rest,
            travel_mm=self.travel_mm[0],
            counts_per_mm=abs(self.counts_per_mm[0]),
            rate_hz=float(self.rate),
            height_mm=height_mm,
            turns=self.counts_per_turn != 0,
        )

    @property
    def level_bytes(self) -> int:
        """Bytes that the levels of a FRAME take."""
        return (level_bits(self.top) * self.rows * self.columns + 7) // 8


def level_bits(top: int) -> int:
    """Bits of a level in a FRAME."""
    return 8 if top <= 255 else 10


def read_info(text: bytes) -> Info:
    """Read the JSON of an INFO.

    Raises
    ------
    ValueError
        If a key is missing or its value cannot be; the message names it.
    """
    try:
        info = msgspec.json.decode(text, type=Info)
        info.display  # noqa: B018 - it refuses what no display can be
    except ValueError as error:  # msgspec's errors are such
        raise ValueError(f"its INFO cannot be true: {error}") from None
    name, serial = printable(info.name), printable(info.serial)
    return msgspec.structs.replace(info, name=name, serial=serial)


def info_pieces(info: dict[str, object]) -> list[bytes]:
    """Bodies of the INFO messages that say this."""
    text = json.dumps(info, separators=(",", ":"), ensure_ascii=False).encode()
    pieces = [text[at : at + PIECE_BYTES] for at in range(0, len(text), PIECE_BYTES)]
    return [
        bytes((INFO, VERSION, number, len(pieces))) + piece for number, piece in enumerate(pieces)
    ]


def line_of(body: bytes) -> bytes:
    """Make the line of a message: COBS(body, CRC-32), and a zero."""
    return cobs.encode(body + zlib.crc32(body).to_bytes(4, "little")) + b"\0"


def body_of(line: bytes) -> bytes | None:
    """Body of a line without its zero; None if the line is damaged."""
    try:
        body = cobs.decode(line)
    except cobs.DecodeError:
        return None
    return body[:-4] if len(body) > 4 and zlib.crc32(body) == _RESIDUE else None


class Lines:
    """Lines put together from the bytes of a port.

    Attributes
    ----------
    damaged : int
        Number of lines that were not whole, and were dropped.
    """

    def __init__(self) -> None:
        self.damaged = 0
        self.clear()

    def bodies(self, chunk: bytes) -> list[bytes]:
        """Bodies of the messages that have come whole."""
        *lines, held = (self._held + chunk).split(b"\0")
        self._held = held[-_MOST_LINE:]
        bodies = [body_of(line) for line in lines if line]
        found = [body for body in bodies if body is not None]
        self.damaged += len(bodies) - len(found)
        return found

    def clear(self) -> None:
        """Forget a line of which a part has come."""
        self._held = b""


class State(NamedTuple):
    """Fields of a STATE; see the protocol's page."""

    number: int
    time_us: int
    x: int
    y: int
    turn: int
    taken: int
    flags: int
    buttons: int  # those that are pressed, a bit each
    knobs: bytes  # positions of four
    trips: int  # of the watchdog, modulo 256
    dropped: int  # lines, modulo 256
    analog: bytes


def read_state(body: bytes) -> State | None:
    """Read the body of a STATE; None if its length is none of a STATE's."""
    if not (29 <= len(body) <= 45 and len(body) % 2):
        return None
    _, *fields = _STATE.unpack_from(body)
    return State(*fields, body[_STATE.size :])  # pyright: ignore[reportCallIssue]


def state_body(state: State) -> bytes:
    """Body of a STATE."""
    return _STATE.pack(STATE, *state[:-1]) + state.analog


def _frame(number: int, levels: bytes = b"") -> bytes:
    """Line of a FRAME; without levels it is REST."""
    return line_of(_NUMBERED.pack(FRAME, number & 0xFFFF) + levels)


def ahead(number: int, base: int) -> int:
    """Return how far a number of 16 bits is ahead of another."""
    return (number - base) & 0xFFFF


class Stage(Enum):
    """All that a conversation can be at."""

    GREETING = "HELLO is repeated until INFO has come"
    RESTING = "REST is repeated until it was taken and the device waits no more"
    LIVE = "FRAMEs are sent and taken"


class Conversation:
    """All that is said to a device and heard from it.

    Parameters
    ----------
    now_ns
        Time at which it begins.
    number
        Number of the first REST; None for one at random.

    Attributes
    ----------
    stage : Stage
        What it is at.
    info : Info or None
        What the device has said of itself; None before.
    state : State or None
        The newest STATE of this greeting.
    events : list of Event
        What happened, until a caller takes it.
    rests : int
        How often the device was brought to rest, or went there, after the first time.
    trips, missed, dropped, old : int
        Trips of the device's watchdog; STATEs that never came; lines that the device dropped;
        STATEs that came twice or late.
    sent_ns : int or None
        When the last FRAME was sent; None since the device rests.
    tripped_ms : float or None
        How long after the last FRAME the watchdog last tripped, by the device's clock.
    acknowledged_ns : int or None
        How long after a FRAME was sent a STATE said that it was taken, of the last one of which
        that was measured; None before.
    """

    def __init__(self, now_ns: int, number: int | None = None) -> None:
        self.stage = Stage.GREETING
        self.info: Info | None = None
        self.state: State | None = None
        self.events: list[Event] = []
        self.rests = self.trips = self.missed = self.dropped = self.old = 0
        self.lines = Lines()
        self.sent_ns: int | None = None
        self.acknowledged_ns: int | None = None
        self._number = random.randrange(0x10000) if number is None else number
        self._taken = 0  # number of the last FRAME or REST that was taken
        self._probe: tuple[int, int] | None = None  # a FRAME that is not taken yet, and its time
        self._due_ns = self._heard_ns = now_ns
        self.tripped_ms: float | None = None
        self._time_us = 0  # of the newest STATE, without wraps
        self._took_us = 0  # of the STATE that first told of the last FRAME taken
        self._pieces: dict[int, bytes] = {}
        self._of_pieces = 0
        self._silent = False
        self._strikes: list[int] = []
        self._buttons: int | None = None  # None before the first STATE of all
        self._knobs: list[int] | None = None  # positions that were told of
        self._zero_ns = self._zero_due_ns = 0
        self._out = b"\0"

    @property
    def placed(self) -> bool:
        """Tell whether the device knows where its carriage is."""
        return self.state is not None and bool(self.state.flags & PLACED) and not self._zero_ns

    @property
    def live(self) -> bool:
        """Tell whether FRAMEs move the actuators."""
        return self.stage is Stage.LIVE

    def hear(self, chunk: bytes, now_ns: int) -> Pose | None:
        """Take bytes that came; give the pose of the newest STATE among them.

        Raises
        ------
        DeviceError
            If the device has a fault, is used by another program as well, or cannot be read on.
        """
        fresh = False
        for body in self.lines.bodies(chunk):
            kind = body[0]
            if kind == STATE:
                fresh |= self._hear_state(body, now_ns)
            elif kind == INFO and len(body) > 4:
                self._hear_piece(body, now_ns)
            elif kind == SAY and len(body) >= 2:
                self._hear_text(body[1], printable(body[2:].decode(errors="replace")))
        return self._pose() if fresh and self.placed else None

    def due(self, now_ns: int) -> bytes:
        """Give what is to be sent besides FRAMEs; to be called every millisecond or so."""
        silent_ns = now_ns - self._heard_ns
        stalled = silent_ns > SILENT_NS or now_ns - (self.sent_ns or now_ns) > STALL_NS
        if self.stage is Stage.LIVE and stalled:
            self.rest(now_ns)
        if self.stage is not Stage.GREETING:
            if silent_ns > SILENT_NS and not self._silent:
                self._silent = True
                self.events.append(Silent())
            if silent_ns > LOST_NS:
                self.greet(now_ns)
        if self.stage is Stage.GREETING and now_ns >= self._due_ns:
            self._due_ns = now_ns + HELLO_NS
            self._out += line_of(bytes((HELLO, VERSION)))
        if self.stage is Stage.RESTING and now_ns >= self._due_ns:
            self._due_ns = now_ns + REST_NS
            self._out += _frame(self._number)
        if self._zero_ns and now_ns >= self._zero_due_ns:
            self._zero_due_ns = now_ns + REST_NS
            self._out += line_of(bytes((ZERO,)))
            if now_ns - self._zero_ns > ZEROING_NS:
                self._zero_ns = 0
        out, self._out = self._out, b""
        return out

    def frame(self, levels: bytes, now_ns: int) -> bytes:
        """Make the line of a FRAME with packed levels; nothing if none may be sent now."""
        if self.stage is not Stage.LIVE:
            return b""
        if now_ns - (self.sent_ns or now_ns) > STALL_NS:
            self.rest(now_ns)
            return b""
        return _frame(self._number + 1, levels)

    def sent(self, now_ns: int) -> None:
        """Note that the line that `frame` made has gone out."""
        self._number = (self._number + 1) & 0xFFFF
        self.sent_ns = now_ns
        if self._probe is None:
            self._probe = self._number, now_ns

    def rest(self, now_ns: int) -> None:
        """Have the device rest, and be sent FRAMEs again once it does."""
        self._go(Stage.RESTING, now_ns)
        self._number = (self._number + 1) & 0xFFFF

    def greet(self, now_ns: int) -> None:
        """Greet the device anew: it was silent, or its port was opened again."""
        self._go(Stage.GREETING, now_ns)
        self._press(0, now_ns)  # no hand holds the buttons of a device that is not there
        self._pieces, self._of_pieces = {}, 0
        self.lines.clear()
        self._out = b"\0"

    def _go(self, stage: Stage, now_ns: int) -> None:
        """Send no FRAMEs for now."""
        self.rests += self.stage is Stage.LIVE
        self.stage, self._due_ns = stage, now_ns
        self.sent_ns = self._probe = None

    def zero(self, now_ns: int) -> None:
        """Say that the carriage is at its stop, until the device says so, too."""
        self._zero_ns = self._zero_due_ns = now_ns

    def goodbye(self) -> bytes:
        """Give what is to be sent last."""
        return b"" if self.stage is Stage.GREETING else _frame(self._number + 1)

    def _hear_piece(self, body: bytes, now_ns: int) -> None:
        _, version, number, count = body[:4]
        if version != VERSION:
            said = f"a device answers that speaks version {version} of the protocol"
            raise DeviceError(f"{said}; this vbraille speaks version {VERSION}")
        if self.stage is Stage.LIVE:  # someone else has asked
            self._meet_other(now_ns)
        if self.stage is not Stage.GREETING or number >= count or count > MOST_PIECES:
            return
        if count != self._of_pieces:
            self._pieces, self._of_pieces = {}, count
        self._pieces[number] = body[4:]
        if len(self._pieces) < count:
            return
        text = b"".join(self._pieces[number] for number in range(count))
        self._pieces = {}
        was = self.info
        try:
            info = read_info(text)
        except ValueError as error:
            raise DeviceError(str(error)) from None
        if was is not None and info != was:
            other = info.name if info.name != was.name else f"another {was.name}"
            raise DeviceError(
                f"{other} came back in the place of {was.name}; plug in the one before, and begin "
                f"again"
            )
        if was is not None:
            self.events.append(Back())
        elif info.fast / info.top < _USUAL_SHARE:
            speed_mm_s = _USUAL_MM_S * info.fast / info.top / _USUAL_SHARE
            self.events.append(SlowActuators(math.floor(speed_mm_s)))
        self.info, self.state = info, None
        self._heard_ns, self._silent = now_ns, False
        self.rest(now_ns)

    def _hear_text(self, code: int, text: str) -> None:
        if self.stage is Stage.GREETING or self.info is None:
            return
        if code == 1:
            raise DeviceError(f"{self.info.name}: {text or 'a fault'}")
        self.events.append(Notice(code, text))

    def _hear_state(self, body: bytes, now_ns: int) -> bool:
        state, last = read_state(body), self.state
        if state is None:
            self.lines.damaged += 1
            return False
        if self.stage is Stage.GREETING or self.info is None:
            return False
        if last is None:
            self._time_us = state.time_us
        else:
            step = ahead(state.number, last.number)
            if not 0 < step < 0x8000:
                self.old += 1
                return False
            self.missed += step - 1
            self._time_us += (state.time_us - last.time_us) & 0xFFFF_FFFF
        self.state, self._heard_ns = state, now_ns
        if self._silent:
            self._silent = False
            self.events.append(Back())
        if last is None or state.taken != last.taken:
            self._took_us = self._time_us
        if last is None or state[_OTHERS:] != last[_OTHERS:]:
            self._note_changes(state, last or state, now_ns)
        if state.flags & PLACED and abs(state.x / self.info.counts_per_mm[0]) < _ZERO_MM:
            self._zero_ns = 0  # ZERO was taken, and is repeated no more
        if state.flags & FAULT:
            raise DeviceError(f"{self.info.name} has a fault; switch it off and on, and try again")
        self._follow(state, now_ns)
        return True

    def _note_changes(self, state: State, before: State, now_ns: int) -> None:
        """Tell of buttons, knobs and trips that changed."""
        info = self.info
        assert info is not None
        self._press(state.buttons, now_ns)
        if self._knobs is None:
            self._knobs = list(state.knobs)
        for number in range(info.knobs):
            position = state.knobs[number]
            far = abs(position - self._knobs[number])
            if far > 1 or (far and position in (0, KNOB_TOP)):  # else it just jitters
                self._knobs[number] = position
                self.events.append(Knob(number + 1, position / KNOB_TOP))
        self.dropped += (state.dropped - before.dropped) & 0xFF
        if tripped := (state.trips - before.trips) & 0xFF:
            self.trips += tripped
            self.tripped_ms = (self._time_us - self._took_us) / 1000
            self.events.append(WatchdogTripped(self.trips))

    def _press(self, buttons: int, now_ns: int) -> None:
        """Tell of buttons that are pressed now and were not, or the other way round."""
        before = buttons if self._buttons is None else self._buttons
        self._buttons = buttons
        self.events += moved(before, buttons, self.info.buttons if self.info else 0, now_ns)

    def _follow(self, state: State, now_ns: int) -> None:
        """Go from stage to stage by what a STATE says."""
        if self.stage is Stage.RESTING:
            if state.taken == self._number and not state.flags & WAITING:
                self.stage, self._taken, self.sent_ns = Stage.LIVE, state.taken, now_ns
            return
        if ahead(state.taken, self._taken) > ahead(self._number, self._taken):
            self._meet_other(now_ns)
        elif state.flags & WAITING:
            self.rest(now_ns)
        else:
            self._taken = state.taken
            if self._probe is not None and ahead(state.taken, self._probe[0]) < 0x8000:
                self.acknowledged_ns, self._probe = now_ns - self._probe[1], None

    def _meet_other(self, now_ns: int) -> None:
        """Rest, since the device answers what this host did not say; or leave it to the other."""
        self._strikes = [at for at in self._strikes if now_ns - at < STRIKES_NS] + [now_ns]
        if len(self._strikes) >= STRIKES:
            self.stage = Stage.GREETING  # so that it is told nothing more
            raise DeviceError(
                f"another program uses {self.info.name if self.info else 'the device'}, too; "
                f"end it, and begin again"
            )
        self.rest(now_ns)

    def _pose(self) -> Pose:
        info, state = self.info, self.state
        assert info is not None
        assert state is not None
        x_mm = state.x / info.counts_per_mm[0] - (info.columns - 1) * info.pitch_mm[0] / 2
        y_mm = state.y / info.counts_per_mm[1] if len(info.counts_per_mm) > 1 else 0.0
        theta_rad = 0.0
        if info.counts_per_turn:
            turns = state.turn / info.counts_per_turn
            theta_rad = math.tau * (turns - round(turns))
        return Pose(self._time_us * _NS_PER_US, x_mm, y_mm, theta_rad)
