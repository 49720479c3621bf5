"""Serial devices on real pseudo-terminals, with the simulated controller as the peer."""

import array
import fcntl
import os
import re
import termios
import threading
import tty
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from cobs import cobs

from tests.controllers import ControllerOf20261121
from tests.engine.test_loop import info
from vbraille.devices.base import Placing
from vbraille.devices.conformance import CHECKS
from vbraille.devices.messages import (
    CountSign,
    Encoder,
    Error,
    Frame,
    Hello,
    Rest,
    State,
    Watchdog,
)
from vbraille.devices.openserial import open_serial
from vbraille.devices.wire import Decoder, Levels, encode, enframe
from vbraille.errors import DeviceError, InputError
from vbraille.pose import Pose
from vbraille.simulation.firmware import Controller, describe
from vbraille.simulation.simulator import split

SPAN_MM = 10.8
HOME_MM = -SPAN_MM / 2  # of the array's centre at the left stop
HALF = np.full((6, 10), 0.5)
REST = np.zeros((6, 10))
NO_FRAME = "device: no frame reached it in time, so it went to rest; reading goes on"
AWAY = "device: unplugged; plug it in again and reading goes on"


def shown(encoder=Encoder.ABSOLUTE, **changes):
    return replace(describe(info(), encoder), **changes)


class Bench:
    """A controller behind a pseudo-terminal at a link, on a clock that turns when a host waits."""

    def __init__(self, link: Path, made_as=Controller, **changes) -> None:
        self.link = link
        self.us = 0
        self.way_mm = 5.0
        self.wire = Decoder()
        self.sent = []  # what came from the host
        self.deaf = self.mute = False
        self.master = self.slave = -1
        self.controller = made_as(shown(**changes))
        self.plug()

    def plug(self) -> None:
        self.master, self.slave = os.openpty()
        tty.setraw(self.slave)
        os.set_blocking(self.master, False)
        self.link.unlink(missing_ok=True)
        self.link.symlink_to(os.ttyname(self.slave))

    def unplug(self) -> None:
        self.link.unlink()
        os.close(self.master)
        os.close(self.slave)
        self.master = -1

    def now_ns(self) -> int:
        return self.us * 1000

    def pause(self, seconds: float) -> None:
        for _ in range(max(1, round(seconds * 1000))):
            self.us += 1000
            if self.master >= 0:
                self.pump()

    def pump(self) -> None:
        self.hear()
        self.say(self.controller.tick(self.us, self.way_mm))

    def hear(self) -> None:
        if not self.deaf:
            chunk = self.receive()
            self.sent += self.wire.feed(chunk)
            self.say(self.controller.receive(chunk, self.us))

    def receive(self) -> bytes:
        chunks = []
        with suppress(BlockingIOError):
            while True:  # a pseudo-terminal gives some of what there is at a time
                chunks.append(os.read(self.master, 65536))
        return b"".join(chunks)

    def say(self, chunk: bytes) -> None:
        if self.mute or not chunk:
            return
        there = min(self.waiting() + len(chunk), 4000)
        try:
            os.write(self.master, chunk)
        except BlockingIOError:  # the line is full of what the host has not read
            return
        while self.waiting() < there:  # the kernel carries it over in its own time
            os.sched_yield()

    def waiting(self) -> int:
        """Bytes that the host may read now."""
        there = array.array("i", [0])
        fcntl.ioctl(self.slave, termios.FIONREAD, there)
        return there[0]

    def open(self, options="", wanted=None, **changes):
        return open_serial(
            f"{self.link}{options}",
            wanted or info(**changes),
            now_ns=self.now_ns,
            pause=self.pause,
            look_s=0.0005,
        )

    def run(self, device, ticks: int, frame=HALF) -> Pose | None:
        """Tick as the loop does; the last sample."""
        last = None
        for _ in range(ticks):
            self.pause(0.001)
            last = device.read() or last
            device.write(frame)
        return last

    def begin(self, device, frame=HALF) -> None:
        """Tick until frames are taken, and then some: a conversation begins at rest."""
        for _ in range(100):
            self.run(device, 1, frame)
            if device.taking:
                break
        assert device.taking
        self.run(device, 3, frame)

    def back(self, device) -> Pose:
        """Let whoever looks for it find it; the first sample."""
        self.find()
        for _ in range(300):
            if sample := self.run(device, 1):
                return sample
        raise AssertionError("the device does not come back")

    def find(self) -> None:
        """Wait for the finder to have found what is there."""
        for thread in threading.enumerate():
            if "finder" in thread.name:
                thread.join(10)

    def kinds(self) -> list:
        """Types of what the host has sent since the last call, each run of one as one."""
        kinds, self.sent = [type(event) for event in self.sent], []
        return [kind for i, kind in enumerate(kinds) if not i or kinds[i - 1] is not kind]


