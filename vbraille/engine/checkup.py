"""The checkup of a device for its builder: measurements, limits, and whether it may be read on.

Actuators swing; rate, clock, place, round trip and watchdog are measured; and the computer, the
line and the device are told apart where something is late.
"""

from __future__ import annotations

import math
import os
import socket
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from vbraille.devices.events import Placing, WatchdogTripped, shown_place, told
from vbraille.devices.protocol import RAMP_MS, REST_MS, WATCHDOG_MS
from vbraille.display import Pose
from vbraille.engine.constants import JUMP_MM_S, NS_PER_S
from vbraille.errors import DeviceError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from vbraille.devices.base import Device
    from vbraille.engine.clock import Clock

_RATE_S = 3.0
_MOST_ROUND_TRIP_MS = 4.0  # a hand at 70 mm/s goes a tenth of a dot in 4 ms
_HELD_PERIODS = 3  # poses farther apart than that, of which none was lost, were held back
_MOST_LATE = 0.01  # as a share of all ticks
_MOST_FAULTS = 50  # of each kind: 1 % of some 5000 ticks
_MOST_CLOCK = 0.02  # that a simple controller's clock may be off
_PLACE_SLACK_MM = 2.0  # that a carriage pressed against its stop may be beyond it
_PLACE_S = 60.0  # that a place is waited for
_TRIPS = 3
_EARLIEST_TRIP_MS = 0.9 * WATCHDOG_MS
_REPORT_MS = 5.0
_TRIP_PATIENCE_S = 0.25
_SWING_S = 0.25
_HELD, _HOLD_S = 0.3, 0.1  # how far actuators go before a watchdog is left without frames
_MOST_OF_TICK = 0.5  # for a driver's read and write together, as a share of a tick
_ALIKE = 20  # first characters in which sentences on one kind of fault are alike
_PARTS = 5  # frames of which a line takes a part at first
_TICK = np.dtype(
    [
        ("late_ns", "<i8"),  # from when the tick was due to when it began
        ("host_ns", "<i8"),  # the part of it that this computer alone is to blame for
        ("work_ns", "<i8"),  # to read and to write
        ("came_ns", "<i8"),  # when a pose came, by this computer's clock
        ("device_ns", "<i8"),  # and by the device's
        ("x_mm", "<f8"),  # NaN without one
        ("taken_ns", "<f8"),  # how long a frame took to be acknowledged; NaN if that is not known
    ]
)
_LATENCY = (
    "set the latency timer of its adapter to 1 ms (echo 1 | sudo tee "
    "/sys/bus/usb-serial/devices/ttyUSB0/latency_timer), as docs/building.md says"
)


@dataclass(slots=True)
class Checkup:
    """Result of a checkup, filled as it goes on.

    Parameters
    ----------
    ticks, late
        How many ticks were done, and how many came too late.
    work_us
        Time that a tick took to read, render and write, in µs: median and 99th percentile.
    clock_s
        Seconds that the device's clock goes on in one second of the computer's; None if it told no
        time.
    x_mm
        Leftmost and rightmost place of the array's centre.
    host_ms, device_ms, line_ms
        Greatest lateness of the computer, of the device by its own clock, and of the line.
    held_ms
        Usual time from poses to the next poses that came; 0 if they came one by one.
    round_trips_ms
        First percentile, median and 99th percentile of the round trips; empty without any.
    trips_ms
        For each time without frames, when the watchdog's trip was reported; None if it was not.
    counts
        Faults by name, as the device and its line count them.
    wrong
        Clauses on why the device is not fit to be read on.
    """

    ticks: int = 0
    late: int = 0
    work_us: tuple[float, float] = (0.0, 0.0)
    clock_s: float | None = None
    x_mm: tuple[float, float] | None = None
    host_ms: float = 0.0
    device_ms: float = 0.0
    line_ms: float = 0.0
    held_ms: float = 0.0
    round_trips_ms: list[float] = field(default_factory=list)
    trips_ms: list[float | None] = field(default_factory=list)
    counts: dict[str, int] = field(default_factory=dict)
    wrong: list[str] = field(default_factory=list)

    @property
    def fit(self) -> bool:
        """Tell if the device is fit to be read on."""
        return not self.wrong

    def to_json(self) -> dict[str, Any]:
        """All of it, for JSON."""
        return {"fit": self.fit, **asdict(self)}


