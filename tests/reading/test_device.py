"""A device that is open to be read on, as a program sees it."""

from vbraille.devices.events import Button, Knob
from vbraille.engine.clock import ManualClock
from vbraille.reading.device import OpenDevice
from vbraille.render import STRESS2
from vbraille.testing import simulated_device


def test_each_poll_gives_the_buttons_and_knobs_since_the_last_and_says_nothing_of_them():
    clock, said = ManualClock(), []
    device = simulated_device(clock=clock)
    with OpenDevice(device, STRESS2.display, clock=clock, say=said.append) as opened:
        opened.start(STRESS2)
        assert opened.poll() == []
        device.press(1)
        device.turn(2, 0.75)
        assert opened.poll() == [Button(1, pressed=True), Knob(2, 0.75)]
        device.let_go(1)
        assert opened.poll() == [Button(1, pressed=False)]
        assert opened.poll() == []
    assert said == []
