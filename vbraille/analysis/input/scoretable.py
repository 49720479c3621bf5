"""Scores to compare: one a participant and cell of a within-subject design."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from vbraille.analysis.input.sheets import UNKNOWN
from vbraille.analysis.input.trials import comparable, factor
from vbraille.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from vbraille.analysis.input.sheets import Sheet
    from vbraille.analysis.input.trials import Places

MOST_LEVELS = 50  # a factor with more levels was not varied by an experimenter
MOST_CELLS = 1_000_000  # cells of all participants together


@dataclass(frozen=True, slots=True)
class Scores:
    """Scores in long form: one entry of each column for each score.

    Parameters
    ----------
    measure
        What the scores are, with the unit: "duration (s)".
    participants : [n]
        Participant of each score.
    factors
        Levels of all scores, [n], by the name of the factor.
    scores : [n]
        Values; NaN where one is missing.
    durations
        Whether scores are durations, which are above 0 and skewed.
    trials : [n]
        How many answers each score is a share of; None if scores are no shares of answers.
    """

    measure: str
    participants: Sequence[str]
    factors: Mapping[str, Sequence[str]]
    scores: Sequence[float]
    trials: Sequence[int] | None = None
    durations: bool = False


def of_trials(trials: pd.DataFrame, places: Places, factors: Sequence[str]) -> list[Scores]:
    """Means of each participant in each cell: legibility of strings, of characters, duration.

    Raises
    ------
    InputError
        If the trials have no such column.
    """
    found = [trials["participant"].cat]
    for name in factors:
        if name not in comparable(trials):
            raise InputError(
                f"there is no column {name!r} to compare by; "
                f"there are {', '.join(comparable(trials))}"
            )
        found.append(pd.Series(factor(trials[name])).cat)
        if len(found[-1].categories) > MOST_LEVELS:
            raise InputError(
                f"{name} has {len(found[-1].categories)} levels, more than can be compared; "
                f"give a factor of a few, such as condition"
            )
    shape = tuple(len(levels.categories) for levels in found)
    if math.prod(shape) > MOST_CELLS:
        raise InputError(f"{', '.join(factors)} have too many levels together; give fewer factors")
    cell = np.ravel_multi_index(tuple(levels.codes.to_numpy(np.int64) for levels in found), shape)
    names = [
        levels.categories[code].tolist()
        for levels, code in zip(found, np.indices(shape).reshape(len(shape), -1), strict=True)
    ]
    columns = dict(zip(factors, names[1:], strict=True))
    timed = trials["duration_s"].dropna()
    scores = []
    for measure, value, share in (
        ("legibility of strings", trials["correct"], True),
        ("legibility of characters", places.frame["correct"], True),
        ("duration (s)", timed, False),
    ):
        if value.size:
            counts = np.bincount(cell[value.index], minlength=math.prod(shape))
            sums = np.bincount(cell[value.index], value, counts.size)
            means = np.divide(sums, counts, out=np.full(counts.size, np.nan), where=counts > 0)
            of = counts.tolist() if share else None
            scores.append(Scores(measure, names[0], columns, means.tolist(), of, not share))
    return scores


def of_sheet(sheet: Sheet) -> Scores:
    """Scores of a table with columns ``participant`` and ``score``, and one for each factor.

    Raises
    ------
    InputError
        If the sheet is no such table.
    """
    sheet.need(("participant", "score"))
    names = [str(name) for name in sheet.frame if name not in ("participant", "score")]
    if not names:
        raise InputError(
            f"{sheet.name} has no column but participant and score; add one for what was varied, "
            f"such as texture"
        )
    if not len(sheet):
        raise InputError(f"{sheet.name} has no scores; add a line for each")
    frame = sheet.frame.map(str.strip)
    for name in ("participant", *names):
        empty = frame.index[frame[name] == ""]
        if empty.size:
            raise InputError(f"{sheet.place(empty[0])}: {name} is empty; fill it in")
    return Scores(
        "score",
        frame["participant"].tolist(),
        {name: frame[name].tolist() for name in names},
        [_score(sheet, row, text) for row, text in frame["score"].items()],
    )


def _score(sheet: Sheet, row: object, text: str) -> float:
    if text.lower() in UNKNOWN:
        return math.nan
    try:
        score = sheet.number(text)
    except ValueError:
        score = math.inf
    if not abs(score) < 1e100:
        raise InputError(
            f"{sheet.place(row)}: score is {text!r}; give a number, or nothing if it is missing"
        )
    return score
