"""Movement of the hand over a line, by its ticks: its duration, its pauses, and its strokes.

The pattern in which a string was read (Lévesque 2009, fig. 3.15) is told apart by eye in the
source; these rules are ours. The way of the hand is cut into strokes wherever it turns back by 2 mm
or more. A stroke to the right is a pass if it brings the middle of the array over nine tenths of
the string or more, and a re-scan if over less, but a tenth or more. A string over whose nine tenths
the middle never came is read "in part"; another one with a re-scan is "re-scan", and one without is
"one pass", "two passes" or "more passes".
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

STILL_MM_S, STILL_S = 5.0, 0.3  # the hand pauses while it is slower than that, for that long
REVERSAL_MM = 2.0  # about a dot's width: a hand that goes back further can feel a dot again
PASS_SHARE, RESCAN_SHARE = 0.9, 0.1
PASSES = {1: "one pass", 2: "two passes"}


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
    still = np.abs(within["vx_mm_s"]) < STILL_MM_S
    edges = np.flatnonzero(np.diff(still, prepend=False, append=False))
    stood_s = (within["time_ns"][edges[1::2] - 1] - within["time_ns"][edges[::2]]) / 1e9
    long = stood_s[stood_s >= STILL_S]
    back = (len(turning_points(within["x_mm"], back_mm)) - 1) // 2
    return [int(long.size), float(long.sum()), back]


def turning_points(x_mm: NDArray[np.float64], least_mm: float = REVERSAL_MM) -> list[int]:
    """Return the ticks at which a way turns back by a length or more, with its two ends."""
    moves = np.flatnonzero(np.diff(x_mm))
    turned = moves[1:][np.diff(np.sign(np.diff(x_mm)[moves])) != 0]
    turns: list[int] = []
    furthest, way = 0, 0.0
    for tick in [*turned.tolist(), len(x_mm) - 1]:
        gone = x_mm[tick] - x_mm[furthest]
        if way * gone > 0:
            furthest = tick
        elif abs(gone) >= least_mm:
            turns.append(furthest)
            furthest, way = tick, gone
    return [*turns, furthest] if turns else []


def describe(
    x_mm: NDArray[np.float64], time_ns: NDArray[np.int64], first_mm: float, last_mm: float
) -> dict[str, Any]:
    """Return the cells of a session's table on how a string was read.

    Parameters
    ----------
    x_mm, time_ns : float64[ticks], int64[ticks]
        Places of the middle of the array within the time that counts, and their times.
    first_mm, last_mm
        Left edge of the first dot that is shown, and right edge of the last.
    """
    turns = np.array(turning_points(x_mm), int)
    starts_mm, ends_mm = x_mm[turns[:-1]], x_mm[turns[1:]]
    way_mm, seconds = ends_mm - starts_mm, np.diff(time_ns[turns]) / 1e9

    def shares(low_mm: Any, high_mm: Any) -> Any:
        over_mm = np.minimum(high_mm, last_mm) - np.maximum(low_mm, first_mm)
        return over_mm / (last_mm - first_mm)

    strokes = shares(starts_mm, ends_mm)[way_mm > 0]
    passes = int((strokes >= PASS_SHARE).sum())
    rescans = int((strokes >= RESCAN_SHARE).sum()) - passes
    pattern = PASSES.get(passes, "more passes")
    if shares(x_mm.min(), x_mm.max()) < PASS_SHARE:
        pattern = "in part"
    elif rescans or not passes:  # many small steps may go over it with neither
        pattern = "re-scan"
    told: dict[str, Any] = {"pattern": pattern, "passes": passes, "rescans": rescans}
    for way, own in (("right", way_mm > 0), ("left", way_mm < 0)):
        speed = abs(way_mm[own].sum()) / seconds[own].sum() if own.any() else None
        told[f"speed_{way}_mm_s"] = "" if speed is None else round(float(speed), 3)
    return told
