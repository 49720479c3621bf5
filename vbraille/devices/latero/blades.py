"""The levels of the 64 blades in a FULL: as deflections say, or on the ramp to rest."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from vbraille.devices.framekernels import step_levels
from vbraille.devices.latero.datagrams import BLADES, BLADES_AT, REST, full_request

if TYPE_CHECKING:
    from numpy.typing import NDArray

ROWS: Final = 8
RAMP_NS: Final = 20_000_000
# How many frames far blades go at most until the Latero answers again: as docs/wire-protocol.md
# has it of a device, for a Latero shows what it gets at once.
_PACE: Final = 2
# The ramp goes on by no more than this in one step, so that a late step is no jump.
_MOST_STEP_NS: Final = 2_000_000


class Blades:
    """Levels that are sent; nothing outside 0 … `REST` ever is.

    Attributes
    ----------
    request : bytearray
        FULL with these levels.
    levels : uint8[64]
        View of the levels in the request, blade 8 · row + column.
    view : memoryview
        The same, for other memory to take them from.
    at_rest : bool
        Whether the ramp has come to its end; False from the next frame on, whatever that shows.
    """

    def __init__(self) -> None:
        self.request = full_request()
        whole = np.frombuffer(self.request, np.uint8)
        self.levels = whole[BLADES_AT : BLADES_AT + BLADES]
        self.at_rest = True
        self.view = memoryview(self.request)[BLADES_AT : BLADES_AT + BLADES]
        self._grid = self.levels.reshape(ROWS, ROWS)
        self._at = np.full(BLADES, float(REST))  # before they are rounded
        self._grid_at = self._at.reshape(ROWS, ROWS)
        self._stepped_ns = 0
        self._behind = 0  # by how many frames the levels are behind
        self._may_go = _PACE  # how many frames far they may go as yet

    @property
    def rests(self) -> bool:
        """Whether all levels are those of rest."""
        return bool(self.levels.min() == REST)

    def show(self, frame: NDArray[np.float64], *, heard: bool = True) -> None:
        """Go towards deflections; this allocates nothing.

        Parameters
        ----------
        frame : float64[8, 8]
            Deflections, in [0, 1].
        heard
            Whether the Latero has answered what was sent a frame ago. If not, it may not have got
            that: levels go on by two frames at most, and what comes after is caught up with.
        """
        self._behind += 1
        if heard:
            self._may_go = _PACE
        steps = min(self._behind, self._may_go)
        self._may_go -= steps
        step_levels(frame, float(REST), steps / self._behind, self._grid_at, self._grid)
        self._behind -= steps
        self.at_rest = False

    def stand_at(self, levels: bytes | memoryview, now_ns: int) -> None:
        """Begin the ramp to rest at levels."""
        self._behind = 0
        self._at[:] = np.frombuffer(levels, np.uint8)
        np.minimum(self._at, float(REST), out=self._at)
        self._stepped_ns = now_ns

    def begin_ramp(self, now_ns: int) -> None:
        """Begin the ramp to rest at the levels that were sent last."""
        self._behind = 0
        self._at[:] = self.levels
        self._stepped_ns = now_ns

    def ramp(self, now_ns: int) -> None:
        """Go on along the ramp: a blade goes its whole way in 20 ms, or less of it in as long."""
        passed_ns = min(now_ns - self._stepped_ns, _MOST_STEP_NS)
        self._stepped_ns = now_ns
        np.add(self._at, REST * passed_ns / RAMP_NS, out=self._at)
        np.minimum(self._at, float(REST), out=self._at)
        np.copyto(self.levels, np.ceil(self._at), casting="unsafe")
        self.at_rest = self.rests
