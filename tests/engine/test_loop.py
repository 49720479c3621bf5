"""The loop: nothing jumps, whatever is late; and a pose that is there begins a tick at once."""

import os

import numpy as np
import pytest

from tests.engine.wire import wired
from vbraille.devices.base import Device
from vbraille.devices.calibration import Calibration
from vbraille.display import Pose
from vbraille.engine.clock import ManualClock
from vbraille.engine.loop import LocalEngine
from vbraille.engine.record import Flag
from vbraille.errors import DeviceError
from vbraille.render import MODELS
from vbraille.simulation.motion import Way
from vbraille.simulation.simulated import SimulatedDevice

MODEL = MODELS["stress2"]
MS = 1_000_000


def moving(mm_s=70.0):
    """An engine on whose device a hand moves over many dots."""
    clock = ManualClock()
    device = SimulatedDevice(MODEL.display, clock.now_ns)
    way = Way(-MODEL.display.span_mm)
    way.move(280.0, mm_s)
    device.move(way.motion())
    engine = LocalEngine(device, clock, poll_ticks=1)
    picture = MODEL.style.render(np.full(26, 63, np.uint8), MODEL.display)
    engine.show(picture, 1)
    for _ in range(300):
        engine.poll()
    return engine, clock, picture


@pytest.mark.parametrize("gap_ms", [5, 6, 10, 20, 50, 100, 200])
def test_a_gap_under_a_moving_hand_is_faded_in(gap_ms):
    engine, clock, picture = moving()
    before = engine.poll()[-1]
    clock.advance_ns(gap_ms * MS)
    most = 0.0
    for tick in range(120):
        now = engine.poll()[-1]
        wanted = picture.path(np.array([before["x_mm"], now["x_mm"]]))
        asked = np.abs(wanted[1] - wanted[0]).max() if tick else 0.0
        most = max(most, float(np.abs(now["frame"] - before["frame"]).max()) - asked)
        before = now
    assert most <= 0.3
    assert np.abs(before["frame"] - picture.path(np.array([before["x_mm"]]))[0]).max() < 1e-6


def test_a_frame_that_was_not_sent_is_not_taken_for_one_that_was():
    engine, _, _ = moving()
    stood = engine.output.copy()
    engine.device._send = lambda _: False
    for _ in range(20):
        engine.poll()
    assert (engine.output == stood).all()
    del engine.device._send
    engine.poll()
    assert np.abs(engine.output - stood).max() < 0.1


class Piped(Device):
    """A device whose poses come through a descriptor, when a test writes a byte."""

    def __init__(self, clock):
        self.display, self.clock = MODEL.display, clock
        self.descriptor, self.end = os.pipe()
        os.set_blocking(self.descriptor, False)

    def read(self):
        try:
            os.read(self.descriptor, 1)
        except BlockingIOError:
            return None
        return Pose(self.clock.now_ns(), 0.0)

    def _send(self, _frame):
        return None

    def _release(self):
        os.close(self.descriptor)
        os.close(self.end)


def test_a_pose_that_is_there_is_answered_at_once_and_a_missing_one_waited_for():
    clock = ManualClock()
    with Piped(clock) as device:
        engine = LocalEngine(device, clock)
        os.write(device.end, b"1")
        engine.poll()
        times = []
        for early_ns in (250_000, 600_000, 990_000):
            clock.sleep_until_ns(clock.now_ns() + early_ns)
            os.write(device.end, b"1")
            came_ns = clock.now_ns()
            tick = engine.poll()[-1]
            times.append(int(tick["time_ns"]) - came_ns)
            assert not np.isnan(tick["x_mm"])
        assert times == [0, 0, 0]
        before_ns = clock.now_ns()
        engine.poll()  # none comes
        assert clock.now_ns() - before_ns == 1_250_000


def test_a_device_that_rested_is_faded_in_from_rest_and_unfelt_until_then(monkeypatch):
    device, clock, wire = wired(monkeypatch, MODEL.display, mm_s=20.0)
    engine = LocalEngine(device, clock)
    engine.show(MODEL.style.render(np.full(20, 63, np.uint8), MODEL.display), 1)
    steps, before, flags = [], wire.controller.level.copy(), 0
    for tick in range(1200):
        if tick == 500:
            clock.advance_ns(120 * MS)  # this computer stood still
            wire.read()
            before = wire.controller.level.copy()
        flags |= int(engine.poll()[-1]["flags"]) * (500 <= tick < 600)
        steps.append(int(np.abs(wire.controller.level - before).max()))
        before = wire.controller.level.copy()
    assert wire.controller.trips == 1
    assert flags & int(Flag.HELD)
    assert flags & int(Flag.UNFELT)
    assert max(steps) <= 300
    assert wire.controller.level.max() > 900


def test_an_inverted_actuator_sets_out_from_rest_and_goes_back(monkeypatch):
    device, clock, wire = wired(monkeypatch, MODEL.display)
    gains = np.ones(MODEL.display.shape)
    gains[0, 0], gains[1, 1] = -0.5, 0.0
    device.calibrate(Calibration("it", gains.tolist()))
    engine = LocalEngine(device, clock)
    levels = []
    for _ in range(400):
        engine.poll()
        levels.append(int(wire.controller.level[0]))
    assert levels[-1] == 1023
    assert np.abs(np.diff(levels)).max() < 60
    engine.close()
    engine.device.read()
    assert abs(int(wire.controller.goal[0])) < 60


@pytest.mark.parametrize("pose", [(np.nan, 0.0, 0.0), (1e9, 0.0, 0.0), (0.0, 0.0, 1.0)])
def test_a_place_that_cannot_be_ends_the_loop_by_a_sentence(pose):
    engine, _, _ = moving()
    engine.device.read = lambda: Pose(1, *pose)
    with pytest.raises(DeviceError, match="where it cannot be"):
        engine.poll()


def test_a_bad_frame_is_never_sent():
    engine, _, _ = moving()
    sent = engine.device.frames
    for bad in (np.nan, 1.01, -0.01):
        frame = np.zeros(MODEL.display.shape)
        frame[2, 3] = bad
        with pytest.raises(DeviceError):
            engine.device.write(frame)
    assert engine.device.frames == sent
