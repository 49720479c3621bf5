"""Intensities of an image over a rectangle of the canvas."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from vbraille.errors import check_range

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from vbraille.scene.measures import Point

WHOLE = 65_535  # the intensity 1
# Images are 0.1 mm to 10 m, and farther with what their blur reaches.
_LEAST_MM, _MOST_MM = 0.01, 100_000.0


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

    Raises
    ------
    ValueError
        If a place or a size is no number, or far out of range.
    """

    intensities: NDArray[np.uint16]
    place_mm: Point
    width_mm: float
    height_mm: float
    outside: float = 0.0

    def __post_init__(self) -> None:
        sides = {"left": self.place_mm[0], "top": self.place_mm[1]}
        for what, value in sides.items():
            check_range(f"{what} of a bitmap", value, -_MOST_MM, _MOST_MM, " mm")
        sizes = {"width": self.width_mm, "height": self.height_mm}
        for what, value in sizes.items():
            check_range(f"{what} of a bitmap", value, _LEAST_MM, _MOST_MM, " mm")
