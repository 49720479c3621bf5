"""A controller written from docs/wire-protocol.md alone, as its builder would.

It shares nothing with vbraille, and so tells whether the page is complete: nothing but Python's
own library is imported. It has two axes, an angle, buttons and knobs; it keeps what it took, each
FRAME beside the pose that it had told last, so that a test can say what lay under the finger.
"""

from __future__ import annotations

import os
import select
import struct
import threading
import time
import tty
import zlib
from contextlib import suppress
from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING, NamedTuple, Self

if TYPE_CHECKING:
    from collections.abc import Callable

CRC_OF_ALL = 0x2144DF1C  # what CRC-32 gives over a body and its own CRC
WATCHDOG_US = 50_000
RAMP_US = 20_000

HELLO, FRAME, REST = 0x01, 0x02, 0x03
INFO, WATCHDOG, STATE = 0x81, 0x83, 0x85
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


class Pose(NamedTuple):
    """Where the array's centre is, in mm, how far it is turned against the clock, in radians."""

    x_mm: float
    y_mm: float
    theta: float = 0.0


@dataclass(frozen=True, slots=True)
class Make:
    """Describe a device of two axes with absolute encoders, as INFO does."""

    rows: int = 6
    columns: int = 10
    column_pitch_nm: int = 1_200_000
    row_pitch_nm: int = 1_800_000
    rest_side: int = 1
    top_level: int = 1023
    rate_hz: int = 1000
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
    def room(self) -> int:
        """The most bytes of a FRAME or a HELLO on the line, without the zero."""
        whole = 3 + self.packed_bytes + 4
        return max(whole + whole // 254 + 1, 7)

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
        """Return the body of INFO."""
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


class Taken(NamedTuple):
    """A FRAME that was taken, and the pose that the STATE before it told."""

    time_us: int
    pose: Pose
    levels: tuple[int, ...]


class PageController:
    """The page's minimal firmware: bytes and times go in, and bytes come out.

    Parameters
    ----------
    _info
        What another bench's controller is made of; this one is made as it is.
    make
        What the device is.
    """

    def __init__(self, _info: object = None, make: Make | None = None) -> None:
        self.make = make or Make()
        self.buttons, self.knobs = 0, bytes(4)
        self.trips = self.dropped = self.cut = 0
        self.taken: list[Taken] = []
        self.levels = self._from = self.make.rest
        self._greeted = self._armed = self._tripped = False
        self._resting, self._ramp_us = True, None
        self._goal, self._behind, self._waiting = self.make.rest, 0, b""
        self._held = b""
        self._sequence = self._frame = self._last_us = 0
        self._told = Pose(0.0, 0.0)

    def receive(self, chunk: bytes, now_us: int) -> bytes:
        """Take bytes as they come, and answer what whole frames of them say."""
        *lines, self._held = (self._held + chunk).split(b"\0")
        self._held = self._held[: self.make.room + 1]
        return b"".join(self._obey(line, now_us) for line in lines if line)

    def tick(self, now_us: int, way_mm: float, y_mm: float = 0.0, theta: float = 0.0) -> bytes:
        """Guard, ramp and tell, once in a period; the way is from the left stop."""
        said = b""
        if self._armed and now_us - self._last_us >= WATCHDOG_US:
            self.trips += 1
            self._rest(now_us)
            self._tripped = True
            said = self._watchdog()
        if self._ramp_us is not None:
            gone = min((now_us - self._ramp_us) / RAMP_US, 1)
            ends = zip(self._from, self.make.rest, strict=True)
            self.levels = tuple(round(start + (rest - start) * gone) for start, rest in ends)
            if gone == 1:
                self._ramp_us = None
        if self._waiting:
            said += self._leave_rest(self._waiting, now_us)
            self._waiting = b""
        self._follow()
        self._sequence = (self._sequence + 1) % 2**16
        counts = self.make.counts(Pose(way_mm - self.make.before_mm, y_mm, theta))
        self._told = self.make.pose(*counts)
        flags = PLACED | RESTING * self._resting | TRIPPED * self._tripped
        head = self._sequence, now_us % 2**32, counts[0], self._frame, flags, self.buttons
        state = struct.pack("<BHIIHBBh2I4s", STATE, *head, NO_FORCE, *counts[1:], self.knobs)
        return said + line_of(state) if self._greeted else b""

    def _obey(self, line: bytes, now_us: int) -> bytes:
        body = body_of(line) if len(line) <= self.make.room else None
        if body is None:
            self.dropped += 1
            self.cut += 1
        elif body[0] == HELLO and body[1:2] > b"\0":
            self._rest(now_us)
            self._greeted = body[1] == 2
            return line_of(self.make.info()) + self._watchdog()
        elif body[0] == REST:
            self._rest(now_us)
        elif body[0] != FRAME:
            self.dropped += 1
        elif self._greeted:
            return self._show(body, now_us)
        return b""

    def _show(self, body: bytes, now_us: int) -> bytes:
        fits = len(body) == 3 + self.make.packed_bytes
        wanted = self.make.levels(body[3:]) if fits else ()
        if not wanted or max(wanted) > self.make.top_level:
            self.dropped += 1
            return b""
        if self._ramp_us is not None:
            return b""
        if self._resting:
            self._waiting = body
            return b""
        steps = (int.from_bytes(body[1:3], "little") - self._frame) % 2**16
        if not 1 <= steps <= 32767:
            self.dropped += 1
            return b""
        self._behind += steps
        return self._take(body, now_us)

    def _leave_rest(self, body: bytes, now_us: int) -> bytes:
        pairs = zip(self.make.levels(body[3:]), self.make.rest, strict=True)
        if 20 * max(abs(level - rest) for level, rest in pairs) > self.make.top_level:
            return b""
        self._behind = 5
        return self._take(body, now_us)

    def _take(self, body: bytes, now_us: int) -> bytes:
        told, self._tripped = self._tripped, False
        self._frame, self._last_us = int.from_bytes(body[1:3], "little"), now_us
        self._goal = self.make.levels(body[3:])
        self._resting, self._armed = False, True
        self.taken.append(Taken(now_us, self._told, self._goal))
        return self._watchdog() if told else b""

    def _follow(self) -> None:
        if self._behind > 2:
            ends = zip(self.levels, self._goal, strict=True)
            way = 2 / self._behind
            self.levels = tuple(start + round((goal - start) * way) for start, goal in ends)
            self._behind -= 2
        elif self._behind:
            self.levels, self._behind = self._goal, 0

    def _rest(self, now_us: int) -> None:
        self._armed = self._tripped = False
        self._resting, self._waiting, self._behind = True, b"", 0
        if self._ramp_us is None and self.levels != self.make.rest:
            self._ramp_us, self._from = now_us, self.levels

    def _watchdog(self) -> bytes:
        return line_of(struct.pack("<B2I", WATCHDOG, self.trips, self.dropped))


class Cable:
    """A pseudo-terminal with a device at its end, which lives in a thread of its own.

    Parameters
    ----------
    device
        What is at its end.
    hand
        Where the array is at a time in s since the cable was plugged in: the way from the left
        stop and y, in mm, and the angle in radians.
    """

    def __init__(
        self, device: PageController, hand: Callable[[float], tuple[float, float, float]]
    ) -> None:
        self.device, self.hand = device, hand
        self._master, self._slave = os.openpty()
        tty.setraw(self._slave)
        os.set_blocking(self._master, False)
        self.path = os.ttyname(self._slave)
        self._waiting = b""
        self._pulled = threading.Event()
        self._thread = threading.Thread(target=self._serve, daemon=True)

    def _serve(self) -> None:
        begun_s = due_s = time.monotonic()
        while not self._pulled.is_set():
            writable = [self._master] if self._waiting else []
            wait_s = max(due_s - time.monotonic(), 0.0)
            heard = select.select([self._master], writable, [], wait_s)[0]
            now_s = time.monotonic()
            said = b""
            if now_s >= due_s:  # before what came is read, as an interrupt would
                due_s = max(due_s + 1 / self.device.make.rate_hz, now_s)
                said = self.device.tick(int(now_s * 1e6), *self.hand(now_s - begun_s))
            if heard:
                said += self.device.receive(os.read(self._master, 4096), int(now_s * 1e6))
            if len(self._waiting) < 500:  # what there is no room for is dropped whole
                self._waiting += said
            if self._waiting:
                with suppress(BlockingIOError):
                    self._waiting = self._waiting[os.write(self._master, self._waiting) :]

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._pulled.set()
        self._thread.join()
        os.close(self._slave)
        os.close(self._master)
