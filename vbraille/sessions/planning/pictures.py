"""Stimuli, compiled for the kernels."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vbraille.render.renderer import Renderer

if TYPE_CHECKING:
    from vbraille.render.tuning import Tuning
    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.planning.stimuli import Stimulus


def render(
    protocol: Protocol, stimulus: Stimulus, tuning: Tuning, *, anchor_mm: float | None = None
) -> Renderer:
    """Picture of a stimulus, for places of the array's centre, or of the anchor that is given."""
    return Renderer(
        np.array(protocol.line(stimulus.masks), np.uint8),
        array=protocol.model.array,
        profile=protocol.model.profile,
        mapping=protocol.mapping,
        geometry=stimulus.geometry,
        tuning=tuning,
        anchor_mm=anchor_mm,
    )
