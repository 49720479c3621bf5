"""Buttons and knobs of a device, from its driver in the host process to the reader."""

import select
import time

from tests import drivers
from tests.engine.test_loop import info
from vbraille.devices.events import Button, Knob
from vbraille.engine.host import Host
from vbraille.testing import simulated_controller

PATIENCE_S = 60.0
_MODULE = '''
from vbraille.simulation.simulated import SimulatedDevice

class Knobbed(SimulatedDevice):
    """Has a knob, which is turned up and a little back, and a button."""

    def __init__(self, _address, wanted):
        super().__init__(wanted)

    def _send(self, frame):
        super()._send(frame)
        if 200 <= self.frames < 400:
            self.turn(1, (self.frames - 200) / 200)
        if self.frames == 400:
            self.turn(1, 0.123)
            self.press(3)
            self.let_go(3)
'''


def heard(host, enough):
    """Events until there are enough."""
    events = []
    end = time.monotonic() + PATIENCE_S
    while not enough(events):
        assert time.monotonic() < end, events
        host.poll()
        events += host.take_events()
        select.select([], [], [], 0.002)
    return events


def test_knobs_and_buttons_of_a_driver_reach_the_reader(tmp_path, monkeypatch):
    environment = drivers.install(tmp_path, "knobbed", "Knobbed", _MODULE)
    monkeypatch.setenv("PYTHONPATH", environment["PYTHONPATH"])
    with Host("knobbed:", info(), 26) as host:
        events = heard(host, lambda told: Knob(1, 0.123) in told and len(buttons(told)) == 2)
    values = [event.value for event in events if isinstance(event, Knob)]
    assert values[:-1] == sorted(values[:-1])
    assert values[-1] == 0.123
    assert 5 <= len(values) <= 60  # of 201 turns
    assert buttons(events) == [Button(3, pressed=True), Button(3, pressed=False)]


def test_buttons_on_the_wire_reach_the_reader_while_ticks_are_compiled():
    with (
        simulated_controller(info(), presses=["1@0.3s-0.5s", "8@0.4s"]) as spec,
        Host(spec, info(), 26) as host,
    ):
        events = heard(host, lambda told: len(buttons(told)) == 4)
        assert buttons(events) == [
            Button(1, pressed=True),
            Button(8, pressed=True),
            Button(1, pressed=False),
            Button(8, pressed=False),
        ]


def buttons(events):
    return [event for event in events if isinstance(event, Button)]
