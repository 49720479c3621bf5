"""The simulated controller, rule by rule of the protocol's page; no test waits for its clock."""

import math
from dataclasses import replace

import numpy as np
import pytest

from tests.packing import packed as packed_levels
from tests.simulation.controlled import INFO, REST, SWING, TOP, Bench, packed, without_states
from vbraille.devices.serial.wire import (
    DELIMITER,
    FAULTY,
    PLACED,
    RESTING,
    CountSign,
    Decoder,
    Encoder,
    Error,
    ErrorCode,
    Frame,
    Hello,
    OtherVersion,
    RestSide,
    State,
    Watchdog,
    encode,
    enframe,
)
from vbraille.display import Display
from vbraille.simulation.firmware import MARK_MM, Controller, describe


def test_before_hello_it_is_silent_and_at_rest(bench):
    assert bench.frame() == []
    assert bench.tick(100) == []
    assert bench.controller.fault(ErrorCode.OTHER, "Broken.") == b""
    assert (bench.levels, bench.controller.at_rest) == (REST, True)
    assert (bench.controller.frames, bench.controller.dropped) == (0, 0)
    assert not bench.controller.greeted


def test_it_answers_hello_and_then_says_where_it_is(bench):
    assert bench.send(Hello()) == [bench.controller.info, Watchdog(trips=0, dropped=0)]
    assert bench.controller.greeted
    assert [type(message) for message in bench.tick(5)] == [State] * 5


def test_hello_in_any_chunks(bench):
    heard = []
    for byte in DELIMITER + encode(Hello()):
        heard += bench.send_bytes(bytes((byte,)))
    assert heard == [bench.controller.info, Watchdog(0, 0)]


def test_another_version_is_told_this_one_and_nothing_else(greeted):
    greeted.show()
    assert greeted.send(Hello(version=7)) == [greeted.controller.info, Watchdog(0, 0)]
    assert greeted.tick(30) == []
    assert greeted.frame() == []
    assert (greeted.levels, greeted.controller.frames) == (REST, 2)
    assert greeted.send(Hello()) == [greeted.controller.info, Watchdog(0, 0)]
    assert greeted.state().resting


def test_a_frame_is_where_the_actuators_stand(greeted):
    assert greeted.show() == []
    assert greeted.levels == SWING
    assert greeted.controller.levels.dtype == np.uint16
    assert not greeted.controller.at_rest
    assert greeted.controller.frames == 2
    assert greeted.controller.last_frame_us == greeted.now_us


def test_of_several_frames_the_last_is_shown(greeted):
    greeted.show()
    greeted.send(*(Frame(n, packed([n] * 6)) for n in (7, 8, 9)))
    greeted.tick(4)
    assert greeted.levels == [9] * 6
    assert greeted.controller.frames == 5
    assert greeted.state().frame_sequence == 9


@pytest.mark.parametrize(
    "line",
    [
        encode(Frame(1, packed(SWING) + b"\0")),
        encode(Frame(1, packed(SWING)[:-1])),
        encode(Frame(1, packed_levels([TOP + 1] * 6, 1023))),
        encode(Frame(1, packed(SWING)))[:-3] + b"\x55\x55\0",
        enframe(b"\x02\x01\x00"),
        enframe(b"\x7f"),
        enframe(b"\x01\x00"),
        encode(Watchdog(1, 1)),
        encode(INFO),
        enframe(b"\x81\x01"),
        b"\xff\1\0",
        b"\1" * 5000 + b"\0",
    ],
)
def test_what_does_not_fit_is_dropped_and_counted(greeted, line):
    assert greeted.send_bytes(line) == []
    assert (greeted.levels, greeted.controller.frames, greeted.controller.dropped) == (REST, 0, 1)
    assert greeted.send(Hello()) == [greeted.controller.info, Watchdog(trips=0, dropped=1)]


