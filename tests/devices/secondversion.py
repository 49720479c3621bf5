"""A controller of version 2, written from docs/wire-protocol.md alone, as its builder would.

It shares nothing with vbraille, and so tells whether the page is complete: nothing but Python's
own library is imported. It has two axes, an angle, buttons and knobs; it keeps what it took, each
FRAME beside the STATE that it had sent last, so that a test can say what lay under the finger.
"""

from __future__ import annotations

import os
import select
import struct
import threading
import time
import tty
import zlib
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass, field
from math import pi

CRC_OF_ALL = 0x2144DF1C  # what CRC-32 gives over a body and its own CRC
WATCHDOG_US = 50_000
RAMP_US = 20_000
U16, U32 = 0xFFFF, 0xFFFFFFFF

HELLO, FRAME, REST = 0x01, 0x02, 0x03
INFO, WATCHDOG, STATE2 = 0x81, 0x83, 0x85
PLACED, RESTING, TRIPPED = 1, 2, 8
NO_FORCE = -32768


def stuffed(body: bytes) -> bytes:
    """Return COBS of a body: every run without a zero behind its length plus one."""
    line = bytearray()
    runs = body.split(b"\0")
    for run in runs[:-1]:
        while len(run) >= 254:
            line += b"\xff" + run[:254]
            run = run[254:]
        line += bytes([len(run) + 1]) + run
    run = runs[-1]
    while len(run) >= 254:
        line += b"\xff" + run[:254]
        run = run[254:]
        if not run:  # the frame ends with a whole run, and no length follows
            return bytes(line)
    return bytes(line + bytes([len(run) + 1]) + run)


def unstuffed(line: bytes) -> bytes | None:
    """Return what COBS was made of, or None of what is no COBS."""
    body = bytearray()
    at = 0
    while at < len(line):
        run = line[at + 1 : at + line[at]]
        if len(run) != line[at] - 1 or 0 in run:
            return None
        body += run
        at += line[at]
        if line[at - len(run) - 1] != 0xFF and at < len(line):
            body.append(0)
    return bytes(body)


def line_of(body: bytes) -> bytes:
    """Return the bytes on the line for a body, with the zero at the end."""
    return stuffed(body + struct.pack("<I", zlib.crc32(body))) + b"\0"


def body_of(line: bytes) -> bytes | None:
    """Return the body of a frame on the line, without its zero; None of a broken one."""
    whole = unstuffed(line)
    if whole is None or len(whole) < 5 or zlib.crc32(whole) != CRC_OF_ALL:
        return None
    return whole[:-4]


def text(words: str) -> bytes:
    """Return words as the page's `text`."""
    spelt = words.encode()
    return bytes([len(spelt)]) + spelt


@dataclass(frozen=True, slots=True)
class Pose:
    """Where the array's centre is, in mm, how far it is turned against the clock, in radians."""

    x_mm: float
    y_mm: float
    theta: float = 0.0


