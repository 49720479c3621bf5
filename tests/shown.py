"""The arrays that tests show lines on, and what is shown on them."""

from dataclasses import replace

import numpy as np

from vbraille.display import Display
from vbraille.render import STRESS2, VBD, Mapping, kernels, work
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


def from_left(masks, style, display) -> Program:
    """A line on a display, for places of the left column as the twin has them."""
    return by_left_column(style.render(masks, display))


def by_left_column(program) -> Program:
    """The same program, for places of the array's left column in place of its centre."""
    numbers = program.numbers.copy()
    numbers[work.CENTER] = (program.shape[1] - 1) * numbers[work.COLUMN_PITCH] / 2
    return Program(numbers, program.table)


def full(display) -> Program:
    """A picture of actuators all the way up, wherever the array is."""
    mapping = Mapping("up", *((NONE,) * display.rows,) * 2, (True,) * display.rows)
    return replace(STRESS2.style, mapping=mapping).render(np.zeros(1, np.uint8), display)


def part_of(program, y_mm, before=NO_PART):
    """Tell which part of a picture is under an array with its centre at y."""
    return kernels.part_of(program.numbers, y_mm, before)
