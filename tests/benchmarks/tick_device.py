"""A controller of the old package that times its own round trips; see `tick_serving`.

It runs before the host, and speaks by the package in `loop-of-2026-11-21.zip`, whichever host
is measured. It ends when its standard input does, and prints as JSON how many round trips
it timed, and their percentiles 50 and 99 in µs.
"""

from __future__ import annotations

import sys

from vbraille.devices.firmware import Controller, describe
from vbraille.devices.pty import Link, Port

from tests.benchmarks.tick_baseline import INFO, RATE_HZ, page
from tests.benchmarks.tick_serving import places_mm, serve
from vbraille.devices.wire.messages import Encoder


def main(link: str) -> None:
    """Be the device until told to end."""
    controller = Controller(describe(INFO, Encoder.ABSOLUTE))
    port = Port(Link(link))

    def tick(now_us: int, x_mm: float) -> bytes:
        return controller.tick(now_us, x_mm + INFO.span_mm)

    serve(controller, port, page().path(places_mm()), INFO.levels - 1, RATE_HZ, tick)


if __name__ == "__main__":
    main(sys.argv[1])
