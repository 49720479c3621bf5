"""Single trials by a logistic model: estimated legibility, tests, contrasts and covariates."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pandas as pd

from vbraille.analysis.input.trials import chosen, codes, factor
from vbraille.analysis.measures.levels import MOST_LEVELS
from vbraille.analysis.results import NOTE_COLUMN, PARTICIPANTS, Column, Kind, Schema, ends
from vbraille.analysis.statistics.anova import orthonormal_contrasts
from vbraille.analysis.statistics.intervals import (
    FEWEST_PARTICIPANTS,
    LEVEL,
    Unanswerable,
    adjust,
    mean_share,
    too_few,
)
from vbraille.analysis.statistics.trialsmodel import (
    TO_D,
    combine,
    compare,
    compare_all,
    difference,
    fit_trials,
    separate_cells,
    tells_difference,
)
from vbraille.braille.cells import UNICODE_BLANK

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from vbraille.analysis.results import ResultTable, Row
    from vbraille.analysis.statistics.trialsmodel import TrialsFit

ALIKE = "no interval: participants who have it do not differ, or are too few to tell"
MOST_ODDS = 600.0  # logarithm of an odds ratio that a number can still hold


class Counts(NamedTuple):
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


_MODEL = (
    "Logistic regression of single trials with participants as clusters: a participant who misses "
    "a condition, or is in another group, counts with what there is."
)
MEANS = Schema(
    "model_means",
    "Estimated legibility of strings",
    f"{_MODEL} The interval is of the population's mean share, by a logit-normal model of how "
    "people differ.",
    (
        Column("condition", "condition", "level of each factor that is compared by"),
        Column("participants", "participants", "who have it", Kind.COUNT),
        Column("trials", "trials", "of all participants", Kind.COUNT),
        Column("legibility", "legibility (%)", "estimated share of strings right", Kind.PERCENT),
        *ends(Kind.PERCENT),
        NOTE_COLUMN,
    ),
)
EFFECTS = Schema(
    "model_effects",
    "Factors tested by the model of trials",
    f"{_MODEL} Wald's test that all levels of a factor are read alike, averaged over those of the "
    "others, or that factors act each by itself: of 2 asin √share, with Kauermann and Carroll's "
    "correction for few participants, as F with the degrees of freedom of Hotelling's T² (Tipton "
    "and Pustejovsky 2015). With few participants near 0 and 100 % it finds too little.",
    (
        Column("effect", "effect", "factors that act together"),
        PARTICIPANTS,
        Column("trials", "trials", "of all participants", Kind.COUNT),
        Column("df1", "df of the effect", "degrees of freedom of the effect", Kind.COUNT),
        Column("df2", "df of its error", "degrees of freedom of its error", Kind.NUMBER),
        Column("f", "F", "Wald's, corrected", Kind.NUMBER),
        Column("p", "p", "that there is no such effect", Kind.P),
        NOTE_COLUMN,
    ),
)
CONTRASTS = Schema(
    "model_contrasts",
    "Conditions compared by the model of trials",
    f"{_MODEL} First against second. The odds ratio is that of the population's shares; d is its "
    "logarithm times √3/π. Its ends that are called together hold for all pairs, by Bonferroni's "
    "correction. t is of the difference of 2 asin √share, with Satterthwaite's degrees of freedom; "
    "corrected p takes account of all pairs.",
    (
        Column("first", "first", "condition"),
        Column("second", "second", "condition"),
        Column("participants", "participants", "who have one of them or both", Kind.COUNT),
        Column("odds_ratio", "odds ratio", "odds of a right answer in first by second's",
               Kind.NUMBER),
        *ends(),
        Column("low_together", "from, together", "lower end, all pairs holding together",
               Kind.NUMBER),
        Column("high_together", "to, together", "upper end", Kind.NUMBER),
        Column("df", "df", "degrees of freedom of t", Kind.NUMBER),
        Column("t", "t", "that both are read alike", Kind.NUMBER),
        Column("p", "p", "two-sided, not corrected", Kind.P),
        Column("p_corrected", "p corrected", "for all pairs", Kind.P),
        Column("difference", "difference (%)", "of the shares, in percentage points", Kind.PERCENT),
        *ends(Kind.PERCENT, name="difference_"),
        Column("d", "d", "effect size", Kind.NUMBER),
        *ends(name="d_", heading="d "),
        NOTE_COLUMN,
    ),
)  # fmt: skip
_FEW_DIFFER = (
    "no interval of the difference: fewer than three participants have anything wrong, or right"
)


def trials_model(
    trials: pd.DataFrame, factors: Sequence[str], correction: str
) -> tuple[ResultTable, ResultTable, ResultTable]:
    """Estimated means, tests of the factors, and contrasts of conditions.

    Parameters
    ----------
    trials
        Trials, as in `vbraille.analysis.input.trials`.
    factors
        Columns whose levels, crossed, are the conditions.
    correction
        How p-values of the contrasts are corrected: a key of `statistics.correction.METHODS`.
    """
    counts = counts_of(trials, factors)
    fit = fit_trials(counts.correct, counts.asked, separate_cells(*counts.asked.shape))
    means = MEANS.fill(list(_means(fit, counts)))
    if len(counts.names) < 2:
        none = [f"{counts.names[0]} alone; nothing to compare"]
        return means, EFFECTS.fill([], none), CONTRASTS.fill([], none)
    effects = EFFECTS.fill(list(_effects(fit, counts)))
    if len(counts.names) > MOST_LEVELS:
        many = f"{len(counts.names)} conditions; the pairs of more than {MOST_LEVELS} are not told"
        return means, effects, CONTRASTS.fill([], [many])
    return means, effects, CONTRASTS.fill(_contrasts(fit, counts, correction))


def _means(fit: TrialsFit, counts: Counts) -> Iterator[Row]:
    for at, name in enumerate(counts.names):
        have = counts.asked[:, at] > 0
        right, asked = counts.correct[have, at], counts.asked[have, at]
        share = _share(fit, np.eye(len(counts.names))[at])
        row: Row = {
            "condition": name,
            "participants": int(have.sum()),
            "trials": int(asked.sum()),
            "legibility": share,
        }
        try:
            found = mean_share(right / asked, asked)
        except Unanswerable as reason:
            yield row | {"note": f"no interval: {reason}"}
        else:
            yield row | {"low": min(found.low, share), "high": max(found.high, share)}


def _share(fit: TrialsFit, weights: NDArray[np.float64]) -> float:
    """Estimated share of right answers of the one study that was fitted."""
    return float(1 / (1 + np.exp(-fit.coefficients[0] @ weights)))


def _effects(fit: TrialsFit, counts: Counts) -> Iterator[Row]:
    """Rows of the factors, then of their interactions."""
    everywhere = range(len(counts.factors))
    for size in range(1, len(counts.factors) + 1):
        for own in combinations(everywhere, size):
            yield {
                "effect": " × ".join(counts.factors[at] for at in own),
                "participants": len(counts.asked),
                "trials": int(counts.asked.sum()),
            } | _effect(fit, counts, own)


def _effect(fit: TrialsFit, counts: Counts, own: tuple[int, ...]) -> Row:
    try:
        if len(counts.asked) < FEWEST_PARTICIPANTS:
            raise Unanswerable(too_few(len(counts.asked)))
        contrasts, note = _contrasts_of(counts.levels, own)
        found = compare_all(fit, contrasts)
    except Unanswerable as reason:
        return {"note": f"no test: {reason}"}
    if np.isnan(found.p[0]):
        return {"note": "no test: participants are too few, or do not differ in something"}
    ends = {"df1": found.df1, "df2": float(found.df2[0])}
    return ends | {"f": float(found.f[0]), "p": float(found.p[0]), "note": note}


def _contrasts_of(
    levels: NDArray[np.int64], own: tuple[int, ...]
) -> tuple[NDArray[np.float64], str]:
    """Contrasts of conditions that are 0 without an effect, float64[q, conditions], and a note.

    They are averages over those combinations of the other factors' levels at which there are all
    levels of the effect's.

    Raises
    ------
    Unanswerable
        If a factor has one level, or there is no such combination.
    """
    sizes = [int(levels[:, at].max()) + 1 for at in own]
    if 1 in sizes:
        raise Unanswerable("a factor has one level")
    rest = [at for at in range(levels.shape[1]) if at not in own]
    others, at_other = np.unique(levels[:, rest], axis=0, return_inverse=True)
    at_other = at_other.ravel()
    whole = np.flatnonzero(np.bincount(at_other) == np.prod(sizes))
    if not whole.size:
        raise Unanswerable("no combination of the other factors has all of its levels")
    apart = np.ones((1, 1))
    for size in sizes:
        apart = np.kron(apart, orthonormal_contrasts(size).T)
    place = np.ravel_multi_index(tuple(levels[:, list(own)].T), sizes)
    contrasts = apart[:, place] / whole.size
    contrasts[:, ~np.isin(at_other, whole)] = 0.0
    if whole.size == len(others):
        return contrasts, ""
    return contrasts, (
        f"over the {whole.size} of {len(others)} combinations of the other factors that have all "
        "of its levels"
    )


def _contrasts(fit: TrialsFit, counts: Counts, correction: str) -> list[Row]:
    size = len(counts.names)
    pairs = list(combinations(range(size), 2))
    rows: list[Row] = []
    for one, two in pairs:
        first, second = np.eye(size)[[one, two]]
        have = counts.asked[:, [one, two]] > 0
        row: Row = {
            "first": counts.names[one],
            "second": counts.names[two],
            "participants": int(have.any(axis=1).sum()),
            "difference": _share(fit, first) - _share(fit, second),
        }
        notes = []
        if (fraction := _extremes(counts, (one, two))) is not None:
            notes.append(fraction)
        odds = odds_row(fit, first - second, row["participants"], 1 - (1 - LEVEL) / len(pairs))
        row["d"] = float(np.log(odds["odds_ratio"])) * TO_D
        if "p" in odds:
            row["d_low"], row["d_high"] = (float(np.log(odds[end])) * TO_D
                                           for end in ("low", "high"))  # fmt: skip
            odds |= _tested(fit, first, second)
            if not tells_difference(counts.correct[:, [one, two]], counts.asked[:, [one, two]]):
                del odds["difference_low"], odds["difference_high"]
                notes.append(_FEW_DIFFER)
        notes += [odds.pop("note")] if "note" in odds else []
        rows.append(row | odds | {"note": "; ".join(notes)})
    known = [row for row in rows if "p" in row]
    for row, p in zip(known, adjust([row["p"] for row in known], correction), strict=True):
        row["p_corrected"] = float(p)
    return rows


def _tested(fit: TrialsFit, first: NDArray[np.float64], second: NDArray[np.float64]) -> Row:
    """Difference of two conditions' shares with its interval, and the test that it is 0."""
    (low, high), test = difference(fit, first, second), compare(fit, first, second)
    return {
        "difference_low": float(low[0]),
        "difference_high": float(high[0]),
        "df": float(test.degrees[0]),
        "t": float(test.estimates[0] / test.errors[0]),
        "p": float(test.p_values()[0]),
    }


