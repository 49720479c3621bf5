"""Sessions' directories in; their rows, and how each string was read, out."""

from __future__ import annotations

from collections import Counter, defaultdict
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from vbraille.sessions.record import journal
from vbraille.sessions.record.events import Answer
from vbraille.sessions.record.export import ROWS_NEED, Traces, read_notes, walk
from vbraille.sessions.record.folder import load
from vbraille.sessions.record.trajectory import Trajectory

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.planning.stimuli import Trial
    from vbraille.sessions.record.events import JournalEvent
    from vbraille.sessions.record.export import PlacedNote
    from vbraille.sessions.record.folder import Record
    from vbraille.sessions.record.progress import Progress

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


class HandStroke(NamedTuple):
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
        """True if the stroke goes to the right."""
        return self.to_mm > self.from_mm


@dataclass(frozen=True, slots=True)
class Reading:
    """Reading of a string in a trial.

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
    speed_right_mm_s, speed_left_mm_s
        Speeds by `SPEED_RULE`; None if there is no stroke in that direction.
    """

    pattern: str
    duration_s: float
    returned: bool
    passes: int
    rescans: int
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
    """Find where a way turns, once reversals shorter than ``least_mm`` are taken out of it.

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


MOST_PICKED = 600


@dataclass(frozen=True, slots=True, eq=False)
class Example:
    """A trial to draw, as in Lévesque 2009, fig. 3.15.

    Parameters
    ----------
    trial, participant, condition, presented
        Which trial it is; ``presented`` is Unicode braille of the cells asked for.
    pattern
        One of `PATTERNS`: how the string was read.
    time_s : float64[n]
        Time since the first tick of the attempt; n is at most `MOST_PICKED`.
    left_mm : float64[n]
        Where the array's left column was at these ticks.
    start_s, end_s
        Beginning and end of the time that counts for the duration; both are in ``time_s``.
    span_mm
        Distance from the array's left column to its right one.
    dots_mm
        Centres of the columns of dots that are shown.
    """

    trial: int
    participant: str
    condition: str
    presented: str
    pattern: str
    time_s: NDArray[np.float64]
    left_mm: NDArray[np.float64]
    start_s: float
    end_s: float
    span_mm: float
    dots_mm: tuple[float, ...]


@dataclass(frozen=True, slots=True, eq=False)
class SessionTrials:
    """A session that was read for the analysis.

    Parameters
    ----------
    folder
        Directory of the session.
    name
        Name of the directory, with more of the path if another session's has the same.
    head
        Head of the session's ``session.json``.
    protocol
        Protocol that the session followed.
    rows
        One row for each planned trial, as `vbraille.sessions.record.export.rows` makes them.
    readings
        For each answered trial that shows a string on a device, by its number: how the string was
        read, or a clause that says why that is not known.
    examples
        One trial of each pattern that occurs, in the order of `PATTERNS`: of its trials that whose
        duration is the median of theirs, the lower of two in the middle, and of equal ones the
        earlier trial.
    faults
        What is damaged, in clauses.
    state
        How far the session came.
    versions
        Versions of the programs that ran the session, by name; several if its runs differ.
    notes
        What the experimenter wrote down, in order.
    counts
        Number of events of each kind, and of practice trials that were answered: "practice".
    quitted
        Whether the participant stopped for good before all trials were done.
    """

    folder: Path
    name: str
    head: dict[str, Any]
    protocol: Protocol
    rows: list[dict[str, Any]]
    readings: dict[int, Reading | str]
    examples: tuple[Example, ...]
    faults: list[str]
    state: str
    versions: dict[str, str]
    notes: tuple[PlacedNote, ...] = ()
    counts: Counter[str] = field(default_factory=Counter)
    quitted: bool = False


def read_session(folder: Path) -> SessionTrials:
    """Read a session's directory; if it is damaged, read what is whole.

    Raises
    ------
    InputError
        If the directory is no session, or one of a newer format.
    VbrailleError
        If a file other than the journal and the traces is missing or has changed.
    """
    record = load(folder)
    progress = record.progress()
    traces = Traces(record, upto=ROWS_NEED if record.protocol.passages else "x_mm")
    rows: list[dict[str, Any]] = []
    readings: dict[int, Reading | str] = {}
    examples: list[tuple[float, Example]] = []
    planned = [told.trial for told in progress.trials.values()]
    for trial, (row, seen) in zip(planned, walk(record, traces, progress), strict=True):
        rows.append(row)
        if isinstance(seen, Trajectory):
            reading = read(seen)
            readings[trial.number] = reading
            example = _example(seen, trial, record.plan.participant, reading.pattern)
            examples.append((reading.duration_s, example))
        elif seen is not None:
            readings[trial.number] = seen
    faults = list(traces.faults)
    if record.journal.damage is not None:
        faults.append(f"{journal.NAME} is damaged, {record.journal.damage}")
    return SessionTrials(
        folder,
        folder.resolve().name,
        record.head,
        record.protocol,
        rows,
        readings,
        _examples(examples),
        faults,
        _state(progress),
        _versions(record, progress),
        tuple(read_notes(record.journal.events)),
        _counts(record.journal.events),
        progress.ended and bool(progress.why),
    )


def pick(x_mm: NDArray[np.float64], kept: Sequence[int]) -> NDArray[np.intp]:
    """Choose ticks by which to draw a way: evenly, among those whose place is known.

    Parameters
    ----------
    x_mm : float64[n]
        Places; NaN where one is not known.
    kept
        Ticks that must be among the chosen ones.

    Returns
    -------
    intp[m]
        Chosen ticks, increasing; at most `MOST_PICKED`.
    """
    known = np.flatnonzero(np.isfinite(x_mm))
    count = min(known.size, MOST_PICKED - len(kept))
    picked = np.zeros(x_mm.size, np.bool_)
    picked[known[np.linspace(0, known.size - 1, count).round().astype(np.intp)]] = True
    picked[list(kept)] = True
    return np.flatnonzero(picked)


def _example(trajectory: Trajectory, trial: Trial, participant: str, pattern: str) -> Example:
    found, begun_ns = trajectory.duration, trajectory.time_ns[0]
    ticks = pick(trajectory.left_mm, (found.start, found.end))
    start_s, end_s = (trajectory.time_ns[[found.start, found.end]] - begun_ns) / 1e9
    return Example(
        trial.number,
        participant,
        trial.condition,
        trial.presented,
        pattern,
        (trajectory.time_ns[ticks] - begun_ns) / 1e9,
        trajectory.left_mm[ticks],
        float(start_s),
        float(end_s),
        trajectory.span_mm,
        tuple(edge_mm + trajectory.dot_mm / 2 for edge_mm in trajectory.edges_mm),
    )


def _examples(examples: Iterable[tuple[float, Example]]) -> tuple[Example, ...]:
    """One example of each pattern, out of examples with their durations."""
    of: dict[str, list[tuple[float, int, Example]]] = defaultdict(list)
    for duration_s, example in examples:
        of[example.pattern].append((duration_s, example.trial, example))
    return tuple(
        sorted(of[pattern], key=lambda told: told[:2])[(len(of[pattern]) - 1) // 2][2]
        for pattern in PATTERNS
        if of[pattern]
    )


def _counts(events: Iterable[JournalEvent]) -> Counter[str]:
    """Number of events of each kind, and of practice trials that were answered."""
    counts: Counter[str] = Counter()
    practised: set[int] = set()
    for event in events:
        counts[event.kind] += 1
        if isinstance(event, Answer) and event.practice:
            practised.add(event.trial)
    counts["practice"] = len(practised)
    return counts


def _state(progress: Progress) -> str:
    if progress.ended:
        return "ended"
    trial = progress.next_trial
    # A trial whose answer was undone was read to its end all the same.
    if trial is not None and progress.correcting is None and progress.record_of(trial).attempts:
        return f"broken off in {'practice ' if trial.practice else ''}trial {trial.number}"
    answered = sum(told.answer is not None for told in progress.trials.values())
    of_all = "" if progress.planned is None else f" of {progress.planned}"
    return f"not ended: {answered}{of_all} trials answered"


def _versions(record: Record, progress: Progress) -> dict[str, str]:
    told: dict[str, list[str]] = defaultdict(list)
    for versions in (record.head.get("versions", {}), *(run.versions for run in progress.runs)):
        for name, version in versions.items():
            if version not in told[name]:
                told[name].append(version)
    return {name: ", ".join(versions) for name, versions in told.items()}
