"""Drawings of ink on paper, in mm: what SVG, PDF and PNG files of scenes are written from.

A drawing is a row of marks, each on top of those before it. Places are x and y in mm from the top
left corner, y down. A gray is 0 for black to 1 for white.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.scene.measures import Point

Contours = tuple["NDArray[np.float64]", ...]  # float64[n, 2] each


@dataclass(frozen=True, slots=True, eq=False)
class InkArea:
    """What is inside of closed contours, in one gray.

    Contours of holes run the other way round than those around them, so that all rules of filling
    leave the holes.
    """

    contours: Contours
    gray: float = 0.0


@dataclass(frozen=True, slots=True, eq=False)
class InkLine:
    """Lines through places.

    Parameters
    ----------
    contours
        The places of each line.
    width_mm
        Width of the ink.
    gray
        Gray of the ink.
    closed
        Whether each line goes back to its first place.
    dashes_mm
        Lengths of a dash and of the blank after it; None for a whole line.
    into_mm
        How far into a dash and its blank a line begins.
    round_ends
        Whether ends are round; they are cut square otherwise, as dashes are.
    """

    contours: Contours
    width_mm: float
    gray: float = 0.0
    closed: bool = False
    dashes_mm: tuple[float, float] | None = None
    into_mm: float = 0.0
    round_ends: bool = True


@dataclass(frozen=True, slots=True, eq=False)
class InkDiscs:
    """Round dots of one size: float64[n, 2] centres, in one gray."""

    centers_mm: NDArray[np.float64]
    radius_mm: float
    gray: float = 0.0


@dataclass(frozen=True, slots=True, eq=False)
class InkText:
    """Print for sighted people: its baseline begins, or has its middle, at a place."""

    text: str
    place_mm: Point
    size_mm: float = 3.0
    centered: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class InkRaster:
    """Pixels over a rectangle: uint8[rows, columns], 0 for black, with its top left corner."""

    pixels: NDArray[np.uint8]
    place_mm: Point
    width_mm: float
    height_mm: float


@dataclass(frozen=True, slots=True, eq=False)
class InkClip:
    """Marks of which only what is inside of contours is seen."""

    contours: Contours
    marks: tuple[PlainMark, ...]


PlainMark = InkArea | InkLine | InkDiscs | InkText | InkRaster
InkMark = PlainMark | InkClip


@dataclass(frozen=True, slots=True, eq=False)
class InkDrawing:
    """A drawing with its size and what it shows.

    Parameters
    ----------
    width_mm, height_mm
        Size of the paper.
    marks
        The marks, the last on top.
    title, description
        What it shows, in a word and in sentences.
    said
        What must be known of how it was drawn, a sentence each.
    """

    width_mm: float
    height_mm: float
    marks: tuple[InkMark, ...]
    title: str = ""
    description: str = ""
    said: tuple[str, ...] = field(default=())


def shifted(mark: InkMark, by_mm: tuple[float, float], scale: float = 1.0) -> InkMark:
    """Make a mark larger by a factor, around the origin, and then move it."""
    by = np.array(by_mm)
    match mark:
        case InkArea():
            return replace(mark, contours=tuple(c * scale + by for c in mark.contours))
        case InkLine():
            dashes = mark.dashes_mm
            return replace(
                mark,
                contours=tuple(c * scale + by for c in mark.contours),
                width_mm=mark.width_mm * scale,
                dashes_mm=None if dashes is None else (dashes[0] * scale, dashes[1] * scale),
                into_mm=mark.into_mm * scale,
            )
        case InkDiscs():
            centers = mark.centers_mm * scale + by
            return replace(mark, centers_mm=centers, radius_mm=mark.radius_mm * scale)
        case InkText():
            x, y = (np.array(mark.place_mm) * scale + by).tolist()
            return replace(mark, place_mm=(x, y), size_mm=mark.size_mm * scale)
        case InkRaster():
            x, y = (np.array(mark.place_mm) * scale + by).tolist()
            size = mark.width_mm * scale, mark.height_mm * scale
            return replace(mark, place_mm=(x, y), width_mm=size[0], height_mm=size[1])
        case InkClip():
            inner = tuple(shifted(one, by_mm, scale) for one in mark.marks)
            contours = tuple(c * scale + by for c in mark.contours)
            return InkClip(contours, inner)  # pyright: ignore[reportArgumentType]
