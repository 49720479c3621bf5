"""A host's loop and a controller on a line in memory, with all that can go wrong there.

No test waits: the clock goes on when the host sleeps, and when it is stopped. What the actuators do
is held against the law that nothing jumps, whatever was lost, late, doubled or stopped:

- In any millisecond an actuator moves by no more than three times what is asked for in one: the
  speed of the hand times the steepest slope of the picture, and what a fade goes. Three times,
  because what was missed must be caught up with.
- The ramp to rest adds a twentieth of the swing to that.
- What is felt after the host was stopped is of a place that the carriage was at from then on.

A hasty controller shows each FRAME at once, so that it jumps where the line loses FRAMEs or
holds them up. The same is asked of what it is told: from one FRAME to the next, however late they
are, and after a rest by nothing.

Everything is rounded to levels, which is one level more, or two where both ends are rounded.
"""

from __future__ import annotations

import heapq
import math
import random
from collections import deque
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tests.controllers import HastyController
from tests.troubles import Troubles, troubles_of_host, troubles_of_line
from vbraille.braille.geometry import Geometry
from vbraille.devices.serial.conversation import Conversation
from vbraille.devices.serial.device import SerialDevice, greet
from vbraille.devices.serial.port import Address
from vbraille.devices.serial.wire import (
    RAMP_MS,
    WATCHDOG_MS,
    Decoder,
    Encoder,
    Frame,
)
from vbraille.display import Display
from vbraille.engine.loop import Loop
from vbraille.engine.record import Ring, X
from vbraille.render import BrailleStyle, Mapping, Profile, Tuning
from vbraille.simulation.firmware import Controller, describe
from vbraille.simulation.simulator import split

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

TOP = 1000
FADE_S = 0.1
PERIOD_US = 1000
COUNT_MM = 0.005
# How much quicker than is asked for what was missed may be caught up with.
CATCH_UP = 3
# What a line gives at a read, and what it holds of what is not read.
READ_BYTES, HELD_BYTES = 4096, 60_000
INFO = Display(
    name="wired", rows=1, columns=3, column_pitch_mm=1.2, row_pitch_mm=1.8, levels=TOP + 1,
    rest_side="right", travel_mm=10_000.0, counts_per_mm=200.0, rate_hz=1000.0,
)  # fmt: skip


# Dots that fill the line, each half a wave long.
DOT_MM = 20.0
CELLS = 30


def waves(swing: float) -> BrailleStyle:
    """How a line is shown that is at full deflection where it is at rest otherwise.

    A dot swings the actuators down by ``swing`` and up again; 0 is the same everywhere.
    """
    return BrailleStyle(
        Profile.HALF_SINE,
        Mapping("waves", (0,), (0,), (True,)),
        Geometry(DOT_MM, DOT_MM, DOT_MM, row_spacing_mm=20.0, line_pitch_mm=60.0),
        Tuning(texture=0.0, contrast=swing),
    )


class Records(Ring):
    """A ring that knows which record was begun last."""

    slot = 0
    begun: Callable[[], None]

    def begin(self) -> int:
        """Begin a record: the host is awake, and has read where the carriage is."""
        self.begun()
        self.slot = super().begin()
        return self.slot


