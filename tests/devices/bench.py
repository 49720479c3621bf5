"""A simulated controller on a line in memory, on a clock that turns when a host waits."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tests.engine.test_loop import info
from vbraille.devices.events import told
from vbraille.devices.serial.device import begin
from vbraille.devices.serial.port import parse_address
from vbraille.devices.serial.wire import Decoder, Encoder
from vbraille.simulation.firmware import Controller, describe

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.devices.serial.device import SerialDevice
    from vbraille.display import Pose

HOME_MM = -5.4  # of the centre of the array, which is 10.8 mm long, at the left stop
HALF = np.full((6, 10), 0.5)
REST = np.zeros((6, 10))
NO_FRAME = "no frame reached it in time, so it went to rest; reading goes on"
HOST_LATE = f"device: this computer was late, and {NO_FRAME}"
LINE_LATE = f"device: the line was late, and {NO_FRAME}"
DEVICE_LATE = f"device: it was late itself, and {NO_FRAME}"
AWAY = "device: unplugged; plug it in again and reading goes on"
# What a pseudo-terminal holds of what is not read, to the device and to the host.
DOWN_BYTES, UP_BYTES = 20_000, 4000


def shown(encoder=Encoder.ABSOLUTE, *, axes=None, **changes):
    """INFO of the bench's display, with other axes and other fields of INFO."""
    return replace(describe(replace(info(), **axes or {}), encoder), **changes)


class MemoryPort:
    """What `SerialPort` is, at a bench."""

    lost = 0

    def __init__(self, bench: Bench, address: str) -> None:
        self.address = parse_address(address)
        self.gone = self.closed = False
        self.losses = 0
        self._bench = bench

    def read(self) -> bytes:
        if not self._there():
            return b""
        self.gone = False
        chunk, self._bench.up = bytes(self._bench.up), bytearray()
        return chunk

    def write(self, frame: bytes) -> bool:
        bench = self._bench
        if self.gone or not self._there() or len(bench.down) + len(frame) > bench.room:
            return False
        bench.down += frame
        return True

    def drop_unsent(self) -> None:
        self._bench.down.clear()
        self._bench.down += b"\0"  # as `SerialPort` ends what was sent in part

    def close(self, _pause: Callable[[float], None]) -> None:
        self.closed = True

    def _there(self) -> bool:
        if not self._bench.plugged and not self.gone:
            self.gone = True
            self.losses += 1
        return self._bench.plugged


class Bench:
    """A controller on a line in memory; a millisecond passes with each tick.

    Parameters
    ----------
    made_as
        Makes the controller of its INFO.
    changes
        What of INFO is otherwise.
    """

    address = "/dev/pts/bench"

    def __init__(self, made_as=Controller, **changes) -> None:
        self.us = 0
        self.way_mm, self.y_mm, self.theta_rad = 5.0, 0.0, 0.0
        self.wire = Decoder()
        self.sent = []  # what came from the host
        self.deaf = self.mute = self.plugged = False
        self.down, self.up = bytearray(), bytearray()
        self.room = DOWN_BYTES
        self.controller = made_as(shown(**changes))
        self.port: MemoryPort | None = None
        self.plug()

    def plug(self) -> None:
        self.plugged = True
        self.down.clear()
        self.up.clear()

    def unplug(self) -> None:
        self.plugged = False

    def now_ns(self) -> int:
        return self.us * 1000

    def pause(self, seconds: float) -> None:
        for _ in range(max(1, round(seconds * 1000))):
            self.us += 1000
            if self.plugged:
                self.pump()

    def pump(self) -> None:
        self.hear()
        self.say(self.controller.tick(self.us, self.way_mm, self.y_mm, self.theta_rad))

    def hear(self) -> None:
        if not self.deaf:
            chunk = self.receive()
            self.sent += self.wire.feed(chunk)
            self.say(self.controller.receive(chunk, self.us))

    def receive(self) -> bytes:
        """What the host has sent."""
        chunk, self.down = bytes(self.down), bytearray()
        return chunk

    def say(self, chunk: bytes) -> None:
        """Have the controller say so, unless it is mute."""
        if not self.mute:
            self.put(chunk)

    def put(self, chunk: bytes) -> None:
        """Put bytes on the line to the host, as far as there is room."""
        self.up += chunk[: UP_BYTES - len(self.up)]

    def begin(self, wanted, *, pause=None, now_ns=None, options="") -> SerialDevice:
        """Open it as it is, for a page that wants this."""
        return begin(self.fresh_port(options), wanted, now_ns or self.now_ns, pause or self.pause)

    def fresh_port(self, options="") -> MemoryPort:
        """Line of the device, as it is when it has just been opened."""
        self.port = MemoryPort(self, f"{self.address}{options}")
        return self.port

    def open(self, options="", **changes) -> SerialDevice:
        return self.begin(info(**changes), options=options)

    def run(self, device, ticks: int, frame=HALF) -> Pose | None:
        """Tick as the loop does; the last sample."""
        last = None
        for _ in range(ticks):
            self.pause(0.001)
            last = device.read() or last
            device.write(frame)
        return last

    def settle(self, device, frame=HALF) -> None:
        """Tick until frames are taken, and then some: a conversation begins at rest."""
        for _ in range(100):
            self.run(device, 1, frame)
            if device.taking:
                break
        assert device.taking
        self.run(device, 3, frame)

    def find(self) -> None:
        """Let those who look for it find it; in memory no one has to."""

    def back(self, device) -> Pose:
        """Let those who look for it find it; the first sample."""
        self.find()
        for _ in range(300):
            if sample := self.run(device, 1):
                return sample
        raise AssertionError("the device does not come back")

    def come_back(self, device, **changes) -> list[str]:
        """Have it unplugged and another plugged in in its place; what is said of it."""
        self.unplug()
        self.run(device, 1)
        self.us += 1_000_000  # so that each notice is said at once
        self.controller = Controller(shown(**changes))
        self.plug()
        self.find()
        self.run(device, 300)
        notes = told(device.take_events())
        assert notes[0] == AWAY
        return notes[1:]

    def kinds(self) -> list:
        """Types of what the host has sent since the last call, each run of one as one."""
        kinds, self.sent = [type(event) for event in self.sent], []
        return [kind for i, kind in enumerate(kinds) if not i or kinds[i - 1] is not kind]
