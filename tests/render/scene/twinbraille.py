"""Braille in a picture in plain numpy, straight from where its dots stand: twin of the kernel."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from tests.render.braille.reference import SWINGS
from vbraille.braille.cells import PLACES, dots_of
from vbraille.render.braille.style import cells_size_mm
from vbraille.render.work import FADE_MM

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.render.labels import Written
    from vbraille.scene.patterns import Label


def label_deflections(
    label: Label, written: Written, x_mm: NDArray[np.float64], y_mm: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Compute what a label has at places of the canvas, without its own modifiers.

    A dot is round: its profile along x, from its middle to its right edge, holds in every
    direction (Lévesque 2009, eqs. 3.2 and 4.1-4.3, applied as eq. 6.1 is).

    Parameters
    ----------
    label, written
        The label, and its cells and their style.
    x_mm, y_mm : float64[n]
        Places of the canvas.

    Returns
    -------
    float64[n]
        Deflections, 0 … 1.
    """
    geometry, tuning = written.style.geometry, written.style.tuning
    radius_mm = geometry.dot_width_mm / 2
    u_mm, v_mm = _own_frame(label, x_mm, y_mm)
    most = np.zeros(u_mm.shape)
    for line, masks in enumerate(written.lines):
        for cell, mask in enumerate(masks):
            for dot in dots_of(int(mask)):
                side, row = PLACES[dot]
                du = u_mm - cell * geometry.cell_pitch_mm - side * geometry.dot_spacing_mm
                dv = v_mm - line * geometry.line_pitch_mm - row * geometry.row_spacing_mm
                far_mm = np.hypot(du - radius_mm, dv - radius_mm)
                inside = far_mm < radius_mm
                swing = SWINGS[written.style.profile](
                    radius_mm + far_mm[inside], geometry.dot_width_mm, tuning
                )
                most[inside] = np.maximum(most[inside], swing)
    return tuning.contrast * most


def label_opacity(
    label: Label, written: Written, x_mm: NDArray[np.float64], y_mm: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Compute the opacity of a label at places of the canvas; float64[n].

    It is 1 on the rectangle of its cells, grown by a dot's radius, and ends over `FADE_MM`; the
    source has no labels (after Lévesque 2009, 8.4.5).
    """
    width_mm, height_mm = cells_size_mm(written.lines, written.style.geometry)
    if width_mm == 0:
        return np.zeros(np.shape(x_mm))
    radius_mm = written.style.geometry.dot_width_mm / 2
    u_mm, v_mm = _own_frame(label, x_mm, y_mm)
    beside_mm = np.maximum(np.maximum(-u_mm, u_mm - width_mm) - radius_mm, 0.0)
    below_mm = np.maximum(np.maximum(-v_mm, v_mm - height_mm) - radius_mm, 0.0)
    return np.clip(1.0 - np.hypot(beside_mm, below_mm) / FADE_MM, 0.0, 1.0)


def _own_frame(
    label: Label, x_mm: NDArray[np.float64], y_mm: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Places as a label has them: along its lines, and down across them."""
    angle = math.radians(label.angle_deg)
    right_mm, down_mm = x_mm - label.place_mm[0], y_mm - label.place_mm[1]
    return (
        right_mm * math.cos(angle) + down_mm * math.sin(angle),
        down_mm * math.cos(angle) - right_mm * math.sin(angle),
    )
