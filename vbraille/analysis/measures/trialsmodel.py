"""Single trials by a logistic model: estimated legibility, factors tested, conditions compared."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from vbraille.analysis.measures.levels import MOST_LEVELS
from vbraille.analysis.measures.trialcounts import counts_of, odds_row
from vbraille.analysis.schemas import NOTE_COLUMN, Column, Kind, Schema
from vbraille.analysis.statistics.correction import adjust
from vbraille.analysis.statistics.intervals import FEWEST_PARTICIPANTS, LEVEL, too_few
from vbraille.analysis.statistics.marginalmeans import (
    TO_D,
    compare,
    compare_all,
    difference,
    separate_cells,
)
from vbraille.analysis.statistics.shares import mean_share
from vbraille.analysis.statistics.trialsmodel import fit_trials
from vbraille.analysis.statistics.unanswerable import Unanswerable

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import pandas as pd
    from numpy.typing import NDArray

    from vbraille.analysis.measures.trialcounts import Counts
    from vbraille.analysis.schemas import ResultTable, Row
    from vbraille.analysis.statistics.trialsmodel import TrialsFit

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
        Column("low", "from (%)", "lower end of its 95 % interval", Kind.PERCENT),
        Column("high", "to (%)", "upper end", Kind.PERCENT),
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
        Column("participants", "participants", "how many", Kind.COUNT),
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
        Column("low", "from", "lower end of its 95 % interval", Kind.NUMBER),
        Column("high", "to", "upper end", Kind.NUMBER),
        Column("low_together", "from, together", "lower end, all pairs holding together",
               Kind.NUMBER),
        Column("high_together", "to, together", "upper end", Kind.NUMBER),
        Column("df", "df", "degrees of freedom of t", Kind.NUMBER),
        Column("t", "t", "that both are read alike", Kind.NUMBER),
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
        apart = np.kron(apart, _apart(size))
    place = np.ravel_multi_index(tuple(levels[:, list(own)].T), sizes)
    contrasts = apart[:, place] / whole.size
    contrasts[:, ~np.isin(at_other, whole)] = 0.0
    if whole.size == len(others):
        return contrasts, ""
    return contrasts, (
        f"over the {whole.size} of {len(others)} combinations of the other factors that have all "
        "of its levels"
    )


def _apart(levels: int) -> NDArray[np.float64]:
    """Orthonormal contrasts of levels, each against the mean of those before it (Helmert's)."""
    rows = np.tril(np.ones((levels, levels)), -1)[1:]
    rows[:, 1:] -= np.diag(np.arange(1.0, levels))
    return rows / np.linalg.norm(rows, axis=1, keepdims=True)


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
        notes += [odds.pop("note")] if "note" in odds else []
        rows.append(row | odds | {"note": "; ".join(notes)})
    known = [row for row in rows if "p" in row]
    for row, p in zip(known, adjust([row["p"] for row in known], correction), strict=True):
        row["p_corrected"] = float(p)
    return rows


def _tested(fit: TrialsFit, first: NDArray[np.float64], second: NDArray[np.float64]) -> Row:
    """Difference of two conditions' shares with its interval, and the test that it is 0."""
    apart, test = difference(fit, first, second), compare(fit, first, second)
    return {
        "difference_low": float(apart.low[0]),
        "difference_high": float(apart.high[0]),
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
