"""A controller that times its own round trips; see `tick_serving`.

It runs before the host, and ends when its standard input does; then it prints as JSON how many
round trips it timed, and their percentiles 50 and 99 in µs.
"""

from __future__ import annotations

import sys

from tests.benchmarks.tick_page import DISPLAY, page
from tests.benchmarks.tick_serving import places_mm, serve
from vbraille.devices.serial.wire import Encoder
from vbraille.simulation.firmware import Controller, describe
from vbraille.simulation.pty import Link, Port


def main(link: str) -> None:
    """Be the device until told to end."""
    controller = Controller(describe(DISPLAY, Encoder.ABSOLUTE))

    def tick(now_us: int, x_mm: float) -> bytes:
        return controller.tick(now_us, x_mm + DISPLAY.span_mm)

    port = Port(Link(link))
    frames = page().path(places_mm() + DISPLAY.span_mm / 2)
    serve(controller, port, frames, DISPLAY.levels - 1, DISPLAY.rate_hz, tick)


if __name__ == "__main__":
    main(sys.argv[1])
