"""Serial devices on real pseudo-terminals, with the simulated controller as the peer."""

import array
import fcntl
import os
import termios
import threading
import tty
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

from tests.devices.bench import AWAY, HALF, HOME_MM, Bench, shown
from tests.engine.test_loop import info
from vbraille.devices.events import told
from vbraille.devices.serial.device import open_serial
from vbraille.devices.serial.wire import Frame, Hello, Rest
from vbraille.display import Pose
from vbraille.engine.clock import RealClock
from vbraille.errors import DeviceError
from vbraille.simulation.firmware import Controller
from vbraille.testing.conformance import CHECKS, check_samples


class PtyBench(Bench):
    """A bench whose line is a pseudo-terminal at a link."""

    def __init__(self, link: Path) -> None:
        self.link = link
        self.master = self.slave = -1
        super().__init__()

    def plug(self) -> None:
        super().plug()
        self.master, self.slave = os.openpty()
        tty.setraw(self.slave)
        os.set_blocking(self.master, False)
        self.link.unlink(missing_ok=True)
        self.link.symlink_to(os.ttyname(self.slave))

    def unplug(self) -> None:
        super().unplug()
        self.link.unlink()
        os.close(self.master)
        os.close(self.slave)

    def receive(self) -> bytes:
        chunks = []
        with suppress(BlockingIOError):
            while True:  # a pseudo-terminal gives some of what there is at a time
                chunks.append(os.read(self.master, 65536))
        return b"".join(chunks)

    def put(self, chunk: bytes) -> None:
        if not chunk:
            return
        there = min(self._waiting() + len(chunk), 4000)
        try:
            os.write(self.master, chunk)
        except BlockingIOError:  # the line is full of what the host has not read
            return
        while self._waiting() < there:  # the kernel carries it over in its own time
            os.sched_yield()

    def _waiting(self) -> int:
        """Bytes that the host may read now."""
        there = array.array("i", [0])
        fcntl.ioctl(self.slave, termios.FIONREAD, there)
        return there[0]

    def begin(self, wanted, *, pause=None, now_ns=None, options=""):
        return open_serial(
            f"{self.link}{options}",
            wanted,
            now_ns=now_ns or self.now_ns,
            pause=pause or self.pause,
            look_s=0.0005,
        )

    def find(self) -> None:
        """Wait for the finder to have found what is there."""
        for thread in threading.enumerate():
            if "finder" in thread.name:
                thread.join(10)


@pytest.fixture
def made(tmp_path):
    bench = PtyBench(tmp_path / "vb0")
    yield bench
    if bench.plugged:
        bench.unplug()


def open_descriptors() -> int:
    return len(list(Path("/proc/self/fd").iterdir()))


def test_a_conversation_from_the_handshake_to_the_end(made):
    os.write(made.slave, b"old")  # what another program left on the line
    with made.open() as device:
        assert made.controller.dropped == 1  # the zero ended what was old
        assert made.run(device, 50).x_mm == pytest.approx(5.0 + HOME_MM)
        assert made.controller.frames > 10
        assert made.kinds() == [Hello, Frame]
    made.pump()
    assert made.kinds()[-1] is Rest
    made.pause(0.03)
    assert made.controller.at_rest


def test_a_peer_that_does_not_read_stops_nobody_and_gets_nothing_late(made):
    device = made.open()
    made.settle(device)
    made.deaf = True
    made.run(device, 1000)
    lost = device.counts()["frames not sent"]
    assert lost > 50  # the line holds some 20 kB, and is emptied now and then
    felt = []
    take = made.controller.receive

    def receive(chunk, us):
        answers = take(chunk, us)
        felt.append(made.controller.levels.any())
        return answers

    made.controller.receive = receive
    made.deaf = False
    made.run(device, 1)
    assert felt == [False]  # what was left on the line is of rest
    made.run(device, 30)
    assert device.counts()["frames not sent"] == lost
    assert made.controller.dropped <= 1  # the frame sent in part was ended
    device.close()


def test_nobody_is_left_behind_when_it_goes_away_in_the_handshake(made):
    made.deaf = True
    before = open_descriptors() - 2  # without the peer's

    def pause(_seconds):
        made.us += 5000
        if made.plugged:
            made.unplug()

    with pytest.raises(DeviceError, match=r"vb0 went away; plug the device in"):
        made.begin(info(), pause=pause)
    assert open_descriptors() == before


class DriversClock(RealClock):
    """The machine's clock, which stands still while the bench of a driver works."""

    def __init__(self) -> None:
        self._others_ns = self._others_busy_ns = 0

    def now_ns(self) -> int:
        return super().now_ns() - self._others_ns

    def busy_ns(self) -> int:
        return super().busy_ns() - self._others_busy_ns

    def sleep_until_ns(self, deadline_ns: int) -> None:
        super().sleep_until_ns(deadline_ns + self._others_ns)

    @contextmanager
    def stopped(self) -> Iterator[None]:
        now_ns, busy_ns = super().now_ns(), super().busy_ns()
        yield
        self._others_ns += super().now_ns() - now_ns
        self._others_busy_ns += super().busy_ns() - busy_ns


@pytest.mark.real_time
@pytest.mark.no_cover  # it times the driver, which coverage makes ten times as slow
@pytest.mark.parametrize("check", CHECKS)
def test_it_conforms(made, check):
    samples = []
    # The controller works while the driver asks for the time, and waits for the kernel to carry
    # bytes over, which may take a busy machine a tenth of a second: that is not the driver's time.
    clock = DriversClock()
    made.controller = Controller(shown(rate_hz=200))

    def now_ns() -> int:  # asking for the time lets it go on
        with clock.stopped():
            made.pause(0.001)
        return made.now_ns()

    def opened():
        device = made.begin(info(rate_hz=200.0), now_ns=now_ns)
        samples.append(device.read())
        return device

    check(opened, *[clock] * (check is check_samples))
    assert isinstance(samples[0], Pose)


@pytest.mark.no_cover
def test_unplugged_and_plugged_in_a_hundred_times(made):
    device = made.open()
    made.run(device, 5)
    before = open_descriptors()
    for time in range(1, 101):
        made.unplug()
        device.write(HALF)
        assert device.read() is None
        assert told(device.take_events()) == [AWAY]
        made.run(device, 3)
        assert told(device.take_events()) == []
        made.us += 1_000_000  # so that each notice is said at once
        made.controller = Controller(shown())
        made.plug()
        made.way_mm = time
        assert made.back(device).x_mm == pytest.approx(time + HOME_MM)
        assert told(device.take_events()) == ["device: back"]
        assert device.rested == device.counts()["reconnections"] == time
    assert open_descriptors() == before
    assert device.counts()["frames not sent"] == 0
    made.settle(device)
    assert made.controller.frames > 0
    device.close()


def test_a_message_cut_by_the_loss_spoils_none_after_it(made):
    device = made.open()
    made.run(device, 5)
    made.say(b"\x20begun")
    device.read()
    made.unplug()
    made.run(device, 1)
    made.controller = Controller(shown())
    made.plug()
    made.back(device)
    assert made.controller.greetings == 1
    device.close()


def test_closing_while_it_is_unplugged_leaves_nothing(made):
    before = open_descriptors() - 2  # without the peer's
    device = made.open()
    made.run(device, 5)
    made.unplug()
    made.run(device, 2)
    device.close()
    assert open_descriptors() == before
    with pytest.raises(DeviceError, match="closed"):
        device.write(HALF)
