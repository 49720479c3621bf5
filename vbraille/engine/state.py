"""All that a tick knows from those before it, in arrays that compiled code works on."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

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
from vbraille.engine.record import FLOATS, INTS
from vbraille.errors import check_range
from vbraille.render import work
from vbraille.render.program import nothing

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.display import Display
    from vbraille.render.program import Program

# The numbers of a tick's record come first, the whole ones and the others.
_WHOLE = (
    *INTS,
    # What does not change: durations, and whether the carriage has an axis y.
    "period_ns", "fade_ns", "pause_ns", "catch_ns", "gap_ns", "step_ns", "idle_ns", "silence_ns",
    "free_y",
    "serial",  # how many pictures were wanted under the hand, and so the last one's number
    "paused",
    "switches",  # states of a scene's switches, three bits for each signal
    "sent_ns",  # when a frame last went out
    "faded_ns", "fading_ns",  # how far a fade has come, and how long it takes
    "placed",  # whether it is known where the array is
    "sampled_ns",  # when the last pose came, by our clock
    "moved_ns",  # when the hand last moved
    "shown",  # serial number of what is under the hand; 0 at rest
    "turned",  # whether the array is turned too far for what is wanted
    "begun", "shown_ns",  # the picture whose own time goes, and that time
    "rested",  # how often the device has gone to rest by itself
    "samples",  # of the velocity
)  # fmt: skip
_REAL = (
    *FLOATS,
    "own_y_mm",  # the carriage's y; a slider has none, and its record has the picture's
    "moved_x_mm", "moved_y_mm", "moved_theta",  # where the hand last moved to
)  # fmt: skip
_STATE = np.dtype([(name, "<i8") for name in _WHOLE] + [(name, "<f8") for name in _REAL])


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
    output : float64[rows, columns]
        The frame last made.

    Raises
    ------
    ValueError
        If the rate is out of range.
    """

    def __init__(self, display: Display, rate_hz: float, now_ns: int, rested: int = 0) -> None:
        check_range("rate", rate_hz, 1, 10_000, " Hz")
        state = np.zeros(1, _STATE)
        self.now = now = state[0]
        self._sent_ns, self._faded_ns = state["sent_ns"], state["faded_ns"]
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
        now["time_ns"] = now["moved_ns"] = now["sampled_ns"] = now["sent_ns"] = now_ns
        now["rested"] = rested
        now["share"] = 1.0
        now["x_mm"] = now["y_mm"] = now["theta_rad"] = np.nan
        ints = state.view(np.int64)[: len(INTS)]
        floats = state.view(np.float64)[len(_WHOLE) : len(_WHOLE) + len(FLOATS)]
        windows = np.zeros((DIFFERENCE, 3)), np.zeros((MEAN, 2))
        self.output, held, target = (np.zeros(display.shape) for _ in range(3))
        frames = self.output, held, target
        self._known = state, ints, floats, *windows, *frames, np.zeros(work.AT)
        self._program = nothing(display)
        # The frame before, the time at which it was sent, and how far its fade had come.
        self._before, self._before_ns = self.output.copy(), (now_ns, 0)
        self._serials = 0

    def show(self, picture: Program | None, line: int = 0) -> None:
        """Put another picture under the hand from the next tick on; it fades in. None is rest.

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
        self.now["line"] = line
        if picture is None:
            self.now["serial"] = 0
            return
        picture.check_shape(self.output.shape)
        self._serials += 1
        self.now["serial"] = self._serials
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
        program = self._program.numbers, self._program.table, self._program.scratch
        return ticks.advance(
            *self._known, *program, times_ns, poses, rested, taking, *columns, first
        )

    def unsent(self) -> None:
        """Forget the frame last made, which did not go out: the actuators are where they were."""
        np.copyto(self.output, self._before)
        self._sent_ns[0], self._faded_ns[0] = self._before_ns