class Wired:
    """A host, a line and a controller.

    Parameters
    ----------
    chance
        What decides.
    troubles
        What goes wrong.
    controller
        Makes the controller of its INFO.
    conversation
        What the host has for it.
    slew_per_s
        Largest, as the device says; 0 is no limit.
    swing
        Of the picture: 0 is the same everywhere, so that only fades move actuators.
    speed_mm_s
        Speed of the hand to the right, in mm/s.
    """

    def __init__(
        self,
        chance: random.Random,
        troubles: Troubles,
        controller: Callable[..., Controller] = Controller,
        conversation: type[Conversation] = Conversation,
        *,
        slew_per_s: int = 0,
        swing: float = 0.0,
        speed_mm_s: float = 60.0,
    ) -> None:
        self.now_us = 0
        self.breaches: list[str] = []
        self.rests = self.shown = 0  # how often the device went to rest, and FRAMEs shown
        self.controller = controller(
            replace(
                describe(INFO, Encoder.ABSOLUTE),
                inverted=bytes((0, 1, 0)),
                largest_slew_per_s=slew_per_s,
            )
        )
        self._chance, self._troubles = chance, troubles
        self._speed_mm_s, self._slew_per_s = speed_mm_s, slew_per_s
        self._stalls: list[tuple[int, int]] = []
        self._awake_us = 0
        self._begun_us: int | None = None
        self._down: list[tuple[int, int, bytes]] = []
        self._up: list[tuple[int, int, bytes]] = []
        self._down_last = self._up_last = 0
        self._count = 0
        self._device_us = 0
        self._made: dict[int, tuple[float, int]] = {}  # by sequence: place, since when awake
        self._sent = Decoder()
        self._shown: int | None = None  # sequence of the FRAME that is shown; None at rest
        self._levels = np.asarray(self.controller.levels, float)
        self._rest = self._levels
        self._at = 0, self.controller.levels
        # Levels in the last millisecond, each with the time since when and whether by the ramp.
        self._past = deque([(0, self._levels, False)])
        # The steepest slope of sin(πu/W).
        slope_per_mm = swing * math.pi / DOT_MM
        asked = slope_per_mm * speed_mm_s * PERIOD_US / 1e6 + PERIOD_US / 1e6 / FADE_S
        self.allowed = CATCH_UP * asked * TOP + 2  # in a millisecond, in levels
        self._at_once = isinstance(self.controller, HastyController)
        self.picture = waves(swing).render(np.full(CELLS, 0b001001, np.uint8), INFO)
        self.port = _Port(self)
        begun = conversation(self.now_ns())
        greet(self.port, begun, self.now_ns, self.pause)
        self.device = SerialDevice(self.port, begun, self.now_ns, self.pause)
        self._records = Records.alone(INFO.shape, 2)
        self._records.begun = self._note_awake
        self._made_awake_us = 0
        self.loop = Loop(self.device, self, fade_s=FADE_S, ring=self._records)

    # The clock of the loop.

    def now_ns(self) -> int:
        """The host's clock; asking for it is where the host may be stopped."""
        self.maybe_stall()
        return self.now_us * 1000

    busy_ns = now_ns

    def sleep_until_ns(self, deadline_ns: int) -> None:
        self._go_on(max(self.now_us, -(-deadline_ns // 1000)))

    def pause(self, seconds: float) -> None:
        self._go_on(self.now_us + round(seconds * 1e6))

    def maybe_stall(self) -> None:
        if self._stalls and self.now_us >= self._stalls[0][0]:
            _, stall_us = self._stalls.pop(0)
            self._go_on(self.now_us + stall_us)
            if stall_us >= WATCHDOG_MS * 1000:
                self._awake_us = self.now_us

    def _note_awake(self) -> None:
        """A frame is made now, of what is known since the host was awake again."""
        self._made_awake_us = self._awake_us

    # The line.

    def send_down(self, message: bytes) -> None:
        """What the host writes."""
        for event in self._sent.feed(message):
            if isinstance(event, Frame):
                x_mm = float(self._records.columns[1][self._records.slot, X])
                self._made[event.sequence] = x_mm, self._made_awake_us
        trouble, chance = self._troubles, self._chance
        if self._begun_us is None:  # the handshake is not on trial
            trouble = Troubles()
        dead, held = self._in(trouble.down_dead), self._in(trouble.down_held)
        if dead or chance.random() < trouble.lost_down:
            return
        due_us = self.now_us + 200 + chance.randint(0, trouble.jitter_us[0])
        if held:
            due_us = max(due_us, held)
        due_us = self._down_last = max(due_us, self._down_last)
        pieces = [message]
        if chance.random() < trouble.split:
            cut = chance.randrange(len(message))
            pieces = [message[:cut], message[cut:]]
        for piece in pieces * (2 if chance.random() < trouble.doubled else 1):
            self._push(self._down, due_us, piece)
        if chance.random() < trouble.replayed:
            self._push(self._down, due_us + chance.randint(1000, 100_000), b"\0" + message)

    def drop_unsent(self) -> None:
        """What has not left the host, for the line holds it, never will."""
        if self._in(self._troubles.down_held):
            self._down = [entry for entry in self._down if entry[0] <= self.now_us + 1000]
            heapq.heapify(self._down)

    def read(self) -> bytes:
        chunk = b""
        while self._up and self._up[0][0] <= self.now_us and len(chunk) < READ_BYTES:
            chunk += heapq.heappop(self._up)[2]
        return chunk

    def _send_up(self, message: bytes) -> None:
        trouble, chance = self._troubles, self._chance
        if self._begun_us is None:
            trouble = Troubles()
        if self._in(trouble.up_dead) or chance.random() < trouble.lost_up:
            return
        if sum(len(entry[2]) for entry in self._up[-8:]) * len(self._up) > 8 * HELD_BYTES:
            return
        if chance.random() < trouble.garbled_up:
            at = chance.randrange(len(message) - 1)
            message = message[:at] + bytes((message[at] ^ 0x10,)) + message[at + 1 :]
        due_us = self.now_us + 200 + chance.randint(0, trouble.jitter_us[1])
        due_us = self._up_last = max(due_us, self._up_last)
        self._push(self._up, due_us, message)
        if chance.random() < trouble.doubled_up:
            self._push(self._up, due_us + chance.randint(0, 30_000), b"\0" + message)

    def _push(self, queue: list[tuple[int, int, bytes]], due_us: int, piece: bytes) -> None:
        self._count += 1
        heapq.heappush(queue, (due_us, self._count, piece))

    def _in(self, spells: tuple[tuple[int, int], ...]) -> int:
        """When the spell that it is in ends; 0 in none."""
        if self._begun_us is None:
            return 0
        since_us = self.now_us - self._begun_us
        ends = (at + length for at, length in spells if at <= since_us < at + length)
        return max(ends, default=-self._begun_us) + self._begun_us

    # The device.

    def way_mm(self, at_us: int) -> float:
        return at_us / 1e6 * self._speed_mm_s

    def _go_on(self, to_us: int) -> None:
        while True:
            tick_us = self._device_us + PERIOD_US
            due_us = self._down[0][0] if self._down else tick_us
            if min(due_us, tick_us) > to_us:
                break
            if due_us < tick_us:
                self.now_us = max(self.now_us, due_us)
                for message in split(heapq.heappop(self._down)[2]):
                    answers = self.controller.receive(message, self.now_us)
                    self._look()
                    for answer in split(answers)[:-1]:
                        self._send_up(answer)
            else:
                self.now_us = self._device_us = tick_us
                answers = self.controller.tick(tick_us, self.way_mm(tick_us))
                self._look()
                for answer in split(answers)[:-1]:
                    self._send_up(answer)
        self.now_us = max(self.now_us, to_us)

    # The law.

    def _look(self) -> None:
        controller = self.controller
        at = controller.frames, controller.levels
        if at[0] == self._at[0] and at[1] is self._at[1]:
            return  # neither a FRAME nor time has moved anything
        self._at = at
        levels = np.asarray(controller.levels, float)
        framed = not controller.resting
        self.shown += framed
        sequence = controller._frame_sequence
        if framed:
            if self._at_once:
                self._mind_frames(sequence, levels)
            self._shown = sequence
            if not np.array_equal(levels, self._levels):
                self._mind_age(sequence, levels)
        elif self._shown is not None:
            self.rests += 1
            self._shown = None
        self._mind_millisecond(levels, ramp=not framed)
        self._levels = levels

    def _mind_millisecond(self, levels: NDArray[np.float64], *, ramp: bool) -> None:
        """Hold what has moved in the last millisecond against the law."""
        past = self._past
        past.append((self.now_us, levels, ramp))
        while len(past) > 1 and past[1][0] <= self.now_us - PERIOD_US:
            past.popleft()
        step = max(float(np.abs(levels - before).max()) for _, before, _ in past)
        allowed = self.allowed
        if any(by_ramp for _, _, by_ramp in list(past)[1:]):
            allowed += TOP / RAMP_MS + 1
        if step > allowed and (ramp or not self._at_once):
            self._breach("within a millisecond", step, allowed)

    def _mind_frames(self, sequence: int, levels: NDArray[np.float64]) -> None:
        """Hold what a FRAME moves against the law, where it is shown at once."""
        step = float(np.abs(levels - self._levels).max())
        if self._shown is None:
            ramps = not np.array_equal(self._levels, self._rest)
            allowed, kind = TOP / RAMP_MS + 1 if ramps else 0.0, "frame out of rest"
        else:
            frames = min((sequence - self._shown) % 2**16, (self._shown - sequence) % 2**16)
            allowed, kind = self.allowed * frames + 2, "frame"
        if step > allowed:
            self._breach(kind, step, allowed)

    def _breach(self, kind: str, step: float, allowed: float) -> None:
        self.breaches.append(
            f"{self.now_us / 1000:.1f} ms, {kind}: {step / TOP:.3f} of a swing, "
            f"where {allowed / TOP:.3f} are allowed"
        )

    def _mind_age(self, sequence: int, levels: NDArray[np.float64]) -> None:
        """What is felt after the host was stopped is of a place after that."""
        x_mm, awake_us = self._made[sequence]
        way_mm = x_mm + 2 * INFO.column_pitch_mm
        if not np.array_equal(levels, self._rest) and way_mm < self.way_mm(awake_us) - COUNT_MM:
            self.breaches.append(f"{self.now_us / 1000:.1f} ms: a place from before the host woke")

    def run(self, seconds: float) -> None:
        """Read for so long, with all the troubles; then leave."""
        self._begun_us = self.now_us
        self._stalls = [(self.now_us + at_us, long_us) for at_us, long_us in self._troubles.stalls]
        self.loop.show(self.picture)
        self.loop.restart_clock()
        end_us = self.now_us + round(seconds * 1e6)
        while self.now_us < end_us:
            self.loop.tick()

    def leave(self) -> None:
        """End as a host process does."""
        self.loop.fade_to_rest()
        self.device.close()
        self._go_on(self.now_us + 200_000)


class _Port:
    """What `SerialPort` is, on the line in memory."""

    address = Address("wired")
    gone = False
    losses = lost = 0

    def __init__(self, wired: Wired) -> None:
        self._wired = wired

    def read(self) -> bytes:
        return self._wired.read()

    def write(self, frame: bytes) -> bool:
        if self._wired._troubles.stopped_writing:
            self._wired.maybe_stall()
        self._wired.send_down(frame)
        return True

    def drop_unsent(self) -> None:
        self._wired.drop_unsent()

    def close(self, pause: Callable[[float], None]) -> None:
        pause(0.05)


def reading(
    seed: int,
    kind: str,
    controller: Callable[..., Controller] = Controller,
    conversation: type[Conversation] = Conversation,
) -> Wired:
    """Read for half a second with the troubles of the "host" or of the "line"; what came of it."""
    chance = random.Random(f"{kind} {seed}")
    make = {"host": troubles_of_host, "line": troubles_of_line}[kind]
    wired = Wired(
        chance,
        make(chance, 400_000),
        controller,
        conversation,
        slew_per_s=chance.choice((0, 0, 8, 40)),
        swing=chance.choice((0.0, 0.5, 1.0)),
        speed_mm_s=chance.choice((0.0, 60.0, 300.0)),
    )
    wired.run(0.5)
    wired.leave()
    if not wired.controller.at_rest:
        wired.breaches.append("not at rest after the end")
    return wired
