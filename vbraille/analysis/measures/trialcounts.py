"""Right answers counted by participant and condition, for the model of trials."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from vbraille.analysis.input.trials import codes, factor
from vbraille.analysis.statistics.intervals import FEWEST_PARTICIPANTS, LEVEL, too_few
from vbraille.analysis.statistics.trialsmodel import combine

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from vbraille.analysis.statistics.trialsmodel import TrialsFit

ALIKE = "no interval: participants who have it do not differ, or are too few to tell"
MOST_ODDS = 600.0  # logarithm of an odds ratio that a number can still hold


@dataclass(frozen=True, slots=True, eq=False)
class Counts:
    """Answers by participant and condition; a condition is a level of each factor.

    Parameters
    ----------
    names : list[str], conditions
        Name of each condition.
    factors
        Names of the factors.
    levels : int64[conditions, factors]
        Number of each condition's level of each factor.
    cells, people : int64[trials]
        Condition and participant of each trial.
    correct, asked : int64[participants, conditions]
        Right answers, and all answers.
    """

    names: list[str]
    factors: tuple[str, ...]
    levels: NDArray[np.int64]
    cells: NDArray[np.int64]
    people: NDArray[np.int64]
    correct: NDArray[np.int64]
    asked: NDArray[np.int64]


def counts_of(trials: pd.DataFrame, factors: Sequence[str]) -> Counts:
    """Count the answers of trials.

    Parameters
    ----------
    trials
        Trials, as in `vbraille.analysis.input.trials`.
    factors
        Columns whose levels, crossed, are the conditions.
    """
    levels = [pd.Series(factor(trials[name])).cat for name in factors]
    shape = tuple(len(level.categories) for level in levels)
    cell = np.ravel_multi_index(tuple(level.codes.to_numpy(np.int64) for level in levels), shape)
    found, cell = np.unique(cell, return_inverse=True)
    places = np.column_stack(np.unravel_index(found, shape))
    names = [
        ", ".join(str(level.categories[at]) for level, at in zip(levels, place, strict=True))
        for place in places
    ]
    who = np.unique(codes(trials["participant"]), return_inverse=True)[1]
    size = int(who.max()) + 1, len(names)
    at = np.ravel_multi_index((who, cell), size)
    asked = np.bincount(at, minlength=size[0] * size[1]).reshape(size)
    right = np.bincount(at, trials["correct"], asked.size).reshape(size).astype(np.int64)
    return Counts(names, tuple(factors), places, cell, who, right, asked)


def odds_row(
    fit: TrialsFit,
    weights: NDArray[np.float64],
    participants: int,
    together: float | None = None,
) -> dict[str, Any]:
    """Columns of an odds ratio: its intervals and test, or the note that says why there is none.

    Parameters
    ----------
    fit
        A model that was fitted to one study.
    weights : float64[p]
        What the coefficients are multiplied by for the logarithm of the odds ratio.
    participants
        How many tell of it.
    together
        Level of the interval that holds together with others; None for no such interval.
    """
    estimate = float(fit.coefficients[0] @ weights)
    row: dict[str, Any] = {"odds_ratio": float(np.exp(np.clip(estimate, -MOST_ODDS, MOST_ODDS)))}
    if participants < FEWEST_PARTICIPANTS:
        return row | {"note": f"no interval: {too_few(participants)}"}
    found = combine(fit, weights)
    if np.isnan(found.errors[0]):
        return row | {"note": ALIKE}
    levels = [("low", "high", LEVEL)]
    levels += [] if together is None else [("low_together", "high_together", together)]
    for low, high, level in levels:
        ends = np.clip(np.concatenate(found.ends(level)), -MOST_ODDS, MOST_ODDS)
        row[low], row[high] = np.exp(ends).tolist()
    row |= {"df": float(found.degrees[0]), "t": estimate / float(found.errors[0])}
    return row | {"p": float(found.p_values()[0])}
