"""Lines of braille cells as numbers and words for the kernel of round dots."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vbraille.braille.cells import DOT_ROWS, PLACES
from vbraille.render import cellkernels as c
from vbraille.render.braille.dots import coefficients

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from vbraille.braille.geometry import Geometry
    from vbraille.render.braille.dots import Profile, Tuning

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


class PackedCells(NamedTuple):
    """Cells for the kernel.

    Parameters
    ----------
    numbers : float64[COUNT]
        Numbers at the places that `vbraille.render.cellkernels` names; ``TABLE`` is 0, and has to
        be where the words begin once they are part of a larger table.
    table : uint16[lines · STRIDE]
        A word for each cell of each line.
    """

    numbers: NDArray[np.float64]
    table: NDArray[np.uint16]


def cells_size_mm(lines: Sequence[NDArray[np.uint8]], geometry: Geometry) -> tuple[float, float]:
    """Width and height of the rectangle of cells, in mm; 0, 0 without cells."""
    cells = max((len(masks) for masks in lines), default=0)
    if cells == 0:
        return 0.0, 0.0
    rows = _ROWS + any(bool(np.any(masks & _EIGHT_DOTS)) for masks in lines)
    down = (len(lines) - 1) * geometry.line_pitch_mm + (rows - 1) * geometry.row_spacing_mm
    return geometry.extent_mm(cells), down + geometry.dot_width_mm


def pack_cells(
    lines: Sequence[NDArray[np.uint8]],
    geometry: Geometry,
    profile: Profile,
    tuning: Tuning,
    place: tuple[float, float, float],
) -> PackedCells:
    """Make the numbers and the words of lines of cells.

    Parameters
    ----------
    lines : sequence of uint8[n]
        Dot masks of each line.
    geometry, profile, tuning
        Distances of the dots, and how they are shown.
    place
        Corner of the first cell, in mm, and direction of the lines, in radians.
    """
    dot, x_mm, y_mm, angle = geometry.dot_width_mm, *place
    stride = max((len(masks) for masks in lines), default=0) + 2
    width_mm, height_mm = cells_size_mm(lines, geometry)
    least_mm = min(geometry.dot_spacing_mm, geometry.cell_gap_mm, geometry.row_spacing_mm)
    rows_mm = (DOT_ROWS - 1) * geometry.row_spacing_mm + dot
    numbers = np.zeros(c.COUNT)
    for at, value in {
        c.X0: x_mm,
        c.Y0: y_mm,
        c.COSINE: math.cos(angle),
        c.SINE: math.sin(angle),
        c.WIDTH: width_mm,
        c.HEIGHT: height_mm,
        c.LINES: len(lines),
        c.LINE_PITCH: geometry.line_pitch_mm,
        c.LINES_PER_MM: 1 / geometry.line_pitch_mm,
        c.ROW_PITCH: geometry.row_spacing_mm,
        c.ROWS_PER_MM: 1 / geometry.row_spacing_mm,
        c.CELL_PITCH: geometry.cell_pitch_mm,
        c.CELLS_PER_MM: 1 / geometry.cell_pitch_mm,
        c.DOT_SPACING: geometry.dot_spacing_mm,
        c.DOT_WIDTH: dot,
        c.DOTS_PER_MM: 1 / dot,
        c.CONTRAST: tuning.contrast,
        c.PROFILE: profile,
        c.STRIDE: stride,
        c.APART: dot <= least_mm and rows_mm <= geometry.line_pitch_mm + _SLACK_MM,
    }.items():
        numbers[at] = value
    numbers[c.SHAPE : c.SHAPE + 6] = coefficients(profile, tuning)
    table = np.zeros((len(lines), stride), np.uint16)
    for row, masks in zip(table, lines, strict=True):
        row[1 : 1 + len(masks)] = _WORDS[masks]
    return PackedCells(numbers, table.ravel())
