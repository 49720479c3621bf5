"""Measurements of a device for its builder: actuators, rate, clock, place, round trip, watchdog."""

from __future__ import annotations

import math
import resource
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from vbraille.devices.serial.wire import WATCHDOG_MS
from vbraille.engine.clock import ManualClock
from vbraille.engine.constants import JUMP_MM_S
from vbraille.engine.local import LocalEngine
from vbraille.pose import Pose
from vbraille.render.program import vibration
from vbraille.simulation.simulated import SimulatedDevice

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from vbraille.devices import Device
    from vbraille.display import Display
    from vbraille.engine.clock import Clock

NS_PER_S = 1_000_000_000
SWING_S = 0.25  # time of one actuator's swing, out and back
_MOST_SWINGS = 8  # as long as so many swings for one actuator, if the device keeps going to rest
_PATIENCE_S = 0.25  # time until a frame counts as never acknowledged
_LOOK_NS = 50_000
# How far the actuators go, and how long they take, before a watchdog is left without frames.
_HELD = 0.3
_HOLD_S = 0.1
_TRIP_PATIENCE_S = 0.5
# What a driver's read and write may take together, as a share of a tick.
_MOST_OF_TICK = 0.5


@dataclass(frozen=True, slots=True)
class Rate:
    """How well a device held a rate of frames.

    Parameters
    ----------
    ticks, late
        How many ticks were done, and how many came too late.
    work_us
        Time that a tick took to read, render and write, in µs: median and 99th percentile.
    clock_s
        Seconds that the device's clock goes on in one second of the computer's.
    x_mm
        Leftmost and rightmost place of the array's centre.
    host_ms, place_ms
        Greatest lateness of a tick, and longest time from one place to the next, in ms.
    """

    ticks: int
    late: int
    work_us: tuple[float, float]
    clock_s: float
    x_mm: tuple[float, float]
    host_ms: float
    place_ms: float


class Watch:
    """Eye on a driver: how long each `read` and `write` of its device takes, and what it gives.

    While it is entered it stands before these two methods. What no driver may give, such as NaN,
    goes no further than here.

    Parameters
    ----------
    device
        An open device.
    clock
        The clock by which calls are timed.
    """

    def __init__(self, device: Device, clock: Clock) -> None:
        self._device = device
        self._clock = clock
        self._calls = {"read": device.read, "write": device.write}
        self._own = {name: call for name, call in self._calls.items() if name in vars(device)}
        self._spent_ns: dict[str, list[int]] = {name: [] for name in self._calls}
        self._found: dict[str, str] = {}
        self._last: Pose | None = None
        self._last_ns = 0

    def __enter__(self) -> Self:
        vars(self._device).update(read=self._read, write=self._write)
        return self

    def __exit__(self, *_: object) -> None:
        for name in self._calls:
            del vars(self._device)[name]
        vars(self._device).update(self._own)

    @property
    def found(self) -> bool:
        """Tell if the driver gave anything wrong so far."""
        return bool(self._found)

    def faults(self) -> list[str]:
        """Clauses on what was wrong with the driver so far, each kind of fault once."""
        period_ms = 1e3 / self._device.display.rate_hz
        median_ms = {name: np.median(ns or [0]) / 1e6 for name, ns in self._spent_ns.items()}
        found = list(self._found.values())
        if sum(median_ms.values()) > _MOST_OF_TICK * period_ms:
            told = " and ".join(f"its {name} takes {ms:.2f} ms" for name, ms in median_ms.items())
            found.append(f"{told}, of the {period_ms:g} ms that a tick has; neither may wait")
        for name, spent_ns in self._spent_ns.items():
            longest_ms = max(spent_ns, default=0) / 1e6
            if longest_ms > WATCHDOG_MS:
                found.append(f"its {name} took {longest_ms:.0f} ms once; it may not wait")
        return found

    def _read(self) -> Pose | None:
        sample: object = self._timed("read")
        if sample is None:
            return None
        if not isinstance(sample, Pose):
            self._find("kind", f"its read gives {sample!r}, where it must give a Pose or None")
            return None
        if not all(map(math.isfinite, sample)):
            where = ", ".join(f"{name} {value}" for name, value in sample._asdict().items())
            self._find("number", f"its read gives a place that is no number ({where})")
            return None
        if sample.theta_rad and not self._device.display.turns:
            self._find(
                "angle",
                f"its read gives an angle of {sample.theta_rad:g} rad, and its Display has no "
                f"turns=True",
            )
            sample = sample._replace(theta_rad=0.0)
        self._compare(sample)
        return sample

    def _compare(self, sample: Pose) -> None:
        """Look whether the clock or the place of a sample can follow those of the last one."""
        now_ns, last = self._clock.now_ns(), self._last
        if last is not None:
            back_ns = last.time_ns - sample.time_ns
            if back_ns > 0:
                self._find("clock", f"its clock goes back, once by {back_ns / 1e6:g} ms")
            elapsed_s = max((now_ns - self._last_ns) / NS_PER_S, 1 / self._device.display.rate_hz)
            far_mm = max(abs(sample.x_mm - last.x_mm), abs(sample.y_mm - last.y_mm))
            if far_mm > JUMP_MM_S * elapsed_s:
                self._find(
                    "jump",
                    f"its carriage jumps, once by {far_mm:.4g} mm in {1e3 * elapsed_s:.3g} ms, "
                    f"faster than any hand",
                )
        self._last, self._last_ns = sample, now_ns

    def _write(self, frame: NDArray[np.float64]) -> None:
        self._timed("write", frame)

    def _timed(self, name: str, *given: Any) -> Any:
        clock, call = self._clock, self._calls[name]
        waits, busy_ns, now_ns = _waits(), clock.busy_ns(), clock.now_ns()
        try:
            return call(*given)
        finally:
            # Time for which the system gave the processor to others is not the driver's.
            waited = _waits() != waits
            own_ns = clock.now_ns() - now_ns if waited else clock.busy_ns() - busy_ns
            self._spent_ns[name].append(own_ns)

    def _find(self, kind: str, fault: str) -> None:
        self._found.setdefault(kind, fault)