@pytest.fixture
def bench(tmp_path):
    benches = []

    def make(**changes) -> Bench:
        benches.append(Bench(tmp_path / "vb0", **changes))
        return benches[-1]

    yield make
    for made in benches:
        if made.master >= 0:
            made.unplug()


@pytest.mark.parametrize("check", CHECKS)
def test_it_conforms(bench, check):
    made = bench()
    samples = []

    def now_ns() -> int:  # whoever asks the time lets it go on
        made.pause(0.001)
        return made.now_ns()

    def opened():
        device = open_serial(str(made.link), info(), now_ns=now_ns, pause=made.pause)
        samples.append(device.read())
        return device

    check(opened)
    assert isinstance(samples[0], Pose)


def test_the_handshake(bench):
    made = bench()
    os.write(made.slave, b"old")  # what another program left on the line
    heard = []

    def pause(seconds):
        if not heard:
            heard.append(os.write(made.master, b"\x07of an earlier conversation"))
        made.pause(seconds)

    with open_serial(str(made.link), info(), now_ns=made.now_ns, pause=pause) as device:
        assert made.controller.dropped == 1  # the zero ended what was old
        assert made.controller.greetings == 2  # the first INFO came behind what was old
        assert device.display == info()
        assert device.placing is Placing.DONE
        assert made.run(device, 50).x_mm == pytest.approx(HOME_MM + 5.0)
        assert made.controller.frames > 10
        assert made.kinds() == [Hello, Frame]
        assert sum(device.counts().values()) == 1
    made.pump()
    assert made.kinds()[-1] is Rest
    made.pause(0.03)
    assert made.controller.at_rest


def test_hello_is_said_every_250_ms_to_a_device_that_starts_slowly(bench):
    made = bench()
    made.deaf = True

    def pause(seconds):
        made.deaf = made.us < 1_100_000
        made.pause(seconds)

    device = open_serial(str(made.link), info(), now_ns=made.now_ns, pause=pause)
    assert made.sent == [Hello()] * 5
    # It answers all that waited: one INFO is a conversation, and the others are not.
    made.run(device, 20)
    assert device.rested == 0
    assert device.counts()["reconnections"] == 0
    device.close()


def open_descriptors() -> int:
    return len(list(Path("/proc/self/fd").iterdir()))


def test_nothing_answers(bench):
    made = bench()
    made.mute = True
    before = open_descriptors()
    with pytest.raises(DeviceError, match=r"nothing answers at .*vb0; see that the device is on"):
        made.open()
    assert 3_000_000 <= made.us <= 3_100_000
    assert made.sent == [Hello()] * 12
    assert open_descriptors() == before


def test_it_answers_nonsense(bench):
    made = bench()
    made.deaf = True

    def pause(seconds):
        made.pause(seconds)
        made.receive()
        os.write(made.master, bytes(range(1, 9)) + b"\0")

    with pytest.raises(DeviceError, match=r"no vbraille device, or not set to 115200 baud"):
        open_serial(f"{made.link}?baud=115200", info(), now_ns=made.now_ns, pause=pause)


def test_it_sends_but_does_not_hear(bench):
    made = bench()
    made.controller.greeted = made.deaf = True
    with pytest.raises(DeviceError, match=r"sends, but does not answer; .*check its cable"):
        made.open()


def test_it_speaks_another_version(bench):
    made = bench()
    made.deaf = True

    def pause(seconds):
        made.pause(seconds)
        os.write(made.master, enframe(b"\x81\x07whatever"))

    with pytest.raises(DeviceError, match=r"speaks version 7 .* this vbraille version 1; update"):
        open_serial(str(made.link), info(), now_ns=made.now_ns, pause=pause)


def test_it_goes_away_in_the_handshake(bench):
    made = bench()
    made.deaf = True
    before = open_descriptors() - 2  # without the peer's

    def pause(_seconds):
        made.us += 5000
        if made.master >= 0:
            made.unplug()

    with pytest.raises(DeviceError, match=r"vb0 went away; plug the device in"):
        open_serial(str(made.link), info(), now_ns=made.now_ns, pause=pause)
    assert open_descriptors() == before


def test_a_signal_passes_through_the_handshake(bench):
    made = bench()
    before = open_descriptors()

    def interrupted(_seconds):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        open_serial(str(made.link), info(), now_ns=made.now_ns, pause=interrupted)
    assert open_descriptors() == before