def test_it_says_another_version_s_info_is_another_s():
    assert Decoder().feed(enframe(b"\x81\x09")) == [OtherVersion(9)]  # one of the lines above


def test_an_error_rests_it_until_hello(greeted):
    greeted.show()
    greeted.tick(10)
    said = greeted.controller.fault(ErrorCode.TEMPERATURE, "Too hot; let it cool.")
    assert greeted.decoder.feed(said) == [Error(ErrorCode.TEMPERATURE, "Too hot; let it cool.")]
    assert greeted.state().flags == PLACED | RESTING | FAULTY
    greeted.tick(18)
    assert not greeted.controller.at_rest
    greeted.tick()
    assert greeted.levels == REST
    greeted.show()
    assert (greeted.levels, greeted.controller.frames) == (REST, 2)
    assert greeted.controller.dropped == 0
    assert without_states(greeted.tick(100)) == []
    greeted.send(Hello())
    greeted.show()
    assert greeted.levels == SWING
    assert greeted.state().flags == PLACED


def test_a_notice_changes_nothing(greeted):
    greeted.show()
    said = greeted.controller.fault(ErrorCode.NOTICE, "Lamp off.")
    assert greeted.decoder.feed(said) == [Error(ErrorCode.NOTICE, "Lamp off.")]
    assert greeted.state().flags == PLACED
    assert greeted.levels == SWING


def test_states_count_on_whoever_hears_them(bench):
    bench.tick(3)
    bench.send(Hello())
    first = bench.state()
    assert first.sequence == 5
    bench.controller.skip(10)
    assert bench.state().sequence == 16
    bench.controller.skip(0xFFFF - 16)
    assert [state.sequence for state in bench.tick(2)] == [0, 1]


def test_a_state_is_of_its_time_and_place():
    bench = Bench(now_us=(1 << 32) - 2000)
    bench.send(Hello())
    bench.controller.buttons = 5
    bench.controller.force_mn = -70
    bench.way_mm = 20.0
    first, second = bench.tick(2)
    assert (first.time_us, second.time_us) == ((1 << 32) - 1000, 0)
    assert first == State(1, first.time_us, 64_000, 0, PLACED | RESTING, 5, -70, 10, 4090, 0)
    bench.controller.force_mn = None
    bench.send(Frame(513, packed(REST)))
    assert bench.state() == State(3, 1000, 64_000, 513, PLACED, 5, None, 10, 4090, 0)


def test_a_state_has_both_axes_the_angle_and_the_knobs():
    bench = Bench()
    bench.send(Hello())
    bench.controller.knobs = [1.0, 0.5]
    *_, first = bench.decoder.feed(bench.controller.tick(0, 20.0, 50.0, -math.pi / 2))
    assert first.count == 64_000
    assert first.y_count == (10 - 5000) % (1 << 16)  # it falls towards the reader
    assert first.theta_count == (4090 + 1024) % 4096  # it grows with the clock
    assert first.knobs == 255 | 128 << 8


def test_a_controller_of_one_axis_says_nothing_of_others():
    bench = Bench(replace(INFO, height_um=0, counts_per_turn=0))
    bench.send(Hello())
    *_, state = bench.decoder.feed(bench.controller.tick(0, 20.0, 50.0, 1.0))
    assert (state.y_count, state.theta_count) == (0, 0)


@pytest.mark.parametrize("sign", CountSign)
def test_an_absolute_encoder_counts_from_the_left_stop_and_wraps(sign):
    bench = Bench(replace(INFO, count_sign=sign))
    bench.send(Hello())
    for way_mm in (0.0, 0.004, 27.68, 300.0, 301.5, 5.0):
        bench.way_mm = way_mm
        state = bench.state()
        assert state.placed
        assert state.count == (60_000 + sign * round(way_mm * 200)) % 65_536


