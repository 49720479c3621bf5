"""Controllers that are out there: vbraille must not hurt anybody with them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.devices.wire.messages import TRIPPED
from vbraille.simulation.firmware import Controller

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from vbraille.devices.wire.messages import Frame


class ControllerOf20261121(Controller):
    """Built from the protocol's page as it was on 2026-11-21.

    Each valid FRAME is shown at once, on the ramp to rest and after it too, and STATE does not
    repeat that the watchdog tripped.
    """

    def _follow(self, frame: Frame, levels: NDArray[np.uint16]) -> bytes:
        self.levels, self._behind = levels, 0
        return self._hold(frame.sequence, levels)

    def _flags(self) -> int:
        return super()._flags() & ~TRIPPED
