"""Lines and pictures that are put under the hand, or on the pins, for a stimulus."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vbraille.braille.cells import dots_of
from vbraille.braille.spelling import spell_string
from vbraille.render import BrailleStyle
from vbraille.render.program import Program
from vbraille.sessions.planning.protocol import Protocol
from vbraille.sessions.planning.trial import Stimulus

LEFT_DOTS = frozenset((1, 2, 3, 7))


class Shown(NamedTuple):
    """A line of braille, or a picture, as it is put under the hand.

    Parameters
    ----------
    program
        What the actuators do at each place.
    end_mm
        Where the last cell ends; None of a picture.
    edges_mm
        Left edges of the dot columns that are shown, left to right; none of a picture.
    canvas_mm
        Width and height of a picture's canvas; None of a line.
    """

    program: Program
    end_mm: float | None
    edges_mm: tuple[float, ...]
    canvas_mm: tuple[float, float] | None = None


def make_shown(protocol: Protocol, stimulus: Stimulus) -> Shown:
    """Compile a stimulus, with blank cells before a string."""
    if stimulus.picture:
        # This loads what compiles pictures; protocols of strings need none of it.
        from vbraille.sessions.planning.pictures import canvas_mm, compile_picture

        program = compile_picture(protocol, stimulus)
        return Shown(program, None, (), canvas_mm(protocol, stimulus))
    style = protocol.style(stimulus.look)
    masks = stimulus.masks(protocol.display.lead_cells)
    program = style.render(np.array(masks, np.uint8), protocol.display_model.display)
    return Shown(program, style.geometry.extent_mm(len(masks)), edges_mm(masks, style))


def edges_mm(masks: list[int], style: BrailleStyle) -> tuple[float, ...]:
    """Return the left edges of the dot columns that a display shows, left to right."""
    shown, geometry = style.mapping.shown_dots(), style.geometry
    edges: list[float] = []
    for cell, mask in enumerate(masks):
        dots = set(dots_of(mask & shown))
        start_mm = cell * geometry.cell_pitch_mm
        edges += [start_mm] if dots & LEFT_DOTS else []
        edges += [start_mm + geometry.dot_spacing_mm] if dots - LEFT_DOTS else []
    return tuple(edges)


def pins_masks(protocol: Protocol, stimulus: Stimulus | None) -> bytes:
    """Return the cells of a conventional display, from its left, for a stimulus or the reference.

    Parameters
    ----------
    stimulus
        What stands on the pins; None for what stimuli on the device are compared with.
    """
    if stimulus is None:
        masks = spell_string(protocol.pins.reference, protocol.masks)
    else:
        masks = stimulus.masks(0)
    return bytes((0,) * (protocol.pins.cell - 1) + tuple(masks))
