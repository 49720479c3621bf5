"""A host process that is stopped for a moment, with a hand that goes on: no actuator jumps."""

import math
import os
import select
import signal
import time

import numpy as np
import pytest

from tests.devices.pagecontroller import Cable, Make, PageController
from tests.tiers import heavy
from tests.wired import CATCH_UP, DOT_MM, FADE_S, INFO, TOP, waves
from vbraille.devices.serial.wire import RAMP_MS
from vbraille.engine.host import Host

PATIENCE_S = 60.0
SPEED_MM_S = 250.0
# In a period: three times what hand and fade ask for, and the ramp, if a stop takes too long.
ALLOWED = TOP * (CATCH_UP * (SPEED_MM_S * math.pi / DOT_MM + 1 / FADE_S) / 1000 + 1 / RAMP_MS) + 2


class Logged(PageController):
    """A controller that keeps its levels, tick by tick."""

    def __init__(self):
        super().__init__(make=Make(rows=1, columns=3, top_level=TOP, travel_um=10_000_000))
        self.log = []

    def tick(self, now_us, _way_mm, y_mm=0.0, theta=0.0):
        # By its own ticks, so that a thread that is held up makes no hand faster.
        said = super().tick(now_us, len(self.log) * SPEED_MM_S / 1000 % 500, y_mm, theta)
        self.log.append(self.levels)
        return said


@pytest.mark.no_cover
@heavy
def test_no_actuator_jumps_when_the_host_was_stopped():
    device = Logged()

    def until(enough):
        end_s = time.monotonic() + PATIENCE_S
        while not enough():
            assert time.monotonic() < end_s
            host.poll()
            select.select([], [], [], 0.002)

    with (
        Cable(device, lambda _s: (0.0, 0.0, 0.0)) as cable,
        Host(f"serial:{cable.path}", INFO, 100_000) as host,
    ):
        host.show(waves(1.0).render(np.full(30, 0b001001, np.uint8), host.display), 1)
        until(lambda: len(device.taken) > 500)
        for stop_ms in (11, 17, 23, 29, 33) * 3:
            os.kill(host.process_id, signal.SIGSTOP)
            select.select([], [], [], stop_ms / 1000)
            os.kill(host.process_id, signal.SIGCONT)
            taken = len(device.taken)
            until(lambda taken=taken: len(device.taken) > taken + 150)
        felt = np.array(device.log)
    assert np.ptp(felt, axis=0).min() > 0.3 * TOP  # on a busy machine it may rest in between
    assert np.abs(np.diff(felt, axis=0)).max() <= ALLOWED