class Watch:
    """A device whose `read` and `write` are timed, and looked at: what no driver may give.

    Such as NaN goes no further than here. All else is the device's own.

    Parameters
    ----------
    device
        An open device.
    clock
        The clock by which calls are timed.
    """

    def __init__(self, device: Device, clock: Clock) -> None:
        self._device, self._clock = device, clock
        self._spent_ns: dict[str, list[int]] = {"read": [], "write": []}
        self.found: dict[str, str] = {}
        self._last, self._last_ns = Pose(-(1 << 62), math.nan), 0

    def __getattr__(self, name: str) -> Any:
        return getattr(self._device, name)

    def faults(self) -> list[str]:
        """Clauses on what was wrong with the driver so far, each kind of fault once."""
        period_ms = 1e3 / self._device.display.rate_hz
        median_ms = {name: np.median(ns or [0]) / 1e6 for name, ns in self._spent_ns.items()}
        if sum(median_ms.values()) > _MOST_OF_TICK * period_ms:
            told = " and ".join(f"its {name} takes {ms:.2f} ms" for name, ms in median_ms.items())
            wrong = f"{told}, of the {period_ms:g} ms that a tick has; neither may wait"
            self.found.setdefault("slow", wrong)
        return list(self.found.values())

    def write(self, frame: NDArray[np.float64]) -> bool:
        """Send a frame."""
        return self._timed("write", frame)

    def read(self) -> Pose | None:
        """Newest pose since the last call, if it is one; see `vbraille.devices.base.Device`."""
        sample: object = self._timed("read")
        if sample is None:
            return None
        if not isinstance(sample, Pose) or not all(map(math.isfinite, sample)):
            wrong = f"its read gives {sample!r}, where it must give a Pose of numbers or None"
            self.found.setdefault("kind", wrong)
            return None
        device, last, now_ns = self._device, self._last, self._clock.now_ns()
        turned = sample.theta_rad and not device.display.turns
        back_ms = (last.time_ns - sample.time_ns) / 1e6
        elapsed_s = max((now_ns - self._last_ns) / NS_PER_S, 1 / device.display.rate_hz)
        # The first pose follows none: NaN is no jump.
        far_mm = max(abs(sample.x_mm - last.x_mm), abs(sample.y_mm - last.y_mm))
        wrong = {
            "its read gives a place while it waits to be shown one; it must give None": (
                device.placing is not Placing.DONE
            ),
            f"its read gives an angle of {sample.theta_rad:g} rad, and its Display has no "
            f"turns=True": turned,
            f"its clock goes back, once by {back_ms:g} ms": back_ms > 0,
            f"its carriage jumps, once by {far_mm:.4g} mm in {1e3 * elapsed_s:.3g} ms, faster than "
            f"any hand": far_mm > JUMP_MM_S * elapsed_s,
        }
        for sentence, is_wrong in wrong.items():
            if is_wrong:
                self.found.setdefault(sentence[:_ALIKE], sentence)
        self._last, self._last_ns = sample, now_ns
        return sample._replace(theta_rad=0.0) if turned else sample

    def _timed(self, name: str, *given: Any) -> Any:
        begun_ns = self._clock.now_ns()
        try:
            return getattr(self._device, name)(*given)
        finally:
            self._spent_ns[name].append(self._clock.now_ns() - begun_ns)


@contextmanager
def taking_parts(most: int = 5) -> Iterator[list[str]]:
    """Have `os.write` and `socket.send` take a few bytes of each message at first, as lines may.

    Gives a list, to which a clause is added if what is sent next is not the rest of it.
    """
    faults: list[str] = []
    rest: dict[object, bytes] = {}
    real_write, real_send = os.write, socket.socket.send

    def part(key: object, data: Any) -> bytes:
        data, left = bytes(data), rest.pop(key, b"")
        if left and not data.startswith(left):
            faults[:] = ["its write does not finish a message that the line took in part"]
        if not left and len(data) > most:
            rest[key] = data[most:]
            return data[:most]
        return data

    def send(self: socket.socket, data: Any, *flags: int) -> int:
        whole = self.type is not socket.SOCK_STREAM
        return real_send(self, data if whole else part(self, data), *flags)

    os.write = lambda descriptor, data: real_write(descriptor, part(descriptor, data))
    socket.socket.send = send
    try:
        yield faults
    finally:
        os.write, socket.socket.send = real_write, real_send


