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

from vbraille.render.braille.packing import PackedCells, cells_size_mm, pack_cells
from vbraille.render.cellkernels import FADE_MM
from vbraille.scene.bounds import around

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy as np
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


def size_mm(written: Written) -> tuple[float, float]:
    """Width and height of the rectangle of a label's cells, in mm; 0, 0 without cells."""
    return cells_size_mm(written.lines, written.style.geometry)


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


def pack_label(label: Label, written: Written) -> PackedCells:
    """Make the numbers and the words of a label, whose own modifiers are left to its caller."""
    style = written.style
    place = (*label.place_mm, math.radians(label.angle_deg))
    return pack_cells(written.lines, style.geometry, style.profile, style.tuning, place)


def box_of(label: Label, written: Written) -> Box:
    """Tell the upright rectangle outside which a label and its opacity are 0."""
    margin_mm = written.style.geometry.dot_width_mm / 2 + FADE_MM
    return around(corners_mm(label, written, margin_mm))
