"""How the hand moved over a line, which the ticks tell."""

from __future__ import annotations

from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

REVERSAL_MM = 2.0  # about a dot's width: a hand that goes back further can feel a dot again
TURN_MM = 0.25  # so close to where it turns, a hand is turning; it may stand there
PASS_SHARE, RESCAN_SHARE = 0.9, 0.1  # of a string that a pass, or a re-scan, goes over
STILL_MM_S, STILL_S = 5.0, 0.3  # the hand pauses while it is slower than that, for that long
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


def turns(x_mm: NDArray[np.float64], least_mm: float) -> list[int]:
    """Return where a way turns by a length or more, with its two furthest ends.

    >>> turns(np.array([0.0, 9.0, 5.0, 6.0, 4.0, 12.0, 11.5]), 3.0)
    [0, 1, 4, 5]
    """
    found: list[int] = []
    low = high = extreme = going = 0
    for n, x in enumerate(x_mm.tolist()):
        if not going:
            low, high = (n if x < x_mm[low] else low), (n if x > x_mm[high] else high)
            if x_mm[high] - x_mm[low] >= least_mm:
                going = 1 if high > low else -1
                found, extreme = [min(low, high)], max(low, high)
        elif (x - x_mm[extreme]) * going > 0:
            extreme = n
        elif (x_mm[extreme] - x) * going >= least_mm:
            found.append(extreme)
            going, extreme = -going, n
    return [*found, extreme] if going else found


def strokes(ticks: NDArray[np.void], first_mm: float, last_mm: float) -> dict[str, Any]:
    """Return the pattern in which a string was read, its passes, and the speeds of the hand.

    The way of the hand is cut wherever it turns back by 2 mm or more. A stroke to the right is a
    pass if it brings the middle of the array over 90 % of the string or more, and a re-scan if over
    less, but 10 % or more. Speeds leave out the time within 0.25 mm of a turn.

    Parameters
    ----------
    ticks
        Ticks in which the line was read.
    first_mm, last_mm
        Left edge of the first dot, and right edge of the last.
    """
    known = ticks[np.isfinite(ticks["x_mm"])]
    x_mm = known["x_mm"]
    ways: dict[bool, list[tuple[float, float]]] = {True: [], False: []}
    passes = rescans = 0
    for start, end in pairwise(turns(x_mm, REVERSAL_MM)):
        way_mm = np.abs(x_mm[start : end + 1] - x_mm[start])
        leaves = start + int(np.flatnonzero(way_mm <= TURN_MM)[-1])
        comes = start + int(np.argmax(way_mm >= way_mm[-1] - TURN_MM))
        time_s = (known["time_ns"][comes] - known["time_ns"][leaves]) / 1e9
        rightward = bool(x_mm[end] > x_mm[start])
        ways[rightward].append((abs(x_mm[comes] - x_mm[leaves]), time_s))
        share = _share(x_mm[start], x_mm[end], first_mm, last_mm) if rightward else 0.0
        passes += share >= PASS_SHARE
        rescans += RESCAN_SHARE <= share < PASS_SHARE
    pattern = "re-scan" if rescans else PASSES.get(passes, "more passes")
    if _share(x_mm.min(), x_mm.max(), first_mm, last_mm) < PASS_SHARE or not passes:
        pattern = "in part"
    row: dict[str, Any] = {"pattern": pattern, "passes": passes, "rescans": rescans}
    for name, rightward in (("speed_right_mm_s", True), ("speed_left_mm_s", False)):
        seconds = sum(time_s for _, time_s in ways[rightward])
        if seconds > 0:
            row[name] = round(float(sum(way for way, _ in ways[rightward]) / seconds), 3)
    return row


def _share(from_mm: float, to_mm: float, first_mm: float, last_mm: float) -> float:
    """Return the share of a string that the middle of the array goes over."""
    over_mm = min(to_mm, last_mm) - max(from_mm, first_mm)
    return float(max(over_mm, 0.0) / (last_mm - first_mm))


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
    return [int(long.size), float(long.sum()), (len(turns(within["x_mm"], back_mm)) - 1) // 2]


def stretches(marked: NDArray[np.bool_], time_ns: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return the lengths in s of the stretches of ticks that are marked.

    >>> stretches(np.array([0, 1, 1, 0, 1], bool), np.arange(5) * 10**9)
    array([1., 0.])
    """
    edges = np.diff(np.concatenate(([False], marked, [False])).astype(np.int8))
    starts, stops = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1) - 1
    return (time_ns[stops] - time_ns[starts]) / 1e9
