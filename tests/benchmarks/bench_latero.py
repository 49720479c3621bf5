"""A Latero on this computer: how late its ticks are, how old a frame's place, and kills.

    python -m tests.benchmarks.bench_latero 2 5

measures 2 blocks of 5 s, and kills 5 times each; without numbers, as the table has it.
"""

from __future__ import annotations

import json
import os
import select
import shutil
import signal
import statistics
import subprocess
import sys
import time
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING

import numpy as np

from tests.benchmarks.bench_engine import BLOCK_S, cyclictest_us
from tests.benchmarks.latero_page import ROOM, page, spec
from tests.benchmarks.timing import Result
from vbraille.devices.latero.device import DISPLAY
from vbraille.engine.host import Host, HostDiedError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

BLOCKS = 12
KILLS = 50
# The watchdog's 50 ms, its ramp of 20, and a period.
LIMIT_MS = 71.0
_PATIENCE_S = 30.0
_FELT = 0.1
_PARENT = """
import sys, time
from tests.benchmarks.bench_latero import reading
with reading(sys.argv[1]) as host:
    print(host.process_id, flush=True)
    time.sleep(600)
"""


def run(blocks: int = BLOCKS, kills: int = KILLS) -> Iterator[Result]:
    """Measure so many blocks of ticks, and kill so often."""
    yield from _ticks(blocks)
    yield from _kills(kills)


def _ticks(blocks: int) -> Iterator[Result]:
    ours, theirs, ages = [], [], []
    measured = shutil.which("cyclictest") is not None
    for _ in range(blocks):
        if measured:
            theirs.append(cyclictest_us())
        late_us, age_ms = _block()
        ours.append(late_us)
        ages.append(age_ms)
    for percent, bar in ((50, 1.2), (99, 1.5)):
        mine = [float(np.percentile(block, percent)) for block in ours]
        what = f"lateness of a Latero's ticks, {blocks * BLOCK_S:g} s, against cyclictest"
        if not measured:
            yield Result(f"{what}, p{percent}", f"≤ {bar} ×", "there is no cyclictest", met=False)
            continue
        share = statistics.median(
            one / float(np.percentile(other, percent))
            for one, other in zip(mine, theirs, strict=True)
        )
        got = f"{share:.2f} × ({statistics.median(mine):.0f} µs)"
        yield Result(f"{what}, p{percent}", f"≤ {bar} ×", got, share <= bar)
    for which, percent, bar_ms in ((0, 50, 1.0), (1, 99, 2.0)):
        got_ms = statistics.median(age[which] for age in ages)
        yield Result(
            f"Latero: position to the frame for it, p{percent}",
            f"≤ {bar_ms:g} ms",
            f"{got_ms:.2f} ms",
            got_ms <= bar_ms,
        )


def _block() -> tuple[NDArray[np.float64], tuple[float, float]]:
    """Lateness of each tick in µs, and how old a frame's place is in ms, for one block."""
    command = [sys.executable, "-m", "tests.benchmarks.latero_device"]
    with subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as device:
        assert device.stdin is not None
        assert device.stdout is not None
        port = int(device.stdout.readline())
        with Host(spec(port), DISPLAY, ROOM) as host:
            host.show(page(), 1)
            time.sleep(0.5)
            host.poll()
            time.sleep(BLOCK_S)
            late_us = host.poll()["lateness_ns"] / 1e3
        device.stdin.close()
        found = json.loads(device.stdout.readline())
    assert found["frames"] > 100
    return late_us, tuple(found["ms"])


@contextmanager
def watched() -> Iterator[tuple[str, Callable[[], tuple[float, float]]]]:
    """A Latero in a process of its own: its spec, and how long its next rest took, in ms."""
    command = [sys.executable, "-m", "tests.benchmarks.latero_watched"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as latero:
        assert latero.stdout is not None
        told = latero.stdout.readline().strip()

        def rested_ms() -> tuple[float, float]:
            assert select.select([latero.stdout], [], [], _PATIENCE_S)[0], "no rest"
            rest_ms, off_ms = map(float, latero.stdout.readline().split())
            return rest_ms, off_ms

        try:
            yield told, rested_ms
        finally:
            latero.kill()


@contextmanager
def reading(told: str) -> Iterator[Host]:
    """A host whose blades are off their rest, and have been for a while."""
    with Host(told, DISPLAY, ROOM) as host:
        host.show(page(), 1)
        end_s = time.monotonic() + _PATIENCE_S
        felt = 0
        while felt < 300:
            felt += int((host.poll()["frame"].max(axis=(1, 2)) > _FELT).sum())
            assert time.monotonic() < end_s
            time.sleep(0.005)
        yield host


def kill_host(told: str, rested_ms: Callable[[], tuple[float, float]]) -> tuple[float, float]:
    """Kill the host alone; give how long the blades and the power took."""
    taken_ms = float("nan"), float("nan")
    with suppress(HostDiedError), reading(told) as host:  # its end is told where it is closed
        assert host.process_id is not None
        os.kill(host.process_id, signal.SIGKILL)
        taken_ms = rested_ms()
    return taken_ms


def kill_parent(
    told: str, rested_ms: Callable[[], tuple[float, float]], *, both: bool = False
) -> tuple[float, float]:
    """Kill the parent, or the host and the parent."""
    command = [sys.executable, "-c", _PARENT, told]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as parent:
        assert parent.stdout is not None
        host = int(parent.stdout.readline())
        if both:
            os.kill(host, signal.SIGKILL)
        parent.kill()
        return rested_ms()


def kill_both(told: str, rested_ms: Callable[[], tuple[float, float]]) -> tuple[float, float]:
    """Kill the host and its parent."""
    return kill_parent(told, rested_ms, both=True)


def _kills(kills: int) -> Iterator[Result]:
    with watched() as (told, rested_ms):
        for who, kill in (("host", kill_host), ("parent", kill_parent), ("both", kill_both)):
            taken = np.array([kill(told, rested_ms) for _ in range(kills)])
            rest_ms, off_ms = taken.max(axis=0)
            yield Result(
                f"Latero: kill -9 of {who}, {kills} times: last frame of the host to rest, and to "
                f"motor power off, at most",
                f"≤ {LIMIT_MS:g} ms",
                f"{rest_ms:.1f} ms, {off_ms:.1f} ms",
                rest_ms <= LIMIT_MS,
            )


if __name__ == "__main__":
    for result in run(*map(int, sys.argv[1:])):
        print(result.row(), flush=True)
