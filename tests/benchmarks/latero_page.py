"""The page with which a Latero's loop is measured: a frame tells for which place it was made."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from vbraille.devices.latero.device import DISPLAY
from vbraille.render import STRESS2, Tuning
from vbraille.simulation.laterosim import OFFSETS

if TYPE_CHECKING:
    from vbraille.render.program import Program

CELLS = 10
STYLE = replace(
    STRESS2.style,
    geometry=replace(
        STRESS2.style.geometry, dot_width_mm=20.0, dot_spacing_mm=25.0, cell_gap_mm=25.0
    ),
    tuning=Tuning(texture=0.0),
)
ROOM = STYLE.room(DISPLAY, CELLS)


def page() -> Program:
    """A line whose dots are all raised and wide, without a texture."""
    return STYLE.render(np.full(CELLS, 0x3F, np.uint8), DISPLAY)


def spec(port: int) -> str:
    """Spec of a Latero at a port of this computer, whose offsets are known."""
    return f"latero:127.0.0.1:{port}?offsets={','.join(map(str, OFFSETS))}"
