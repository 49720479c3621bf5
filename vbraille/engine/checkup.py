"""The checkup of a device for its builder: measurements, limits, and whether it may be read on.

Actuators swing; rate, clock, place, round trip and watchdog are measured; and the computer, the
line and the device are told apart where something is late.
"""

from __future__ import annotations

import math
import os
import socket
from contextlib import contextmanager
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np

from vbraille.devices.events import Placing, shown_place, told
from vbraille.devices.protocol import RAMP_MS, REST_MS, WATCHDOG_MS
from vbraille.display import Pose
from vbraille.engine.constants import JUMP_MM_S, NS_PER_S
from vbraille.errors import DeviceError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from vbraille.devices.base import Device
    from vbraille.engine.clock import Clock

    _Row = NDArray[np.float64]
    Lines = Iterator[tuple[str, str]]  # each with what is wrong, or an empty text

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
_PARTS, _PART_BYTES = 5, 5  # frames of which a line takes a part at first, and that part
_LATENCY = (
    "set the latency timer of its adapter to 1 ms (echo 1 | sudo tee "
    "/sys/bus/usb-serial/devices/ttyUSB0/latency_timer), as docs/building.md says"
)


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
        self._spent_ns: list[int] = []  # by each call
        self.found: dict[str, str] = {}
        self._last, self._last_ns = Pose(-(1 << 62), math.nan), 0

    def __getattr__(self, name: str) -> Any:
        return getattr(self._device, name)

    def faults(self) -> list[str]:
        """Clauses on what was wrong with the driver so far, each kind of fault once."""
        period_ms = 1e3 / self._device.display.rate_hz
        call_ms = float(np.median(self._spent_ns or [0])) / 1e6
        if 2 * call_ms > _MOST_OF_TICK * period_ms:
            self.found["slow"] = (
                f"its read and write take {call_ms:.2f} ms each, of the {period_ms:g} ms that a "
                f"tick has; neither may wait"
            )
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
        # Poses that the line held back come soon after one another: their own times count, too.
        elapsed_s = max(now_ns - self._last_ns, sample.time_ns - last.time_ns) / NS_PER_S
        elapsed_s = max(elapsed_s, 1 / device.display.rate_hz)
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
            self._spent_ns.append(self._clock.now_ns() - begun_ns)


@contextmanager
def taking_parts() -> Iterator[list[str]]:
    """Have `os.write` and `socket.send` take a few bytes of each message at first, as lines may.

    Gives a list, to which a clause is added if what is sent next is not the rest of it.
    """
    faults: list[str] = []
    rest: dict[object, bytes] = {}  # of messages that were taken in part, by where they go
    real_write, real_send = os.write, socket.socket.send

    def part(key: object, data: Any) -> bytes:
        left = rest.pop(key, b"")
        if left and not bytes(data).startswith(left):
            faults[:] = ["its write does not finish a message that the line took in part"]
        if left or len(data) <= _PART_BYTES:
            return data
        rest[key] = bytes(data[_PART_BYTES:])
        return data[:_PART_BYTES]

    def send(self: socket.socket, data: Any, *flags: int) -> int:
        stream = self.type is socket.SOCK_STREAM
        return real_send(self, part(self, data) if stream else data, *flags)

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


