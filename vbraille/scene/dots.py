"""Dots of a picture: at places of their own, or where an image has blobs; Lévesque 2009, 8.4.4."""

from __future__ import annotations

from vbraille.scene.measures import Point, check_file, check_length, check_point, check_share
from vbraille.scene.pattern import Pattern
from vbraille.scene.strokes import DotStyle


class Dots(Pattern, frozen=True, kw_only=True, tag="dots"):
    """Dots at any places, which share their look; where they overlap, the larger counts.

    Parameters
    ----------
    centers_mm
        Middles of the dots.
    dot
        How the dots look.

    Raises
    ------
    ValueError
        If there are none, or a number is out of range.
    """

    centers_mm: tuple[Point, ...]
    dot: DotStyle = DotStyle()

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.centers_mm:
            raise ValueError("centers are missing; give at least one")
        for number, center in enumerate(self.centers_mm, 1):
            check_point(f"centers, number {number}", center)


class ImageDots(Pattern, frozen=True, kw_only=True, tag="image-dots"):
    """Dots where a grayscale image has blobs: Lévesque 2009, 6.3.1 and eq. 6.1.

    A blob is a connected set of bright pixels. Its dot stands at its centre of mass and has its
    largest gray as amplitude. How a blob becomes a dot is not in the source; this is ours to
    choose.

    Parameters
    ----------
    file
        Name of a PNG, GIF, BMP, JPEG or SVG file, seen from the file of the scene.
    place_mm
        Place of the top left corner on the canvas.
    width_mm, height_mm
        Size on the canvas; if one of them is left out, it follows from the other and from the
        picture's shape.
    threshold
        Gray, from 0 to 1, above which a pixel belongs to a blob.
    by_area
        Whether a dot has its blob's area, and not the radius of ``dot``.
    dot
        How the dots look.
    cell_mm
        Width and height of a cell: there is a dot in the middle of each cell of a grid over the
        image instead, whose mean gray is its amplitude (5.3, with cells of 1.2 by 1.8 mm). No dot
        is then larger than its cell. None for blobs.

    Raises
    ------
    ValueError
        If the file is none of this machine, or a number is out of range.
    """

    file: str
    place_mm: Point = (0.0, 0.0)
    width_mm: float | None = None
    height_mm: float | None = None
    threshold: float = 0.1
    by_area: bool = True
    cell_mm: Point | None = None
    dot: DotStyle = DotStyle(plateau=0.25)

    def __post_init__(self) -> None:
        super().__post_init__()
        check_file(self.file)
        check_point("place", self.place_mm)
        check_length("width", self.width_mm, 0.1)
        check_length("height", self.height_mm, 0.1)
        check_share("threshold", self.threshold)
        for side in self.cell_mm or ():
            check_length("cell", side, 0.1)
