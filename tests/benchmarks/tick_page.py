"""The page with which ticks are measured: a frame tells for which place it was made."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from vbraille.render import STRESS2, Tuning

if TYPE_CHECKING:
    from vbraille.render.program import Program

# Dots so wide that the level of the first actuator tells for which place a frame was made.
STYLE = replace(
    STRESS2.style,
    geometry=replace(
        STRESS2.style.geometry, dot_width_mm=20.0, dot_spacing_mm=25.0, cell_gap_mm=25.0
    ),
    tuning=Tuning(texture=0.0),
)
CELLS = 26
DISPLAY = replace(STRESS2.display, levels=65_536)


def page() -> Program:
    """A line whose dots are all raised, without a texture."""
    return STYLE.render(np.full(CELLS, 0x3F, np.uint8), DISPLAY)
