"""Speed at which passages were read, with the hand's pauses and regressions."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vbraille.analysis.input.parsing import PASSAGE_COLUMNS
from vbraille.analysis.input.trials import groups
from vbraille.analysis.results import CONDITION, NOTE_COLUMN, PROTOCOL, Column, Kind, Schema, ends
from vbraille.analysis.statistics.intervals import Unanswerable, mean_interval

if TYPE_CHECKING:
    import pandas as pd

    from vbraille.analysis.results import ResultTable, Row

_ALL = "all"
READING_SPEED = Schema(
    "reading_speed",
    "Reading speed",
    "Of each participant, with Student's interval over the own passages; over participants, the "
    "mean of their means, with Student's interval. Pauses and regressions are those of the hand "
    "within a line, a passage.",
    (
        PROTOCOL,
        Column("participant", "participant", "pseudonym; all for the mean over participants"),
        CONDITION,
        Column("passages", "passages", "how many", Kind.COUNT),
        Column("speed", "words a minute", "of the passages' words", Kind.NUMBER),
        *ends(),
        Column("pauses", "pauses", "of the hand, a passage", Kind.NUMBER),
        Column("regressions", "regressions", "of the hand, a passage", Kind.NUMBER),
        NOTE_COLUMN,
    ),
    empty="no passage was read",
)


def timed(judgements: pd.DataFrame) -> pd.DataFrame:
    """Judgements of passages that were read to the end, and whose time is known."""
    asked = judgements[judgements["question"] == "read"]
    return asked[(asked["answered"] == "read") & asked["words_per_minute"].notna()]


def reading_speed(judgements: pd.DataFrame) -> ResultTable:
    """Speed of each participant in each condition, and means over participants."""
    rows: list[Row] = []
    for (protocol, condition), part in groups(timed(judgements), "protocol", "condition"):
        about: Row = {"protocol": protocol, "condition": condition}
        means: list[list[float]] = []
        for (participant,), own in groups(part, "participant"):
            speeds = own["words_per_minute"].to_numpy(np.float64)
            means.append([float(own[name].mean()) for name in PASSAGE_COLUMNS])
            row = about | {"participant": participant, "passages": len(own)}
            rows.append(row | _row(means[-1], speeds))
        if len(means) > 1:
            row = about | {"participant": _ALL, "passages": len(part)}
            each = np.array(means)
            rows.append(row | _row(each.mean(axis=0).tolist(), each[:, 0]))
    return READING_SPEED.fill(rows)


def _row(means: list[float], speeds: np.ndarray) -> Row:
    """Means of some passages or participants, with the interval of the speed."""
    row: Row = dict(zip(("speed", "pauses", "regressions"), means, strict=True))
    try:
        found = mean_interval(speeds)
    except Unanswerable as reason:
        return row | {"note": f"no interval: {reason}"}
    return row | {"low": found.low, "high": found.high}
