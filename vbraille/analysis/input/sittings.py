"""Sessions' directories in; their rows, and how each string was read, out."""

from __future__ import annotations

from collections import Counter, defaultdict
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from vbraille.analysis.input.strokes import PATTERNS, read
from vbraille.sessions.record import journal
from vbraille.sessions.record.events import Answer
from vbraille.sessions.record.export import Traces, walk
from vbraille.sessions.record.folder import load
from vbraille.sessions.record.notes import read_notes
from vbraille.sessions.record.progress import Progress
from vbraille.sessions.record.trajectory import Trajectory

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from vbraille.analysis.input.strokes import Reading
    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.planning.stimuli import Trial
    from vbraille.sessions.record.eventbase import JournalEvent
    from vbraille.sessions.record.folder import Record
    from vbraille.sessions.record.notes import PlacedNote

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


def read_sitting(folder: Path) -> SessionTrials:
    """Read a session's directory; if it is damaged, read what is whole.

    Raises
    ------
    InputError
        If the directory is no session, or one of a newer format.
    VbrailleError
        If a file other than the journal and the traces is missing or has changed.
    """
    record = load(folder)
    progress = Progress(record.plan, record.told.events, record.procedure)
    traces = Traces(record)
    rows: list[dict[str, Any]] = []
    readings: dict[int, Reading | str] = {}
    examples: list[tuple[float, Example]] = []
    planned = [told.trial for told in progress.trials.values()]
    for trial, (row, seen) in zip(planned, walk(record, traces), strict=True):
        rows.append(row)
        if isinstance(seen, Trajectory):
            reading = read(seen)
            readings[trial.number] = reading
            example = _example(seen, trial, record.plan.participant, reading.pattern)
            examples.append((reading.duration_s, example))
        elif seen is not None:
            readings[trial.number] = seen
    faults = list(traces.faults)
    if record.told.damage is not None:
        faults.append(f"{journal.NAME} is damaged, {record.told.damage}")
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
        tuple(read_notes(record.told.events)),
        _counts(record.told.events),
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
    if trial is not None and progress.correcting is None and progress.told(trial).attempts:
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
