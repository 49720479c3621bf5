"""The loop: read the carriage, render, write the frame.

Whatever changes without the hand's doing - a new line, a tuning, a jump, the
start, a pause, rest - fades from the frame last sent.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Protocol

import numpy as np

from vbraille.engine.ring import Flag
from vbraille.engine.tally import Tally
from vbraille.engine.velocity import Velocity
from vbraille.errors import DeviceError
from vbraille.pose import Pose
from vbraille.render.kernels import blend

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.devices.base import Device
    from vbraille.engine.clock import Clock
    from vbraille.engine.ring import Ring

NS_PER_S = 1_000_000_000
FADE_S = 0.1
PAUSE_FADE_S = 0.02
IDLE_S = 5.0
# A hand that moved less than this is at rest: some counts of a fine encoder.
STILL_MM = 0.05
# No hand moves 5 m/s: a carriage that is further within a tick was lost and found again.
JUMP_MM_S = 5_000.0
SILENCE_S = 0.1
# By plain numbers: a flag of an enumeration takes a microsecond to join.
_PAUSED, _SILENT, _FOLLOWED = int(Flag.PAUSED), int(Flag.SILENT), int(Flag.FOLLOWED)
_RESTING, _CHANGED, _RESTED = int(Flag.RESTING), int(Flag.CHANGED), int(Flag.RESTED)
_HELD = int(Flag.HELD)
_NOWHERE = Pose(0, math.nan, math.nan, math.nan)  # before the first sample
_PLACING = (0, int(Flag.MARK), int(Flag.STOP))  # by `Placing`


class Picture(Protocol):
    """What is under the hand: a frame for every place."""

    def frame(self, x_mm: float, out: NDArray[np.float64], /) -> None:
        """Fill the frame for the array's centre at x."""
        ...


