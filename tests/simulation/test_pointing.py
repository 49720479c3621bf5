"""A simulated hand held from outside: where it goes, and what it does when it is let go."""

import os
import subprocess
import sys
import threading
from dataclasses import replace

import numpy as np
import pytest

from tests.tiers import by_tier
from vbraille.devices import open_device
from vbraille.devices.events import HandHeld, told
from vbraille.engine.clock import ManualClock
from vbraille.errors import InputError
from vbraille.render import STRESS2
from vbraille.simulation.motion import Motion
from vbraille.simulation.recorded import Recorded
from vbraille.simulation.simulated import HELD_MM_S, SimulatedDevice
from vbraille.simulation.steering import BeAt, Pointer, ReadLine, Steering
from vbraille.testing import simulated_device

SPAN_MM = STRESS2.display.span_mm
LEFT_MM = -SPAN_MM / 2
TAKEN, GIVEN_BACK = HandHeld(held=True), HandHeld(held=False)
PLANE = replace(STRESS2.display, height_mm=100.0, turns=True)


@pytest.fixture
def ends():
    """Both ends, as a server and the process of a device have them."""
    pointer = Pointer()
    return pointer, Pointer(pointer.descriptor)


@pytest.fixture
def clock():
    return ManualClock()


def held_device(clock, display=STRESS2, hand="sweep:100"):
    """A device that reads a line, and what holds its hand."""
    device = simulated_device(display, hand=hand, clock=clock, pointer=Pointer())
    device.steering.give(ReadLine(150.0))
    return device, device.pointer


def places(device, clock, seconds):
    """Places of the array's centre along x, a thousand a second."""
    found = []
    for _ in range(round(seconds * 1000)):
        clock.advance_ns(1_000_000)
        found.append(device.read().x_mm)
    return np.array(found)


def after_home(way):
    """Number of the first place near the left stop."""
    return np.flatnonzero(way <= LEFT_MM + 0.25)[0]


def test_a_pose_arrives_as_it_was_told_until_the_hand_is_let_go(ends):
    ours, theirs = ends
    assert theirs.at() is None
    assert not theirs.held
    ours.hold(BeAt(10.5, -2.0, 0.25))
    assert theirs.at() == BeAt(10.5, -2.0, 0.25)
    assert theirs.at() is theirs.at()
    assert theirs.held
    ours.hold(BeAt(11.0))
    ours.hold(BeAt(12.0))
    assert theirs.at() == BeAt(12.0)
    ours.let_go()
    assert theirs.at() is None
    assert not ours.held


def test_what_is_being_written_is_taken_when_it_is_whole(ends):
    ours, theirs = ends
    ours.hold(BeAt(1.0))
    assert theirs.at() == BeAt(1.0)
    ours.hold(BeAt(2.0))
    size = os.fstat(ours.descriptor).st_size
    for byte in range(64, size - 8):
        was = os.pread(ours.descriptor, 1, byte)
        os.pwrite(ours.descriptor, bytes([was[0] ^ 0x40]), byte)
        late = Pointer(ours.descriptor)
        assert late.at() in (None, BeAt(2.0))
        os.pwrite(ours.descriptor, was, byte)
        assert late.at() == BeAt(2.0)
    assert theirs.at() == BeAt(2.0)


@pytest.mark.parametrize("reaped", [True, False])
def test_a_hold_ends_with_the_process_that_holds(ends, reaped):
    ours, theirs = ends
    program = (
        "import sys; from vbraille.simulation.steering import Pointer;"
        "from vbraille.simulation.steering import BeAt;"
        "Pointer(int(sys.argv[1])).hold(BeAt(7.0)); print('held', flush=True); sys.stdin.read()"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", program, str(ours.descriptor)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        pass_fds=(ours.descriptor,),
    )
    with process:
        assert process.stdout.readline() == b"held\n"
        assert all(theirs.at() == BeAt(7.0) for _ in range(1000))
        process.kill()
        if reaped:
            process.wait()
        else:
            os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)
        assert any(theirs.at() is None for _ in range(1000))
        assert theirs.at() is None


