"""Whether a device is fit to be read on: what is measured, what is allowed, and the verdict."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from vbraille.devices.base import Placing
from vbraille.devices.events import WatchdogTripped
from vbraille.devices.sentences import shown_place, told
from vbraille.devices.serial.wire import RAMP_MS, WATCHDOG_MS
from vbraille.engine.checkup import (
    NS_PER_S,
    Watch,
    hold_rate,
    round_trips_ms,
    swing_each,
    trip_ms,
)
from vbraille.errors import DeviceError

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.devices import Device
    from vbraille.engine.checkup import Rate
    from vbraille.engine.clock import Clock

_RATE_S = 3.0
_ROUND_TRIPS = 500
# A longer round trip is felt: a hand at 70 mm/s goes a tenth of a dot in 4 ms.
_MOST_ROUND_TRIP_MS = 4.0
_MOST_LATE = 0.01  # as a share of all ticks
_MOST_FAULTS = 50  # of each kind: 1 % of some 5000 ticks
_MARK_S = 60.0
# What the clocks of simple controllers may be off by; more is heard in a speed.
_MOST_CLOCK = 0.02
# A carriage pressed against its stop may be so far beyond it.
_PLACE_SLACK_MM = 2.0
_TRIPS = 3
# Too early, the watchdog trips while nothing is wrong; a report takes as long as a round trip.
_EARLIEST_TRIP_MS = 0.9 * WATCHDOG_MS
_REPORT_MS = 5.0


def check(device: Device, clock: Clock, say: Callable[[str], None]) -> int:
    """Measure a device; say what was measured, one thing a line, and last the verdict.

    Returns
    -------
    int
        Exit code: 0 if the device is fit to be read on, 1 if it is not.

    Raises
    ------
    DeviceError
        If the device is gone, or gives no place within a minute.
    """
    with Watch(device, clock) as watch:
        return _Check(device, clock, say, watch).run()


class _Check:
    """One check; each of its parts says what it measured and gives what is wrong."""

    def __init__(
        self, device: Device, clock: Clock, say: Callable[[str], None], watch: Watch
    ) -> None:
        self._device = device
        self._clock = clock
        self._say = say
        self._watch = watch
        self._shown = False  # whether its place was chosen here, and says nothing

    def run(self) -> int:
        device = self._device
        self._wait_for_place()
        for row, column in swing_each(device, self._clock):
            self._say(f"actuator: row {row + 1}, column {column + 1}")
        missed = device.counts().get("states missed", 0)
        rate = hold_rate(device, self._clock, _RATE_S)
        missed = device.counts().get("states missed", 0) - missed
        wrong = [
            *self._actuators(),
            *self._rate(rate, missed),
            *self._time(rate),
            *self._place(rate),
            *self._round_trips(),
            *self._faults(),
        ]
        self._say_notes()
        wrong += self._watchdog()
        self._say_notes(tripped=True)
        wrong += [*self._watch.faults(), *self._end()]
        if wrong:
            self._say(f"verdict: not fit to be read on: {'; '.join(wrong)}")
            return 1
        self._say(f"verdict: fit to be read on{self._but()}")
        return 0

    def _say_notes(self, *, tripped: bool = False) -> None:
        """Say what the device has told, but for trips of its watchdog that were asked for."""
        events = self._device.take_events()
        asked = WatchdogTripped if tripped else ()
        for sentence in told(event for event in events if not isinstance(event, asked)):
            self._say(sentence)

    def _end(self) -> list[str]:
        """Let the device go, which its driver may fail at."""
        try:
            self._device.close()
        except Exception as fault:
            return [f"its driver cannot let it go ({type(fault).__name__}: {fault})"]
        return []

    def _but(self) -> str:
        """Remarks that go with a verdict that is good."""
        untold = []
        if not self._device.acknowledges:
            untold.append("what it has taken")
        if self._device.watchdog_trips is None:
            untold.append("its watchdog")
        but = f", but {' and '.join(untold)} could not be tested" if untold else ""
        off = len(self._device.particulars.disabled) if self._device.particulars else 0
        return but + (f", without {off} of its actuators, which are disabled" if off else "")

    def _actuators(self) -> list[str]:
        told, info = self._device.particulars, self._device.display
        all_off = told is not None and len(told.disabled) == info.rows * info.columns
        return ["every one of its actuators is disabled"] if all_off else []

    def _wait_for_place(self) -> None:
        """Wait for any place, or a wrong one: frames are not taken without one."""
        device, clock = self._device, self._clock
        begun_ns, minutes = clock.now_ns(), 0
        while device.read() is None and not self._watch.found:
            passed_s = (clock.now_ns() - begun_ns) / NS_PER_S
            if device.placing is Placing.STOP:
                device.set_zero()
                self._shown = True
            elif device.placing is Placing.MARK and passed_s > 0.5 + minutes * _MARK_S:
                self._say("place: move the carriage over its mark")
                minutes += 1
            if passed_s > (1 + minutes) * _MARK_S:
                raise DeviceError(f"{device.display.name} gives no place; look at its encoder")
            clock.sleep_until_ns(clock.now_ns() + 1_000_000)

    def _rate(self, rate: Rate, missed: int) -> list[str]:
        due = rate.ticks + rate.late
        share = rate.late / due
        self._say(f"rate: {self._device.display.rate_hz:g} Hz, {rate.late} of {due} ticks late")
        self._say(f"work: median {rate.work_us[0]:.0f} µs, 99 % under {rate.work_us[1]:.0f} µs")
        part = f"the device, or a line that lost {missed} places," if missed else "the line"
        self._say(
            f"late: this computer by {rate.host_ms:.1f} ms at most, {part} by "
            f"{max(rate.place_ms - 1000 / self._device.display.rate_hz, 0.0):.1f} ms"
        )
        return (
            [f"{share:.1%} of the ticks come late on this computer"] if share > _MOST_LATE else []
        )

    def _time(self, rate: Rate) -> list[str]:
        self._say(
            f"clock: {rate.clock_s:.3f} s pass on it in a second, {1 - _MOST_CLOCK:g} to "
            f"{1 + _MOST_CLOCK:g} s are allowed"
        )
        if abs(rate.clock_s - 1) <= _MOST_CLOCK:
            return []
        if math.isnan(rate.clock_s):
            return ["it told neither its time nor its place"]
        return [
            f"its clock goes {rate.clock_s:.2f} times as fast as it should; see to its time_us, or "
            f"to time_ns of its driver's poses"
        ]

    def _place(self, rate: Rate) -> list[str]:
        info = self._device.display
        if self._shown:
            self._say(f"place: not tested, since its reader must show it {shown_place(info)}")
            return []
        if math.isnan(rate.x_mm[0]):
            self._say("place: none was told")
            return []
        edge = "left edge" if info.height_mm else "left stop"
        low_mm, high_mm = (round(x_mm + info.span_mm / 2, 1) + 0.0 for x_mm in rate.x_mm)
        self._say(
            f"place: {low_mm:.1f} to {high_mm:.1f} mm from the {edge}, of "
            f"{info.travel_mm:g} mm; {_PLACE_SLACK_MM:g} mm beyond either end are allowed"
        )
        if low_mm >= -_PLACE_SLACK_MM and high_mm <= info.travel_mm + _PLACE_SLACK_MM:
            return []
        off_mm = low_mm if low_mm < -_PLACE_SLACK_MM else high_mm
        return [
            f"its carriage is at {off_mm:.1f} mm from the {edge}, where it cannot be; see to "
            f"{shown_place(info)}, its counts and their sign"
        ]

    def _round_trips(self) -> list[str]:
        taken = round_trips_ms(self._device, self._clock, _ROUND_TRIPS)
        if not self._device.acknowledges:
            self._say("round trip: not tested, since this device does not say what it has taken")
            return []
        if not taken.size:
            self._say("round trip: none, for no frame was acknowledged")
            return [
                "it acknowledges none of the frames that it is sent; see to its frame_sequence, "
                "or to acknowledged_ns of its driver"
            ]
        low, median, high = np.percentile(taken, (1, 50, 99))
        self._say(f"round trip: median {median:.2f} ms, 98 % within {low:.2f} to {high:.2f} ms")
        if taken.size < _ROUND_TRIPS:
            return [f"only {taken.size} frames were acknowledged before one was not"]
        if median <= _MOST_ROUND_TRIP_MS:
            return []
        return [f"a round trip takes {median:.1f} ms; have the port's latency set to 1 ms"]

    def _watchdog(self) -> list[str]:
        """Leave the device without frames several times, and see how long it takes to say so."""
        if self._device.watchdog_trips is None:
            self._say("watchdog: not tested, since this device does not tell of one")
            return []
        self._say("watchdog: the device is sent nothing now, so that it trips")
        taken = [trip_ms(self._device, self._clock) for _ in range(_TRIPS)]
        tripped = [ms for ms in taken if ms is not None]
        if not tripped:
            self._say("watchdog: no trip was reported")
            return ["its watchdog does not trip in time when no frame comes; nobody may read on it"]
        median = float(np.median(tripped))
        promised_ms = WATCHDOG_MS + RAMP_MS + 1000 / self._device.display.rate_hz
        self._say(
            f"watchdog: tripped {len(tripped)} of {_TRIPS} times, median {median:.1f} ms after "
            f"the last frame, and so at rest after {median + RAMP_MS:.1f} ms with a ramp of "
            f"{RAMP_MS} ms; {promised_ms:g} ms are promised, and {_REPORT_MS:g} ms allowed for "
            f"its report"
        )
        if len(tripped) < _TRIPS:
            return [f"its watchdog trips {len(tripped)} of {_TRIPS} times that no frame comes"]
        early = median < _EARLIEST_TRIP_MS
        if not early and median + RAMP_MS <= promised_ms + _REPORT_MS:
            return []
        how = "early" if early else "late"
        return [f"its watchdog trips after {median:.0f} ms, too {how}; {WATCHDOG_MS} ms are right"]

    def _faults(self) -> list[str]:
        counts = self._device.counts()
        for name, count in counts.items():
            self._say(f"{name}: {count}")
        return [f"{name}: {count}" for name, count in counts.items() if count > _MOST_FAULTS]
