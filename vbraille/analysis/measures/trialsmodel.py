"""Single trials by a logistic model: estimated legibility, conditions compared, covariates."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pandas as pd

from vbraille.analysis.input.trials import codes, factor
from vbraille.analysis.measures.levels import MOST_LEVELS
from vbraille.analysis.schemas import NOTE_COLUMN, Column, Kind, Schema
from vbraille.analysis.statistics.correction import adjust
from vbraille.analysis.statistics.intervals import FEWEST_PARTICIPANTS, LEVEL, too_few
from vbraille.analysis.statistics.marginalmeans import TO_D, difference, mean, separate_cells
from vbraille.analysis.statistics.trialsmodel import combine, fit_trials
from vbraille.analysis.statistics.unanswerable import Unanswerable
from vbraille.braille.cells import UNICODE_BLANK

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from vbraille.analysis.schemas import ResultTable, Row
    from vbraille.analysis.statistics.trialsmodel import TrialsFit

_MODEL = (
    "Logistic regression of single trials with participants as clusters: a participant who misses "
    "a condition, or is in another group, counts with what there is."
)
MEANS = Schema(
    "model_means",
    "Estimated legibility of strings",
    f"{_MODEL} The interval is of the population's share, and t has Satterthwaite's degrees of "
    "freedom.",
    (
        Column("condition", "condition", "level of each factor that is compared by"),
        Column("participants", "participants", "who have it", Kind.COUNT),
        Column("trials", "trials", "of all participants", Kind.COUNT),
        Column("legibility", "legibility (%)", "estimated share of strings right", Kind.PERCENT),
        Column("low", "from (%)", "lower end of its 95 % interval", Kind.PERCENT),
        Column("high", "to (%)", "upper end", Kind.PERCENT),
        Column("df", "df", "degrees of freedom of its interval", Kind.NUMBER),
        NOTE_COLUMN,
    ),
)
CONTRASTS = Schema(
    "model_contrasts",
    "Conditions compared by the model of trials",
    f"{_MODEL} First against second. The odds ratio is that of the population's shares; d is its "
    "logarithm times √3/π. p is of the odds ratio, by t with Satterthwaite's degrees of freedom; "
    "corrected p takes account of all pairs, and so do the ends that are called together, by "
    "Bonferroni's correction.",
    (
        Column("first", "first", "condition"),
        Column("second", "second", "condition"),
        Column("participants", "participants", "who have one of them or both", Kind.COUNT),
        Column("odds_ratio", "odds ratio", "odds of a right answer in first by second's",
               Kind.NUMBER),
        Column("low", "from", "lower end of its 95 % interval", Kind.NUMBER),
        Column("high", "to", "upper end", Kind.NUMBER),
        Column("low_together", "from, together", "lower end, all pairs holding together",
               Kind.NUMBER),
        Column("high_together", "to, together", "upper end", Kind.NUMBER),
        Column("df", "df", "degrees of freedom of t", Kind.NUMBER),
        Column("t", "t", "of the logarithm of the odds ratio", Kind.NUMBER),
        Column("p", "p", "two-sided, not corrected", Kind.P),
        Column("p_corrected", "p corrected", "for all pairs", Kind.P),
        Column("difference", "difference (%)", "of the shares, in percentage points", Kind.PERCENT),
        Column("difference_low", "from (%)", "lower end of its 95 % interval", Kind.PERCENT),
        Column("difference_high", "to (%)", "upper end", Kind.PERCENT),
        Column("d", "d", "effect size", Kind.NUMBER),
        Column("d_low", "d from", "lower end of its 95 % interval", Kind.NUMBER),
        Column("d_high", "d to", "upper end", Kind.NUMBER),
        NOTE_COLUMN,
    ),
)  # fmt: skip
COVARIATES = Schema(
    "model_covariates",
    "What else legibility goes with",
    "Odds ratio of a right answer for one unit more, in one logistic regression of single trials "
    "on the conditions and all covariates, with participants as clusters.",
    (
        Column("covariate", "covariate", "what it is, with its unit"),
        Column("participants", "participants", "who have it", Kind.COUNT),
        Column("trials", "trials", "of all participants", Kind.COUNT),
        Column("odds_ratio", "odds ratio", "for a unit more", Kind.NUMBER),
        Column("low", "from", "lower end of its 95 % interval", Kind.NUMBER),
        Column("high", "to", "upper end", Kind.NUMBER),
        Column("df", "df", "degrees of freedom of t", Kind.NUMBER),
        Column("t", "t", "of the logarithm of the odds ratio", Kind.NUMBER),
        Column("p", "p", "two-sided", Kind.P),
        NOTE_COLUMN,
    ),
)
_ALIKE = "no interval: participants who have it do not differ, or are too few to tell"
_MANY = 10  # trials that the odds ratio over time is for
MOST_ODDS = 600.0  # logarithm of an odds ratio that a number can still hold


class Counts(NamedTuple):
    """Right answers and all answers by participant and condition."""

    names: list[str]
    cells: NDArray[np.int64]  # of each trial
    correct: NDArray[np.int64]  # [participants, conditions]
    trials: NDArray[np.int64]


def trials_model(
    trials: pd.DataFrame, factors: Sequence[str], correction: str
) -> tuple[ResultTable, ResultTable, ResultTable]:
    """Estimated means, contrasts of conditions, and covariates.

    Parameters
    ----------
    trials
        Trials, as in `vbraille.analysis.input.trials`.
    factors
        Columns whose levels, crossed, are the conditions.
    correction
        How p-values of the contrasts are corrected: a key of `statistics.correction.METHODS`.
    """
    counts = _counts(trials, factors)
    fit = fit_trials(counts.correct, counts.trials, separate_cells(*counts.trials.shape))
    means = MEANS.fill(list(_means(fit, counts)))
    if len(counts.names) < 2:
        none = f"{counts.names[0]} alone; nothing to compare"
        contrasts = CONTRASTS.fill([], [none])
    elif len(counts.names) > MOST_LEVELS:
        many = f"{len(counts.names)} conditions; the pairs of more than {MOST_LEVELS} are not told"
        contrasts = CONTRASTS.fill([], [many])
    else:
        contrasts = CONTRASTS.fill(_contrasts(fit, counts, correction))
    return means, contrasts, _covariates(trials, counts)


def _counts(trials: pd.DataFrame, factors: Sequence[str]) -> Counts:
    levels = [pd.Series(factor(trials[name])).cat for name in factors]
    shape = tuple(len(level.categories) for level in levels)
    cell = np.ravel_multi_index(tuple(level.codes.to_numpy(np.int64) for level in levels), shape)
    found, cell = np.unique(cell, return_inverse=True)
    names = [
        ", ".join(str(level.categories[at]) for level, at in zip(levels, place, strict=True))
        for place in zip(*np.unravel_index(found, shape), strict=True)
    ]
    who = np.unique(codes(trials["participant"]), return_inverse=True)[1]
    size = int(who.max()) + 1, len(names)
    at = np.ravel_multi_index((who, cell), size)
    asked = np.bincount(at, minlength=size[0] * size[1]).reshape(size)
    right = np.bincount(at, trials["correct"], asked.size).reshape(size).astype(np.int64)
    return Counts(names, cell, right, asked)


def _means(fit: TrialsFit, counts: Counts) -> Iterator[Row]:
    for at, name in enumerate(counts.names):
        have = int((counts.trials[:, at] > 0).sum())
        weights = np.eye(len(counts.names))[at]
        row: Row = {
            "condition": name,
            "participants": have,
            "trials": int(counts.trials[:, at].sum()),
            "legibility": float(fit_share(fit, weights)),
        }
        if have < FEWEST_PARTICIPANTS:
            yield row | {"note": f"no interval: {too_few(have)}"}
            continue
        found = mean(fit, weights)
        if np.isnan(found.low[0]):
            yield row | {"note": _ALIKE}
            continue
        df = float(combine(fit, weights).degrees[0])
        yield row | {"low": float(found.low[0]), "high": float(found.high[0]), "df": df}


def fit_share(fit: TrialsFit, weights: NDArray[np.float64]) -> float:
    """Estimated share of right answers of the one study that was fitted."""
    return float(1 / (1 + np.exp(-fit.coefficients[0] @ weights)))


def _contrasts(fit: TrialsFit, counts: Counts, correction: str) -> list[Row]:
    size = len(counts.names)
    pairs = list(combinations(range(size), 2))
    rows: list[Row] = []
    for one, two in pairs:
        first, second = np.eye(size)[[one, two]]
        have = counts.trials[:, [one, two]] > 0
        row: Row = {
            "first": counts.names[one],
            "second": counts.names[two],
            "participants": int(have.any(axis=1).sum()),
            "difference": fit_share(fit, first) - fit_share(fit, second),
        }
        notes = []
        if (fraction := _extremes(counts, (one, two))) is not None:
            notes.append(fraction)
        tested = _tested(fit, first - second, row["participants"], 1 - (1 - LEVEL) / len(pairs))
        if "p" in tested:
            apart = difference(fit, first, second)
            if np.isnan(apart.low[0]):
                notes.append("no interval of the difference: all are alike in one of them")
            else:
                row["difference_low"] = float(apart.low[0])
                row["difference_high"] = float(apart.high[0])
            logs = np.log([tested["odds_ratio"], tested["low"], tested["high"]]) * TO_D
            row |= dict(zip(("d", "d_low", "d_high"), logs.tolist(), strict=True))
        else:
            row["d"] = float(np.log(tested["odds_ratio"])) * TO_D
        notes += [tested.pop("note")] if "note" in tested else []
        rows.append(row | tested | {"note": "; ".join(notes)})
    known = [row for row in rows if "p" in row]
    for row, p in zip(known, adjust([row["p"] for row in known], correction), strict=True):
        row["p_corrected"] = float(p)
    return rows


def _extremes(counts: Counts, pair: tuple[int, int]) -> str | None:
    """Note on conditions in which everything or nothing was right."""
    for at in pair:
        right, asked = counts.correct[:, at].sum(), counts.trials[:, at].sum()
        if right in (0, asked):
            what = "nothing" if right == 0 else "everything"
            return f"{what} is right in {counts.names[at]}: the odds are Firth's finite ones"
    return None


def _tested(
    fit: TrialsFit, weights: NDArray[np.float64], participants: int, together: float | None
) -> dict[str, Any]:
    """Columns of an odds ratio: its intervals and test, or the note that says why there is none."""
    estimate = float(fit.coefficients[0] @ weights)
    row: dict[str, Any] = {"odds_ratio": float(np.exp(np.clip(estimate, -MOST_ODDS, MOST_ODDS)))}
    if participants < FEWEST_PARTICIPANTS:
        return row | {"note": f"no interval: {too_few(participants)}"}
    found = combine(fit, weights)
    if np.isnan(found.errors[0]):
        return row | {"note": _ALIKE}
    levels = [("low", "high", LEVEL)]
    levels += [] if together is None else [("low_together", "high_together", together)]
    for low, high, level in levels:
        ends = np.clip(np.concatenate(found.ends(level)), -MOST_ODDS, MOST_ODDS)
        row[low], row[high] = np.exp(ends).tolist()
    row |= {"df": float(found.degrees[0]), "t": estimate / float(found.errors[0])}
    return row | {"p": float(found.p_values()[0])}


def _covariates(trials: pd.DataFrame, counts: Counts) -> ResultTable:
    """Odds ratios of what varies between trials besides the conditions."""
    columns = {name: value for name, value in _columns(trials).items() if np.ptp(value) > 0}
    if not columns:
        return COVARIATES.fill([], ["the trials differ in no covariate"])
    participants = counts.trials.shape[0]
    row: Row = {"participants": participants, "trials": len(trials)}
    if participants < FEWEST_PARTICIPANTS:
        return COVARIATES.fill([], [f"no covariates: {too_few(participants)}"])
    correct, asked, design = _patterns(trials, counts, list(columns.values()))
    try:
        fit = fit_trials(correct, asked, design)
    except Unanswerable as reason:
        return COVARIATES.fill([], [f"no covariates: {reason}"])
    rows = []
    for at, name in enumerate(columns):
        weights = np.eye(design.shape[-1])[len(counts.names) + at]
        rows.append({"covariate": name} | row | _tested(fit, weights, participants, None))
    return COVARIATES.fill(rows)


def _columns(trials: pd.DataFrame) -> dict[str, NDArray[np.float64]]:
    """Covariates of each trial, in the unit that is named; those not known are not there."""
    found = {}
    number = trials.groupby(["participant", "session"], observed=True).cumcount().to_numpy()
    found[f"{_MANY} trials later in the session"] = number / _MANY
    block = trials["block"].to_numpy(np.float64)
    if (block > 0).all():
        found["a block later"] = block
    strings = trials["presented"].cat.categories
    cells = np.frombuffer("".join(strings).encode("utf-32-le"), "<u4") - UNICODE_BLANK
    own = np.repeat(np.arange(len(strings)), [len(text) for text in strings])
    dots = np.bincount(own, np.bitwise_count(cells)) / np.bincount(own)
    found["a dot more in each cell"] = dots[codes(trials["presented"])]
    return found


def _patterns(
    trials: pd.DataFrame, counts: Counts, covariates: Sequence[NDArray[np.float64]]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Counts of each participant at each pattern of condition and covariates, and the design.

    Participants with fewer patterns than others have rows without trials.
    """
    cells = len(counts.names)
    centred = [(value - value.mean()) for value in covariates]
    who = np.unique(codes(trials["participant"]), return_inverse=True)[1]
    patterns, at = np.unique(
        np.column_stack([who, counts.cells, *centred]), axis=0, return_inverse=True
    )
    asked = np.bincount(at.ravel())
    right = np.bincount(at.ravel(), trials["correct"])
    owner = patterns[:, 0].astype(np.int64)
    own = np.bincount(owner)
    place = np.arange(len(patterns)) - np.repeat(np.cumsum(own) - own, own)
    shape = own.size, int(own.max())
    design = np.zeros((*shape, cells + len(covariates)))
    design[owner, place, patterns[:, 1].astype(np.int64)] = 1.0
    design[owner, place, cells:] = patterns[:, 2:]
    counted = []
    for of in (right, asked):
        table = np.zeros(shape)
        table[owner, place] = of
        counted.append(table)
    return counted[0], counted[1], design
