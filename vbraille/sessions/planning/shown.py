"""A line of braille as it is put under the hand: what a stimulus becomes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vbraille.braille.cells import dots_of
from vbraille.render import BrailleStyle
from vbraille.render.program import Program
from vbraille.sessions.planning.protocol import Protocol
from vbraille.sessions.planning.trial import Stimulus

LEFT_DOTS = frozenset((1, 2, 3, 7))


class Shown(NamedTuple):
    """A line of braille, as it is put under the hand.

    Parameters
    ----------
    program
        What the actuators do at each place.
    end_mm
        Where the last dot ends.
    edges_mm
        Left edges of the dot columns that are shown.
    """

    program: Program
    end_mm: float
    edges_mm: tuple[float, ...]


def make_shown(protocol: Protocol, stimulus: Stimulus) -> Shown:
    """Compile a stimulus, with blank cells before it."""
    style = protocol.style(stimulus.look)
    masks = stimulus.masks(protocol.display.lead_cells)
    program = style.render(np.array(masks, np.uint8), protocol.display_model.display)
    return Shown(program, style.geometry.extent_mm(len(masks)), _edges_mm(masks, style))


def _edges_mm(masks: list[int], style: BrailleStyle) -> tuple[float, ...]:
    """Return the left edges of the dot columns that a display shows, left to right."""
    shown, geometry, edges = style.mapping.shown_dots(), style.geometry, []
    for cell, mask in enumerate(masks):
        dots = set(dots_of(mask & shown))
        start_mm = cell * geometry.cell_pitch_mm
        edges += [start_mm] if dots & LEFT_DOTS else []
        edges += [start_mm + geometry.dot_spacing_mm] if dots - LEFT_DOTS else []
    return tuple(edges)
