"""Controllers that are out there, or may be: vbraille must not hurt anybody with them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.devices.pagecontroller import Make, PageController
from vbraille.devices.serial.wire import TRIPPED
from vbraille.simulation.firmware import Controller

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from vbraille.devices.serial.wire import Frame, Info


class HastyController(Controller):
    """Shows each valid FRAME at once, on its ramp to rest and after it too.

    Its STATEs do not repeat that the watchdog tripped.
    """

    def _follow(self, frame: Frame, levels: NDArray[np.uint16]) -> bytes:
        self.levels, self._behind = levels, 0
        return self._hold(frame.sequence, levels)

    def _flags(self) -> int:
        return super()._flags() & ~TRIPPED


class Alone(PageController):
    """The controller that was written from the page alone, made as an INFO says."""

    def __init__(self, info: Info) -> None:
        super().__init__(
            make=Make(
                rows=info.rows,
                columns=info.columns,
                column_pitch_nm=info.column_pitch_nm,
                top_level=info.top_level,
                slew_per_s=info.largest_slew_per_s,
                travel_um=info.travel_um,
                inverted=info.inverted,
            )
        )

    @property
    def frames(self) -> int:
        return len(self.taken)

    @property
    def resting(self) -> bool:
        return self._resting

    @property
    def at_rest(self) -> bool:
        return self._resting and self._ramp_us is None

    @property
    def _frame_sequence(self) -> int:
        return self._frame