class Loop:
    """Drive a device.

    Parameters
    ----------
    device
        Opened; the loop writes rest before it lets go of it, and leaves closing
        to whoever opened it.
    clock
        When ticks are due.
    rate_hz
        Ticks a second.
    fade_s
        How long a change takes that the hand did not cause.
    idle_s
        How long without motion before the array goes to rest.
    ring
        Where to record every tick.

    Attributes
    ----------
    pose : Pose or None
        The newest sample of the device; None before the first.
    velocity : Velocity
        Of the hand.
    output : float64[rows, columns]
        The frame last sent.
    tally : Tally
        What happened so far.

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
        if not 1 <= rate_hz <= 10_000:
            raise ValueError(f"rate is {rate_hz:g} Hz; it must be 1 to 10000 Hz")
        self.device = device
        self.clock = clock
        self.rate_hz = rate_hz
        self.pose: Pose | None = None
        self.velocity = Velocity()
        self.tally = Tally()
        self._ring = ring
        shape = device.display.rows, device.display.columns
        self.output = np.zeros(shape)
        self._target = np.zeros(shape)
        self._held = np.zeros(shape)
        self._rest = np.zeros(shape)
        self._picture: Picture | None = None
        self._line = 0
        self._paused = False
        self._rested = device.rested
        self._shown: Picture | None = None  # what the target is of; None at rest
        self._fade_ns = int(fade_s * NS_PER_S)
        # How long this fade takes, and how far it has come: by ticks, since a loop that was
        # held up would jump if it took the time that it lost for time in which it faded.
        self._fading_ns = self._faded_ns = self._fade_ns
        self._ticked_ns = clock.now_ns()
        self._share = 1.0
        self._happened = 0  # flags of what this tick began with
        self._idle_ns = int(idle_s * NS_PER_S)
        self._period_ns = round(NS_PER_S / rate_hz)
        self._deadline_ns = clock.now_ns()
        self._moved_ns = self._sampled_ns = self._deadline_ns
        self._moved_mm = 0.0, 0.0

    def show(self, picture: Picture | None, line: int = 0) -> None:
        """Put something else under the hand; it fades in. None is rest. Records tell the line."""
        self._picture = picture
        self._line = line

    @property
    def paused(self) -> bool:
        """Whether the array rests until told otherwise; setting it takes effect at once."""
        return self._paused

    @paused.setter
    def paused(self, paused: bool) -> None:
        self._paused = paused
        self._moved_ns = self.clock.now_ns()

    @property
    def resting(self) -> bool:
        """Whether every actuator was at rest in the frame last sent."""
        return not self.output.any()

    def tick(self) -> None:
        """Wait for the next deadline; then read, render and write.

        Raises
        ------
        DeviceError
            If the device is gone.
        """
        self.clock.sleep_until_ns(self._deadline_ns)
        now_ns = self.clock.now_ns()
        busy_ns = self.clock.busy_ns()
        lateness_ns = now_ns - self._deadline_ns
        followed = self.device.followed  # asked before the place, which is then the last one
        self._happened = 0
        self._faded_ns += min(now_ns - self._ticked_ns, self._period_ns)
        self._ticked_ns = now_ns
        self._read(now_ns)
        if self.device.rested != self._rested:
            self._rested = self.device.rested
            self.output.fill(0.0)
            self._happened |= _RESTED
            self._change(self._shown, self._fade_ns)
        if not self.device.taking:
            self.output.fill(0.0)
            self._shown = None
            self._faded_ns = self._fading_ns
        picture = self._wanted(now_ns)
        if picture is not self._shown:
            fade_ns = int(PAUSE_FADE_S * NS_PER_S) if self._paused else self._fade_ns
            self._change(picture, fade_ns)
        self._write(picture)
        self.tally.ticks += 1
        # Deadlines stand where the start put them; one that has passed is counted, never chased.
        self._deadline_ns += self._period_ns
        done_ns = self.clock.now_ns()
        work_ns = done_ns - now_ns
        if work_ns > self._period_ns and self.clock.busy_ns() - busy_ns > self._period_ns:
            self.tally.overruns += 1
        behind_ns = done_ns - self._deadline_ns
        if behind_ns >= self._period_ns:
            missed = behind_ns // self._period_ns
            self.tally.late += missed
            self._deadline_ns += missed * self._period_ns
        if self._ring is not None:
            self._record(self._ring, now_ns, lateness_ns, work_ns, followed)

    def warm_up(self) -> None:
        """Compile what a tick calls, so that the first is no slower than the others."""
        blend(self._held, self._target, 0.0, self._held)
        if self._picture is not None:
            self._picture.frame(0.0, self._target)

    def restart_clock(self) -> None:
        """Let the next tick be due now: the time before it was not the loop's."""
        self._deadline_ns = self.clock.now_ns()

    def fade_to_rest(self) -> None:
        """Bring every actuator to rest, over the usual time.

        Asks the device for nothing: it may be the carriage that has failed.

        Raises
        ------
        DeviceError
            If the device is gone.
        """
        self.show(None)
        np.copyto(self._held, self.output)
        self._deadline_ns = self.clock.now_ns()
        faded_ns = 0
        while not self.resting:
            self._deadline_ns = max(self._deadline_ns + self._period_ns, self.clock.now_ns())
            self.clock.sleep_until_ns(self._deadline_ns)
            faded_ns += self._period_ns
            share = faded_ns / self._fade_ns if faded_ns < self._fade_ns else 1.0
            blend(self._held, self._rest, share, self.output)
            self.device.write(self.output)
        self._shown = None

    def _record(
        self, ring: Ring, now_ns: int, lateness_ns: int, work_ns: int, followed: bool
    ) -> None:
        flags = _PLACING[self.device.placing] | self._happened
        if self._shown is None:
            flags |= _RESTING
        if self._paused:
            flags |= _PAUSED
        if self._silent(now_ns):
            flags |= _SILENT
        if followed:
            flags |= _FOLLOWED
        if not self.device.taking:
            flags |= _HELD
        tally, pose = self.tally, self.pose or _NOWHERE
        ring.append(
            self.output,
            now_ns,
            pose.time_ns,
            lateness_ns,
            work_ns,
            tally.late,
            tally.overruns,
            self._line,
            0,
            flags,
            pose.x_mm,
            pose.y_mm,
            pose.theta_rad,
            self.velocity.x_mm_s,
            self.velocity.y_mm_s,
            tally.forward_mm,
            tally.forward_s,
            0.0,
            self._share,
        )

    def _read(self, now_ns: int) -> None:
        sample = self.device.read()
        if sample is None:
            return
        _, x_mm, y_mm, theta_rad = sample
        if not (-1e6 < x_mm < 1e6 and -1e6 < y_mm < 1e6 and math.isfinite(theta_rad)):
            raise DeviceError(
                f"{self.device.display.name} says that its carriage is at x = {x_mm} mm, "
                f"y = {y_mm} mm, turned by {theta_rad} rad, where it cannot be; switch it off and "
                f"on, and if it says so again, look at its encoder and at the counts that its INFO "
                f"tells, with 'vbraille device check'"
            )
        if self.pose is None:
            self._moved_mm, self._moved_ns = (x_mm, y_mm), now_ns
        else:
            step_mm = x_mm - self.pose.x_mm
            elapsed_s = max(now_ns - self._sampled_ns, self._period_ns) / NS_PER_S
            if math.hypot(step_mm, y_mm - self.pose.y_mm) > JUMP_MM_S * elapsed_s:
                self.velocity.reset()
                self._change(self._shown, self._fade_ns)
            elif step_mm > 0:
                self.tally.forward_mm += step_mm
                self.tally.forward_s += elapsed_s
        self.velocity.add(sample.time_ns, x_mm, y_mm)
        self.pose = sample
        self._sampled_ns = now_ns
        if math.dist((x_mm, y_mm), self._moved_mm) > STILL_MM:
            self._moved_mm, self._moved_ns = (x_mm, y_mm), now_ns

    def _silent(self, now_ns: int) -> bool:
        return now_ns - self._sampled_ns > SILENCE_S * NS_PER_S

    def _wanted(self, now_ns: int) -> Picture | None:
        """What belongs under the hand now."""
        idle = now_ns - self._moved_ns > self._idle_ns
        if self._paused or idle or self._silent(now_ns) or self.pose is None:
            return None
        if not self.device.taking:
            return None
        return self._picture

    def _change(self, picture: Picture | None, fade_ns: int) -> None:
        np.copyto(self._held, self.output)
        self._shown = picture
        self._happened |= _CHANGED
        self._fading_ns = fade_ns
        self._faded_ns = 0

    def _write(self, picture: Picture | None) -> None:
        # The first tick of a change still sends what was there, the last one all of the new.
        fading = self._faded_ns < self._fading_ns
        out = self._target if fading else self.output
        if picture is not None and self.pose is not None:
            picture.frame(self.pose.x_mm, out)
        else:
            out.fill(0.0)
        self._share = self._faded_ns / self._fading_ns if fading else 1.0
        if fading:
            blend(self._held, out, self._share, self.output)
        self.device.write(self.output)
