"""Going on below a page: a finger that stays under the last line asks for the next one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from vbraille.engine.record import Flag

if TYPE_CHECKING:
    from numpy.typing import NDArray

# Ours: longer than a finger that strays off the last line takes to come back, shorter than one
# that waits for something to happen.
STAY_S: Final = 0.5
_STAY_NS: Final = round(STAY_S * 1e9)
# A plain number, as in `vbraille.reading.underhand`.
_UNFELT: Final = int(Flag.SILENT | Flag.MARK | Flag.STOP | Flag.HELD | Flag.TURNED)


class Foot:
    """Watches for a finger that has been on a page and stays below its last line.

    Parameters
    ----------
    rows
        Number of rows of the page.
    """

    def __init__(self, rows: int) -> None:
        self._rows = rows
        self._begun = False  # whether the finger was on the page since that came
        self._since_ns: int | None = None

    def rest(self) -> None:
        """Take the time below the page to begin anew, since nothing was felt meanwhile."""
        self._since_ns = None

    def stays(self, ticks: NDArray[np.void]) -> bool:
        """Look at ticks, which are all since the last call: whether it has stayed long enough.

        Time in which the device was away, or at rest by itself, does not count.
        """
        felt = ticks["flags"] & _UNFELT == 0
        on = felt & (ticks["part"] < self._rows)
        self._begun = self._begun or bool(on.any())
        elsewhere = np.flatnonzero(on | ~felt)
        if elsewhere.size:
            self.rest()
            ticks = ticks[elsewhere[-1] + 1 :]
        if not ticks.size or not self._begun:
            return False
        if self._since_ns is None:
            self._since_ns = int(ticks["time_ns"][0])
        return int(ticks["time_ns"][-1]) - self._since_ns >= _STAY_NS