def test_a_line_too_slow_for_the_frames(bench):
    made = bench()
    with pytest.raises(
        InputError,
        match=r"115200 baud carry 137 frames a second .* 1000 are asked for; "
        r"choose --rate 137 or less, or set the device and \?baud= to 921600",
    ):
        made.open("?baud=115200")
    made.open("?baud=115200", rate_hz=137.0).close()
    open_serial(f"{made.link}?baud=300", None, now_ns=made.now_ns, pause=made.pause).close()
    # A pseudo-terminal has no baud rate unless one is given.
    made.open(rate_hz=2000.0).close()


@pytest.mark.parametrize("sign", CountSign)
@pytest.mark.parametrize("encoder", Encoder)
def test_places_by_every_encoder(bench, encoder, sign):
    # Eight bits more than the travel takes, and a stop near the wrap: it wraps at once.
    made = bench(encoder=encoder, count_sign=sign, count_bits=17, left_stop_count=130_000)
    device = made.open()
    waiting = {Encoder.ABSOLUTE: Placing.DONE, Encoder.INDEX: Placing.MARK}
    assert device.placing is waiting.get(encoder, Placing.STOP)
    if encoder is not Encoder.ABSOLUTE:
        assert made.run(device, 20) is None
        assert made.controller.frames == 0
        if encoder is Encoder.INDEX:
            device.set_zero()  # of no meaning
            assert made.run(device, 5) is None
            made.way_mm = 15.0
        else:
            made.way_mm = 0.0
            made.run(device, 5)
            device.set_zero()
        made.run(device, 5)
    assert device.placing is Placing.DONE
    made.begin(device)
    for way_mm in (0.0, 0.005, 150.0, 300.0, 280.0, 60.0, 0.0):
        made.way_mm = way_mm
        assert made.run(device, 3).x_mm == pytest.approx(HOME_MM + way_mm)
    assert made.controller.frames > 10
    assert device.rested == 0
    device.close()


def test_a_count_of_eight_bits_goes_round_and_round(bench):
    made = bench(encoder=Encoder.INCREMENTAL, count_bits=8)
    made.way_mm = 0.0
    device = made.open()
    made.run(device, 3)
    device.set_zero()
    for way_mm in np.arange(0.0, 20.0, 0.5):
        made.way_mm = way_mm
        assert made.run(device, 2).x_mm == pytest.approx(HOME_MM + way_mm)
    device.close()


def test_an_index_that_is_lost_is_looked_for_again(bench):
    made = bench(encoder=Encoder.INDEX)
    device = made.open()
    made.run(device, 2)
    made.way_mm = 15.0
    assert made.run(device, 5) is not None
    made.controller.placed = False
    made.run(device, 1)
    assert device.placing is Placing.MARK
    device.close()


def test_time_goes_on_over_its_wrap(bench):
    made = bench()
    made.us = 2**32 - 10_000
    device = made.open()
    times = [made.run(device, 1).time_ns for _ in range(30)]
    assert np.diff(times).tolist() == [1_000_000] * 29
    device.close()


def test_the_newest_of_several_states_wins_and_gaps_are_counted(bench):
    made = bench()
    device = made.open()
    made.run(device, 5)
    for way_mm in (6.0, 7.0, 8.0):
        made.way_mm = way_mm
        made.pause(0.001)
    assert device.read().x_mm == pytest.approx(HOME_MM + 8.0)
    assert device.read() is None
    made.mute = True
    made.pause(0.007)
    made.mute = False
    made.run(device, 3)
    assert device.counts()["states missed"] == 7
    assert device.rested == 0
    device.close()


def test_silence_of_100_ms_brings_rest_and_less_than_500_ms_goes_on(bench):
    made = bench(encoder=Encoder.INCREMENTAL)
    device = made.open()
    made.run(device, 5)
    device.set_zero()
    made.begin(device)
    made.mute = True
    made.kinds()
    made.run(device, 99)
    assert made.kinds() == [Frame]
    assert device.take_notes() == []
    made.run(device, 20)
    assert made.kinds() == [Frame, Rest]
    assert device.take_notes() == [
        "device: silent, and sent to rest; reading goes on once it speaks"
    ]
    assert device.rested == 0
    made.run(device, 300)
    assert made.kinds() == []
    assert made.controller.at_rest
    made.mute = False
    made.way_mm = 8.0
    # The encoder has kept count, and needs no zero again.
    assert made.run(device, 50).x_mm == pytest.approx(HOME_MM + 3.0)
    assert made.kinds() == [Frame]
    assert device.rested == 1
    assert device.take_notes() == ["device: back"]
    assert device.placing is Placing.DONE
    assert device.counts()["frames not sent"] == 0
    assert device.counts()["reconnections"] == 0
    assert device.counts()["watchdog trips"] == 0
    device.close()