@dataclass(frozen=True, slots=True)
class Controls:
    """Which buttons are pressed (bit 0 the first), and where each knob stands (0 to 255)."""

    buttons: int = 0
    knobs: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class Make:
    """What a device of two axes with absolute encoders is, as INFO2 tells it."""

    rows: int
    columns: int
    column_pitch_nm: int
    row_pitch_nm: int
    rest_side: int = 1
    top_level: int = 1023
    rate_hz: int = 500
    slew_per_s: int = 0
    travel_um: int = 300_000
    counts_per_m: int = 200_000
    count_sign: int = -1
    count_bits: int = 24
    left_stop_count: int = 70_000
    name: str = "Alone"
    firmware: str = "2"
    inverted: bytes = b""
    gain: bytes = b""
    enabled: bytes = b""
    buttons: int = 2
    knobs: int = 1
    contactor_nm: tuple[int, int] = (0, 0)
    height_um: int = 200_000
    y_counts_per_m: int = 100_000
    y_count_sign: int = 1
    far_stop_count: int = 1_000
    counts_per_turn: int = 4_096
    turn_sign: int = 1
    straight_count: int = 96

    @property
    def actuators(self) -> int:
        """How many actuators there are."""
        return self.rows * self.columns

    @property
    def level_bits(self) -> int:
        """How many bits a level takes."""
        return self.top_level.bit_length()

    @property
    def packed_bytes(self) -> int:
        """How many bytes the levels of a FRAME take."""
        return (self.actuators * self.level_bits + 7) // 8

    @property
    def rest(self) -> tuple[int, ...]:
        """The level of each actuator at rest."""
        sides = self.inverted or bytes(self.actuators)
        return tuple(self.top_level if side else 0 for side in sides)

    @property
    def before_mm(self) -> float:
        """How far before the line the array's centre is at the left stop, in mm."""
        return (self.columns - 1) * self.column_pitch_nm / 2e6

    def info(self) -> bytes:
        """Return the body of INFO2."""
        return b"".join(
            (
                struct.pack("<4B2IB", INFO, 2, self.rows, self.columns,
                            self.column_pitch_nm, self.row_pitch_nm, self.rest_side),
                struct.pack("<3HIB", self.top_level, self.rate_hz, self.slew_per_s,
                            self.travel_um, 0),
                struct.pack("<IbBI", self.counts_per_m, self.count_sign, self.count_bits,
                            self.left_stop_count),
                text(self.name),
                text(self.firmware),
                self.inverted or bytes(self.actuators),
                self.gain or b"\xff" * self.actuators,
                self.enabled or b"\x01" * self.actuators,
                struct.pack("<2B3I", self.buttons, self.knobs, *self.contactor_nm, self.height_um),
                struct.pack("<IbI", self.y_counts_per_m, self.y_count_sign, self.far_stop_count),
                struct.pack("<IbI", self.counts_per_turn, self.turn_sign, self.straight_count),
            )
        )  # fmt: skip

    def counts(self, pose: Pose) -> tuple[int, int, int]:
        """Return `count`, `y_count` and `theta_count` at a pose: Place's equations backwards."""
        along = round((pose.x_mm + self.before_mm) * self.counts_per_m / 1000)
        across = round(pose.y_mm * self.y_counts_per_m / 1000)
        turned = round(pose.theta * self.counts_per_turn / (2 * pi))
        return (
            (self.left_stop_count + self.count_sign * along) % 2**self.count_bits,
            (self.far_stop_count + self.y_count_sign * across) % 2**self.count_bits,
            (self.straight_count + self.turn_sign * turned) % self.counts_per_turn,
        )

    def pose(self, count: int, y_count: int, theta_count: int) -> Pose:
        """Return the pose that the host makes of counts: Place's equations, of absolute ones."""
        middle = 2 ** (self.count_bits - 1)
        along = (count - self.left_stop_count + middle) % (2 * middle) - middle
        across = (y_count - self.far_stop_count + middle) % (2 * middle) - middle
        half = self.counts_per_turn // 2
        turned = (theta_count - self.straight_count + half) % self.counts_per_turn - half
        return Pose(
            -self.before_mm + self.count_sign * along * 1000 / self.counts_per_m,
            self.y_count_sign * across * 1000 / self.y_counts_per_m,
            self.turn_sign * turned * 2 * pi / self.counts_per_turn,
        )

    def levels(self, packed: bytes) -> tuple[int, ...]:
        """Return the levels of a FRAME."""
        spare = 8 * len(packed) - self.actuators * self.level_bits
        stream = int.from_bytes(packed, "big") >> spare
        mask = 2**self.level_bits - 1
        shifts = range((self.actuators - 1) * self.level_bits, -1, -self.level_bits)
        return tuple(stream >> shift & mask for shift in shifts)


@dataclass(frozen=True, slots=True)
class Taken:
    """A FRAME that was taken, and the pose that the STATE sent last had told by then."""

    time_us: int
    sequence: int
    pose: Pose | None
    levels: tuple[int, ...]


