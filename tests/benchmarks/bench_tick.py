"""The host of today and that of 2026-11-21, in turn, beside the same independent controller.

`loop-of-2026-11-21.zip` is the package as it was at commit 5ced91b, but for what neither the host
nor the controller needs:

    git archive --format=zip -9 5ced91b vbraille/{__init__,errors,caching,geometry}.py \
        vbraille/{devices,engine,render}, less devices/{carriage,conformance,simulator}.py and
        engine/{advance,batch,checkup,local,suspending}.py

It is unpacked for the measurement, since numba keeps nothing that it compiles of a zip.

    python -m tests.benchmarks.bench_tick 5

measures for 5 s each way, once.
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
import tempfile
import zipfile
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tests.benchmarks.timing import Result

if TYPE_CHECKING:
    from collections.abc import Iterator

REPEATS = 3
BLOCK_S = 60.0
LONG_S = 600.0
BUSY_PROCESSES = 3
ROOT = Path(__file__).parents[2]
ARCHIVE = Path(__file__).with_name("loop-of-2026-11-21.zip")
# By whom each is opened: one module for each interface that a host had.
BASELINE = "tests.benchmarks.tick_baseline"
TODAY = "tests.benchmarks.tick_today"
_SPIN = "while True: pass"


def run(
    seconds: float = BLOCK_S, repeats: int = REPEATS, long_s: float = LONG_S
) -> Iterator[Result]:
    """Measure each host so often for so many seconds, quiet and beside busy processes.

    Parameters
    ----------
    seconds
        Of each measurement.
    repeats
        Measurements of each kind; rows give their medians.
    long_s
        For how long today's host is run to see whether it loses ticks; 0 leaves that out.
    """
    with tempfile.TemporaryDirectory() as folder, zipfile.ZipFile(ARCHIVE) as archive:
        old = Path(folder)
        archive.extractall(old)
        hosts = {"baseline": (BASELINE, old), "today": (TODAY, ROOT)}
        for module, root in hosts.values():
            measured(module, root, old, 0.5)  # compiles, for the others to be warm
        found: dict[tuple[str, bool], list[dict[str, Any]]] = {}
        for _ in range(repeats):
            for busy in (False, True):
                for name, (module, root) in hosts.items():
                    with _busy(BUSY_PROCESSES if busy else 0):
                        got = measured(module, root, old, seconds)
                    found.setdefault((name, busy), []).append(got)
        yield from _rows(found)
        if long_s:
            lost = measured(TODAY, ROOT, old, long_s)["overruns"]
            minutes = f"in {long_s / 60:g} minutes"
            yield Result(f"ticks lost by own work {minutes}", "0", f"{lost}", lost == 0)


def _rows(found: dict[tuple[str, bool], list[dict[str, Any]]]) -> Iterator[Result]:
    def median(name: str, busy: bool, what: str, which: int) -> float:
        return statistics.median(got[what][which] for got in found[name, busy])

    def beside(what: str, which: int, *, busy: bool) -> tuple[float, float, str]:
        ours, theirs = (median(name, busy, what, which) for name in ("today", "baseline"))
        return ours, ours / theirs, f"{ours:.1f} µs, {ours / theirs:.2f} × ({theirs:.1f} µs)"

    for which, name, bar_us in ((0, "p50", 8.0), (1, "p99", 30.0)):
        ours_us, share, said = beside("work_us", which, busy=False)
        yield Result(
            f"work of a tick, {name}, beside the loop of 2026-11-21, on a quiet machine",
            f"≤ 1/5, ≤ {bar_us:g} µs",
            said,
            share <= 0.2 and ours_us <= bar_us,
        )
    for which, name, bar_us in ((0, "p50", None), (1, "p99", 60.0)):
        ours_us, _, said = beside("work_us", which, busy=True)
        yield Result(
            f"the same beside {BUSY_PROCESSES} busy processes, {name}",
            "reported" if bar_us is None else f"≤ {bar_us:g} µs",
            said,
            bar_us is None or ours_us <= bar_us,
        )
    for busy, where in ((False, "quiet"), (True, "busy")):
        ours, theirs = (
            statistics.median(got["processor"] for got in found[name, busy])
            for name in ("today", "baseline")
        )
        yield Result(
            f"processor time of the host at 1 kHz, on a {where} machine",
            "≤ 3.5 %" if not busy else "reported",
            f"{ours:.1%} ({theirs:.1%})",
            busy or ours <= 0.035,
        )
    for busy, where in ((False, "quiet"), (True, "busy")):
        for which, name, bar_us in ((0, "p50", 60.0), (1, "p99", 200.0)):
            ours_us, _, said = beside("trip_us", which, busy=busy)
            yield Result(
                f"position at the device to the frame for it back, {name}, on a {where} machine",
                "reported" if busy else f"≤ {bar_us:g} µs",
                said,
                busy or ours_us <= bar_us,
            )
    ours, theirs = (
        statistics.median(got["ready_s"] for got in found[name, False])
        for name in ("today", "baseline")
    )
    yield Result(
        "host ready, from launch, warm", "≤ 0.6 s", f"{ours:.2f} s ({theirs:.2f} s)", ours <= 0.6
    )
    lost, lost_before = (
        sum(got["overruns"] for busy in (False, True) for got in found[name, busy])
        for name in ("today", "baseline")
    )
    yield Result("ticks lost by own work in all of that", "0", f"{lost} ({lost_before})", lost == 0)


def measured(
    module: str,
    root: Path,
    devices: Path,
    seconds: float,
    device_module: str = "tests.benchmarks.tick_device",
    *options: str,
) -> dict[str, Any]:
    """What is found of one host, beside a controller of its own.

    Parameters
    ----------
    module, root
        Module that opens the host, and the directory of its package.
    devices
        Directory of the controller's package.
    seconds
        Duration of the measurement.
    device_module, options
        Module that is the controller, and what else it is told.
    """
    with tempfile.TemporaryDirectory() as folder:
        link = str(Path(folder) / "vb0")
        device = _python(devices, device_module, link, *options)
        with device:
            assert device.stdin is not None
            assert device.stdout is not None
            device.stdout.readline()
            with _python(
                root, "tests.benchmarks.tick_host", module, f"serial:{link}", str(seconds)
            ) as host:
                said = host.communicate()[0]
            device.stdin.close()
            found = json.loads(said) | json.loads(device.stdout.readline())
    assert Path(found["package"]).parent == root, "the wrong package was measured"
    return found


def _python(root: Path, *arguments: str) -> subprocess.Popen[str]:
    """Run a module of these benchmarks with the package that is in a directory."""
    # Whoever measures with byte code forbidden would measure the compiler.
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
    return subprocess.Popen(
        [sys.executable, "-m", *arguments],
        cwd=root,
        env=environment | {"PYTHONPATH": str(ROOT)},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )


@contextmanager
def _busy(processes: int) -> Iterator[None]:
    """Have so many other processes busy."""
    with ExitStack() as stack:
        for _ in range(processes):
            spinning = stack.enter_context(subprocess.Popen([sys.executable, "-c", _SPIN]))
            stack.callback(spinning.kill)
        yield


if __name__ == "__main__":
    for result in run(float(sys.argv[1]), repeats=1, long_s=0.0):
        print(result.row(), flush=True)
