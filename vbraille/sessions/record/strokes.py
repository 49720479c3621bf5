"""Strokes of the hand over a string, and the pattern in which it was read (fig. 3.15).

Where the source tells patterns apart by eye, these rules are ours. The way of the hand is cut into
strokes wherever it turns back by 2 mm or more. A stroke to the right is a pass if it brings the
middle of the array over nine tenths of the string or more, and a re-scan if over less, but a tenth
or more. A string over whose nine tenths the middle never came is read "in part"; another one with a
re-scan is "re-scan", and one without is "one pass", "two passes" or "more passes".
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

REVERSAL_MM = 2.0  # about a dot's width: a hand that goes back further can feel a dot again
PASS_SHARE, RESCAN_SHARE = 0.9, 0.1
PASSES = {1: "one pass", 2: "two passes"}


def turning_points(x_mm: NDArray[np.float64], least_mm: float = REVERSAL_MM) -> list[int]:
    """Return the ticks at which a way turns back by a length or more, with its two ends."""
    steps = np.sign(np.diff(x_mm))
    moves = np.flatnonzero(steps)
    turned = moves[1:][steps[moves[1:]] != steps[moves[:-1]]]
    turns: list[int] = []
    furthest = 0
    for tick in [*turned.tolist(), len(x_mm) - 1]:
        if not turns:
            if abs(x_mm[tick] - x_mm[furthest]) >= least_mm:
                turns.append(furthest)
                furthest = tick
            continue
        way = x_mm[furthest] - x_mm[turns[-1]]
        gone = x_mm[tick] - x_mm[furthest]
        if way * gone > 0:
            furthest = tick
        elif abs(gone) >= least_mm:
            turns.append(furthest)
            furthest = tick
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

    def share(one: float, other: float) -> float:
        over_mm = min(max(one, other), last_mm) - max(min(one, other), first_mm)
        return over_mm / (last_mm - first_mm)

    seconds = {"right": 0.0, "left": 0.0}
    lengths = {"right": 0.0, "left": 0.0}
    shares = []
    for start, end in pairwise(turning_points(x_mm)):
        way = "right" if x_mm[end] > x_mm[start] else "left"
        seconds[way] += float(time_ns[end] - time_ns[start]) / 1e9
        lengths[way] += float(abs(x_mm[end] - x_mm[start]))
        if way == "right":
            shares.append(share(x_mm[start], x_mm[end]))
    passes = sum(part >= PASS_SHARE for part in shares)
    rescans = sum(RESCAN_SHARE <= part < PASS_SHARE for part in shares)
    pattern = PASSES.get(passes, "more passes")
    if share(x_mm.min(), x_mm.max()) < PASS_SHARE:
        pattern = "in part"
    elif rescans or not passes:  # many small steps may go over it with neither
        pattern = "re-scan"
    speeds = {
        f"speed_{way}_mm_s": round(lengths[way] / seconds[way], 3) if seconds[way] else ""
        for way in seconds
    }
    return {"pattern": pattern, "passes": passes, "rescans": rescans} | speeds
