"""Tables of the way strings were read: durations, passes, speeds, patterns (Lévesque 2009, 3.4)."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.special import betainc

from vbraille.analysis.input.sessions import PATTERN_RULE, PATTERNS, SPEED_RULE, Reading
from vbraille.analysis.input.trials import (
    NO_KEYS,
    CellKeys,
    chosen,
    codes,
    factor,
    groups,
    name_string,
)
from vbraille.analysis.results import (
    CONDITION,
    NOTE_COLUMN,
    PARTICIPANT,
    SESSION,
    TRIAL,
    Column,
    Kind,
    Schema,
    ends,
    mean_or_none,
    to_print,
)
from vbraille.analysis.statistics.intervals import Unanswerable, correlation_interval
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Iterable

    import pandas as pd
    from numpy.typing import NDArray

    from vbraille.analysis.input.sessions import SessionTrials
    from vbraille.analysis.results import ResultTable, Row

_WHOSE = (
    PARTICIPANT,
    CONDITION,
)
_SPEEDS = (
    Column("speed_right_mm_s", "speed to the right (mm/s)", "mean of the strokes", Kind.TENTHS),
    Column("speed_left_mm_s", "speed to the left (mm/s)", "mean of the strokes", Kind.TENTHS),
)
TRAJECTORIES = Schema(
    "trajectories",
    "How each string was read",
    f"{PATTERN_RULE} {SPEED_RULE}",
    (
        *_WHOSE,
        SESSION,
        TRIAL,
        Column("presented", "string", "names of its cells"),
        Column("duration_s", "duration (s)", "by the thesis's rule", Kind.TENTHS),
        Column("returned", "returned", "1 if the hand went back over the first dot", Kind.COUNT),
        Column("passes", "passes", "strokes to the right over the whole string", Kind.COUNT),
        Column("rescans", "re-scans", "strokes to the right over a part of it", Kind.COUNT),
        *_SPEEDS,
        Column("pattern", "pattern", ", ".join(PATTERNS)),
        NOTE_COLUMN,
    ),
    empty="no trial has a trajectory",
)
READING_PATTERNS = Schema(
    "patterns",
    "Reading patterns, by participant and condition",
    f"Trials of each pattern (Lévesque 2009, fig. 3.15), and means over trials. {PATTERN_RULE}",
    (
        *_WHOSE,
        Column("trials", "trials", "whose trajectory is known", Kind.COUNT),
        *(
            Column(name.replace("-", "").replace(" ", "_"), name, "trials of it", Kind.COUNT)
            for name in PATTERNS
        ),
        Column("passes", "mean passes", "of a trial", Kind.TENTHS),
        *_SPEEDS,
        NOTE_COLUMN,
    ),
    empty="no trial has a trajectory",
)
CORRELATIONS = Schema(
    "duration_legibility",
    "Correlation of duration with legibility",
    "Pearson's r, with its interval on Fisher's scale, for values of any distribution. Of a "
    "participant's trials in a condition: duration and whether the string was right. Of strings: "
    "mean duration and share of right answers, all trials pooled. Of participants: their means.",
    (
        Column("of", "of", "trials, strings or participants"),
        Column("participant", "participant", "whose trials; else all"),
        Column("condition", "condition", "in which; else all"),
        Column("n", "n", "pairs of values", Kind.COUNT),
        Column("r", "r", "Pearson's", Kind.NUMBER),
        *ends(),
        Column("p", "p", "that there is no correlation", Kind.P),
        NOTE_COLUMN,
    ),
)


def trajectories(
    sessions: Iterable[SessionTrials],
    trials: pd.DataFrame | None = None,
    keys: CellKeys = NO_KEYS,
) -> ResultTable:
    """Table with a row for each trial of a string on a device, by participant, session and trial.

    Parameters
    ----------
    sessions
        Sessions that were read.
    trials
        Trials with the names of conditions, which differ where two protocols share a name.
    keys
        Names of cells that protocols give.
    """
    named: dict[Any, str] = {}
    if trials is not None:
        named = trials.set_index(["session", "trial"])["condition"].to_dict()
    rows: list[Row] = []
    for session in sessions:
        of = {row["trial"]: row for row in session.rows}
        for number, seen in session.readings.items():
            told = of[number]
            row: Row = {
                "participant": told["participant"],
                "condition": named.get((told["session"], number), told["condition"]),
                "session": told["session"],
                "trial": number,
                "presented": name_string(told["presented"], keys),
            }
            if isinstance(seen, Reading) and told["paused_s"] > 0:
                seen = f"it was paused for {to_print(told['paused_s'], Kind.TENTHS)} s"
            elif isinstance(seen, Reading) and told["early"]:
                seen = "it was answered before it was read to its end"
            rows.append(row | (_described(seen) if isinstance(seen, Reading) else {"note": seen}))
    return TRAJECTORIES.fill(rows)


def patterns(table: ResultTable) -> ResultTable:
    """Counts and means of each participant and condition.

    Parameters
    ----------
    table
        Table that `trajectories` gives.
    """
    known = table.frame[table.frame["pattern"].notna()]
    whose = [column.name for column in _WHOSE]
    known = known.assign(**{name: factor(known[name]) for name in whose})
    rows: list[Row] = []
    for key, seen in groups(known, *whose):
        row: Row = dict(zip(whose, key, strict=True)) | {
            "trials": len(seen),
            "passes": seen["passes"].mean(),
        }
        for column, pattern in zip(READING_PATTERNS.columns[3:], PATTERNS, strict=False):
            row[column.name] = (seen["pattern"] == pattern).sum()
        notes = []
        for column, way in zip(_SPEEDS, ("right", "left"), strict=True):
            row[column.name] = mean_or_none(seen[column.name].dropna().to_numpy())
            if row[column.name] is None:
                notes.append(f"no stroke to the {way}")
        rows.append(row | {"note": "; ".join(notes)})
    return READING_PATTERNS.fill(rows)


def correlations(trials: pd.DataFrame) -> ResultTable:
    """Correlations of duration with legibility over trials, strings and participants."""
    timed = chosen(trials, trials["duration_s"].notna())
    if timed.empty:
        return CORRELATIONS.fill([], ["no duration is known"])
    rows: list[Row] = [
        {"of": "trials", "participant": participant, "condition": condition}
        | correlation(part["duration_s"].to_numpy(), part["correct"].to_numpy(), "trials")
        for (participant, condition), part in groups(timed, "participant", "condition")
    ]
    for of, name in (("strings", "string_set"), ("participants", "participant")):
        level = codes(timed[name])
        duration, correct = (
            np.bincount(level, timed[value]) / np.bincount(level)
            for value in ("duration_s", "correct")
        )
        whose = {"of": of, "participant": "all", "condition": "all"}
        rows.append(whose | correlation(duration, correct, of))
    return CORRELATIONS.fill(rows)


def _described(reading: Reading) -> Row:
    """Values of a reading, or a note on why one is missing."""
    row: Row = {name: of for name, of in asdict(reading).items() if name in TRAJECTORIES.names} | {
        "returned": int(reading.returned)
    }
    ways = {"right": reading.speed_right_mm_s, "left": reading.speed_left_mm_s}
    return row | {"note": "; ".join(f"no stroke to the {w}" for w, v in ways.items() if v is None)}


def correlation(duration: NDArray, correct: NDArray, what: str) -> Row:
    """Pearson's r of durations with shares, or with right and wrong; ``what`` is counted."""
    row: Row = {"n": duration.size}
    if duration.size < 3:
        return row | {"note": f"{count(duration.size, what[:-1])}: a correlation needs three"}
    correct = correct.astype(np.float64)
    if np.ptp(correct) == 0:
        return row | {"note": f"legibility is the same in all {what}"}
    if np.ptp(duration) <= 1e-12 * np.abs(duration).max():
        return row | {"note": f"duration is the same in all {what}"}
    r, shape = float(np.corrcoef(duration, correct)[0, 1]), duration.size / 2 - 1
    row |= {"r": r, "p": 2 * float(betainc(shape, shape, (1 - abs(r)) / 2))}
    if what == "strings":
        return row | {"note": "no interval: the same people read all strings"}
    try:
        ends = correlation_interval(duration, correct)
    except Unanswerable:
        return row | {"note": f"no interval of {duration.size} {what}"}
    return row | {"low": ends.low, "high": ends.high}
