"""Drawings of ink by matplotlib, as PDF and PNG files that are true to scale."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import EllipseCollection
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.patches import PathPatch
from matplotlib.path import Path as Outline
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from vbraille.pictures.figurefiles import METADATA, styled
from vbraille.pictures.ink import (
    InkArea,
    InkClip,
    InkDiscs,
    InkDrawing,
    InkLine,
    InkRaster,
    InkText,
)
from vbraille.pictures.words import plain

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from vbraille.pictures.ink import Contours, PlainMark

_MM_PER_INCH, _POINTS_PER_INCH = 25.4, 72
_POINTS_PER_MM = _POINTS_PER_INCH / _MM_PER_INCH


def ink_pdf(drawing: InkDrawing) -> bytes:
    """Make the PDF file of a drawing, a page of its size."""
    told = {"Title": plain(drawing.title), "Subject": plain(drawing.description)}
    content = io.BytesIO()
    with styled():
        figure = _figure(drawing)
        figure.savefig(content, format="pdf", metadata=told | METADATA["pdf"])
    return content.getvalue()


def ink_png(drawing: InkDrawing, pixels_per_mm: float) -> bytes:
    """Make the PNG file of a drawing, 8 bits of gray, with its title and description.

    Parameters
    ----------
    drawing
        The drawing.
    pixels_per_mm
        Resolution.
    """
    dpi = pixels_per_mm * _MM_PER_INCH
    with styled():
        figure = _figure(drawing)
        figure.dpi = dpi
        canvas = FigureCanvasAgg(figure)
        canvas.draw()
        pixels = np.asarray(canvas.buffer_rgba())[..., 0]
    told = PngInfo()
    texts = {"Title": drawing.title, "Description": drawing.description, **METADATA["png"]}
    for key, text in texts.items():
        if text.strip():
            told.add_text(key, plain(text))
    content = io.BytesIO()
    Image.fromarray(pixels).save(content, "png", dpi=(dpi, dpi), pnginfo=told, optimize=True)
    return content.getvalue()


def _figure(drawing: InkDrawing) -> Figure:
    size = drawing.width_mm / _MM_PER_INCH, drawing.height_mm / _MM_PER_INCH
    figure = Figure(figsize=size, facecolor="white")
    figure.set_layout_engine("none")
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_axis_off()
    axes.set(xlim=(0, drawing.width_mm), ylim=(drawing.height_mm, 0), aspect="auto")
    for layer, mark in enumerate(drawing.marks, 1):
        clip = None
        if isinstance(mark, InkClip):
            clip = _outline(mark.contours, closed=True)
        for inner in mark.marks if isinstance(mark, InkClip) else (mark,):
            artist = _draw(axes, inner)
            artist.set_zorder(layer)
            if clip is not None:
                artist.set_clip_path(clip, axes.transData)
    return figure


def _draw(axes: Axes, mark: PlainMark) -> Artist:
    match mark:
        case InkArea():
            patch = PathPatch(_outline(mark.contours, closed=True), linewidth=0)
            patch.set_facecolor(str(mark.gray))
            return axes.add_patch(patch)
        case InkLine():
            return axes.add_patch(_line(mark))
        case InkDiscs():
            sizes = np.full(len(mark.centers_mm), 2 * mark.radius_mm)
            discs = EllipseCollection(
                sizes,
                sizes,
                np.zeros_like(sizes),
                units="xy",
                offsets=mark.centers_mm,
                offset_transform=axes.transData,
                linewidths=0,
                facecolors=str(mark.gray),
            )
            return axes.add_collection(discs, autolim=False)
        case InkText():
            side = "center" if mark.centered else "left"
            size = mark.size_mm * _POINTS_PER_MM
            return axes.text(*mark.place_mm, plain(mark.text), fontsize=size, ha=side)
        case InkRaster():
            return _raster(axes, mark)


def _line(mark: InkLine) -> PathPatch:
    patch = PathPatch(_outline(mark.contours, closed=mark.closed), fill=False)
    patch.set(edgecolor=str(mark.gray), linewidth=mark.width_mm * _POINTS_PER_MM)
    patch.set_capstyle("round" if mark.round_ends else "butt")
    patch.set_joinstyle("round" if mark.round_ends else "miter")
    if mark.dashes_mm is not None:
        # Dashes are told in widths of the line.
        patch.set_linestyle(
            (
                mark.into_mm / mark.width_mm,
                tuple(length / mark.width_mm for length in mark.dashes_mm),
            )
        )
    return patch


def _raster(axes: Axes, mark: InkRaster) -> AxesImage:
    x, y = mark.place_mm
    image = AxesImage(
        axes,
        cmap="gray",
        extent=(x, x + mark.width_mm, y + mark.height_mm, y),
        origin="upper",
        interpolation="none",
    )
    image.set_data(mark.pixels)
    image.set_clim(0, 255)
    image.set_clip_path(axes.patch)
    return axes.add_image(image)


def _outline(contours: Contours, *, closed: bool) -> Outline:
    """Make one path of contours; matplotlib fills by winding, so holes must run backwards."""
    places, codes = [], []
    for contour in contours:
        steps = np.full(len(contour) + closed, Outline.LINETO, dtype=np.uint8)
        steps[0] = Outline.MOVETO
        if closed:
            contour = np.vstack([contour, contour[:1]])
            steps[-1] = Outline.CLOSEPOLY
        places.append(contour)
        codes.append(steps)
    return Outline(np.vstack(places), np.concatenate(codes))
