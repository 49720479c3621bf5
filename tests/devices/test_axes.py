"""Two axes, the angle and knobs, as STATEs tell them."""

import math

import pytest

from tests.devices.bench import HALF, HOME_MM, Bench
from vbraille.devices.base import Placing
from vbraille.devices.events import Knob, told
from vbraille.devices.serial.hardware import turned
from vbraille.devices.serial.wire import CountSign, Encoder, TurnSign, YCountSign
from vbraille.errors import DeviceError

PLANE = {"height_mm": 200.0, "turns": True, "contactor_mm": (0.5, 1.4)}


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("encoder", Encoder)
def test_places_by_every_encoder(encoder, sign):
    made = Bench(
        encoder=encoder,
        axes=PLANE,
        count_sign=CountSign(sign),
        y_count_sign=YCountSign(-sign),
        turn_sign=TurnSign(sign),
        count_bits=17,
        far_stop_count=131_000,
        y_counts_per_m=100_000,
        counts_per_turn=3601,
        straight_count=3590,
    )
    made.y_mm = 40.0
    device = made.open()
    if encoder is not Encoder.ABSOLUTE:
        assert made.run(device, 20) is None
        made.way_mm = 15.0
        if encoder is Encoder.INCREMENTAL:
            made.way_mm = made.y_mm = 0.0
            made.run(device, 5)
            device.set_zero()
        made.run(device, 5)
    assert device.placing is Placing.DONE
    made.settle(device)
    step_rad = 2 * math.pi / 3601
    for way_mm, y_mm, turn in ((0, 0, 0), (20, 40, 0.5), (300, 200, -1.2), (100, 90, 3.0)):
        made.way_mm, made.y_mm, made.theta_rad = way_mm, y_mm, turn
        pose = made.run(device, 3)
        assert pose.x_mm == pytest.approx(way_mm + HOME_MM)
        assert pose.y_mm == pytest.approx(y_mm, abs=0.01)
        assert pose.theta_rad == pytest.approx(turn, abs=step_rad)
    device.close()


def test_a_display_with_all_that_there_is():
    made = Bench(axes=PLANE)
    with made.open() as device:
        display, particulars = device.display, device.particulars
    assert (display.axes, display.height_mm, display.contactor_mm) == ("xyθ", 200.0, (0.5, 1.4))
    assert (particulars.buttons, particulars.knobs) == (8, 4)


@pytest.mark.parametrize("axes", [{}, {"height_mm": 200.0}, {"turns": True}])
def test_an_axis_that_is_not_there_says_nothing(axes):
    made = Bench(axes=axes)
    made.y_mm, made.theta_rad = 50.0, 0.25
    device = made.open()
    made.settle(device)
    pose = made.run(device, 3)
    assert pose.y_mm == pytest.approx(50.0 if "height_mm" in axes else 0.0)
    assert pose.theta_rad == pytest.approx(0.25 if "turns" in axes else 0.0, abs=1e-3)
    device.close()


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"y_counts_per_m": 0}, "height_um is 200000, and y_counts_per_m is 0"),
        ({"y_counts_per_m": 80_000_000}, "height_um is 200000, which takes 16000000 counts"),
    ],
)
def test_an_axis_that_cannot_be_counted_is_one_sentence(changes, said):
    with pytest.raises(DeviceError, match=said):
        Bench(axes=PLANE, count_bits=24, **changes).open()


@pytest.mark.parametrize(
    ("axes", "said"),
    [
        ({"height_mm": 100.0, "turns": True}, "way across the lines 100 mm, not 200 mm"),
        ({"height_mm": 200.0}, "measured angles no, not yes"),
    ],
)
def test_another_surface_cannot_take_its_place(axes, said):
    made = Bench(axes=PLANE)
    device = made.open()
    made.settle(device)
    (sentence,) = made.come_back(device, axes=axes)
    assert sentence.startswith("device: another test came back (")
    assert said in sentence
    device.close()


def test_what_has_changed_of_the_axes_is_said():
    made = Bench(axes=PLANE)
    device = made.open()
    made.settle(device)
    (sentence, back) = made.come_back(
        device,
        axes=PLANE,
        y_counts_per_m=100_000,
        y_count_sign=YCountSign.AWAY,
        turn_sign=TurnSign.CLOCKWISE,
        counts_per_turn=4096,
        far_stop_count=7,
        straight_count=9,
    )
    assert back == "device: back"
    assert sentence == (
        "device: changed, for a count across the lines is 10 µm, not 5 µm, its counts across the "
        "lines grow away from the reader, a turn of its array is 4096 counts, not 65536, its "
        "counts grow as it turns with the clock, its far stop is at count 7, not 16757216, its "
        "array is straight at count 9, not 0"
    )
    device.close()


def knobs_of(device):
    return [event for event in device.take_events() if isinstance(event, Knob)]


def test_a_knob_that_is_turned_is_told_and_one_that_jitters_is_not():
    made = Bench()
    made.controller.knobs[:] = [0.5] * 4
    device = made.open()
    made.settle(device)
    assert knobs_of(device) == []
    for step in range(100):  # by two counts, which no hand does
        made.controller.knobs[1] = (128 + step % 3) / 255
        made.run(device, 25)
    assert knobs_of(device) == []
    made.controller.knobs[1] = 0.8
    made.run(device, 3)
    assert knobs_of(device) == [Knob(2, 204 / 255)]
    made.controller.knobs[1] = 0.2
    made.controller.knobs[3] = 1.0
    made.run(device, 30)
    assert sorted(knobs_of(device), key=lambda knob: knob.number) == [
        Knob(2, 51 / 255),
        Knob(4, 1.0),
    ]
    device.close()


def test_knobs_and_buttons_that_are_not_there_are_not_read():
    made = Bench(buttons=2, knobs=1)
    device = made.open()
    made.settle(device)
    made.controller.knobs = [0.0, 1.0, 1.0, 1.0]
    made.controller.buttons = 0b1111_1100
    made.run(device, 3)
    assert device.take_events() == []
    device.close()


def test_a_knob_that_was_turned_while_the_device_was_away_stands_where_it_was_left():
    made = Bench()
    device = made.open()
    made.settle(device)
    before = made.controller
    made.unplug()
    made.run(device, 1)
    before.hang_up()
    before.knobs[0] = 0.6
    made.us += 1_000_000
    made.plug()
    made.run(device, 300)
    events = device.take_events()
    assert [event for event in events if isinstance(event, Knob)] == [Knob(1, 153 / 255)]
    assert told(events)[-1] == "device: back"
    device.close()


@pytest.mark.parametrize(
    ("before", "now", "told_of"),
    [(100, 102, False), (100, 103, True), (254, 255, True), (255, 254, False), (1, 0, True)],
)
def test_when_a_knob_was_turned(before, now, told_of):
    assert turned(before, now) is told_of


def test_a_hand_on_two_axes_is_felt_while_it_goes():
    made = Bench(axes=PLANE)
    device = made.open()
    made.settle(device)
    for step in range(100):
        made.way_mm, made.y_mm = 3.0 * step, 2.0 * step
        assert made.run(device, 1, HALF) is not None
    assert made.controller.frames > 100
    assert device.rested == 0
    device.close()
