"""Scores to compare: one a participant and cell of a within-subject design."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import pandas as pd

from vbraille.analysis.input.trials import comparable, factor
from vbraille.analysis.statistics.intervals import LARGEST
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
    levels = [trials["participant"]]
    for name in factors:
        if name not in comparable(trials):
            raise InputError(
                f"there is no column {name!r} to compare by; "
                f"there are {', '.join(comparable(trials))}"
            )
        levels.append(pd.Series(factor(trials[name]), trials.index))
        if (many := len(levels[-1].cat.categories)) > MOST_LEVELS:
            raise InputError(
                f"{name} has {many} levels, more than can be compared; "
                f"give a factor of a few, such as condition"
            )
    if math.prod(len(level.cat.categories) for level in levels) > MOST_CELLS:
        raise InputError(f"{', '.join(factors)} have too many levels together; give fewer factors")
    scores = []
    for measure, value, share in (
        ("legibility of strings", trials["correct"], True),
        ("legibility of characters", places.frame["correct"], True),
        ("duration (s)", trials["duration_s"].dropna(), False),
    ):
        if value.size:
            own = [level.loc[value.index] for level in levels]
            cells: Any = value.groupby(own, observed=False).agg(["mean", "size"])
            who, *columns = (list(names) for names in zip(*cells.index, strict=True))
            of = cells["size"].tolist() if share else None
            columns = dict(zip(factors, columns, strict=True))
            scores.append(Scores(measure, who, columns, cells["mean"].tolist(), of, not share))
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
    score = sheet.value(text)
    if abs(score) >= LARGEST:
        raise InputError(
            f"{sheet.place(row)}: score is {text!r}; give a number, or nothing if it is missing"
        )
    return score
