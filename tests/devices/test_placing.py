"""Where the carriage is and when, as STATEs tell it, whatever the encoder."""

import numpy as np
import pytest

from tests.devices.bench import HOME_MM, Bench, shown
from vbraille.devices.base import Placing
from vbraille.devices.serial.wire import CountSign, Encoder
from vbraille.simulation.firmware import Controller


@pytest.mark.parametrize("sign", CountSign)
@pytest.mark.parametrize("encoder", Encoder)
def test_places_by_every_encoder(encoder, sign):
    # Eight bits more than the travel takes, and a stop near the wrap: it wraps at once.
    made = Bench(encoder=encoder, count_sign=sign, count_bits=17, left_stop_count=130_000)
    device = made.open()
    waiting = {Encoder.ABSOLUTE: Placing.DONE, Encoder.INDEX: Placing.MARK}
    assert device.placing is waiting.get(encoder, Placing.STOP)
    if encoder is not Encoder.ABSOLUTE:
        assert made.run(device, 20) is None
        assert made.controller.frames == 0
        if encoder is Encoder.INDEX:
            device.set_zero()  # of no meaning
            assert made.run(device, 5) is None
            made.way_mm = 15.0
        else:
            made.way_mm = 0.0
            made.run(device, 5)
            device.set_zero()
        made.run(device, 5)
    assert device.placing is Placing.DONE
    made.settle(device)
    for way_mm in (0.0, 0.005, 150.0, 300.0, 280.0, 60.0, 0.0):
        made.way_mm = way_mm
        assert made.run(device, 3).x_mm == pytest.approx(way_mm + HOME_MM)
    assert made.controller.frames > 10
    assert device.rested == 0
    device.close()


def test_a_count_of_eight_bits_goes_round_and_round():
    made = Bench(encoder=Encoder.INCREMENTAL, count_bits=8)
    made.way_mm = 0.0
    device = made.open()
    made.run(device, 3)
    device.set_zero()
    for way_mm in np.arange(0.0, 20.0, 0.5):
        made.way_mm = way_mm
        assert made.run(device, 2).x_mm == pytest.approx(way_mm + HOME_MM)
    device.close()


def test_an_index_that_is_lost_is_looked_for_again():
    made = Bench(encoder=Encoder.INDEX)
    device = made.open()
    made.run(device, 2)
    made.way_mm = 15.0
    assert made.run(device, 5) is not None
    made.controller.placed = False
    made.run(device, 1)
    assert device.placing is Placing.MARK
    device.close()


def test_time_goes_on_over_its_wrap():
    made = Bench()
    made.us = 2**32 - 10_000
    device = made.open()
    times = [made.run(device, 1).time_ns for _ in range(30)]
    assert np.diff(times).tolist() == [1_000_000] * 29
    device.close()


def test_the_newest_of_several_states_wins_and_gaps_are_counted():
    made = Bench()
    device = made.open()
    made.run(device, 5)
    for way_mm in (6.0, 7.0, 8.0):
        made.way_mm = way_mm
        made.pause(0.001)
    assert device.read().x_mm == pytest.approx(8.0 + HOME_MM)
    assert device.read() is None
    made.mute = True
    made.pause(0.007)
    made.mute = False
    made.run(device, 3)
    assert device.counts()["states missed"] == 7
    assert device.rested == 0
    device.close()


def test_a_state_that_is_old_or_comes_twice_is_dropped_and_counted():
    made = Bench()
    device = made.open()
    made.run(device, 5)
    made.way_mm = 6.0
    made.pause(0.001)
    old = bytes(made.up)
    made.way_mm = 7.0
    made.pause(0.001)
    assert device.read().x_mm == pytest.approx(7.0 + HOME_MM)
    made.put(old)
    assert device.read() is None
    made.put(old)
    made.pause(0.001)
    assert device.read().x_mm == pytest.approx(7.0 + HOME_MM)
    assert device.counts()["old states dropped"] == 2
    assert device.counts()["states missed"] == 0
    device.close()


def test_times_do_not_go_back_when_the_device_starts_anew():
    made = Bench()
    made.us = 5_000_000
    device = made.open()
    last = made.run(device, 5)
    made.unplug()
    made.run(device, 1)
    made.plug()
    made.controller = Controller(shown())
    begun_us = made.us
    tick, made.controller.tick = made.controller.tick, None
    made.controller.tick = lambda us, *at: tick(us - begun_us, *at)
    again = made.back(device)
    assert again.time_ns - last.time_ns == pytest.approx(made.us * 1000 - 5_005_000_000, abs=5e7)
    device.close()
