"""What was found of actuators, what is sent for it, and that nothing jumps."""

import os

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tiers import examples
from vbraille.devices import calibrations
from vbraille.devices.base import Device, Particulars
from vbraille.devices.calibration import Calibration, Correction, Tried, correction_for
from vbraille.devices.calibrations import parse
from vbraille.display import Display
from vbraille.errors import DeviceError, InputError
from vbraille.simulation.simulated import SimulatedDevice

SHAPE = 2, 3
DISPLAY = Display("bench", 2, 3, 1.2, 1.4)
FRAMES = 20
TRIED = st.builds(
    Tried,
    st.integers(0, 1),
    st.integers(0, 2),
    st.sampled_from(["ok", "weak", "dead"]),
    st.booleans(),
    st.integers(1, 20).map(lambda steps: steps / 20),
)
FOUND = st.lists(TRIED, unique_by=lambda one: one.place).map(
    lambda tried: Calibration("bench", *SHAPE, tuple(tried))
)
DEFLECTIONS = st.lists(st.floats(0, 1), min_size=6, max_size=6).map(
    lambda values: np.reshape(values, SHAPE)
)


def settled(correction, rested=0):
    for _ in range(FRAMES):
        correction.of(np.zeros(SHAPE), rested)
    assert not correction.moving
    return correction


@examples(100)
@given(FOUND, DEFLECTIONS)
def test_actuators_are_sent_what_makes_up_for_them(found, frame):
    correction = Correction(SHAPE, FRAMES)
    correction.aim(found)
    sent = settled(correction).of(frame, 0)
    for (row, column), wanted in np.ndenumerate(frame):
        one = found.of((row, column)) or Tried(row, column)
        if one.state == "dead":
            assert sent[row, column] == 0
        else:
            swing = one.gain * wanted
            assert sent[row, column] == pytest.approx(1 - swing if one.inverted else swing)


@examples(60)
@given(st.lists(FOUND, min_size=1, max_size=4), DEFLECTIONS, st.data())
def test_no_change_of_what_is_made_up_for_jumps(several, frame, data):
    correction, rested = Correction(SHAPE, FRAMES), 0
    before = np.array(correction.of(frame, 0))
    for found in several:
        correction.aim(found)
        for _ in range(data.draw(st.integers(1, 2 * FRAMES))):
            now = np.array(correction.of(frame, rested))
            assert np.all((now >= 0) & (now <= 1))
            # Scale and offset may change by 2 and by 1 in all, against each other.
            assert np.abs(now - before).max() <= 2 / FRAMES + 1e-9
            before = now


@examples(30)
@given(FOUND)
def test_after_a_rest_inverted_actuators_set_out_from_where_the_device_rests(found):
    correction = Correction(SHAPE, FRAMES)
    correction.aim(found)
    settled(correction)
    first = correction.of(np.zeros(SHAPE), 1)
    assert first.max() <= 1 / FRAMES
    at_rest = settled(correction, 1).of(np.zeros(SHAPE), 1)
    assert at_rest.tolist() == (found.scale() < 0).astype(float).tolist()
    correction.leave()
    assert settled(correction, 1).of(np.zeros(SHAPE), 1).max() == 0
    # Something to feel has it go on as before.
    felt = np.full(SHAPE, 0.5)
    for _ in range(FRAMES):
        correction.leave() if not correction.moving else None
        sent = correction.of(felt, 1)
    for _ in range(FRAMES):
        sent = correction.of(felt, 1)
    assert sent == pytest.approx(found.scale() * 0.5 + (found.scale() < 0))


def test_a_slow_actuator_is_given_time_to_turn():
    assert correction_for(SHAPE, 1000.0)._step == pytest.approx(1 / 100)
    assert correction_for(SHAPE, 1000.0, slew_per_s=2.0)._step == pytest.approx(1 / 500)


def test_a_device_sends_what_is_corrected_and_none_is_told_otherwise():
    device = SimulatedDevice(DISPLAY, lambda: 0)
    device.correct(Calibration("bench", *SHAPE, (Tried(0, 0, "dead"), Tried(1, 2, gain=0.5))))
    frame = np.full(SHAPE, 0.8)
    for _ in range(200):
        device.write(frame)
    assert device.levels.tolist() == [[0, 818, 818], [818, 818, 409]]
    assert frame.tolist() == np.full(SHAPE, 0.8).tolist()
    device.correct(None)
    for _ in range(200):
        device.write(frame)
    assert device.levels.tolist() == np.full(SHAPE, 818).tolist()
    assert device.calibration is None