def test_two_who_write_at_once_leave_orders_and_poses_whole():
    steering, pointer = Steering(), Pointer()
    taking, holding = Steering(steering.descriptor), Pointer(pointer.descriptor)
    count = by_tier(2000, 20_000, 200_000)

    def order():
        for n in range(count):
            steering.give(ReadLine(float(n)))

    def hold():
        for n in range(count):
            pointer.hold(BeAt(float(n), float(-n), 2.0 * n))

    writers = [threading.Thread(target=order), threading.Thread(target=hold)]
    for writer in writers:
        writer.start()
    while any(writer.is_alive() for writer in writers):
        at, given = holding.at(), taking.take()
        assert at is None or (at.y_mm, at.theta_rad) == (-at.x_mm, 2 * at.x_mm)
        assert given is None or given.end_mm == int(given.end_mm)
    assert holding.at() == BeAt(count - 1.0, 1.0 - count, 2.0 * (count - 1))


def test_the_hand_goes_where_it_is_held_no_faster_than_a_hand_is_led(clock):
    device, pointer = held_device(clock)
    places(device, clock, 0.5)
    assert device.take_events() == []
    pointer.hold(BeAt(200.0))
    way = places(device, clock, 0.3)
    assert way[-1] == 200.0
    assert way[20] > way[0]
    assert np.abs(np.diff(way)).max() <= HELD_MM_S / 1000 + 0.01
    assert device.take_events() == [TAKEN]
    pointer.hold(BeAt(201.0))  # near by it glides, and is there at once for who looks
    way = places(device, clock, 0.02)
    assert way[1] > 200.0
    assert way[-1] == 201.0
    assert np.diff(way).max() < 0.15
    assert device.take_events() == []


@pytest.mark.parametrize(
    ("told_mm", "found_mm"), [(-500.0, LEFT_MM), (900.0, 300.0 + LEFT_MM), (-1e300, LEFT_MM)]
)
def test_the_carriage_stops_at_its_ends(clock, told_mm, found_mm):
    device, pointer = held_device(clock)
    pointer.hold(BeAt(told_mm, 50.0, 1.0))
    places(device, clock, 1.0)
    pose = device.read()
    assert pose.x_mm == pytest.approx(found_mm)
    assert (pose.y_mm, pose.theta_rad) == (0.0, 0.0)  # it has one axis only


def test_a_carriage_of_more_axes_is_held_on_all_of_them(clock):
    device, pointer = held_device(clock, PLANE)
    pointer.hold(BeAt(40.0, 500.0, 0.5))
    places(device, clock, 1.0)
    pose = device.read()
    assert (pose.x_mm, pose.y_mm, pose.theta_rad) == pytest.approx((40.0, 100.0, 0.5))


def test_let_go_the_hand_reads_the_line_again_from_its_start(clock):
    device, pointer = held_device(clock)
    places(device, clock, 0.5)
    pointer.hold(BeAt(200.0))
    places(device, clock, 1.0)
    assert not device.steering.done_at(clock.now_ns())
    pointer.let_go()
    way = places(device, clock, 4.0)
    assert np.abs(np.diff(way)).max() <= 0.26
    assert way[after_home(way) :].max() == pytest.approx(150.0 + SPAN_MM / 2, abs=0.11)
    assert device.take_events() == [TAKEN, GIVEN_BACK]
    assert told([TAKEN, GIVEN_BACK]) == ["hand: moved in the live view", "hand: simulated again"]
    assert device.steering.done_at(clock.now_ns())


def test_of_orders_given_meanwhile_the_last_is_followed_when_it_is_let_go(clock):
    device, pointer = held_device(clock)
    pointer.hold(BeAt(100.0))
    places(device, clock, 0.5)
    device.steering.give(ReadLine(80.0))
    device.steering.give(ReadLine(20.0))
    assert places(device, clock, 0.5)[-1] == 100.0
    pointer.let_go()
    way = places(device, clock, 3.0)
    assert way[after_home(way) :].max() == pytest.approx(20.0 + SPAN_MM / 2, abs=0.11)
    assert device.steering.done_at(clock.now_ns())


