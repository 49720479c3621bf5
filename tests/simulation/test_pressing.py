"""Presses of simulated buttons, by plan and by hand."""

import pytest

from tests.engine.test_loop import info
from vbraille.devices.events import Button, Knob
from vbraille.engine.clock import ManualClock
from vbraille.errors import InputError
from vbraille.simulation.controls import Controls, parse_presses, parse_script
from vbraille.simulation.simulated import SimulatedDevice, open_simulated


def test_a_press_is_short_unless_it_is_said_till_when():
    assert parse_presses("1@2.5s") == parse_script("2.5s press 1\n2.6s release 1", "")
    assert parse_presses("8@0s-4s") == parse_script("0s press 8\n4s release 8", "")


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("1", "no press"),
        ("one@2s", "no press"),
        ("1@2", "no press"),
        ("9@2s", "button is 9; it must be 1 to 8"),
        ("0@2s", "button is 0"),
        ("1@4s-2s", "let go at 2 s"),
        ("1@4000s", "time of the press is 4000 s"),
    ],
)
def test_what_is_no_press_is_refused_in_a_sentence(text, why):
    with pytest.raises(InputError, match=why):
        parse_presses(text)


def test_buttons_that_are_held_at_a_time():
    controls, held = Controls(parse_presses("1@1s-2s,3@1.5s-4s")), []
    for now_s in (0.9, 1.0, 1.5, 2.0, 4.0):
        controls.advance(now_s)
        held.append(controls.buttons)
    assert held == [0, 1, 5, 4, 0]


def test_a_device_in_memory_tells_what_was_pressed_and_turned():
    clock = ManualClock()
    device = SimulatedDevice(info(), clock.now_ns, presses=parse_presses("2@0.5s-0.6s"))
    assert list(device.take_events()) == []
    device.press(1)
    device.let_go(1)
    device.turn(1, 0.25)
    assert device.take_events() == [
        Button(1, pressed=True),
        Button(1, pressed=False),
        Knob(1, 0.25),
    ]
    told = []
    for _ in range(10):
        clock.advance_ns(100_000_000)
        told += device.take_events()
    assert told == [Button(2, pressed=True), Button(2, pressed=False)]
    with pytest.raises(ValueError, match="button is 9"):
        device.press(9)
    with pytest.raises(ValueError, match="position of a knob is 2"):
        device.turn(1, 2.0)


def test_presses_are_in_the_spec_of_a_device():
    device = open_simulated("?hand=slow&press=1@0s-3000s,2@0s-3000s", info())
    assert device.take_events() == [Button(1, pressed=True), Button(2, pressed=True)]
    with pytest.raises(InputError, match="no press"):
        open_simulated("?hand=slow&press=1@2s,now", info())