def test_silence_of_500_ms_begins_a_new_conversation(bench):
    made = bench(encoder=Encoder.INCREMENTAL)
    device = made.open()
    made.run(device, 5)
    device.set_zero()
    made.begin(device)
    made.controller = Controller(shown(Encoder.INCREMENTAL))  # it restarts, and waits for HELLO
    made.kinds()
    made.run(device, 480)
    assert made.kinds() == [Frame, Rest]
    assert made.controller.greetings == 0
    made.mute = True
    made.run(device, 1000)
    assert made.sent == [Hello()] * 4
    made.mute = False
    made.run(device, 300)
    assert device.placing is Placing.STOP
    assert device.rested == 1
    notes = device.take_notes()
    assert [note[:14] for note in notes] == ["device: silent", "device: back"]
    assert device.counts()["reconnections"] == 1
    device.set_zero()
    assert made.run(device, 5).x_mm == pytest.approx(HOME_MM)
    device.close()


def test_a_peer_that_does_not_read_stops_nobody_and_gets_nothing_late(bench):
    made = bench()
    device = made.open()
    made.begin(device)
    made.deaf = True
    made.run(device, 1000)
    lost = device.counts()["frames not sent"]
    assert lost > 50  # the line holds some 20 kB, and is emptied now and then
    assert not device.taking
    felt = []
    take, made.controller.receive = made.controller.receive, None

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
    # The watchdog tripped meanwhile, and it is said; all fades in once frames arrive.
    assert device.counts()["watchdog trips"] == 1
    assert device.take_notes() == [NO_FRAME]
    assert device.taking
    assert device.rested == 1
    device.close()


OLD_AND_NEW = pytest.mark.parametrize("made_as", [Controller, ControllerOf20261121])


@OLD_AND_NEW
@pytest.mark.parametrize("stall_ms", [41, 49, 50.5, 55, 60, 69, 75, 150, 2000])
def test_a_host_that_was_stopped_lets_the_ramp_end_and_begins_from_rest(bench, made_as, stall_ms):
    made = bench(made_as=made_as)
    device = made.open()
    for time in range(1, 3):
        made.begin(device)
        made.kinds()
        assert (made.controller.levels == 512).all()
        levels = [made.controller.levels[0]]
        for _ in range(round(stall_ms)):  # nobody asks for the time
            made.pause(0.001)
            levels.append(made.controller.levels[0])
        made.us += round(stall_ms % 1 * 1000)
        made.run(device, 1)
        assert not device.taking
        while not device.taking:
            levels.append(made.controller.levels[0])
            made.run(device, 1, REST)
        assert not made.controller.levels.any()
        assert np.abs(np.diff(np.array(levels, int))).max() <= 512 / 20 + 1
        assert device.rested == time
        # The second comes within a second of the first, and is said later with its count.
        assert device.take_notes() == ([NO_FRAME] if time == 1 or stall_ms > 1000 else [])
    assert device.counts()["watchdog trips"] == 2  # its own, and not the host's REST
    assert Rest not in made.kinds()
    device.close()


@OLD_AND_NEW
def test_what_a_stopped_host_has_not_read_is_not_taken_for_the_place(bench, made_as):
    made = bench(made_as=made_as)
    device = made.open()
    made.begin(device)
    for way_mm in range(10, 90):  # 80 ms of states, and no WATCHDOG: the line was full
        made.way_mm = way_mm
        made.controller.tick(made.us, way_mm)
        made.us += 1000
        made.say(encode(State(way_mm, made.us, 0, device._sequence, 1, 0, None)))
    made.way_mm = 120.0
    made.run(device, 1)
    assert not device.taking
    while not device.taking:
        made.pause(0.001)
        sample = device.read()
        device.write(HALF)
    assert not any(made.controller.levels)
    assert sample.x_mm == pytest.approx(HOME_MM + 120.0)
    device.close()


def test_an_old_controller_that_a_late_frame_holds_is_told_to_rest(bench):
    made = bench(made_as=ControllerOf20261121)
    device = made.open()
    made.begin(device)
    made.deaf = True
    made.run(device, 53)  # it trips, and says so
    assert not device.taking
    made.deaf = False
    made.receive()  # what was on the way is lost
    made.kinds()
    full = Levels(60, 1023).pack(np.full(60, 1023))
    made.say(made.controller.receive(encode(Frame(9999, full)), made.us))  # but for an old one
    assert (made.controller.levels == 1023).all()
    made.run(device, 3)
    made.hear()
    assert made.kinds() == [Rest]
    made.run(device, 20)
    assert made.controller.at_rest
    made.begin(device)
    device.close()


def test_a_device_that_neither_rests_nor_trips_is_not_read_on(bench):
    made = bench()
    device = made.open()
    made.begin(device)
    made.controller._flags = lambda: 1  # never at rest, whatever comes
    made.pause(0.06)
    with pytest.raises(DeviceError, match="test does not go to rest, neither when it is told to"):
        made.run(device, 600)
    device.close()


