"""The steady tick with devices of version 1 and version 2 of the wire protocol, in turn.

    python -m tests.benchmarks.bench_protocols 5

measures for 5 s each, once.
"""

from __future__ import annotations

import statistics
import sys
from typing import TYPE_CHECKING, Any

from tests.benchmarks.bench_tick import ROOT, TODAY, measured
from tests.benchmarks.timing import Result

if TYPE_CHECKING:
    from collections.abc import Iterator

BLOCK_S = 30.0
REPEATS = 5
MOST = 1.1  # times the first: the tick's figures of version 1 are reached
DEVICES = {
    "version 1": ("1", "x"),
    "version 2": ("2", "x"),
    "version 2 with y and θ": ("2", "xyθ"),
}


def run(seconds: float = BLOCK_S, repeats: int = REPEATS) -> Iterator[Result]:
    """Measure each kind of device so often for so many seconds; rows give medians."""
    found: dict[str, list[dict[str, Any]]] = {name: [] for name in DEVICES}
    for number in range(repeats + 1):
        for name, device in DEVICES.items():
            got = _one(device, seconds if number else 0.5)  # the first run warms the caches
            if number:
                found[name].append(got)
    first, *others = DEVICES
    for what, title in (
        ("work_us", "work of a tick"),
        ("trip_us", "position at the device to the frame for it back"),
    ):
        for which, percentile in ((0, "p50"), (1, "p99")):
            base = statistics.median(got[what][which] for got in found[first])
            for name in others:
                ours = statistics.median(got[what][which] for got in found[name])
                yield Result(
                    f"{title}, {percentile}, {name} beside {first}",
                    f"≤ {MOST:g} ×",
                    f"{ours:.1f} µs, {ours / base:.2f} × ({base:.1f} µs)",
                    ours <= MOST * base,
                )
    for name in DEVICES:
        share = statistics.median(got["processor"] for got in found[name])
        lost = sum(got["overruns"] for got in found[name])
        yield Result(
            f"processor time of the host at 1 kHz, {name}; ticks lost by own work",
            "reported; 0",
            f"{share:.1%}; {lost}",
            lost == 0,
        )


def _one(device: tuple[str, str], seconds: float) -> dict[str, Any]:
    return measured(TODAY, ROOT, ROOT, seconds, "tests.benchmarks.tick_device_today", *device)


if __name__ == "__main__":
    for result in run(float(sys.argv[1]), repeats=1):
        print(result.row(), flush=True)
