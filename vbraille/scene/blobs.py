"""Dots in the places where an image has blobs: Lévesque 2009, 6.3.1, and the grid of 5.3."""

from __future__ import annotations

import math
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from msgspec.structs import replace

from vbraille.errors import InputError, needing_extras
from vbraille.scene.bitmap import WHOLE
from vbraille.scene.imagefiles import intensities_of
from vbraille.scene.images import MOST_PER_MM, named, naming, shape_of, size_mm
from vbraille.scene.pattern import Pattern
from vbraille.scene.patterns import Dots, Group

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from vbraille.scene.measures import Point
    from vbraille.scene.patterns import AnyPattern, ImageDots

MOST_DOTS = 20_000
# Dots share a pattern if they look the same: no finger tells these steps, nor does an 8-bit image
# have finer ones.
_RADIUS_MM = 0.01
_LEVELS = 255
_LEAST_RADIUS_MM = 0.05


@dataclass(frozen=True, slots=True)
class _Dot:
    center_mm: Point
    radius_mm: float
    amplitude: float


def dots_of(pattern: ImageDots, folder: Path) -> AnyPattern:
    """Dots of an image.

    Without a grid of cells, pixels above the threshold that touch, also at a corner, are a blob.
    Its dot stands at its centre of mass, by gray, and is as high as its brightest pixel.

    Parameters
    ----------
    pattern
        Image, and how its dots look. The amplitude of that counts together with the gray.
    folder
        Folder from which the name of its file is seen.

    Returns
    -------
    Dots or Group
        The dots; a group, by the maximum, if not all look the same.

    Raises
    ------
    InputError
        If the file cannot be read, nothing in it is above the threshold, there are more than
        20,000 dots, dots overlap, which they may not (6.3.1), or one is farther away than 10 m.
    """
    size = (0.0, 0.0)

    def shape(columns: int, rows: int, own: tuple[float, float] | None) -> tuple[int, int]:
        nonlocal size
        size = size_mm(pattern, columns, rows, own)
        most_columns, most_rows = shape_of(*size, MOST_PER_MM)
        return min(columns, most_columns), min(rows, most_rows)

    with naming(pattern):
        gray = intensities_of(Path(folder, pattern.file), "gray", shape)
    find = _blobs if pattern.cell_mm is None else _cells
    dots = find(pattern, gray, size)
    if not dots:
        raise InputError(
            f"{named(pattern)} has no dot: nothing in its image is above the threshold of "
            f"{pattern.threshold:g}; make that smaller"
        )
    _refuse_overlap(pattern, dots)
    try:
        return _drawn(pattern, dots)
    except ValueError as error:  # where the image reaches farther than any place may be
        raise InputError(f"{named(pattern)} has dots too far away: {error}") from None


def _blobs(pattern: ImageDots, gray: NDArray[np.uint16], size: Point) -> list[_Dot]:
    """Find a dot for each connected set of pixels above the threshold."""
    import numpy as np

    with needing_extras():
        from scipy import ndimage
    rows, columns = gray.shape
    wide, high = size[0] / columns, size[1] / rows
    labeled: Any = ndimage.label(gray > pattern.threshold * WHOLE, np.ones((3, 3)))
    labels, count = labeled  # a pair unless the labels are to be written elsewhere
    _check_count(pattern, count)
    if not count:
        return []
    numbers = np.arange(1, count + 1)
    centers: Any = ndimage.center_of_mass(gray.astype(np.float64), labels, numbers)
    largest = ndimage.maximum(gray, labels, numbers)
    areas = np.bincount(labels.ravel(), minlength=count + 1)[1:] * wide * high
    left, top = pattern.place_mm
    return [
        _Dot(
            (left + (column + 0.5) * wide, top + (row + 0.5) * high),
            math.sqrt(area / math.pi) if pattern.by_area else pattern.dot.radius_mm,
            float(high_gray) / WHOLE,
        )
        for (row, column), area, high_gray in zip(centers, areas, largest, strict=True)
    ]


def _cells(pattern: ImageDots, gray: NDArray[np.uint16], size: Point) -> list[_Dot]:
    """Find a dot for each cell of a grid whose mean gray is above the threshold."""
    import numpy as np
    from PIL import Image

    wide, high = pattern.cell_mm or (0.0, 0.0)
    # Whole cells only, as in the source: 113 by 60 mm have 94 by 33.
    columns, rows = (int(of / cell + 1e-9) for of, cell in zip(size, (wide, high), strict=True))
    if not columns or not rows:
        raise InputError(f"{named(pattern)} is smaller than a cell; make the cells smaller")
    _check_count(pattern, columns * rows)
    per_mm = gray.shape[1] / size[0], gray.shape[0] / size[1]
    covered = (0.0, 0.0, columns * wide * per_mm[0], rows * high * per_mm[1])
    means = Image.fromarray(gray.astype(np.float32)).resize(
        (columns, rows), Image.Resampling.BOX, box=covered
    )
    left, top = pattern.place_mm
    radius = min(pattern.dot.radius_mm, wide / 2, high / 2)
    return [
        _Dot((left + (column + 0.5) * wide, top + (row + 0.5) * high), radius, mean / WHOLE)
        for row, line in enumerate(np.asarray(means).tolist())
        for column, mean in enumerate(line)
        if mean > pattern.threshold * WHOLE
    ]


def _check_count(pattern: ImageDots, count: int) -> None:
    if count > MOST_DOTS:
        what = "blobs" if pattern.cell_mm is None else "cells"
        raise InputError(
            f"{named(pattern)} has {count} {what}, and no more than {MOST_DOTS} can be dots; "
            "take a simpler image"
        )


def _refuse_overlap(pattern: ImageDots, dots: list[_Dot]) -> None:
    """Refuse dots that overlap; the larger look for smaller ones, so that none looks far."""
    with needing_extras():
        from scipy.spatial import KDTree
    tree = KDTree([dot.center_mm for dot in dots])
    for number in sorted(range(len(dots)), key=lambda n: -dots[n].radius_mm):
        dot = dots[number]
        for near in tree.query_ball_point(dot.center_mm, 2 * dot.radius_mm):
            other = dots[near]
            apart = math.dist(dot.center_mm, other.center_mm)
            if near != number and apart < dot.radius_mm + other.radius_mm - _RADIUS_MM:
                (x, y), (x2, y2) = dot.center_mm, other.center_mm
                raise InputError(
                    f"{named(pattern)} has dots that overlap, at {x:.1f}, {y:.1f} mm and at "
                    f"{x2:.1f}, {y2:.1f} mm; draw them farther apart, or make them smaller"
                )


def _drawn(pattern: ImageDots, dots: list[_Dot]) -> AnyPattern:
    """Draw dots, those that look the same as one pattern."""
    alike: dict[tuple[int, int], list[Point]] = defaultdict(list)
    for dot in dots:
        alike[round(dot.radius_mm / _RADIUS_MM), round(dot.amplitude * _LEVELS)].append(
            dot.center_mm
        )
    own = {name: getattr(pattern, name) for name in Pattern.__struct_fields__}
    parts = [
        Dots(
            centers_mm=tuple(centers),
            dot=replace(
                pattern.dot,
                radius_mm=max(radius * _RADIUS_MM, _LEAST_RADIUS_MM),
                amplitude=pattern.dot.amplitude * level / _LEVELS,
            ),
        )
        for (radius, level), centers in sorted(alike.items())
    ]
    if len(parts) == 1:
        return replace(parts[0], **own)
    return Group(operation="maximum", parts=tuple(parts), **own)
