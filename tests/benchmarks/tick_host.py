"""The program around a host that is measured: which one, its directory says.

`python -m` looks into the working directory first. So the program finds the `vbraille` that it is
started beside, and a host process that it starts finds the same.
"""

from __future__ import annotations

import json
import os
import sys
import time
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

_SETTLED_S = 1.0
_POLL_S = 0.2


@dataclass(frozen=True, slots=True)
class Opened:
    """A host that drives the device, whatever its interface is.

    Parameters
    ----------
    ready_s
        From its launch until it could be told what to show.
    process_id
        The process of its loop.
    work_ns
        Takes the work of the ticks since the last call; int64[n].
    overruns
        Ticks that were lost so far through their own work.
    """

    ready_s: float
    process_id: int
    work_ns: Callable[[], NDArray[np.int64]]
    overruns: Callable[[], int]


def busy_s(process: int) -> float:
    """Processor time of a process so far."""
    fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def main(module: str, spec: str, seconds: float) -> None:
    """Measure the host that a module opens, for so long; print what was found, as JSON."""
    with import_module(module).opened(spec) as host:
        time.sleep(_SETTLED_S)
        host.work_ns()
        begun_s, busy_before_s, overruns = (
            time.monotonic(),
            busy_s(host.process_id),
            host.overruns(),
        )
        work = []
        while time.monotonic() < begun_s + seconds:
            time.sleep(_POLL_S)
            work.append(host.work_ns())
        share = (busy_s(host.process_id) - busy_before_s) / (time.monotonic() - begun_s)
        overruns = host.overruns() - overruns
    median, high = np.percentile(np.concatenate(work), (50, 99)) / 1e3
    found = {
        "ready_s": host.ready_s,
        "work_us": (float(median), float(high)),
        "processor": share,
        "overruns": overruns,
        "package": str(Path(import_module("vbraille").__file__ or "").parent),
    }
    print(json.dumps(found), flush=True)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], float(sys.argv[3]))
