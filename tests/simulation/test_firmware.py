"""The simulated controller, rule by rule of the protocol's page; nobody waits for its clock."""

from dataclasses import replace

import numpy as np
import pytest

from tests.controllers import ControllerOf20261121
from vbraille.devices.wire.codec import DELIMITER, Decoder, Levels, OtherVersion, encode, enframe
from vbraille.devices.wire.messages import (
    FAULTY,
    PLACED,
    RESTING,
    TRIPPED,
    CountSign,
    Encoder,
    Error,
    ErrorCode,
    Frame,
    Hello,
    Info,
    Rest,
    RestSide,
    State,
    Watchdog,
)
from vbraille.display import Display
from vbraille.simulation.described import describe
from vbraille.simulation.firmware import MARK_MM, Controller

TOP = 1000  # 10 bits could say more
INFO = Info(
    version=1,
    rows=2,
    columns=3,
    column_pitch_nm=1_200_000,
    row_pitch_nm=1_800_000,
    rest_side=RestSide.RIGHT,
    top_level=TOP,
    rate_hz=1000,
    largest_slew_per_s=0,
    travel_um=300_000,
    encoder=Encoder.ABSOLUTE,
    counts_per_m=200_000,
    count_sign=CountSign.RIGHTWARD,
    count_bits=16,
    left_stop_count=60_000,
    name="Bench",
    firmware="0.3",
    inverted=bytes((0, 0, 0, 1, 1, 1)),
    gain=b"\xff" * 6,
    enabled=b"\1" * 6,
)
REST = [0, 0, 0, TOP, TOP, TOP]
SWING = [TOP, 500, 0, 0, 500, TOP]
PACKING = Levels(6, TOP)


def packed(levels):
    return PACKING.pack(np.array(levels, np.uint16))


class Bench:
    """A controller, what it says, and a timer that ticks each millisecond when told to."""

    def __init__(self, info=INFO, now_us=10_000_000, made=Controller):
        self.controller = made(info)
        self.decoder = Decoder()
        self.now_us = now_us
        self.way_mm = 0.0
        self.sequence = 0

    def send(self, *messages):
        """Send messages to it; its answers."""
        return self.send_bytes(b"".join(map(encode, messages)))

    def send_bytes(self, chunk):
        return self.decoder.feed(self.controller.receive(chunk, self.now_us))

    def frame(self, levels=SWING):
        self.sequence = (self.sequence + 1) & 0xFFFF
        return self.send(Frame(self.sequence, packed(levels)))

    def show(self, levels=SWING):
        """Show levels, from rest if it is there; its answers."""
        return [*(self.frame(REST) if self.controller.at_rest else ()), *self.frame(levels)]

    def tick(self, milliseconds=1):
        """Let time pass; what it says meanwhile."""
        heard = []
        for _ in range(milliseconds):
            self.now_us += 1000
            heard += self.decoder.feed(self.controller.tick(self.now_us, self.way_mm))
        return heard

    def state(self):
        """STATE of the controller after another millisecond."""
        *_, state = self.tick()
        return state

    @property
    def levels(self):
        return self.controller.levels.tolist()


@pytest.fixture
def bench():
    bench = Bench()
    bench.tick()
    return bench


@pytest.fixture
def greeted(bench):
    bench.send(Hello())
    return bench


def without_states(heard):
    return [message for message in heard if not isinstance(message, State)]


def test_before_hello_it_is_silent_and_at_rest(bench):
    assert bench.frame() == []
    assert bench.tick(100) == []
    assert bench.controller.fault(ErrorCode.OTHER, "Broken.") == b""
    assert (bench.levels, bench.controller.at_rest) == (REST, True)
    assert (bench.controller.frames, bench.controller.dropped) == (0, 0)
    assert not bench.controller.greeted


def test_it_answers_hello_and_then_says_where_it_is(bench):
    assert bench.send(Hello()) == [INFO, Watchdog(trips=0, dropped=0)]
    assert bench.controller.greeted
    assert [type(message) for message in bench.tick(5)] == [State] * 5


def test_hello_in_any_chunks(bench):
    heard = []
    for byte in DELIMITER + encode(Hello()):
        heard += bench.send_bytes(bytes((byte,)))
    assert heard == [INFO, Watchdog(0, 0)]


def test_another_version_is_told_this_one_and_nothing_else(greeted):
    greeted.show()
    assert greeted.send(Hello(version=2)) == [INFO, Watchdog(0, 0)]
    assert greeted.tick(30) == []
    assert greeted.frame() == []
    assert (greeted.levels, greeted.controller.frames) == (REST, 2)
    assert greeted.send(Hello()) == [INFO, Watchdog(0, 0)]
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
    assert greeted.levels == [9] * 6
    assert greeted.controller.frames == 5
    assert greeted.state().frame_sequence == 9


