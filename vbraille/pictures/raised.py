"""Raised-line drawings for swell paper and embossers: black on white, on a sheet, true to scale."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from vbraille.pictures.abstract import abstract_drawing
from vbraille.pictures.ink import shifted
from vbraille.pictures.looks import RAISED

if TYPE_CHECKING:
    from vbraille.pictures.ink import InkDrawing
    from vbraille.render.scene.assets import Assets
    from vbraille.scene.scene import Scene

_INCH_MM = 25.4
# Width and height of a sheet, in mm; it may be turned.
SHEETS = {
    "a4": (210.0, 297.0),
    "letter": (8.5 * _INCH_MM, 11 * _INCH_MM),
    "11x11.5": (11 * _INCH_MM, 11.5 * _INCH_MM),
}
MARGIN_MM = 0.5 * _INCH_MM


def raised_drawing(scene: Scene, assets: Assets, sheet: str | None = None) -> InkDrawing:
    """Draw a scene for fingers, on paper of the canvas's size or in the middle of a sheet.

    On a sheet it has its true size, unless it is too large for what the margins leave; then it is
    made smaller as a whole, but lines, blanks and braille stay as fingers need them.

    Parameters
    ----------
    scene, assets
        A resolved scene, and what it takes from image files and labels.
    sheet
        Name of a sheet, of `SHEETS`; None for paper of the canvas's size.

    Returns
    -------
    InkDrawing
        The drawing, whose ``said`` tells the paper and the scale.

    Raises
    ------
    InputError
        If textures have more lines or dots on the canvas than can be drawn.
    """
    canvas = scene.canvas
    if sheet is None:
        drawing = abstract_drawing(scene, assets, RAISED)
        paper = f"{canvas.width_mm:g} × {canvas.height_mm:g} mm, the canvas"
        return replace(drawing, said=(f"paper: {paper}", "scale: 1 to 1, print without scaling"))
    short, long = SHEETS[sheet]
    upright = canvas.width_mm <= canvas.height_mm
    width, height = (short, long) if upright else (long, short)
    room = width - 2 * MARGIN_MM, height - 2 * MARGIN_MM
    scale = min(room[0] / canvas.width_mm, room[1] / canvas.height_mm, 1.0)
    drawing = abstract_drawing(scene, assets, RAISED.on_paper(scale))
    by = (width - scale * canvas.width_mm) / 2, (height - scale * canvas.height_mm) / 2
    marks = tuple(shifted(mark, by, scale) for mark in drawing.marks)
    way = "upright" if upright else "on its side"
    said = (
        f"paper: {sheet}, {width:g} × {height:g} mm, {way}, margins of {MARGIN_MM:g} mm or more",
        "scale: 1 to 1, print without scaling"
        if scale == 1.0
        else f"scale: {scale:.3f} of the true size, since the canvas is larger than the paper",
    )
    return replace(drawing, width_mm=width, height_mm=height, marks=marks, said=said)
