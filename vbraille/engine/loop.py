"""The loop: read the carriage, make the frame, write it; and an engine that runs it here."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from vbraille.engine import ticks
from vbraille.engine.constants import (
    DIFFERENCE,
    FADE_S,
    GAP_NS,
    GAP_PERIODS,
    MEAN,
    NS_PER_S,
    STEP_NS,
)
from vbraille.engine.engine import Watcher
from vbraille.engine.record import FLAGS, FLOATS, INTS, LATE, LATENESS, WORK, Flag, Ring
from vbraille.engine.ticks import POSE_THETA, POSE_X, POSE_Y, POSED
from vbraille.errors import DeviceError, check_range
from vbraille.render import work
from vbraille.render.program import nothing

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from vbraille.devices.base import Device
    from vbraille.devices.events import Event
    from vbraille.display import Display, Pose
    from vbraille.engine.clock import Clock
    from vbraille.render.program import Program
    from vbraille.simulation.steering import HandOrder

# Plain numbers, since joining flags of an enumeration takes a microsecond.
_HELD = int(Flag.HELD)
_PLACING = (0, int(Flag.STOP))  # the flag for each `Placing`
_SAME_RATE = 0.01
# A pose that is there begins a tick at once, but no sooner than a period, divided by this, after
# the one before; and a tick without one comes so much later than a period.
_GUARD = 4


class Loop:
    """Drive a device, tick by tick.

    A device that tells its place as often as there are ticks begins each of them; ticks of others
    come at even times.

    Parameters
    ----------
    device
        An open device. The loop writes rest before it lets go of it, and leaves closing to its
        opener.
    clock
        The clock by which ticks are due.
    rate_hz
        Ticks a second.
    ring
        Ring in which every tick is recorded; without it only the last tick is kept.
    orders
        What can be waited for, by its ``fileno``, and then is told to ``obey``; None for nothing.

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
        ring: Ring | None = None,
        orders: Any = None,
    ) -> None:
        check_range("rate", rate_hz, 1, 10_000, " Hz")
        display, now_ns = device.display, clock.now_ns()
        self.device, self.clock, self.rate_hz = device, clock, rate_hz
        self.ring = ring or Ring.alone(display.shape, 2)
        self._late = 0
        self._orders = orders
        self._period_ns = round(NS_PER_S / rate_hz)
        self._guard_ns = self._period_ns // _GUARD
        self._same_rate = abs(display.rate_hz - rate_hz) <= _SAME_RATE * rate_hz
        self._due_ns = self._began_ns = now_ns  # when a tick is due, and when the last one began
        self._times_ns = np.zeros((1, 2), np.int64)
        self._poses = np.zeros((1, 4))
        self._pose = self._poses[0]
        state = np.zeros(1, ticks.STATE)
        self.now = now = state[0]
        self._sent_ns, self._faded_ns = state["sent_ns"], state["faded_ns"]
        now["period_ns"] = self._period_ns
        now["gap_ns"] = max(GAP_NS, round(GAP_PERIODS * self._period_ns))
        now["step_ns"] = max(STEP_NS, self._period_ns)
        now["free_y"] = "y" in display.axes
        now["time_ns"] = now["moved_ns"] = now["sampled_ns"] = now["sent_ns"] = now_ns
        now["rested"] = device.rested
        now["share"] = 1.0
        now["x_mm"] = now["y_mm"] = now["theta_rad"] = np.nan
        ints = state.view(np.int64)[: len(INTS)]
        floats = state.view(np.float64)[len(ticks.WHOLE) : len(ticks.WHOLE) + len(FLOATS)]
        windows = np.zeros((DIFFERENCE, 3)), np.zeros((MEAN, 2))
        self.output, held, target = (np.zeros(display.shape) for _ in range(3))
        frames = self.output, held, target
        self._known = state, ints, floats, *windows, *frames, np.zeros(work.AT)
        self._program = nothing(display)
        # The frame before, the time at which it was sent, and how far its fade had come.
        self._before, self._before_ns = self.output.copy(), (now_ns, 0)
        self._serials = 0

    def show(self, picture: Program, line: int) -> None:
        """Put another picture under the hand from the next tick on; it fades in.

        Parameters
        ----------
        picture
            What is to be shown.
        line
            Number by which records call it.

        Raises
        ------
        ValueError
            If it was compiled for another array.
        """
        picture.check_shape(self.output.shape)
        self._serials += 1
        self.now["line"], self.now["serial"] = line, self._serials
        self._program = picture

    @property
    def paused(self) -> bool:
        """Tell whether the array rests until told otherwise; setting it works from the next tick.

        What rests comes back for it.
        """
        return bool(self.now["paused"])

    @paused.setter
    def paused(self, paused: bool) -> None:
        self.now["paused"] = paused
        self.now["moved_ns"] = self.now["time_ns"]
        self.now["begun"] = 0

    @property
    def switches(self) -> int:
        """States of a scene's switches, as `vbraille.scene.signals.packed` has them.

        Setting them works from the next tick; what rests comes back for it.
        """
        return int(self.now["switches"])

    @switches.setter
    def switches(self, switches: int) -> None:
        self.now["switches"] = switches
        self.now["moved_ns"] = self.now["time_ns"]

    def advance(self, times_ns: NDArray[np.int64], poses: NDArray[np.float64]) -> int:
        """Do ticks, from the ring's next slot on; see `vbraille.engine.ticks.advance`."""
        np.copyto(self._before, self.output)
        self._before_ns = self._sent_ns[0], self._faded_ns[0]
        program = self._program.numbers, self._program.table, self._program.scratch
        device, ring = self.device, self.ring
        given = times_ns, poses, device.rested, device.taking
        return ticks.advance(*self._known, *program, *given, *ring.columns, ring.slot)

    def take_events(self) -> list[Event]:
        """Take the events of the device since the last call."""
        return list(self.device.take_events())

    def tick(self) -> None:
        """Wait for the next tick's time, or pose; make the frame and write it.

        Raises
        ------
        DeviceError
            If the device is gone, or says that its carriage is where none can be.
        """
        clock, device, ring = self.clock, self.device, self.ring
        sample = self._next_pose()
        now_ns = clock.now_ns()
        times_ns, pose = self._times_ns, self._pose
        times_ns[0, 0] = now_ns
        pose[POSED] = sample is not None
        if sample is not None:
            times_ns[0, 1], pose[POSE_X], pose[POSE_Y], pose[POSE_THETA] = sample
            if sample.theta_rad and not device.display.turns:
                raise self._nowhere()
        taking = device.taking
        slot = ring.slot
        if not self.advance(times_ns, self._poses):
            raise self._nowhere()
        if device.write(self.output):
            self._sent_ns[0] = clock.now_ns()
        elif (
            device.taking
        ):  # the actuators are where they were; else the next tick finds them at rest
            np.copyto(self.output, self._before)
            self._sent_ns[0], self._faded_ns[0] = self._before_ns
        done_ns = clock.now_ns()
        # Deadlines that have passed are counted, and never chased.
        lateness_ns = max(now_ns - self._due_ns, 0)
        self._began_ns = now_ns
        even = self._due_ns + self._period_ns
        self._due_ns = now_ns + self._period_ns if sample and self._same_rate else even
        missed = max((done_ns - self._due_ns) // self._period_ns, 0)
        self._late += missed
        self._due_ns += missed * self._period_ns
        whole = ring.integers
        whole[slot, LATENESS], whole[slot, WORK] = lateness_ns, done_ns - now_ns
        whole[slot, LATE] = self._late
        if device.placing or not (taking and device.taking):  # a write may have brought it to rest
            held = 0 if device.taking else _HELD
            whole[slot, FLAGS] = (whole[slot, FLAGS] & ~_HELD) | held | _PLACING[device.placing]
        ring.publish()

    def _next_pose(self) -> Pose | None:
        """Wait until a tick is due, or for a pose, which begins one at once; read the device.

        Where none has come for too long, the tick goes without.
        """
        clock, device, orders = self.clock, self.device, self._orders
        begins_ns = latest_ns = self._due_ns
        follows = self._same_rate and device.descriptor is not None
        if follows:
            begins_ns, latest_ns = self._began_ns + self._guard_ns, latest_ns + self._guard_ns
        else:
            if device.ahead_ns:
                clock.sleep_until_ns(self._due_ns - device.ahead_ns)
                device.ask()
            clock.sleep_until_ns(begins_ns)
        while True:
            waited = (device.descriptor if follows else None), orders
            ready = clock.wait_ns([each for each in waited if each is not None], latest_ns)
            if orders is not None and orders in ready:
                orders.obey()
            clock.sleep_until_ns(begins_ns)
            sample = device.read()
            if sample is not None or clock.now_ns() >= latest_ns:
                return sample

    def _nowhere(self) -> DeviceError:
        x_mm, y_mm, theta_rad = self._pose[POSE_X:]
        return DeviceError(
            f"{self.device.display.name} says that its carriage is at {x_mm} mm along x, {y_mm} mm "
            f"along y, turned by {theta_rad} rad, where it cannot be; look at its encoder with "
            f"'vbraille device check', or at its driver, which must give numbers, and an angle "
            f"only where its Display turns"
        )

    def restart_clock(self) -> None:
        """Make the next tick due now, after a time in which the loop did not run."""
        self._due_ns = self.clock.now_ns()

    def fade_to_rest(self) -> None:
        """Bring every actuator to rest, over the usual time.

        The device is not read meanwhile: its carriage may be what has failed.

        Raises
        ------
        DeviceError
            If the device is gone.
        """
        device = self.device
        self.now["line"] = self.now["serial"] = 0
        left = self.output.copy()
        if device.calibration is not None:
            device.calibrate(None)
        share, step = 1.0, 1 / (FADE_S * self.rate_hz)
        self.restart_clock()
        while self.output.any() or device.moving:
            self._due_ns = max(self._due_ns + self._period_ns, self.clock.now_ns())
            self.clock.sleep_until_ns(self._due_ns)
            share = max(share - step, 0.0)
            self.output[:] = share * left
            device.write(self.output)


class LocalEngine(Loop, Watcher):
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
    display : Display
        The actuators and the carriage of the device.
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
        Loop.__init__(self, device, clock, rate_hz=rate_hz, ring=ring)
        Watcher.__init__(self)
        self.display = device.display
        self.poll_ticks = poll_ticks

    @property
    def steered(self) -> bool:
        """Tell whether a simulated hand moves the device, and takes orders."""
        return hasattr(self.device, "obey")

    def show(self, picture: Program, line: int, end_mm: float | None = None) -> None:
        """Put another picture under the hand; see `vbraille.engine.host.Host.show`."""
        super().show(picture, line)
        self.wait_for(line, end_mm, self.display)

    def give(self, order: HandOrder) -> None:
        """Tell a simulated hand what to do; nothing happens where a person moves the device."""
        if self.steered:
            self.device.obey(order)  # pyright: ignore[reportAttributeAccessIssue]

    def poll(self) -> NDArray[np.void]:
        """Do some ticks; return their records."""
        for _ in range(self.poll_ticks):
            self.tick()
        return self._take()

    def _take(self) -> NDArray[np.void]:
        ticks = self.ring.drain()
        self.watch(ticks, self.display)
        return ticks

    def take_events(self) -> list[Event]:
        """Take the events of the device and the ticks since the last call."""
        return [*super().take_events(), *self._take_found()]

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

    def start(self) -> Display:
        """Begin with the next poll: what has gone by until now is not late."""
        self.restart_clock()
        return self.display

    def close(self) -> None:
        """Have the array fade to rest; the device's opener closes it."""
        self.fade_to_rest()
