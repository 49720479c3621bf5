"""The page and the host of today, with which the loop of 2026-11-21 is compared."""

from __future__ import annotations

import time
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tests.benchmarks.tick_host import Opened
from vbraille.engine.host import Host
from vbraille.render import STRESS2, Tuning

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.render.program import Program

# As in `tick_baseline`: the controller tells by the first actuator for which place a frame is.
STYLE = replace(
    STRESS2.style,
    geometry=replace(
        STRESS2.style.geometry, dot_width_mm=20.0, dot_spacing_mm=25.0, cell_gap_mm=25.0
    ),
    tuning=Tuning(texture=0.0),
)
CELLS = 26
DISPLAY = replace(STRESS2.display, levels=65_536)


def page() -> Program:
    """A line whose dots are all raised, without a texture."""
    return STYLE.render(np.full(CELLS, 0x3F, np.uint8), DISPLAY)


@contextmanager
def opened(spec: str) -> Iterator[Opened]:
    """Have today's host drive a device, with the page under the hand."""
    begun_s = time.monotonic()
    with Host(spec, DISPLAY, STYLE.room(DISPLAY, CELLS)) as host:
        ready_s = time.monotonic() - begun_s
        host.show(page(), 1)
        assert host.process_id is not None
        yield Opened(
            ready_s, host.process_id, lambda: host.poll()["work_ns"], lambda: host.tally.overruns
        )
