"""A controller that times its round trips, at a pseudo-terminal or a socket; see `tick_serving`.

It runs before the host, and ends when its standard input does; then it prints as JSON how many
round trips it timed, and their percentiles 50 and 99 in µs.
"""

from __future__ import annotations

import socket
import sys
from contextlib import suppress

from tests.benchmarks.tick_page import DISPLAY, page
from tests.benchmarks.tick_serving import places_mm, serve
from vbraille.devices.serial.wire import Encoder
from vbraille.simulation.firmware import Controller, describe
from vbraille.simulation.pty import Link, Port


class SocketPort:
    """The device's end of a connection, which waits for the host to connect.

    It prints the number of its port before.
    """

    def __init__(self) -> None:
        with socket.create_server(("127.0.0.1", 0)) as server:
            print(server.getsockname()[1], flush=True)
            self._line, _ = server.accept()
        self._line.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.descriptor = self._line.fileno()

    def read(self) -> bytes:
        """Give the bytes that have come."""
        return self._line.recv(65_536)

    def send(self, message: bytes) -> None:
        """Send a message whole."""
        with suppress(OSError):  # the host has gone
            self._line.sendall(message)

    def unplug(self) -> None:
        """Hang up."""
        self._line.close()


def main(link: str) -> None:
    """Be the device at a link, or at a socket without one, until told to end."""
    controller = Controller(describe(DISPLAY, Encoder.ABSOLUTE))

    def tick(now_us: int, x_mm: float) -> bytes:
        return controller.tick(now_us, x_mm + DISPLAY.span_mm)

    frames = page().path(places_mm() + DISPLAY.span_mm / 2)
    port = Port(Link(link)) if link else SocketPort()
    serve(controller, port, frames, DISPLAY.levels - 1, DISPLAY.rate_hz, tick)


if __name__ == "__main__":
    main(sys.argv[1])
