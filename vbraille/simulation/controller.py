"""A simulated controller: what a device does with bytes and ticks, without a port or a clock.

It does the same as `firmware/vbraille.h`, and has the same names for it.
"""

from __future__ import annotations

import json
import struct
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from vbraille.devices.protocol import (
    FAULT,
    FRAME,
    HELLO,
    PIECE_BYTES,
    PLACED,
    RAMP_MS,
    SAY,
    VERSION,
    WAITING,
    WATCHDOG_MS,
    ZERO,
    Lines,
    State,
    info_pieces,
    level_bits,
    line_of,
    read_info,
    state_body,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from vbraille.display import Display

_MOST_AGE: Final = 50  # ticks without a FRAME
_COUNTS_PER_TURN: Final = 65_536


def info_of(display: Display, *, buttons: int = 8, knobs: int = 4) -> dict[str, Any]:
    """INFO of a device that is such a display.

    Raises
    ------
    ValueError
        If the protocol has no room for it.
    """
    top, axes = display.levels - 1, 2 if display.height_mm else 1
    told = {
        "name": display.name,
        "rows": display.rows,
        "columns": display.columns,
        "pitch_mm": [display.column_pitch_mm, display.row_pitch_mm],
        "rest": display.rest_side,
        "top": top,
        "fast": -(-top * 65 // 100),
        "rate": round(display.rate_hz),
        "counts_per_mm": [display.counts_per_mm] * axes,
        "travel_mm": [display.travel_mm, display.height_mm][:axes],
        "serial": "simulated",
        "counts_per_turn": _COUNTS_PER_TURN * display.turns,
        "buttons": buttons,
        "knobs": knobs,
    }
    read_info(json.dumps(told).encode())
    return told


class Controller:
    """The device's end of the wire protocol.

    Parameters
    ----------
    info
        INFO, as `docs/wire-protocol.md` describes it.
    placed
        Whether its encoders know where the carriage is.

    Attributes
    ----------
    level, goal : int64[actuators]
        Levels of the actuators, and those that they go to.
    x, y, turn, buttons, knobs, analog
        What the next STATE says: counts of the encoders, bits, bytes and numbers.
    placed, waiting, resting, greeted : bool
        What it is at.
    trips, dropped, frames, greetings : int
        Counts, which do not wrap here.
    watchdog_ms : int or None
        Time after which it rests without a FRAME; None for a device without a watchdog.
    acknowledges : bool
        Whether STATEs say which FRAMEs were taken, as they must.
    """

    def __init__(self, info: dict[str, Any], *, placed: bool = True) -> None:
        self.info = info
        self.top, self.fast = info["top"], info["fast"]
        count = info["rows"] * info["columns"]
        self.level: NDArray[np.int64] = np.zeros(count, np.int64)
        self.goal: NDArray[np.int64] = np.zeros(count, np.int64)
        self.x = self.y = self.turn = self.buttons = 0
        self.knobs: Sequence[int] = (0, 0, 0, 0)
        self.analog: Sequence[int] = (0,) * len(info.get("analog", ()))
        self.placed = placed
        self.watchdog_ms: int | None = WATCHDOG_MS
        self.trips = self.dropped = self.frames = self.greetings = 0
        self.greeted = self.resting = self.faulty = False
        self.waiting = True
        self.acknowledges = True
        self.taken = self.number = self._base = 0
        self._slow = -(-self.top // RAMP_MS)
        self._pieces = info_pieces(info)
        self._piece = len(self._pieces)  # that is due; none
        self._until_state = 0
        self._armed = False
        self._age = 0
        self._now_us = self._taken_us = 0
        self._say: tuple[int, bytes] | None = None
        self._say_code = 0
        self._zero = (0, 0, 0)
        self._seen = (0, 0, 0)
        self._bits = level_bits(self.top)
        self._level_bytes = (self._bits * count + 7) // 8
        self._lines = Lines()

    @property
    def at_rest(self) -> bool:
        """Tell whether every actuator is at rest."""
        return not self.level.any()

    def receive(self, chunk: bytes) -> None:
        """Take bytes from the host."""
        damaged = self._lines.damaged
        bodies = self._lines.bodies(chunk)
        self.dropped += self._lines.damaged - damaged
        for body in bodies:
            self.dropped += not self._obey(body)

    def hang_up(self) -> None:
        """Forget a line that came in part: the port is gone."""
        self._lines.clear()

    def say(self, code: int, text: str) -> None:
        """Tell the host something; code 1 is a fault, until the next HELLO."""
        if code and self.faulty:
            return
        self._say, self._say_code = (code, text.encode()[:PIECE_BYTES]), code
        if code:
            self.faulty = True
            self._rest(waiting=True)

    def tick(self, now_us: int, *, room: bool = True) -> bytes:
        """Do a tick, one each millisecond; give the line to send, or nothing.

        Parameters
        ----------
        now_us
            Time by the device's clock.
        room
            Whether the line to the host has room; otherwise a STATE is lost, and all else is sent
            later.
        """
        self._now_us = now_us
        self._seen = self.x, self.y, self.turn
        if self._armed and self.watchdog_ms is not None:
            self._age += 1
            late = now_us - self._taken_us >= 1000 * self.watchdog_ms
            if late or (self._age >= _MOST_AGE and self.watchdog_ms == WATCHDOG_MS):
                self.trips += 1
                self._rest(waiting=True)
        most = self._slow if self.resting else self.fast
        self.level += np.clip(self.goal - self.level, -most, most)
        if self.at_rest:
            self.resting = False
        return self._speak(room)

    def _rest(self, *, waiting: bool) -> None:
        self.goal[:] = 0
        self.resting, self.waiting, self._armed = True, waiting, False

    def _obey(self, body: bytes) -> bool:
        if len(body) > 3 + self._level_bytes:
            return False
        kind, size = body[0], len(body)
        if kind == HELLO and size == 2:
            self.greeted, self.faulty = body[1] == VERSION, False
            self.greetings += 1
            if self._say_code:
                self._say = None
            self._piece = 0
            self._rest(waiting=True)
            return True
        if not self.greeted:
            return False
        if kind == ZERO and size == 1:
            self._zero, self.placed = self._seen, True
            return True
        if kind != FRAME or self.faulty or size < 3:
            return False
        number = int.from_bytes(body[1:3], "little")
        if size == 3:
            self._base = number
            self._rest(waiting=False)
        elif not self._take(number, body[3:]):
            return False
        self.taken = number
        return True

    def _take(self, number: int, packed: bytes) -> bool:
        if len(packed) != self._level_bytes or self.waiting or self.resting:
            return False
        levels = self._unpacked(packed)
        if not 1 <= (number - self.taken) & 0xFFFF <= 0x7FFF or (levels > self.top).any():
            return False
        self.goal[:] = levels
        self._armed, self._age, self._taken_us = True, 0, self._now_us
        self.frames += 1
        return True

    def _unpacked(self, packed: bytes) -> NDArray[np.int64]:
        bits = np.unpackbits(np.frombuffer(packed, np.uint8), bitorder="little")
        levels = bits[: self._bits * self.level.size].reshape(-1, self._bits)
        return levels @ (1 << np.arange(self._bits))

    def _speak(self, room: bool) -> bytes:
        self._until_state -= self._until_state > 0
        if self._piece < len(self._pieces):
            piece = self._pieces[self._piece]
            self._piece += room
            return line_of(piece) if room else b""
        if not self.greeted:
            return b""
        if self._say is not None:
            code, text = self._say
            self._say = None if room else self._say
            return line_of(bytes((SAY, code)) + text) if room else b""
        if self._until_state:
            return b""
        self._until_state = 1000 // self.info["rate"]
        self.number = (self.number + 1) & 0xFFFF
        return line_of(state_body(self._state())) if room else b""

    def _state(self) -> State:
        x, y, turn = (_i32(now - zero) for now, zero in zip(self._seen, self._zero, strict=True))
        waiting = WAITING * (self.waiting or self.resting)
        flags = PLACED * self.placed + waiting + FAULT * self.faulty
        analog = struct.pack(f"<{len(self.analog)}h", *self.analog)
        now_us = self._now_us & 0xFFFF_FFFF
        taken = self.taken if self.acknowledges else self._base
        counted = self.trips & 0xFF, self.dropped & 0xFF
        controls = self.buttons, bytes(self.knobs)
        return State(self.number, now_us, x, y, turn, taken, flags, *controls, *counted, analog)


def _i32(number: int) -> int:
    return (number + 0x8000_0000) % 0x1_0000_0000 - 0x8000_0000
