"""A controller of version 1 as a stranger built it, from the page of that version alone.

Nothing of vbraille is used: a change there must not change what is out there. What is the same in
both versions, the frames on the line, it has from its younger sister.
"""

import struct
from types import SimpleNamespace

from tests.devices.secondversion import body_of, line_of

WATCHDOG_US, RAMP_US = 50_000, 20_000
PLACED, RESTING, TRIPPED = 1, 2, 8


class FirstVersion:
    """STReSS² of 6 × 10 actuators with 10 bits, 300 mm of travel, 200 counts a mm."""

    ACTUATORS, TOP = 60, 1023

    def __init__(self, _info=None):
        self.info = SimpleNamespace(version=1)
        self.hellos = []
        self.frames = self.trips = self.dropped = self.buttons = 0
        self.levels = [0] * self.ACTUATORS
        self._began = self.levels
        self._greeted = self._armed = self._tripped = False
        self._resting, self._ramp_us = True, None
        self._held = b""
        self._sequence = self._frame = self._last_us = 0

    def receive(self, chunk, now_us):
        *lines, self._held = (self._held + chunk).split(b"\0")
        return b"".join(self._take(line, now_us) for line in lines if line)

    def tick(self, now_us, way_mm):
        said = b""
        if self._armed and now_us - self._last_us >= WATCHDOG_US:
            self.trips += 1
            self._rest(now_us)
            self._tripped = True
            said = self._watchdog()
        if self._ramp_us is not None:
            left = 1 - (now_us - self._ramp_us) / RAMP_US
            self.levels = [round(level * max(left, 0)) for level in self._began]
            if left <= 0:
                self._ramp_us = None
        self._sequence = (self._sequence + 1) & 0xFFFF
        flags = PLACED | RESTING * self._resting | TRIPPED * self._tripped
        state = struct.pack(
            "<BHIIHBBh",
            0x82,
            self._sequence,
            now_us & 0xFFFF_FFFF,
            round(way_mm * 200),
            self._frame,
            flags,
            self.buttons,
            -0x8000,
        )
        return said + line_of(state) if self._greeted else b""

    def _take(self, line, now_us):
        body = body_of(line)
        if body is None:
            self.dropped += 1
        elif body[0] == 1 and body[1:2] > b"\0":
            self.hellos.append(body[1])
            self._rest(now_us)
            self._greeted = body[1] == 1
            return self._info() + self._watchdog()
        elif body[0] == 3:
            self._rest(now_us)
        elif body[0] == 2 and self._greeted:
            return self._show(body, now_us)
        return b""

    def _show(self, body, now_us):
        number = int.from_bytes(body[3:], "big")
        if len(body) != 3 + self.ACTUATORS * 10 // 8:
            self.dropped += 1
            return b""
        levels = [number >> 10 * n & self.TOP for n in reversed(range(self.ACTUATORS))]
        (sequence,) = struct.unpack("<H", body[1:3])
        if self._ramp_us is not None or (self._resting and 20 * max(levels) > self.TOP):
            return b""
        if not self._resting and not 1 <= (sequence - self._frame) & 0xFFFF <= 0x7FFF:
            self.dropped += 1
            return b""
        told, self._tripped = self._tripped, False
        self.levels, self._frame, self._last_us = levels, sequence, now_us
        self._resting, self._armed = False, True
        self.frames += 1
        return self._watchdog() if told else b""

    def _rest(self, now_us):
        self._armed = self._tripped = False
        self._resting = True
        if self._ramp_us is None and any(self.levels):
            self._ramp_us, self._began = now_us, self.levels

    def _watchdog(self):
        return line_of(struct.pack("<BII", 0x83, self.trips, self.dropped))

    def _info(self):
        name, firmware = b"Old", b"1.7"
        return line_of(
            struct.pack(
                "<BBBBIIBHHHIBIbBI",
                *(0x81, 1, 6, 10, 1_200_000, 1_800_000, 1, self.TOP, 1000, 0),
                *(300_000, 0, 200_000, 1, 24, 0),
            )
            + bytes([len(name)])
            + name
            + bytes([len(firmware)])
            + firmware
            + bytes(60)
            + b"\xff" * 60
            + b"\1" * 60
        )