def test_inverted_actuators_go_back_before_a_device_is_left():
    device = SimulatedDevice(DISPLAY, lambda: 0)
    assert not device.uncorrect()
    device.correct(Calibration("bench", *SHAPE, (Tried(0, 1, inverted=True),)))
    rest, seen = np.zeros(SHAPE), []
    for _ in range(150):
        device.write(rest)
    assert device.levels[0, 1] == 1023
    while device.uncorrect():
        device.write(rest)
        seen.append(int(device.levels[0, 1]))
    assert len(seen) == 100
    assert seen == sorted(seen, reverse=True)
    assert seen[-1] == 0


def test_one_actuator_that_is_felt_brings_inverted_ones_back_to_their_own_rest():
    correction = Correction(SHAPE, FRAMES)
    correction.aim(Calibration("bench", *SHAPE, (Tried(0, 1, inverted=True),)))
    settled(correction)
    correction.leave()
    settled(correction)
    felt = np.zeros(SHAPE)
    felt[1, 2] = 0.5
    for _ in range(FRAMES):
        sent = correction.of(felt, 0)
    assert sent[0, 1] == 1.0
    assert sent[1, 2] == 0.5


def test_a_driver_that_writes_by_itself_is_not_corrected():
    class Writer(SimulatedDevice):
        def write(self, frame):
            self._send(frame)

    with pytest.raises(DeviceError, match="has a write of its own"):
        Writer(DISPLAY, lambda: 0).correct(Calibration("bench", *SHAPE))


class WithOwn(SimulatedDevice):
    particulars = Particulars("1", "absolute", 0.0, disabled=((0, 0),), inverted=())


def test_what_a_device_makes_up_for_goes_before_what_a_host_found(tmp_path):
    settings = tmp_path / "settings.toml"
    calibrations.save(settings, Calibration("bench", *SHAPE, (Tried(0, 1, "dead"),)))
    assert calibrations.correct_by_kept(settings, WithOwn(DISPLAY, lambda: 0)) is None
    device = SimulatedDevice(DISPLAY, lambda: 0)
    found = calibrations.correct_by_kept(settings, device)
    assert found is not None
    assert device.calibration == found


@examples(60)
@given(FOUND, st.text(st.characters(blacklist_categories=["Cc", "Cs", "Zl", "Zp"]), min_size=1))
def test_a_file_says_what_was_found(found, name):
    if not name.isprintable():
        return
    named = Calibration(name, found.rows, found.columns, found.tried)
    assert parse(calibrations.to_toml(named), "file") == named


def test_a_file_is_on_the_disk_before_it_has_its_name(tmp_path, monkeypatch):
    synced, real = [], os.fsync

    def sync(descriptor):
        synced.append(path.exists())
        real(descriptor)

    monkeypatch.setattr(os, "fsync", sync)
    path = calibrations.path_of(tmp_path / "settings.toml", "bench")
    calibrations.save(tmp_path / "settings.toml", Calibration("bench", *SHAPE))
    assert path.exists()
    assert synced[0] is False
    assert synced[-1] is True  # and then its folder


def test_each_device_has_a_file_of_its_own(tmp_path):
    settings = tmp_path / "settings.toml"
    names = ["STReSS²", "STReSS", "stress²", "STReSS² 0042", "a/b", "../x"]
    paths = {calibrations.path_of(settings, name) for name in names}
    assert len(paths) == len(names)
    assert {path.parent for path in paths} == {tmp_path}


def test_a_device_is_known_by_its_serial_number():
    device: Device = SimulatedDevice(DISPLAY, lambda: 0)
    assert calibrations.name_of(device) == "bench"
    device.serial_number = "0042"
    assert calibrations.name_of(device) == "bench 0042"


def test_actuators_that_are_not_there_or_there_twice_are_refused():
    with pytest.raises(ValueError, match="row 3, column 1 is not in an array of 2 × 3"):
        Calibration("bench", *SHAPE, (Tried(2, 0),))
    with pytest.raises(ValueError, match="there twice"):
        Calibration("bench", *SHAPE, (Tried(1, 0), Tried(1, 0, "dead")))
    with pytest.raises(ValueError, match=r"gain is 0; it must be 0\.05 to 1"):
        Tried(0, 0, gain=0)
    with pytest.raises(InputError, match="row is 17"):
        parse('device = "x"\nrows = 20\ncolumns = 2\n[[actuator]]\nrow = 17\ncolumn = 1', "file")


def test_what_a_session_keeps_of_it():
    found = Calibration("bench", *SHAPE, (Tried(0, 0, "weak", True, 0.5), Tried(1, 1, "dead")))
    assert found.to_json() == {
        "device": "bench",
        "tried": 2,
        "actuators": 6,
        "scale": [[-0.5, 1.0, 1.0], [1.0, 0.0, 1.0]],
        "dead": [[1, 1]],
        "weak": [[0, 0]],
    }
