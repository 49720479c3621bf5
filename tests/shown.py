"""Lines compiled in one call, and the arrays that tests show them on."""

from dataclasses import replace

import numpy as np

from tests.render.braille.reference import deflections
from vbraille.display import Display
from vbraille.render import STRESS2, VBD, BrailleStyle, Mapping, kernels
from vbraille.render.braille.mappings import NONE
from vbraille.render.program import Program
from vbraille.render.work import NO_PART

STRESS2_ARRAY = STRESS2.display
VBD_ARRAY = VBD.display
# A device of the author's later code (Lévesque 2009, ch. 8, and its successor).
LATERO = Display("Latero", rows=8, columns=8, column_pitch_mm=1.2, row_pitch_mm=1.6125)


def array_of(rows, columns, column_pitch_mm, row_pitch_mm) -> Display:
    """Actuators, on a carriage of no consequence."""
    return Display("array", rows, columns, column_pitch_mm, row_pitch_mm)


def rendered(masks, *, array, profile, mapping, geometry, tuning, first_row=None, anchor_mm=None):
    """A line on a display, for places of the array's centre, or of the anchor that is given."""
    style = BrailleStyle(profile, mapping, geometry, tuning, first_row)
    program = style.render(masks, array)
    return program if anchor_mm is None else program.with_anchor(anchor_mm)


def from_left(masks, **manner):
    """A line on a display, for places of the left column as the twin has them."""
    return rendered(masks, **manner).with_anchor(0.0)


def twin(x_mm, masks, *, array, profile, mapping, geometry, tuning, first_row=None, anchor_mm=0.0):
    """The frames of a line in plain numpy, for places of the left column."""
    style = BrailleStyle(profile, mapping, geometry, tuning, first_row)
    return deflections(x_mm, masks, style, array, anchor_mm)


def full(display) -> Program:
    """A picture of actuators all the way up, wherever the array is."""
    mapping = Mapping("up", *((NONE,) * display.rows,) * 2, (True,) * display.rows)
    return replace(STRESS2.style, mapping=mapping).render(np.zeros(1, np.uint8), display)


def part_of(program, y_mm, before=NO_PART):
    """Tell which part of a picture is under an array with its centre at y."""
    return kernels.part_of(program.numbers, y_mm, before)
