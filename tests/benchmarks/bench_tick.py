"""The tick of a serial device: from its place to the frame, work, and the host's processor."""

from __future__ import annotations

import os
import subprocess
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tests.benchmarks.timing import Result
from vbraille.engine.host import Host
from vbraille.render import MODELS

if TYPE_CHECKING:
    from collections.abc import Iterator

SECONDS, PORT = 8.0, 47_300
FIRMWARE = Path(__file__).parents[2] / "firmware"


def run() -> Iterator[Result]:
    """Read a line at a controller of C for some seconds, at a socket and at a pseudo-terminal."""
    with tempfile.TemporaryDirectory() as folder:
        binary, link = Path(folder) / "device", Path(folder) / "port"
        source = Path(__file__).with_name("tick_device.c")
        subprocess.run(
            ["cc", "-O2", "-std=gnu99", f"-I{FIRMWARE}", str(source), "-o", str(binary)], check=True
        )
        for name, place, spec in (
            ("socket", str(PORT), f"serial:socket://127.0.0.1:{PORT}"),
            ("pseudo-terminal", str(link), f"serial:{link}"),
        ):
            # A real controller has a processor of its own: this one comes first.
            first = ["chrt", "-f", "45"] if os.geteuid() == 0 else []
            command = [*first, str(binary), place, str(SECONDS)]
            with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as device:
                time.sleep(0.5)
                ticks, share = _read(spec, device)
                answered_us = np.array(device.communicate()[0].split(), float) / 1e3
            yield from _rows(name, answered_us, ticks, share)


def _rows(name: str, answered_us: np.ndarray, ticks: np.ndarray, share: float) -> Iterator[Result]:
    median, most = np.percentile(answered_us, (50, 99))
    yield _row(f"{name}: STATE to FRAME at the controller, p50", median, "µs", 40)
    yield _row(f"{name}: STATE to FRAME at the controller, p99", most, "µs", 150)
    late = 100 * float((answered_us > 300).mean())
    yield _row(f"{name}: STATEs answered after more than 300 µs", late, "%", 0.5)
    median, most = np.percentile(ticks["work_ns"] / 1e3, (50, 99))
    yield _row(f"{name}: work of a tick, p50", median, "µs", 30)
    yield _row(f"{name}: work of a tick, p99", most, "µs", 80)
    yield _row(f"{name}: processor of the host process", 100 * share, "%", 6)


def _row(what: str, got: float, unit: str, bar: float) -> Result:
    return Result(what, f"≤ {bar:g} {unit}", f"{got:.1f} {unit}", got <= bar)


def _read(spec: str, device: subprocess.Popen[str]) -> tuple[np.ndarray, float]:
    model = MODELS["stress2"]
    ticks = []
    with Host(spec, model.display, fits=False) as host:
        host.show(model.style.render(np.full(26, 63, np.uint8), host.display), 1)
        begun_s, used_s = time.monotonic(), _processor_s(host._process.pid)
        while device.poll() is None and time.monotonic() - begun_s < SECONDS - 1:
            time.sleep(0.05)
            ticks.append(host.poll())
        used_s = _processor_s(host._process.pid) - used_s
        share = used_s / (time.monotonic() - begun_s)
    return np.concatenate(ticks), share


def _processor_s(process: int | None) -> float:
    fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
