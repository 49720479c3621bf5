"""How a string was read, from where the array was: strokes, passes, and the pattern they make.

Lévesque 2009, 3.4 and fig. 3.15, names three patterns: one pass, two passes,
re-scan of characters; it tells them apart by eye. What is exact here is ours.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from vbraille.sessions.record.trajectory import Trajectory

# Ours: about a dot's width, since a hand that goes back further can feel a dot again. Tremor and
# the counts of an encoder stay far below it.
REVERSAL_MM = 2.0
# Ours: so close to where it turns, a hand is turning; it may stand there, which is not counted.
TURN_MM = 0.25
PASS_SHARE, RESCAN_SHARE = 0.9, 0.1

ONE_PASS, TWO_PASSES, MORE_PASSES = "one pass", "two passes", "more passes"
RESCAN, IN_PART = "re-scan", "in part"
PATTERNS = (ONE_PASS, TWO_PASSES, MORE_PASSES, RESCAN, IN_PART)
PATTERN_RULE = (
    f"Within the time that counts, the way of the hand is cut into strokes wherever it turns back "
    f"by {REVERSAL_MM:g} mm or more; a stroke to the right is a pass if it brings the middle of "
    f"the array over {100 * PASS_SHARE:g} % of the string or more (from the left edge of the "
    f"first dot shown to the right edge of the last), and a re-scan if over less, but "
    f"{100 * RESCAN_SHARE:g} % or more; a trial in which the middle of the array never came over "
    f"{100 * PASS_SHARE:g} % of the string is read in part, of the others one with a re-scan is "
    f"re-scan, and one without is one pass, two passes or more passes, by their number."
)
SPEED_RULE = (
    f"The speed each way is the length of the strokes that way by the time that they took, "
    f"stops within them included, and without the time spent within {TURN_MM:g} mm of where the "
    f"hand turned."
)


@dataclass(frozen=True, slots=True)
class HandStroke:
    """A motion in one direction.

    Parameters
    ----------
    start, end
        First and last tick of the stroke: the hand turned at either.
    from_mm, to_mm
        Where the array's left column was at the first tick and at the last.
    length_mm, seconds
        Length and time of the stroke without the turns at its ends.
    """

    start: int
    end: int
    from_mm: float
    to_mm: float
    length_mm: float
    seconds: float

    @property
    def right(self) -> bool:
        """Whether the stroke goes to the right."""
        return self.to_mm > self.from_mm


@dataclass(frozen=True, slots=True)
class Reading:
    """How a string was read in a trial.

    Parameters
    ----------
    pattern
        One of `PATTERNS`, by `PATTERN_RULE`.
    duration_s
        How long the trial took, by the thesis's rule.
    returned
        Whether the hand went back over the leftmost dot; see
        `vbraille.sessions.record.trajectory.Duration`.
    passes, rescans
        Numbers of strokes to the right of either kind; short strokes are of neither.
    strokes_right, strokes_left
        Numbers of all strokes, by direction.
    speed_right_mm_s, speed_left_mm_s
        Speeds by `SPEED_RULE`; None if there is no stroke in that direction.
    """

    pattern: str
    duration_s: float
    returned: bool
    passes: int
    rescans: int
    strokes_right: int
    strokes_left: int
    speed_right_mm_s: float | None
    speed_left_mm_s: float | None


def read(trajectory: Trajectory) -> Reading:
    """Find out how a string was read in a trial, within the time that counts."""
    found = trajectory.duration
    counts = slice(found.start, found.end + 1)
    known = np.isfinite(trajectory.left_mm[counts])
    left_mm = trajectory.left_mm[counts][known]
    made = strokes(left_mm, trajectory.time_ns[counts][known])
    first_mm = trajectory.edges_mm[0]
    last_mm = trajectory.edges_mm[-1] + trajectory.dot_mm
    half_mm = trajectory.span_mm / 2

    def share(from_mm: float, to_mm: float) -> float:
        """Share of the string that the middle of the array goes over."""
        over_mm = min(to_mm + half_mm, last_mm) - max(from_mm + half_mm, first_mm)
        return max(over_mm, 0.0) / (last_mm - first_mm)

    right = [stroke for stroke in made if stroke.right]
    left = [stroke for stroke in made if not stroke.right]
    shares = [share(stroke.from_mm, stroke.to_mm) for stroke in right]
    passes = sum(part >= PASS_SHARE for part in shares)
    rescans = sum(RESCAN_SHARE <= part < PASS_SHARE for part in shares)
    return Reading(
        _pattern(share(float(left_mm.min()), float(left_mm.max())), passes, rescans),
        found.seconds,
        found.returned,
        passes,
        rescans,
        len(right),
        len(left),
        _speed_mm_s(right),
        _speed_mm_s(left),
    )


def strokes(
    x_mm: NDArray[np.float64], time_ns: NDArray[np.int64], least_mm: float = REVERSAL_MM
) -> list[HandStroke]:
    """Cut a way into strokes.

    Strokes go to the right and to the left in turn. Each begins where the one before it ends, and
    none is shorter than ``least_mm``. What comes before the first stroke and after the last is
    shorter than that, and belongs to none. Read backwards, a way has the same strokes, each in
    the other direction.

    Parameters
    ----------
    x_mm : float64[n]
        Places, all of them known.
    time_ns : int64[n]
        Time of each place.
    least_mm
        Shorter reversals do not end a stroke.
    """
    turns = turning_points(x_mm, least_mm).tolist()
    return [_stroke(x_mm, time_ns, *ends) for ends in pairwise(turns)]


def turning_points(x_mm: NDArray[np.float64], least_mm: float) -> NDArray[np.intp]:
    """Where a way turns, when reversals shorter than ``least_mm`` are taken out of it.

    Parameters
    ----------
    x_mm : float64[n]
        Places, all of them known.
    least_mm
        Length of the shortest reversal that counts; above 0.

    Returns
    -------
    intp[turns]
        Ticks of the turns, with the way's two furthest ends. They are in turn the lowest and
        the highest place between their neighbours, which are ``least_mm`` or more away. Empty
        if the way never extends so far.
    """
    steps_mm = np.diff(x_mm)
    moves = np.flatnonzero(steps_mm)
    if not moves.size:
        return np.zeros(0, np.intp)
    up = steps_mm[moves] > 0
    # The first tick at each place where the way turns, and both ends of the way.
    at = np.concatenate(([0], moves[:-1][up[1:] != up[:-1]] + 1, [moves[-1] + 1]))
    while at.size > 2:
        legs = np.abs(np.diff(x_mm[at]))
        beside = np.concatenate(([np.inf], legs, [np.inf]))
        # Both ends of a short leg between longer ones are taken out; the rest goes on as before.
        # If two neighbours are as long as each other the first goes, so that never both go at once.
        out = np.flatnonzero((legs < least_mm) & (legs < beside[:-2]) & (legs <= beside[2:]))
        if not out.size:
            return at
        keep = np.ones(at.size, bool)
        keep[out[out < legs.size - 1]] = False  # the way ends at the other end of its last leg,
        keep[out[out > 0] + 1] = False  # and begins at that of its first
        at = at[keep]
    return at if abs(x_mm[at[-1]] - x_mm[at[0]]) >= least_mm else np.zeros(0, np.intp)


def _stroke(
    x_mm: NDArray[np.float64], time_ns: NDArray[np.int64], start: int, end: int
) -> HandStroke:
    way_mm = x_mm[start : end + 1]
    from_mm, to_mm = float(way_mm[0]), float(way_mm[-1])
    # No place of a stroke is beyond its ends.
    if to_mm > from_mm:
        at_start, at_end = way_mm <= from_mm + TURN_MM, way_mm >= to_mm - TURN_MM
    else:
        at_start, at_end = way_mm >= from_mm - TURN_MM, way_mm <= to_mm + TURN_MM
    leaves, comes = end - int(np.argmax(at_start[::-1])), start + int(np.argmax(at_end))
    if leaves >= comes:  # a short way that only goes to and fro
        leaves, comes = start, end
    return HandStroke(
        start,
        end,
        from_mm,
        to_mm,
        abs(float(x_mm[comes] - x_mm[leaves])),
        float(time_ns[comes] - time_ns[leaves]) / 1e9,
    )


def _pattern(seen: float, passes: int, rescans: int) -> str:
    """Pattern of a trial in which the given share of the string was gone over."""
    if seen < PASS_SHARE:
        return IN_PART
    if rescans or not passes:  # many small steps may go over it with neither
        return RESCAN
    return {1: ONE_PASS, 2: TWO_PASSES}.get(passes, MORE_PASSES)


def _speed_mm_s(made: Iterable[HandStroke]) -> float | None:
    seconds = sum(stroke.seconds for stroke in made)
    return sum(stroke.length_mm for stroke in made) / seconds if seconds > 0 else None
