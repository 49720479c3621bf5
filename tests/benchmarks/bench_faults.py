"""Cables pulled and processes killed: what the actuators do, by the controller's clock."""

from __future__ import annotations

import os
import re
import select
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

from tests.benchmarks.bench_engine import INFO, ROOM, line, simulator
from tests.benchmarks.timing import Result
from vbraille.engine.host import Host, HostDiedError
from vbraille.engine.record import Flag

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    import numpy as np

TIMES = 50
UNPLUGS = 100
LIMIT_MS = 71.0
BACK_S = 1.0
# What is read on, by its axes.
DISPLAYS: Final = {"x": INFO, "xyθ": replace(INFO, height_mm=200.0, turns=True)}
_PATIENCE_S = 30.0

# Says when the actuators have come to rest, and how long after the last frame that was valid.
_CONTROLLER = """
import sys
from tests.benchmarks.bench_faults import DISPLAYS
from vbraille.cli.old.commands.simulate import PRIORITY
from vbraille.engine.realtime import come_first
from vbraille.simulation.carriage import area_of
from vbraille.simulation.firmware import describe
from vbraille.simulation.hand import Sweep
from vbraille.devices.serial.wire import Encoder
from vbraille.simulation.pty import Link, Port
from vbraille.simulation.simulator import Simulator
display = DISPLAYS[sys.argv[2]]
simulator = Simulator(
    describe(display, Encoder.ABSOLUTE),
    Sweep(60.0),
    Port(Link(sys.argv[1])),
    say=lambda _: None,
    area=area_of(display, 10.0),
)
controller, seen = simulator.controller, 0
def stopped():
    global seen
    if controller.at_rest and controller.frames != seen:
        seen = controller.frames
        print(controller.rest_after_us / 1000, flush=True)
    return False
print("ready", flush=True)
come_first(PRIORITY)
simulator.run(stopped)
"""
_PARENT = """
import sys, time
from tests.benchmarks.bench_faults import reading
with reading(sys.argv[1]) as host:
    print(host.process_id, flush=True)
    time.sleep(600)
"""


def run() -> Iterator[Result]:
    yield _unplugged()
    for axes in DISPLAYS:
        for who in KILLS:
            taken = killed_ms(who, TIMES, axes)
            yield Result(
                f"kill -9 of {who}, {TIMES} times, axes {axes}: last valid frame to rest, at most",
                f"≤ {LIMIT_MS:g} ms",
                f"{max(taken):.1f} ms",
                max(taken) <= LIMIT_MS,
            )


def killed_ms(who: str, times: int, axes: str) -> list[float]:
    """Kill "host", "parent" or "both" so often, while they read on a controller with these axes.

    Returns
    -------
    list[float]
        From the last frame that the controller took until its actuators were at rest, in ms, by the
        controller's clock.
    """
    with tempfile.TemporaryDirectory() as folder:
        link = str(Path(folder) / "vb0")
        command = [sys.executable, "-c", _CONTROLLER, link, axes]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as controller:
            assert controller.stdout is not None
            controller.stdout.readline()

            def rested_ms() -> float:
                assert select.select([controller.stdout], [], [], _PATIENCE_S)[0]
                return float(controller.stdout.readline())

            try:
                return [KILLS[who](f"serial:{link}", rested_ms) for _ in range(times)]
            finally:
                controller.kill()


@contextmanager
def reading(spec: str) -> Iterator[Host]:
    """A host with actuators off their rest."""
    with Host(spec, INFO, ROOM) as host:
        host.show(line(), 1)
        _until(host, lambda ticks: bool(ticks["frame"][-1].any()) and ticks["tick"][-1] > 300)
        yield host


def _until(host: Host, enough: Callable[[np.ndarray], bool]) -> None:
    end_s = time.monotonic() + _PATIENCE_S
    while True:
        ticks = host.poll()
        if ticks.size and enough(ticks):
            return
        assert time.monotonic() < end_s
        time.sleep(0.005)


def _host(spec: str, rested_ms: Callable[[], float]) -> float:
    # Its end is told where it is closed.
    taken_ms = float("nan")
    with suppress(HostDiedError), reading(spec) as host:
        assert host.process_id is not None
        os.kill(host.process_id, signal.SIGKILL)
        taken_ms = rested_ms()
    return taken_ms


def _parent(spec: str, rested_ms: Callable[[], float], both: bool = False) -> float:
    command = [sys.executable, "-c", _PARENT, spec]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as parent:
        assert parent.stdout is not None
        host = int(parent.stdout.readline())
        ended = os.pidfd_open(host)
        if both:
            os.kill(host, signal.SIGKILL)
        parent.kill()
        taken = rested_ms()
        assert select.select([ended], [], [], _PATIENCE_S)[0]
        os.close(ended)
        return taken


def _both(spec: str, rested_ms: Callable[[], float]) -> float:
    return _parent(spec, rested_ms, both=True)


KILLS: Final = {"host": _host, "parent": _parent, "both": _both}


def _unplugged() -> Result:
    back_s: list[float] = []
    with simulator("--unplug-every", "0.7s") as (spec, device), reading(spec) as host:
        assert device.stdout is not None
        begun = _settled(host)
        for said in device.stdout:
            if not said.startswith("plugged in again"):
                continue
            plugged_s = time.monotonic()
            host.poll()
            _until(
                host,
                lambda ticks: (
                    not ticks["flags"][-1] & Flag.SILENT and bool(ticks["frame"][-1].any())
                ),
            )
            back_s.append(time.monotonic() - plugged_s)
            if len(back_s) == UNPLUGS:
                break
        leaked = _settled(host) - begun
    names = ", ".join(f"{number} × {name}" for name, number in sorted(leaked.items()))
    return Result(
        f"unplugged and plugged in again, {UNPLUGS} times: reading again after, at most",
        f"≤ {BACK_S:g} s, no descriptor leaked",
        f"{max(back_s):.2f} s, {leaked.total()} leaked{f' ({names})' * bool(names)}",
        max(back_s) <= BACK_S and not leaked,
    )


def _settled(host: Host) -> Counter[str]:
    """Descriptors of a host that holds its port, by what they are.

    A port is five of them: the terminal, and two pipes of pyserial's. Counted while the device
    happened to be unplugged at the beginning, and plugged in at the end, they were five more
    without a leak. So a count is taken only with the port there, and twice alike.
    """
    end_s = time.monotonic() + _PATIENCE_S
    last = Counter[str]()
    while True:
        now = _descriptors(host)
        if now == last and now["/dev/pts"]:
            return now
        assert time.monotonic() < end_s, f"the host's descriptors do not settle: {now}"
        last = now
        host.poll()
        time.sleep(0.05)


def _descriptors(host: Host) -> Counter[str]:
    """What the descriptors of the host are, without the numbers that tell one from the other."""
    names = Counter[str]()
    for descriptor in Path(f"/proc/{host.process_id}/fd").iterdir():
        with suppress(OSError):  # closed meanwhile
            name = str(descriptor.readlink()).removesuffix(" (deleted)")
            names[re.sub(r":?\[\d+\]$|(?<=^/dev/pts)/\d+$", "", name)] += 1
    return names