@pytest.mark.parametrize(
    "line",
    [
        encode(Frame(1, packed(SWING) + b"\0")),
        encode(Frame(1, packed(SWING)[:-1])),
        encode(Frame(1, Levels(6, 1023).pack(np.full(6, TOP + 1)))),
        encode(Frame(1, packed(SWING)))[:-3] + b"\x55\x55\0",
        enframe(b"\x02\x01\x00"),
        enframe(b"\x7f"),
        enframe(b"\x01\x00"),
        encode(Watchdog(1, 1)),
        encode(INFO),
        enframe(b"\x81\x02"),
        b"\xff\1\0",
        b"\1" * 5000 + b"\0",
    ],
)
def test_what_does_not_fit_is_dropped_and_counted(greeted, line):
    assert greeted.send_bytes(line) == []
    assert (greeted.levels, greeted.controller.frames, greeted.controller.dropped) == (REST, 0, 1)
    assert greeted.send(Hello()) == [INFO, Watchdog(trips=0, dropped=1)]


def test_it_says_another_version_s_info_is_another_s():
    assert Decoder().feed(enframe(b"\x81\x02")) == [OtherVersion(2)]  # one of the lines above


def ramp(begun, milliseconds):
    done = min(milliseconds / 20, 1)
    return np.rint(np.array(begun) + done * (np.array(REST) - begun)).tolist()


def test_the_watchdog_trips_after_50_ms_and_ramps_for_20(greeted):
    greeted.show()
    heard = greeted.tick(49)
    assert without_states(heard) == []
    assert not any(state.resting for state in heard)
    assert greeted.levels == SWING
    watchdog, state = greeted.tick()
    assert watchdog == Watchdog(trips=1, dropped=0)
    assert state.resting
    for milliseconds in range(1, 20):
        greeted.tick()
        assert greeted.levels == ramp(SWING, milliseconds)
        assert not greeted.controller.at_rest
    greeted.tick()
    assert (greeted.levels, greeted.controller.at_rest) == (REST, True)
    assert greeted.controller.rest_after_us == 70_000
    assert without_states(greeted.tick(200)) == []  # its own trip disarms it
    assert greeted.controller.trips == 1


@pytest.mark.parametrize("after_us", [0, 1, 499, 500, 999])
def test_it_rests_within_71_ms_wherever_between_ticks_the_last_frame_came(greeted, after_us):
    greeted.tick()
    greeted.now_us += after_us
    greeted.show()
    greeted.now_us -= after_us
    greeted.tick(71)
    assert greeted.controller.at_rest
    assert 70_000 <= greeted.controller.rest_after_us < 71_000


def test_a_late_tick_changes_nothing_about_when_the_timer_saw_to_it(greeted):
    greeted.show()
    greeted.now_us += 40_000
    greeted.tick()
    greeted.now_us += 14_300  # 55.3 ms after the frame, where it was due after 50
    greeted.tick()
    assert (
        greeted.levels == np.rint(np.array(SWING) + (np.array(REST) - SWING) * (6.3 / 20)).tolist()
    )
    greeted.now_us += 500_000
    greeted.tick()
    assert greeted.controller.rest_after_us == 70_000


def test_all_that_was_due_is_done_in_one_late_tick(greeted):
    greeted.show()
    greeted.now_us += 500_000
    assert without_states(greeted.tick()) == [Watchdog(1, 0)]
    assert greeted.controller.at_rest
    assert greeted.controller.rest_after_us == 70_000


def test_frames_feed_it(greeted):
    for _ in range(10):
        greeted.show()
        assert without_states(greeted.tick(49)) == []
    assert greeted.controller.trips == 0


@pytest.mark.parametrize(
    "line",
    [
        encode(Frame(1, packed(SWING)))[:-2] + b"\x55\0",
        encode(Frame(1, packed(SWING) + b"\0")),
        b"\x55",
        DELIMITER,
    ],
)
def test_nothing_else_does(greeted, line):
    greeted.show()
    for _ in range(49):
        greeted.tick()
        greeted.send_bytes(line)
    assert without_states(greeted.tick())[0].trips == 1


@pytest.mark.parametrize("message", [Rest(), Hello()])
def test_rest_and_hello_bring_it_to_rest_by_the_ramp_and_disarm_it(greeted, message):
    greeted.show()
    greeted.tick(10)
    greeted.send(message)
    greeted.tick(5)
    assert greeted.levels == ramp(SWING, 5)
    assert greeted.state().resting
    greeted.tick(14)
    assert (greeted.levels, greeted.controller.at_rest) == (REST, True)
    assert greeted.controller.rest_after_us == 30_000
    greeted.tick(100)
    assert greeted.controller.trips == 0


def test_a_ramp_on_its_way_is_not_begun_anew(greeted):
    greeted.show()
    greeted.tick(60)
    greeted.send(Rest())
    greeted.tick(5)
    greeted.send(Hello())
    greeted.tick(5)
    assert greeted.controller.at_rest
    assert greeted.controller.rest_after_us == 70_000


