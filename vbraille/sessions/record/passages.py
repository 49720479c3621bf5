"""Reading of a passage: its speed from the journal, its pauses and regressions from the trace.

The time of a passage is from the first touch of its first line to the end of its last one, pauses
of the session left out. The hand *pauses* while it is slower than 5 mm/s for 0.3 s or longer, from
the first touch of a line to its end, and *regresses* where it goes to the left there by half a cell
or more.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from vbraille.sessions.record.events import Contact, Ended, Read

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from vbraille.sessions.planning.stimuli import Trial
    from vbraille.sessions.record.events import JournalEvent
    from vbraille.sessions.record.progress import TrialRecord
    from vbraille.sessions.record.traces import TickColumns

STILL_MM_S, STILL_S = 5.0, 0.3
COLUMNS = {
    "lines": "number of the passage's lines",
    "words": "number of the passage's words",
    "words_per_minute": "from the first touch of the first line to the end of the last one, pauses "
    "of the session left out",
    "hand_pauses": "how often the hand stood still within a line, for 0.3 s or longer",
    "hand_paused_s": "how long it did, together",
    "regressions": "how often the hand went back within a line, by half a cell or more",
}
_PER_MINUTE = 60.0


def spans_of(events: Iterable[JournalEvent], told: TrialRecord) -> dict[int, list[int]]:
    """Times at which each stimulus of a trial's last attempt was touched and read, ns, if known."""
    found: dict[int, list[int]] = {}
    for event in events:
        if not isinstance(event, Contact | Read | Ended) or event.time_ns is None:
            continue
        of = (event.trial, event.practice, event.attempt)
        if of != (told.trial.number, told.trial.practice, told.attempts):
            continue
        times = found.setdefault(event.stimulus, [])
        if bool(times) is not isinstance(event, Contact):
            times.append(event.time_ns)
    return {stimulus: times[:2] for stimulus, times in found.items()}


def read_so(
    trial: Trial, told: TrialRecord, spans: dict[int, list[int]], lines: list[TickColumns]
) -> dict[str, Any]:
    """Cells of a row for how a passage was read; those that are not known are left out.

    Parameters
    ----------
    trial, told
        The trial as it was shown, and its record.
    spans
        Times of each line, as `spans_of` gives them.
    lines
        Ticks of each line, in order; empty where the trace is damaged.
    """
    words = len((trial.stimuli[0].text or "").split())
    row: dict[str, Any] = {"lines": len(trial.stimuli), "words": words}
    known: list[list[int]] = [spans.get(n, []) for n in range(len(trial.stimuli))]
    if not known[0] or len(known[-1]) < 2:
        return row
    seconds = (known[-1][1] - known[0][0]) / 1e9 - told.paused_s
    if seconds > 0:
        row["words_per_minute"] = round(_PER_MINUTE * words / seconds, 3)
    if len(lines) < len(known) or any(len(span) < 2 for span in known):
        return row
    pauses, paused_s, back = 0, 0.0, 0
    for stimulus, span, ticks in zip(trial.stimuli, known, lines, strict=True):
        time_ns = ticks["time_ns"]
        within = np.flatnonzero(
            (time_ns >= span[0]) & (time_ns <= span[1]) & ~np.isnan(ticks["x_mm"])
        )
        # From its furthest place the hand is on its way to the next line.
        if within.size:
            within = within[: int(np.argmax(ticks["x_mm"][within])) + 1]
        still = stretches(np.abs(ticks["vx_mm_s"][within]) < STILL_MM_S, time_ns[within])
        long = still[still >= STILL_S]
        pauses, paused_s = pauses + long.size, paused_s + float(long.sum())
        back += went_back(ticks["x_mm"][within], stimulus.geometry.cell_pitch_mm / 2)
    return row | {
        "hand_pauses": pauses, "hand_paused_s": round(paused_s, 3), "regressions": back,
    }  # fmt: skip


def stretches(marked: NDArray[np.bool_], time_ns: NDArray[np.int64]) -> NDArray[np.float64]:
    """Lengths in s of the stretches of ticks that are marked.

    >>> stretches(np.array([0, 1, 1, 0, 1], bool), np.arange(5) * 10**9)
    array([1., 0.])
    """
    edges = np.diff(np.concatenate(([False], marked, [False])).astype(np.int8))
    starts, stops = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1) - 1
    return (time_ns[stops] - time_ns[starts]) / 1e9


def went_back(x_mm: NDArray[np.float64], least_mm: float) -> int:
    """Number of ways to the left by a distance or more, before the hand goes on to the right.

    >>> went_back(np.array([0.0, 9.0, 5.0, 6.0, 4.0, 12.0, 11.5]), 3.0)
    1
    """
    number, furthest, lowest, counted = 0, -np.inf, np.inf, False
    for x in x_mm.tolist():
        if x >= furthest:
            furthest, lowest, counted = x, x, False
        lowest = min(lowest, x)
        if furthest - lowest >= least_mm and not counted:
            number, counted = number + 1, True
        if counted and x - lowest >= least_mm:  # it goes on, and may go back again from here
            furthest, lowest, counted = x, x, False
    return number
