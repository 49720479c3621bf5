"""All that a tick knows from those before it, in arrays that compiled code works on."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vbraille.devices.events import Exposed
from vbraille.engine import ticks
from vbraille.engine.constants import (
    CATCH_S,
    DIFFERENCE,
    FADE_S,
    GAP_PERIODS,
    GAP_S,
    IDLE_S,
    MEAN,
    NS_PER_S,
    PAUSE_FADE_S,
    SILENCE_S,
    STEP_S,
)
from vbraille.errors import check_range
from vbraille.render import work
from vbraille.render.frames import blend
from vbraille.render.program import nothing

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.devices.events import Event
    from vbraille.display import Display
    from vbraille.render.program import Program

_STATE = np.dtype(
    [
        (name, "<i8")
        for name in (
            # What does not change: durations, and whether the carriage has an axis y.
            "period_ns", "fade_ns", "pause_ns", "catch_ns", "gap_ns", "step_ns", "idle_ns",
            "silence_ns", "free_y",
            "serial",  # how many pictures were wanted under the hand, and so the last one's number
            "line",  # what records call it
            "paused",
            "switches",  # states of a scene's switches, three bits for each signal
            "tick",  # number of the next one
            "ticked_ns", "sent_ns",  # when the last one woke, and when a frame last went out
            "faded_ns", "fading_ns",  # how far a fade has come, and how long it takes
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
    rested
        How often the device has gone to rest by itself.

    Attributes
    ----------
    now : record
        The numbers that a tick knows, by the names below.
    output : float64[rows, columns]
        The frame last made.

    Raises
    ------
    ValueError
        If the rate is out of range.
    """

    def __init__(self, display: Display, rate_hz: float, now_ns: int, rested: int = 0) -> None:
        check_range("rate", rate_hz, 1, 10_000, " Hz")
        self.shape = display.shape
        self._numbers = np.zeros(1, _STATE)
        self.now = now = self._numbers[0]
        period_s = 1 / rate_hz
        for name, duration_s in (
            ("period_ns", period_s),
            ("fade_ns", FADE_S),
            ("pause_ns", PAUSE_FADE_S),
            ("catch_ns", CATCH_S),
            ("gap_ns", max(GAP_S, GAP_PERIODS * period_s)),
            ("step_ns", max(STEP_S, period_s)),
            ("idle_ns", IDLE_S),
            ("silence_ns", SILENCE_S),
        ):
            now[name] = round(duration_s * NS_PER_S)
        now["free_y"] = "y" in display.axes
        now["ticked_ns"] = now["moved_ns"] = now["sampled_ns"] = now["sent_ns"] = now_ns
        now["rested"] = rested
        now["share"] = 1.0
        self._window_ns = np.zeros(DIFFERENCE, np.int64)
        self._window_mm = np.zeros((DIFFERENCE, 2))
        self._velocities = np.zeros((MEAN, 2))
        self.output = np.zeros(display.shape)
        self._held = np.zeros(display.shape)
        self._target = np.zeros(display.shape)
        self._at = np.zeros(work.AT)
        self._sent_ns, self._faded_ns = self._numbers["sent_ns"], self._numbers["faded_ns"]
        # The frame before, the time at which it was sent, and how far its fade had come.
        self._before = self.output.copy()
        self._before_ns = now_ns, 0
        self._program = nothing(display)
        self._gather()
        self._serials = self._exposures = 0

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
        self._gather()

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
        np.copyto(self._before, self.output)
        self._before_ns = self._sent_ns[0], self._faded_ns[0]
        return ticks.advance(*self._arrays, times_ns, poses, rested, taking, *columns, first)

    def sent(self, now_ns: int) -> None:
        """Note when the frame last made went out."""
        self._sent_ns[0] = now_ns

    def unsent(self) -> None:
        """Forget the frame last made, which did not go out: the actuators are where they were."""
        np.copyto(self.output, self._before)
        self._sent_ns[0], self._faded_ns[0] = self._before_ns

    def hold(self) -> None:
        """Keep the frame last made, to fade from it."""
        self._held[:] = self.output

    def fade(self, share: float) -> None:
        """Make a frame between the one that `hold` kept and rest."""
        self._target.fill(0.0)
        blend(self._held, self._target, share, self.output)

    def _gather(self) -> None:
        """Gather the arrays that compiled code takes, in its order."""
        self._arrays = (
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
            self._program.scratch,
        )