@OLD_AND_NEW
def test_closing_ends_by_the_ramp_even_where_nothing_was_faded_out(bench, made_as):
    made = bench(made_as=made_as)
    device = made.open()
    made.begin(device)
    device.close()
    made.hear()
    assert (made.controller.levels == 512).all()
    made.pause(0.005)
    assert made.controller.levels[0] == pytest.approx(384, abs=30)
    made.pause(0.02)
    assert made.controller.at_rest


def test_a_trip_whose_report_is_lost_is_counted_by_the_states_and_once(bench):
    made = bench()
    device = made.open()
    made.begin(device)
    made.deaf = True
    say = made.say
    made.say = lambda chunk: say(b"".join(m for m in split(chunk) if len(m) > 20))  # STATE alone
    made.run(device, 60)
    assert device.counts()["watchdog trips"] == 1
    made.say = say
    made.deaf = False
    made.begin(device)
    assert device.counts()["watchdog trips"] == 1
    assert device.take_notes() == [NO_FRAME]
    device.close()


def test_frames_that_are_too_far_apart_for_the_watchdog_are_refused(bench):
    made = bench()
    with pytest.raises(InputError, match="30 a second are asked for; choose --rate 40 or more"):
        made.open(rate_hz=30.0)
    made.open(rate_hz=40.0).close()


def test_trips_before_the_first_report_are_of_no_concern(bench):
    made = bench()
    made.controller.trips = 5
    device = made.open()
    made.run(device, 20)
    assert device.counts()["watchdog trips"] == 0
    assert device.rested == 0
    device.close()


def test_an_error_ends_the_reading_and_a_notice_does_not(bench):
    made = bench()
    device = made.open()
    made.run(device, 5)
    made.say(made.controller.fault(255, "Clean the array."))
    made.say(encode(Error(254, "")))
    made.run(device, 3)
    assert device.take_notes() == ["device: Clean the array.", "device: notice 254"]
    made.say(made.controller.fault(3, "Too hot; let it cool."))
    with pytest.raises(DeviceError, match=r"^test: Too hot; let it cool\.$"):
        made.run(device, 1)
    device.close()
    assert not made.controller.levels.any() or made.controller.faulty


def test_a_fault_whose_error_was_lost_ends_the_reading(bench):
    made = bench()
    device = made.open()
    made.run(device, 5)
    made.controller.fault(1, "lost")
    with pytest.raises(DeviceError, match="test has a fault; switch it off and on"):
        made.run(device, 2)
    device.close()


def test_levels_are_those_of_the_formula(bench, rng):
    inverted, enabled = (rng.integers(0, 2, 60) for _ in range(2))
    gain = rng.integers(0, 256, 60)
    made = bench(
        top_level=150,
        inverted=bytes(inverted.tolist()),
        enabled=bytes(enabled.tolist()),
        gain=bytes(gain.tolist()),
    )
    device = made.open()
    made.begin(device)
    for frame in (np.ones((6, 10)), rng.random((6, 10)), np.full((6, 10), 1 / 3)):
        made.run(device, 3, frame)
        levels = np.rint(frame.reshape(-1) * gain / 255 * 150) * enabled
        levels = np.where(inverted, 150 - levels, levels)
        assert made.controller.levels.tolist() == levels.tolist()
    device.close()
    made.pause(0.03)
    assert made.controller.levels.tolist() == (150 * inverted).tolist()


def test_no_actuator_is_moved_faster_than_it_may(bench):
    made = bench(largest_slew_per_s=100)  # a tenth in a millisecond
    device = made.open()
    made.begin(device, REST)
    ways = []
    for target in (1.0, 0.0, 0.25):
        levels = []
        for _ in range(13):
            made.run(device, 1, np.full((6, 10), target))
            made.hear()
            levels.append(Levels(60, 1023).unpack(made.sent[-1].packed)[0] / 1023)
        ways.append(np.round(levels, 2).tolist())
    up = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.0, 1.0, 1.0]
    assert ways[0] == up
    assert ways[1] == [0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1, 0.0, 0.0, 0.0, 0.0]
    assert ways[2] == [0.1, 0.2, *[0.25] * 11]
    # Late, it goes no further, for it would go there at once.
    made.us += 30_000
    made.run(device, 1, np.ones((6, 10)))
    made.hear()
    assert Levels(60, 1023).unpack(made.sent[-1].packed)[0] == round(0.35 * 1023)
    # Two frames at one time are no way round it.
    device.write(np.ones((6, 10)))
    made.hear()
    assert Levels(60, 1023).unpack(made.sent[-1].packed)[0] == round(0.35 * 1023)
    device.close()


