"""Movement of the hand over a line, by its ticks."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vbraille.sessions.record.strokes import turning_points

STILL_MM_S, STILL_S = 5.0, 0.3  # the hand pauses while it is slower than that, for that long


class Duration(NamedTuple):
    """The ticks in which a line was read, how long that was, and whether the hand came back."""

    ticks: slice
    seconds: float
    returned: bool


def duration(ticks: NDArray[np.void], edge_mm: float, span_mm: float) -> Duration | None:
    """Return how long a line was read; None if the hand never came to it.

    Reading begins when the rightmost actuator comes to the left edge of the first dot, and ends
    when it crosses that edge to the left for the last time (Lévesque 2009, 3.4).
    """
    on = ticks["x_mm"] + span_mm / 2 >= edge_mm
    if not on.any():
        return None
    start = int(np.argmax(on))
    left = start + 1 + np.flatnonzero(on[start:-1] & ~on[start + 1 :])
    end = int(left[-1]) if left.size else len(ticks) - 1
    seconds = float(ticks["time_ns"][end] - ticks["time_ns"][start]) / 1e9
    return Duration(slice(start, end + 1), seconds, bool(left.size))


def pauses(ticks: NDArray[np.void], edge_mm: float, span_mm: float, back_mm: float) -> list[float]:
    """Return how often, and for how long, the hand stood on a line, and how often it went back.

    What counts is the way from the first touch to the furthest place, from which the hand is on its
    way to the next line.

    Parameters
    ----------
    back_mm
        Shortest way back that counts.
    """
    on = np.flatnonzero(ticks["x_mm"] + span_mm / 2 >= edge_mm)
    if not on.size:
        return [0, 0.0, 0]
    furthest = on[0] + int(np.nanargmax(ticks["x_mm"][on[0] :]))
    within = ticks[on[0] : furthest + 1]
    still = stretches(np.abs(within["vx_mm_s"]) < STILL_MM_S, within["time_ns"])
    long = still[still >= STILL_S]
    back = (len(turning_points(within["x_mm"], back_mm)) - 1) // 2
    return [int(long.size), float(long.sum()), back]


def stretches(marked: NDArray[np.bool_], time_ns: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return the lengths in s of the stretches of ticks that are marked.

    >>> stretches(np.array([0, 1, 1, 0, 1], bool), np.arange(5) * 10**9)
    array([1., 0.])
    """
    edges = np.diff(np.concatenate(([False], marked, [False])).astype(np.int8))
    starts, stops = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1) - 1
    return (time_ns[stops] - time_ns[starts]) / 1e9
