"""The loop: read the carriage, make the frame, write it; and an engine that runs it."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import numpy as np

from vbraille.devices.serial.kernels import example
from vbraille.display import Pose
from vbraille.engine import serialtick
from vbraille.engine.constants import FADE_S, IDLE_S, NS_PER_S
from vbraille.engine.record import FLAGS, LATE, LATENESS, OVERRUNS, WORK, Flag, Ring, Tally
from vbraille.engine.state import LoopState
from vbraille.engine.ticks import POSE_THETA, POSE_X, POSE_Y, POSED
from vbraille.errors import DeviceError

if TYPE_CHECKING:
    from collections.abc import Mapping
    from typing import Any

    from numpy.typing import NDArray

    from vbraille.devices.base import Device
    from vbraille.devices.events import Event
    from vbraille.devices.serial.device import SerialDevice
    from vbraille.devices.serial.kernels import SteadyConversation
    from vbraille.display import Display
    from vbraille.engine.clock import Clock
    from vbraille.engine.mailbox import Mailbox
    from vbraille.render.program import Program
# Plain numbers, since joining flags of an enumeration takes a microsecond.
_HELD = int(Flag.HELD)
# How often compiled ticks are interrupted to look for signals, for the parent and for events.
_LOOK_S = 0.02
_SAME_RATE = 0.01
# A STATE may begin a tick up to a period, divided by this, before or after its deadline.
_GUARD = 4
_PLACING = (0, int(Flag.MARK), int(Flag.STOP))  # the flag for each `Placing`


class Loop:
    """Drive a device, tick by tick, in plain Python but for what `LoopState.advance` does.

    Parameters
    ----------
    device
        An open device. The loop writes rest before it lets go of it, and leaves closing to its
        opener.
    clock
        The clock by which ticks are due.
    rate_hz
        Ticks a second.
    fade_s
        Duration of a change that the hand did not cause.
    idle_s
        Time without motion before the array goes to rest.
    ring
        Ring in which every tick is recorded; without it only the last tick is kept.

    Attributes
    ----------
    state : State
        What a tick knows from the ticks before it.
    late, overruns : int
        Number of deadlines that passed before their tick could begin, and of ticks whose own work
        took longer than a period.

    Raises
    ------
    ValueError
        If the rate is not 1 to 10,000 Hz.
    """

    def __init__(
        self,
        device: Device,
        clock: Clock,
        *,
        rate_hz: float = 1000.0,
        fade_s: float = FADE_S,
        idle_s: float = IDLE_S,
        ring: Ring | None = None,
    ) -> None:
        self.device = device
        # It is known by its method: its module loads pyserial, which no other device needs.
        self._serial = cast("SerialDevice", device) if hasattr(device, "begin_steady") else None
        self.clock = clock
        self.rate_hz = rate_hz
        display = device.display
        self.state = LoopState(
            display,
            rate_hz,
            clock.now_ns(),
            fade_s=fade_s,
            idle_s=idle_s,
            rested=device.rested,
        )
        self.ring = ring or Ring.alone(display.shape, 2)
        self.late = self.overruns = 0
        self._times_ns = np.zeros((1, 2), np.int64)
        self._poses = np.zeros((1, 4))
        self._fade_ns = int(fade_s * NS_PER_S)
        self._period_ns = round(NS_PER_S / rate_hz)
        self._deadline_ns = clock.now_ns()
        self._told = np.zeros(serialtick.TOLD, np.int64)
        self._told[serialtick.MOST] = max(1, round(_LOOK_S * rate_hz))
        self._told[serialtick.PERIOD] = self._period_ns
        # Where a device tells its place as often as there are ticks, each STATE begins a tick.
        same = abs(display.rate_hz - rate_hz) <= _SAME_RATE * rate_hz
        self._told[serialtick.GUARD] = self._period_ns // _GUARD if same else 0
        self._silence = np.zeros(1, np.int64), np.zeros(1, np.int64)

    def show(self, picture: Program | None, line: int = 0) -> None:
        """Put another picture under the hand; it fades in.

        None stands for rest. ``line`` is the number by which records call it.
        """
        self.state.want(picture, line)

    @property
    def output(self) -> NDArray[np.float64]:
        """The frame last sent, float64[rows, columns]."""
        return self.state.output

    @property
    def x_mm(self) -> float | None:
        """Place of the array's centre along x; None before the first pose."""
        now = self.state.now
        return float(now["x_mm"]) if now["placed"] else None

    @property
    def tally(self) -> Tally:
        """Counts of what happened so far."""
        now = self.state.now
        return Tally(
            ticks=int(now["tick"]),
            late=self.late,
            overruns=self.overruns,
            forward_mm=float(now["forward_mm"]),
            forward_s=float(now["forward_s"]),
        )

    @property
    def paused(self) -> bool:
        """Tell whether the array rests until told otherwise; setting it takes effect at once."""
        return bool(self.state.now["paused"])

    @paused.setter
    def paused(self, paused: bool) -> None:
        self.state.pause(paused, self.clock.now_ns())

    @property
    def switches(self) -> int:
        """States of a scene's switches, as `vbraille.scene.signals.packed` has them.

        Setting them takes effect with the next tick.
        """
        return int(self.state.now["switches"])

    @switches.setter
    def switches(self, switches: int) -> None:
        self.state.switch(switches, self.clock.now_ns())

    @property
    def resting(self) -> bool:
        """Tell whether every actuator was at rest in the frame last sent."""
        return not self.output.any()

    def take_events(self) -> list[Event]:
        """Take the events of the device and of the picture since the last call."""
        return [*self.device.take_events(), *self.state.take_events()]

    def run(self, mailbox: Mailbox | None = None) -> None:
        """Do some ticks, until the mailbox says something new or it is time to look around.

        Compiled code does them for a serial device (`SerialDevice.begin_steady`) as long as
        nothing unusual happens; a tick in which something does is done in Python.

        Raises
        ------
        DeviceError
            If the device is gone, or says that its carriage is where none can be.
        """
        steady = None if self._serial is None else self._serial.begin_steady()
        if self._serial is None or steady is None:
            self.tick()
        else:
            self._run_steadily(self._serial, steady, mailbox)

    def tick(self) -> None:
        """Wait for the next deadline; then read, make the frame and write it.

        Raises
        ------
        DeviceError
            If the device is gone, or says that its carriage is where none can be.
        """
        if self.device.ahead_ns:
            self.clock.sleep_until_ns(self._deadline_ns - self.device.ahead_ns)
            self.device.ask()
        self.clock.sleep_until_ns(self._deadline_ns)
        now_ns = self.clock.now_ns()
        self._tick(now_ns, now_ns - self._deadline_ns, None)

    def _tick(self, now_ns: int, lateness_ns: int, taken: Pose | None) -> None:
        """Do the tick that has just begun; its pose may have been read already."""
        busy_ns = self.clock.busy_ns()
        device, ring = self.device, self.ring
        times_ns, pose = self._times_ns, self._poses[0]
        times_ns[0, 0] = now_ns
        sample = device.read() or taken
        taking = device.taking
        if sample is None:
            pose[POSED] = 0.0
        else:
            times_ns[0, 1], pose[POSE_X], pose[POSE_Y], pose[POSE_THETA] = sample
            pose[POSED] = 1.0
            if pose[POSE_THETA] and not device.display.turns:
                raise self._nowhere()
        slot = ring.begin()
        done = self.state.advance(times_ns, self._poses, device.rested, taking, ring.columns, slot)
        if not done:
            raise self._nowhere()
        device.write(self.state.output)
        done_ns = self.clock.now_ns()
        if done_ns - now_ns > self._period_ns and self.clock.busy_ns() - busy_ns > self._period_ns:
            self.overruns += 1
        self._finish(slot, now_ns, lateness_ns, done_ns, taking=taking)

    def _finish(
        self, slot: int, now_ns: int, lateness_ns: int, done_ns: int, *, taking: bool
    ) -> None:
        """Record when a tick was done, and set when the next one is due."""
        # Deadlines stand where the start put them; one that has passed is counted, never chased.
        self.state.done_ns[0] = done_ns
        self._deadline_ns += self._period_ns
        behind_ns = done_ns - self._deadline_ns
        if behind_ns >= self._period_ns:
            missed = behind_ns // self._period_ns
            self.late += missed
            self._deadline_ns += missed * self._period_ns
        device, ring = self.device, self.ring
        whole = ring.integers
        whole[slot, LATENESS], whole[slot, WORK] = lateness_ns, done_ns - now_ns
        whole[slot, LATE], whole[slot, OVERRUNS] = self.late, self.overruns
        if not (taking and device.taking) or device.placing:  # a write may have brought it to rest
            held = 0 if device.taking else _HELD
            whole[slot, FLAGS] = (whole[slot, FLAGS] & ~_HELD) | held | _PLACING[device.placing]
        ring.end()

    def _nowhere(self) -> DeviceError:
        x_mm, y_mm, theta_rad = self._poses[0, POSE_X:]
        display = self.device.display
        where = f"{x_mm} mm"
        if "y" in display.axes or y_mm:
            where += f" along x and {y_mm} mm along y"
        if "θ" in display.axes or theta_rad:
            where += f", turned by {theta_rad} rad"
        says = f"{display.name} says that its carriage is at {where}"
        if not np.isfinite(self._poses[0, POSE_X:]).all():
            return DeviceError(
                f"{says}, where it cannot be; its driver must give numbers, or None as long as it "
                f"knows none: tell its author"
            )
        if theta_rad and not display.turns:
            return DeviceError(
                f"{says}, and that it measures no angle; its driver must give Display turns=True, "
                f"or Pose no angle: tell its author"
            )
        return DeviceError(
            f"{says}, where it cannot be; switch it off and on, and if it says so again, look at "
            f"its encoder and its counts with 'vbraille device check'"
        )

    def _run_steadily(
        self, device: SerialDevice, steady: SteadyConversation, mailbox: Mailbox | None
    ) -> None:
        """Do ticks in compiled code, and in Python the one that compiled code stopped at."""
        told, ring = self._told, self.ring
        told[serialtick.DESCRIPTOR], told[serialtick.HELD] = steady.descriptor, steady.begun
        told[serialtick.DEADLINE], told[serialtick.APPENDED] = self._deadline_ns, ring.appended
        told[serialtick.LATE_SO_FAR], told[serialtick.OVERRUNS_SO_FAR] = self.late, self.overruns
        told[serialtick.UNSENT], told[serialtick.RESTED] = 0, self.device.rested
        orders, known = self._silence if mailbox is None else (mailbox.orders, mailbox.obeyed)
        why = self.state.run_steadily(
            told, orders, known, steady, self._times_ns, self._poses, ring
        )
        done = int(told[serialtick.APPENDED]) - ring.appended
        ring.end(done)
        self.late = int(told[serialtick.LATE_SO_FAR])
        self._deadline_ns = int(told[serialtick.DEADLINE])
        woken_ns, lateness_ns = int(told[serialtick.WOKEN]), int(told[serialtick.LATENESS_OF_IT])
        unwritten = slice(told[serialtick.WRITTEN], told[serialtick.SIZE])
        torn = bytes(steady.out[unwritten]) if why == serialtick.TORN else b""
        device.end_steady(int(told[serialtick.HELD]), int(told[serialtick.UNSENT]), torn)
        if why == serialtick.NOWHERE:
            raise self._nowhere()
        if why == serialtick.UNMADE:
            slot = ring.begin()
            self.device.write(self.state.output)
            self._finish(slot, woken_ns, lateness_ns, self.clock.now_ns(), taking=True)
        elif woken_ns:
            pose = self._poses[0]
            taken = None
            if pose[POSED]:
                taken = Pose(int(self._times_ns[0, 1]), *pose[POSE_X:].tolist())
            self._tick(woken_ns, lateness_ns, taken)
        elif not done:
            self.tick()

    def load(self) -> None:
        """Load or compile the code of steady ticks, without doing one."""
        told, silence = np.zeros(serialtick.TOLD, np.int64), np.zeros(1, np.int64)
        self.state.run_steadily(
            told,
            silence,
            silence,
            example(self.device.display),
            self._times_ns,
            self._poses,
            self.ring,
        )

    def restart_clock(self) -> None:
        """Make the next tick due now, after a time in which the loop did not run."""
        self._deadline_ns = self.clock.now_ns()

    def fade_to_rest(self) -> None:
        """Bring every actuator to rest, over the usual time.

        The device is not read meanwhile: its carriage may be what has failed.

        Raises
        ------
        DeviceError
            If the device is gone.
        """
        self.state.want(None, 0)
        self.state.hold()
        self._deadline_ns = self.clock.now_ns()
        faded_ns = 0
        while not self.resting:
            self._deadline_ns = max(self._deadline_ns + self._period_ns, self.clock.now_ns())
            self.clock.sleep_until_ns(self._deadline_ns)
            faded_ns += self._period_ns
            self.state.fade(faded_ns / self._fade_ns if faded_ns < self._fade_ns else 1.0)
            self.device.write(self.output)
        while self.device.uncorrect():
            self._deadline_ns = max(self._deadline_ns + self._period_ns, self.clock.now_ns())
            self.clock.sleep_until_ns(self._deadline_ns)
            self.device.write(self.output)