@dataclass(slots=True)
class Controller:
    """The page's minimal firmware: bytes and times go in, and bytes come out."""

    make: Make
    hand: Callable[[int], tuple[Pose, Controls]]
    send: Callable[[bytes], bool]
    buffer: bytearray = field(default_factory=bytearray)
    levels: tuple[int, ...] = ()
    ramp_from: tuple[int, ...] = ()
    ramp_began: int = 0
    ramping: bool = False
    resting: bool = True
    greeted: bool = False
    armed: bool = False
    tripped: bool = False
    report: bool = False
    trips: int = 0
    dropped: int = 0
    state_sequence: int = 0
    frame_sequence: int = 0
    last_frame: int = 0
    next_state: int = 0
    told: Pose | None = None
    taken: list[Taken] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.levels = self.ramp_from = self.make.rest

    @property
    def period_us(self) -> int:
        """How long it is from a STATE to the next, in µs."""
        return 1_000_000 // self.make.rate_hz

    @property
    def room(self) -> int:
        """How many bytes of a FRAME or HELLO come before the zero, at most."""
        whole = 3 + self.make.packed_bytes + 4
        return max(whole + whole // 254 + 1, 7)

    def timer(self, now: int) -> None:
        """Guard, ramp and tell: what the timer's interrupt does at a time in µs."""
        if self.armed and now - self.last_frame & U32 >= WATCHDOG_US:
            self.tripped = self.report = True
            self.trips += 1
            self.go_to_rest(now)
        if self.ramping:
            gone = now - self.ramp_began & U32
            self.ramping = gone < RAMP_US
            self.levels = tuple(
                round(start + (rest - start) * min(gone, RAMP_US) / RAMP_US)
                for start, rest in zip(self.ramp_from, self.make.rest, strict=True)
            )
        if self.report:
            self.report = False
            if self.greeted:
                self.tell_watchdog()
        late = now - self.next_state & U32
        if late < U32 // 2:
            periods = 1 + late // self.period_us
            self.next_state = self.next_state + periods * self.period_us & U32
            self.state_sequence = self.state_sequence + periods & U16
            if self.greeted:
                self.tell_state(now)

    def tell_state(self, now: int) -> None:
        """Send STATE2 of this moment."""
        pose, controls = self.hand(now)
        counts = self.make.counts(pose)
        flags = PLACED | RESTING * self.resting | TRIPPED * self.tripped
        body = struct.pack(
            "<BHIIHBBhII4s", STATE2, self.state_sequence, now & U32, counts[0],
            self.frame_sequence, flags, controls.buttons, NO_FORCE, *counts[1:],
            bytes(controls.knobs).ljust(4, b"\0"),
        )  # fmt: skip
        if self.send(line_of(body)):
            self.told = self.make.pose(*counts)

    def tell_watchdog(self) -> None:
        """Send WATCHDOG."""
        self.send(line_of(struct.pack("<BII", WATCHDOG, self.trips & U32, self.dropped & U32)))

    def go_to_rest(self, now: int) -> None:
        """Begin the ramp, unless it has begun or all is at rest."""
        self.armed = False
        self.resting = True
        if not self.ramping and self.levels != self.make.rest:
            self.ramping = True
            self.ramp_began = now
            self.ramp_from = self.levels

    def receive(self, line: Iterable[int], now: int) -> None:
        """Take bytes as they come, and do what whole frames of them say."""
        for byte in line:
            if byte:
                if len(self.buffer) <= self.room:
                    self.buffer.append(byte)
                continue
            if self.buffer:
                body = body_of(bytes(self.buffer)) if len(self.buffer) <= self.room else None
                if body is None or not self.obey(body, now):
                    self.dropped += 1
            self.buffer.clear()

    def obey(self, body: bytes, now: int) -> bool:
        """Do what a message says; False if it is to be counted as dropped."""
        if body[0] == HELLO and len(body) >= 2 and body[1] >= 1:
            self.tripped = False
            self.go_to_rest(now)
            self.greeted = body[1] == 2
            self.send(line_of(self.make.info()))
            self.tell_watchdog()
            return True
        if body[0] == REST:
            self.tripped = False
            self.go_to_rest(now)
            return True
        return body[0] == FRAME and (not self.greeted or self.take(body, now))

    def take(self, body: bytes, now: int) -> bool:
        """Show a FRAME if it may be shown; False if it is to be counted as dropped."""
        if len(body) != 3 + self.make.packed_bytes:
            return False
        wanted = self.make.levels(body[3:])
        if max(wanted) > self.make.top_level:
            return False
        sequence = body[1] | body[2] << 8
        if self.ramping:
            return True
        if self.resting:
            away = max(abs(a - b) for a, b in zip(wanted, self.make.rest, strict=True))
            if 20 * away > self.make.top_level:
                return True
        elif not 1 <= (sequence - self.frame_sequence & U16) <= 32767:
            return False
        told = self.tripped
        self.levels = wanted
        self.frame_sequence = sequence
        self.last_frame = now
        self.armed = True
        self.resting = self.tripped = False
        self.taken.append(Taken(now, sequence, self.told, wanted))
        if told:
            self.tell_watchdog()
        return True


def microseconds() -> int:
    """Return the device's clock."""
    return time.monotonic_ns() // 1000 & U32


class Cable:
    """A pseudo-terminal with the device at its end, which serves it in a thread of its own."""

    def __init__(self, make: Make, hand: Callable[[int], tuple[Pose, Controls]]) -> None:
        self.master, self.slave = os.openpty()
        tty.setraw(self.slave)
        os.set_blocking(self.master, False)
        self.path = os.ttyname(self.slave)
        self.waiting = bytearray()
        self.controller = Controller(make, hand, self.send)
        self.unplugged = threading.Event()
        self.thread = threading.Thread(target=self.serve, daemon=True)

    def send(self, line: bytes) -> bool:
        """Queue a frame if there is room for all of it; one alone always has room."""
        if len(self.waiting) > 256:
            return False
        self.waiting += line
        return True

    def serve(self) -> None:
        """Read, guard and write until the cable is pulled."""
        controller = self.controller
        controller.next_state = microseconds()
        while not self.unplugged.is_set():
            due = controller.next_state - microseconds() & U32
            wait_s = due / 1e6 if due < controller.period_us else 0.0
            select.select([self.master], [self.master] if self.waiting else [], [], wait_s)
            controller.timer(microseconds())
            with suppress(BlockingIOError):
                controller.receive(os.read(self.master, 4096), microseconds())
            with suppress(BlockingIOError):
                if self.waiting:
                    del self.waiting[: os.write(self.master, self.waiting)]

    def __enter__(self) -> Cable:
        self.thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.unplugged.set()
        self.thread.join()
        os.close(self.slave)
        os.close(self.master)
