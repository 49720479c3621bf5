"""What the hand did in a trial, from its trace: Lévesque 2009, 3.4."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from vbraille.geometry import Geometry
    from vbraille.render.mappings import Mapping


@dataclass(frozen=True, slots=True)
class Duration:
    """How long a string was read.

    Parameters
    ----------
    start, end
        First and last of the ticks that count.
    seconds
        Between the two.
    returned
        Whether the hand went back over the leftmost dot. If not, the end is the last tick at
        which an actuator was off its idle end.
    """

    start: int
    end: int
    seconds: float
    returned: bool


def first_edge_mm(masks: Sequence[int], mapping: Mapping, geometry: Geometry) -> float | None:
    """Left edge of the leftmost dot that is shown of a line of cells; None if none is."""
    rows = mapping.row_bits()
    for cell, mask in enumerate(masks):
        for side in (0, 1):
            if rows[mask, side]:
                return cell * geometry.cell_pitch_mm + side * geometry.dot_spacing_mm
    return None


def duration(
    x_mm: NDArray[np.float64],
    time_ns: NDArray[np.int64],
    moved: Callable[[], NDArray[np.bool_]],
    *,
    edge_mm: float,
    span_mm: float,
) -> Duration | None:
    """Duration of a trial, by the rule of the thesis as it was made exact.

    It starts with the first tick at which the rightmost actuator, x + S, is at
    the left edge of the leftmost dot or past it, and ends with the one at which
    it has crossed that edge downwards for the last time.

    Parameters
    ----------
    x_mm : float64[n]
        Where the array's left column was.
    time_ns : int64[n]
        When.
    moved
        Gives bool[n], whether any actuator was off its idle end; asked only if it is needed.
    edge_mm, span_mm
        The edge, and S, from the left column to the right one.

    Returns
    -------
    Duration or None
        None if the hand never came to the dot.
    """
    on = x_mm + span_mm >= edge_mm  # False where the place is not known
    if not on.any():
        return None
    start = int(np.argmax(on))
    crossings = start + 1 + np.flatnonzero(on[start:-1] & ~on[start + 1 :])
    if crossings.size:
        end, returned = int(crossings[-1]), True
    else:
        last = np.flatnonzero(moved())
        end, returned = max(start, int(last[-1]) if last.size else start), False
    return Duration(start, end, float(time_ns[end] - time_ns[start]) / 1e9, returned)