def _extremes(counts: Counts, pair: tuple[int, int]) -> str | None:
    """Note on conditions in which everything or nothing was right."""
    for at in pair:
        right, asked = counts.correct[:, at].sum(), counts.asked[:, at].sum()
        if right in (0, asked):
            what = "nothing" if right == 0 else "everything"
            return f"{what} is right in {counts.names[at]}: the odds are Firth's finite ones"
    return None


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
    counts = counts_of(trials, factors)
    participants = len(counts.asked)
    if participants < FEWEST_PARTICIPANTS:
        return COVARIATES.fill([], [*notes, f"no covariates: {too_few(participants)}"])
    right, asked, design = _single(trials, counts, list(columns.values()))
    try:
        fit = fit_trials(right, asked, design)
    except Unanswerable as reason:
        return COVARIATES.fill([], [*notes, f"no covariates: {reason}"])
    units = np.eye(design.shape[-1])[len(counts.names) :]
    return COVARIATES.fill(
        [
            {"covariate": name, "participants": participants, "trials": len(trials)}
            | odds_row(fit, unit, participants)
            for name, unit in zip(columns, units, strict=True)
        ],
        notes,
    )


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
    trials: pd.DataFrame, counts: Counts, columns: Sequence[NDArray[np.float64]]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Right answers, answers and design of each trial, by participant.

    Participants with fewer trials than others have places without one.
    """
    cells = len(counts.names)
    who = counts.people
    place = pd.Series(who).groupby(who).cumcount().to_numpy()
    shape = int(who.max()) + 1, int(place.max()) + 1
    design = np.zeros((*shape, cells + len(columns)))
    design[who, place, counts.cells] = 1.0
    for at, value in enumerate(columns, cells):
        design[who, place, at] = value - value.mean()
    right, asked = np.zeros(shape), np.zeros(shape)
    right[who, place] = trials["correct"]
    asked[who, place] = 1.0
    return right, asked, design