@pytest.mark.parametrize("sign", CountSign)
@pytest.mark.parametrize("bits", [8, 16, 32])
def test_an_index_encoder_is_right_from_its_mark_on(sign, bits):
    info = replace(INFO, encoder=Encoder.INDEX, count_sign=sign, count_bits=bits)
    bench = Bench(info)
    bench.send(Hello())

    def true():
        return (60_000 + sign * round(bench.way_mm * 200)) % (1 << bits)

    states = []
    for bench.way_mm in (0.0, 5.0, MARK_MM - 0.1):
        states.append(bench.state())
        assert not states[-1].placed
        assert states[-1].count != true()
    moved = (states[1].count - states[0].count) % (1 << bits)
    assert moved == sign * 1000 % (1 << bits)
    for bench.way_mm in (MARK_MM + 0.1, 3.0, 200.0):
        state = bench.state()
        assert (state.placed, state.count) == (True, true())
    bench.send(Hello())
    assert bench.state().placed


def test_its_mark_is_felt_on_the_way_back_too_and_lies_on_a_short_carriage():
    bench = Bench(replace(INFO, encoder=Encoder.INDEX))
    bench.send(Hello())
    bench.way_mm = MARK_MM + 50
    assert not bench.state().placed  # where it was when it started
    bench.way_mm = MARK_MM - 0.1
    assert bench.state().placed
    assert Controller(replace(INFO, travel_um=4000)).mark_mm == 2.0


@pytest.mark.parametrize("sign", CountSign)
def test_an_incremental_encoder_is_never_placed(sign):
    bench = Bench(replace(INFO, encoder=Encoder.INCREMENTAL, count_sign=sign, left_stop_count=0))
    bench.send(Hello())
    at_stop = bench.state()
    assert at_stop.count != 0
    for bench.way_mm in (0.1, MARK_MM, 300.0, 50.0):
        state = bench.state()
        assert not state.placed
        moved = sign * round(bench.way_mm * 200)
        assert state.count == (at_stop.count + moved) % 65_536


def test_unplugged_it_is_silent_and_its_watchdog_goes_on(greeted):
    greeted.show()
    greeted.send_bytes(encode(Frame(2, packed(SWING)))[:-4])
    greeted.controller.hang_up()
    assert greeted.tick(100) == []
    assert (greeted.controller.trips, greeted.controller.rest_after_us) == (1, 70_000)
    assert greeted.levels == REST
    greeted.show()
    assert greeted.levels == REST
    assert greeted.send(Hello()) == [greeted.controller.info, Watchdog(trips=1, dropped=0)]


def test_a_device_is_described_to_the_host():
    device = Display(
        name="simulated STReSS²", rows=6, columns=10, column_pitch_mm=1.2, row_pitch_mm=1.8,
        levels=1024, rest_side="right", travel_mm=300.0, counts_per_mm=200.0, rate_hz=1000.0,
    )  # fmt: skip
    info = describe(device, Encoder.INDEX)
    assert (info.rows, info.columns, info.top_level, info.rate_hz) == (6, 10, 1023, 1000)
    assert (info.column_pitch_nm, info.row_pitch_nm) == (1_200_000, 1_800_000)
    assert (info.name, info.rest_side) == ("simulated STReSS²", RestSide.RIGHT)
    assert (info.travel_um, info.counts_per_m) == (300_000, 200_000)
    assert info.encoder is Encoder.INDEX
    assert info.left_stop_count + 60_000 > 1 << info.count_bits > 2 * 60_000
    assert (set(info.gain), set(info.enabled), set(info.inverted)) == ({255}, {1}, {0})
    fine = describe(replace(device, counts_per_mm=1e6), Encoder.INCREMENTAL)
    assert 1 << fine.count_bits > 2 * 300 * 1e6
    assert fine.left_stop_count == 0
    with pytest.raises(ValueError, match="rate_hz is 20; it must be 50 to 10000 Hz"):
        describe(replace(device, rate_hz=20.0), Encoder.INDEX)