def test_the_way_back_from_rest_is_no_faster(bench):
    made = bench(largest_slew_per_s=100)
    device = made.open()
    made.begin(device, np.ones((6, 10)))
    made.run(device, 20, np.ones((6, 10)))
    made.mute = True
    made.run(device, 150, np.ones((6, 10)))
    made.mute = False
    made.sent.clear()
    made.begin(device, np.ones((6, 10)))
    made.hear()
    levels = [Levels(60, 1023).unpack(e.packed)[0] for e in made.sent if isinstance(e, Frame)]
    assert levels[0] == 0
    assert levels[-4:] == [102, 205, 307, 409]
    device.close()


def test_sequences_count_on_and_wrap(bench):
    made = bench(rows=1, columns=1, inverted=b"\0", gain=b"\xff", enabled=b"\1")
    device = made.open()
    frame = np.ones((1, 1))
    made.run(device, 10, frame)
    sequences = [event.sequence for event in made.sent if isinstance(event, Frame)]
    assert sequences == list(range(1, len(sequences) + 1))
    device._sequence = 65_530  # as if so many had been sent
    made.run(device, 20, frame)
    sequences = [event.sequence for event in made.sent if isinstance(event, Frame)]
    sequences = sequences[sequences.index(65_531) :]
    assert sequences[:8] == [65_531, 65_532, 65_533, 65_534, 65_535, 0, 1, 2]
    assert set(np.diff(sequences[5:])) == {1}
    device.close()


def test_a_frame_is_acknowledged_by_the_states(bench):
    made = bench()
    device = made.open()
    assert device.acknowledged_ns is None
    made.begin(device)
    assert device.acknowledged_ns is None
    made.deaf = True
    made.pause(0.003)
    device.read()
    assert device.acknowledged_ns is None
    made.deaf = False
    made.pause(0.001)
    device.read()
    assert device.acknowledged_ns == 4_000_000
    made.pause(0.001)
    device.read()
    assert device.acknowledged_ns == 4_000_000
    made.mute = True
    made.run(device, 150)  # what is not sent is not acknowledged
    made.mute = False
    made.pause(0.005)
    device.read()
    assert device.acknowledged_ns is None
    device.close()


def test_nothing_to_feel_for_five_seconds_is_rest_until_there_is(bench):
    made = bench()
    device = made.open()
    made.run(device, 10)
    made.run(device, 4900, REST)
    assert Rest not in made.kinds()  # a blank is no rest
    made.run(device, 200, REST)
    assert made.kinds() == [Frame, Rest]
    made.run(device, 200, REST)
    assert made.kinds() == []
    made.run(device, 10)
    assert made.kinds() == [Frame]
    assert (made.controller.levels == 512).all()
    assert device.take_notes() == []
    assert device.rested == 0
    device.close()


@pytest.mark.no_cover
def test_unplugged_and_plugged_in_a_hundred_times(bench):
    made = bench()
    device = made.open()
    made.run(device, 5)
    before = open_descriptors()
    for time in range(1, 101):
        made.unplug()
        device.write(HALF)
        assert device.read() is None
        assert device.take_notes() == [AWAY]
        made.run(device, 3)
        assert device.take_notes() == []
        made.us += 1_000_000  # so that each notice is said at once
        made.controller = Controller(shown())
        made.plug()
        made.way_mm = time
        assert made.back(device).x_mm == pytest.approx(HOME_MM + time)
        assert device.take_notes() == ["device: back"]
        assert device.rested == device.counts()["reconnections"] == time
    assert open_descriptors() == before
    assert device.counts()["frames not sent"] == 0
    made.begin(device)
    assert made.controller.frames > 0
    device.close()


def test_a_message_cut_by_the_loss_spoils_none_after_it(bench):
    made = bench()
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


@pytest.mark.no_cover
def test_an_info_that_nobody_asked_for_begins_nothing(bench):
    made = bench()
    device = made.open()
    made.begin(device)
    made.say(encode(shown()))
    made.run(device, 2)
    assert device.taking
    made.deaf = made.mute = True
    made.run(device, 300)
    os.set_blocking(made.slave, False)
    for size in (1000, 1):  # nothing goes out any more
        with suppress(BlockingIOError):
            while True:
                os.write(made.slave, bytes(size))
    made.run(device, 600)
    made.mute = False
    made.say(encode(shown()))
    made.run(device, 2)
    assert device.counts()["reconnections"] == 0
    made.deaf = False
    made.run(device, 300)
    assert device.counts()["reconnections"] == 1
    device.close()


