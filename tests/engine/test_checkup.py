"""The checkup: right devices are fit, and what is wrong is said of the right one."""

import pytest

from tests.engine.wire import wired
from vbraille.devices.base import Device
from vbraille.devices.events import Placing
from vbraille.display import Display, Pose
from vbraille.engine.checkup import Checkup, Watch
from vbraille.engine.clock import ManualClock

SMALL = Display("small", 1, 2, 1.0, 1.0, levels=256, travel_mm=100.0)


def done(device, clock, say=lambda _: None, rate_s=0.2):
    checkup = Checkup(device, clock, say)
    assert checkup.run(rate_s) == checkup.to_json()["fit"] == (not checkup.wrong)
    return checkup


def checked(monkeypatch, **how):
    device, clock, _ = wired(monkeypatch, SMALL, **how)
    said = []
    return done(device, clock, said.append, 0.5), said


def test_a_right_device_is_fit(monkeypatch):
    found, said = checked(monkeypatch)
    assert not found.wrong, found.wrong
    assert said[-1] == "verdict: fit to be read on"
    assert len(found.values["trips_ms"]) == 3


@pytest.mark.parametrize("hold_ms", [8, 16])
def test_a_line_that_holds_bytes_back_is_blamed_and_not_the_device(monkeypatch, hold_ms):
    found, _ = checked(monkeypatch, hold_ms=hold_ms)
    assert found.wrong
    (wrong,) = found.wrong
    assert f"{hold_ms} ms" in wrong
    assert "latency_timer" in wrong


@pytest.mark.parametrize(
    ("changed", "named"),
    [
        ({"watchdog_ms": None}, "watchdog"),
        ({"watchdog_ms": 200}, "watchdog"),
        ({"acknowledges": False}, "acknowledges"),
    ],
)
def test_what_is_built_wrong_is_named(monkeypatch, changed, named):
    found, said = checked(monkeypatch, **changed)
    assert named in "; ".join(found.wrong)
    assert said[-1].startswith("verdict: not fit")


class Driver(Device):
    """A driver that another package might have."""

    def __init__(self, clock, **wrong):
        self.display = SMALL
        self.clock = clock
        vars(self).update(wrong)

    def read(self):
        return Pose(self.clock.now_ns(), 0.0)

    def _send(self, _frame):
        return None

    def _release(self):
        pass


def test_a_driver_that_gives_places_while_it_waits_for_one_is_told_of():
    clock = ManualClock()
    found = done(Driver(clock, placing=Placing.STOP), clock)
    assert any("waits to be shown" in wrong for wrong in found.wrong)


def test_a_driver_that_leaves_a_message_cut_is_told_of():
    import socket

    here, there = socket.socketpair()

    class Cutting(Driver):
        sent = 0

        def _send(self, _frame):
            self.sent += 1
            here.send(bytes([self.sent % 256]) * 20)
            there.recv(4096)

    with here, there:
        clock = ManualClock()
        found = done(Cutting(clock), clock)
        assert any("does not finish a message" in wrong for wrong in found.wrong)


@pytest.mark.parametrize(("device_ms", "jumps"), [(28, False), (1, True)])
def test_poses_that_the_line_held_back_are_no_jump(device_ms, jumps):
    clock = ManualClock()
    device = Driver(clock)
    watch = Watch(device, clock)
    for pose in (Pose(0, 0.0), Pose(device_ms * 1_000_000, 7.0)):
        device.read = lambda pose=pose: pose
        watch.read()
        clock.advance_ns(1_300_000)
    assert any("jumps" in fault for fault in watch.faults()) == jumps
