"""A controller that times its own round trips: from reading its encoder to the frame for it.

It runs before the host, and speaks by the package in `loop-of-2026-11-21.zip`, whichever host
is measured. It ends when its standard input does, and prints as JSON how many round trips
it timed, and their percentiles 50 and 99 in µs.
"""

from __future__ import annotations

import gc
import json
import os
import select
import sys
import time
from itertools import pairwise

import numpy as np
from vbraille.devices.firmware import Controller, describe
from vbraille.devices.pty import Link, Port

from tests.benchmarks.tick_baseline import INFO, RATE_HZ, page
from vbraille.devices.wire.messages import Encoder

LOW_MM, HIGH_MM, STEP_MM = 2.0, 8.0, 0.04
_PRIORITY = 41  # the host has 40; a real controller has a processor of its own
_MARGIN = 25  # steps near the turns, where one level stands for two places of late
_MOST_TICKS = 20
_SETTLING = 500  # round trips before those that count
_PERIOD_NS = round(1e9 / RATE_HZ)
_STDIN = 0


def main(link: str) -> None:
    """Be the device until told to end."""
    steps = round((HIGH_MM - LOW_MM) / STEP_MM)
    forth = LOW_MM + STEP_MM * np.arange(steps)
    places_mm = np.concatenate((forth, forth[::-1]))  # of each tick, again and again
    frames = page().path(places_mm)
    levels = np.rint(frames[:, 0, 0].astype(float) * (INFO.levels - 1)).astype(int).tolist()
    assert min(abs(a - b) for a, b in pairwise(levels[:steps])) > 5
    clear = [_MARGIN < n % steps < steps - _MARGIN for n in range(2 * steps)]
    controller = Controller(describe(INFO, Encoder.ABSOLUTE))
    port = Port(Link(link))
    assert port.descriptor is not None
    print("ready", flush=True)
    os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(_PRIORITY))
    gc.freeze()
    gc.disable()
    read_ns = [0] * (2 * steps)
    taken_us: list[float] = []
    due_ns, tick = time.monotonic_ns(), 0
    while True:
        left_s = max(due_ns - time.monotonic_ns(), 0) / 1e9
        readable = select.select((port.descriptor, _STDIN), (), (), left_s)[0]
        if _STDIN in readable:
            break
        if readable:
            chunk = port.read()
            now_ns = time.monotonic_ns()
            before = controller.frames
            port.send(controller.receive(chunk, now_ns // 1000))
            if controller.frames > before:
                level = int(controller.levels[0])
                for back in range(min(_MOST_TICKS, tick)):
                    n = (tick - 1 - back) % (2 * steps)
                    if abs(levels[n] - level) <= 2:
                        if clear[n]:
                            taken_us.append((now_ns - read_ns[n]) / 1e3)
                        break
        now_ns = time.monotonic_ns()
        if now_ns < due_ns:
            continue
        n = tick % (2 * steps)
        read_ns[n] = now_ns
        port.send(controller.tick(now_ns // 1000, float(places_mm[n]) + INFO.span_mm))
        tick += 1
        due_ns = max(due_ns + _PERIOD_NS, now_ns - _PERIOD_NS)
    port.unplug()
    counted = taken_us[_SETTLING:]
    median, high = np.percentile(counted, (50, 99))
    print(json.dumps({"trips": len(counted), "trip_us": (median, high)}), flush=True)


if __name__ == "__main__":
    main(sys.argv[1])