def test_times_do_not_go_back_when_the_device_starts_anew(bench):
    made = bench()
    made.us = 5_000_000
    device = made.open()
    last = made.run(device, 5)
    made.unplug()
    made.run(device, 1)
    made.plug()
    made.controller = Controller(shown())
    begun_us = made.us
    tick, made.controller.tick = made.controller.tick, None
    made.controller.tick = lambda us, way_mm: tick(us - begun_us, way_mm)
    again = made.back(device)
    assert again.time_ns - last.time_ns == pytest.approx(made.us * 1000 - 5_005_000_000, abs=5e7)
    device.close()


def test_another_device_in_its_place_is_left_alone(bench):
    made = bench()
    device = made.open()
    made.run(device, 5)
    made.unplug()
    made.run(device, 1)
    made.controller = Controller(shown(name="Other", row_pitch_nm=2_000_000))
    made.plug()
    made.find()
    made.run(device, 1000)
    assert device.take_notes() == [
        AWAY,
        "device: Other came back in its place (pitch across the line 2 mm, not 1.8 mm); "
        "plug in test again and reading goes on",
    ]
    assert made.controller.frames == 0
    assert made.controller.greetings == 1
    made.unplug()
    made.run(device, 1)
    made.controller = Controller(shown())
    made.plug()
    assert made.back(device)
    assert device.take_notes() == ["device: back"]
    device.close()


def come_back(made, device, **changes):
    """Have it unplugged and another plugged in in its place; what is said of it."""
    made.unplug()
    made.run(device, 1)
    made.us += 1_000_000  # so that each notice is said at once
    made.controller = Controller(shown(**changes))
    made.plug()
    made.find()
    made.run(device, 300)
    notes = device.take_notes()
    assert notes[0] == AWAY
    return notes[1:]


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"name": "Other"}, "its name is Other, not test"),
        ({"counts_per_m": 100_000}, "a count is 10 µm, not 5 µm"),
        ({"count_sign": CountSign.LEFTWARD}, "its counts grow leftward"),
        ({"left_stop_count": 700}, "its left stop is at count 700, not 16757216"),
        ({"encoder": Encoder.INCREMENTAL}, "its encoder is incremental, not absolute"),
        ({"largest_slew_per_s": 300}, "its actuators may move 300 swings a second, not without"),
        ({"gain": b"\x80" * 2 + b"\xff" * 58}, "2 of its actuators have another gain"),
        ({"inverted": b"\1" * 60}, "60 of its actuators have another rest level"),
        ({"enabled": b"\0" + b"\1" * 59}, "1 of its actuators have another fitness for use"),
        ({"firmware": "9.9"}, None),
    ],
)
def test_what_is_otherwise_with_a_device_that_came_back_is_said_and_minded(bench, changes, said):
    made = bench()
    device = made.open()
    made.run(device, 5)
    notes = come_back(made, device, **changes)
    if said is None:
        assert notes == ["device: back"]
    else:
        assert notes[0].startswith(f"device: changed, for {said}")
        assert notes[1:] == ["device: back"]
    # What hung on it is as the device is now.
    if "encoder" in changes:
        assert "its left stop must be shown again" in notes[0]
        assert device.placing is Placing.STOP
        made.way_mm = 0.0
        made.run(device, 3)
        device.set_zero()
    for way_mm in (0.0, 7.0, 30.0):
        made.way_mm = way_mm
        assert made.run(device, 3).x_mm == pytest.approx(HOME_MM + way_mm)
    made.run(device, 300)
    levels = made.controller.levels.tolist()
    assert levels[0] == {"gain": 257, "enabled": 0, "inverted": 511}.get(next(iter(changes)), 512)
    # The next time it is the same again.
    assert come_back(made, device, **changes) == ["device: back"]
    device.close()


def test_a_stranger_of_the_same_name_is_told_by_what_is_otherwise(bench):
    made = bench()
    device = made.open()
    made.run(device, 5)
    assert come_back(made, device, travel_um=200_000, rate_hz=500) == [
        "device: another test came back (travel 200 mm, not 300 mm, rate 500 Hz, not 1000 Hz); "
        "plug in the one that reading began on, or set this one as that was, and reading goes on"
    ]
    assert made.controller.frames == 0
    device.close()