def finishes_parts(device: Device) -> list[str]:
    """Clause on a driver that does not finish a frame that the line took in part."""
    frame = np.zeros(device.display.shape)
    with taking_parts() as faults:
        for _ in range(2 * _PARTS):
            device.write(frame)
    device.write(frame)
    return faults


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
    return _Check(device, clock, say).run(rate_s)


class _Check:
    """One check; each of its parts says what it measured and gives what is wrong."""

    def __init__(self, device: Device, clock: Clock, say: Callable[[str], None]) -> None:
        self._watch = Watch(device, clock)
        self._device: Any = self._watch  # to all others it is the device
        self._clock, self._say = clock, say
        self._rate_hz = device.display.rate_hz
        self._counted = dict(device.counts())  # before
        self._shown = False  # whether its place was chosen here, and says nothing
        self._found = Checkup()

    def run(self, rate_s: float) -> Checkup:
        device, found = self._device, self._found
        self._wait_for_place()
        for row, column in np.ndindex(*device.display.shape):
            self._say(f"actuator: row {row + 1}, column {column + 1}")
            self._drive(_SWING_S, lambda share: math.sin(math.pi * share), (row, column))
        self._hold_rate(rate_s)
        found.wrong += [*self._rate(), *self._time(), *self._place(), *self._round_trips()]
        counts = device.counts().items()
        found.counts = {name: count - self._counted.get(name, 0) for name, count in counts}
        for name, count in found.counts.items():
            self._say(f"{name}: {count}")
            found.wrong += [f"{name}: {count}"] * (count > _MOST_FAULTS)
        notes = told(device.take_events())
        found.wrong += [*self._watchdog(), *self._watch.faults()]
        # Its trips were asked for.
        notes += told(e for e in device.take_events() if not isinstance(e, WatchdogTripped))
        for sentence in notes:
            self._say(sentence)
        found.wrong += finishes_parts(device)
        try:
            device.close()
        except Exception as fault:  # of a driver
            wrong = f"its driver cannot let it go ({type(fault).__name__}: {fault})"
            found.wrong.append(wrong)
        untold = ["what it has taken"] * (not device.acknowledges)
        untold += ["its watchdog"] * (device.watchdog_trips is None)
        but = f", but {' and '.join(untold)} could not be tested" if untold else ""
        not_fit = f"not fit to be read on: {'; '.join(found.wrong)}"
        self._say(f"verdict: {not_fit if found.wrong else f'fit to be read on{but}'}")
        return found

    def _wait_for_place(self) -> None:
        """Wait for any place, or a wrong one: frames are not taken without one."""
        device, clock = self._device, self._clock
        begun_ns, asked = clock.now_ns(), False
        while device.read() is None and not self._watch.found:
            if device.placing is Placing.STOP and not self._shown:
                device.set_zero()
                self._shown = True
            elif device.placing is Placing.MARK and not asked:
                asked = True
                self._say("place: move the carriage over its mark")
            if clock.now_ns() - begun_ns > _PLACE_S * NS_PER_S:
                raise DeviceError(f"{device.display.name} gives no place; look at its encoder")
            clock.sleep_until_ns(clock.now_ns() + 1_000_000)

    def _drive(
        self, seconds: float, level: Callable[[float], float], at: Any = slice(None)
    ) -> NDArray[np.void]:
        """Send frames for a while, at the device's rate.

        Parameters
        ----------
        seconds
            How long.
        level
            Deflection at a share of that time; from where the device went to rest by itself it is
            0, so that nothing jumps.
        at
            Actuators that have it; the others rest.

        Returns
        -------
        _TICK[n]
            What was measured in each tick.
        """
        device, clock, rate_hz = self._device, self._clock, self._rate_hz
        period_ns = round(NS_PER_S / rate_hz)
        frame, was = np.zeros(device.display.shape), (device.rested, device.taking)
        ticks = np.zeros(max(round(seconds * rate_hz), 2), _TICK)
        due_ns = clock.now_ns()
        for n, tick in enumerate(ticks):
            due_ns, begun_ns = due_ns + period_ns, clock.now_ns()
            clock.sleep_until_ns(due_ns)
            woke_ns = clock.now_ns()
            sample = device.read() or Pose(0, math.nan)
            frame[at] = level(n / ticks.size) * ((device.rested, device.taking) == was)
            device.write(frame)
            done_ns, taken_ns = clock.now_ns(), device.acknowledged_ns
            tick["late_ns"], tick["host_ns"] = woke_ns - due_ns, woke_ns - max(due_ns, begun_ns)
            tick["work_ns"], tick["came_ns"] = done_ns - woke_ns, woke_ns
            tick["device_ns"], tick["x_mm"] = sample[:2]
            tick["taken_ns"] = math.nan if taken_ns is None else taken_ns
            due_ns = max(due_ns, done_ns - period_ns)  # what is late is not caught up with
        return ticks

    def _hold_rate(self, seconds: float) -> None:
        """Drive the device at its rate for some seconds; all actuators swell and sink."""
        found, period_ms = self._found, 1e3 / self._rate_hz
        times = max(round(seconds), 1)
        ticks = self._drive(seconds, lambda share: math.sin(math.pi * times * share) ** 2)
        found.ticks, found.late = ticks.size, int((ticks["late_ns"] > period_ms * 1e6).sum())
        found.work_us = tuple(np.percentile(ticks["work_ns"] / 1e3, (50, 99)).tolist())
        found.host_ms = float(ticks["host_ns"].max()) / 1e6
        taken_ms = ticks["taken_ns"][~np.isnan(ticks["taken_ns"])] / 1e6
        if taken_ms.size:
            found.round_trips_ms = np.percentile(taken_ms, (1, 50, 99)).tolist()
        known = ticks[~np.isnan(ticks["x_mm"])]
        if known.size < 4:
            return
        found.x_mm = float(known["x_mm"].min()), float(known["x_mm"].max())
        arrived, taken = np.diff(known["came_ns"]) / 1e6, np.diff(known["device_ns"]) / 1e6
        usual_ms = float(np.median(arrived))
        found.held_ms = usual_ms if usual_ms > _HELD_PERIODS * period_ms else 0.0
        found.line_ms = max(float((arrived - taken).max()), 0.0)
        if not found.held_ms:
            found.device_ms = max(float(taken.max()) - period_ms, 0.0)
        # Over half of the time each, and their median: samples that came late weigh little.
        half = known.size // 2
        passed = {
            name: known[name][half:] - known[name][:-half] for name in ("came_ns", "device_ns")
        }
        found.clock_s = float(np.median(passed["device_ns"] / np.maximum(passed["came_ns"], 1)))

    def _rate(self) -> Iterator[str]:
        found = self._found
        self._say(f"rate: {self._rate_hz:g} Hz, {found.late} of {found.ticks} ticks late")
        median_us, most_us = found.work_us
        self._say(f"work: median {median_us:.0f} µs, 99 % under {most_us:.0f} µs")
        self._say(
            f"late: this computer by {found.host_ms:.1f} ms at most, the device by "
            f"{found.device_ms:.1f} ms, the line by {found.line_ms:.1f} ms"
        )
        if found.held_ms:
            yield f"the line holds bytes back for {found.held_ms:.0f} ms; {_LATENCY}"
        elif found.late / found.ticks > _MOST_LATE:
            yield f"{found.late / found.ticks:.1%} of the ticks come late on this computer"

    def _time(self) -> Iterator[str]:
        clock_s = self._found.clock_s
        if clock_s is None:
            yield "it told neither its time nor its place"
            return
        self._say(
            f"clock: {clock_s:.3f} s pass on it in a second, {1 - _MOST_CLOCK:g} to "
            f"{1 + _MOST_CLOCK:g} s are allowed"
        )
        if abs(clock_s - 1) > _MOST_CLOCK:
            yield f"its clock goes {clock_s:.2f} times as fast as it should"

    def _place(self) -> Iterator[str]:
        info, x_mm = self._device.display, self._found.x_mm
        if self._shown or x_mm is None:
            why = f"its reader must show it {shown_place(info)}" if self._shown else "none was told"
            self._say(f"place: not tested, since {why}")
            return
        edge = "left edge" if info.height_mm else "left stop"
        low_mm, high_mm = (round(mm + info.span_mm / 2, 1) + 0.0 for mm in x_mm)
        self._say(
            f"place: {low_mm:.1f} to {high_mm:.1f} mm from the {edge}, of {info.travel_mm:g} mm"
        )
        off_mm = low_mm if low_mm < -_PLACE_SLACK_MM else high_mm
        if not -_PLACE_SLACK_MM <= off_mm <= info.travel_mm + _PLACE_SLACK_MM:
            yield (
                f"its carriage is at {off_mm:.1f} mm from the {edge}, where it cannot be; see to "
                f"{shown_place(info)}, its counts and their sign"
            )

    def _round_trips(self) -> Iterator[str]:
        if not self._device.acknowledges:
            self._say("round trip: not tested, since this device does not say what it has taken")
        elif not self._found.round_trips_ms:
            self._say("round trip: none, for no frame was acknowledged")
            yield "it acknowledges none of the frames that it is sent"
        else:
            low, median, high = self._found.round_trips_ms
            self._say(f"round trip: median {median:.2f} ms, 98 % within {low:.2f} to {high:.2f} ms")
            if median > _MOST_ROUND_TRIP_MS and not self._found.held_ms:
                took = f"a round trip takes {median:.1f} ms"
                yield f"{took}, so the line holds bytes back; {_LATENCY}"

    def _watchdog(self) -> Iterator[str]:
        """Leave the device without frames several times, and see how long it takes to say so."""
        if self._device.watchdog_trips is None:
            self._say("watchdog: not tested, since this device does not tell of one")
            return
        self._say("watchdog: the device is sent nothing now, so that it trips")
        trips = self._found.trips_ms = [self._trip_ms() for _ in range(_TRIPS)]
        tripped = [ms for ms in trips if ms is not None]
        if not tripped:
            self._say("watchdog: no trip was reported")
            yield "its watchdog does not trip when no frame comes; do not read on it"
            return
        after_ms = float(np.median(tripped))
        self._say(
            f"watchdog: tripped {len(tripped)} of {_TRIPS} times, {after_ms:.1f} ms after the last "
            f"frame, and so at rest after {after_ms + RAMP_MS:.1f} ms; {REST_MS} ms are promised"
        )
        if len(tripped) < _TRIPS:
            yield f"its watchdog trips {len(tripped)} of {_TRIPS} times that no frame comes"
        elif not _EARLIEST_TRIP_MS <= after_ms <= REST_MS - RAMP_MS + _REPORT_MS:
            how = "early" if after_ms < WATCHDOG_MS else "late"
            when = f"its watchdog trips after {after_ms:.0f} ms, too {how}"
            yield f"{when}; {WATCHDOG_MS} ms are right"

    def _trip_ms(self) -> float | None:
        """Send nothing, with the actuators off their rest, until the device's watchdog trips."""
        device, clock = self._device, self._clock
        # It takes frames again, and the actuators go out and stay there for half of the time.
        self._drive(3 * _HOLD_S, lambda share: _HELD * min(max(4 * share - 1, 0), 1))
        trips = device.watchdog_trips
        # It is not read meanwhile either: a host that owes frames tells the device to rest.
        clock.sleep_until_ns(clock.now_ns() + round(_TRIP_PATIENCE_S * NS_PER_S))
        taken_ms = None
        for _ in range(round(_TRIP_PATIENCE_S * 1e3)):
            device.read()
            if device.watchdog_trips != trips:
                taken_ms = device.tripped_ms
                break
            clock.sleep_until_ns(clock.now_ns() + 1_000_000)
        self._drive(2 * _HOLD_S, lambda _: 0.0)  # it rests by now
        return taken_ms
