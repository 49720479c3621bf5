"""A host of both versions of the protocol, beside devices of one."""

from dataclasses import replace

import numpy as np
import pytest

from tests.devices.bench import HALF, HOME_MM, Bench, shown
from tests.devices.firstversion import FirstVersion
from tests.engine.test_loop import info
from vbraille.devices.events import Button
from vbraille.devices.saying import told
from vbraille.devices.serial.transitions import Stage
from vbraille.devices.wire.codec import Decoder, enframe
from vbraille.devices.wire.messages import Frame, Hello
from vbraille.errors import DeviceError
from vbraille.simulation.firmware import Controller


class ThirdVersion(Controller):
    """Answers every HELLO with an INFO of version 3, of which nothing else can be known."""

    def receive(self, chunk, now_us):
        heard = [type(message) for message in Decoder().feed(chunk)]
        super().receive(chunk, now_us)
        return enframe(b"\x81\x03 whatever it may be") if Hello in heard else b""


class Fickle(Controller):
    """Answers a HELLO in the version that it was not greeted in."""

    def __init__(self, made):
        super().__init__(made)
        self.hellos = []

    def receive(self, chunk, now_us):
        said = b""
        for message in Decoder().feed(chunk):
            if isinstance(message, Hello):
                self.hellos.append(now_us)
                other = Controller(shown(version=3 - message.version))
                said += other.receive(b"\0", now_us) + other._take(message)
        return said


def hellos(made):
    return [message.version for message in made.sent if isinstance(message, Hello)]


@pytest.mark.parametrize("made_as", [Controller, FirstVersion])
def test_a_device_of_version_1_is_greeted_again_and_read_on_as_ever(made_as):
    made = Bench(made_as, version=1)
    device = made.open()
    assert hellos(made) == [2, 1]
    assert made.us < 50_000  # and it was not kept waiting
    assert device.display.axes == "x"
    assert device.particulars.protocol == "serial, version 1"
    made.settle(device)
    for way_mm in (0.0, 150.0, 300.0):
        made.way_mm = way_mm
        pose = made.run(device, 3)
        assert pose[1:] == pytest.approx((way_mm + HOME_MM, 0.0, 0.0))
    made.controller.buttons = 0b10
    made.run(device, 2)
    assert device.take_events() == [Button(2, pressed=True)]
    assert np.unique(made.controller.levels).tolist() == [512]
    device.close()
    made.pause(0.03)
    assert not np.any(made.controller.levels)
    assert device.counts()["watchdog trips"] == 0


def test_a_device_of_version_2_is_greeted_once():
    made = Bench()
    device = made.open()
    assert hellos(made) == [2]
    assert device.particulars.protocol == "serial, version 2"
    device.close()


@pytest.mark.parametrize(("before", "after"), [(1, 2), (2, 1)])
def test_a_device_that_comes_back_with_another_firmware_is_read_on(before, after):
    made = Bench(version=before)
    device = made.open()
    made.settle(device)
    assert made.come_back(device, version=after) == ["device: back"]
    made.settle(device)
    assert device.particulars.protocol == f"serial, version {after}"
    assert device.conversation.version == after
    device.close()


def test_a_device_of_version_1_that_restarts_is_greeted_in_both_again():
    made = Bench(FirstVersion)
    device = made.open()
    made.settle(device)
    made.controller = FirstVersion()
    made.sent.clear()
    made.run(device, 1000)
    assert hellos(made) == [2, 1]
    assert told(device.take_events()) == [
        "device: silent, and sent to rest; reading goes on once it speaks",
        "device: back",
    ]
    made.settle(device)
    device.close()


def test_a_firmware_of_the_future_is_one_sentence():
    made = Bench(ThirdVersion)
    with pytest.raises(DeviceError) as fault:
        made.open()
    assert str(fault.value) == (
        "the device at /dev/pts/bench speaks version 3 of the protocol and this vbraille "
        "versions 1 and 2; update the older of the two"
    )
    assert made.port.closed


def test_a_firmware_of_the_future_that_comes_back_is_one_sentence_and_is_told_nothing():
    made = Bench()
    device = made.open()
    made.settle(device)
    made.unplug()
    made.run(device, 1)
    made.us += 1_000_000
    made.controller = ThirdVersion(shown())
    made.plug()
    made.run(device, 300)
    assert told(device.take_events())[1:] == [
        "device: a device of version 3 of the protocol came back; plug in test again and "
        "reading goes on"
    ]
    assert device.conversation.stage is Stage.STRANGER
    made.sent.clear()
    made.run(device, 500)
    assert made.sent == []
    device.close()


def test_a_device_that_changes_its_mind_is_not_greeted_without_a_pause():
    made = Bench(Fickle)
    with pytest.raises(DeviceError, match="does not answer"):
        made.open()
    assert 10 <= len(made.controller.hellos) <= 30  # in 3 s


def test_what_a_late_answer_to_the_newer_hello_says_is_made_up_for():
    """It answers both HELLOs by an INFO of version 1, and takes the second for later."""

    class Slow(FirstVersion):
        def receive(self, chunk, now_us):
            said = super().receive(chunk, now_us)
            return said + (self._info() if self.hellos == [2] else b"")

    made = Bench(Slow)
    device = made.open()
    made.settle(device)
    assert hellos(made) == [2, 1]
    device.close()


def test_states_of_another_version_are_not_read():
    made = Bench(axes={"height_mm": 100.0})
    device = made.open()
    made.settle(device)
    other = Controller(replace(shown(version=1)))
    other.greeted = True
    made.run(device, 1)
    made.deaf = True
    missed = device.counts()["states missed"]
    for _ in range(20):
        made.put(other.tick(made.us, 100.0))
    assert made.run(device, 3).x_mm == pytest.approx(made.way_mm + HOME_MM)
    assert device.counts()["states missed"] == missed
    device.close()


def test_frames_are_the_same_in_both_versions():
    sent = []
    for version in (1, 2):
        made = Bench(version=version)
        device = made.begin(info(), options="")
        made.settle(device, HALF)
        sent.append([message.packed for message in made.sent if isinstance(message, Frame)][-1])
        device.close()
    assert sent[0] == sent[1]
