"""The page, the device and the host with which the loop of 2026-11-21 is measured.

It is written for the package in `loop-of-2026-11-21.zip`, and imported where that comes first on
the path: in the controller, whichever host is measured, and in the program around the old host.
"""

from __future__ import annotations

import time
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from vbraille.render.renderer import Renderer

from tests.benchmarks.tick_host import Opened
from vbraille.devices import DeviceInfo
from vbraille.engine.host import Host
from vbraille.render import STRESS2, Tuning

if TYPE_CHECKING:
    from collections.abc import Iterator

RATE_HZ = 1000.0
# Dots so wide that the level of the first actuator tells for which place a frame was made.
GEOMETRY = replace(STRESS2.geometry, dot_width_mm=20.0, dot_spacing_mm=25.0, cell_gap_mm=25.0)
CELLS = 26
INFO = DeviceInfo(
    name="independent controller",
    rows=STRESS2.array.rows,
    columns=STRESS2.array.columns,
    column_pitch_mm=STRESS2.array.column_pitch_mm,
    row_pitch_mm=STRESS2.array.row_pitch_mm,
    levels=65_536,
    rest_side=STRESS2.rest_side,
    travel_mm=GEOMETRY.travel_mm,
    counts_per_mm=200.0,
    rate_hz=RATE_HZ,
)


def page() -> Renderer:
    """A line whose dots are all raised, without a texture."""
    return Renderer(
        np.full(CELLS, 0x3F, np.uint8),
        array=STRESS2.array,
        profile=STRESS2.profile,
        mapping=STRESS2.mapping,
        geometry=GEOMETRY,
        tuning=Tuning(texture=0.0),
    )


@contextmanager
def opened(spec: str) -> Iterator[Opened]:
    """Have the host of the old package drive a device, with the page under the hand."""
    begun_s = time.monotonic()
    with Host(spec, INFO, CELLS) as host:
        ready_s = time.monotonic() - begun_s
        host.show(page(), 1, 20.0)
        assert host.process_id is not None
        yield Opened(
            ready_s, host.process_id, lambda: host.poll()["work_ns"], lambda: host.tally.overruns
        )