def _waits() -> int:
    """How often this thread has waited for something of its own accord."""
    return resource.getrusage(resource.RUSAGE_THREAD).ru_nvcsw


def swing_each(device: Device, clock: Clock) -> Iterator[tuple[int, int]]:
    """Swing one actuator after the other, out and back without a jump.

    The row and column of each actuator, from 0, are yielded before it swings, so that they can be
    said.
    Actuators that the device reports as disabled are left out.

    Raises
    ------
    DeviceError
        If the device is gone.
    """
    info = device.display
    steps = round(SWING_S * info.rate_hz)
    frame = np.zeros((info.rows, info.columns))
    told = device.particulars
    for row, column in np.ndindex(frame.shape):
        if told is not None and (row, column) in told.disabled:
            continue
        yield row, column
        due_ns = clock.now_ns()
        taking, step = device.taking, 0
        for _ in range(_MOST_SWINGS * steps):
            step += 1
            frame[row, column] = math.sin(math.pi * step / steps) ** 2 if step < steps else 0.0
            due_ns += round(NS_PER_S / info.rate_hz)
            clock.sleep_until_ns(due_ns)
            device.read()
            if device.taking != taking:
                # It has gone to rest, or leaves it: begin again from rest, so that nothing jumps.
                taking, step = device.taking, 0
                frame[row, column] = 0.0
            device.write(frame)
            if step == steps:
                break
        frame[row, column] = 0.0


def warm_up(display: Display) -> None:
    """Compile and load what `hold_rate` calls, before a device's watchdog could trip meanwhile."""
    clock = ManualClock()
    with SimulatedDevice(display, clock.now_ns) as device:
        hold_rate(device, clock, 1 / display.rate_hz)


def hold_rate(device: Device, clock: Clock, seconds: float) -> Rate:
    """Drive the device at its rate for a number of seconds.

    Raises
    ------
    DeviceError
        If the device is gone.
    """
    rate_hz = device.display.rate_hz
    engine = LocalEngine(device, clock, rate_hz=rate_hz, poll_ticks=round(rate_hz / 4))
    # All actuators swell and sink, once a second.
    engine.loop.show(vibration(device.display, 1.0, exposure_s=math.inf))
    engine.loop.restart_clock()
    polled = []
    while engine.tally.ticks + engine.tally.late < seconds * rate_hz:
        polled.append(engine.poll())
    engine.loop.fade_to_rest()
    ticks = np.concatenate(polled)
    median, most = np.percentile(ticks["work_ns"] / 1e3, (50, 99))
    known = ticks[~np.isnan(ticks["x_mm"])]
    x_mm = (math.nan, math.nan)
    if known.size:
        x_mm = float(known["x_mm"].min()), float(known["x_mm"].max())
    return Rate(
        ticks=engine.tally.ticks,
        late=engine.tally.late,
        work_us=(float(median), float(most)),
        clock_s=_clock_s(known),
        x_mm=x_mm,
        host_ms=float(ticks["lateness_ns"].max()) / 1e6,
        place_ms=_longest_ms(known),
    )