def test_a_hand_that_was_done_stays_where_it_is_let_go(clock):
    device, pointer = held_device(clock)
    places(device, clock, 10.0)
    assert device.steering.done_at(clock.now_ns())
    pointer.hold(BeAt(50.0))
    places(device, clock, 0.5)
    pointer.let_go()
    assert set(places(device, clock, 1.0)) == {50.0}


@pytest.mark.parametrize("steered", [True, False])
def test_a_recorded_hand_goes_on_where_it_was_taken(clock, steered):
    recorded = Recorded(np.arange(6) * 0.4, np.arange(6) * 10.0 + LEFT_MM - SPAN_MM / 2)
    pointer, steering = Pointer(), Steering() if steered else None
    device = SimulatedDevice(STRESS2.display, clock.now_ns, recorded, steering, pointer=pointer)
    if steering is None:
        device.move(recorded.motion())
    else:
        steering.give(ReadLine(150.0))
    at_mm = places(device, clock, 1.0)[-1]
    pointer.hold(BeAt(200.0))
    places(device, clock, 1.0)
    pointer.let_go()
    way = places(device, clock, 4.0)
    assert way.min() == pytest.approx(at_mm, abs=0.1)
    assert way[-1] == pytest.approx(50.0 + LEFT_MM - SPAN_MM / 2 + SPAN_MM / 2, abs=0.1)


def test_a_hand_that_nothing_steers_reads_on_after_it_is_let_go(clock):
    pointer = Pointer()
    hand = simulated_device(hand="sweep:500").hand
    device = SimulatedDevice(STRESS2.display, clock.now_ns, hand, pointer=pointer)
    device.write(np.zeros((6, 10)))
    pointer.hold(BeAt(50.0))
    assert places(device, clock, 1.0)[-1] == 50.0
    pointer.let_go()
    assert places(device, clock, 3.0).max() > 250


def test_a_still_hand_moves_only_when_it_is_held(clock):
    device, pointer = held_device(clock, hand="still")
    assert set(places(device, clock, 2.0)) == {device.read().x_mm}
    pointer.hold(BeAt(70.0))
    assert places(device, clock, 1.0)[-1] == 70.0
    device.steering.give(ReadLine(20.0))
    pointer.let_go()
    assert set(places(device, clock, 2.0)) == {70.0}
    assert not device.steering.done_at(clock.now_ns())


def test_a_still_hand_that_nobody_can_hold_is_refused():
    with pytest.raises(InputError, match="moves only in the live view"):
        simulated_device(hand="still")


def test_a_spec_names_the_memory_that_holds_the_hand():
    steering, pointer = Steering(), Pointer()
    spec = f"sim:?hand=still&steering={steering.descriptor}&pointer={pointer.descriptor}"
    with open_device(spec, STRESS2.display) as device:
        assert device.pointer.descriptor == pointer.descriptor


@pytest.mark.parametrize("wrong", ["none", "-1", "999999999999999999999", "steering"])
def test_a_descriptor_of_something_else_is_refused(wrong):
    steering = Steering()
    descriptor = str(steering.descriptor) if wrong == "steering" else wrong
    with pytest.raises(InputError, match="nothing can steer a hand by pointer="):
        open_device(f"sim:?hand=sweep:60&pointer={descriptor}", STRESS2.display)


def test_the_memory_of_a_pointer_steers_no_hand():
    with pytest.raises(ValueError, match="not of memory that steers a hand"):
        Steering(Pointer().descriptor)


def test_a_motion_of_a_still_hand_stays_at_the_start_of_the_line():
    hand = simulated_device(hand="still", pointer=Pointer()).hand
    motion = hand.read_line(-10.8, 50.0)
    assert isinstance(motion, Motion)
    assert set(motion.x_mm) == {-10.8}
