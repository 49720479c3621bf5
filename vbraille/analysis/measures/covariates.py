"""Covariates of right answers, by a logistic model of single trials."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from vbraille.analysis.input.trials import chosen, codes, factor
from vbraille.analysis.results import NOTE_COLUMN, Column, Kind, Schema, ends
from vbraille.analysis.statistics.intervals import FEWEST_PARTICIPANTS, Unanswerable, too_few
from vbraille.analysis.statistics.trialsmodel import combine, fit_trials
from vbraille.braille.cells import UNICODE_BLANK

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from vbraille.analysis.results import ResultTable, Row
    from vbraille.analysis.statistics.trialsmodel import TrialsFit

ALIKE = "no interval: participants who have it do not differ, or are too few to tell"
MOST_ODDS = 600.0  # logarithm of an odds ratio that a number can still hold


COVARIATES = Schema(
    "model_covariates",
    "What else legibility goes with",
    "Odds ratio of a right answer for one unit more, in one logistic regression of single trials "
    "on the conditions and all covariates, with participants as clusters. Each is told with the "
    "others held still: what is read in another time may be more legible, or the other way round.",
    (
        Column("covariate", "covariate", "what it is, with its unit"),
        Column("participants", "participants", "who have it", Kind.COUNT),
        Column("trials", "trials", "of all participants", Kind.COUNT),
        Column("odds_ratio", "odds ratio", "for a unit more", Kind.NUMBER),
        *ends(),
        Column("df", "df", "degrees of freedom of t", Kind.NUMBER),
        Column("t", "t", "of the logarithm of the odds ratio", Kind.NUMBER),
        Column("p", "p", "two-sided", Kind.P),
        NOTE_COLUMN,
    ),
)
_MANY = 10  # trials that the odds ratio over time is for
_TIMED = 0.5  # share of the trials whose duration must be known for it to be a covariate


def covariates(trials: pd.DataFrame, factors: Sequence[str]) -> ResultTable:
    """Odds ratios of what varies between trials besides the conditions.

    Parameters
    ----------
    trials
        Trials, as in `vbraille.analysis.input.trials`.
    factors
        Columns whose levels, crossed, are the conditions.
    """
    late = _later(trials)
    seconds = trials["duration_s"].to_numpy(np.float64)
    timed = seconds > 0  # not of a duration that is not known
    notes = []
    if timed.mean() < _TIMED:
        seconds = None
    elif not timed.all():
        notes.append(
            f"without {(~timed).sum()} of {len(trials)} trials, whose duration is not known"
        )
        trials, late, seconds = chosen(trials, timed), late[timed], seconds[timed]
    columns = {
        name: value for name, value in _columns(trials, late, seconds).items() if np.ptp(value) > 0
    }
    if not columns:
        return COVARIATES.fill([], [*notes, "the trials differ in no covariate"])
    participants = trials["participant"].nunique()
    if participants < FEWEST_PARTICIPANTS:
        return COVARIATES.fill([], [*notes, f"no covariates: {too_few(participants)}"])
    right, asked, design = _single(trials, factors, list(columns.values()))
    try:
        fit = fit_trials(right, asked, design)
    except Unanswerable as reason:
        return COVARIATES.fill([], [*notes, f"no covariates: {reason}"])
    units = np.eye(design.shape[-1])[design.shape[-1] - len(columns) :]
    return COVARIATES.fill(
        [
            {"covariate": name, "participants": participants, "trials": len(trials)}
            | _odds(fit, unit)
            for name, unit in zip(columns, units, strict=True)
        ],
        notes,
    )


def _odds(fit: TrialsFit, unit: NDArray[np.float64]) -> Row:
    """Columns of an odds ratio, or the note that says why it has no interval."""
    estimate = float(fit.coefficients[0] @ unit)
    row: Row = {"odds_ratio": float(np.exp(np.clip(estimate, -MOST_ODDS, MOST_ODDS)))}
    found = combine(fit, unit)
    if np.isnan(found.errors[0]):
        return row | {"note": ALIKE}
    low, high = np.exp(np.clip(np.concatenate(found.ends()), -MOST_ODDS, MOST_ODDS)).tolist()
    t = estimate / float(found.errors[0])
    row |= {"low": low, "high": high, "df": float(found.degrees[0]), "t": t}
    return row | {"p": float(found.p_values()[0])}


def _later(trials: pd.DataFrame) -> NDArray[np.float64]:
    """Tens of trials that came before each in its session."""
    by = trials.groupby(["participant", "session"], observed=True)
    return by.cumcount().to_numpy(np.float64) / _MANY


def _columns(
    trials: pd.DataFrame, late: NDArray[np.float64], seconds: NDArray[np.float64] | None
) -> dict[str, NDArray[np.float64]]:
    """Covariates of each trial, in the unit that is named; those not known are not there."""
    found = {f"{_MANY} trials later in the session": late}
    block = trials["block"].to_numpy(np.float64)
    if (block > 0).all():
        found["a block later"] = block
    strings = trials["presented"].cat.categories
    cells = np.frombuffer("".join(strings).encode("utf-32-le"), "<u4") - UNICODE_BLANK
    lengths = np.array([len(text) for text in strings])
    own = np.repeat(np.arange(len(strings)), lengths)
    dots = np.bincount(own, np.bitwise_count(cells)) / lengths
    which = codes(trials["presented"])
    found["a dot more in each cell"] = dots[which]
    if seconds is not None:
        found["twice the time for each cell"] = np.log2(seconds / lengths[which])
    return found


def _single(
    trials: pd.DataFrame, factors: Sequence[str], columns: Sequence[NDArray[np.float64]]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Right answers, answers and design of each trial, by participant.

    Participants with fewer trials than others have places without one.
    """
    columns_of = [pd.Series(factor(trials[name]), trials.index) for name in factors]
    cell = trials.groupby(columns_of or np.zeros(len(trials)), observed=True).ngroup()
    who = np.unique(codes(trials["participant"]), return_inverse=True)[1]
    place = pd.Series(who).groupby(who).cumcount().to_numpy()
    shape = int(who.max()) + 1, int(place.max()) + 1
    cells = int(cell.max()) + 1
    design = np.zeros((*shape, cells + len(columns)))
    design[who, place, cell.to_numpy()] = 1.0
    for at, value in enumerate(columns, cells):
        design[who, place, at] = value - value.mean()
    right, asked = np.zeros(shape), np.zeros(shape)
    right[who, place] = trials["correct"]
    asked[who, place] = 1.0
    return right, asked, design