class Checkup:
    """A measurement of a device, done by `run`.

    Parameters
    ----------
    device, clock
        The device, opened, and the clock that its time is measured by.
    say
        Takes a line.

    Attributes
    ----------
    values : dict
        What was measured, by name. ``ticks`` and ``late``: how many ticks were done, and how many
        came too late. ``host_ms``, ``device_ms`` and ``line_ms``: greatest lateness of the
        computer, of the device by its own clock, and of the line. ``held_ms``: usual time from
        poses to the next poses that came; 0 if they came one by one. ``clock_s``: seconds that the
        device's clock goes on in one of the computer's. ``x_mm``: leftmost and rightmost place of
        the array's centre. ``round_trips_ms``: first percentile, median and 99th. ``trips_ms``: for
        each time without frames, when the watchdog's trip was reported, or None. ``counts``: faults
        by name, as the device and its line count them. What could not be measured is missing.
    wrong : list of str
        Clauses on why the device is not fit to be read on.
    """

    def __init__(self, device: Device, clock: Clock, say: Callable[[str], None]) -> None:
        self.values: dict[str, Any] = {}
        self.wrong: list[str] = []
        self._watch = Watch(device, clock)
        self._device: Any = self._watch  # to all others it is the device
        self._clock, self._say = clock, say
        self._rate_hz = device.display.rate_hz
        self._shown = False  # whether its place was chosen here, and says nothing

    def to_json(self) -> dict[str, Any]:
        """All of it, for JSON."""
        return {"fit": not self.wrong, **self.values, "wrong": self.wrong}

    def run(self, rate_s: float = _RATE_S) -> bool:
        """Measure; say what was measured, one thing a line, and last the verdict.

        Parameters
        ----------
        rate_s
            For how long the device is held to its rate, in seconds.

        Returns
        -------
        bool
            Whether the device is fit to be read on.

        Raises
        ------
        DeviceError
            If the device is gone, or gives no place within a minute.
        """
        device = self._device
        self._wait_for_place()
        for row, column in np.ndindex(*device.display.shape):
            self._say(f"actuator: row {row + 1}, column {column + 1}")
            self._drive(_SWING_S, lambda share: math.sin(math.pi * share), (row, column))
        # All actuators swell and sink.
        times = max(round(rate_s), 1)
        ticks = self._drive(rate_s, lambda share: math.sin(math.pi * times * share) ** 2)
        untold = []
        lines = self._timing(*ticks), self._taking(*ticks), self._counts(), self._watchdog()
        for said, wrong in chain(*lines):
            self._say(said)
            self.wrong += [wrong] * bool(wrong)
            untold += [said.partition(":")[0]] * (": not tested" in said)
        self.wrong += [*self._watch.faults(), *finishes_parts(device)]
        verdict = f"fit to be read on{', but not tested: ' * bool(untold)}{', '.join(untold)}"
        if self.wrong:
            verdict = f"not fit to be read on: {'; '.join(self.wrong)}"
        self._say(f"verdict: {verdict}")
        return not self.wrong

    def _wait_for_place(self) -> None:
        """Wait for any place, or a wrong one: frames are not taken without one."""
        device, clock = self._device, self._clock
        begun_ns = clock.now_ns()
        while device.read() is None and not self._watch.found:
            if device.placing is Placing.STOP and not self._shown:
                device.set_zero()
                self._shown = True
            if clock.now_ns() - begun_ns > _PLACE_S * NS_PER_S:
                raise DeviceError(f"{device.display.name} gives no place; look at its encoder")
            clock.sleep_until_ns(clock.now_ns() + 1_000_000)

    def _drive(
        self, seconds: float, level: Callable[[float], float], at: Any = slice(None)
    ) -> NDArray[np.float64]:
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
        float64[6, n]
            For each tick, in ms: from when it was due to when it began; the part of that for which
            this computer alone is to blame; when its pose came, by the computer's clock and by the
            device's; then x in mm, NaN without a pose; and how long a frame took to be
            acknowledged, NaN if that is not known.
        """
        device, clock, rate_hz = self._device, self._clock, self._rate_hz
        period_ns, count = round(NS_PER_S / rate_hz), max(round(seconds * rate_hz), 2)
        frame, was = np.zeros(device.display.shape), (device.rested, device.taking)
        ticks = np.zeros((count, 6))
        due_ns = clock.now_ns()
        for n in range(count):
            due_ns, begun_ns = due_ns + period_ns, clock.now_ns()
            clock.sleep_until_ns(due_ns)
            woke_ns = clock.now_ns()
            sample = device.read() or Pose(0, math.nan)
            frame[at] = level(n / count) * ((device.rested, device.taking) == was)
            device.write(frame)
            taken_ns = device.acknowledged_ns
            taken_ms = math.nan if taken_ns is None else taken_ns / 1e6
            late_ns, host_ns = woke_ns - due_ns, woke_ns - max(due_ns, begun_ns)
            ticks[n, :4] = late_ns / 1e6, host_ns / 1e6, woke_ns / 1e6, sample.time_ns / 1e6
            ticks[n, 4:] = sample.x_mm, taken_ms
            due_ns = max(due_ns, clock.now_ns() - period_ns)  # what is late is not caught up with
        return ticks.T

    def _timing(self, late_ms: _Row, host_ms: _Row, came_ms: _Row, device_ms: _Row, x_mm: _Row,
                _taken_ms: _Row) -> Lines:  # fmt: skip
        """Tell the computer, the line and the device apart."""
        values, period_ms = self.values, 1e3 / self._rate_hz
        late, count = int((late_ms > period_ms).sum()), late_ms.size
        values["ticks"], values["late"], values["host_ms"] = count, late, float(host_ms.max())
        yield f"rate: {self._rate_hz:g} Hz, {late} of {count} ticks late", ""
        came_ms, device_ms = came_ms[~np.isnan(x_mm)], device_ms[~np.isnan(x_mm)]
        if came_ms.size < 4:
            yield "late: not tested, since no poses came", "it told neither its time nor its place"
            return
        arrived_ms, apart_ms = np.diff(came_ms), np.diff(device_ms)
        usual_ms = float(np.median(arrived_ms))
        held_ms = values["held_ms"] = usual_ms if usual_ms > _HELD_PERIODS * period_ms else 0.0
        values["line_ms"] = max(float((arrived_ms - apart_ms).max()), 0.0)
        values["device_ms"] = 0.0 if held_ms else max(float(apart_ms.max()) - period_ms, 0.0)
        wrong = f"{late / count:.1%} of the ticks come late on this computer"
        wrong = wrong if late / count > _MOST_LATE else ""
        if held_ms:
            wrong = f"the line holds bytes back for {held_ms:.0f} ms; {_LATENCY}"
        yield (
            f"late: this computer by {values['host_ms']:.1f} ms at most, the device by "
            f"{values['device_ms']:.1f} ms, the line by {values['line_ms']:.1f} ms",
            wrong,
        )
        # Over half of the time each, and their median: samples that came late weigh little.
        half = came_ms.size // 2
        since_ms = np.maximum(came_ms[half:] - came_ms[:-half], 1e-6)
        clock_s = float(np.median((device_ms[half:] - device_ms[:-half]) / since_ms))
        values["clock_s"], off = clock_s, abs(clock_s - 1) > _MOST_CLOCK
        yield (
            f"clock: {clock_s:.3f} s pass on it in a second, {1 - _MOST_CLOCK:g} to "
            f"{1 + _MOST_CLOCK:g} s are allowed",
            f"its clock goes {clock_s:.2f} times as fast as it should" if off else "",
        )

    def _taking(self, *ticks: _Row) -> Lines:
        """Tell where the carriage was, and when frames were acknowledged."""
        x_mm, taken_ms = (row[~np.isnan(row)] for row in ticks[4:])
        info, values = self._device.display, self.values
        if self._shown or not x_mm.size:
            why = f"its reader must show it {shown_place(info)}" if self._shown else "none was told"
            yield f"place: not tested, since {why}", ""
        else:
            values["x_mm"] = [float(x_mm.min()), float(x_mm.max())]
            edge = "left edge" if info.height_mm else "left stop"
            low_mm, high_mm = (round(mm + info.span_mm / 2, 1) + 0.0 for mm in values["x_mm"])
            off_mm = low_mm if low_mm < -_PLACE_SLACK_MM else high_mm
            near = -_PLACE_SLACK_MM <= off_mm <= info.travel_mm + _PLACE_SLACK_MM
            wrong = (
                f"its carriage is at {off_mm:.1f} mm from the {edge}, where it cannot be; see to "
                f"{shown_place(info)}, its counts and their sign"
            )
            where = f"{low_mm:.1f} to {high_mm:.1f} mm from the {edge}, of {info.travel_mm:g} mm"
            yield f"place: {where}", "" if near else wrong
        if not self._device.acknowledges:
            yield "round trip: not tested, since this device does not say what it has taken", ""
        elif not taken_ms.size:
            wrong = "it acknowledges none of the frames that it is sent"
            yield "round trip: none, for no frame was acknowledged", wrong
        else:
            low, median, high = np.percentile(taken_ms, (1, 50, 99)).tolist()
            values["round_trips_ms"] = [low, median, high]
            slow = median > _MOST_ROUND_TRIP_MS and not values.get("held_ms")
            wrong = f"a round trip takes {median:.1f} ms, so the line holds bytes back; {_LATENCY}"
            said = f"round trip: median {median:.2f} ms, 98 % within {low:.2f} to {high:.2f} ms"
            yield said, wrong if slow else ""

    def _counts(self) -> Lines:
        """Tell what the device and its line counted, and what happened."""
        counts = self.values["counts"] = dict(self._device.counts())
        for name, count in counts.items():
            said = f"{name}: {count}"
            # On a line that holds bytes back frames come too late by no fault of the device.
            faulty = count > _MOST_FAULTS and not self.values.get("held_ms")
            yield said, said if faulty else ""
        for sentence in told(self._device.take_events()):
            yield sentence, ""

    def _watchdog(self) -> Lines:
        """Leave the device without frames several times, and see how long it takes to say so."""
        if self._device.watchdog_trips is None:
            yield "watchdog: not tested, since this device does not tell of one", ""
            return
        yield "watchdog: the device is sent nothing now, so that it trips", ""
        trips = self.values["trips_ms"] = [self._trip_ms() for _ in range(_TRIPS)]
        tripped = [ms for ms in trips if ms is not None]
        if not tripped:
            wrong = "its watchdog does not trip when no frame comes; do not read on it"
            yield "watchdog: no trip was reported", wrong
            return
        after_ms, wrong = float(np.median(tripped)), ""
        if len(tripped) < _TRIPS:
            wrong = f"its watchdog trips {len(tripped)} of {_TRIPS} times that no frame comes"
        elif self.values.get("held_ms"):  # what it says meanwhile may be lost
            yield f"watchdog: tripped {_TRIPS} of {_TRIPS} times, it is not known when", ""
            return
        elif not _EARLIEST_TRIP_MS <= after_ms <= REST_MS - RAMP_MS + _REPORT_MS:
            how = "early" if after_ms < WATCHDOG_MS else "late"
            when = f"its watchdog trips after {after_ms:.0f} ms, too {how}"
            wrong = f"{when}; {WATCHDOG_MS} ms are right"
        yield (
            f"watchdog: tripped {len(tripped)} of {_TRIPS} times, {after_ms:.1f} ms after the last "
            f"frame, and so at rest after {after_ms + RAMP_MS:.1f} ms; {REST_MS} ms are promised",
            wrong,
        )

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
