"""The checkup of a device for its builder: measurements, limits, and whether it may be read on.

Actuators swing, and rate, clock, place, round trip and watchdog are measured.
"""

from __future__ import annotations

import gc
import math
import resource
from collections import deque
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from vbraille.devices.events import Placing, WatchdogTripped, shown_place, told
from vbraille.devices.serial.wire import RAMP_MS, WATCHDOG_MS
from vbraille.display import Pose
from vbraille.engine.clock import ManualClock
from vbraille.engine.constants import FADE_S, JUMP_MM_S, NS_PER_S
from vbraille.engine.loop import LocalEngine
from vbraille.errors import DeviceError
from vbraille.render.program import vibration
from vbraille.simulation.simulated import SimulatedDevice

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from vbraille.devices import Device
    from vbraille.display import Display
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


_SWING_S = 0.25  # time of one actuator's swing, out and back
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
    """Result of a test of how well a device holds a rate of frames.

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


@dataclass(slots=True)
class Checkup:
    """Result of a checkup, filled as it goes on.

    Parameters
    ----------
    rate
        How well the device held its rate; None before that is measured.
    round_trips_ms
        First percentile, median and 99th percentile of the round trips; empty without any.
    trips_ms
        For each time without frames, when the watchdog's trip was reported; None if it was not.
    counts
        Faults by name, as the device and its line count them.
    wrong
        Clauses on why the device is not fit to be read on.
    """

    rate: Rate | None = None
    round_trips_ms: list[float] = field(default_factory=list)
    trips_ms: list[float | None] = field(default_factory=list)
    counts: dict[str, int] = field(default_factory=dict)
    wrong: list[str] = field(default_factory=list)

    @property
    def fit(self) -> bool:
        """Tell if the device is fit to be read on."""
        return not self.wrong

    def to_json(self) -> dict[str, Any]:
        """Tell all of it for JSON, which has no NaN: null stands for what was not told."""
        rate = {} if self.rate is None else asdict(self.rate)
        if self.rate is not None:
            if math.isnan(self.rate.clock_s):
                rate["clock_s"] = None
            if math.isnan(self.rate.x_mm[0]):
                rate["x_mm"] = None
        return {"fit": self.fit, **asdict(self), "rate": rate}


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
        # As in the engine's process: looking for garbage may take a tenth of a second of a call.
        self._collects = gc.isenabled()
        gc.disable()
        vars(self._device).update(read=self._read, write=self._write)
        return self

    def __exit__(self, *_: object) -> None:
        if self._collects:
            gc.enable()
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
        waits, queued_ns = _waits(), _queued_ns()
        busy_ns, now_ns = clock.busy_ns(), clock.now_ns()
        try:
            return call(*given)
        finally:
            # Time for which the system gave the processor to others is not the driver's.
            own_ns = clock.busy_ns() - busy_ns
            if _waits() != waits:
                own_ns = clock.now_ns() - now_ns - (_queued_ns() - queued_ns)
            self._spent_ns[name].append(max(own_ns, 0))

    def _find(self, kind: str, fault: str) -> None:
        self._found.setdefault(kind, fault)


def _waits() -> int:
    """Tell how often this thread has waited for something of its own accord."""
    return resource.getrusage(resource.RUSAGE_THREAD).ru_nvcsw


def _queued_ns() -> int:
    """Time for which this thread could have gone on and had no processor; 0 if no kernel tells."""
    try:
        return int(Path("/proc/thread-self/schedstat").read_text().split()[1])
    except OSError:
        return 0


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
    engine.show(vibration(device.display, 1.0, exposure_s=math.inf))
    engine.restart_clock()
    polled = []
    while engine.tally.ticks + engine.tally.late < seconds * rate_hz:
        polled.append(engine.poll())
    engine.fade_to_rest()
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
    """Way of the device's clock in a second of the computer's; NaN if it never told a time.

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


SWING_S = 1.0  # time of a swing, out and back
SWINGS = 4  # how often an actuator swings before it rests again


