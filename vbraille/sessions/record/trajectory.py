"""Way of the hand in a trial, and duration of its reading, by Lévesque 2009, 3.4."""

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
    """Duration of the reading of a string.

    Parameters
    ----------
    start, end
        Indices of the first and the last tick that count.
    seconds
        Time between these two ticks.
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
    """The way of the array in the last attempt at a trial, in which the hand came to the string.

    Parameters
    ----------
    left_mm : float64[n]
        Places of the array's left column up to the answer; NaN where one is not known.
    time_ns : int64[n]
        Times of these places, by the host's clock.
    edges_mm
        Left edges of the dot columns that are shown, at least one.
    dot_mm
        Width of a dot.
    span_mm
        Distance S from the array's left column to its right one.
    duration
        Duration of the reading, and the ticks that it is taken from.
    """

    left_mm: NDArray[np.float64]
    time_ns: NDArray[np.int64]
    edges_mm: tuple[float, ...]
    dot_mm: float
    span_mm: float
    duration: Duration


def edges_mm(masks: Sequence[int], mapping: Mapping, geometry: Geometry) -> tuple[float, ...]:
    """Left edges of the dot columns that a display shows of a line of cells, left to right."""
    return tuple(
        cell * geometry.cell_pitch_mm + side * geometry.dot_spacing_mm
        for cell, side in columns_of(masks, mapping)
    )


def columns_of(masks: Sequence[int], mapping: Mapping) -> list[tuple[int, int]]:
    """Dot columns that a display shows of a line: their cells, and 0 for the left, 1 for the right.

    They are in order, left to right.
    """
    shown = mapping.shown_dots()
    return [
        (cell, side)
        for cell, mask in enumerate(masks)
        for side, dots in enumerate(_COLUMNS)
        if mask & shown & dots
    ]


def first_edge_mm(masks: Sequence[int], mapping: Mapping, geometry: Geometry) -> float | None:
    """Left edge of the leftmost dot that a display shows of some cells; None if it shows none."""
    return next(iter(edges_mm(masks, mapping, geometry)), None)


def duration(
    left_mm: NDArray[np.float64],
    time_ns: NDArray[np.int64],
    moved: Callable[[], NDArray[np.bool_]],
    *,
    edge_mm: float,
    span_mm: float,
) -> Duration | None:
    """Duration of a trial, by the rule of Lévesque 2009 in an exact form.

    It starts with the first tick at which the rightmost actuator, at a distance S from the left
    column, is at the left edge of the leftmost dot or past it. It ends with the tick at which that
    actuator has crossed the edge to the left for the last time.

    Parameters
    ----------
    left_mm : float64[n]
        Places of the array's left column.
    time_ns : int64[n]
        Times of these places.
    moved
        Function that gives, as bool[n], whether any actuator was off its idle end; it is called
        only if it is needed.
    edge_mm, span_mm
        Left edge of the leftmost dot, and the distance S.

    Returns
    -------
    Duration or None
        Duration of the reading; None if the hand never came to the dot.
    """
    on = left_mm + span_mm >= edge_mm  # this is False where the place is not known
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
