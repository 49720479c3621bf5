"""Actuators between rest and FRAMEs: stopped hosts, watchdogs, lines that are full."""

import numpy as np
import pytest

from tests.controllers import HastyController
from tests.devices.bench import DEVICE_LATE, HALF, HOME_MM, HOST_LATE, LINE_LATE, REST, Bench
from tests.packing import packed
from vbraille.devices.events import told
from vbraille.devices.serial.wire import Frame, Rest, State, Watchdog, encode
from vbraille.errors import DeviceError
from vbraille.simulation.firmware import Controller
from vbraille.simulation.simulator import split

OLD_AND_NEW = pytest.mark.parametrize("made_as", [Controller, HastyController])


def test_a_peer_that_does_not_read_stops_nobody_and_gets_nothing_late():
    made = Bench()
    device = made.open()
    made.settle(device)
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
    assert told(device.take_events()) == [LINE_LATE]
    assert device.taking
    assert device.rested == 1
    device.close()


def test_a_device_that_stood_still_is_told_from_a_line_that_did():
    made = Bench()
    device = made.open()
    made.settle(device)
    for _ in range(55):  # its timer stands still, and what is sent to it waits
        made.us += 1000
        device.read()
        device.write(HALF)
    made.say(made.controller.tick(made.us, 5.0))
    made.settle(device)
    assert told(device.take_events()) == [DEVICE_LATE]
    device.close()


@OLD_AND_NEW
@pytest.mark.parametrize("stall_ms", [41, 49, 50.5, 55, 60, 69, 75, 150, 2000])
def test_a_host_that_was_stopped_lets_the_ramp_end_and_begins_from_rest(made_as, stall_ms):
    made = Bench(made_as=made_as)
    device = made.open()
    for time in range(1, 3):
        made.settle(device)
        made.kinds()
        assert (made.controller.levels == 512).all()
        levels = [made.controller.levels[0]]
        for _ in range(round(stall_ms)):  # no test asks for the time
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
        assert told(device.take_events()) == ([HOST_LATE] if time == 1 or stall_ms > 1000 else [])
    assert device.counts()["watchdog trips"] == 2  # its own, and not the host's REST
    assert Rest not in made.kinds()
    device.close()


@OLD_AND_NEW
def test_what_a_stopped_host_has_not_read_is_not_taken_for_the_place(made_as):
    made = Bench(made_as=made_as)
    device = made.open()
    made.settle(device)
    for way_mm in range(10, 90):  # 80 ms of states, and no WATCHDOG: the line was full
        made.way_mm = way_mm
        made.controller.tick(made.us, way_mm)
        made.us += 1000
        made.say(
            encode(
                State(way_mm, made.us, 0, device.conversation.frames.sequence, 1, 0, None, 0, 0, 0)
            )
        )
    made.way_mm = 120.0
    made.run(device, 1)
    assert not device.taking
    while not device.taking:
        made.pause(0.001)
        sample = device.read()
        device.write(HALF)
    assert not any(made.controller.levels)
    assert sample.x_mm == pytest.approx(120.0 + HOME_MM)
    device.close()


def test_an_old_controller_that_a_late_frame_holds_is_told_to_rest():
    made = Bench(made_as=HastyController)
    device = made.open()
    made.settle(device)
    made.deaf = True
    made.run(device, 53)  # it trips, and says so
    assert not device.taking
    made.deaf = False
    made.receive()  # what was on the way is lost
    made.kinds()
    full = packed([1023] * 60, 1023)
    made.say(made.controller.receive(encode(Frame(9999, full)), made.us))  # but for an old one
    assert (made.controller.levels == 1023).all()
    made.run(device, 3)
    made.hear()
    assert made.kinds() == [Rest]
    made.run(device, 20)
    assert made.controller.at_rest
    made.settle(device)
    device.close()


def test_a_device_that_neither_rests_nor_trips_is_not_read_on():
    made = Bench()
    device = made.open()
    made.settle(device)
    made.controller._flags = lambda: 1  # never at rest, whatever comes
    made.pause(0.06)
    with pytest.raises(DeviceError, match="test does not go to rest, neither when it is told to"):
        made.run(device, 600)
    device.close()


