"""Stimuli, compiled for the kernels."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from vbraille.render.program import Program
    from vbraille.render.tuning import Tuning
    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.planning.stimuli import Stimulus


def render(protocol: Protocol, stimulus: Stimulus, tuning: Tuning) -> Program:
    """Picture of a stimulus."""
    style = replace(
        protocol.model.style, mapping=protocol.mapping, geometry=stimulus.geometry, tuning=tuning
    )
    return style.render(np.array(protocol.line(stimulus.masks), np.uint8), protocol.model.display)
