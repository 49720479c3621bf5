"""Stimuli as pictures that the compiled code can show."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from vbraille.render.braille.profiles import Tuning
    from vbraille.render.program import Program
    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.planning.stimuli import Stimulus


def render(protocol: Protocol, stimulus: Stimulus, tuning: Tuning) -> Program:
    """Make the picture of a stimulus, for places of the array's centre."""
    style = replace(
        protocol.model.style,
        mapping=protocol.mapping_of(stimulus),
        geometry=stimulus.geometry,
        tuning=tuning,
    )
    masks = np.array(protocol.line(stimulus.masks), np.uint8)
    return style.render(masks, protocol.model.display)