@OLD_AND_NEW
def test_closing_ends_by_the_ramp_even_where_nothing_was_faded_out(made_as):
    made = Bench(made_as=made_as)
    device = made.open()
    made.settle(device)
    device.close()
    made.hear()
    assert (made.controller.levels == 512).all()
    made.pause(0.005)
    assert made.controller.levels[0] == pytest.approx(384, abs=30)
    made.pause(0.02)
    assert made.controller.at_rest


def test_a_trip_whose_report_is_lost_is_counted_by_the_states_and_once():
    made = Bench()
    device = made.open()
    made.settle(device)
    made.deaf = True
    say = made.say
    made.say = lambda chunk: say(b"".join(m for m in split(chunk) if len(m) > 20))  # STATE alone
    made.run(device, 60)
    assert device.counts()["watchdog trips"] == 1
    made.say = say
    made.deaf = False
    made.settle(device)
    assert device.counts()["watchdog trips"] == 1
    assert told(device.take_events()) == [LINE_LATE]
    device.close()


def test_trips_before_the_first_report_are_of_no_concern():
    made = Bench()
    made.controller.trips = 5
    device = made.open()
    made.run(device, 20)
    assert device.counts()["watchdog trips"] == 0
    assert device.rested == 0
    device.close()


def test_a_watchdog_count_that_there_was_no_time_for_is_not_believed(rng):
    made = Bench()
    device = made.open()
    made.run(device, 20)
    for count in rng.integers(0, 2**32, 1000).tolist():
        made.say(encode(Watchdog(count, 0)))
        made.run(device, 1)
    assert device.counts()["watchdog trips"] == 0
    assert device.counts()["watchdog reports not believed"] >= 999
    assert device.rested == 0
    assert told(device.take_events()) == []
    assert device.watchdog_trips == 0
    device.close()


def test_a_watchdog_count_is_believed_over_its_wrap():
    made = Bench()
    device = made.open()
    made.say(encode(Watchdog(2**32 - 1, 0)))
    made.run(device, 100)
    made.say(encode(Watchdog(0, 0)))
    made.run(device, 2)
    assert device.counts()["watchdog trips"] == 1
    device.close()


def test_it_says_whether_its_frames_are_taken():
    made = Bench()
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


def test_nothing_to_feel_for_five_seconds_is_rest_until_there_is():
    made = Bench()
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
    assert told(device.take_events()) == []
    assert device.rested == 0
    device.close()


def test_a_frame_that_found_no_room_counts_in_the_sequence_of_the_next():
    made = Bench()
    device = made.open()
    made.settle(device)
    last = device.conversation.frames.sequence
    made.hear()
    made.room = 0
    made.run(device, 3)
    assert device.counts()["frames not sent"] == 3
    made.room, made.sent = 20_000, []
    made.run(device, 2)
    assert next(one for one in made.sent if isinstance(one, Frame)).sequence == last + 4


def test_a_host_that_was_stopped_reads_all_that_waits_before_it_takes_a_place():
    made = Bench()
    device = made.open()
    made.settle(device)
    whole = made.port.read
    left = bytearray()

    def read():
        """A little at a time, as a driver of the system may give it."""
        left.extend(whole())
        chunk = bytes(left[:100])
        del left[:100]
        return chunk

    made.port.read = read
    for way_mm in range(10, 70):
        made.way_mm = float(way_mm)
        made.pause(0.001)
    pose = device.read()
    assert not left
    assert pose.x_mm == pytest.approx(69.0 + HOME_MM)


def test_a_place_is_never_earlier_than_the_one_before():
    made = Bench()
    device = made.open()
    made.settle(device)
    before = made.run(device, 1)
    made.mute = True
    made.pause(0.001)
    sequence = device.conversation.states.sequence + 1
    made.mute = False
    back_us = made.us - 5000  # a clock that is set back
    taken = device.conversation.frames.sequence
    made.say(encode(State(sequence, back_us, 0, taken, 1, 0, None, 0, 0, 0)))
    assert device.read().time_ns == before.time_ns
