"""A controller of today's package that times its own round trips, in either version; see
`tick_serving`.

    python -m tests.benchmarks.tick_device_today LINK VERSION AXES
"""

from __future__ import annotations

import sys
from dataclasses import replace

from tests.benchmarks.tick_serving import places_mm, serve
from tests.benchmarks.tick_today import DISPLAY, page
from vbraille.devices.wire.messages import Encoder
from vbraille.simulation.described import describe
from vbraille.simulation.firmware import Controller
from vbraille.simulation.pty import Link, Port

_COUNTS = 100  # different places across the line, one after the other: all differ from the last


def main(link: str, version: int, axes: str) -> None:
    """Be the device until told to end."""
    display = replace(DISPLAY, height_mm=200.0 * ("y" in axes), turns="θ" in axes)
    controller = Controller(describe(display, Encoder.ABSOLUTE, version))
    ticks = 0

    def tick(now_us: int, x_mm: float) -> bytes:
        nonlocal ticks
        ticks += 1
        y_mm = 5.0 + ticks % _COUNTS / display.counts_per_mm
        return controller.tick(now_us, x_mm + display.span_mm, y_mm, 0.0)

    port = Port(Link(link))
    frames = page().path(places_mm() + DISPLAY.span_mm / 2)
    serve(controller, port, frames, DISPLAY.levels - 1, DISPLAY.rate_hz, tick)


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), sys.argv[3])
