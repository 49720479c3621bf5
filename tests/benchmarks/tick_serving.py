"""The loop of a controller that times its own round trips: from reading its encoder to the frame.

It needs nothing of any package, so that it serves controllers of old packages and of today's.
"""

from __future__ import annotations

import gc
import json
import os
import select
import time
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

LOW_MM, HIGH_MM, STEP_MM = 2.0, 8.0, 0.04
_PRIORITY = 41  # the host has 40; a real controller has a processor of its own
_MARGIN = 25  # steps near the turns, where one level stands for two places of late
_MOST_TICKS = 20
_SETTLING = 500  # round trips before those that count
_STDIN = 0


def places_mm() -> NDArray[np.float64]:
    """Places of the carriage in each tick, forth and back, again and again."""
    forth = LOW_MM + STEP_MM * np.arange(round((HIGH_MM - LOW_MM) / STEP_MM))
    return np.concatenate((forth, forth[::-1]))


def serve(
    controller: Any,
    port: Any,
    frames: NDArray[np.floating],
    top_level: int,
    rate_hz: float,
    tick: Callable[[int, float], bytes],
) -> None:
    """Be the device until standard input ends; print what was found, as JSON.

    Parameters
    ----------
    controller, port
        The device's.
    frames : float[places, rows, columns]
        Deflections for the places of `places_mm`.
    top_level
        Highest level of an actuator.
    rate_hz
        Ticks a second.
    tick
        The controller's tick, of the time in µs and the place in mm.
    """
    places, period_ns = places_mm(), round(1e9 / rate_hz)
    size = places.size
    steps = size // 2
    levels = np.rint(frames[:, 0, 0].astype(float) * top_level).astype(int).tolist()
    assert min(abs(a - b) for a, b in pairwise(levels[:steps])) > 5
    clear = [_MARGIN < n % steps < steps - _MARGIN for n in range(size)]
    print("ready", flush=True)
    os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(_PRIORITY))
    gc.freeze()
    gc.disable()
    read_ns = [0] * size
    taken_us: list[float] = []
    due_ns, number = time.monotonic_ns(), 0
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
                for back in range(min(_MOST_TICKS, number)):
                    n = (number - 1 - back) % size
                    if abs(levels[n] - level) <= 2:
                        if clear[n]:
                            taken_us.append((now_ns - read_ns[n]) / 1e3)
                        break
        now_ns = time.monotonic_ns()
        if now_ns < due_ns:
            continue
        n = number % size
        read_ns[n] = now_ns
        port.send(tick(now_ns // 1000, float(places[n])))
        number += 1
        due_ns = max(due_ns + period_ns, now_ns - period_ns)
    port.unplug()
    counted = taken_us[_SETTLING:]
    median, high = np.percentile(counted, (50, 99))
    print(json.dumps({"trips": len(counted), "trip_us": (median, high)}), flush=True)
