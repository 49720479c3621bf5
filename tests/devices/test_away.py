"""Devices that fall silent, go away, and come back the same, changed, or as another one."""

import pytest

from tests.devices.bench import AWAY, HOME_MM, Bench, shown
from vbraille.devices.base import Placing
from vbraille.devices.events import told
from vbraille.devices.serial.wire import (
    CountSign,
    Encoder,
    Error,
    Frame,
    Hello,
    Rest,
    State,
    Watchdog,
    encode,
    enframe,
)
from vbraille.simulation.firmware import Controller


def test_silence_of_100_ms_brings_rest_and_less_than_500_ms_goes_on():
    made = Bench(encoder=Encoder.INCREMENTAL)
    device = made.open()
    made.run(device, 5)
    device.set_zero()
    made.settle(device)
    made.mute = True
    made.kinds()
    made.run(device, 99)
    assert made.kinds() == [Frame]
    assert told(device.take_events()) == []
    made.run(device, 20)
    assert made.kinds() == [Frame, Rest]
    assert told(device.take_events()) == [
        "device: silent, and sent to rest; reading goes on once it speaks"
    ]
    assert device.rested == 0
    made.run(device, 300)
    assert made.kinds() == []
    assert made.controller.at_rest
    made.mute = False
    made.way_mm = 8.0
    # The encoder has kept count, and needs no zero again.
    assert made.run(device, 50).x_mm == pytest.approx(3.0 + HOME_MM)
    assert made.kinds() == [Frame]
    assert device.rested == 1
    assert told(device.take_events()) == ["device: back"]
    assert device.placing is Placing.DONE
    assert device.counts()["frames not sent"] == 0
    assert device.counts()["reconnections"] == 0
    assert device.counts()["watchdog trips"] == 0
    device.close()


def test_silence_of_500_ms_begins_a_new_conversation():
    made = Bench(encoder=Encoder.INCREMENTAL)
    device = made.open()
    made.run(device, 5)
    device.set_zero()
    made.settle(device)
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
    notes = told(device.take_events())
    assert [note[:14] for note in notes] == ["device: silent", "device: back"]
    assert device.counts()["reconnections"] == 1
    device.set_zero()
    assert made.run(device, 5).x_mm == pytest.approx(HOME_MM)
    device.close()


def test_another_device_in_its_place_is_left_alone():
    made = Bench()
    device = made.open()
    made.run(device, 5)
    made.unplug()
    made.run(device, 1)
    made.controller = Controller(shown(name="Other", row_pitch_nm=2_000_000))
    made.plug()
    made.find()
    made.run(device, 1000)
    assert told(device.take_events()) == [
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
    assert told(device.take_events()) == ["device: back"]
    device.close()


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
def test_what_is_otherwise_with_a_device_that_came_back_is_said_and_minded(changes, said):
    made = Bench()
    device = made.open()
    made.run(device, 5)
    notes = made.come_back(device, **changes)
    if said is None:
        assert notes == ["device: back"]
    else:
        assert notes[0].startswith(f"device: changed, for {said}")
        assert notes[1:] == ["device: back"]
    # What hung on it is as the device is now.
    if "encoder" in changes:
        assert "its place must be shown again" in notes[0]
        assert device.placing is Placing.STOP
        made.way_mm = 0.0
        made.run(device, 3)
        device.set_zero()
    for way_mm in (0.0, 7.0, 30.0):
        made.way_mm = way_mm
        assert made.run(device, 3).x_mm == pytest.approx(way_mm + HOME_MM)
    made.run(device, 300)
    levels = made.controller.levels.tolist()
    assert levels[0] == {"gain": 257, "enabled": 0, "inverted": 511}.get(next(iter(changes)), 512)
    # The next time it is the same again.
    assert made.come_back(device, **changes) == ["device: back"]
    device.close()


def test_a_stranger_of_the_same_name_is_told_by_what_is_otherwise():
    made = Bench()
    device = made.open()
    made.run(device, 5)
    assert made.come_back(device, travel_um=200_000, rate_hz=500) == [
        "device: another test came back (travel 200 mm, not 300 mm, rate 500 Hz, not 1000 Hz); "
        "plug in the one that reading began on, or set this one as that was, and reading goes on"
    ]
    assert made.controller.frames == 0
    device.close()


def test_another_version_in_its_place_is_left_alone():
    made = Bench()
    device = made.open()
    made.run(device, 5)
    made.controller = Controller(shown())
    made.mute = True
    made.run(device, 510)
    made.put(enframe(b"\x81\x03"))
    made.run(device, 2)
    assert (
        "a device of version 3 of the protocol came back, and this vbraille speaks version 2"
        in told(device.take_events())[-1]
    )
    device.close()


def test_what_is_left_of_an_earlier_conversation_is_dropped():
    made = Bench()
    device = made.open()
    made.run(device, 5)
    made.mute = True
    made.run(device, 600)
    made.mute = False
    made.deaf = True
    sent = State(1, 2, 3, 4, 0, 0, None, 5, 6, 7), Watchdog(99, 0), Error(3, "old")
    made.put(b"".join(map(encode, sent)))
    assert made.run(device, 3) is None
    device.close()
