"""Assets of a scene: bitmaps of images, and labels as cells, with their numbers.

A label has a frame of its own: u along its lines and v down across them, in mm, from the top left
corner of its first cell, which is where the square around dot 1 begins. With angle φ::

    u = (x - x0) cos φ + (y - y0) sin φ,    v = (y - y0) cos φ - (x - x0) sin φ

The dot in column s (0 left, 1 right) and row r of cell c of line n is round; its square begins at
u = c · cell pitch + s · dot spacing, v = n · line pitch + r · row spacing. Off the dots a label is
at rest, whatever the mapping of its style: in a picture what is inverted is said by the pattern.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from vbraille.braille.cells import DOT_ROWS, PLACES
from vbraille.render.braille.style import coefficients
from vbraille.render.cellkernels import (
    APART,
    CELL_PITCH,
    CELLS_PER_MM,
    CONTRAST,
    COSINE,
    COUNT,
    DOT_SPACING,
    DOT_WIDTH,
    DOTS_PER_MM,
    FADE_MM,
    HEIGHT,
    LINE_PITCH,
    LINES,
    LINES_PER_MM,
    PROFILE,
    ROW_PITCH,
    ROWS_PER_MM,
    SHAPE,
    SINE,
    STRIDE,
    WIDTH,
    X0,
    Y0,
)
from vbraille.scene.bounds import around

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from vbraille.render.braille.style import BrailleStyle
    from vbraille.scene.bitmap import Bitmap
    from vbraille.scene.bounds import Box
    from vbraille.scene.measures import Point
    from vbraille.scene.patterns import Image, Label


@dataclass(frozen=True, slots=True, eq=False)
class Written:
    """A label as cells, and how they are shown.

    Parameters
    ----------
    lines : tuple of uint8[n]
        Dot masks of the cells of each line.
    style
        Distances, profile and tuning of its dots.
    """

    lines: tuple[NDArray[np.uint8], ...]
    style: BrailleStyle


@dataclass(frozen=True, slots=True)
class Assets:
    """Assets that are needed beside a scene to compile it.

    Parameters
    ----------
    bitmaps
        Intensities of each image of the scene.
    written
        Cells of each label of the scene.
    signals
        Numbers of the signals by their names, and of their integrals by ``∫`` and the name.
    """

    bitmaps: Mapping[Image, Bitmap] = field(default_factory=dict)
    written: Mapping[Label, Written] = field(default_factory=dict)
    signals: Mapping[str, int] = field(default_factory=dict)


# By so much lines may reach into one another; a dot is less than 1e-9 up so near its edge.
_SLACK_MM = 1e-6
_ROWS = 3
_EIGHT_DOTS = 0xC0  # dots 7 and 8, which make a fourth row
# Bit r of a word is the dot in row r of the left column; bit 4 + r that of the right one.
_WORDS = np.array(
    [
        sum(1 << 4 * side + row for dot, (side, row) in PLACES.items() if mask >> (dot - 1) & 1)
        for mask in range(256)
    ],
    np.uint16,
)


@dataclass(frozen=True, slots=True, eq=False)
class PackedLabel:
    """A label for the kernels.

    Parameters
    ----------
    numbers : float64[COUNT]
        The numbers, at the places that `braillenumbers` names; ``TABLE`` is 0, and has to be where
        its words begin once they are part of a larger table.
    table : uint16[lines · STRIDE]
        A word for each cell of each line.
    """

    numbers: NDArray[np.float64]
    table: NDArray[np.uint16]


def size_mm(written: Written) -> tuple[float, float]:
    """Tell the width and height of the rectangle of a label's cells, in mm; 0, 0 without cells."""
    geometry, lines = written.style.geometry, written.lines
    cells = max((len(masks) for masks in lines), default=0)
    if cells == 0:
        return 0.0, 0.0
    rows = _ROWS + any(bool(np.any(masks & _EIGHT_DOTS)) for masks in lines)
    down = (len(lines) - 1) * geometry.line_pitch_mm + (rows - 1) * geometry.row_spacing_mm
    return geometry.extent_mm(cells), down + geometry.dot_width_mm


def corners_mm(
    label: Label, written: Written, margin_mm: float = 0.0
) -> tuple[Point, Point, Point, Point]:
    """Tell the corners of a label's rectangle, grown by a margin; clockwise from the first cell's.

    With half a dot width and `FADE_MM` as the margin nothing of the label is outside, not even of
    its opacity.
    """
    width_mm, height_mm = size_mm(written)
    angle = math.radians(label.angle_deg)
    cosine, sine = math.cos(angle), math.sin(angle)

    def place(u_mm: float, v_mm: float) -> Point:
        x_mm, y_mm = label.place_mm
        return x_mm + u_mm * cosine - v_mm * sine, y_mm + u_mm * sine + v_mm * cosine

    left, right, bottom = -margin_mm, width_mm + margin_mm, height_mm + margin_mm
    return place(left, left), place(right, left), place(right, bottom), place(left, bottom)


def pack_label(label: Label, written: Written) -> PackedLabel:
    """Make the numbers and the words of a label, whose own modifiers are left to its caller."""
    geometry, tuning = written.style.geometry, written.style.tuning
    angle = math.radians(label.angle_deg)
    numbers = np.zeros(COUNT)
    numbers[X0], numbers[Y0] = label.place_mm
    numbers[COSINE], numbers[SINE] = math.cos(angle), math.sin(angle)
    numbers[WIDTH], numbers[HEIGHT] = size_mm(written)
    numbers[LINES] = len(written.lines)
    numbers[LINE_PITCH] = geometry.line_pitch_mm
    numbers[LINES_PER_MM] = 1 / geometry.line_pitch_mm
    numbers[ROW_PITCH] = geometry.row_spacing_mm
    numbers[ROWS_PER_MM] = 1 / geometry.row_spacing_mm
    numbers[CELL_PITCH] = geometry.cell_pitch_mm
    numbers[CELLS_PER_MM] = 1 / geometry.cell_pitch_mm
    numbers[DOT_SPACING] = geometry.dot_spacing_mm
    numbers[DOT_WIDTH] = geometry.dot_width_mm
    numbers[DOTS_PER_MM] = 1 / geometry.dot_width_mm
    numbers[CONTRAST] = tuning.contrast
    numbers[PROFILE] = written.style.profile
    numbers[SHAPE : SHAPE + 6] = coefficients(written.style.profile, tuning)
    stride = max((len(masks) for masks in written.lines), default=0) + 2
    numbers[STRIDE] = stride
    numbers[APART] = (
        geometry.dot_width_mm
        <= min(geometry.dot_spacing_mm, geometry.cell_gap_mm, geometry.row_spacing_mm)
        and (DOT_ROWS - 1) * geometry.row_spacing_mm + geometry.dot_width_mm
        <= geometry.line_pitch_mm + _SLACK_MM
    )
    table = np.zeros((len(written.lines), stride), np.uint16)
    for row, masks in zip(table, written.lines, strict=True):
        row[1 : 1 + len(masks)] = _WORDS[masks]
    return PackedLabel(numbers, table.ravel())


def box_of(label: Label, written: Written) -> Box:
    """Tell the upright rectangle outside which a label and its opacity are 0."""
    margin_mm = written.style.geometry.dot_width_mm / 2 + FADE_MM
    return around(corners_mm(label, written, margin_mm))
