"""Assets of a scene: bitmaps of images, and labels as cells."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from vbraille.render.braille.style import cells_size_mm
from vbraille.render.work import FADE_MM
from vbraille.scene.bitmap import bitmap_box
from vbraille.scene.geometry import around

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.render.braille.style import BrailleStyle
    from vbraille.scene.bitmap import Bitmap
    from vbraille.scene.geometry import Box
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
    """

    bitmaps: Mapping[Image, Bitmap] = field(default_factory=dict)
    written: Mapping[Label, Written] = field(default_factory=dict)

    def boxes(self) -> dict[Image | Label, Box]:
        """Compute the rectangles outside which an image or a label and its opacity are 0."""
        boxes: dict[Image | Label, Box] = {}
        for image, bitmap in self.bitmaps.items():
            box = bitmap_box(bitmap)
            if box is not None:
                boxes[image] = box
        for label, written in self.written.items():
            margin_mm = written.style.geometry.dot_width_mm / 2 + FADE_MM
            boxes[label] = around(corners_mm(label, written, margin_mm))
        return boxes


def corners_mm(
    label: Label, written: Written, margin_mm: float = 0.0
) -> tuple[Point, Point, Point, Point]:
    """Tell the corners of a label's rectangle, grown by a margin; clockwise from the first cell's.

    With half a dot width and `FADE_MM` as the margin nothing of the label is outside, not even of
    its opacity.
    """
    width_mm, height_mm = cells_size_mm(written.lines, written.style.geometry)
    angle = math.radians(label.angle_deg)
    cosine, sine = math.cos(angle), math.sin(angle)

    def place(u_mm: float, v_mm: float) -> Point:
        x_mm, y_mm = label.place_mm
        return x_mm + u_mm * cosine - v_mm * sine, y_mm + u_mm * sine + v_mm * cosine

    left, right, bottom = -margin_mm, width_mm + margin_mm, height_mm + margin_mm
    return place(left, left), place(right, left), place(right, bottom), place(left, bottom)
