"""A Latero that times how long it takes from reading its encoders to the frame for that place.

Its array goes to and fro by a fixed step with each answer. It ends when its standard input does,
and prints as JSON how many frames it timed, and percentiles 50 and 99 in ms.
"""

from __future__ import annotations

import gc
import json
import os
import select
import socket
import sys
import time

import numpy as np

from tests.benchmarks.latero_page import page
from vbraille.carriers import latero
from vbraille.devices.latero.device import DISPLAY
from vbraille.devices.latero.wire import FULL
from vbraille.simulation.lateroboard import LateroBoard
from vbraille.simulation.laterosim import OFFSETS

LOW_MM, HIGH_MM, STEP_MM = 2.0, 8.0, 0.4
_PRIORITY = 41  # the host has 40; a real Latero has a processor of its own
_MARGIN = 4  # steps near the turns, where one frame stands for two places of late
_MOST_TICKS = 8
_SETTLING = 1000
_STDIN = 0


def main() -> None:
    """Be the Latero until told to end."""
    steps = round((HIGH_MM - LOW_MM) / STEP_MM)
    forth = LOW_MM + STEP_MM * np.arange(steps)
    places_mm = np.concatenate((forth, forth[::-1]))
    line, frame = page(), np.zeros(DISPLAY.shape)
    levels, encoders = [], []
    for x_mm in places_mm:
        line.frame(float(x_mm), frame)
        levels.append(np.rint(150 * (1 - frame)).astype(int).ravel())
        joints = latero.joints_at(float(x_mm) + DISPLAY.span_mm / 2, 100.0)
        encoders.append((*latero.encoders_of(joints, OFFSETS), 0))
    clear = [_MARGIN <= n % steps < steps - _MARGIN for n in range(2 * steps)]
    board = LateroBoard()
    line_in = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    line_in.bind(("127.0.0.1", 0))
    print(line_in.getsockname()[1], flush=True)
    os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(_PRIORITY))
    gc.freeze()
    gc.disable()
    read_ns = [0] * (2 * steps)
    taken_ms: list[float] = []
    tick, shown = 0, board.levels.astype(int)
    while True:
        readable = select.select((line_in, _STDIN), (), ())[0]
        if _STDIN in readable:
            break
        request, host = line_in.recvfrom(256)
        now_ns = time.monotonic_ns()
        n = tick % (2 * steps)
        board.encoders = encoders[n]
        read_ns[n] = time.monotonic_ns()
        answer = board.receive(request)
        if answer is not None:
            line_in.sendto(answer, host)
        if request[2] != FULL:
            continue
        shown, before = board.levels.astype(int), shown
        # A question between two ticks bears the frame that is shown already.
        if not board.at_rest and (shown != before).any():
            backs = range(1, min(_MOST_TICKS, tick) + 1)
            off = [int(np.abs(levels[(tick - back) % (2 * steps)] - shown).max()) for back in backs]
            best = int(np.argmin(off))
            made = (tick - 1 - best) % (2 * steps)
            if off[best] <= 2 and clear[made]:
                taken_ms.append((now_ns - read_ns[made]) / 1e6)
        tick += 1
    counted = taken_ms[_SETTLING:]
    median, high = np.percentile(counted, (50, 99))
    print(json.dumps({"frames": len(counted), "ms": (median, high)}), flush=True)


if __name__ == "__main__":
    sys.exit(main())
