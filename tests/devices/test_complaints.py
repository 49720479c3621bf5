"""What a device complains of, and its buttons."""

import re

import pytest

from tests.devices.bench import Bench
from vbraille.devices.base import Placing
from vbraille.devices.events import Back, Button, Placed, Silent, Unplugged, WatchdogTripped, told
from vbraille.devices.serial.wire import Encoder, Error, encode
from vbraille.errors import DeviceError


def test_an_error_ends_the_reading_and_a_notice_does_not():
    made = Bench()
    device = made.open()
    made.run(device, 5)
    made.say(made.controller.fault(255, "Clean the array."))
    made.say(encode(Error(254, "")))
    made.run(device, 3)
    assert told(device.take_events()) == ["device: Clean the array.", "device: notice 254"]
    made.say(made.controller.fault(3, "Too hot; let it cool."))
    with pytest.raises(DeviceError, match=r"^test: Too hot; let it cool\.$"):
        made.run(device, 1)
    device.close()
    assert not made.controller.levels.any() or made.controller.faulty


def test_a_fault_whose_error_was_lost_ends_the_reading():
    made = Bench()
    device = made.open()
    made.run(device, 5)
    made.controller.fault(1, "lost")
    with pytest.raises(DeviceError, match="test has a fault; switch it off and on"):
        made.run(device, 2)
    device.close()


def test_each_kind_of_notice_is_said_once_a_second_with_a_count():
    made = Bench()
    device = made.open()
    said = []
    for number in range(3000):
        made.say(encode(Error(200, f"Warm: {number}.")) + encode(Error(201, "Dusty.")))
        made.run(device, 1)
        said += told(device.take_events())
    assert len(said) == 6
    assert said[:2] == ["device: Warm: 0.", "device: Dusty."]
    assert re.fullmatch(
        r"device: Warm: (99\d|100\d)\. \(1?\d{3,4} times in the last second\)", said[2]
    )
    device.close()


def test_buttons_are_told_as_they_change():
    made = Bench()
    made.controller.buttons = 0b100  # held while the conversation begins: it is not pressed now
    device = made.open()
    made.run(device, 5)
    assert list(device.take_events()) == []
    made.controller.buttons = 0b001
    made.run(device, 5)
    made.controller.buttons = 0b011
    made.run(device, 5)
    assert list(device.take_events()) == [
        Button(1, pressed=True),
        Button(3, pressed=False),
        Button(2, pressed=True),
    ]
    made.unplug()
    made.run(device, 1)
    assert list(device.take_events()) == [
        Button(1, pressed=False),
        Button(2, pressed=False),
        Unplugged(),
    ]
    made.controller.buttons = 0b100  # held when it is plugged in: it is not pressed now
    made.plug()
    made.back(device)
    made.controller.buttons = 0
    made.run(device, 5)
    told = [event for event in device.take_events() if isinstance(event, Button)]
    assert told == [Button(3, pressed=False)]
    device.close()


def test_events_have_the_numbers():
    made = Bench(encoder=Encoder.INCREMENTAL)
    device = made.open()
    made.run(device, 5)
    device.set_zero()
    made.settle(device)
    assert list(device.take_events()) == [Placed(Placing.DONE)]
    made.mute = True
    made.run(device, 150)
    made.mute = False
    made.settle(device)
    silent, back = device.take_events()
    assert silent == Silent(pytest.approx(100.0))
    assert back == Back()
    made.us += 70_000
    made.controller.tick(made.us, 5.0)
    made.run(device, 5)
    assert list(device.take_events()) == [WatchdogTripped(0, "host")]
    device.close()
