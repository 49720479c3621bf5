"""The simulated device at a real pseudo-terminal; the host does something between its ticks."""

import os
import time
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest

from tests.simulation.test_firmware import INFO, REST, SWING, packed
from vbraille.devices.serial.wire import (
    DELIMITER,
    Decoder,
    Encoder,
    Frame,
    Hello,
    Info,
    State,
    Watchdog,
    encode,
)
from vbraille.errors import InputError
from vbraille.simulation.hand import Sweep
from vbraille.simulation.pty import Link, Port
from vbraille.simulation.simulator import Defect, Faults, Simulator, Spoiler

PATIENCE_S = 30.0
# Of one axis, and slow, which leaves the machine of the test some time.
SLOW = replace(INFO, rate_hz=500, travel_um=40_000, height_um=0, counts_per_turn=0)


class Host:
    """What a host hears of a port, and says at it."""

    def __init__(self, path):
        self.descriptor = os.open(path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        self.decoder = Decoder()
        self.heard = []
        self.sequence = 0

    def close(self):
        os.close(self.descriptor)

    def hear(self):
        """What was said since the last time."""
        try:
            chunk = os.read(self.descriptor, 65_536)
        except BlockingIOError:
            chunk = b""
        new = self.decoder.feed(chunk)
        self.heard += new
        return new

    def say(self, message):
        line = encode(message)
        assert os.write(self.descriptor, line) == len(line)

    def frame(self):
        """Show something, from rest if it is there."""
        resting = not self.states or self.states[-1].resting
        self.sequence += 1
        self.say(Frame(self.sequence, packed(REST if resting else SWING)))

    @property
    def states(self):
        return [message for message in self.heard if isinstance(message, State)]


class Bench:
    """A simulator, what it says, and a host."""

    def __init__(self, info=SLOW, faults=None, link=None, speed_mm_s=400.0):
        self.said = []
        self.info = info
        self.port = Port(link)
        self.simulator = Simulator(
            info, Sweep(speed_mm_s), self.port, say=self.said.append, faults=faults
        )
        self.controller = self.simulator.controller
        self.host = Host(self.port.path)

    def close(self):
        self.host.close()
        self.port.unplug()

    def run(self, *steps):
        """Run until each of the host's steps has come true once; one is asked after each tick."""
        end = time.monotonic() + PATIENCE_S
        waiting = list(steps)

        def stopped():
            assert time.monotonic() < end, f"{len(waiting)} of {len(steps)} steps did not come"
            self.host.hear()
            if waiting and waiting[0]():
                del waiting[0]
            return not waiting

        self.simulator.run(stopped)

    def greet(self):
        self.host.say(Hello())
        self.run(lambda: self.host.states)

    def feel(self):
        """Have the device leave rest, and something shown."""
        self.host.frame()
        self.run(lambda: not self.host.states[-1].resting)
        self.host.frame()

    def show(self):
        """Send a FRAME; a step that never comes."""
        self.host.frame()
        return False

    def way_mm(self):
        """Where the host believes the carriage to be, by an encoder that is placed."""
        counts = (self.host.states[-1].count - self.info.left_stop_count) % (1 << 16)
        return counts / 200


@pytest.fixture
def bench():
    bench = Bench()
    yield bench
    bench.close()


@pytest.fixture
def make():
    made = []

    def make_one(**options):
        made.append(Bench(**options))
        return made[-1]

    yield make_one
    for bench in made:
        bench.close()


def ticks(number):
    """A step that comes after so many ticks."""
    left = [number]

    def passed():
        left[0] -= 1
        return left[0] <= 0

    return passed


def test_it_is_silent_until_hello_and_then_answers(bench):
    bench.run(ticks(20))
    assert bench.host.heard == []
    assert bench.said == []
    bench.greet()
    assert bench.host.heard[:2] == [SLOW, Watchdog(0, 0)]
    assert bench.said == ["greeted by a host"]


def test_states_are_sent_at_the_rate_by_its_clock(bench):
    bench.greet()
    bench.run(ticks(100))
    states = bench.host.states
    elapsed_us = states[-1].time_us - states[0].time_us
    assert states[-1].sequence - states[0].sequence == pytest.approx(elapsed_us / 2000, abs=3)
    assert len(states) >= bench.simulator.states_sent - 1
    assert 0 < states[0].time_us < PATIENCE_S * 1e6


def test_the_hand_sets_out_with_the_first_frame(bench):
    bench.greet()
    bench.run(ticks(50))
    assert bench.way_mm() == 0
    bench.run(lambda: bench.show() or bench.way_mm() > 30)
    assert bench.controller.frames > 10
    bench.run(lambda: bench.way_mm() == 0)  # it needs no more of them


def test_a_watchdog_s_trip_is_said_once_it_has_come_to_rest(bench):
    bench.greet()
    bench.feel()
    bench.run(lambda: bench.controller.trips)

    def rested():
        assert bench.said == ["greeted by a host"] or bench.controller.at_rest
        return bench.controller.at_rest

    bench.run(rested, ticks(20))
    assert bench.controller.levels.tolist() == REST
    after_ms = bench.controller.rest_after_us / 1000
    assert bench.said[1:] == [f"watchdog: trip 1, at rest {after_ms:.1f} ms after the last frame"]
    assert Watchdog(1, 0) in bench.host.heard


def test_with_an_index_the_hand_crosses_the_mark_once_greeted(make):
    bench = make(info=replace(SLOW, encoder=Encoder.INDEX))
    bench.run(ticks(50))
    bench.greet()
    assert not bench.host.states[0].placed
    bench.run(lambda: bench.host.states[-1].placed, lambda: bench.way_mm() == 0, ticks(20))
    assert bench.way_mm() == 0
    bench.run(lambda: bench.show() or bench.way_mm() > 20)
    bench.host.say(Hello())
    bench.run(lambda: bench.said.count("greeted by a host") == 2, ticks(5))
    assert bench.way_mm() > 20  # on its way it stays


def test_a_mark_that_was_crossed_while_the_computer_stood_still_is_crossed_again(make):
    bench = make(info=replace(SLOW, encoder=Encoder.INDEX))
    bench.greet()
    bench.run(lambda: bench.way_mm() > 0)
    time.sleep(0.15)  # there and back takes 88 ms
    bench.run(lambda: bench.host.states[-1].placed)


def test_with_an_incremental_encoder_it_goes_back_at_each_greeting(make):
    bench = make(info=replace(SLOW, encoder=Encoder.INCREMENTAL, left_stop_count=0))
    bench.greet()
    stop = bench.host.states[-1].count
    bench.run(lambda: bench.show() or bench.host.states[-1].count != stop, ticks(10))
    for _ in range(2):
        bench.host.say(Hello())
        bench.run(lambda: bench.host.states[-1].count == stop, ticks(20))
        assert bench.host.states[-1].count == stop
    bench.run(lambda: bench.show() or bench.host.states[-1].count != stop)


def test_a_host_that_does_not_read_loses_states_and_nothing_waits(make):
    bench = make(info=replace(SLOW, rate_hz=2000))
    bench.host.say(Hello())
    end = time.monotonic() + PATIENCE_S
    sent = []

    def stopped():
        assert time.monotonic() < end
        sent.append(bench.simulator.states_sent)
        return len(sent) > 30 and 0 < sent[-1] == sent[-30]

    bench.simulator.run(stopped)
    bench.run(ticks(20))
    sequences = [state.sequence for state in bench.host.states]
    assert not any(bench.host.decoder.dropped.values())  # each came whole, or not at all
    assert len(sequences) > sent[-1]
    assert max(later - earlier for earlier, later in pairwise(sequences)) > 20


def test_late_ticks_are_skipped_and_their_states_dropped(bench):
    bench.greet()
    last = bench.host.states[-1]
    dropped = bench.simulator.states_dropped
    bench.run(lambda: time.sleep(0.1) or True, ticks(3))
    state = next(state for state in bench.host.states if state.time_us > last.time_us + 50_000)
    elapsed_us = state.time_us - last.time_us
    assert state.sequence - last.sequence == pytest.approx(elapsed_us / 2000, abs=10)
    assert bench.simulator.states_dropped - dropped >= 40


def test_hosts_come_and_go_and_it_stays(bench):
    for greetings in (1, 2, 3):
        bench.host.close()
        bench.simulator.run(ticks(5))
        bench.host = Host(bench.port.path)
        bench.host.say(Hello())
        bench.run(lambda: any(isinstance(message, Info) for message in bench.host.heard))
        assert bench.said == ["greeted by a host"] * greetings


def test_messages_are_dropped_and_corrupted_both_ways(make):
    bench = make(faults=Faults(drop=0.2, corrupt=0.2, seed=3))
    bench.run(lambda: bench.host.say(Hello()) or bench.controller.greeted, ticks(1))
    sent = [0]

    def show():
        sent[0] += 1
        return bench.show() or sent[0] == 100

    bench.run(show, ticks(2))
    assert bench.host.decoder.dropped["bad CRC"] > 0
    assert 40 < bench.controller.frames < 90
    assert bench.controller.dropped > 5
    assert bench.simulator.states_dropped > 5
    sequences = [state.sequence for state in bench.host.states]
    assert len(sequences) < sequences[-1] - sequences[0]


def test_chances_are_of_whole_messages_and_of_the_seed():
    messages = [encode(Frame(n, packed(SWING))) for n in range(1000)]
    stream = DELIMITER + b"".join(messages)
    faults = Faults(drop=0.1, corrupt=0.2)

    def spoilt(faults, chunk):
        spoiler = Spoiler(faults)
        pieces = (stream[at : at + chunk] for at in range(0, len(stream), chunk))
        return b"".join(map(spoiler.spoil_stream, pieces))

    passed = spoilt(faults, 7)
    assert passed == spoilt(faults, 1000)
    assert passed != spoilt(replace(faults, seed=2), 7)
    assert spoilt(Faults(), 7) == stream
    assert spoilt(Faults(drop=1.0), 7) == DELIMITER
    spoiler = Spoiler(faults)
    became = [(message, spoiler.spoil(message)) for message in messages]
    assert sum(new == b"" for _, new in became) == pytest.approx(100, abs=30)
    changed = [(old, new) for old, new in became if new not in (old, b"")]
    assert len(changed) == pytest.approx(180, abs=40)
    for old, new in changed:
        turned = int.from_bytes(old, "big") ^ int.from_bytes(new, "big")
        assert len(old) == len(new)
        assert turned.bit_count() == 1


def test_what_has_no_end_is_not_held_for_ever():
    spoiler = Spoiler(Faults(corrupt=0.5))
    assert len(b"".join(spoiler.spoil_stream(b"\1" * 1000) for _ in range(100))) > 90_000


@pytest.mark.real_time
def test_stalled_it_neither_reads_nor_writes_but_its_watchdog_goes_on(make):
    bench = make(faults=Faults(stall_s=0.2))
    bench.greet()

    def stalled():
        each = pairwise(bench.host.states[-50:])
        return any((new.sequence - old.sequence) * 2 > 150 for old, new in each)  # ms

    # A machine that is busy may let the watchdog trip before the first stall does.
    bench.run(lambda: bench.show() or stalled())
    assert any("watchdog: trip" in line for line in bench.said)
    frames = bench.controller.frames
    bench.run(lambda: bench.show() or bench.controller.frames > frames)
    assert bench.controller.rest_after_us <= 50_000 + 20_000 + 2_000


def test_unplugged_it_hangs_up_and_comes_back_ungreeted(make, tmp_path):
    link = tmp_path / "vb0"
    bench = make(faults=Faults(unplug_every_s=0.3, corrupt=1e-12), link=Link(str(link)))
    bench.greet()
    bench.host.frame()
    os.write(bench.host.descriptor, b"\x55")  # what comes after must not be taken for its end
    end = time.monotonic() + PATIENCE_S

    def stopped(word):
        assert time.monotonic() < end
        return bench.said[-1].startswith(word)

    bench.simulator.run(lambda: stopped("unplugged"))
    assert not os.path.lexists(link)
    with pytest.raises(OSError, match="Input/output error"):
        os.write(bench.host.descriptor, b"\0")
    bench.simulator.run(lambda: stopped("plugged in again"))
    assert link.readlink() == Path(bench.port.path)
    bench.host.close()
    bench.host = Host(link)
    bench.run(ticks(10))
    assert bench.host.heard == []
    os.write(bench.host.descriptor, DELIMITER)
    bench.greet()
    assert bench.host.heard[1] == Watchdog(1, 0)
    assert bench.said[1].startswith("watchdog: trip 1, at rest 7")


@pytest.mark.parametrize(
    "wrong", [{"drop": 1.5}, {"corrupt": float("nan")}, {"stall_s": -1}, {"unplug_every_s": -1}]
)
def test_faults_are_in_range(wrong):
    with pytest.raises(ValueError, match=f"{next(iter(wrong))} is .*; it must be 0"):
        Faults(**wrong)


def test_a_link_is_never_put_over_what_somebody_else_has_made(tmp_path):
    path = tmp_path / "vb0"
    link = Link(str(path))
    path.symlink_to("/nowhere")
    for _ in range(2):
        with pytest.raises(InputError, match="vb0 is there already; remove it, or choose another"):
            link.point("/dev/pts/98")
        link.remove()
        assert path.readlink() == Path("/nowhere")
    path.unlink()
    link.point("/dev/pts/98")
    link.point("/dev/pts/99")  # plugged in again, at another port
    assert path.readlink() == Path("/dev/pts/99")
    assert list(tmp_path.iterdir()) == [path]
    path.unlink()
    path.symlink_to("/dev/pts/97")
    with pytest.raises(InputError, match="is there already"):
        link.point("/dev/pts/98")
    link.remove()
    assert path.readlink() == Path("/dev/pts/97")


def test_a_link_is_removed_by_who_made_it(tmp_path):
    link = Link(str(tmp_path / "vb0"))
    link.point("/dev/pts/98")
    link.remove()
    link.remove()
    assert list(tmp_path.iterdir()) == []


def test_no_descriptor_is_left_when_there_can_be_no_link(tmp_path):
    before = len(list(Path("/proc/self/fd").iterdir()))
    for path in (tmp_path, tmp_path / "none" / "vb0"):
        with pytest.raises(InputError, match="choose another"):
            Port(Link(str(path)))
    assert len(list(Path("/proc/self/fd").iterdir())) == before


@pytest.mark.parametrize("defect", Defect)
def test_it_is_built_wrong_in_what_it_is_told_to_be(make, defect):
    bench = make(faults=Faults(defect=defect))
    bench.greet()
    begun_ns, begun = time.monotonic_ns(), bench.host.states[-1]
    bench.feel()
    bench.run(ticks(75))  # of 2 ms: the watchdog has tripped, unless it is late or not there
    state = bench.host.states[-1]
    passed_us = (time.monotonic_ns() - begun_ns) / 1000
    (info,) = [message for message in bench.host.heard if isinstance(message, Info)]
    found = {
        Defect.NO_ACKNOWLEDGEMENT: bench.controller.frames > 0 and state.frame_sequence == 0,
        Defect.NO_ACTUATORS: not any(info.enabled),
        Defect.OFF_PLACE: bench.way_mm() > info.travel_um / 1000,
        Defect.SLOW_CLOCK: (state.time_us - begun.time_us) / passed_us < 0.7,
        Defect.NO_WATCHDOG: bench.controller.watchdog_us is None and not bench.controller.trips,
        Defect.LATE_WATCHDOG: bench.controller.watchdog_us == 200_000,
    }
    assert [kind for kind, is_so in found.items() if is_so] == [defect]
