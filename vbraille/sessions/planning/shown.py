"""Lines and pictures that are put under the hand, or on the pins, for a stimulus."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vbraille.braille.cells import mask_of
from vbraille.braille.spelling import spell_string
from vbraille.render.program import Program
from vbraille.sessions.planning.protocol import Protocol
from vbraille.sessions.planning.trial import Stimulus

SIDES = mask_of((1, 2, 3, 7)), mask_of((4, 5, 6, 8))


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
    style = protocol.style(stimulus.look)
    if stimulus.picture:
        # This loads what compiles pictures; protocols of strings need none of it.
        from vbraille.sessions.planning.pictures import compile_picture, picture

        opened = picture(protocol, stimulus)
        canvas = opened.resolved.canvas
        program = compile_picture(protocol, opened, style.tuning.contrast)
        return Shown(program, None, (), (canvas.width_mm, canvas.height_mm))
    masks = np.array(stimulus.masks(protocol.display.lead_cells), np.uint8)
    program = style.render(masks, protocol.display_model.display)
    return Shown(program, width_mm(protocol, stimulus), edges_mm(protocol, stimulus))


def width_mm(protocol: Protocol, stimulus: Stimulus) -> float:
    """Return the length of the line that a string is in, or the width of a picture's canvas."""
    if stimulus.picture:
        from vbraille.sessions.planning.pictures import picture

        return picture(protocol, stimulus).resolved.canvas.width_mm
    cells = stimulus.masks(protocol.display.lead_cells)
    return protocol.style(stimulus.look).geometry.extent_mm(len(cells))


def edges_mm(protocol: Protocol, stimulus: Stimulus) -> tuple[float, ...]:
    """Return the left edges of the dot columns that a display shows, left to right."""
    style = protocol.style(stimulus.look)
    shown, geometry = style.mapping.shown_dots(), style.geometry
    return tuple(
        cell * geometry.cell_pitch_mm + side * geometry.dot_spacing_mm
        for cell, mask in enumerate(stimulus.masks(protocol.display.lead_cells))
        for side, dots in enumerate(SIDES)
        if mask & shown & dots
    )


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
