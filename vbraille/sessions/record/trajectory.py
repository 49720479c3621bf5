"""What the hand did in a trial, from its trace: Lévesque 2009, 3.4."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from vbraille.braille.geometry import Geometry
    from vbraille.render.braille.mappings import Mapping

_COLUMNS = (0b01000111, 0b10111000)  # masks of a cell's left dots, 1, 2, 3, 7, and its right ones


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


@dataclass(frozen=True, slots=True, eq=False)
class Trajectory:
    """The way of the array in the last attempt of a trial that the hand came to the string in.

    Parameters
    ----------
    left_mm : float64[n]
        Where the array's left column was, NaN where that is not known; up to the answer.
    time_ns : int64[n]
        When, by the host's clock.
    edges_mm
        Left edges of the dot columns that are shown; one at least.
    dot_mm
        Width of a dot.
    span_mm
        S, from the array's left column to its right one.
    duration
        Which of the ticks count.
    """

    left_mm: NDArray[np.float64]
    time_ns: NDArray[np.int64]
    edges_mm: tuple[float, ...]
    dot_mm: float
    span_mm: float
    duration: Duration


def edges_mm(masks: Sequence[int], mapping: Mapping, geometry: Geometry) -> tuple[float, ...]:
    """Left edges of the dot columns that are shown of a line of cells, from left to right."""
    shown = mapping.shown_dots()
    return tuple(
        cell * geometry.cell_pitch_mm + side * geometry.dot_spacing_mm
        for cell, mask in enumerate(masks)
        for side, dots in enumerate(_COLUMNS)
        if mask & shown & dots
    )


def first_edge_mm(masks: Sequence[int], mapping: Mapping, geometry: Geometry) -> float | None:
    """Left edge of the leftmost dot that is shown of a line of cells; None if none is."""
    return next(iter(edges_mm(masks, mapping, geometry)), None)


def duration(
    left_mm: NDArray[np.float64],
    time_ns: NDArray[np.int64],
    moved: Callable[[], NDArray[np.bool_]],
    *,
    edge_mm: float,
    span_mm: float,
) -> Duration | None:
    """Duration of a trial, by the rule of the thesis as it was made exact.

    It starts with the first tick at which the rightmost actuator, S right of the
    left column, is at the left edge of the leftmost dot or past it, and ends with the one at which
    it has crossed that edge downwards for the last time.

    Parameters
    ----------
    left_mm : float64[n]
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
    on = left_mm + span_mm >= edge_mm  # False where the place is not known
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
