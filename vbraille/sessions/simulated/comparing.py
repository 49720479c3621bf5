"""What the simulated reader goes by when it compares two stimuli: a length, or how strong they are.

A width, a gap and a distance between dots are felt as lengths, by the edges of the dots
(`vbraille.sessions.simulated.observer`). Contrast and texture have no length: of these it feels
how strong the strongest dot is, but not what their value is.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

from vbraille.sessions.record.trajectory import columns_of, edges_mm

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vbraille.braille.geometry import Geometry
    from vbraille.render import Mapping
    from vbraille.sessions.simulated.observer import Observer
    from vbraille.sessions.simulated.skin import Exploration

WIDTH, GAP, SPACING, CELL_GAP = "dot_width_mm", "dot_gap_mm", "dot_spacing_mm", "cell_gap_mm"
LENGTHS = (WIDTH, GAP, SPACING, CELL_GAP)


def nominal_mm(parameter: str, geometry: Geometry) -> float:
    """Value of a length that the reader was told, by the nominal distances."""
    if parameter == GAP:
        return geometry.dot_spacing_mm - geometry.dot_width_mm
    return getattr(geometry, parameter)


@dataclass(frozen=True, slots=True)
class Stretch:
    """Two neighbouring dot columns of a line, whose distance tells a length.

    Parameters
    ----------
    columns
        Number of dot columns that are shown of the line.
    first
        Number of the first of the two, from 0.
    distance_mm
        Distance between the two by the nominal distances.
    cells
        How many cells further the second one is: 0 in the same cell.
    """

    columns: int
    first: int
    distance_mm: float
    cells: int


def stretch_of(
    parameter: str, masks: Sequence[int], mapping: Mapping, geometry: Geometry
) -> Stretch | None:
    """Find two dot columns by which a distance can be told; None if the line has none.

    Parameters
    ----------
    parameter
        "dot_spacing_mm" or "cell_gap_mm".
    masks
        Dot masks of the line's cells, which are the same in all trials and known to the reader.
    mapping, geometry
        Which dots are shown, and the nominal distances.
    """
    columns = columns_of(masks, mapping)
    edges = edges_mm(masks, mapping, geometry)
    for number, (one, two) in enumerate(pairwise(columns)):
        cells = two[0] - one[0]
        if (cells > 0) is (parameter == CELL_GAP):
            return Stretch(len(columns), number, edges[number + 1] - edges[number], cells)
    return None


def felt_mm(
    observer: Observer, parameter: str, exploration: Exploration, stretch: Stretch | None
) -> float:
    """Length that is felt of a stimulus; NaN if it is not felt."""
    if parameter in (WIDTH, GAP):
        return observer.lengths_mm(exploration)[(WIDTH, GAP).index(parameter)]
    dots_mm = observer.dots_mm(exploration)
    if stretch is None or len(dots_mm) != stretch.columns:
        return math.nan
    distance_mm = dots_mm[stretch.first + 1, 0] - dots_mm[stretch.first, 0]
    more_mm = (distance_mm - stretch.distance_mm) / max(stretch.cells, 1)
    return float(nominal_mm(parameter, observer.geometry) + more_mm)
