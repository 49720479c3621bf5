"""Scores to compare: one a participant and cell of a within-subject design."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vbraille.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from vbraille.analysis.input.sheets import Sheet
    from vbraille.analysis.input.trials import Places, Trials

MOST_LEVELS = 50  # a factor of more was not varied by an experimenter
MOST_CELLS = 1_000_000  # of all participants
_MISSING = {"", "na", "n/a", "nan"}


@dataclass(frozen=True, slots=True)
class Scores:
    """Scores in long form.

    Parameters
    ----------
    measure
        What they are, with the unit: "duration (s)".
    participants : [n]
        Whose.
    factors
        Level of each score, [n], by the factor's name.
    scores : [n]
        NaN where one is missing.
    durations
        Whether scores are durations, which are above 0 and skewed.
    trials : [n]
        How many answers each share is of; None if scores are no shares of answers.
    """

    measure: str
    participants: Sequence[str]
    factors: Mapping[str, Sequence[str]]
    scores: Sequence[float]
    trials: Sequence[int] | None = None
    durations: bool = False


def of_trials(trials: Trials, places: Places, factors: Sequence[str]) -> list[Scores]:
    """Means of each participant in each cell: legibility of strings, of characters, duration.

    Raises
    ------
    InputError
        If the trials have no such column.
    """
    for name in factors:
        if name not in trials.columns():
            raise InputError(
                f"there is no column {name!r} to compare by; "
                f"there are {', '.join(trials.columns())}"
            )
    found = [trials.participant, *(trials.factor(name) for name in factors)]
    for name, factor in zip(factors, found[1:], strict=True):
        if len(factor) > MOST_LEVELS:
            raise InputError(
                f"{name} has {len(factor)} levels, more than can be compared; "
                f"give a factor of a few, such as condition"
            )
    if math.prod(map(len, found)) > MOST_CELLS:
        raise InputError(f"{', '.join(factors)} have too many levels together; give fewer factors")
    timed = ~np.isnan(trials.duration_s)
    measures = [
        ("legibility of strings", np.arange(len(trials)), trials.correct, True),
        ("legibility of characters", places.at, places.correct, True),
        ("duration (s)", np.flatnonzero(timed), trials.duration_s[timed], False),
    ]
    scores = []
    for measure, at, value, share in measures:
        if not at.size:
            continue
        shape = tuple(len(factor) for factor in found)
        cell = np.ravel_multi_index(tuple(factor.codes[at] for factor in found), shape)
        counts = np.bincount(cell, minlength=math.prod(shape))
        sums = np.bincount(cell, value, counts.size)
        means = np.divide(sums, counts, out=np.full(counts.size, np.nan), where=counts > 0)
        names = [
            [factor.levels[code] for code in codes.tolist()]
            for factor, codes in zip(found, np.indices(shape).reshape(len(shape), -1), strict=True)
        ]
        columns = dict(zip(factors, names[1:], strict=True))
        of = counts.tolist() if share else None
        scores.append(Scores(measure, names[0], columns, means.tolist(), of, not share))
    return scores


def of_sheet(sheet: Sheet) -> Scores:
    """Scores of a table with columns participant, score, and the factors.

    Raises
    ------
    InputError
        If it is no such table.
    """
    sheet.need(("participant", "score"))
    names = [name for name in sheet.columns if name not in ("participant", "score")]
    if not names:
        raise InputError(
            f"{sheet.name} has no column but participant and score; add one for what was varied, "
            f"such as texture"
        )
    for name in ("participant", *names):
        for row, value in enumerate(sheet.columns[name]):
            if not value.strip():
                raise InputError(f"{sheet.place(row)}: {name} is empty; fill it in")
    if not len(sheet):
        raise InputError(f"{sheet.name} has no scores; add a line for each")
    columns = {name: [v.strip() for v in values] for name, values in sheet.columns.items()}
    return Scores(
        "score",
        columns["participant"],
        {name: columns[name] for name in names},
        [_score(sheet, row, text) for row, text in enumerate(columns["score"])],
    )


def _score(sheet: Sheet, row: int, text: str) -> float:
    if text.lower() in _MISSING:
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
