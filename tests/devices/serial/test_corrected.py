"""Calibrations of a serial device, whose own INFO goes first, down to the controller's levels."""

import numpy as np

from tests.devices.bench import HALF, REST, Bench
from vbraille.devices.calibration import Calibration, Tried

SHAPE = 6, 10
FOUND = Calibration(
    "bench",
    *SHAPE,
    (Tried(0, 0, "dead"), Tried(1, 2, gain=0.5), Tried(2, 3, inverted=True), Tried(5, 9, "weak")),
)
FULL = np.ones(SHAPE)


def levels(made):
    return made.controller.levels.reshape(SHAPE)


def corrected(**changes):
    made = Bench(**changes)
    device = made.open()
    device.correct(FOUND)
    made.settle(device)
    return made, device


def largest_step(made, device, ticks, frame):
    """Largest change of a level in a tick, while a frame is asked for."""
    largest, before = 0, levels(made).astype(int)
    for _ in range(ticks):
        made.run(device, 1, frame)
        now = levels(made).astype(int)
        largest, before = max(largest, np.abs(now - before).max()), now
    return largest


def test_levels_make_up_for_what_was_found():
    made, device = corrected()
    made.run(device, 150, FULL)
    wanted = np.full(SHAPE, 1023)
    wanted[0, 0], wanted[1, 2], wanted[2, 3] = 0, round(1023 / 2), 0
    assert levels(made).tolist() == wanted.tolist()
    made.run(device, 3, REST)
    assert levels(made)[2, 3] == 1023
    assert np.count_nonzero(levels(made)) == 1
    assert device.calibration == FOUND


def test_what_info_says_goes_before_what_was_found():
    for changes in (
        {"gain": bytes([255] * 59 + [200])},
        {"enabled": bytes([1] * 59 + [0])},
        {"inverted": bytes([0] * 59 + [1])},
    ):
        made, device = corrected(**changes)
        assert device.has_own_gains
        assert device.calibration is None
        made.run(device, 150, FULL)
        assert levels(made)[0, 0] == levels(made)[1, 2] == levels(made)[2, 3] == 1023


def test_an_inverted_actuator_goes_over_without_a_jump_and_so_it_rests():
    made = Bench()
    device = made.open()
    device.correct(FOUND)
    # 1/20 is the ramp's step, which the controller makes by itself when it rests. When it leaves
    # rest, it makes up for some FRAMEs, two in a period.
    assert largest_step(made, device, 300, np.full(SHAPE, 0.001)) <= 2 * 12
    assert levels(made)[2, 3] > 1000
    device.rest()
    made.pause(0.03)
    device.read()
    assert not levels(made).any()
    assert largest_step(made, device, 300, np.full(SHAPE, 0.001)) <= 2 * 12
    assert levels(made)[2, 3] > 1000
    device.close()
    made.pause(0.03)
    assert not levels(made).any()


def test_what_was_found_is_made_up_for_when_the_device_is_back():
    made, device = corrected()
    made.run(device, 150, HALF)
    before = levels(made).tolist()
    made.come_back(device)
    made.run(device, 300, HALF)
    assert levels(made).tolist() == before


def test_nothing_is_steady_while_an_actuator_is_on_its_way():
    made, device = corrected()
    drive = device.conversation.drive
    made.port.bare_descriptor = -1  # nothing is done with these numbers
    assert not drive.settled
    assert device.begin_steady() is None
    made.run(device, 150, HALF)
    assert drive.settled
    steady = device.begin_steady()
    assert steady is not None
    assert steady.actuators.swing[0, 0] == 0
    assert steady.actuators.rest[2, 3] == 1023