def _longest_ms(ticks: NDArray[np.void]) -> float:
    """Longest time from a tick with a new place to the next such tick, in ms."""
    new = ticks["time_ns"][np.diff(ticks["device_ns"], prepend=-1) > 0]
    return float(np.diff(new).max(initial=0)) / 1e6


def _clock_s(ticks: NDArray[np.void]) -> float:
    """How far the device's clock goes in a second of the computer's; NaN if it never told a time.

    Compares how far the device's clock is ahead in the first third of the samples and in the last.
    Medians are taken, so that samples which came late, as after a stall, weigh little.
    """
    third = ticks.size // 3
    if not third:
        return math.nan
    first, last = ticks[:third], ticks[-third:]
    ahead_ns = [float(np.median(part["device_ns"] - part["time_ns"])) for part in (first, last)]
    passed_ns = float(np.median(last["time_ns"]) - np.median(first["time_ns"]))
    return 1 + (ahead_ns[1] - ahead_ns[0]) / passed_ns


def round_trips_ms(device: Device, clock: Clock, count: int) -> NDArray[np.float64]:
    """Times from a frame until the device has said that it has that frame, in ms.

    Returns
    -------
    float64[n]
        One time for each frame acknowledged; empty if the device acknowledges none.

    Raises
    ------
    DeviceError
        If the device is gone.
    """
    frame = np.zeros((device.display.rows, device.display.columns))
    taken = []
    for _ in range(count):
        _begin(device, clock, frame)
        device.write(frame)
        give_up_ns = clock.now_ns() + round(_PATIENCE_S * NS_PER_S)
        while device.acknowledged_ns is None and clock.now_ns() < give_up_ns:
            clock.sleep_until_ns(clock.now_ns() + _LOOK_NS)
            device.read()
        if device.acknowledged_ns is None:
            break
        taken.append(device.acknowledged_ns / 1e6)
    return np.array(taken)


def trip_ms(device: Device, clock: Clock) -> float | None:
    """Send nothing, with the actuators a little off their rest, until the device's watchdog trips.

    Afterwards the actuators are at rest and frames are sent again.

    Returns
    -------
    float or None
        Time from the last frame until the device said that the watchdog tripped, in ms; None if
        it said so not within half a second, or never does.

    Raises
    ------
    DeviceError
        If the device is gone.
    """
    _begin(device, clock, np.zeros((device.display.rows, device.display.columns)))
    _move(device, clock, 0.0, _HELD)
    _move(device, clock, _HELD, _HELD)
    trips, last_ns = device.watchdog_trips, clock.now_ns()
    while device.watchdog_trips == trips:
        if clock.now_ns() - last_ns > _TRIP_PATIENCE_S * NS_PER_S:
            _move(device, clock, _HELD, 0.0)
            return None
        clock.sleep_until_ns(clock.now_ns() + _LOOK_NS)
        device.read()
    taken_ms = (clock.now_ns() - last_ns) / 1e6
    clock.sleep_until_ns(clock.now_ns() + round(_HOLD_S * NS_PER_S))  # wait while it ramps to rest
    _move(device, clock, 0.0, 0.0)
    return taken_ms


def _move(device: Device, clock: Clock, from_: float, to: float) -> None:
    """Move all actuators from one deflection to another, at the device's rate."""
    info = device.display
    steps = round(_HOLD_S * info.rate_hz)
    frame = np.empty((info.rows, info.columns))
    due_ns = clock.now_ns()
    for step in range(1, steps + 1):
        frame.fill(from_ + (to - from_) * step / steps)
        due_ns += round(NS_PER_S / info.rate_hz)
        clock.sleep_until_ns(due_ns)
        device.read()
        device.write(frame)


def _begin(device: Device, clock: Clock, frame: NDArray[np.float64]) -> None:
    """Send rest until the device takes frames, or until that has taken too long."""
    give_up_ns = clock.now_ns() + round(_PATIENCE_S * NS_PER_S)
    while not device.taking and clock.now_ns() < give_up_ns:
        device.write(frame)
        clock.sleep_until_ns(clock.now_ns() + round(NS_PER_S / device.display.rate_hz))
        device.read()
