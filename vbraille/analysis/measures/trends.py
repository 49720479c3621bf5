"""Legibility over time: Lévesque 2009, 3.4.2 and fig. 3.14."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from vbraille.analysis.input.trials import groups
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
)
from vbraille.analysis.statistics.intervals import slope_interval
from vbraille.wording import count

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.analysis.results import ResultTable, Row

PAST = 10  # trials that the moving average is taken over
_WHOSE = (
    PARTICIPANT,
    SESSION,
    CONDITION,
)
OVER_TIME = Schema(
    "over_time",
    "Legibility over time",
    f"The moving average is over the past {PAST} trials of the same session and condition, the "
    f"trial itself among them.",
    (
        *_WHOSE,
        Column("number", "number", "of the trial in its session and condition", Kind.COUNT),
        TRIAL,
        Column("correct", "correct", "1 if every place is right, else 0", Kind.COUNT),
        Column("average", f"past {PAST} (%)", "moving average", Kind.PERCENT),
        NOTE_COLUMN,
    ),
)
SLOPES = Schema(
    "slopes",
    "Change of legibility over time",
    "Slope of the straight line through the single trials (1 right, 0 wrong; least squares), for "
    "10 trials; through the moving average's points, which share trials, p would be too small.",
    (
        *_WHOSE,
        Column("trials", "trials", "how many", Kind.COUNT),
        Column(
            "slope", "slope (% in 10 trials)", "change of legibility in 10 trials", Kind.PERCENT
        ),
        *ends(Kind.PERCENT),
        Column("p", "p", "that there is no change, by t", Kind.P),
        NOTE_COLUMN,
    ),
)


def over_time(trials: pd.DataFrame) -> ResultTable:
    """Moving average at every trial, in the order of the sessions."""
    names = [column.name for column in _WHOSE]
    frame = trials.sort_values(names, kind="stable")[[*names, "trial", "correct"]]
    by = [frame[name] for name in names]
    correct = frame["correct"].astype(np.int64)
    number = correct.groupby(by, observed=True).cumcount() + 1
    right = correct.groupby(by, observed=True).cumsum()
    before = right.groupby(by, observed=True).shift(PAST, fill_value=0)
    average = ((right - before) / PAST).where(number >= PAST)
    note = pd.Series("", frame.index).mask(number < PAST, f"fewer than {PAST} trials yet")
    return OVER_TIME.fill(frame.assign(number=number, correct=correct, average=average, note=note))


def slopes(trials: pd.DataFrame) -> ResultTable:
    """Slope of legibility in every session and condition."""
    names = [column.name for column in _WHOSE]
    return SLOPES.fill(
        [
            dict(zip(names, whose, strict=True)) | slope(part["correct"].to_numpy())
            for whose, part in groups(trials, *names)
        ]
    )


def slope(correct: NDArray[np.bool_]) -> Row:
    """Least-squares slope of right and wrong on the number of the trial, for 10 trials."""
    row: Row = {"trials": correct.size}
    if correct.size < 3:
        return row | {"note": f"{count(correct.size, 'trial')}: a slope needs three"}
    if correct.all() or not correct.any():
        what = "right" if correct[0] else "wrong"
        return row | {"slope": 0.0, "note": f"no interval and no p: every trial is {what}"}
    numbers = np.arange(correct.size, dtype=np.float64)
    found, around, p = slope_interval(numbers, correct.astype(np.float64))
    return row | {"slope": 10 * found, "low": 10 * around.low, "high": 10 * around.high, "p": p}
