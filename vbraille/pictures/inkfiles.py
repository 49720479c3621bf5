"""Files of drawings of ink: SVG, PDF or PNG, as their suffix says."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from vbraille.pictures.ink import InkDrawing

INK_KINDS = ("svg", "pdf", "png")


def ink_bytes(drawing: InkDrawing, kind: str, pixels_per_mm: float) -> bytes:
    """Make the file of a drawing, with its title and description in it.

    Parameters
    ----------
    drawing
        The drawing.
    kind
        What the file is, one of `INK_KINDS`.
    pixels_per_mm
        Resolution of a PNG.
    """
    if kind == "svg":
        from vbraille.pictures.inksvg import svg

        return svg(drawing)
    # Only who wants these waits for matplotlib.
    from vbraille.pictures import drawink

    return drawink.ink_pdf(drawing) if kind == "pdf" else drawink.ink_png(drawing, pixels_per_mm)
