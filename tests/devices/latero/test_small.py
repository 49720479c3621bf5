"""A Latero's buttons, blades, arms and address, each by itself."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vbraille.carriers import latero
from vbraille.devices.events import Placing
from vbraille.devices.latero.conversation import ArmPlace, Blades, Debounced
from vbraille.devices.latero.device import LateroAddress, parse_latero_address
from vbraille.errors import InputError

MS = 1_000_000


def test_a_button_counts_after_5_ms_without_a_bounce():
    button = Debounced()
    readings = [(0, True), (1, False), (2, True), (4, True), (6, True)]
    assert not any(button.take(reading, ms * MS) for ms, reading in readings)
    assert button.take(True, 7 * MS)
    assert button.pressed
    assert not button.take(False, 8 * MS)
    assert not button.take(True, 9 * MS)
    assert not button.take(True, 99 * MS)
    assert not button.take(False, 100 * MS)
    assert button.take(False, 105 * MS)
    assert not button.pressed


def test_a_button_of_a_device_that_is_away_is_let_go():
    button = Debounced()
    button.take(True, 0)
    button.take(True, 5 * MS)
    assert button.let_go()
    assert not button.pressed
    assert not button.let_go()


@given(st.lists(st.floats(0, 1), min_size=64, max_size=64))
def test_levels_are_those_of_the_source(deflections):
    blades = Blades()
    frame = np.array(deflections).reshape(8, 8)
    blades.show(frame)
    assert blades.levels.max() <= 150
    assert np.abs(blades.levels.reshape(8, 8) - 150 * (1 - frame)).max() <= 0.5 + 1e-9
    assert bytes(blades.request[15:79]) == bytes(blades.levels) == bytes(blades.view)


def test_blade_8_row_plus_column_is_that_of_the_frame():
    frame = np.zeros((8, 8))
    frame[2, 5] = 1.0
    blades = Blades()
    blades.show(frame)
    assert np.flatnonzero(blades.levels != 150).tolist() == [21]
    assert blades.levels[21] == 0
    assert not blades.rests


def test_the_ramp_takes_20_ms_and_jumps_nowhere():
    blades = Blades()
    blades.show(np.linspace(0, 1, 64).reshape(8, 8))
    last = blades.levels.astype(int)
    blades.begin_ramp(0)
    for ms in range(1, 21):
        assert not blades.at_rest
        blades.ramp(ms * MS)
        step = blades.levels.astype(int) - last
        assert (step >= 0).all()
        assert step.max() <= 8
        last = blades.levels.astype(int)
    assert blades.at_rest
    assert (last == 150).all()


def test_a_late_step_of_the_ramp_is_no_jump():
    blades = Blades()
    blades.stand_at(bytes(64), 0)
    blades.ramp(500 * MS)
    assert blades.levels.max() == 15


def test_a_level_beyond_rest_is_taken_for_rest():
    blades = Blades()
    blades.stand_at(bytes((255,)) * 64, 0)
    blades.ramp(MS)
    assert blades.at_rest


def test_the_place_is_unknown_before_the_reset_is_shown():
    place = ArmPlace(None)
    assert place.placing is Placing.STOP
    place.set_zero()  # nothing is known of the encoders
    assert place.placing is Placing.STOP
    assert place.take((100, 200, 300, 0)) is None
    place.set_zero()
    assert place.placing is Placing.DONE
    assert place.take((100, 200, 300, 0)) == pytest.approx((0, 217.5, 0), abs=0.05)


@given(st.floats(0, 281), st.floats(0, 217.5), st.floats(-0.5, 0.5))
def test_a_place_comes_back_with_its_angle(x_mm, y_mm, theta_rad):
    offsets = (5, 0xFFFF_FFF0, 70_000)
    encoders = latero.encoders_of(latero.joints_at(x_mm, y_mm, theta_rad), offsets)
    found = ArmPlace(offsets).take((*encoders, 0))
    assert found == pytest.approx((x_mm, y_mm, theta_rad), abs=0.08)


def test_arms_that_cannot_be_there_are_to_be_shown_their_place_again():
    place = ArmPlace((0, 0, 0))
    assert place.take((0, 0, 0, 0)) is None
    assert place.placing is Placing.STOP


@pytest.mark.parametrize(
    ("text", "address"),
    [
        ("lab-7", LateroAddress("lab-7", 8900, None, 0, False)),
        ("10.0.0.2:9000", LateroAddress("10.0.0.2", 9000, None, 0, False)),
        ("a?offsets=1,-2,3", LateroAddress("a", 8900, (1, 0xFFFF_FFFE, 3), 0, False)),
        ("a?power=none", LateroAddress("a", 8900, None, None, True)),
        ("a?power=0x1F", LateroAddress("a", 8900, None, 31, True)),
        ("a?power=08", LateroAddress("a", 8900, None, 8, True)),
    ],
)
def test_an_address(text, address):
    assert parse_latero_address(text) == address


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("", "needs the name"),
        (":8900", "needs the name"),
        ("a b", "needs the name"),
        ("a:", "port is ''"),
        ("a:0", "port is '0'"),
        ("a:65536", "port is '65536'"),
        ("a:x", "port is 'x'"),
        ("a:000001234567", "port is '000001234567'"),
        ("a?offsets=1,2", "three whole numbers"),
        ("a?power=on", "register"),
        ("a?power=99999", "register"),
        ("a?baud=3", "no option 'baud'"),
    ],
)
def test_what_is_no_address_is_refused_in_a_sentence(text, why):
    with pytest.raises(InputError, match=why):
        parse_latero_address(text)
