"""What every engine offers: a loop that drives a device, in a process of its own or in this one."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Protocol

from vbraille.devices.events import Placing
from vbraille.engine.record import Flag

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.devices.events import Event
    from vbraille.display import Display
    from vbraille.engine.record import Tally
    from vbraille.render.program import Program


class Engine(Protocol):
    """A loop with its device, as seen by whoever gives it lines to show and watches it."""

    @property
    def display(self) -> Display:
        """The actuators and the carriage of the device."""
        ...

    @property
    def tally(self) -> Tally:
        """Counts of what the loop has done, up to the last poll."""
        ...

    @property
    def x_mm(self) -> float | None:
        """Where the array's centre was at the last poll; None before it is known."""
        ...

    @property
    def paused(self) -> bool:
        """Whether the array is to rest; setting it takes effect with the next tick."""
        ...

    @paused.setter
    def paused(self, paused: bool) -> None: ...

    def show(self, picture: Program, line: int) -> None:
        """Put a picture of a line under the hand.

        Parameters
        ----------
        picture
            Picture that is shown.
        line
            Number of the line in the records, from 1.
        """
        ...

    def poll(self) -> NDArray[np.void]:
        """Take the records of all ticks since the last poll.

        Returns
        -------
        record[n]
            Records of `vbraille.engine.record.tick_dtype`, oldest first.

        Raises
        ------
        VbrailleError
            If the loop has ended by itself.
        """
        ...

    def take_events(self) -> Sequence[Event]:
        """Take the events of the device and the engine since the last call."""
        ...

    def set_zero(self) -> None:
        """Say that the carriage is at the left stop now."""
        ...


def place_of(tick: np.void | None) -> float | None:
    """Tell where the array's centre was in a record; None if that was not known."""
    if tick is None or math.isnan(tick["x_mm"]):
        return None
    return float(tick["x_mm"])


def placing_of(tick: np.void | None) -> Placing:
    """Tell how the device was waiting to be shown its place, from a record."""
    flags = 0 if tick is None else int(tick["flags"])
    if flags & Flag.STOP:
        return Placing.STOP
    return Placing.MARK if flags & Flag.MARK else Placing.DONE