def test_a_frame_does_not_cut_the_ramp_after_a_trip_and_the_first_taken_has_it_reported(greeted):
    greeted.show()
    greeted.tick(50)
    for milliseconds in range(1, 20):
        assert greeted.frame() == []  # full, as from a host that has not heard
        assert greeted.frame(REST) == []
        state = greeted.state()
        assert greeted.levels == ramp(SWING, milliseconds)
        assert (state.resting, state.tripped, state.frame_sequence) == (True, True, 2)
    greeted.tick()
    assert (greeted.levels, greeted.controller.at_rest) == (REST, True)
    assert greeted.controller.rest_after_us == 70_000
    assert greeted.frame(REST) == [Watchdog(trips=1, dropped=0)]
    assert greeted.frame(REST) == []
    state = greeted.state()
    assert (state.resting, state.tripped) == (False, False)
    assert greeted.controller.dropped == 0  # none was, for all were valid


@pytest.mark.parametrize("message", [Rest(), Hello()])
def test_a_frame_does_not_cut_the_ramp_after_rest_and_hello(greeted, message):
    greeted.show()
    greeted.tick(10)
    greeted.send(message)
    greeted.frame()
    for milliseconds in range(1, 20):
        greeted.tick()
        greeted.frame()
        assert greeted.levels == ramp(SWING, milliseconds)
    greeted.tick()
    greeted.frame()
    assert (greeted.levels, greeted.controller.at_rest) == (REST, True)
    assert greeted.controller.rest_after_us == 30_000


def next_to_rest(step):
    return [rest + (step if rest == 0 else -step) for rest in REST]


@pytest.mark.parametrize("to_rest", ["start", "trip", "rest", "hello"])
def test_rest_is_left_by_a_twentieth_of_the_swing_at_most(greeted, to_rest):
    if to_rest != "start":
        greeted.show()
    if to_rest == "rest":
        greeted.send(Rest())
    if to_rest == "hello":
        greeted.send(Hello())
    greeted.tick(100)
    frames = greeted.controller.frames
    greeted.frame(SWING)
    greeted.frame(next_to_rest(TOP // 20 + 1))
    assert (greeted.levels, greeted.controller.frames) == (REST, frames)
    greeted.frame(next_to_rest(TOP // 20))
    assert greeted.levels == next_to_rest(TOP // 20)
    greeted.frame(SWING)  # from then on the host says how fast
    assert greeted.levels == SWING


def test_a_device_of_two_levels_leaves_rest_by_a_frame_of_rest():
    bench = Bench(replace(INFO, top_level=1))
    bench.send(Hello())
    rest, swing = (Levels(6, 1).pack(np.array(levels)) for levels in ([0, 0, 0, 1, 1, 1], [1] * 6))
    bench.send(Frame(1, swing))
    assert bench.controller.frames == 0
    bench.send(Frame(2, rest), Frame(3, swing))
    assert bench.levels == [1] * 6


def test_frames_that_come_twice_or_late_are_dropped_and_do_not_feed_the_watchdog(greeted):
    greeted.sequence = 65_530
    greeted.show([0, 0, 0, TOP, TOP, TOP])
    for level in range(10):  # over the wrap
        greeted.frame([level] * 6)
    assert greeted.levels == [9] * 6
    for late in (0, 1, 5, 30_000):
        greeted.send(Frame((greeted.sequence - late) & 0xFFFF, packed(SWING)))
    assert greeted.levels == [9] * 6
    assert greeted.controller.dropped == 4
    for _ in range(49):
        greeted.tick()
        greeted.send(Frame(greeted.sequence, packed(SWING)))
    assert without_states(greeted.tick())[0].trips == 1
    greeted.tick(30)
    greeted.send(Frame(7, packed(REST)))  # after a rest any number is the first
    assert greeted.state().frame_sequence == 7


def test_a_lost_report_of_a_trip_is_repeated_in_the_states_until_a_frame_is_taken(greeted):
    greeted.show()
    assert not any(state.tripped for state in greeted.tick(49))
    assert all(state.tripped for state in greeted.tick(300)[1:])
    greeted.frame()  # not taken: too far from rest
    assert greeted.state().flags == PLACED | RESTING | TRIPPED
    greeted.frame(REST)
    assert greeted.state().flags == PLACED


@pytest.mark.parametrize("message", [Rest(), Hello()])
def test_whoever_says_rest_or_hello_needs_no_report_of_a_trip_any_more(greeted, message):
    greeted.show()
    greeted.tick(100)
    greeted.send(message)
    assert greeted.state().flags == PLACED | RESTING


def test_the_controller_of_2026_11_21_is_cut_short_and_does_not_repeat():
    old = Bench(made=ControllerOf20261121)
    old.send(Hello())
    old.frame()  # from rest
    assert old.levels == SWING
    *_, tripped = old.tick(60)
    assert (old.levels, tripped.flags) == (ramp(SWING, 10), PLACED | RESTING)
    assert old.frame() == [Watchdog(trips=1, dropped=0)]
    assert old.levels == SWING
    old.send(Frame(old.sequence, packed(REST)))
    assert old.levels == REST


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
    assert first == State(1, first.time_us, 64_000, 0, PLACED | RESTING, 5, -70)
    bench.controller.force_mn = None
    bench.send(Frame(513, packed(REST)))
    assert bench.state() == State(3, 1000, 64_000, 513, PLACED, 5, None)


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
    assert greeted.send(Hello()) == [INFO, Watchdog(trips=1, dropped=0)]


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
