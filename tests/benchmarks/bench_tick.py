"""The loop of this checkout and that of another, in turn, beside the same devices.

    git worktree add ../before COMMIT
    python -m tests.benchmarks.bench_tick ../before 5 6

measures each for 5 s, six times. Without another checkout (`python -m tests.benchmarks tick`) the
figures are this one's alone. The device is always this checkout's: a controller at a
pseudo-terminal, a Latero at a port, and a driver in Python.
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
import tempfile
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tests import drivers
from tests.benchmarks.latero_page import spec as latero_spec
from tests.benchmarks.timing import Result

if TYPE_CHECKING:
    from collections.abc import Iterator

REPEATS = 3
BLOCK_S = 20.0
BUSY_PROCESSES = 3
ROOT = Path(__file__).parents[2]
# Of the work of a tick, this checkout's against the other's.
BARS = {"serial": 1.3, "latero": 0.7, "driver": 0.7}
_SPIN = "while True: pass"
_DRIVER = '''
import time
import numpy as np
from vbraille.devices import Device
from vbraille.display import Pose

class Plain(Device):
    """A device in memory, as a driver from elsewhere is: four members, and no more."""

    def __init__(self, address, wanted):
        self._wanted, self._ticks = wanted, 0
        self._kept = np.zeros(wanted.shape)

    @property
    def display(self):
        return self._wanted

    def read(self):
        self._ticks += 1
        return Pose(time.monotonic_ns(), 2.0 + self._ticks % 150 * 0.04, 0.0, 0.0)

    def _send(self, frame):
        self._kept[:] = frame

    def _release(self):
        pass
'''


def run(
    other: Path | None = None, seconds: float = BLOCK_S, repeats: int = REPEATS
) -> Iterator[Result]:
    """Measure the hosts so often for so many seconds; rows give their medians.

    Parameters
    ----------
    other
        Directory of another checkout; None for none.
    seconds
        Duration of each measurement.
    repeats
        Measurements of each kind.
    """
    hosts = {"now": ROOT} | ({"before": other} if other else {})
    found: dict[tuple[str, str, bool], list[dict[str, Any]]] = {}
    with tempfile.TemporaryDirectory() as folder:
        installed = drivers.install(Path(folder), "plain", "Plain", _DRIVER)["PYTHONPATH"]
        for number in range(repeats + 1):
            for kind in BARS:
                for busy in (False, True) if kind == "serial" else (False,):
                    for name, root in hosts.items():
                        with spinning(BUSY_PROCESSES if busy else 0):
                            got = measured(kind, root, seconds if number else 2.0, installed)
                        if number:  # the first compiles, for the others to be warm
                            found.setdefault((kind, name, busy), []).append(got)
    yield from _rows(found)


def _rows(found: dict[tuple[str, str, bool], list[dict[str, Any]]]) -> Iterator[Result]:
    def median(key: tuple[str, str, bool], what: str, which: int | None = None) -> float:
        values = [got[what] if which is None else got[what][which] for got in found[key]]
        return statistics.median(values)

    for kind, name, busy in found:
        if name == "before":
            continue
        beside = (kind, "before", busy)
        where = f", beside {BUSY_PROCESSES} busy processes" if busy else ""
        for which, percent in ((0, "p50"), (1, "p99")):
            ours_us = median((kind, name, busy), "work_us", which)
            row, got, bar, met = f"work of a tick, {kind}, {percent}{where}", "", "reported", True
            if beside in found:
                theirs_us = median(beside, "work_us", which)
                share = ours_us / theirs_us
                got = f"{share:.2f} × ({theirs_us:.1f} µs), "
                bar, met = f"≤ {BARS[kind]:g} ×", share <= BARS[kind]
            yield Result(row, bar, f"{got}{ours_us:.1f} µs", met)
        for what, unit, factor in (("processor", "%", 100.0), ("ready_s", "s", 1.0)):
            names = [each for each in ("now", "before") if (kind, each, busy) in found]
            got = ", ".join(f"{factor * median((kind, n, busy), what):.2f} {unit}" for n in names)
            yield Result(f"{what}, {kind}{where}", "reported", got, met=True)
        if kind == "serial":
            for which, percent in ((0, "p50"), (1, "p99")):
                names = [each for each in ("now", "before") if (kind, each, busy) in found]
                got = ", ".join(
                    f"{median((kind, n, busy), 'trip_us', which):.0f} µs" for n in names
                )
                row = f"position at the device to the frame for it back, {percent}{where}"
                yield Result(row, "reported", got, met=True)
        lost = sum(got["overruns"] for got in found[kind, name, busy])
        yield Result(f"ticks lost by own work, {kind}{where}", "0", f"{lost}", lost == 0)


def measured(kind: str, root: Path, seconds: float, installed: str) -> dict[str, Any]:
    """What is found of the host of a checkout, beside a device of this one.

    Parameters
    ----------
    kind
        Device: one of `BARS`, or socket.
    root
        Directory of the host's checkout.
    seconds
        Duration of the measurement.
    installed
        Directory in which the driver in Python is installed.
    """
    with ExitStack() as stack:
        device = None
        if kind == "serial":
            link = str(Path(stack.enter_context(tempfile.TemporaryDirectory())) / "vb0")
            device = stack.enter_context(_python(ROOT, installed, "tick_device", link))
            _line(device)
            spec = f"serial:{link}"
        elif kind == "socket":
            device = stack.enter_context(_python(ROOT, installed, "tick_device", ""))
            spec = f"serial:socket://127.0.0.1:{int(_line(device))}"
        elif kind == "latero":
            device = stack.enter_context(_python(ROOT, installed, "latero_device"))
            spec = latero_spec(int(_line(device)))
        else:
            spec = "plain:"
        with _python(root, installed, "tick_host", spec, str(seconds)) as host:
            found = json.loads(host.communicate()[0])
        if device is not None:
            assert device.stdin is not None
            device.stdin.close()
            if kind == "socket":
                _line(device)  # which says that it was ready
            found |= json.loads(_line(device))
    assert Path(found["package"]).parent == root, "the wrong package was measured"
    return found


def _line(process: subprocess.Popen[str]) -> str:
    assert process.stdout is not None
    return process.stdout.readline()


def _python(root: Path, installed: str, module: str, *arguments: str) -> subprocess.Popen[str]:
    """Run a module of these benchmarks with the package that is in a directory."""
    # With byte code forbidden the compiler would be measured.
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
    # The working directory comes first, and an old checkout has benchmarks of its own: this one's
    # are run by their path.
    start = (
        f"import runpy, sys; import vbraille; sys.path.insert(0, {str(ROOT)!r}); "
        "sys.argv = sys.argv[1:]; runpy.run_module(sys.argv[0], run_name='__main__')"
    )
    return subprocess.Popen(
        [sys.executable, "-c", start, f"tests.benchmarks.{module}", *arguments],
        cwd=root,
        env=environment | {"PYTHONPATH": f"{root}:{installed}"},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )


@contextmanager
def spinning(processes: int) -> Iterator[None]:
    """Have so many other processes busy."""
    with ExitStack() as stack:
        for _ in range(processes):
            process = stack.enter_context(subprocess.Popen([sys.executable, "-c", _SPIN]))
            stack.callback(process.kill)
        yield


if __name__ == "__main__":
    for result in run(Path(sys.argv[1]).resolve(), float(sys.argv[2]), int(sys.argv[3])):
        print(result.row(), flush=True)
