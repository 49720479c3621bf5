"""Devices that speak another version of the protocol: one sentence, and nothing more is said."""

import pytest

from tests.devices.bench import Bench, shown
from vbraille.devices.events import told
from vbraille.devices.serial.conversation import Stage
from vbraille.devices.serial.wire import Decoder, Hello, enframe
from vbraille.errors import DeviceError
from vbraille.simulation.firmware import Controller


class OtherVersion(Controller):
    """Answers every HELLO with an INFO of another version, of which nothing else can be known."""

    version = 3

    def receive(self, chunk, now_us):
        heard = [type(message) for message in Decoder().feed(chunk)]
        super().receive(chunk, now_us)
        return enframe(bytes((0x81, self.version)) + b" and more") if Hello in heard else b""


class Older(OtherVersion):
    version = 1


class Fickle(Controller):
    """Answers the first HELLO with an INFO of another version, and later ones with its own."""

    greeted_once = False

    def receive(self, chunk, now_us):
        if Hello() in Decoder().feed(chunk) and not self.greeted_once:
            self.greeted_once = True
            return enframe(b"\x81\x01")
        return super().receive(chunk, now_us)


def test_a_device_is_greeted_once():
    made = Bench()
    device = made.open()
    assert [message for message in made.sent if isinstance(message, Hello)] == [Hello(2)]
    assert device.particulars.protocol == "serial, version 2"
    device.close()


@pytest.mark.parametrize("made_as", [Older, OtherVersion, Fickle])
def test_a_firmware_of_another_version_is_one_sentence(made_as):
    made = Bench(made_as)
    with pytest.raises(DeviceError) as fault:
        made.open()
    version = getattr(made_as, "version", 1)
    assert str(fault.value) == (
        f"the device at /dev/pts/bench speaks version {version} of the protocol and this vbraille "
        f"version 2; update the older of the two"
    )
    assert made.port.closed


@pytest.mark.parametrize("made_as", [Older, OtherVersion])
def test_one_that_comes_back_is_one_sentence_and_is_told_nothing(made_as):
    made = Bench()
    device = made.open()
    made.settle(device)
    made.unplug()
    made.run(device, 1)
    made.us += 1_000_000
    made.controller = made_as(shown())
    made.plug()
    made.run(device, 300)
    assert told(device.take_events())[1:] == [
        f"device: a device of version {made_as.version} of the protocol came back, and this "
        f"vbraille speaks version 2; plug in test again and reading goes on"
    ]
    assert device.conversation.stage is Stage.STRANGER
    made.sent.clear()
    made.run(device, 500)
    assert made.sent == []
    device.close()


def test_states_of_another_version_are_not_read():
    made = Bench()
    device = made.open()
    made.settle(device)
    pose = made.run(device, 1)
    dropped = device.counts()["unknown type"]
    for _ in range(20):
        made.put(enframe(b"\x82" + bytes(16)))
    assert made.run(device, 3).x_mm == pytest.approx(pose.x_mm)
    assert device.counts()["unknown type"] == dropped + 20
    device.close()
