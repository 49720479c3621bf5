"""The loop: read the carriage, render, write the frame.

Whatever changes without the hand's doing - a new line, a tuning, a jump, the
start, a pause, rest - fades from the frame last sent.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np

from vbraille.errors import DeviceError
from vbraille.render.kernels import blend

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.devices.base import Device, Sample
    from vbraille.engine.clock import Clock

NS_PER_S = 1_000_000_000
FADE_S = 0.1
PAUSE_FADE_S = 0.02
IDLE_S = 5.0
# A hand that moved less than this is at rest: some counts of a fine encoder.
STILL_MM = 0.05
# No hand moves 5 m/s: a carriage that is further within a tick was lost and found again.
JUMP_MM_S = 5_000.0
SILENCE_S = 0.1
_SPEED_WINDOW = 50  # samples


class Picture(Protocol):
    """What is under the hand: a frame for every place."""

    def frame(self, x_mm: float, out: NDArray[np.float64]) -> None:
        """Fill the frame for the array's left column at x."""
        ...


@dataclass(slots=True)
class Tally:
    """What happened so far.

    Parameters
    ----------
    ticks, late
        Ticks done, and deadlines that passed before their tick could begin.
    forward_mm, forward_s
        Way to the right, and the time that it took.
    """

    ticks: int = 0
    late: int = 0
    forward_mm: float = 0.0
    forward_s: float = 0.0

    @property
    def scanning_mm_s(self) -> float:
        """Mean speed of the hand while it moved right; 0 if it never did."""
        return self.forward_mm / self.forward_s if self.forward_s else 0.0


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

    Attributes
    ----------
    x_mm : float or None
        Where the array's left column is; None before the first sample.
    speed_mm_s : float
        Over the last 50 samples, positive to the right; 0 until there are as many.
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
    ) -> None:
        if not 1 <= rate_hz <= 10_000:
            raise ValueError(f"rate is {rate_hz:g} Hz; it must be 1 to 10000 Hz")
        self.device = device
        self.clock = clock
        self.rate_hz = rate_hz
        self.x_mm: float | None = None
        self.speed_mm_s = 0.0
        self.tally = Tally()
        shape = device.info.rows, device.info.columns
        self.output = np.zeros(shape)
        self._target = np.zeros(shape)
        self._held = np.zeros(shape)
        self._rest = np.zeros(shape)
        self._picture: Picture | None = None
        self._paused = False
        self._shown: Picture | None = None  # what the target is of; None at rest
        self._fade_ns = int(fade_s * NS_PER_S)
        self._fading_ns = self._fade_ns
        self._faded_from_ns = clock.now_ns() - self._fade_ns
        self._idle_ns = int(idle_s * NS_PER_S)
        self._period_ns = round(NS_PER_S / rate_hz)
        self._deadline_ns = clock.now_ns()
        self._moved_ns = self._sampled_ns = self._deadline_ns
        self._moved_mm = 0.0
        self._samples = 0
        self._places_mm = np.zeros(_SPEED_WINDOW)
        self._times_ns = np.zeros(_SPEED_WINDOW, np.int64)

    def show(self, picture: Picture | None) -> None:
        """Put something else under the hand; it fades in. None is rest."""
        self._picture = picture

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
        self._read(now_ns)
        picture = self._wanted(now_ns)
        if picture is not self._shown:
            fade_ns = int(PAUSE_FADE_S * NS_PER_S) if self._paused else self._fade_ns
            self._change(now_ns, picture, fade_ns)
        if picture is not None and self.x_mm is not None:
            picture.frame(self.x_mm, self._target)
        else:
            self._target.fill(0.0)
        self._write(now_ns)
        self.tally.ticks += 1
        # Deadlines stand where the start put them; one that has passed is counted, never chased.
        self._deadline_ns += self._period_ns
        behind_ns = self.clock.now_ns() - self._deadline_ns
        if behind_ns >= self._period_ns:
            missed = behind_ns // self._period_ns
            self.tally.late += missed
            self._deadline_ns += missed * self._period_ns

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
        begun_ns = self._deadline_ns = self.clock.now_ns()
        while not self.resting:
            self._deadline_ns += self._period_ns
            self.clock.sleep_until_ns(self._deadline_ns)
            since_ns = self.clock.now_ns() - begun_ns
            share = since_ns / self._fade_ns if since_ns < self._fade_ns else 1.0
            blend(self._held, self._rest, share, self.output)
            self.device.write(self.output)
        self._shown = None

    def _read(self, now_ns: int) -> None:
        sample = self.device.read()
        if sample is None:
            return
        x_mm = sample.x_mm
        if not -1e6 < x_mm < 1e6:
            raise DeviceError(f"{self.device.info.name} says that its carriage is at {x_mm} mm")
        if self.x_mm is None:
            self._moved_mm, self._moved_ns = x_mm, now_ns
        else:
            step_mm = x_mm - self.x_mm
            elapsed_s = max(now_ns - self._sampled_ns, self._period_ns) / NS_PER_S
            if abs(step_mm) > JUMP_MM_S * elapsed_s:
                self._samples = 0
                self._change(now_ns, self._shown, self._fade_ns)
            elif step_mm > 0:
                self.tally.forward_mm += step_mm
                self.tally.forward_s += elapsed_s
        self._estimate_speed(sample)
        self.x_mm = x_mm
        self._sampled_ns = now_ns
        if abs(x_mm - self._moved_mm) > STILL_MM:
            self._moved_mm, self._moved_ns = x_mm, now_ns

    def _estimate_speed(self, sample: Sample) -> None:
        """Way since the oldest of the last samples, by the device's own time."""
        slot = self._samples % _SPEED_WINDOW
        if self._samples >= _SPEED_WINDOW:
            way_mm = sample.x_mm - float(self._places_mm[slot])
            time_ns = sample.time_ns - int(self._times_ns[slot])
            self.speed_mm_s = way_mm / time_ns * NS_PER_S if time_ns > 0 else 0.0
        else:
            self.speed_mm_s = 0.0
        self._places_mm[slot] = sample.x_mm
        self._times_ns[slot] = sample.time_ns
        self._samples += 1

    def _wanted(self, now_ns: int) -> Picture | None:
        """What belongs under the hand now."""
        silent = now_ns - self._sampled_ns > SILENCE_S * NS_PER_S
        idle = now_ns - self._moved_ns > self._idle_ns
        if self._paused or silent or idle or self.x_mm is None:
            return None
        return self._picture

    def _change(self, now_ns: int, picture: Picture | None, fade_ns: int) -> None:
        np.copyto(self._held, self.output)
        self._shown = picture
        self._fading_ns = fade_ns
        self._faded_from_ns = now_ns

    def _write(self, now_ns: int) -> None:
        # The first tick of a change still sends what was there, the last one all of the new.
        since_ns = now_ns - self._faded_from_ns
        if since_ns < self._fading_ns:
            blend(self._held, self._target, since_ns / self._fading_ns, self.output)
        else:
            np.copyto(self.output, self._target)
        self.device.write(self.output)
