"""A screen under the hand: from a program's write to the changed frame, and what a flood costs."""

from __future__ import annotations

import os
import statistics
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tests.benchmarks.timing import Result
from tests.screen.brltty import Brltty, shown
from vbraille.engine.record import Flag
from vbraille.render import STRESS2

if TYPE_CHECKING:
    from collections.abc import Iterator

WRITES = 100
FLOOD_S = float(os.environ.get("FLOOD_S", "60"))
RATE_HZ = 1000.0


def run() -> Iterator[Result]:
    with (
        tempfile.TemporaryDirectory() as folder,
        shown(folder, STRESS2, hand="spot:20,0") as screen,
        Brltty(Path(folder), Path(folder) / "socket") as brltty,
    ):
        client = screen.written_by(brltty)
        yield _latency(screen, client)
        yield _flood(screen, client)


def _latency(screen: Any, client: Any) -> Result:
    taken_ms = []
    for number in range(WRITES):
        screen.rest(0.05)
        screen.ticks.clear()
        begun_ns = time.monotonic_ns()
        client.writeText("abcdefg" if number % 2 else "gfedcba")

        def changes(begun_ns: int = begun_ns) -> list[int]:
            ticks = np.concatenate(screen.ticks) if screen.ticks else screen.settled()
            at = (ticks["flags"] & int(Flag.CHANGED) != 0) & (ticks["time_ns"] > begun_ns)
            return ticks["time_ns"][at].tolist()

        screen.until(lambda: bool(changes()))
        taken_ms.append((changes()[0] - begun_ns) / 1e6)
    p50, p90 = statistics.median(taken_ms), statistics.quantiles(taken_ms, n=10)[-1]
    got = f"{p50:.1f} ms ({p90:.1f} ms)"
    return Result(
        "a BrlAPI client's write to the changed frame, p50 (p90)", "≤ 20 ms", got, p50 <= 20
    )


def _flood(screen: Any, client: Any) -> Result:
    late = []
    for floods in (False, True):
        before = screen.device.tally.late
        begun_s = due_s = time.monotonic()
        count = 0

        def write(floods: bool = floods, begun_s: float = begun_s) -> bool:
            nonlocal due_s, count
            while floods and time.monotonic() >= due_s:
                client.writeText(f"{count % 10000:04d} updates")
                count, due_s = count + 1, due_s + 1 / RATE_HZ
            return time.monotonic() - begun_s > FLOOD_S

        screen.until(write, 2 * FLOOD_S)
        late.append(screen.device.tally.late - before)
    got = f"{late[1]} ({late[0]} without, {count / FLOOD_S:.0f} a second)"
    return Result("late ticks in a minute of 1,000 updates a second", "as without", got,
                  late[1] <= late[0] + 3)  # fmt: skip