class ActuatorSwings:
    """Actuators of a device that swing one after the other.

    The caller calls `tick` again and again; each call waits for its time.

    Parameters
    ----------
    device
        Open device, whose correction is that of its opener.
    clock
        Clock by which ticks are due.
    begun
        Function that is told the row and column, from 0, of each actuator as it begins to swing.
    swing_s
        Time of a swing, out and back, in seconds.
    swings
        How often an actuator swings before it rests again.
    """

    def __init__(
        self,
        device: Device,
        clock: Clock,
        begun: Callable[[tuple[int, int]], None] = lambda _: None,
        swing_s: float = SWING_S,
        swings: int = SWINGS,
    ) -> None:
        rate_hz = device.display.rate_hz
        self._device, self._clock, self._say_begun = device, clock, begun
        self._period_ns = round(NS_PER_S / rate_hz)
        self._steps, self._swings = round(swing_s * rate_hz), swings
        self._fade = 1 / max(FADE_S * rate_hz, 1.0)  # of a deflection, a frame
        self._frame = np.zeros(device.display.shape)
        self._next: deque[tuple[int, int]] = deque()
        self._at: tuple[int, int] | None = None
        self._step = 0
        self._ending = False
        self._due_ns = clock.now_ns()
        self._was = device.rested, device.taking

    @property
    def resting(self) -> bool:
        """Tell whether every actuator is at rest, and none is to swing."""
        return self._at is None and not self._next

    def swing(self, *places: tuple[int, int]) -> None:
        """Have actuators swing one after the other, once the present one has faded to rest."""
        self._next.clear()
        self._next.extend(places)
        self._ending = True

    def stop(self) -> None:
        """Have the actuator that swings fade to rest."""
        self.swing()

    def tick(self) -> None:
        """Wait for the next frame's time, read the device, and send the frame.

        Raises
        ------
        DeviceError
            If the device is gone for good.
        """
        self._due_ns = max(self._due_ns + self._period_ns, self._clock.now_ns() - self._period_ns)
        self._clock.sleep_until_ns(self._due_ns)
        device = self._device
        device.read()
        now = device.rested, device.taking
        if now != self._was:
            # It has gone to rest by itself, or leaves it: begin again from there.
            self._was, self._step = now, 0
            if self._at is not None:
                self._frame[self._at] = 0.0
        self._move()
        device.write(self._frame)

    def rest(self) -> None:
        """Fade to rest, and have inverted actuators go to where the device itself rests.

        Raises
        ------
        DeviceError
            If the device is gone for good.
        """
        self.stop()
        while not self.resting or self._device.uncorrect():
            self.tick()

    def _move(self) -> None:
        """Move the actuator that swings by a step, or go to the next."""
        if self._at is None:
            self._ending = False
            if self._next:
                self._at, self._step = self._next.popleft(), 0
                self._say_begun(self._at)
            return
        if self._ending:
            level = max(self._frame[self._at] - self._fade, 0.0)
        else:
            self._step += 1
            level = math.sin(math.pi * self._step / self._steps) ** 2
            if self._step == self._steps * self._swings:
                level, self._ending = 0.0, True
        self._frame[self._at] = level
        if self._ending and level == 0.0:
            self._at = None


def check(
    device: Device, clock: Clock, say: Callable[[str], None], *, rate_s: float = _RATE_S
) -> Checkup:
    """Measure a device; say what was measured, one thing a line, and last the verdict.

    Parameters
    ----------
    device, clock
        The device, opened, and the clock that its time is measured by.
    say
        Takes a line.
    rate_s
        For how long the device is held to its rate, in seconds.

    Raises
    ------
    DeviceError
        If the device is gone, or gives no place within a minute.
    """
    with Watch(device, clock) as watch:
        return _Check(device, clock, say, watch, rate_s).run()


class _Check:
    """One check; each of its parts says what it measured and gives what is wrong."""

    def __init__(
        self,
        device: Device,
        clock: Clock,
        say: Callable[[str], None],
        watch: Watch,
        rate_s: float,
    ) -> None:
        self._device = device
        self._clock = clock
        self._say = say
        self._watch = watch
        self._rate_s = rate_s
        self._shown = False  # whether its place was chosen here, and says nothing
        self._found = Checkup()

    def run(self) -> Checkup:
        device = self._device
        self._wait_for_place()
        self._swing_each()
        missed = device.counts().get("states missed", 0)
        rate = self._found.rate = hold_rate(device, self._clock, self._rate_s)
        missed = device.counts().get("states missed", 0) - missed
        wrong = self._found.wrong
        wrong += [
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
        else:
            self._say(f"verdict: fit to be read on{self._but()}")
        return self._found

    def _swing_each(self) -> None:
        """Swing one actuator after the other, but for those that the device reports as disabled."""
        told, shape = self._device.particulars, self._device.display.shape
        off = () if told is None else told.disabled
        places = [place for place in np.ndindex(*shape) if place not in off]
        swings = ActuatorSwings(self._device, self._clock, self._say_actuator, _SWING_S, 1)
        swings.swing(*places)
        # A device that keeps going to rest is given up at last.
        most = _MOST_SWINGS * _SWING_S * self._device.display.rate_hz * len(places)
        for _ in range(round(most)):
            if swings.resting:
                break
            swings.tick()

    def _say_actuator(self, place: tuple[int, int]) -> None:
        self._say(f"actuator: row {place[0] + 1}, column {place[1] + 1}")

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
        low, median, high = self._found.round_trips_ms = np.percentile(taken, (1, 50, 99)).tolist()
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
        self._found.trips_ms = taken
        tripped = [ms for ms in taken if ms is not None]
        if not tripped:
            self._say("watchdog: no trip was reported")
            return ["its watchdog does not trip in time when no frame comes; do not read on it"]
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
        counts = self._found.counts = dict(self._device.counts())
        for name, count in counts.items():
            self._say(f"{name}: {count}")
        return [f"{name}: {count}" for name, count in counts.items() if count > _MOST_FAULTS]