@pytest.mark.parametrize(
    ("offset", "value", "said"),
    [
        (2, 0, "rows is 0; it must be 1 to 16"),
        (2, 200, "rows is 200; it must be 1 to 16"),
        (3, 65, "columns is 65; it must be 1 to 64"),
        (12, 7, r"rest_side is 7; it must be one of 0 \(LEFT\), 1 \(RIGHT\)"),
        (16, 0xFF, "rate_hz is 65512; it must be 50 to 10000 Hz"),
        (23, 3, "encoder is 3; it must be one of 0"),
        (28, 0, "count_sign is 0; it must be one of 1"),
        (29, 33, "count_bits is 33; it must be 8 to 32 bits"),
        (29, 16, "travel_um is 300000, which takes 60000 counts .* less than 32768, .*_bits 16"),
        (34, 0xFF, "it ends before its last field"),
        (35, 0, None),  # of a text, which is mended
        (-1, 2, "enabled are up to 2; they must be 0 to 1"),
    ],
)
def test_an_info_that_cannot_be_is_named_with_its_field_and_value(bench, offset, value, said):
    made = bench()
    body = bytearray(cobs.decode(encode(shown())[:-1])[:-4])
    body[offset] = value
    receive = made.controller.receive

    def answer(chunk, us):
        return receive(chunk, us).replace(encode(made.controller.info), enframe(bytes(body)))

    made.controller.receive = answer
    if said is None:
        made.open().close()
        return
    with pytest.raises(DeviceError, match=rf"vb0 says in its INFO what cannot be: {said}"):
        made.open()
    assert made.us < 100_000  # at once, and not when the time to answer is over
    made.controller.receive = receive
    device = made.open()
    made.run(device, 5)
    made.unplug()
    made.run(device, 1)
    made.controller = Controller(shown())
    receive = made.controller.receive
    made.controller.receive = answer
    made.plug()
    made.find()
    made.run(device, 1000)
    notes = device.take_notes()
    assert len(notes) == 2
    assert re.match(rf"device: what came back says in its INFO what cannot be: {said}", notes[1])
    device.close()


def test_each_kind_of_notice_is_said_once_a_second_with_a_count(bench):
    made = bench()
    device = made.open()
    said = []
    for number in range(3000):
        made.say(encode(Error(200, f"Warm: {number}.")) + encode(Error(201, "Dusty.")))
        made.run(device, 1)
        said += device.take_notes()
    assert len(said) == 6
    assert said[:2] == ["device: Warm: 0.", "device: Dusty."]
    assert re.fullmatch(
        r"device: Warm: (99\d|100\d)\. \(1?\d{3,4} times in the last second\)", said[2]
    )
    device.close()


def test_a_watchdog_count_that_there_was_no_time_for_is_not_believed(bench, rng):
    made = bench()
    device = made.open()
    made.run(device, 20)
    for count in rng.integers(0, 2**32, 1000).tolist():
        made.say(encode(Watchdog(count, 0)))
        made.run(device, 1)
    assert device.counts()["watchdog trips"] == 0
    assert device.counts()["watchdog reports not believed"] >= 999
    assert device.rested == 0
    assert device.take_notes() == []
    assert device.watchdog_trips == 0
    device.close()


def test_a_watchdog_count_is_believed_over_its_wrap(bench):
    made = bench()
    device = made.open()
    made.say(encode(Watchdog(2**32 - 1, 0)))
    made.run(device, 100)
    made.say(encode(Watchdog(0, 0)))
    made.run(device, 2)
    assert device.counts()["watchdog trips"] == 1
    device.close()


def test_another_version_in_its_place_is_left_alone(bench):
    made = bench()
    device = made.open()
    made.run(device, 5)
    made.controller = Controller(shown())
    made.mute = True
    made.run(device, 510)
    os.write(made.master, enframe(b"\x81\x02"))
    made.run(device, 2)
    assert "a device of version 2 of the protocol came back" in device.take_notes()[-1]
    device.close()


def test_what_is_left_of_an_earlier_conversation_is_dropped(bench):
    made = bench()
    device = made.open()
    made.run(device, 5)
    made.mute = True
    made.run(device, 600)
    made.mute = False
    made.deaf = True
    sent = State(1, 2, 3, 4, 0, 0, None), Watchdog(99, 0), Error(3, "old")
    os.write(made.master, b"".join(map(encode, sent)))
    assert made.run(device, 3) is None
    device.close()


def test_closing_while_it_is_unplugged_leaves_nothing(bench):
    made = bench()
    before = open_descriptors() - 2  # without the peer's
    device = made.open()
    made.run(device, 5)
    made.unplug()
    made.run(device, 2)
    device.close()
    assert open_descriptors() == before
    with pytest.raises(DeviceError, match="closed"):
        device.write(HALF)


def test_it_says_whether_its_frames_are_taken(bench):
    made = bench()
    with made.open() as device:
        made.run(device, 200)
        assert device.taking
        take, made.controller.receive = made.controller.receive, lambda _chunk, _us: b""
        made.run(device, 40)
        assert device.taking  # one that is lost now and then is no refusal
        made.run(device, 15)
        assert not device.taking
        made.controller.receive = take
        made.run(device, 60)
        assert device.taking
        made.run(device, 6000, REST)  # nothing is sent that could be taken
        assert device.taking
