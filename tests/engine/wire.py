"""A serial device without a port or real time: a controller at the end of a line in memory."""

from vbraille.devices import serial
from vbraille.devices.line import Address
from vbraille.engine.clock import ManualClock
from vbraille.simulation.controller import Controller, info_of


class Wire:
    """A line whose controller ticks each millisecond of a clock, and which holds bytes back."""

    descriptor = None

    def __init__(self, clock, display, hold_ms=0, mm_s=0.0, **changed):
        self.clock, self.hold_ms, self.mm_s = clock, hold_ms, mm_s
        self.controller = Controller(info_of(display))
        for name, value in changed.items():
            setattr(self.controller, name, value)
        self.ms = 0
        self.to_device, self.to_host = [], []

    def _held(self):
        return -(-self.ms // self.hold_ms) * self.hold_ms if self.hold_ms else self.ms

    def _arrived(self, way):
        arrived = b"".join(chunk for at, chunk in way if at <= self.ms)
        way[:] = [(at, chunk) for at, chunk in way if at > self.ms]
        return arrived

    def _run(self):
        while self.ms < self.clock.now_ns() // 1_000_000:
            self.ms += 1
            self.controller.receive(self._arrived(self.to_device))
            self.controller.x = round(200 * (50 + self.mm_s * self.ms / 1000))
            self.to_host.append((self._held(), self.controller.tick(self.ms * 1000)))

    def read(self):
        self._run()
        return self._arrived(self.to_host)

    def write(self, message):
        self._run()
        self.to_device.append((self._held(), message))
        return True

    def drop_unsent(self):
        pass

    def close(self):
        pass


def wired(monkeypatch, display, **how):
    """An open device at such a line, its clock and the line."""
    clock = ManualClock()
    wire = Wire(clock, display, **how)
    monkeypatch.setattr(serial, "Line", lambda _: wire)
    monkeypatch.setattr(serial, "usb_identity", lambda _: None)

    def pause(seconds):
        clock.advance_ns(round(seconds * 1e9))

    device = serial.SerialDevice(Address("wire", 1, {"boot": 5.0}), clock.now_ns, pause)
    return device, clock, wire
