"""Intensities of an image over a rectangle of the canvas, and its opacity mask."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from vbraille.scene.geometry import Box

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.scene.measures import Point


WHOLE = 65_535  # the intensity 1


@dataclass(frozen=True, slots=True, eq=False)
class Bitmap:
    """Intensities over a rectangle of the canvas, which is bilinear between them.

    The value of a pixel is that of its middle. Between middles it is bilinear, and all around the
    rectangle there are pixels of the value ``outside``, so that nothing jumps at its edges. The
    rectangle of a blurred image is larger than the image, by what the blur reaches.

    Parameters
    ----------
    intensities : uint16[rows, columns]
        Intensities from 0 to 65,535, which stands for 1; row 0 is far from the reader.
    place_mm
        Top left corner of the rectangle.
    width_mm, height_mm
        Size of the rectangle.
    outside
        Intensity beyond it, from 0 to 1, in steps as fine as those of the others.
    nearest
        Whether a place has the intensity of its pixel, and not one between those of its neighbours.
    """

    intensities: NDArray[np.uint16]
    place_mm: Point
    width_mm: float
    height_mm: float
    outside: float = 0.0
    nearest: bool = False


_MOST_EDGE_PIXELS, _MOST_EDGE_MM = 5, 1.0


def opaque(bitmap: Bitmap) -> Bitmap:
    """Make the opacity mask of an image: 1 where it is anything but 0, with a soft edge around.

    The source saturates the image and adds a linear gradient around its edges; the later code of
    its author lets it fall over five pixels. Here it falls over five pixels too, or over 1 mm if
    that is less, in every direction alike and also beyond the rectangle, so that the mask is
    nowhere below the image. Each pixel is the largest of 1 - n/N for the pixels n steps away that
    are not 0, where a step goes to any of the eight neighbours and N is the length of the edge.

    Of an image of which the nearest pixels count, it is that of the later code.

    Returns
    -------
    Bitmap
        The mask, which is wider by the edge on every side.
    """
    if bitmap.nearest:
        return _opaque_pixels(bitmap)
    pixel_mm = pixel_size_mm(bitmap)
    edge = max(1, min(_MOST_EDGE_PIXELS, math.floor(_MOST_EDGE_MM / max(pixel_mm))))
    reached = np.pad(bitmap.intensities > 0, edge, constant_values=bitmap.outside > 0)
    mask = np.where(reached, WHOLE, 0).astype(np.uint16)
    for step in range(1, edge):
        for axis in (0, 1):  # the edge all around is wider than this goes
            reached = reached | np.roll(reached, 1, axis) | np.roll(reached, -1, axis)
        value = round(WHOLE * (1 - step / edge))
        np.maximum(mask, np.where(reached, value, 0).astype(np.uint16), out=mask)
    width, height = pixel_mm
    return Bitmap(
        mask,
        (bitmap.place_mm[0] - edge * width, bitmap.place_mm[1] - edge * height),
        bitmap.width_mm + 2 * edge * width,
        bitmap.height_mm + 2 * edge * height,
        1.0 if bitmap.outside > 0 else 0.0,
    )


def _opaque_pixels(bitmap: Bitmap) -> Bitmap:
    """Opacity mask of an image of which the nearest pixels count, in steps of 8 bits.

    From each pixel that is not 0 it falls linearly over five pixels, of which the fifth to the
    right and below is left out.
    """
    edge = _MOST_EDGE_PIXELS
    there = bitmap.intensities > 0
    rows, columns = there.shape
    around = np.pad(there, edge)
    mask = np.zeros(there.shape, np.uint8)
    for down in range(-edge, edge):
        for right in range(-edge, edge):
            value = int(255 * max(0.0, 1.0 - math.hypot(down, right) / edge))
            top, left = edge - down, edge - right
            reached = around[top : top + rows, left : left + columns]
            np.maximum(mask, np.where(reached, value, 0).astype(np.uint8), out=mask)
    return replace(bitmap, intensities=mask.astype(np.uint16) * (WHOLE // 255))


def pixel_size_mm(bitmap: Bitmap) -> tuple[float, float]:
    """Width and height of a pixel."""
    rows, columns = bitmap.intensities.shape
    return bitmap.width_mm / columns, bitmap.height_mm / rows


def bitmap_box(bitmap: Bitmap) -> Box | None:
    """Compute the rectangle outside which an image and its mask are 0; None for everywhere.

    Half a pixel beyond the last ones there is still something of them, since the image is bilinear.
    Where there is nothing at all it is a corner.
    """
    if bitmap.outside > 0:
        return None
    mask = opaque(bitmap)
    rows, columns = np.nonzero(mask.intensities)
    width, height = pixel_size_mm(mask)
    left, top = mask.place_mm
    if rows.size == 0:
        return Box(left, top, left, top)
    return Box(
        left + (float(columns.min()) - 0.5) * width,
        top + (float(rows.min()) - 0.5) * height,
        left + (float(columns.max()) + 1.5) * width,
        top + (float(rows.max()) + 1.5) * height,
    )
