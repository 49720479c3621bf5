"""The program around a host that is measured: which one, its directory says.

`python -m` looks into the working directory first. So the program finds the `vbraille` that it is
started beside, and a host process that it starts finds the same. The benchmarks are those of this
checkout, whichever host is measured.
"""

from __future__ import annotations

import json
import os
import sys
import time
from pathlib import Path

import numpy as np

import vbraille
from tests.benchmarks import latero_page, tick_page
from vbraille.devices.latero.device import DISPLAY as LATERO
from vbraille.engine.host import Host

_SETTLED_S = 1.0
_POLL_S = 0.2


def busy_s(process: int) -> float:
    """Processor time of a process so far."""
    fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def main(spec: str, seconds: float) -> None:
    """Measure the host of a device for so long; print what was found, as JSON."""
    display, page, room = tick_page.DISPLAY, tick_page.page(), None
    if spec.startswith("latero:"):
        display, page, room = LATERO, latero_page.page(), latero_page.ROOM
    begun_s = time.monotonic()
    with Host(spec, display, room or tick_page.STYLE.room(display, tick_page.CELLS)) as host:
        ready_s = time.monotonic() - begun_s
        host.show(page, 1)
        assert host.process_id is not None
        time.sleep(_SETTLED_S)
        host.poll()
        begun_s, overruns = time.monotonic(), host.tally.overruns
        busy_before_s = busy_s(host.process_id)
        work = []
        while time.monotonic() < begun_s + seconds:
            time.sleep(_POLL_S)
            work.append(host.poll()["work_ns"])
        share = (busy_s(host.process_id) - busy_before_s) / (time.monotonic() - begun_s)
        overruns = host.tally.overruns - overruns
    median, high = np.percentile(np.concatenate(work), (50, 99)) / 1e3
    found = {
        "ready_s": ready_s,
        "work_us": (float(median), float(high)),
        "processor": share,
        "overruns": overruns,
        "package": str(Path(vbraille.__file__ or "").parent),
    }
    print(json.dumps(found), flush=True)


if __name__ == "__main__":
    main(sys.argv[1], float(sys.argv[2]))
