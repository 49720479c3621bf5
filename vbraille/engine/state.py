"""All that a tick knows from those before it, in arrays that compiled code works on."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vbraille.devices.events import Exposed
from vbraille.engine import serialtick, ticks
from vbraille.engine.constants import (
    DIFFERENCE,
    FADE_S,
    IDLE_S,
    MEAN,
    NS_PER_S,
    PAUSE_FADE_S,
    SILENCE_S,
)
from vbraille.errors import check_range
from vbraille.render import work
from vbraille.render.frames import blend
from vbraille.render.program import nothing, scratch_for

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.devices.events import Event
    from vbraille.devices.serial.kernels import SteadyConversation
    from vbraille.display import Display
    from vbraille.engine.record import Ring
    from vbraille.render.program import Program

    _Three = tuple[NDArray, NDArray, NDArray]
    _Eleven = tuple[*_Three, *_Three, *_Three, NDArray, NDArray]

_STATE = np.dtype(
    [
        (name, "<i8")
        for name in (
            "period_ns", "fade_ns", "pause_ns", "idle_ns", "silence_ns",  # which do not change
            "free_y",  # whether the carriage has an axis y
            "serial",  # how many pictures were wanted under the hand, and so the last one's number
            "line",  # what records call it
            "paused",
            "switches",  # states of a scene's switches, three bits for each signal
            "tick",  # number of the next one
            "ticked_ns", "done_ns",  # when the last one woke, and when its frame had gone out
            "faded_ns", "fading_ns",  # how far a fade has come, and how long it takes
            "behind_ns",  # how much of the hand's way is to be caught up with, by the time it took
            "placed",  # whether it is known where the array is
            "device_ns", "sampled_ns",  # of the last pose, by the device's clock and by ours
            "moved_ns",  # when the hand last moved
            "shown",  # serial number of what is under the hand; 0 at rest
            "part",  # of what is shown
            "turned",  # whether the array is turned too far for what is wanted
            "begun", "shown_ns",  # the picture whose own time goes, and that time
            "exhausted",  # the picture that has moved by itself for as long as it may
            "exposures",  # how often one has
            "rested",  # how often the device has gone to rest by itself
            "flags",  # of this tick
            "samples", "last_ns",  # of the velocity
        )
    ]
    + [
        (name, "<f8")
        for name in (
            "x_mm", "y_mm", "theta_rad", "vx_mm_s", "vy_mm_s",
            "moved_x_mm", "moved_y_mm", "moved_theta",  # where the hand last moved to
            "forward_mm", "forward_s", "share",
        )
    ]
)  # fmt: skip


class LoopState:
    """State of one loop from tick to tick, and the compiled ticks that work on it.

    Parameters
    ----------
    display
        The actuators and the carriage that are driven.
    rate_hz
        Ticks a second, 1 to 10,000.
    now_ns
        Time at which it begins, by the clock of its ticks.
    fade_s
        Duration of a change that the hand did not cause.
    idle_s
        Time without motion before the array goes to rest.
    rested
        How often the device has gone to rest by itself.

    Attributes
    ----------
    now : record
        The numbers that a tick knows, by the names below.
    done_ns : int64[1, …]
        View of these numbers, of which the first is when the last frame had gone out.
    output : float64[rows, columns]
        The frame last made.

    Raises
    ------
    ValueError
        If the rate is out of range.
    """

    def __init__(
        self,
        display: Display,
        rate_hz: float,
        now_ns: int,
        *,
        fade_s: float = FADE_S,
        idle_s: float = IDLE_S,
        rested: int = 0,
    ) -> None:
        check_range("rate", rate_hz, 1, 10_000, " Hz")
        self.shape = display.shape
        self._numbers = np.zeros(1, _STATE)
        self.now = now = self._numbers[0]
        now["period_ns"] = round(NS_PER_S / rate_hz)
        now["fade_ns"] = now["fading_ns"] = now["faded_ns"] = int(fade_s * NS_PER_S)
        now["pause_ns"] = int(PAUSE_FADE_S * NS_PER_S)
        now["idle_ns"] = int(idle_s * NS_PER_S)
        now["silence_ns"] = int(SILENCE_S * NS_PER_S)
        now["free_y"] = "y" in display.axes
        now["ticked_ns"] = now["moved_ns"] = now["sampled_ns"] = now_ns
        now["rested"] = rested
        now["share"] = 1.0
        self._window_ns = np.zeros(DIFFERENCE, np.int64)
        self._window_mm = np.zeros((DIFFERENCE, 2))
        self._velocities = np.zeros((MEAN, 2))
        self.output = np.zeros(display.shape)
        self._held = np.zeros(display.shape)
        self._target = np.zeros(display.shape)
        self._at = np.zeros(work.AT)
        self._scratch = scratch_for(display.shape)
        self.done_ns = self._numbers.view(np.int64)[list(_STATE.fields or ()).index("done_ns") :]
        self._program = nothing(display)
        self._arrays = self._gathered()
        self._serials = 0
        self._exposures = 0  # that were told

    def want(self, program: Program | None, line: int) -> None:
        """Put another picture under the hand from the next tick on; it fades in. None is rest.

        Raises
        ------
        ValueError
            If the program was compiled for another array.
        """
        now = self.now
        now["line"] = line
        if program is None:
            now["serial"] = 0
            return
        program.check_shape(self.shape)
        self._serials += 1
        now["serial"] = self._serials
        self._program = program
        self._arrays = self._gathered()

    def pause(self, paused: bool, now_ns: int) -> None:
        """Let the array rest, or go on, from the next tick on."""
        self.now["paused"] = paused
        self.now["moved_ns"] = now_ns
        self.now["begun"] = self.now["exhausted"] = 0

    def switch(self, switches: int, now_ns: int) -> None:
        """Change the states of switches from the next tick on; what rests comes back for it."""
        self.now["switches"] = switches
        self.now["moved_ns"] = now_ns

    def take_events(self) -> list[Event]:
        """Take the events since the last call: that a picture was felt for long enough."""
        told, self._exposures = self._exposures, int(self.now["exposures"])
        limit_s = float(self._program.numbers[work.EXPOSURE])
        return [Exposed(limit_s)] * (self._exposures - told)

    def fade(self, share: float) -> None:
        """Make a frame between the one that `hold` kept and rest."""
        self._target.fill(0.0)
        blend(self._held, self._target, share, self.output)

    def hold(self) -> None:
        """Keep the frame last made, to fade from it."""
        self._held[:] = self.output

    def _gathered(self) -> _Eleven:
        """The arrays that compiled code takes, in its order."""
        return (
            self._numbers,
            self._window_ns,
            self._window_mm,
            self._velocities,
            self.output,
            self._held,
            self._target,
            self._at,
            self._program.numbers,
            self._program.table,
            self._scratch,
        )

    def advance(
        self,
        times_ns: NDArray[np.int64],
        poses: NDArray[np.float64],
        rested: int,
        taking: bool,
        columns: tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float32]],
        first: int = 0,
    ) -> int:
        """Do ticks and return how many were done; see `vbraille.engine.ticks.advance`."""
        return ticks.advance(*self._arrays, times_ns, poses, rested, taking, *columns, first)

    def run_steadily(
        self,
        told: NDArray[np.int64],
        orders: NDArray[np.int64],
        known: NDArray[np.int64],
        steady: SteadyConversation,
        times_ns: NDArray[np.int64],
        poses: NDArray[np.float64],
        ring: Ring,
    ) -> int:
        """Do ticks of a steady serial conversation; see `vbraille.engine.serialtick.run`."""
        return serialtick.run(
            told,
            orders,
            known,
            steady.received,
            steady.work,
            steady.out,
            steady.talk,
            steady.actuators,
            *self._arrays,
            times_ns,
            poses,
            ring.published,
            *ring.columns,
        )
