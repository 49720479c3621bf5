"""An array that is turned too far for braille: what its reader is told, once each time."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from vbraille.engine.record import Flag
from vbraille.render.braille.straying import MOST_TILT_RAD

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy as np

# This is a plain number because numpy, when it reads an enumeration, can swallow an exception that
# a signal raises.
_TURNED = int(Flag.TURNED)


class Upright:
    """Watches which way the array is turned."""

    def __init__(self) -> None:
        self._turned = False

    def watch(self, tick: np.void) -> Iterator[str]:
        """Sentences to be said after a tick."""
        turned = bool(int(tick["flags"]) & _TURNED)
        if turned is self._turned:
            return
        self._turned = turned
        most = math.degrees(MOST_TILT_RAD)
        if not turned:
            yield "upright: braille is felt again"
            return
        theta = math.degrees(float(tick["theta_rad"]))
        right = "left" if theta < 0 else "right"  # against the clock it is turned if positive
        yield (
            f"turned: the array is turned by {abs(theta):.0f} degrees, and braille is felt up to "
            f"{most:.0f}; turn it back to the {right}"
        )
