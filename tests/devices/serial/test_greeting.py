"""The greeting: who answers, and who does not; with a simulated controller in memory."""

import re

import pytest
from cobs import cobs

from tests.devices.bench import DOWN_BYTES, HOME_MM, Bench, shown
from tests.engine.test_loop import info
from vbraille.devices.base import Placing
from vbraille.devices.events import told
from vbraille.devices.serial.wire import Frame, Hello, Rest, encode, enframe
from vbraille.errors import DeviceError, InputError
from vbraille.simulation.firmware import Controller


def test_the_handshake():
    made = Bench()
    made.down += b"old"  # what another program left on the line
    heard = []

    def pause(seconds):
        if not heard:
            heard.append(made.put(b"\x07of an earlier conversation"))
        made.pause(seconds)

    with made.begin(info(), pause=pause) as device:
        assert made.controller.dropped == 1  # the zero ended what was old
        assert made.controller.greetings == 2  # the first INFO came behind what was old
        assert device.display == info()
        assert device.placing is Placing.DONE
        assert made.run(device, 50).x_mm == pytest.approx(5.0 + HOME_MM)
        assert made.controller.frames > 10
        assert made.kinds() == [Hello, Frame]
        assert sum(device.counts().values()) == 1
    made.pump()
    assert made.kinds()[-1] is Rest
    made.pause(0.03)
    assert made.controller.at_rest


def test_hello_is_said_every_250_ms_to_a_device_that_starts_slowly():
    made = Bench()
    made.deaf = True

    def pause(seconds):
        made.deaf = made.us < 1_100_000
        made.pause(seconds)

    device = made.begin(info(), pause=pause)
    assert made.sent == [Hello()] * 5
    # It answers all that waited: one INFO is a conversation, and the others are not.
    made.run(device, 20)
    assert device.rested == 0
    assert device.counts()["reconnections"] == 0
    device.close()


def test_nothing_answers():
    made = Bench()
    made.mute = True
    with pytest.raises(DeviceError, match=r"nothing answers at .*bench; see that the device is on"):
        made.open()
    assert 3_000_000 <= made.us <= 3_100_000
    assert made.sent == [Hello()] * 12
    assert made.port.closed


def test_it_answers_nonsense():
    made = Bench()
    made.deaf = True

    def pause(seconds):
        made.pause(seconds)
        made.receive()
        made.put(bytes(range(1, 9)) + b"\0")

    with pytest.raises(DeviceError, match=r"no vbraille device, or not set to 115200 baud"):
        made.begin(info(), pause=pause, options="?baud=115200")


def test_it_sends_but_does_not_hear():
    made = Bench()
    made.controller.greeted = made.deaf = True
    with pytest.raises(DeviceError, match=r"sends, but does not answer; .*check its cable"):
        made.open()


def test_it_speaks_another_version():
    made = Bench()
    made.deaf = True

    def pause(seconds):
        made.pause(seconds)
        made.put(enframe(b"\x81\x07whatever"))

    with pytest.raises(DeviceError, match=r"version 7 .* this vbraille version 2; update"):
        made.begin(info(), pause=pause)


def test_it_goes_away_in_the_handshake():
    made = Bench()
    made.deaf = True

    def pause(_seconds):
        made.us += 5000
        made.unplug()

    with pytest.raises(DeviceError, match=r"bench went away; plug the device in"):
        made.begin(info(), pause=pause)
    assert made.port.closed


def test_a_signal_passes_through_the_handshake():
    made = Bench()

    def interrupted(_seconds):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        made.begin(info(), pause=interrupted)
    assert made.port.closed


def test_a_line_too_slow_for_the_frames():
    made = Bench()
    with pytest.raises(
        InputError,
        match=r"115200 baud carry 137 frames a second .* 1000 are asked for; "
        r"choose ‹rate› 137 or less, or set the device and \?baud= to 921600",
    ):
        made.open("?baud=115200")
    made.open("?baud=115200", rate_hz=137.0).close()
    made.begin(None, options="?baud=300").close()
    # A pseudo-terminal has no baud rate unless one is given.
    made.open(rate_hz=2000.0).close()


def test_frames_that_are_too_far_apart_for_the_watchdog_are_refused():
    made = Bench()
    with pytest.raises(InputError, match="30 a second are asked for; choose ‹rate› 40 or more"):
        made.open(rate_hz=30.0)
    made.open(rate_hz=40.0).close()


@pytest.mark.parametrize(
    ("offset", "value", "said"),
    [
        (2, 0, "rows is 0; it must be 1 to 16"),
        (2, 200, "rows is 200; it must be 1 to 16"),
        (3, 65, "columns is 65; it must be 1 to 64"),
        (12, 7, r"rest_side is 7; it must be one of 0 \(LEFT\), 1 \(RIGHT\)"),
        (16, 0xFF, "rate_hz is 65512; it must be 50 to 10000 Hz"),
        (23, 3, "encoder is 3; it must be one of 0"),
        (28, 0, "count_sign is 0; it must be one of 1"),
        (29, 33, "count_bits is 33; it must be 8 to 32 bits"),
        (29, 16, "travel_um is 300000, which takes 60000 counts .* less than 32768, .*_bits 16"),
        (34, 0xFF, "it ends before its last field"),
        (35, 0, None),  # of a text, which is mended
        (-33, 2, "enabled are up to 2; they must be 0 to 1"),
        (-32, 9, "buttons is 9; it must be 0 to 8"),
        (-31, 5, "knobs is 5; it must be 0 to 4"),
        (-5, 0, "turn_sign is 0; it must be one of 1"),
    ],
)
def test_an_info_that_cannot_be_is_named_with_its_field_and_value(offset, value, said):
    made = Bench()
    body = bytearray(cobs.decode(encode(shown())[:-1])[:-4])
    body[offset] = value
    receive = made.controller.receive

    def answer(chunk, us):
        return receive(chunk, us).replace(encode(made.controller.info), enframe(bytes(body)))

    made.controller.receive = answer
    if said is None:
        made.open().close()
        return
    with pytest.raises(DeviceError, match=rf"bench says in its INFO what cannot be: {said}"):
        made.open()
    assert made.us < 100_000  # at once, and not when the time to answer is over
    made.controller.receive = receive
    device = made.open()
    made.run(device, 5)
    made.unplug()
    made.run(device, 1)
    made.controller = Controller(shown())
    receive = made.controller.receive
    made.controller.receive = answer
    made.plug()
    made.find()
    made.run(device, 1000)
    notes = told(device.take_events())
    assert len(notes) == 2
    assert re.match(rf"device: what came back says in its INFO what cannot be: {said}", notes[1])
    device.close()


@pytest.mark.no_cover
def test_an_info_that_nobody_asked_for_begins_nothing():
    made = Bench()
    device = made.open()
    made.settle(device)
    made.say(encode(shown()))
    made.run(device, 2)
    assert device.taking
    made.deaf = made.mute = True
    made.run(device, 300)
    made.room = 0  # nothing goes out any more
    made.run(device, 600)
    made.mute = False
    made.say(encode(shown()))
    made.run(device, 2)
    assert device.counts()["reconnections"] == 0
    made.deaf = False
    made.room = DOWN_BYTES
    made.run(device, 300)
    assert device.counts()["reconnections"] == 1
    device.close()
