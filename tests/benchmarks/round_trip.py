"""A device that times its own round trips: from reading its encoder to the frame for that place.

The page is one dot so wide that the level of the first actuator tells the place
for which the frame was made. Prints the two percentiles 50 and 99, in ms.
"""

from __future__ import annotations

import os
import select
import sys
import time
from dataclasses import replace

import numpy as np

from tests.shown import rendered
from vbraille.cli.simulate import go_real_time
from vbraille.devices.messages import Encoder
from vbraille.render import VBD, Tuning
from vbraille.simulation.firmware import Controller, describe
from vbraille.simulation.pty import Link, Port

GEOMETRY = replace(VBD.style.geometry, dot_width_mm=20.0, dot_spacing_mm=25.0, cell_gap_mm=25.0)
INFO = replace(VBD.on(GEOMETRY), levels=65_536)
LOW_MM, HIGH_MM, STEP_MM = 2.0, 8.0, 0.04
_MARGIN = 25  # steps near the turns, where one level stands for two places of late
_MOST_TICKS = 20
_PERIOD_NS = 1_000_000


def dot():
    """The page."""
    return rendered(
        np.ones(1, np.uint8),
        array=VBD.display,
        profile=VBD.style.profile,
        mapping=VBD.style.mapping,
        geometry=GEOMETRY,
        tuning=Tuning(texture=0.0),
    )


def main(link: str, seconds: float) -> None:
    """Be the device for so long."""
    steps = round((HIGH_MM - LOW_MM) / STEP_MM)
    forth = LOW_MM + STEP_MM * np.arange(steps)
    places_mm = np.concatenate((forth, forth[::-1]))  # of each tick, again and again
    frames = dot().with_anchor(0.0).path(places_mm)  # of the left column
    levels = np.rint(frames[:, 0, 0].astype(float) * (INFO.levels - 1)).astype(int).tolist()
    clear = [_MARGIN < n % steps < steps - _MARGIN for n in range(2 * steps)]
    controller = Controller(describe(INFO, Encoder.ABSOLUTE))
    port = Port(Link(link))
    assert port.descriptor is not None
    print("ready", flush=True)
    go_real_time()
    read_ns = [0] * (2 * steps)
    taken_ms: list[float] = []
    due_ns, tick = time.monotonic_ns(), 0
    end_ns = None
    while end_ns is None or time.monotonic_ns() < end_ns:
        left_s = max(due_ns - time.monotonic_ns(), 0) / 1e9
        if select.select((port.descriptor,), (), (), left_s)[0]:
            chunk = port.read()
            now_ns = time.monotonic_ns()
            before = controller.frames
            port.send(controller.receive(chunk, now_ns // 1000))
            if controller.frames > before and end_ns is None:
                end_ns = now_ns + round(seconds * 1e9)
            elif controller.frames > before:
                level = int(controller.levels[0])
                for back in range(min(_MOST_TICKS, tick)):
                    n = (tick - 1 - back) % (2 * steps)
                    if abs(levels[n] - level) <= 2:
                        if clear[n]:
                            taken_ms.append((now_ns - read_ns[n]) / 1e6)
                        break
        now_ns = time.monotonic_ns()
        if now_ns < due_ns:
            continue
        n = tick % (2 * steps)
        read_ns[n] = now_ns
        port.send(controller.tick(now_ns // 1000, float(places_mm[n]) + INFO.span_mm / 2))
        tick += 1
        due_ns = max(due_ns + _PERIOD_NS, now_ns - _PERIOD_NS)
    port.unplug()
    print(len(taken_ms), *np.percentile(taken_ms[1000:], (50, 99)), flush=True)
    sys.stdout.flush()
    os._exit(0)


if __name__ == "__main__":
    main(sys.argv[1], float(sys.argv[2]))