class LocalEngine(Loop):
    """An engine in this process, for a device that a program has, tests and clocks turned by hand.

    Parameters
    ----------
    device
        An open device, which its opener closes.
    clock
        The clock by which ticks are due.
    rate_hz
        Ticks a second.
    poll_ticks
        How many ticks each poll does.

    Attributes
    ----------
    lost : int
        Number of ticks that were never polled; always 0.
    """

    lost = 0

    def __init__(
        self, device: Device, clock: Clock, *, rate_hz: float = 1000.0, poll_ticks: int = 1
    ) -> None:
        # One more than a poll's: a view of a single record is of a type of its own, for which
        # ticks would be compiled again.
        ring = Ring.alone(device.display.shape, poll_ticks + 1)
        super().__init__(device, clock, rate_hz=rate_hz, ring=ring)
        self._reader = ring.reader()
        self.poll_ticks = poll_ticks

    @property
    def display(self) -> Display:
        """The actuators and the carriage of the device."""
        return self.device.display

    def poll(self) -> NDArray[np.void]:
        """Do some ticks; return their records."""
        for _ in range(self.poll_ticks):
            self.tick()
        return self._take()

    def _take(self) -> NDArray[np.void]:
        self.ring.publish()
        return self._reader.drain()

    def set_zero(self) -> None:
        """Say that the carriage is at the left stop now."""
        self.device.set_zero()

    @property
    def calibration(self) -> dict[str, Any] | None:
        """Tell what is made up for in the device's actuators, as `Calibration.to_json` says it."""
        found = self.device.calibration
        return None if found is None else found.to_json()

    @property
    def counts(self) -> Mapping[str, int]:
        """Tell what went wrong with the device, by name."""
        return self.device.counts()

    def start(self) -> None:
        """Begin with the next poll: what has gone by until now is not late."""
        self.restart_clock()

    def close(self) -> None:
        """Have the array fade to rest; the device's opener closes it."""
        self.fade_to_rest()
