"""Whether a device is fit to be read on, by a controller on a clock that is turned by hand."""

import json
import re
from dataclasses import replace

import pytest

from tests.baddrivers import BAD, Good
from tests.devices.bench import Bench
from tests.engine.test_loop import info
from tests.tiers import heavy
from vbraille.devices.serial.wire import Encoder
from vbraille.engine.checkup import check
from vbraille.engine.clock import ManualClock

RATE_S = 1.0  # what a bench does in it, it always does
SMALL = {"rows": 1, "columns": 2, "inverted": b"\0\1", "gain": b"\xff\xff", "enabled": b"\1\1"}


class BenchClock:
    """The clock of a bench: who sleeps on it has the controller go on."""

    def __init__(self, bench):
        self._bench = bench

    def now_ns(self):
        return self._bench.now_ns()

    busy_ns = now_ns

    def sleep_until_ns(self, deadline_ns):
        while self.now_ns() < deadline_ns:
            self._bench.pause(0.001)


@pytest.fixture
def checked():
    """Check a device of two actuators whose controller is made as it should not be."""

    def run(spoil=lambda _bench: None, **changes):
        bench = Bench(**{**SMALL, **changes})
        spoil(bench)
        said = []
        with bench.begin(None) as device:
            found = check(device, BenchClock(bench), said.append, rate_s=RATE_S)
        # As --json prints it: without NaN, which JSON has not.
        assert json.loads(json.dumps(found.to_json(), allow_nan=False))["wrong"] == found.wrong
        return found.fit, said

    return run


def test_what_is_as_it_should_be_is_fit_and_measured(checked):
    fit, said = checked()
    assert (fit, said[-1]) == (True, "verdict: fit to be read on")
    kinds = [line.partition(":")[0] for line in said]
    assert kinds[:7] == ["actuator", "actuator", "rate", "work", "late", "clock", "place"]
    assert "late: this computer by 0.0 ms at most, the line by 0.0 ms" in said
    assert "clock: 1.000 s pass on it in a second, 0.98 to 1.02 s are allowed" in said
    assert (
        "place: 5.0 to 5.0 mm from the left stop, of 300 mm; 2 mm beyond either end are allowed"
    ) in said
    (tripped,) = [line for line in said if line.startswith("watchdog: tripped")]
    assert re.match(r"watchdog: tripped 3 of 3 times, median 5[01]\.0 ms after the last", tripped)
    # It does not hold its own trips against the device.
    assert [line for line in said if line.startswith("device: ")] == []
    assert "watchdog trips: 0" in said


def late(bench):
    bench.controller.watchdog_us = 80_000


def early(bench):
    bench.controller.watchdog_us = 30_000


def missing(bench):
    bench.controller.watchdog_us = None


def unacknowledged(bench):
    bench.controller.acknowledges = False


def untaken(bench):
    bench.controller._take_frame = lambda _frame: b""


def far_off(bench):
    bench.way_mm = 5005.0


def a_bit_off(bench):
    bench.way_mm = -2.5


def together(*spoils):
    def spoil(bench):
        for one in spoils:
            one(bench)

    return spoil


def clock_at(speed):
    def spoil(bench):
        tick, receive = bench.controller.tick, bench.controller.receive
        bench.controller.tick = lambda us, *at: tick(round(us * speed), *at)
        bench.controller.receive = lambda chunk, us: receive(chunk, round(us * speed))

    return spoil


FAR_OFF = "its carriage is at 5005.0 mm from the left stop, where it cannot be; see to the"
A_BIT_OFF = "its carriage is at -2.5 mm from the left stop, where it cannot be"
UNTAKEN = "it acknowledges none of the frames that it is sent; see to its frame_sequence"
MISSING = "its watchdog does not trip in time when no frame comes; do not read on it"
LATE = "its watchdog trips after 81 ms, too late; 50 ms are right"
HALF_AS_FAST = "its clock goes 0.50 times as fast as it should; see to its time_us"
A_BIT_SLOW = "its clock goes 0.97 times as fast as it should; see to its time_us"
EARLY = "its watchdog trips after 31 ms, too early; 50 ms are right"


@pytest.mark.parametrize(
    ("spoil", "found"),
    [
        (together(unacknowledged, a_bit_off), [UNTAKEN, A_BIT_OFF]),
        # The next two are as these to a checkup.
        pytest.param(untaken, [UNTAKEN], marks=heavy),
        pytest.param(clock_at(0.5), [HALF_AS_FAST], marks=heavy),
        (together(far_off, missing), [FAR_OFF, MISSING]),
        (late, [LATE]),
        (early, [EARLY]),
        (clock_at(0.97), [A_BIT_SLOW]),
    ],
    ids=["unacknowledged", "untaken", "clock 0.5", "far off", "late", "early", "clock 0.97"],
)
def test_what_is_not_as_it_should_be_is_not_fit(checked, spoil, found):
    fit, said = checked(spoil)
    assert not fit
    verdict = said[-1].removeprefix("verdict: not fit to be read on: ")
    assert verdict != said[-1]
    assert [sentence for sentence in found if sentence not in verdict] == []


@pytest.mark.parametrize(
    "changes", [{"enabled": b"\0\0"}, pytest.param({"gain": b"\0\0"}, marks=heavy)]
)
def test_actuators_that_are_all_disabled_are_not_fit_and_not_swung(checked, changes):
    fit, said = checked(**changes)
    assert not fit
    assert said[-1] == "verdict: not fit to be read on: every one of its actuators is disabled"
    assert not [line for line in said if line.startswith("actuator")]


def test_some_disabled_actuators_and_a_place_not_tested_are_said_with_the_verdict(checked):
    """The place is not tested where the reader is to show it."""
    fit, said = checked(enabled=b"\1\0", encoder=Encoder.INCREMENTAL, left_stop_count=0)
    assert fit
    assert said[-1] == (
        "verdict: fit to be read on, without 1 of its actuators, which are disabled"
    )
    assert said[0] == "actuator: row 1, column 1"
    assert "actuator: row 1, column 2" not in said
    assert "place: not tested, since its reader must show it the left stop" in said


def test_a_device_of_two_axes_is_shown_a_corner_and_has_no_stop(checked):
    plane = {"height_um": 60_000, "y_counts_per_m": 200_000}
    _, said = checked(encoder=Encoder.INCREMENTAL, left_stop_count=0, **plane)
    assert "place: not tested, since its reader must show it the far left corner" in said
    _, said = checked(**plane)
    (place,) = [line for line in said if line.startswith("place: ")]
    assert place.startswith("place: 5.0 to 5.0 mm from the left edge, of 300 mm;")


@pytest.mark.parametrize(
    ("driver", "found"), BAD.items(), ids=lambda each: getattr(each, "__name__", "")
)
def test_a_bad_driver_is_not_fit_by_the_name_of_its_fault(driver, found):
    clock, said = ManualClock(), []
    device = driver(replace(info(), rows=1, columns=2), clock)
    assert not check(device, clock, said.append).fit
    assert said[-1].startswith("verdict: not fit to be read on: ")
    assert found in said[-1]


def test_a_slow_but_right_clock_and_a_carriage_at_its_stop_are_fit(checked):
    def spoil(bench):
        clock_at(0.99)(bench)
        bench.way_mm = -1.5

    assert checked(spoil)[0]


def test_what_a_device_does_not_tell_is_said_with_the_verdict():
    clock, said = ManualClock(), []
    with Good(replace(info(), rows=1, columns=2), clock) as device:
        assert check(device, clock, said.append).fit
    assert said[-1] == (
        "verdict: fit to be read on, but what it has taken and its watchdog could not be tested"
    )
